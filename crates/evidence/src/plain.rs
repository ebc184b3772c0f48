//! A view whose rays are small integers, and intersections of these rays in integers. It is a judge that
//! shares no code with the library, for scenes of integer corners.

use std::cmp::Ordering;

use glam::DVec3;

use binspace::view::Camera;

/// An eye at the origin that looks along −z, with y up and pixels of 2^−shift at depth 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlainView {
    size: [u32; 2],
    shift: u32,
}

/// A corner in units of 1 / [`UNITS`]; below 2²⁰ in magnitude.
pub type Corner = [i64; 3];

/// The number of units in a length of 1: a power of two, so that corners are exact in `f64`.
pub const UNITS: f64 = 256.0;

/// The intersection of a ray and a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Met {
    /// The ray misses the polygon.
    Nothing,
    /// The ray meets the polygon's boundary, or lies in its plane.
    Boundary,
    /// The ray meets the inside of the polygon at this depth.
    At(Depth),
}

/// An exact depth: a fraction with a denominator above 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    over: i128,
    under: i128,
}

impl Depth {
    /// Compares two depths.
    pub fn compare(&self, other: &Self) -> Ordering {
        (self.over * other.under).cmp(&(other.over * self.under))
    }

    /// The depth as a multiple of a ray: numerator and denominator.
    pub(crate) fn along(&self, ray: [i128; 3]) -> [i128; 2] {
        [self.over, self.under * -ray[2]]
    }

    /// Returns the depth along the view, in world units, rounded.
    pub fn to_f64(self) -> f64 {
        self.over as f64 / self.under as f64 / UNITS
    }
}

impl PlainView {
    /// Creates a view of this size, about 50 degrees high.
    pub fn new(size: [u32; 2]) -> Self {
        Self { size, shift: size[1].next_power_of_two().ilog2() }
    }

    /// Returns the picture's width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the camera. Its pixels' rays are exactly this view's rays.
    ///
    /// # Panics
    ///
    /// If a side is 0, or too large for a [`Camera`].
    pub fn camera(&self) -> Camera {
        let half = f64::from(self.size[1]) * 0.5 * 2f64.powi(-(self.shift as i32));
        let (eye, ahead, up) = (DVec3::ZERO, DVec3::NEG_Z, DVec3::Y);
        Camera::perspective_by_slope(eye, ahead, up, half, self.size).expect("a camera")
    }

    /// Returns the direction of a pixel's ray.
    pub fn ray(&self, [x, y]: [u32; 2]) -> [i128; 3] {
        let [width, height] = self.size.map(i128::from);
        let (x, y) = (i128::from(x), i128::from(y));
        [2 * x + 1 - width, height - 2 * y - 1, -(2 << self.shift)]
    }

    /// Returns the intersection of a pixel's ray and a convex flat polygon.
    pub fn meet(&self, polygon: &[Corner], pixel: [u32; 2]) -> Met {
        let ray = self.ray(pixel);
        let corner = |k: usize| polygon[k % polygon.len()].map(i128::from);
        // The side of the plane through the eye and an edge on which the ray lies.
        let sides = (0..polygon.len()).map(|k| dot(ray, cross(corner(k), corner(k + 1))).signum());
        let (mut left, mut right, mut on) = (false, false, false);
        sides.for_each(|side| match side {
            1 => left = true,
            -1 => right = true,
            _ => on = true,
        });
        if left && right {
            return Met::Nothing;
        }
        let normal = cross(minus(corner(1), corner(0)), minus(corner(2), corner(0)));
        let (over, under) = (dot(normal, corner(0)), dot(normal, ray));
        if on || under == 0 {
            return Met::Boundary;
        }
        let sign = under.signum();
        let (over, under) = (over * sign * -ray[2], under * sign);
        if over > 0 { Met::At(Depth { over, under }) } else { Met::Nothing }
    }

