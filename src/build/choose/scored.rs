//! The best of a sample of own planes by a score.

use super::cost::Counts;
use super::set::Set;
use super::sketch::{LANES, Sketch, SketchPlane};
use crate::Error;
use crate::build::progress::{PIECES_AT_ONCE, Watch};
use crate::exact::PlaneId;
use crate::memory::reserve;

/// Tries own planes; its lists are kept to be used again.
#[derive(Debug, Default)]
pub(super) struct Scored {
    sketch: Sketch,
    tried: Vec<Tried>,
}

/// A piece whose plane is tried, and how that divides the set.
#[derive(Debug)]
struct Tried {
    piece: usize,
    plane: SketchPlane,
    counts: Counts,
}

impl Scored {
    /// The best plane of `candidates` pieces by a score of the counts and of whether the plane is
    /// perpendicular to an axis, lower being better; the earliest of equals.
    pub(super) fn best(
        &mut self,
        set: &Set<'_>,
        candidates: usize,
        watch: &Watch<'_>,
        score: impl Fn(&Counts, bool) -> (f64, f64),
    ) -> Result<PlaneId, Error> {
        let Self { sketch, tried } = self;
        sketch.reset(set);
        tried.clear();
        reserve(tried, candidates.min(set.len()))?;
        tried.extend(set.sample(candidates).map(|piece| Tried {
            piece,
            plane: sketch.plane(set, piece),
            counts: Counts::default(),
        }));
        for start in (0..set.len()).step_by(PIECES_AT_ONCE) {
            let part = start..set.len().min(start + PIECES_AT_ONCE);
            if watch.work(part.len() * tried.len()).is_err() {
                break;
            }
            sketch.clear();
            sketch.extend(set, part.clone())?;
            for Tried { plane, counts, .. } in &mut *tried {
                *counts += sketch.count(plane, 0..part.len().div_ceil(LANES));
            }
        }
        let score = |tried: &Tried| {
            let piece = &set.pieces[tried.piece];
            score(&tried.counts, (0..3).any(|axis| piece.min[axis] == piece.max[axis]))
        };
        let scores = tried.iter().map(|tried| (score(tried), tried.piece));
        let best = scores.min_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        Ok(set.own_plane(best.map_or(0, |(_, piece)| piece)))
    }
}
