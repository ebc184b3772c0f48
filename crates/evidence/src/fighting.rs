//! Z-fighting: two sheets so near each other that depth buffers cannot separate them.

use glam::DVec3;

use crate::method::{DepthBuffer, DepthFormat, Method, MethodError};
use binspace::internals::Faces;
use binspace::raster::{Image, Rays, zbuffer};
use binspace::view::Camera;

/// A sheet that fills the picture and recedes from 20 to 190 units, and a second sheet behind it. Along every
/// ray, the distance of the second sheet from the eye is larger by a share `gap`. The further sheet comes
/// first, so it is visible wherever a buffer stores the same number for both.
#[derive(Debug)]
pub struct Sheets {
    gap: f64,
    faces: Faces,
    camera: Camera,
    rays: Rays,
    truth: Image,
    /// The depth of the nearer sheet in each pixel.
    depths: Vec<f64>,
}

/// The near and the far plane.
pub const PLANES: [f64; 2] = [1.0, 200.0];
/// The reciprocals of the depths at the lower left of the picture and at the upper right.
const ENDS: [f64; 2] = [1.0 / 20.0, 1.0 / 190.0];
/// The tangent of half of the field of view.
const HALF_HEIGHT: f64 = 0.5;

/// The result of a buffer for two sheets.
#[derive(Clone, Debug)]
pub struct Fight {
    /// The picture: faces 0 and 1 are the further sheet.
    pub image: Image,
    /// Wrong pixels.
    pub wrong: usize,
    /// The depth of the nearest wrong pixel and of the furthest.
    pub seen: Option<[f64; 2]>,
}

/// The prediction from the steps of a format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// The nearest and the furthest depth at which the sheets are less than a step apart.
    pub begin: Option<[f64; 2]>,
    /// The number of wrong pixels. Where the sheets are s steps apart, with s below 1, both are stored as the
    /// same number in a share 1 − s of the pixels.
    pub wrong: f64,
}

impl Sheets {
    /// Creates the sheets, and their true picture of this size. Width and height should be as 4 to 3.
    ///
    /// # Panics
    ///
    /// If `gap` is not a small positive number.
    pub fn new(gap: f64, size: [u32; 2]) -> Self {
        let camera =
            Camera::perspective_by_slope(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, HALF_HEIGHT, size)
                .expect("a camera");
        let sheets: Vec<_> = [1.0 + gap, 1.0].into_iter().flat_map(sheet).collect();
        let (faces, _) = Faces::new(&sheets, Some(0.0)).expect("a scene");
        let rays = Rays::new(&camera, &faces).expect("rays");
        let truth = zbuffer(&rays, &faces);
        let depths = truth.depths().collect();
        Self { gap, faces, camera, rays, truth: truth.into_image(), depths }
    }

    /// Returns the four triangles: two of the further sheet, two of the nearer.
    pub fn polygons(&self) -> Vec<[DVec3; 3]> {
        [1.0 + self.gap, 1.0].into_iter().flat_map(sheet).collect()
    }

    /// Returns the camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the picture of a method.
    ///
    /// # Errors
    ///
    /// The errors of the method.
    pub fn shown_by(&self, method: &dyn Method) -> Result<Fight, MethodError> {
        let painted = method.prepare(&self.faces)?.paint(&self.camera, &self.rays)?;
        let image = painted.image;
        // Each sheet consists of two triangles. It is not wrong to show the other triangle of the same sheet.
        let mut wrong: Vec<f64> = Vec::new();
        for (i, (&shown, &nearest)) in image.faces().iter().zip(self.truth.faces()).enumerate() {
            if shown / 2 != nearest / 2 {
                wrong.push(self.depths[i]);
            }
        }
        let ends = wrong
            .iter()
            .fold([f64::INFINITY, 0.0f64], |[low, high], &depth| [low.min(depth), high.max(depth)]);
        Ok(Fight { image, wrong: wrong.len(), seen: (!wrong.is_empty()).then_some(ends) })
    }

    /// Returns the picture of a depth buffer.
    ///
    /// # Errors
    ///
    /// No error is known.
    pub fn in_format(&self, format: DepthFormat) -> Result<Fight, MethodError> {
        self.shown_by(&DepthBuffer::new(format).with_range(PLANES[0], PLANES[1]))
    }

