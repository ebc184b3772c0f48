//! The best free plane of a set of pieces: perpendicular to an axis, through a corner.

use super::choose::{Counts, work};
use super::live::Live;
use crate::geom::{Faces, PlaneId};

/// Sorted coordinates, kept to be used again.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    minima: Vec<f64>,
    maxima: Vec<f64>,
    flat: Vec<f64>,
    candidates: Vec<f64>,
}

/// A free plane with its cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreePlane {
    pub(super) cost: f64,
    pub(super) axis: usize,
    pub(super) coordinate: f64,
}

impl Sweep {
    /// The free plane of least cost, if one has fewer pieces on each side than there are:
    /// O(n log n).
    pub(super) fn best(&mut self, pieces: &[Live], tolerance: f64) -> Option<FreePlane> {
        let mut best: Option<FreePlane> = None;
        for axis in 0..3 {
            self.sort(pieces, axis, tolerance);
            self.scan(pieces.len(), axis, tolerance, &mut best);
        }
        best
    }

    fn sort(&mut self, pieces: &[Live], axis: usize, tolerance: f64) {
        for list in [&mut self.minima, &mut self.maxima, &mut self.flat, &mut self.candidates] {
            list.clear();
        }
        for piece in pieces {
            let (min, max) = (piece.min[axis], piece.max[axis]);
            if max - min <= 2.0 * tolerance {
                self.flat.push(0.5 * (min + max));
            }
            self.minima.push(min);
            self.maxima.push(max);
            if piece.min_is_corner(axis) {
                self.candidates.push(min);
            }
            if piece.max_is_corner(axis) {
                self.candidates.push(max);
            }
        }
        for list in [&mut self.minima, &mut self.maxima, &mut self.flat, &mut self.candidates] {
            list.sort_unstable_by(f64::total_cmp);
        }
    }

    /// Walks the candidates upwards, with a finger in each list of ends: those of pieces within
    /// the tolerance of the plane count as not reaching beyond it.
    fn scan(&self, pieces: usize, axis: usize, tolerance: f64, best: &mut Option<FreePlane>) {
        let (mut ended, mut begun, mut flat_below, mut flat_above) = (0, 0, 0, 0);
        let mut last = f64::NAN;
        let least = work(pieces / 2) * 2.0;
        for &coordinate in &self.candidates {
            if coordinate == last {
                continue;
            }
            last = coordinate;
            ended += run(&self.maxima[ended..], |c| c <= coordinate + tolerance);
            begun += run(&self.minima[begun..], |c| c < coordinate - tolerance);
            let half = 0.5 * tolerance;
            flat_below += run(&self.flat[flat_below..], |c| c < coordinate - half);
            flat_above = flat_above.max(flat_below);
            flat_above += run(&self.flat[flat_above..], |c| c <= coordinate + half);
            let coplanar = flat_above - flat_below;
            // Behind and not in front; in front and not behind; both.
            let (back, front) = (ended - coplanar.min(ended), pieces - begun);
            let front = front - coplanar.min(front);
            let splits = pieces.saturating_sub(back + front + coplanar);
            let counts = Counts { front, back, splits };
            let progress = front + splits < pieces && back + splits < pieces;
            let hopeless =
                coplanar == 0 && best.is_some_and(|best| least + counts.price() >= best.cost);
            if progress && !hopeless {
                let cost = counts.cost();
                if best.is_none_or(|best| cost < best.cost) {
                    *best = Some(FreePlane { cost, axis, coordinate });
                }
            }
        }
    }
}

/// How many leading values a condition holds for.
fn run(values: &[f64], holds: impl Fn(f64) -> bool) -> usize {
    values.iter().take_while(|&&value| holds(value)).count()
}

impl FreePlane {
    /// The plane by the name of a corner on it.
    pub(super) fn id(&self, faces: &Faces, pieces: &[Live]) -> Option<PlaneId> {
        let (axis, c) = (self.axis, self.coordinate);
        let touches = |piece: &&Live| {
            piece.min[axis] == c && piece.min_is_corner(axis)
                || piece.max[axis] == c && piece.max_is_corner(axis)
        };
        let corner = pieces.iter().find(touches)?.corner_at(faces, axis, c)?;
        Some(PlaneId::axis(axis, corner))
    }
}
