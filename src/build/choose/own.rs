//! The best plane among the pieces' own planes, by counting all pieces.

use super::cost::Counts;
use super::set::{LANES, PackedPieces, PackedPlane, Set};
use crate::build::piece::Piece;
use crate::exact::PlaneId;
use crate::progress::{PIECES_AT_ONCE, Watch};

/// The share of a set's bounding box that a piece fills along the two axes of its largest share, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    /// 1 divided by the size of the box; `None` along axes where the box has no extent.
    per_unit: [Option<f64>; 3],
}

impl Shares {
    pub(super) fn of(size: [f64; 3]) -> Self {
        Self { per_unit: size.map(|size| (size > 0.0).then(|| 1.0 / size)) }
    }

    #[inline]
    pub(super) fn get(&self, piece: &Piece) -> f64 {
        let [x, y, z] = std::array::from_fn(|axis| {
            let size = piece.max[axis] - piece.min[axis];
            self.per_unit[axis].map_or(1.0, |per_unit| size * per_unit)
        });
        // The largest product of two of the three.
        (x * y).max(y * z).max(z * x)
    }
}

/// A chooser among the planes of the set's pieces. Its buffers are reused.
#[derive(Debug, Default)]
pub(super) struct Scored {
    sketch: PackedPieces,
    /// Each tried piece, and how its plane divides the set.
    tried: Vec<(usize, PackedPlane, Counts)>,
}

impl Scored {
    /// Returns the plane with the lowest score among the planes of `candidates` pieces. Of equal planes,
    /// returns the earliest. The score depends on the counts and on whether the plane is perpendicular to an
    /// axis.
    pub(super) fn best(
        &mut self,
        set: &Set<'_>,
        candidates: usize,
        watch: &Watch<'_>,
        score: impl Fn(&Counts, bool) -> (f64, f64),
    ) -> PlaneId {
        let Self { sketch, tried } = self;
        sketch.reset(set);
        tried.clear();
        tried.reserve(candidates.min(set.len()));
        let planes = set.sample(candidates).map(|piece| (piece, sketch.plane(set, piece)));
        tried.extend(planes.map(|(piece, plane)| (piece, plane, Counts::default())));
        for start in (0..set.len()).step_by(PIECES_AT_ONCE) {
            let part = start..set.len().min(start + PIECES_AT_ONCE);
            if watch.work(part.len() * tried.len()).is_err() {
                break;
            }
            sketch.clear();
            sketch.extend(set, part.clone());
            for (_, plane, counts) in &mut *tried {
                *counts += sketch.count(plane, 0..part.len().div_ceil(LANES));
            }
        }
        let scores = tried.iter().map(|&(own, _, counts)| {
            let Piece { min, max, .. } = set.pieces[own];
            (score(&counts, (0..3).any(|axis| min[axis] == max[axis])), own)
        });
        let best = scores.min_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        set.own_plane(best.map_or(0, |(_, piece)| piece))
    }
}
