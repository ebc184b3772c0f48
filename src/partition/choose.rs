//! Chooses the planes between cells: medians of samples (J. L. Bentley, "Multidimensional binary search trees
//! used for associative searching", 1975), along the axis of the samples' largest extent.

use super::{CellRange, Extent, Partition, SplitPlane};
use crate::error::{Error, Kind};
use crate::exact::faces::CellBox;
use crate::exact::{Faces, MAX_NAMES};
use crate::faces::{Precision, Tolerance, empty_faces};
use crate::input::Point;
use crate::memory::{push, reserve};

impl Partition {
    /// Divides a scene into `cells` cells with about equally many samples each. The grid includes `room`.
    /// O(samples · log cells).
    pub(crate) fn new<P: Point>(
        extent: &Extent,
        room: &Extent,
        tolerance: Tolerance,
        samples: impl IntoIterator<Item = P>,
        cells: usize,
    ) -> Result<Self, Error> {
        if cells > Self::MAX_CELLS {
            let problem = format!(
                "{cells} cells are too many: divide the scene into at most {}",
                Self::MAX_CELLS
            );
            return Err(Kind::Argument(problem).error());
        }
        let bounds = |&Extent { low, high, .. }: &Extent| {
            if low.cmpgt(high).any() { Default::default() } else { [low, high] }
        };
        let precision = Precision::new(extent.precision, bounds(extent));
        let mut whole = *extent;
        whole.merge(room);
        let bounds = bounds(&whole);
        let Faces { lattice, tolerance, .. } = empty_faces(bounds, tolerance, precision)?;
        let [low, high] = bounds.map(|corner| lattice.snap(corner));
        let mut points: Vec<[f64; 3]> = Vec::new();
        for (number, sample) in samples.into_iter().enumerate() {
            if number == MAX_NAMES {
                let problem =
                    format!("there are more than {MAX_NAMES} samples: pass only some of them");
                return Err(Kind::Argument(problem).error());
            }
            let point = sample.to_dvec3();
            // Samples only choose planes, so NaN and infinite samples are left out. Samples outside the scene count as on
            // its border: a plane there would leave a part without room for further planes.
            if point.is_finite() {
                let point = lattice.snap(point);
                push(&mut points, [0, 1, 2].map(|axis| point[axis].clamp(low[axis], high[axis])))?;
            }
        }
        let planes = planes(&mut points, [low, high], cells.max(1))?;
        Ok(Self { lattice, tolerance, planes })
    }
}

/// A subtree still to be divided: the range of its samples, and its box.
struct Samples {
    subtree: CellRange,
    samples: std::ops::Range<usize>,
    room: CellBox,
}

fn planes(samples: &mut [[f64; 3]], room: CellBox, cells: usize) -> Result<Vec<SplitPlane>, Error> {
    let mut planes = Vec::new();
    reserve(&mut planes, cells - 1)?;
    let subtree = CellRange { plane: 0, cells: 0..cells };
    let mut parts = vec![Samples { subtree, samples: 0..samples.len(), room }];
    while let Some(Samples { subtree, samples: range, room }) = parts.pop() {
        let count = subtree.cells.len();
        if count < 2 {
            continue;
        }
        let own = &mut samples[range.clone()];
        let plane = split_plane(own, &room, count);
        planes.push(plane);
        let behind = range.start + move_behind(own, plane);
        let [mut back_room, mut front_room] = [room; 2];
        (back_room[1][plane.axis], front_room[0][plane.axis]) = (plane.at, plane.at);
        let [back, front] = subtree.sides();
        parts.push(Samples { subtree: front, samples: behind..range.end, room: front_room });
        parts.push(Samples { subtree: back, samples: range.start..behind, room: back_room });
    }
    Ok(planes)
}

/// The plane that divides a box into two parts, for `count` cells in total. The plane contains a sample:
/// samples often are corners, and planes through corners cut fewer polygons. The plane does not depend on the
/// order of the samples.
fn split_plane(samples: &mut [[f64; 3]], room: &CellBox, count: usize) -> SplitPlane {
    let mut reach = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for sample in &*samples {
        for axis in 0..3 {
            reach[0][axis] = reach[0][axis].min(sample[axis]);
            reach[1][axis] = reach[1][axis].max(sample[axis]);
        }
    }
    let axis = longest(&reach);
    let least = reach[0][axis];
    // Without two different samples, use the middle.
    if samples.is_empty() || reach[1][axis] == least {
        let axis = longest(room);
        let middle = 0.5 * room[0][axis] + 0.5 * room[1][axis];
        return SplitPlane { axis, at: middle.round() + 0.0 };
    }
    let place = (samples.len() as u128 * (count / 2) as u128 / count as u128) as usize;
    let by_axis = |a: &[f64; 3], b: &[f64; 3]| a[axis].total_cmp(&b[axis]);
    let at = samples.select_nth_unstable_by(place, by_axis).1[axis];
    // If many samples are at the lower end, a plane at `at` would have no sample behind it: use the next
    // larger coordinate.
    let next = || {
        let above = samples.iter().map(|sample| sample[axis]).filter(|&c| c > least);
        above.fold(f64::INFINITY, f64::min)
    };
    SplitPlane { axis, at: if at > least { at } else { next() } }
}

/// The axis of a box's largest extent, the first of equals.
fn longest([low, high]: &CellBox) -> usize {
    let length = |axis: usize| high[axis] - low[axis];
    (1..3).fold(0, |best, axis| if length(axis) > length(best) { axis } else { best })
}

/// Moves the samples behind a plane to the beginning, and counts them.
fn move_behind(samples: &mut [[f64; 3]], plane: SplitPlane) -> usize {
    let mut behind = 0;
    for i in 0..samples.len() {
        if samples[i][plane.axis] < plane.at {
            samples.swap(i, behind);
            behind += 1;
        }
    }
    behind
}

#[cfg(test)]
mod tests {
    use crate::partition::Extent;
    use crate::{BuildOptions, ErrorKind};

    #[test]
    fn samples_that_do_not_end_are_an_error() {
        let mut extent = Extent::default();
        extent.include(&[[0.0; 3], [1.0; 3]]);
        // These samples are left out, so they take no memory.
        let samples = std::iter::repeat([f64::NAN; 3]);
        let error = BuildOptions::DEFAULT.partition(&extent, samples, 2).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
    }
}
