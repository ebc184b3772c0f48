//! The bounding box of a set, and the pieces that fill it.

use super::live::{Live, bounds};

/// How many of the largest polygons are tried beside free planes at every node.
pub(super) const LARGEST: usize = 2;
/// The share of the box below which a polygon is not tried as one of the largest.
const LARGE: f64 = 0.2;

/// The bounding box of a set.
#[derive(Debug)]
pub(super) struct Cell {
    size: [f64; 3],
}

impl Cell {
    pub(super) fn around(pieces: &[Live]) -> Self {
        let (min, max) = bounds(pieces);
        Self { size: std::array::from_fn(|axis| max[axis] - min[axis]) }
    }

    /// How much of the box a piece fills along its two longer sides, 0 to 1.
    pub(super) fn share(&self, piece: &Live) -> f64 {
        let [x, y, z] = std::array::from_fn(|axis| {
            let size = piece.max[axis] - piece.min[axis];
            if self.size[axis] > 0.0 { size / self.size[axis] } else { 1.0 }
        });
        // The largest product of two of the three.
        (x * y).max(y * z).max(z * x)
    }

    /// The pieces that fill most of the box, if they fill enough of it.
    pub(super) fn largest<'p>(&self, pieces: &'p [Live]) -> impl Iterator<Item = &'p Live> {
        let mut top: [(f64, Option<&Live>); LARGEST] = [(LARGE, None); LARGEST];
        for piece in pieces {
            let share = self.share(piece);
            if share > top[LARGEST - 1].0 {
                top[LARGEST - 1] = (share, Some(piece));
                top.sort_by(|a, b| b.0.total_cmp(&a.0));
            }
        }
        top.into_iter().filter_map(|(_, piece)| piece)
    }
}
