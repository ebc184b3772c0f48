//! The order of paths: those that look alike follow one another where that changes nothing.

use std::collections::{BTreeMap, BinaryHeap};

use binspace::drawing::Path;

/// Paths that overlap by less than this, in pixels, may be painted in either order. Smaller: corners that
/// were rounded apart keep neighbours in order; larger: what is as narrow as that may show.
const THIN: f64 = 1e-3;
/// Outlines with more corners than this are taken for the boxes around them. Larger: time.
const MOST_CORNERS: usize = 64;
/// Pairs of paths that are looked at, for each path, before the order is left as it is. Larger: time and
/// memory where many large polygons lie on one another; smaller: longer files.
const MOST_PAIRS: usize = 400;

type Point = [f64; 2];

/// An order of paths in which those that overlap stay as they are, and those of equal looks come one
/// after another where they can.
pub(crate) fn by_fill<L: Ord>(paths: &[Path<'_>], looks: &[L], size: [u32; 2]) -> Vec<usize> {
    match overlaps(paths, size) {
        Some(pairs) => ordered(looks, &pairs),
        None => (0..paths.len()).collect(),
    }
}

/// Takes, again and again, what looks like the one before; if there is none such, what has the most alike
/// that can be painted now.
fn ordered<L: Ord>(looks: &[L], pairs: &[[u32; 2]]) -> Vec<usize> {
    let mut numbers: BTreeMap<&L, usize> = BTreeMap::new();
    let look: Vec<usize> = looks
        .iter()
        .map(|look| {
            let next = numbers.len();
            *numbers.entry(look).or_insert(next)
        })
        .collect();
    let n = looks.len();
    // How many paths below each are not painted yet, and which are above it.
    let mut below = vec![0u32; n];
    let mut above = vec![vec![]; n];
    for &[first, second] in pairs {
        below[second as usize] += 1;
        above[first as usize].push(second);
    }
    let mut ready = vec![vec![]; numbers.len()];
    for path in (0..n).rev().filter(|&path| below[path] == 0) {
        ready[look[path]].push(path);
    }
    // How many of each look can be painted, as it was when it was written down.
    let mut counts: BinaryHeap<(usize, usize)> =
        ready.iter().enumerate().map(|(look, paths)| (paths.len(), look)).collect();
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
                    ready[look[next]].push(next);
                    if look[next] != current {
                        counts.push((ready[look[next]].len(), look[next]));
                    }
                }
            }
        }
    }
    order
}

/// A path by its outlines, and the box around them.
struct Area {
    low: Point,
    high: Point,
    outlines: Vec<Vec<Point>>,
}

/// Pairs of paths that overlap, the lower one first; `None` if there are too many to look at.
fn overlaps(paths: &[Path<'_>], size: [u32; 2]) -> Option<Vec<[u32; 2]>> {
    let areas: Vec<Area> = paths.iter().map(area).collect();
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
                // The same pair is in other cells too: this is the first one.
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

fn area(path: &Path<'_>) -> Area {
    let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
    for (axis, c) in path.outlines().flatten().flat_map(|point| point.iter().enumerate()) {
        low[axis] = low[axis].min(*c);
        high[axis] = high[axis].max(*c);
    }
    let outlines = path.outlines().map(|outline| {
        if outline.len() <= MOST_CORNERS {
            outline.to_vec()
        } else {
            vec![low, [high[0], low[1]], high, [low[0], high[1]]]
        }
    });
    Area { low, high, outlines: outlines.collect() }
}

fn overlap(a: &Area, b: &Area) -> bool {
    let boxes = (0..2).all(|i| a.low[i] + THIN < b.high[i] && b.low[i] + THIN < a.high[i]);
    let apart = |p: &[Point], q: &[Point]| separates(p, q) || separates(q, p);
    boxes && a.outlines.iter().any(|p| b.outlines.iter().any(|q| !apart(p, q)))
}

/// Whether two outlines lie on two sides of a line along a side of the first one.
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
    fn what_overlaps_stays_in_order_and_the_rest_goes_by_looks() {
        // 0 below 2, 3 below 4.
        let looks = ["a", "b", "b", "a", "b"];
        assert_eq!(ordered(&looks, &[[0, 2], [3, 4]]), [0, 3, 4, 2, 1]);
        assert_eq!(ordered(&looks, &[[0, 1], [1, 3]]), [2, 4, 0, 1, 3]);
        assert_eq!(ordered(&looks[..0], &[]), [0usize; 0]);
    }

    #[test]
    fn outlines_that_touch_do_not_overlap() {
        let area = |outline: &[Point]| {
            let fold = |f: fn(f64, f64) -> f64| {
                [0, 1].map(|i: usize| outline.iter().map(|p| p[i]).reduce(f).unwrap())
            };
            Area { low: fold(f64::min), high: fold(f64::max), outlines: vec![outline.to_vec()] }
        };
        let left = area(&[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]);
        let right = area(&[[2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        let both = area(&[[0.0, 1.0], [2.0, 1.0], [1.0, 3.0]]);
        assert!(!overlap(&left, &right) && !overlap(&right, &left));
        assert!(overlap(&left, &both) && overlap(&both, &right));
        // One inside of the other.
        let small = area(&[[0.2, 0.2], [0.4, 0.2], [0.2, 0.4]]);
        assert!(overlap(&left, &small) && overlap(&small, &left) && !overlap(&right, &small));
    }
}
