//! Spheres.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::{Shared, slopes};
use crate::plain::{Corner, Depth, PlainView, UNITS};

/// A sphere ahead of the eye, in units of 1 / [`UNITS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sphere {
    /// The centre.
    pub centre: Corner,
    /// The radius, above 0.
    pub radius: i64,
}

impl Sphere {
    /// Draws the sphere by its own routine: the depth in a pixel is the smaller root of a quadratic equation,
    /// in `f64`.
    pub fn draw(&self, view: &PlainView, number: u32, picture: &mut Shared) {
        let [width, height] = view.size();
        for pixel in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
            let depth = self.depth(view, pixel);
            if !depth.is_nan() {
                picture.put(pixel, depth, number);
            }
        }
    }

    /// The depth at which a pixel's ray meets the sphere, rounded; NaN if the ray misses.
    pub(super) fn depth(&self, view: &PlainView, pixel: [u32; 2]) -> f64 {
        let [x, y, z] = self.centre.map(|c| c as f64 / UNITS);
        let rest = x * x + y * y + z * z - (self.radius as f64 / UNITS).powi(2);
        let [right, up] = slopes(view, pixel);
        // |w (right, up, -1) - centre|² = radius².
        let (a, half) = (right * right + up * up + 1.0, right * x + up * y - z);
        (half - (half * half - a * rest).sqrt()) / a
    }

    /// Returns whether a pixel's ray meets the sphere, exactly: the sign of the quadratic equation's
    /// discriminant.
    pub fn is_met(&self, view: &PlainView, pixel: [u32; 2]) -> bool {
        self.equation(view, pixel)[2] > 0
    }

    /// Compares the sphere's depth with a given depth, exactly, on a ray that meets the sphere.
    pub fn compare(&self, view: &PlainView, pixel: [u32; 2], depth: &Depth) -> Ordering {
        let [a, half, discriminant] = self.equation(view, pixel).map(IBig::from);
        let [over, under] = depth.along(view.ray(pixel)).map(IBig::from);
        // (half - √discriminant) / a against over / under.
        let left = half * &under - a * over;
        if left < IBig::ZERO {
            return Ordering::Less;
        }
        (&left * &left).cmp(&(&under * &under * discriminant))
    }

    /// a t² − 2 half t + rest = 0, where t is a multiple of the ray: a, half, half² − a · rest.
    fn equation(&self, view: &PlainView, pixel: [u32; 2]) -> [i128; 3] {
        let (ray, centre) = (view.ray(pixel), self.centre.map(i128::from));
        let dot = |a: [i128; 3], b: [i128; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<i128>();
        let (a, half) = (dot(ray, ray), dot(ray, centre));
        let rest = dot(centre, centre) - i128::from(self.radius).pow(2);
        [a, half, half * half - a * rest]
    }
}
