//! Polylines for a pen: segments joined at their ends, and sorted to shorten pen travel.

use crate::Error;

/// Ends are rounded to a grid with this step, in pixels; equal grid points are one corner. Too small: lines
/// are interrupted at corners that two projections rounded differently. Too large: lines of a very fine mesh
/// lose their shape.
const GRID: f64 = 1.0 / 1024.0;
/// At a corner, at most this many segments are compared to find the straightest continuation. Too small:
/// lines turn where they could continue straight. Too large: corners of many segments take time.
const CHOICES: usize = 8;

/// A line through points, which a pen draws without being lifted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Polyline {
    /// The points, from one end to the other. The last point of a closed line equals the line's first point.
    pub points: Vec<[f64; 2]>,
    /// The indices, in the input, of the segments of the line, in drawing order. A line of n points has n − 1
    /// segments.
    pub segments: Vec<usize>,
}

impl Polyline {
    /// Returns the length of the polyline, in the unit of its points.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|ends| distance(ends[0], ends[1])).sum()
    }

    fn ends(&self) -> [[f64; 2]; 2] {
        [self.points.first(), self.points.last()].map(|end| end.copied().unwrap_or_default())
    }
}

impl AsRef<[[f64; 2]]> for Polyline {
    fn as_ref(&self) -> &[[f64; 2]] {
        &self.points
    }
}

/// Joins segments that share ends into as few polylines as possible, and sorts and directs them to shorten
/// pen travel.
///
/// For example, join [runs of edges](super::EdgeRun) of the same style:
///
/// ```
/// use binspace::drawing::{Hidden, VisibilityMap, polylines};
///
/// # fn lines(map: &VisibilityMap<'_>) -> Result<(), binspace::Error> {
/// let visible = map.edges(Hidden::Skip)?;
/// for line in polylines(visible.iter().map(|run| run.ends))? {
///     println!("pen down at {:?}, {} more points", line.points[0], line.segments.len());
/// }
/// # Ok(())
/// # }
/// ```
///
/// Each segment is drawn once. A line that is not closed begins and ends where an odd number of segments
/// meet: lines are Eulerian trails, found by Hierholzer's algorithm (1873). If a line can continue in several
/// ways, it continues with the straightest of a few segments. Two segments share an end if the two positions
/// are equal after rounding to a thousandth of a pixel. (So two ends that are closer together than that may
/// stay separate.) Segments with an infinite or NaN coordinate are left out.
///
/// The pen begins at (0, 0). The next line is always the line that has the end nearest to the pen. Takes
/// O(n log n) for n segments, unless ends are spread very unevenly.
///
/// # Errors
///
/// If there are 2³¹ segments or more.
pub fn polylines(
    segments: impl IntoIterator<Item = [[f64; 2]; 2]>,
) -> Result<Vec<Polyline>, Error> {
    let mut net = Net::default();
    for (number, ends) in segments.into_iter().enumerate() {
        if ends.as_flattened().iter().all(|c| c.is_finite()) {
            net.segments.push(Segment { number, ends, corners: [0; 2] });
        }
    }
    // Ends have numbers of 32 bits.
    if net.segments.len() > (u32::MAX / 2) as usize {
        return Err(Error::out_of_memory());
    }
    net.find_corners();
    let joined = net.trails();
    Ok(ordered(joined))
}

#[derive(Clone, Copy, Debug)]
struct Segment {
    number: usize,
    ends: [[f64; 2]; 2],
    corners: [u32; 2],
}

/// Segments, and the corners where their ends meet. End `2 s + e` is end `e` of segment `s`.
#[derive(Debug, Default)]
struct Net {
    segments: Vec<Segment>,
    /// The ends at all corners, one corner after another, and the start of each corner's ends.
    ends: Vec<u32>,
    begins: Vec<u32>,
    /// For each corner, the index in `ends` of the corner's first end that may be unused; and whether each
    /// segment is used.
    done: Vec<u32>,
    is_used: Vec<bool>,
    /// For each corner where an odd number of ends meet, another such corner, which a jump reaches without
    /// drawing.
    jumps: Vec<Option<u32>>,
}

/// A step of a trail: the corner that the step leads to, and the end where the step begins (`None` for a
/// jump).
type Step = (u32, Option<u32>);

