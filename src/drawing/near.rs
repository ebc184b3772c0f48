//! Points of the plane, from which the nearest to a place is found and removed.

use crate::Error;
use crate::memory::reserve;

/// Points in a k-d tree: the middle of each range of places parts the others, along one axis and then the
/// other, into those before it and those after. (J. L. Bentley, "Multidimensional binary search trees
/// used for associative searching", 1975.)
#[derive(Debug)]
pub(super) struct Ends {
    points: Vec<[f64; 2]>,
    /// The numbers of the points, place by place, and the place of each.
    numbers: Vec<u32>,
    places: Vec<u32>,
    /// Of the range whose middle is a place, how many points are left, and the box around all.
    counts: Vec<u32>,
    boxes: Vec<Extent>,
    /// Which places have a point that is left.
    is_left: Vec<bool>,
}

/// The least and the greatest coordinates of points.
#[derive(Clone, Copy, Debug)]
struct Extent {
    low: [f64; 2],
    high: [f64; 2],
}

impl Extent {
    fn around(points: impl Iterator<Item = [f64; 2]>) -> Self {
        let none = Self { low: [f64::MAX; 2], high: [f64::MIN; 2] };
        points.fold(none, |Self { low, high }, point| Self {
            low: [0, 1].map(|i: usize| low[i].min(point[i])),
            high: [0, 1].map(|i: usize| high[i].max(point[i])),
        })
    }

    fn distance(&self, from: [f64; 2]) -> f64 {
        let away = |i: usize| (self.low[i] - from[i]).max(from[i] - self.high[i]).max(0.0);
        away(0).hypot(away(1))
    }
}

/// A range of places, and the axis (0, 1 for x, y) along which its middle divides it.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: usize,
    high: usize,
    axis: usize,
}

impl Node {
    fn middle(self) -> usize {
        self.low.midpoint(self.high)
    }

    /// The ranges before and after the middle, none if empty.
    fn parts(self) -> [Option<Self>; 2] {
        let Self { low, high, axis } = self;
        let parts = [(low, self.middle()), (self.middle() + 1, high)];
        parts.map(|(low, high)| (low < high).then_some(Self { low, high, axis: 1 - axis }))
    }
}

impl Ends {
    pub(super) fn new(points: Vec<[f64; 2]>) -> Result<Self, Error> {
        let n = points.len();
        let (mut numbers, mut places, mut counts) = (Vec::new(), Vec::new(), Vec::new());
        for list in [&mut numbers, &mut places, &mut counts] {
            reserve(list, n)?;
        }
        let (mut is_left, mut boxes) = (Vec::new(), Vec::new());
        reserve(&mut is_left, n)?;
        reserve(&mut boxes, n)?;
        boxes.resize(n, Extent { low: [0.0; 2], high: [0.0; 2] });
        is_left.resize(n, true);
        numbers.extend(0..n as u32);
        places.resize(n, 0);
        counts.resize(n, 0);
        let mut stack: Vec<Node> = Vec::new();
        stack.extend((n > 0).then_some(Node { low: 0, high: n, axis: 0 }));
        while let Some(node) = stack.pop() {
            let Node { low, high, axis } = node;
            let along = |&number: &u32| points[number as usize][axis];
            numbers[low..high]
                .select_nth_unstable_by(node.middle() - low, |a, b| along(a).total_cmp(&along(b)));
            counts[node.middle()] = (high - low) as u32;
            boxes[node.middle()] =
                Extent::around(numbers[low..high].iter().map(|&number| points[number as usize]));
            stack.extend(node.parts().into_iter().flatten());
        }
        for (place, &number) in (0..).zip(&numbers) {
            places[number as usize] = place;
        }
        Ok(Self { points, numbers, places, counts, boxes, is_left })
    }

    fn root(&self) -> Option<Node> {
        let high = self.points.len();
        (high > 0).then_some(Node { low: 0, high, axis: 0 })
    }

    /// The number of the nearest point that is left; the first one found of several.
    pub(super) fn nearest(&self, from: [f64; 2]) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        // Ranges, and how far away their boxes are: the tree is never deeper than 32.
        let mut stack: Vec<(Node, f64)> = self.root().map(|root| (root, 0.0)).into_iter().collect();
        while let Some((node, least)) = stack.pop() {
            let middle = node.middle();
            if self.counts[middle] == 0 || best.is_some_and(|(found, _)| least >= found) {
                continue;
            }
            let number = self.numbers[middle];
            let point = self.points[number as usize];
            let distance = distance(point, from);
            if self.is_left[middle] && best.is_none_or(|(found, _)| distance < found) {
                best = Some((distance, number));
            }
            let parts = node
                .parts()
                .map(|part| part.map(|part| (part, self.boxes[part.middle()].distance(from))));
            // The nearer one is looked at first.
            let is_first_nearer =
                parts[0].map_or(f64::MAX, |part| part.1) < parts[1].map_or(f64::MAX, |part| part.1);
            let [near, far] = if is_first_nearer { [0, 1] } else { [1, 0] };
            stack.extend(parts[far].into_iter().chain(parts[near]));
        }
        best.map(|(_, number)| number)
    }

    /// Removes a point that is left.
    pub(super) fn remove(&mut self, number: u32) {
        let place = self.places[number as usize] as usize;
        self.is_left[place] = false;
        let mut next = self.root();
        while let Some(node) = next {
            self.counts[node.middle()] -= 1;
            let [before, after] = node.parts();
            next = match place.cmp(&node.middle()) {
                std::cmp::Ordering::Less => before,
                std::cmp::Ordering::Equal => None,
                std::cmp::Ordering::Greater => after,
            };
        }
    }
}

/// The distance of two points.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn the_nearest_is_the_nearest_of_all() {
        let mut random = SplitMix64::new(7);
        let mut dice = || random.next() >> 33;
        for n in [0, 1, 2, 3, 40, 500] {
            // Many of them in one place, or on one line.
            let points: Vec<[f64; 2]> =
                (0..n).map(|_| [0, 1].map(|_| (dice() % 23) as f64)).collect();
            let mut left: Vec<usize> = (0..n).collect();
            let mut ends = Ends::new(points.clone()).unwrap();
            while !left.is_empty() {
                let from = [0, 1].map(|_| (dice() % 300) as f64 / 10.0 - 3.0);
                let distance = |k: usize| (points[k][0] - from[0]).hypot(points[k][1] - from[1]);
                let least = left.iter().map(|&k| distance(k)).fold(f64::MAX, f64::min);
                let found = ends.nearest(from).unwrap() as usize;
                assert!(left.contains(&found) && distance(found) == least, "{found} of {n}");
                left.retain(|&k| k != found);
                ends.remove(found as u32);
            }
            assert_eq!(ends.nearest([0.0; 2]), None);
        }
    }
}
