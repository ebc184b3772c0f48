//! A linear function on the picture, through three points.

use std::marker::PhantomData;

use crate::Precision;

/// A position on the picture, in pixels, and the interpolated value there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::method) struct Sample {
    pub(in crate::method) x: f64,
    pub(in crate::method) y: f64,
    pub(in crate::method) value: f64,
}

/// A value at one point and its slopes; every operation is rounded to `P`.
#[derive(Clone, Copy, Debug)]
pub(in crate::method) struct Gradient<P> {
    origin: Sample,
    pub(super) along_x: f64,
    pub(super) along_y: f64,
    precision: PhantomData<P>,
}

impl<P: Precision> Gradient<P> {
    /// Creates the function through the first sample and the two neighbours that span the largest triangle
    /// with it. If no triangle has an area, the function is constant.
    pub(in crate::method) fn new(samples: &[Sample]) -> Self {
        let precision = PhantomData;
        let Some((&origin, rest)) = samples.split_first() else {
            let origin = Sample { x: 0.0, y: 0.0, value: 0.0 };
            return Self { origin, along_x: 0.0, along_y: 0.0, precision };
        };
        let arm =
            |to: &Sample| [to.x - origin.x, to.y - origin.y, to.value - origin.value].map(P::round);
        let minor = |a: f64, d: f64, b: f64, c: f64| P::round(P::round(a * d) - P::round(b * c));
        let (mut area, mut slopes) = (0.0f64, [0.0; 2]);
        for pair in rest.windows(2) {
            let ([x1, y1, z1], [x2, y2, z2]) = (arm(&pair[0]), arm(&pair[1]));
            let spanned = minor(x1, y2, x2, y1);
            if spanned.abs() > area.abs() {
                area = spanned;
                slopes = [minor(z1, y2, z2, y1), minor(x1, z2, x2, z1)];
            }
        }
        let [along_x, along_y] = slopes.map(|c| if area == 0.0 { 0.0 } else { P::round(c / area) });
        Self { origin, along_x, along_y, precision }
    }

    /// The first value of a row: the value at the row's centre line and the x of the first sample.
    #[inline]
    pub(in crate::method) fn row(&self, y: u32) -> f64 {
        let dy = P::round(f64::from(y) + 0.5 - self.origin.y);
        P::round(self.origin.value + P::round(dy * self.along_y))
    }

    /// The value at the centre of a row's pixel.
    #[inline]
    pub(in crate::method) fn at(&self, row: f64, x: u32) -> f64 {
        self.at_x(row, f64::from(x) + 0.5)
    }

    /// The value at any x of a row.
    #[inline]
    pub(super) fn at_x(&self, row: f64, x: f64) -> f64 {
        let dx = P::round(x - self.origin.x);
        P::round(row + P::round(dx * self.along_x))
    }
}

#[cfg(test)]
mod tests {
    use super::{Gradient, Sample};

    fn samples(positions: &[[f64; 2]]) -> Vec<Sample> {
        let sample = |&[x, y]: &[f64; 2]| Sample {
            x,
            y,
            value: f64::from((0.25 * x + 0.5 * y + 3.0) as f32),
        };
        positions.iter().map(sample).collect()
    }

    #[test]
    fn slopes_are_those_of_the_largest_triangle() {
        // The triangle of the first three has almost no area, and 6 + 5e-7 is 6 in `f32`.
        let all = samples(&[[0.0, 0.0], [6.0, 0.0], [12.0, 1e-6], [8.0, 8.0], [0.0, 8.0]]);
        let gradient = Gradient::<f32>::new(&all);
        assert_eq!((gradient.along_x, gradient.along_y), (0.25, 0.5));
        assert_eq!(gradient.at(gradient.row(2), 4), 3.0 + 1.125 + 1.25);
        assert!((Gradient::<f32>::new(&all[..3]).along_y - 0.5).abs() > 0.1);
    }

    #[test]
    fn without_area_the_first_value_counts() {
        let gradient = Gradient::<f64>::new(&samples(&[[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]]));
        assert_eq!(gradient.at(gradient.row(7), 9), 3.75);
        assert_eq!(Gradient::<f64>::new(&[]).at(0.0, 1), 0.0);
    }
}