impl Net {
    /// Numbers the places where ends meet.
    fn find_corners(&mut self) {
        let mut places: Vec<([i64; 2], u32)> = Vec::with_capacity(2 * self.segments.len());
        for (s, segment) in (0u32..).zip(&self.segments) {
            // Shifted, so that round numbers do not lie between two places of the grid.
            let place = |end: [f64; 2]| end.map(|c| (c / GRID + 0.3137).round() as i64);
            places.extend([0, 1].map(|e| (place(segment.ends[e as usize]), 2 * s + e)));
        }
        places.sort_unstable();
        let mut last = None;
        for &(place, end) in &places {
            if last != Some(place) {
                self.begins.push(self.ends.len() as u32);
                last = Some(place);
            }
            self.ends.push(end);
            let corner = self.begins.len() as u32 - 1;
            self.segments[end as usize / 2].corners[end as usize % 2] = corner;
        }
        self.done.extend_from_slice(&self.begins);
        self.begins.push(self.ends.len() as u32);
        self.is_used.resize(self.segments.len(), false);
        self.pair_odd_corners();
    }

    fn pair_odd_corners(&mut self) {
        let corners = self.done.len();
        self.jumps.resize(corners, None);
        let mut open = None;
        for corner in 0..corners {
            if (self.begins[corner + 1] - self.begins[corner]).is_multiple_of(2) {
                continue;
            }
            match open.take() {
                None => open = Some(corner),
                Some(other) => {
                    self.jumps[corner] = Some(other as u32);
                    self.jumps[other] = Some(corner as u32);
                }
            }
        }
    }

    /// Trails through all segments: circuits of segments and jumps, split at the jumps.
    fn trails(&mut self) -> Vec<Polyline> {
        let mut lines = Vec::new();
        let (mut path, mut circuit): (Vec<Step>, Vec<Step>) = (vec![], vec![]);
        let corners = self.done.len();
        // Odd corners come first, so that circuits there begin with a jump.
        for start in 0..2 * corners {
            circuit.clear();
            let jump = self.jumps[start % corners].take();
            let begin = match jump {
                Some(to) => to,
                None if start < corners => continue,
                None => (start - corners) as u32,
            };
            if jump.is_some() {
                self.jumps[begin as usize] = None;
            }
            path.push((begin, None));
            while let Some(&(corner, from)) = path.last() {
                match self.step(corner, from) {
                    Some(step) => path.push(step),
                    None => {
                        path.pop();
                        circuit.push((corner, from));
                    }
                }
            }
            circuit.reverse();
            self.part(&circuit, &mut lines);
        }
        lines
    }

    /// The next step from a corner that was reached from an end, or by a jump.
    fn step(&mut self, corner: u32, from: Option<u32>) -> Option<Step> {
        let at = corner as usize;
        let all = self.done[at]..self.begins[at + 1];
        let is_open = |&i: &u32| !self.is_used[self.ends[i as usize] as usize / 2];
        let open = all.clone().find(is_open);
        self.done[at] = open.unwrap_or(all.end);
        let choices = (self.done[at]..all.end).take(CHOICES).filter(is_open);
        let straightness = |&i: &u32| {
            let way = |end: u32| {
                let ends = self.segments[end as usize / 2].ends;
                let [a, b] = [ends[end as usize % 2], ends[1 - end as usize % 2]];
                [b[0] - a[0], b[1] - a[1]].map(|c| c / distance(a, b).max(GRID))
            };
            let next = way(self.ends[i as usize]);
            from.map(way).map_or(0.0, |before| before[0] * next[0] + before[1] * next[1])
        };
        let best = choices.max_by(|a, b| straightness(a).total_cmp(&straightness(b)));
        let Some(best) = best else {
            let to = self.jumps[at].take()?;
            self.jumps[to as usize] = None;
            return Some((to, None));
        };
        let end = self.ends[best as usize];
        let segment = &self.segments[end as usize / 2];
        self.is_used[end as usize / 2] = true;
        Some((segment.corners[1 - end as usize % 2], Some(end)))
    }

    /// Adds the lines of a circuit.
    fn part(&self, circuit: &[Step], lines: &mut Vec<Polyline>) {
        for steps in circuit.split(|(_, from)| from.is_none()).filter(|steps| !steps.is_empty()) {
            let mut line = Polyline { points: vec![], segments: vec![] };
            // The exact capacity, because there are many lines, and most are short.
            line.points.reserve_exact(steps.len() + 1);
            line.segments.reserve_exact(steps.len());
            for &(_, from) in steps {
                let end = from.unwrap_or_default() as usize;
                let segment = &self.segments[end / 2];
                if line.points.is_empty() {
                    line.points.push(segment.ends[end % 2]);
                }
                line.points.push(segment.ends[1 - end % 2]);
                line.segments.push(segment.number);
            }
            lines.push(line);
        }
    }
}

