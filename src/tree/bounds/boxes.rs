//! Boxes of fragments in `f32`, laid out by the block.
//!
//! Their unit is 2⁵¹ lattice steps, so coordinates are hardly larger than 1 in every scene.

use glam::Vec4;

use crate::exact::LATTICE_LIMIT;

/// The least coordinates of a box, then the largest.
pub(crate) type Flat = [f32; 6];

/// The box of nothing.
pub(super) const NOTHING: Flat = [
    f32::INFINITY,
    f32::INFINITY,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NEG_INFINITY,
    f32::NEG_INFINITY,
];

/// How many boxes are summed up in one. Smaller: more memory; larger: more boxes are looked at where few
/// are met.
pub(crate) const BLOCK: usize = 16;

/// Boxes that are compared with a plane at once.
const GROUP: usize = 4;

/// [`BLOCK`] boxes by fours: the least x of four of them, their least y, and so on. The last of a list is
/// filled up with zeros.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Block(pub(super) [[Vec4; 6]; BLOCK / GROUP]);

impl Block {
    pub(super) fn new(boxes: impl Iterator<Item = Flat>) -> Self {
        let mut block = Self::default();
        for (k, bounds) in boxes.take(BLOCK).enumerate() {
            for (row, side) in block.0[k / GROUP].iter_mut().zip(bounds) {
                row[k % GROUP] = side;
            }
        }
        block
    }

    /// The box of some number, less than [`BLOCK`].
    #[inline]
    pub(crate) fn get(&self, k: usize) -> Flat {
        self.0[k / GROUP % (BLOCK / GROUP)].map(|row| row[k % GROUP])
    }

    /// The box of the first ones, up to so many.
    pub(super) fn all(&self, len: usize) -> Flat {
        (0..len.min(BLOCK)).map(|k| self.get(k)).fold(NOTHING, union)
    }
}

/// A box that contains one in lattice units.
pub(super) fn outwards(low: [f64; 3], high: [f64; 3]) -> Flat {
    std::array::from_fn(|i| {
        let exact = if i < 3 { low[i] } else { high[i - 3] } / LATTICE_LIMIT;
        let rounded = exact as f32;
        match f64::from(rounded) - exact {
            lost if i < 3 && lost > 0.0 => rounded.next_down(),
            lost if i >= 3 && lost < 0.0 => rounded.next_up(),
            _ => rounded,
        }
    })
}

/// Its least and its largest coordinates in lattice units.
pub(super) fn in_lattice(bounds: &Flat) -> [[f64; 3]; 2] {
    let [a, b, c, d, e, f] = bounds.map(|side| f64::from(side) * LATTICE_LIMIT);
    [[a, b, c], [d, e, f]]
}

pub(super) fn union(a: Flat, b: Flat) -> Flat {
    std::array::from_fn(|i| if i < 3 { a[i].min(b[i]) } else { a[i].max(b[i]) })
}
