//! Lines for a pen, compared with graphs and exhaustive searches.

use super::map_of;
use binspace::drawing::{Polyline, polylines};
use binspace::internals::cuboid;
use testkit::prelude::*;

type Segment = [[f64; 2]; 2];

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The distance that a pen travels between the segments or lines that it draws, from (0, 0).
fn travel<'p>(lines: impl Iterator<Item = &'p [[f64; 2]]>) -> f64 {
    let mut pen = [0.0; 2];
    let mut sum = 0.0;
    for points in lines {
        sum += distance(pen, points[0]);
        pen = points[points.len() - 1];
    }
    sum
}

/// The least number of lines that draw all segments of a small grid.
fn fewest(segments: &[Segment]) -> usize {
    let mut corners: Vec<[u64; 2]> =
        segments.iter().flatten().map(|end| end.map(f64::to_bits)).collect();
    corners.sort_unstable();
    corners.dedup();
    let place = |end: [f64; 2]| corners.binary_search(&end.map(f64::to_bits)).unwrap();
    let mut net: Vec<usize> = (0..corners.len()).collect();
    let mut ends = vec![0; corners.len()];
    for &[a, b] in segments {
        let [a, b] = [place(a), place(b)];
        ends[a] += 1;
        ends[b] += 1;
        let (old, new) = (net[a], net[b]);
        net.iter_mut().filter(|n| **n == old).for_each(|n| *n = new);
    }
    let odd = |name: usize| (0..net.len()).filter(|&c| net[c] == name && ends[c] % 2 == 1).count();
    let mut names = net.clone();
    names.sort_unstable();
    names.dedup();
    names.into_iter().map(|name| (odd(name) / 2).max(1)).sum()
}

/// Each segment is drawn once, and lines follow one another from nearest end to nearest end.
fn check(segments: &[Segment], lines: &[Polyline]) {
    let mut drawn: Vec<usize> = lines.iter().flat_map(|line| line.segments.clone()).collect();
    drawn.sort_unstable();
    assert_eq!(drawn, (0..segments.len()).collect::<Vec<_>>());
    for line in lines {
        assert_eq!(line.points.len(), line.segments.len() + 1);
        let steps = line.points.windows(2).map(|ends| distance(ends[0], ends[1])).sum::<f64>();
        assert_eq!(line.length(), steps);
        for (ends, &segment) in line.points.windows(2).zip(&line.segments) {
            let [a, b] = segments[segment];
            let is = |from, to| distance(ends[0], from) + distance(ends[1], to) < 1e-9;
            assert!(is(a, b) || is(b, a), "{line:?} {a:?} {b:?}");
        }
    }
    let mut pen = [0.0; 2];
    for (i, line) in lines.iter().enumerate() {
        let start = |line: &Polyline| distance(pen, line.points[0]);
        let end = |line: &Polyline| distance(pen, line.points[line.points.len() - 1]);
        assert!(lines[i..].iter().all(|other| start(other).min(end(other)) >= start(line)));
        pen = line.points[line.points.len() - 1];
    }
}

#[test]
fn lines_are_as_few_as_can_be_and_travel_is_short() {
    let mut dice = Dice(20);
    let (mut lines_found, mut several, mut compared) = (0, 0, 0);
    let [mut before, mut after] = [0.0; 2];
    for round in 0..times(300) {
        let side = [3, 6, 40][round % 3];
        let count = 1 + dice.roll() % [8, 60, 200][round / 3 % 3];
        let mut end = || [0, 1].map(|_| (dice.roll() % side) as f64 / 7.0);
        let mut segments: Vec<Segment> = (0..count).map(|_| [end(), end()]).collect();
        // Segments without length are left out: their lines would have no length.
        segments.retain(|[a, b]| a != b);
        let lines = polylines(segments.iter().copied()).unwrap();
        check(&segments, &lines);
        assert_eq!(lines.len(), fewest(&segments), "{segments:?}");
        lines_found += lines.len();
        several += usize::from(lines.len() > 1);
        compared += segments.len();
        before += travel(segments.iter().map(|segment| &segment[..]));
        after += travel(lines.iter().map(|line| &line.points[..]));
    }
    enough!(lines_found > 2_000, several > 150, compared > 10_000; "{lines_found} {several}");
    assert!(after < 0.2 * before, "{after} of {before}");
}

#[test]
fn the_straightest_way_is_taken() {
    // Two long lines that cross in a common corner.
    let point = |x: f64, y: f64| [x, y];
    let arms = [point(0.0, 1.0), point(2.0, 1.0), point(1.0, 0.0), point(1.0, 2.0)];
    let lines = polylines(arms.map(|arm| [arm, point(1.0, 1.0)])).unwrap();
    let found: Vec<_> = lines.iter().map(|line| &line.points[..]).collect();
    assert_eq!(found.len(), 2);
    for points in found {
        let [a, b] = [points[0], points[2]];
        assert!(a[0] == b[0] || a[1] == b[1], "{points:?}");
    }
}

#[test]
fn ends_that_were_rounded_apart_are_common_and_no_numbers_are_left_out() {
    let (nan, far) = (f64::NAN, f64::INFINITY);
    let segments = [
        [[nan, 0.0], [1.0, 1.0]],
        [[1.0, 1.0], [2.0, 1.0]],
        [[1.0, far], [2.0, 1.0]],
        [[2.000_000_01, 0.999_999_99], [7.0, 7.0]],
        [[1e300, -1e300], [7.0, 7.0]],
    ];
    let lines = polylines(segments).unwrap();
    let found: Vec<_> = lines.iter().map(|line| &line.segments[..]).collect();
    assert_eq!(found, [[1, 3, 4]]);
    assert_eq!(polylines([]).unwrap(), []);
}

#[test]
fn a_cube_is_two_lines() {
    let tree = BspTree::build(cuboid(-DVec3::ONE, DVec3::ONE)).unwrap();
    let eye = DVec3::new(4.0, 3.0, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.9, [300, 200]).unwrap();
    let map = map_of(&tree, &camera);
    let runs = map.edges(Hidden::Keep).unwrap();
    let visible: Vec<Segment> =
        runs.iter().filter(|run| run.is_visible).map(|run| run.ends).collect();
    let lines = polylines(visible.iter().copied()).unwrap();
    check(&visible, &lines);
    // Three edges meet in the nearest corner, and in three of the six around it.
    assert_eq!((visible.len(), lines.len()), (9, 2));
}

/// A fan of many segments at one corner, and a chain of many segments, on a thread with a small stack.
#[test]
fn corners_of_many_and_long_lines_take_no_stack() {
    let spread = std::thread::Builder::new().stack_size(1 << 18).spawn(|| {
        let fan = (0..40_000).map(|k| [[0.0, 0.0], [f64::from(k), 5.0]]);
        let chain = (0..40_000).map(|k| [[f64::from(k), 9.0], [f64::from(k + 1), 9.0]]);
        let lines = polylines(fan.chain(chain)).unwrap();
        assert_eq!(lines.len(), 20_001);
    });
    spread.unwrap().join().unwrap();
}