    /// Returns all polygons that a pixel's ray meets, the nearest first; `None` if it meets a boundary, or
    /// two polygons at the same depth.
    pub fn layers(&self, polygons: &[Vec<Corner>], pixel: [u32; 2]) -> Option<Vec<(u32, Depth)>> {
        let mut met = Vec::new();
        for (polygon, number) in polygons.iter().zip(0..) {
            match self.meet(polygon, pixel) {
                Met::Nothing => {}
                Met::Boundary => return None,
                Met::At(depth) => met.push((number, depth)),
            }
        }
        met.sort_by(|a, b| a.1.compare(&b.1));
        let tied = met.windows(2).any(|pair| pair[0].1.compare(&pair[1].1).is_eq());
        (!tied).then_some(met)
    }

    /// Returns the visible polygons in a pixel, the furthest first, if some polygons are opaque and the
    /// others translucent: the nearest opaque polygon, and all translucent polygons before it. `None` as for
    /// [`layers`](Self::layers).
    pub fn shown(
        &self,
        polygons: &[Vec<Corner>],
        opaque: &[bool],
        pixel: [u32; 2],
    ) -> Option<Vec<u32>> {
        let layers = self.layers(polygons, pixel)?;
        let last = layers.iter().position(|&(number, _)| opaque[number as usize]);
        let end = last.map_or(layers.len(), |last| last + 1);
        Some(layers[..end].iter().rev().map(|&(number, _)| number).collect())
    }

    /// Returns the value of an attribute where a pixel's ray meets the plane of a triangle, given its values
    /// at the corners, below 2²⁰ in magnitude: a fraction, rounded once it is known.
    pub fn interpolate(&self, triangle: [Corner; 3], values: [i64; 3], pixel: [u32; 2]) -> f64 {
        let (ray, [a, b, c]) = (self.ray(pixel), triangle.map(|corner| corner.map(i128::from)));
        let weights = [cross(b, c), cross(c, a), cross(a, b)].map(|normal| dot(ray, normal));
        let over: i128 = weights.iter().zip(values).map(|(w, value)| w * i128::from(value)).sum();
        over as f64 / weights.iter().sum::<i128>() as f64
    }
}

/// Returns a corner in world units.
pub fn to_world(corner: Corner) -> DVec3 {
    DVec3::from_array(corner.map(|c| c as f64 / UNITS))
}

fn minus(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::{Met, PlainView};

    #[test]
    fn a_square_is_met_where_it_is() {
        // Pixels have a side of 1/4 at depth 1. The square reaches to 2.0 at depth 4, which is 0.5 at depth
        // 1.
        let view = PlainView::new([4, 4]);
        let square = [[-512, -512], [512, -512], [512, 512], [-512, 512]];
        let square = square.map(|[x, y]| [x, y, -1024]);
        for x in 0..4 {
            let Met::At(depth) = view.meet(&square, [x, 1]) else { panic!("column {x}") };
            assert_eq!(depth.to_f64(), 4.0);
        }
        let half = square.map(|[x, y, z]| [x / 2, y / 2, z]);
        let met = [0, 1, 2, 3].map(|x| view.meet(&half, [x, 1]) != Met::Nothing);
        assert_eq!(met, [false, true, true, false]);
        assert_eq!(view.meet(&square.map(|[x, y, z]| [x, y, -z]), [1, 1]), Met::Nothing);
    }

    #[test]
    fn values_are_linear_on_the_plane() {
        let view = PlainView::new([4, 4]);
        // In the plane x + z = -2 units of 256, x is the value itself.
        let triangle = [[0, -900, -512], [512, -900, -1024], [128, 700, -640]];
        for x in 0..4 {
            let value = view.interpolate(triangle, triangle.map(|corner| corner[0]), [x, 2]);
            // x = s w and x - w = -512, with s the slope of the ray: w = 512 / (1 - s).
            let slope = (2.0 * f64::from(x) - 3.0) / 8.0;
            assert!((value - slope * 512.0 / (1.0 - slope)).abs() < 1e-9, "{x}: {value}");
        }
    }
}
