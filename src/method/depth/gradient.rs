//! A linear function on the picture, through three points.

use std::marker::PhantomData;

use crate::geom::Precision;

/// A position on the picture, in pixels, and the value of what is interpolated there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) value: f64,
}

/// A value at one point and its slopes; every operation is rounded to `P`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gradient<P> {
    origin: Sample,
    pub(super) along_x: f64,
    pub(super) along_y: f64,
    precision: PhantomData<P>,
}

impl<P: Precision> Gradient<P> {
    /// Through the first sample and two neighbours that span the most with it. Where they span
    /// nothing the value is that of the first everywhere.
    pub(super) fn new(samples: &[Sample]) -> Self {
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

    /// The value at a pixel's centre.
    #[inline]
    pub(super) fn at(&self, x: u32, y: u32) -> f64 {
        let dx = P::round(f64::from(x) + 0.5 - self.origin.x);
        let dy = P::round(f64::from(y) + 0.5 - self.origin.y);
        let along = P::round(self.origin.value + P::round(dx * self.along_x));
        P::round(along + P::round(dy * self.along_y))
    }
}
