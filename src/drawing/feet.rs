//! Lines of the picture found by where they are.

use super::rounded::Rounded;
use super::table::{Table, insert};
use crate::Error;

/// The point of a line that is next to the middle of the picture, and the cosine of twice the line's angle:
/// the same for both directions. Of a line that the picture shows, they are off by far less than [`STEP`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    point: [f64; 2],
    cosine: f64,
}

/// The numbers of lines, by their feet.
#[derive(Debug, Default)]
pub(super) struct Feet(Table<[i64; 4], u32>);

/// Lines are looked up by their feet in such steps, in pixels and of the cosine, among so many of one place at
/// most; one that is missed is a line of its own. (Few are so near to one another in most pictures, but all
/// are in one that shows a scene from very far.)
const STEP: f64 = 1.0 / (1u64 << 20) as f64;
const SAME: i64 = 8;

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
}

impl Feet {
    /// The lines whose feet may be the same.
    pub(super) fn near(&self, foot: &Foot) -> impl Iterator<Item = u32> {
        let [xs, ys, cosines] = foot.numbers().map(|number| {
            let [low, high] = [-STEP, STEP].map(|step| step_of(number + step / 256.0));
            std::iter::once(low).chain((high != low).then_some(high))
        });
        let planes = xs.flat_map(move |x| ys.clone().map(move |y| [x, y]));
        let places = planes.flat_map(move |[x, y]| cosines.clone().map(move |c| [x, y, c]));
        places.flat_map(move |[x, y, c]| {
            (0..SAME).map_while(move |n| self.0.get(&[x, y, c, n]).copied())
        })
    }

    /// Adds a line, unless there are too many of its place.
    pub(super) fn add(&mut self, foot: &Foot, line: u32) -> Result<(), Error> {
        let [x, y, cosine] = foot.numbers().map(step_of);
        let mut places = (0..SAME).map(|number| [x, y, cosine, number]);
        match places.find(|place| !self.0.contains_key(place)) {
            Some(free) => insert(&mut self.0, free, line),
            None => Ok(()),
        }
    }
}

fn step_of(number: f64) -> i64 {
    (number / STEP).floor() as i64
}
