//! Moves paths of one style next to one another.

use std::collections::{BTreeMap, BinaryHeap};

use super::paths::{Drawing, Path};

type Point = [f64; 2];

/// Paths that overlap by less than this, in pixels, may be painted in either order. Too small: neighbours
/// keep their order only because corners were rounded differently. Too large: overlaps of this width may be
/// visible.
const THIN: f64 = 1e-3;
/// Outlines with more corners than this are replaced by the boxes around them. Too small: fewer paths move.
/// Too large: more time.
const MOST_COMPARED_CORNERS: usize = 64;
/// If more pairs than this per path have to be compared, the order stays the same. Too small: longer files.
/// Too large: time and memory where many large polygons overlap.
const MOST_PAIRS: usize = 400;

impl Drawing {
    /// Moves paths with equal keys next to one another if that does not change the picture.
    ///
    /// `key` returns the key of the polygon with a given number, for example its colour. Paths that overlap
    /// keep their order, and no path moves across a line or a point of an [overlay](Self::display_list).
    /// Files are shorter if consecutive paths share a colour, and a plotter changes its pen less often.
    /// [`VectorPicture::add_drawing`](super::VectorPicture::add_drawing) batches drawings without strokes
    /// automatically.
    ///
    /// The order is a greedy topological order. Several paths may be possible as the next path. If one of
    /// them has the key of the previous path, it is the next path. Otherwise, the next path has the most
    /// frequent key among the possible paths. Takes O(n log n + k) for n paths and k pairs of overlapping
    /// paths. If more than about 400 n pairs of bounding boxes overlap, nothing moves.
    #[must_use]
    pub fn batched<K: Ord>(&self, key: impl Fn(usize) -> K) -> Self {
        let paths: Vec<Path<'_>> = self.paths().collect();
        let keys: Vec<K> = paths.iter().map(|path| key(path.polygon())).collect();
        let mut batched = self.clone();
        batched.paths.clear();
        let mut start = 0;
        let ends = self.overlaid.iter().map(|&(below, _)| below as usize).chain([paths.len()]);
        for end in ends.map(|end| end.min(paths.len())) {
            let here = &paths[start.min(end)..end];
            let order = match overlaps(here, self.size) {
                Some(pairs) => ordered(&keys[start.min(end)..end], &pairs),
                None => (0..here.len()).collect(),
            };
            batched.paths.extend(order.into_iter().map(|path| here[path].record.clone()));
            start = start.max(end);
        }
        batched
    }
}

/// An order of paths, given their keys and the pairs of a lower and an upper path that have to keep their
/// order.
fn ordered<K: Ord>(keys: &[K], pairs: &[[u32; 2]]) -> Vec<usize> {
    let mut numbers: BTreeMap<&K, usize> = BTreeMap::new();
    let numbered = keys.iter().map(|key| {
        let next = numbers.len();
        *numbers.entry(key).or_insert(next)
    });
    let kinds: Vec<usize> = numbered.collect();
    let n = keys.len();
    // For each path, the number of paths below it that are not in the order yet, and the paths above it.
    let mut below = vec![0u32; n];
    let mut above = vec![vec![]; n];
    for &[first, second] in pairs {
        below[second as usize] += 1;
        above[first as usize].push(second);
    }
    let mut ready = vec![vec![]; numbers.len()];
    for path in (0..n).rev().filter(|&path| below[path] == 0) {
        ready[kinds[path]].push(path);
    }
    // The number of paths of each kind that can be next. Entries may be out of date.
    let mut counts: BinaryHeap<(usize, usize)> =
        ready.iter().enumerate().map(|(kind, paths)| (paths.len(), kind)).collect();
    let mut order = Vec::with_capacity(n);
    while let Some((count, current)) = counts.pop() {
        if ready[current].is_empty() {
            continue;
        }
        if ready[current].len() != count {
            counts.push((ready[current].len(), current));
            continue;
        }
        while let Some(path) = ready[current].pop() {
            order.push(path);
            for &next in &above[path] {
                let next = next as usize;
                below[next] -= 1;
                if below[next] == 0 {
                    ready[kinds[next]].push(next);
                    if kinds[next] != current {
                        counts.push((ready[kinds[next]].len(), kinds[next]));
                    }
                }
            }
        }
    }
    order
}

/// The outlines of a path that are compared with other paths, and the box around them.
struct BoxedPath {
    low: Point,
    high: Point,
    outlines: Vec<Vec<Point>>,
}