    /// Returns the prediction that includes the roundings of the pipeline: it uses the planes that the
    /// pipeline sets up, bounds of the roundings in each pixel, and the steps. No pixel is wrong outside the
    /// predicted depths.
    ///
    /// # Errors
    ///
    /// No error is known.
    pub fn predicted_with_roundings(&self, format: DepthFormat) -> Result<Prediction, MethodError> {
        let mut prediction = Prediction { begin: None, wrong: 0.0 };
        for (apart, &depth) in self.apart(format)?.into_iter().zip(&self.depths) {
            prediction.wrong += apart.share_wrong();
            if !apart.is_right() {
                let [low, high] = prediction.begin.unwrap_or([f64::INFINITY, 0.0]);
                prediction.begin = Some([low.min(depth), high.max(depth)]);
            }
        }
        Ok(prediction)
    }

    /// The distance of the sheets in each pixel, just before they are stored.
    fn apart(&self, format: DepthFormat) -> Result<Vec<Apart>, MethodError> {
        let method = DepthBuffer::new(format).with_range(PLANES[0], PLANES[1]);
        let planes = method.set_up(&self.camera, &self.faces)?;
        let [width, _] = self.camera.size();
        let apart = |(k, &face): (u32, &u32)| {
            // A triangle of the further sheet is behind a triangle of the nearer sheet, along the same rays.
            let [near, far] = [face, face - 2].map(|face| planes.at(face, k % width, k / width));
            let (near, far) = (near.expect("a sheet"), far.expect("a sheet"));
            let step = near.step.min(far.step);
            Apart {
                steps: (far.value - near.value) / step,
                roundings: [near.rounding / step, far.rounding / step],
            }
        };
        Ok((0..).zip(self.truth.faces()).map(apart).collect())
    }

    /// Returns the prediction from the steps of a format, by the formula of [`DepthFormat::step`].
    pub fn predicted(&self, format: DepthFormat) -> Prediction {
        let mut prediction = Prediction { begin: None, wrong: 0.0 };
        for &depth in &self.depths {
            // In 1 / w, from which z is computed, the sheets differ by gap / (1 + gap); in w they differ by
            // gap.
            let share = if is_linear(format) { self.gap } else { self.gap / (1.0 + self.gap) };
            let apart = share * depth / format.step(PLANES, depth);
            if apart < 1.0 {
                prediction.wrong += 1.0 - apart;
                let [low, high] = prediction.begin.unwrap_or([f64::INFINITY, 0.0]);
                prediction.begin = Some([low.min(depth), high.max(depth)]);
            }
        }
        prediction
    }
}

/// How far the number of the further sheet is beyond the number of the nearer sheet, in steps; and the
/// largest effect of roundings on each number.
#[derive(Clone, Copy, Debug)]
struct Apart {
    steps: f64,
    roundings: [f64; 2],
}

impl Apart {
    /// Whether both are certainly stored as different numbers, in the right order.
    fn is_right(&self) -> bool {
        self.steps - self.roundings[0] - self.roundings[1] > 1.0
    }

    /// The probability of a wrong pixel, if each rounding is equally likely anywhere within its bound.
    /// Numbers that are s steps apart, with s below 1, are stored as the same number with the probability 1 −
    /// s.
    fn share_wrong(&self) -> f64 {
        const PARTS: u32 = 8;
        let middle = |k: u32| (2 * k + 1) as f64 / f64::from(PARTS) - 1.0;
        let mut sum = 0.0;
        for (i, j) in (0..PARTS).flat_map(|i| (0..PARTS).map(move |j| (i, j))) {
            let moved = middle(i) * self.roundings[0] + middle(j) * self.roundings[1];
            sum += (1.0 - (self.steps + moved)).clamp(0.0, 1.0);
        }
        sum / f64::from(PARTS * PARTS)
    }
}

fn is_linear(format: DepthFormat) -> bool {
    matches!(format, DepthFormat::LinearInteger(_) | DepthFormat::LinearFloat)
}

/// A sheet as two triangles, `times` as far away.
fn sheet(times: f64) -> [[DVec3; 3]; 2] {
    let [near, far] = ENDS;
    // A little beyond the picture's corners. 1 / w is linear there, as on every plane.
    let corner = |x: f64, y: f64| {
        let share = 0.5 + 0.47 * y + 0.03 * x;
        let depth = times / (near + share * (far - near));
        DVec3::new(x * 1.34 * HALF_HEIGHT * depth, y * 1.01 * HALF_HEIGHT * depth, -depth)
    };
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    [[a, b, c], [a, c, d]]
}