/// Sorts and directs lines to shorten pen travel.
fn ordered(mut lines: Vec<Polyline>) -> Vec<Polyline> {
    let mut ends = Vec::with_capacity(2 * lines.len());
    ends.extend(lines.iter().flat_map(Polyline::ends));
    let mut left = Ends::new(ends);
    let mut ordered = Vec::with_capacity(lines.len());
    let mut pen = [0.0; 2];
    while let Some(end) = left.nearest(pen) {
        let line = end as usize / 2;
        left.remove(2 * line as u32);
        left.remove(2 * line as u32 + 1);
        let mut line =
            std::mem::replace(&mut lines[line], Polyline { points: vec![], segments: vec![] });
        if end % 2 == 1 {
            line.points.reverse();
            line.segments.reverse();
        }
        pen = line.ends()[1];
        ordered.push(line);
    }
    ordered
}

/// Points in a k-d tree: the middle point of each range of places separates the others into lower and higher
/// points, along the two axes alternately. (J. L. Bentley, "Multidimensional binary search trees used for
/// associative searching", 1975.)
#[derive(Debug)]
pub(super) struct Ends {
    points: Vec<[f64; 2]>,
    /// The number of the point at each place, and the place of each point.
    numbers: Vec<u32>,
    places: Vec<u32>,
    /// For each place, the number of remaining points in the range whose middle is this place.
    counts: Vec<u32>,
    /// Whether the point of each place remains.
    is_left: Vec<bool>,
}

/// A range of places, and the axis (0, 1 for x, y) along which the middle divides the range.
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

    /// The ranges before and after the middle; `None` if empty.
    fn parts(self) -> [Option<Self>; 2] {
        let Self { low, high, axis } = self;
        let parts = [(low, self.middle()), (self.middle() + 1, high)];
        parts.map(|(low, high)| (low < high).then_some(Self { low, high, axis: 1 - axis }))
    }
}

impl Ends {
    pub(super) fn new(points: Vec<[f64; 2]>) -> Ends {
        let n = points.len();
        let mut numbers: Vec<u32> = (0..n as u32).collect();
        let (mut places, mut counts) = (vec![0; n], vec![0; n]);
        let mut stack: Vec<Node> = Vec::new();
        stack.extend((n > 0).then_some(Node { low: 0, high: n, axis: 0 }));
        while let Some(node) = stack.pop() {
            let Node { low, high, axis } = node;
            let along = |&number: &u32| points[number as usize][axis];
            numbers[low..high]
                .select_nth_unstable_by(node.middle() - low, |a, b| along(a).total_cmp(&along(b)));
            counts[node.middle()] = (high - low) as u32;
            stack.extend(node.parts().into_iter().flatten());
        }
        for (place, &number) in (0..).zip(&numbers) {
            places[number as usize] = place;
        }
        Self { points, numbers, places, counts, is_left: vec![true; n] }
    }

    fn root(&self) -> Option<Node> {
        let high = self.points.len();
        (high > 0).then_some(Node { low: 0, high, axis: 0 })
    }

    /// The number of the nearest remaining point. If several are nearest, the first that is found.
    pub(super) fn nearest(&self, from: [f64; 2]) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        // Ranges, each with a lower bound on the distance of its points. The stack stays short, because the
        // tree is never deeper than 32.
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
            let across = from[node.axis] - point[node.axis];
            let [before, after] = node.parts();
            let [near, far] = if across < 0.0 { [before, after] } else { [after, before] };
            // The nearer range is searched first.
            stack.extend(far.map(|far| (far, least.max(across.abs()))));
            stack.extend(near.map(|near| (near, least)));
        }
        best.map(|(_, number)| number)
    }

    /// Removes a remaining point.
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

/// The distance between two points.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod near_tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn the_nearest_is_the_nearest_of_all() {
        let mut random = SplitMix64::new(7);
        let mut dice = || random.next() >> 33;
        for n in [0, 1, 2, 3, 40, 500] {
            // Many points are in one place, or on one line.
            let points: Vec<[f64; 2]> =
                (0..n).map(|_| [0, 1].map(|_| (dice() % 23) as f64)).collect();
            let mut left: Vec<usize> = (0..n).collect();
            let mut ends = Ends::new(points.clone());
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