/// Pairs of paths that overlap, the lower path first; `None` if there are too many pairs to compare.
fn overlaps(paths: &[Path<'_>], size: [u32; 2]) -> Option<Vec<[u32; 2]>> {
    let areas: Vec<BoxedPath> = paths.iter().map(area).collect();
    let [width, height] = size.map(f64::from);
    let cell = (width * height / areas.len().max(1) as f64).sqrt().max(1.0);
    let [columns, rows] = [width, height].map(|side| (side / cell) as usize + 1);
    let place = |c: f64, most: usize| ((c / cell).max(0.0) as usize).min(most - 1);
    let mut cells: Vec<Vec<u32>> = vec![vec![]; columns * rows];
    let (mut entries, most) = (0, MOST_PAIRS * areas.len());
    for (number, area) in areas.iter().enumerate() {
        let [left, right] = [area.low, area.high].map(|corner| place(corner[0], columns));
        for row in place(area.low[1], rows)..=place(area.high[1], rows) {
            entries += right - left + 1;
            if entries > most {
                return None;
            }
            (left..=right).for_each(|column| cells[row * columns + column].push(number as u32));
        }
    }
    let (mut pairs, mut looked_at) = (Vec::new(), 0);
    for (here, cell) in cells.iter().enumerate() {
        looked_at += cell.len() * cell.len() / 2;
        if looked_at > most {
            return None;
        }
        for (i, &second) in cell.iter().enumerate() {
            for &first in &cell[..i] {
                let [a, b] = [first, second].map(|number| &areas[number as usize]);
                // The same pair is in other cells too: only the first cell counts.
                let corner = [0, 1].map(|axis: usize| a.low[axis].max(b.low[axis]));
                let is_first = here == place(corner[1], rows) * columns + place(corner[0], columns);
                if is_first && overlap(a, b) {
                    pairs.push([first, second]);
                }
            }
        }
    }
    Some(pairs)
}

fn area(path: &Path<'_>) -> BoxedPath {
    let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
    for (axis, c) in path.outlines().flatten().flat_map(|point| point.iter().enumerate()) {
        low[axis] = low[axis].min(*c);
        high[axis] = high[axis].max(*c);
    }
    let outlines = path.outlines().map(|outline| {
        if outline.len() <= MOST_COMPARED_CORNERS {
            outline.to_vec()
        } else {
            vec![low, [high[0], low[1]], high, [low[0], high[1]]]
        }
    });
    BoxedPath { low, high, outlines: outlines.collect() }
}

fn overlap(a: &BoxedPath, b: &BoxedPath) -> bool {
    let boxes = (0..2).all(|i| a.low[i] + THIN < b.high[i] && b.low[i] + THIN < a.high[i]);
    let apart = |p: &[Point], q: &[Point]| separates(p, q) || separates(q, p);
    boxes && a.outlines.iter().any(|p| b.outlines.iter().any(|q| !apart(p, q)))
}

/// Whether a side of the first outline separates the two outlines (for convex outlines: the separating axis
/// theorem).
fn separates(sides: &[Point], other: &[Point]) -> bool {
    (0..sides.len()).any(|i| {
        let [from, to] = [sides[i], sides[(i + 1) % sides.len()]];
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        let across = |point: &Point| {
            (way[0] * (point[1] - from[1]) - way[1] * (point[0] - from[0])) / length
        };
        let span = |outline: &[Point]| {
            outline
                .iter()
                .map(across)
                .fold((f64::MAX, f64::MIN), |(low, high), c| (low.min(c), high.max(c)))
        };
        let (own, others) = (span(sides), span(other));
        length > 0.0 && (own.1 <= others.0 + THIN || others.1 <= own.0 + THIN)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_that_overlap_stay_in_order_and_others_go_by_keys() {
        // Path 0 is below path 2, and 3 below 4.
        let keys = ["a", "b", "b", "a", "b"];
        assert_eq!(ordered(&keys, &[[0, 2], [3, 4]]), [0, 3, 4, 2, 1]);
        assert_eq!(ordered(&keys, &[[0, 1], [1, 3]]), [2, 4, 0, 1, 3]);
        assert_eq!(ordered(&keys[..0], &[]), [0usize; 0]);
    }

    #[test]
    fn outlines_that_touch_do_not_overlap() {
        let area = |outline: &[Point]| {
            let fold = |f: fn(f64, f64) -> f64| {
                [0, 1].map(|i: usize| outline.iter().map(|p| p[i]).reduce(f).unwrap())
            };
            BoxedPath {
                low: fold(f64::min),
                high: fold(f64::max),
                outlines: vec![outline.to_vec()],
            }
        };
        let left = area(&[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]);
        let right = area(&[[2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        let both = area(&[[0.0, 1.0], [2.0, 1.0], [1.0, 3.0]]);
        assert!(!overlap(&left, &right) && !overlap(&right, &left));
        assert!(overlap(&left, &both) && overlap(&both, &right));
        // One outline inside the other.
        let small = area(&[[0.2, 0.2], [0.4, 0.2], [0.2, 0.4]]);
        assert!(overlap(&left, &small) && overlap(&small, &left) && !overlap(&right, &small));
    }
}