#[cfg(test)]
mod tests {
    use super::Sheets;
    use crate::method::Bsp;
    use crate::method::DepthFormat;
    use crate::method::DepthFormat::{Float, FloatReversed, Integer, LinearFloat, LinearInteger};
    use binspace::BuildOptions;

    const SIZE: [u32; 2] = [160, 120];

    #[test]
    fn integers_fight_where_predicted_and_as_much() {
        let cases = [
            (Integer(16), 6e-4),
            (Integer(16), 3e-4),
            (Integer(16), 1e-3),
            (Integer(24), 2.4e-6),
            (Integer(24), 4e-6),
            (LinearInteger(16), 5e-5),
            (LinearInteger(16), 8e-5),
        ];
        for (format, gap) in cases {
            let sheets = Sheets::new(gap, SIZE);
            let (fight, predicted) = (sheets.in_format(format).unwrap(), sheets.predicted(format));
            let ([first, last], [begin, end]) = (fight.seen.unwrap(), predicted.begin.unwrap());
            // Where the sheets are a step apart, no pixel may be wrong. Soon after this depth, some pixel
            // should be wrong.
            assert!(first >= begin * (1.0 - 1e-9) && last <= end * (1.0 + 1e-9), "{format} {gap}");
            assert!(first <= begin * 1.05 && last >= end * 0.95, "{format} {gap}: {first} {begin}");
            let share = fight.wrong as f64 / predicted.wrong;
            assert!((0.95..1.05).contains(&share), "{format} {gap}: {share} {fight:?}");
        }
    }

    /// No pixel is wrong where roundings cannot make it so. If at least a tenth of the picture is predicted
    /// to be wrong, then the nearest wrong pixel is within 15 % of the predicted depth, and the number of
    /// wrong pixels is half to twice the predicted number.
    #[test]
    fn roundings_predict_where_every_format_fights() {
        let cases: [(DepthFormat, &[f64]); 6] = [
            (Integer(16), &[6e-4, 3e-4]),
            (Integer(24), &[2.4e-6, 4e-6]),
            (LinearInteger(16), &[5e-5, 8e-5]),
            (Float, &[1e-6, 2.4e-6, 6e-6]),
            (FloatReversed, &[6e-8, 1e-7, 6e-7]),
            (LinearFloat, &[6e-8, 1e-7, 6e-7]),
        ];
        for (format, gaps) in cases {
            let [mut right, mut fights] = [0, 0];
            for &gap in gaps {
                let sheets = Sheets::new(gap, SIZE);
                let fight = sheets.in_format(format).unwrap();
                let predicted = sheets.predicted_with_roundings(format).unwrap();
                let apart = sheets.apart(format).unwrap();
                for (apart, &shown) in apart.iter().zip(fight.image.faces()) {
                    assert!(!apart.is_right() || shown >= 2, "{format} {gap}: {apart:?}");
                    right += usize::from(apart.is_right());
                }
                if predicted.wrong < 0.1 * apart.len() as f64 {
                    continue;
                }
                let ([first, last], [begin, end]) = (fight.seen.unwrap(), predicted.begin.unwrap());
                assert!(begin <= first && last <= end, "{format} {gap}: {fight:?}");
                assert!(first <= 1.15 * begin, "{format} {gap}: {first} {begin}");
                let share = fight.wrong as f64 / predicted.wrong;
                assert!((0.5..2.0).contains(&share), "{format} {gap}: {share}");
                fights += 1;
            }
            assert!(right > 1000 && fights > 0, "{format}: {right} {fights}");
        }
    }

    #[test]
    fn an_f32_fights_like_24_bits_and_reversed_much_later() {
        let sheets = Sheets::new(2.4e-6, SIZE);
        let wrong = [Integer(24), Float, FloatReversed]
            .map(|format| sheets.in_format(format).unwrap().wrong as f64);
        assert!(wrong[1] > 0.5 * wrong[0] && wrong[0] > 1000.0, "{wrong:?}");
        assert_eq!(wrong[2], 0.0);
    }

    #[test]
    fn the_tree_fights_at_no_distance() {
        for gap in [6e-4, 2.4e-6, 1e-9] {
            let sheets = Sheets::new(gap, SIZE);
            let tree = Bsp::exact(BuildOptions::DEFAULT.with_tolerance(0.0));
            assert_eq!(sheets.shown_by(&tree).unwrap().wrong, 0, "{gap}");
        }
    }
}
