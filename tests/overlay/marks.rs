//! A mark on a curve is painted over both segments of the curve that meet there.

use std::collections::HashSet;
use testkit::prelude::*;

use binspace::overlay::{Overlay, Shape, Shapes};

/// Half the side of the grid.
const ROOM: f64 = 64.0;
/// Different corners of a curve.
const CORNERS: usize = 8;

/// A line, and points at every second corner. Two consecutive corners have no points, because one plane
/// cannot contain the segments at both.
struct Curve {
    corners: Vec<DVec3>,
    marks: Vec<Mark>,
}

/// A point, and the numbers of the segments that end and begin there.
struct Mark {
    at: DVec3,
    arriving: usize,
    leaving: usize,
}

impl Curve {
    /// Creates a curve with random corners. Each corner may be repeated up to `most` times in a row. A closed
    /// curve ends with its first corner.
    fn new(dice: &mut Dice, is_closed: bool, most: usize) -> Self {
        let mut any = |size: f64| dice.point(-0.5, 0.5) * size;
        let middle = any(60.0);
        let distinct: Vec<DVec3> = (0..CORNERS).map(|_| middle + any(40.0)).collect();
        let (mut corners, mut numbers) = (Vec::new(), Vec::new());
        for k in 0..CORNERS + usize::from(is_closed) {
            corners.extend((0..1 + dice.below(most)).map(|_| distinct[k % CORNERS]));
            // The next segment begins at the last repetition.
            numbers.push(corners.len() - 1);
        }
        let marked = if is_closed { 0..CORNERS } else { 1..CORNERS - 1 };
        let mark = |k: usize| Mark {
            at: distinct[k],
            arriving: numbers[(k + CORNERS - 1) % CORNERS],
            leaving: numbers[k],
        };
        Self { corners, marks: marked.step_by(2).map(mark).collect() }
    }
}

fn tree_of_nothing() -> BspTree {
    let bounds = DVec3::splat(ROOM);
    let options = BuildOptions::DEFAULT.with_tolerance(0.0).with_bounds(-bounds, bounds);
    options.build(Vec::<Vec<DVec3>>::new()).expect("a tree of nothing")
}

/// Returns the number of marks that came after both of their segments: all, from all eyes.
fn compare(curves: &[Curve], dice: &mut Dice) -> usize {
    let tree = tree_of_nothing();
    let mut overlay = Overlay::new(&tree);
    let named: Vec<(usize, &Mark)> = (0..curves.len())
        .flat_map(|line| curves[line].marks.iter().map(move |mark| (line, mark)))
        .collect();
    let shapes = Shapes::NONE.with_lines(curves.iter().map(|curve| &curve.corners));
    let shapes = shapes.with_points(named.iter().map(|(_, mark)| mark.at));
    overlay.replace_with(&tree, shapes).expect("on the grid");
    let mut compared = 0;
    for _ in 0..5 {
        let eye = [0; 3].map(|_| 20.4 * dice.around_zero(3));
        let order = overlay.order(&tree, Viewpoint::eye(eye)).expect("its own tree");
        let mut painted = HashSet::new();
        for shape in order {
            match shape {
                Shape::Segment(piece) => {
                    let ends = [0.0, 1.0].into_iter().enumerate();
                    let ends = ends.filter(|(_, share)| piece.shares().contains(share));
                    painted.extend(ends.map(|(end, _)| (piece.line(), piece.number(), end)));
                }
                Shape::Marker(marker) => {
                    let (line, mark) = named[marker.point()];
                    for segment in [(line, mark.arriving, 1), (line, mark.leaving, 0)] {
                        assert!(painted.contains(&segment), "{segment:?} is not painted yet");
                        compared += 1;
                    }
                }
                _ => unreachable!(),
            }
        }
    }
    compared
}

fn check(is_closed: bool, most: usize) {
    let mut compared = 0;
    for seed in seeds(12) {
        let mut dice = Dice(seed);
        let curves: Vec<Curve> = (0..20).map(|_| Curve::new(&mut dice, is_closed, most)).collect();
        compared += compare(&curves, &mut dice);
    }
    assert!(compared >= 12 * 20 * 3 * 2 * 5, "{compared}");
}

#[test]
fn a_point_at_a_corner_of_a_line_comes_after_the_segments_there() {
    check(false, 1);
}

#[test]
fn a_point_at_a_repeated_corner_comes_after_the_segments_there() {
    check(false, 3);
}

#[test]
fn a_point_where_a_line_closes_comes_after_the_segments_there() {
    check(true, 1);
    check(true, 3);
}

/// Thousands of points in one place, where thousands of segments meet: the progress calls count the examined
/// pieces, which are fewer than all pairs of a point and a segment.
#[test]
fn the_work_at_points_where_many_segments_meet_is_not_quadratic() {
    let tree = tree_of_nothing();
    let mut overlay = Overlay::new(&tree);
    let many = 4000;
    let mut dice = Dice(7);
    let mut any = |size: f64| dice.point(-0.5, 0.5) * size;
    let at = dvec3(1.0, 2.0, 3.0);
    let rays: Vec<[DVec3; 2]> = (0..many).map(|_| [at, any(60.0)]).collect();
    let reversed: Vec<[DVec3; 2]> = rays.iter().map(|&[from, to]| [to, from]).collect();
    let through: Vec<[DVec3; 3]> = (0..many).map(|_| [any(60.0), at, any(60.0)]).collect();
    let flower: Vec<DVec3> = rays.iter().flatten().copied().collect();
    let mut calls = |lines: &[&[DVec3]]| {
        let shapes = Shapes::NONE.with_lines(lines.iter().copied());
        let shapes = shapes.with_points((0..many).map(|_| at));
        let mut calls = 0;
        let count = |_| {
            calls += 1;
            std::ops::ControlFlow::Continue(())
        };
        overlay.replace_with_progress(&tree, shapes, count).expect("on the grid");
        assert!(overlay.len() >= 2 * many);
        calls
    };
    fn slices<const N: usize>(lines: &[[DVec3; N]]) -> Vec<&[DVec3]> {
        lines.iter().map(|line| &line[..]).collect()
    }
    for lines in [slices(&rays), slices(&reversed), slices(&through), vec![&flower[..]]] {
        // Each call stands for 65 536 examined pieces. Quadratic work would be 244 calls or more; n log n is
        // 3 calls.
        let calls = calls(&lines);
        assert!(calls < 40, "{calls} calls for {} lines", lines.len());
    }
}
