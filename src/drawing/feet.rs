//! Lines of the picture found by where they are.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::rounded::Rounded;
use super::table::Table;
use crate::Error;

/// The point of a line that is next to the middle of the picture, and the cosine of twice the line's angle:
/// the same for both directions. Of a line that the picture shows, they are off by less than a
/// [`MARGIN`] of a [`STEP`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    point: [f64; 2],
    cosine: f64,
}

/// The numbers of lines, by their feet; those of one place in an order of lines that is exact: in a picture that
/// shows a scene from very far, all are in one place.
#[derive(Debug, Default)]
pub(super) struct Feet(Table<Place, SmallVec<[u32; 2]>>);

type Place = [i64; 3];

/// Places are so large, in pixels and of the cosine. Too small: feet of one line are in several; too large: more
/// lines are compared in integers.
const STEP: f64 = 1.0 / (1u64 << 20) as f64;
/// Feet are looked for in neighbouring places if they are nearer to these than this share of a step. (Values of lines
/// that the picture shows are off by less than 2⁻³¹ pixels, feet by less than four times as much: 2⁻⁹ of a
/// step.)
const MARGIN: f64 = 1.0 / 256.0;

impl Foot {
    /// That of a line in a picture of this size.
    pub(super) fn of(line: &Rounded, size: [f64; 2]) -> Self {
        let [_, kx, ky] = line.k;
        let middle = size.map(|side| 0.5 * side);
        let square = kx * kx + ky * ky;
        let off = line.at(middle) / square;
        let point = [middle[0] - off * kx, middle[1] - off * ky];
        Self { point, cosine: (kx * kx - ky * ky) / square }
    }

    fn numbers(&self) -> [f64; 3] {
        [self.point[0], self.point[1], self.cosine]
    }

    fn place(&self) -> Place {
        self.numbers().map(step_of)
    }

    /// The places where a line may be whose foot this is.
    fn places(&self) -> impl Iterator<Item = Place> {
        let [xs, ys, cosines] = self.numbers().map(|number| {
            let [low, high] = [-STEP, STEP].map(|step| step_of(number + step * MARGIN));
            std::iter::once(low).chain((high != low).then_some(high))
        });
        let planes = xs.flat_map(move |x| ys.clone().map(move |y| [x, y]));
        planes.flat_map(move |[x, y]| cosines.clone().map(move |c| [x, y, c]))
    }
}

impl Feet {
    /// The line with this foot that a comparison of lines with another one says is the same; or else where to
    /// [`add`](Self::add) that one.
    pub(super) fn search(
        &self,
        foot: &Foot,
        compare: impl Fn(u32) -> Ordering,
    ) -> Result<u32, usize> {
        let mut free = 0;
        for place in foot.places() {
            let Some(lines) = self.0.get(&place) else { continue };
            match lines.binary_search_by(|&line| compare(line)) {
                Ok(at) => return Ok(lines[at]),
                Err(at) if place == foot.place() => free = at,
                Err(_) => {}
            }
        }
        Err(free)
    }

    /// Adds a line that was sought without success.
    pub(super) fn add(&mut self, foot: &Foot, at: usize, line: u32) -> Result<(), Error> {
        self.0.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        let lines = self.0.entry(foot.place()).or_default();
        lines.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        lines.insert(at, line);
        Ok(())
    }
}

fn step_of(number: f64) -> i64 {
    (number / STEP).floor() as i64
}
