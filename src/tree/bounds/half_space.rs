//! Planes that are compared with boxes.

use glam::{DVec3, Vec4};

use super::boxes::{Block, Flat};
use crate::exact::lattice::{exponent_of, scaled};
use crate::exact::{LATTICE_LIMIT, Lattice};

/// The front of a plane, prepared to be compared with many boxes of one scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpace {
    normal: [f32; 3],
    /// Less than the offset, by more than the rounding of all that it is compared with.
    offset: f32,
    /// The coordinates of a box's furthest corner along the normal, and of its nearest.
    far: [usize; 3],
    near: [usize; 3],
}

/// Error bound of a scalar product with a corner of a box, as a share of the sum of the normal's
/// magnitudes: coordinates are at most 1.014, and the normal, products and sums are rounded, which makes
/// 4 · 1.014 · 2⁻²⁴. The rest is more than a step of the scene's grid, by which the eye may be off.
/// Smaller: boxes that reach over the plane are behind; larger: more of those near it are not.
const DISTANCE_ERROR: f64 = 4.2 / (1_u64 << 24) as f64;

/// Roundings in the place of the plane, by `f64`.
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// More than the distance of any corner from the scene's middle, along a normal whose largest coordinate
/// is 1.
const OUTSIDE: f64 = 4.0;

impl HalfSpace {
    /// A plane with a number that is infinite or NaN has all boxes in front.
    pub(crate) fn new((normal, offset): (DVec3, f64), lattice: &Lattice) -> Self {
        // By a power of two first, which is exact, so that no digit is lost where numbers are subnormal.
        let largest = normal.abs().max_element();
        let up = if largest > 0.0 { -exponent_of(largest) } else { 0 };
        let normal = DVec3::from_array(normal.to_array().map(|c| scaled(c, up)));
        let offset = scaled(offset, up);
        let size = normal.abs().max_element().max(f64::MIN_POSITIVE);
        let normal = normal / size;
        // An eighth of all lengths, so that none overflows.
        let middle = lattice.to_world([0.0; 3]) / 8.0;
        let unit = lattice.length_to_world(LATTICE_LIMIT / 8.0);
        let offset = offset / 8.0 / size;
        let sum = offset.abs() + normal.abs().dot(middle.abs());
        let margin = (sum * ROUNDINGS + f64::MIN_POSITIVE) / unit;
        let margin = margin + normal.abs().element_sum() * DISTANCE_ERROR;
        let least = ((offset - normal.dot(middle)) / unit - margin).clamp(-OUTSIDE, OUTSIDE);
        // The same margin for all boxes: so a box inside another never is on the front of a plane that the
        // larger one is behind.
        let offset = if least.is_nan() { f32::NEG_INFINITY } else { (least as f32).next_down() };
        let normal = if least.is_nan() { [0.0; 3] } else { normal.as_vec3().to_array() };
        let sides = |is_far| [0, 1, 2].map(|i| if (normal[i] > 0.0) == is_far { i + 3 } else { i });
        Self { normal, offset, far: sides(true), near: sides(false) }
    }

    /// A bit for each box that is not behind, at least as far as certain.
    #[inline]
    pub(crate) fn meets(&self, block: &Block) -> u32 {
        self.fronts(block, self.far)
    }

    /// A bit for each box that is in front.
    #[inline]
    pub(crate) fn holds(&self, block: &Block) -> u32 {
        self.fronts(block, self.near)
    }

    /// A bit for each box that has a corner in front.
    #[inline]
    fn fronts(&self, Block(groups): &Block, [x, y, z]: [usize; 3]) -> u32 {
        let [a, b, c] = self.normal;
        let mut fronts = 0;
        for (g, group) in groups.iter().enumerate() {
            let along = group[x] * a + group[y] * b + group[z] * c;
            fronts |= along.cmpge(Vec4::splat(self.offset)).bitmask() << (4 * g);
        }
        fronts
    }

    /// Whether all of a box is behind.
    #[inline]
    pub(crate) fn is_behind(&self, bounds: &Flat) -> bool {
        let [a, b, c] = self.normal;
        let [x, y, z] = self.far;
        bounds[x] * a + bounds[y] * b + bounds[z] * c < self.offset
    }
}
