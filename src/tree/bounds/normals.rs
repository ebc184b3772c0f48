//! What the normals of several fragments have in common.

use std::cmp::Ordering;

use glam::Vec3;

use super::boxes::{Flat, in_lattice};
use crate::exact::Eye;

/// The least and the largest coordinates of unit normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tree) struct Normals {
    low: [f32; 3],
    high: [f32; 3],
}

/// A bound on the error of a unit normal's coordinate in `f32`, and of adding this to it. With ε = 2⁻²³: a
/// normal is within 2⁻³⁴ of its longest coordinate and is made a unit one in `f64`, which leaves less than
/// ε / 1000. A coordinate of at most 1 is rounded to `f32` by ε / 4, and so is the sum, by ε / 2 where it is
/// more than 1. So this is more than twice as much as is needed. Smaller: a box may be without the exact
/// normal; larger: fewer subtrees are decided at once.
const NORMAL_ERROR: f32 = 2.0 * f32::EPSILON;

impl Normals {
    pub(super) const NONE: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    /// Of one, whose unit normal is given rounded.
    pub(super) fn of(normal: Vec3) -> Self {
        let normal = normal.to_array();
        Self { low: normal.map(|c| c - NORMAL_ERROR), high: normal.map(|c| c + NORMAL_ERROR) }
    }

    pub(super) fn union(self, other: Self) -> Self {
        let pick = |of: fn(f32, f32) -> f32, a: [f32; 3], b: [f32; 3]| {
            std::array::from_fn(|i| of(a[i], b[i]))
        };
        Self {
            low: pick(f32::min, self.low, other.low),
            high: pick(f32::max, self.high, other.high),
        }
    }

    /// Which side all polygons show to an eye that have such normals and vertices in a box; `None`
    /// if these do not tell.
    ///
    /// A polygon's plane is at n·(e − p) from the eye e, with n its normal and p any point of it. The
    /// bounds of n and p bound each product, and so the sum.
    pub(super) fn facing(&self, arms: &Arms, bounds: &Flat) -> Option<Ordering> {
        let [least, most] = arms.to(bounds);
        let (mut low, mut high, mut size) = (0.0, 0.0, 0.0);
        for axis in 0..3 {
            let [a, b] = [self.low[axis], self.high[axis]].map(f64::from);
            let [c, d] = [least[axis], most[axis]];
            let products = [a * c, a * d, b * c, b * d];
            low += products.into_iter().fold(f64::INFINITY, f64::min);
            high += products.into_iter().fold(f64::NEG_INFINITY, f64::max);
            size += products.into_iter().fold(0.0, |size, product| product.abs().max(size));
        }
        // With ε = 2⁻⁵²: each product has a rounding, ε / 2 of it, and each sum one of its terms'. There are
        // two sums that round (the first adds to 0), so ε / 2 + ε / 2 + ε / 2 of the size is enough.
        let margin = 4.0 * f64::EPSILON * size;
        if low > margin {
            Some(Ordering::Greater)
        } else if high < -margin {
            Some(Ordering::Less)
        } else {
            None
        }
    }
}

/// The eye relative to points of boxes.
#[derive(Clone, Copy, Debug)]
pub(in crate::tree) struct Arms {
    eye: [f64; 3],
    /// 1, or 0 for an eye at infinity.
    w: f64,
}

impl Arms {
    pub(in crate::tree) fn new(eye: &Eye) -> Self {
        let (eye, w) = eye.homogeneous();
        Self { eye, w }
    }

    /// The least and largest coordinates of the eye less a point of a box, in lattice units, or of
    /// the direction towards the eye.
    fn to(&self, bounds: &Flat) -> [[f64; 3]; 2] {
        let [low, high] = in_lattice(bounds);
        let bound = |corner: [f64; 3], sign: f64| {
            std::array::from_fn(|axis| {
                let (eye, corner) = (self.eye[axis], self.w * corner[axis]);
                // The eye and the difference are rounded, by ε / 2 of the eye, and of the eye and the corner; and
                // so is the sum below, by as much again. (A direction and corners of boxes are exact.)
                let rounded = 2.0 * f64::EPSILON * (eye.abs() + corner.abs() + 1.0);
                eye - corner + sign * rounded
            })
        };
        [bound(high, -1.0), bound(low, 1.0)]
    }
}
