//! Crossings of polygons, by hand; `hidden_crossings` compares them with rays.

use super::{map_of, map_with};
use binspace::drawing::{EdgeKind, EdgeRun};
use testkit::prelude::*;
use testkit::scenes::triangles;
use testkit::shapes::rectangle;

/// A tree by each heuristic, and one of a frame.
fn trees<P: Polygon>(polygons: &[P]) -> Vec<(String, BspTree)> {
    testkit::scenes::trees(polygons, BuildOptions::DEFAULT)
}

fn crossings(tree: &BspTree, camera: &Camera) -> Vec<EdgeRun> {
    map_of(tree, camera).crossings(Hidden::Skip).unwrap()
}

/// An edge of a third polygon lies on a part of the line in which two polygons cross. The rest of the line is
/// still a crossing.
#[test]
fn crossings_go_on_where_an_edge_of_a_third_polygon_lies_on_them() {
    let floor = vec![[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]];
    let wall = vec![[0.0, -2.0, -2.0], [0.0, 2.0, -2.0], [0.0, 2.0, 2.0], [0.0, -2.0, 2.0]];
    let flap = vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.5, 1.0]];
    let polygons = [floor, wall, flap];
    let eye = DVec3::new(6.0, -0.5, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]).unwrap();
    let at = |y: f64| camera.project(DVec3::new(0.0, y, 0.0)).unwrap();
    let distance = |[a, b]: [[f64; 2]; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0], [2, 1, 0]] {
        for (by, tree) in trees(&order.map(|i: usize| &polygons[i])) {
            let [floor, wall] = [0, 1].map(|i| order.iter().position(|&o| o == i).unwrap());
            let kind = EdgeKind::Crossing(floor.max(wall));
            let all = crossings(&tree, &camera);
            let runs = all.iter().filter(|run| run.polygon == floor.min(wall) && run.kind == kind);
            let length: f64 = runs.map(|run| distance(run.ends)).sum();
            let flap = distance([at(0.0), at(1.0)]);
            let expected = distance([at(-2.0), at(2.0)]) - flap;
            assert!((length - expected).abs() < 1e-3, "{order:?}, {by}: {length}, {expected}");
            // The flap only touches the floor and the wall.
            assert!(all.iter().all(|run| run.polygon == floor.min(wall) && run.kind == kind));
        }
    }
}

/// A pane goes through a wall. In the picture, edges of two other polygons lie on parts of the crossing.
#[test]
fn crossings_show_beside_edges_that_lie_on_them_in_the_picture() {
    let wall = vec![[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 0.0, 2.0], [-2.0, 0.0, 2.0]];
    let pane = vec![[-2.0, -2.0, -2.0], [2.0, -2.0, -2.0], [2.0, 2.0, 2.0], [-2.0, 2.0, 2.0]];
    let flap = vec![[-1.0, -3.0, 0.0], [0.0, -3.0, 0.0], [0.0, -3.0, 2.0]];
    // This flap is on another part of the line, from below.
    let other = vec![[0.5, -3.0, 0.0], [1.0, -3.0, 0.0], [0.5, -3.0, -2.0]];
    let polygons = [wall, pane, flap, other];
    let eye = DVec3::new(0.0, -10.0, 0.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.5, [320, 240]).unwrap();
    // The parts of four units that the edges of the flaps do not cover. The flaps are at seven tenths of the
    // distance.
    let at = |x: f64| camera.project(DVec3::new(x, 0.0, 0.0)).unwrap()[0];
    let hidden = |from: f64, to: f64| at(to / 0.7) - at(from / 0.7);
    let expected = at(2.0) - at(-2.0) - hidden(-1.0, 0.0) - hidden(0.5, 1.0);
    for order in [[0, 1, 2, 3], [3, 2, 0, 1], [1, 3, 2, 0], [2, 1, 3, 0]] {
        for (by, tree) in trees(&order.map(|i: usize| &polygons[i])) {
            let opacity = |i: usize| if order[i] == 1 { 0.5 } else { 1.0 };
            let map = map_with(&tree, &camera, opacity);
            let length = |runs: Vec<EdgeRun>| -> f64 {
                let shown = runs.iter().filter(|run| run.is_visible);
                shown.map(|run| (run.ends[1][0] - run.ends[0][0]).abs()).sum()
            };
            let found = [
                map.crossings(Hidden::Skip),
                map.crossings(Hidden::Keep),
                map.crossings(Hidden::Count),
            ]
            .map(|runs| length(runs.unwrap()));
            let are_right = found.iter().all(|length| (length - expected).abs() < 1e-6);
            assert!(are_right, "{order:?}, {by}: {found:?}, {expected}");
        }
    }
}

/// A pane that lies on a board does not cross the board, although a third polygon goes through both.
#[test]
fn polygons_of_one_plane_do_not_cross() {
    let square = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    let fin = [[1.0, 0.2, -1.0], [1.0, 1.8, -1.0], [1.0, 1.8, 1.0], [1.0, 0.2, 1.0]];
    let eye = DVec3::new(3.0, -2.0, 4.0);
    let camera = Camera::perspective(eye, DVec3::X + DVec3::Y, DVec3::Z, 0.8, [320, 240]).unwrap();
    for (_, tree) in trees(&[square, square, fin]) {
        let opacity = |polygon: usize| if polygon == 1 { 0.5 } else { 1.0 };
        let runs = map_with(&tree, &camera, opacity).crossings(Hidden::Skip).unwrap();
        assert!(!runs.is_empty() && runs.iter().all(|run| run.kind == EdgeKind::Crossing(2)));
    }
}

/// Three planes through one line: each pair crosses there.
#[test]
fn planes_through_one_line_cross_in_it() {
    let card = |x: f64, y: f64| [[-x, -y, -1.0], [x, y, -1.0], [x, y, 1.0], [-x, -y, 1.0]];
    let cards = [card(1.0, 0.0), card(0.0, 1.0), card(1.0, 1.0)];
    let mut seen = 0;
    for turn in 0..16 {
        let angle = std::f64::consts::TAU * (f64::from(turn) + 0.3) / 16.0;
        let eye = DVec3::new(3.0 * angle.cos(), 3.0 * angle.sin(), 0.5);
        let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]).unwrap();
        for (by, tree) in trees(&cards) {
            let runs = crossings(&tree, &camera);
            // Two of the cards are visible at the line, one on each side, along the whole line in the
            // picture.
            let pairs: Vec<_> = runs.iter().map(|run| (run.polygon, run.kind)).collect();
            assert_eq!(pairs.len(), 1, "{turn}, {by}: {runs:?}");
            seen += 1;
        }
    }
    assert!(seen > 16 * Heuristic::ALL.len());
}

/// Two upright cards cross, and a bar is in front of the middle of their crossing.
#[test]
fn cards_cross_in_a_line_and_a_bar_hides_its_middle() {
    let cards = [
        [[-2.0, -2.0, -2.0], [2.0, -2.0, 2.0], [2.0, 2.0, 2.0], [-2.0, 2.0, -2.0]],
        [[-2.0, -2.0, 2.0], [2.0, -2.0, -2.0], [2.0, 2.0, -2.0], [-2.0, 2.0, 2.0]],
        [[-3.0, -0.5, 3.0], [3.0, -0.5, 3.0], [3.0, 0.5, 3.0], [-3.0, 0.5, 3.0]],
    ];
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    for (count, expected) in [(2, vec![40.0]), (3, vec![15.0, 15.0])] {
        for (by, tree) in trees(&cards[..count]) {
            let runs = crossings(&tree, &camera);
            let lengths = runs.iter().map(|run| (run.ends[1][1] - run.ends[0][1]).abs());
            let lengths: Vec<f64> = lengths.map(|length| (length * 1e6).round() / 1e6).collect();
            assert_eq!(lengths, expected, "{by}");
            for run in runs {
                assert_eq!((run.polygon, run.kind), (0, EdgeKind::Crossing(1)));
                assert!(run.is_visible && run.edge.is_none());
                assert!(run.ends.iter().all(|end| (end[0] - 40.0).abs() < 1e-9));
            }
        }
    }
}

/// A wall through a floor of tiles has a run for each tile. Two walls in a line with a gap between them have
/// one run each.
#[test]
fn a_wall_crosses_every_tile_of_a_floor() {
    let count = 2_000;
    let mut polygons: Vec<[[f64; 3]; 4]> = (0..count)
        .map(|i| {
            let x = f64::from(i);
            [[x, -1.0, 0.0], [x + 1.0, -1.0, 0.0], [x + 1.0, 1.0, 0.0], [x, 1.0, 0.0]]
        })
        .collect();
    let end = f64::from(count) + 1.0;
    polygons.push([[-1.0, 0.0, -1.0], [end, 0.0, -1.0], [end, 0.0, 1.0], [-1.0, 0.0, 1.0]]);
    let tree = BspTree::build(&polygons).unwrap();
    let centre = DVec3::new(0.5 * end, 0.0, 0.0);
    let direction = DVec3::new(0.0, 1.0, -1.0);
    let camera = Camera::parallel(direction, DVec3::Z, centre, 0.4 * end, [800, 200]).unwrap();
    let runs = crossings(&tree, &camera);
    // The picture shows four fifths of the floor's length.
    let tiles: Vec<usize> = runs.iter().map(|run| run.polygon).collect();
    assert!(runs.len() > 1_500 && tiles.is_sorted_by(|a, b| a < b), "{}", runs.len());
    assert!(runs.iter().all(|run| run.kind == EdgeKind::Crossing(count as usize)));
}

/// A wall that stands on a floor touches it, and two walls meet at a corner: nothing crosses.
#[test]
fn touching_polygons_do_not_cross() {
    let floor = [[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 0.0, 2.0], [-2.0, 0.0, 2.0]];
    let wall = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [-1.0, 2.0, 0.0]];
    let other = [[1.0, 0.0, 0.0], [1.0, 0.0, 2.0], [1.0, 2.0, 2.0], [1.0, 2.0, 0.0]];
    let tree = BspTree::build([floor, wall, other]).unwrap();
    let eye = DVec3::new(-3.0, 4.0, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [200, 150]).unwrap();
    assert_eq!(crossings(&tree, &camera), []);
}

/// A quad that is bent upwards stands on a floor with its bend. The floor is cut by the plane of half of the
/// quad, and shows through the quad on both sides of the cut.
#[test]
fn a_bend_that_touches_a_floor_does_not_cross_it() {
    let bent = [[-2.0, 0.0, 1.0], [0.0, -1.0, 0.0], [2.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
    let floor = [[-3.0, -3.0, 0.0], [3.0, -3.0, 0.0], [3.0, 3.0, 0.0], [-3.0, 3.0, 0.0]];
    let camera =
        Camera::parallel(dvec3(0.2, 0.1, -1.0), DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    for polygons in [[bent, floor], [floor, bent]] {
        for (by, tree) in trees(&polygons) {
            assert_eq!(tree.faces().len(), 3, "the quad is bent");
            for hidden in [Hidden::Skip, Hidden::Keep, Hidden::Count] {
                let runs = map_with(&tree, &camera, |_| 0.5).crossings(hidden).unwrap();
                assert_eq!(runs, [], "{by}, {hidden:?}");
            }
        }
    }
}

/// The triangles of one polygon that is not planar can pierce each other.
#[test]
fn a_polygon_does_not_cross_itself() {
    let mut cut = 0;
    for seed in seeds(100) {
        let mut dice = Dice(seed);
        let corners = 6 + dice.below(4);
        let outline: Vec<DVec3> = (0..corners).map(|_| dice.point(-1.0, 1.0)).collect();
        let camera =
            Camera::parallel(dvec3(0.3, 0.2, -1.0), DVec3::Y, DVec3::ZERO, 4.0, [80, 80]).unwrap();
        let Ok(tree) = BspTree::build([&outline]) else { continue };
        cut += usize::from(tree.len() > tree.faces().len());
        for hidden in [Hidden::Skip, Hidden::Keep, Hidden::Count] {
            let runs = map_with(&tree, &camera, |_| 0.5).crossings(hidden).unwrap();
            assert_eq!(runs, [], "{seed}, {hidden:?}");
        }
    }
    enough!(cut > 50; "{cut}");
}

/// A floor of tiles and a wall of panels are divided at the same places. Each panel crosses one tile in one run, and
/// meets the tiles beside it only in a point.
#[test]
fn panels_cross_only_the_tiles_at_their_places() {
    let mut dice = Dice(9);
    let count = 24;
    for _ in 0..times(12) {
        let mut ends: Vec<f64> = (0..=count).map(|_| dice.around_zero(4000) / 1024.0).collect();
        ends.sort_unstable_by(f64::total_cmp);
        ends.dedup();
        let count = ends.len() - 1;
        let tile = |ends: &[f64]| {
            let at = |x: f64, y: f64| dvec3(x, y, 0.0);
            [at(ends[0], -1.0), at(ends[1], -1.0), at(ends[1], 1.0), at(ends[0], 1.0)]
        };
        let panel = |ends: &[f64]| tile(ends).map(|p| dvec3(p.x, 0.0, p.y));
        let polygons: Vec<[DVec3; 4]> =
            ends.windows(2).map(tile).chain(ends.windows(2).map(panel)).collect();
        let tree = BspTree::build(&polygons).unwrap();
        let eye = dice.point(-1.0, 1.0).normalize() * 9.0;
        let perspective = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 1.2, [320, 240]);
        let parallel = Camera::parallel(-eye, DVec3::Z, DVec3::ZERO, 12.0, [320, 240]);
        for camera in [perspective.unwrap(), parallel.unwrap()] {
            for (opacity, hidden) in
                [0.5, 1.0].into_iter().flat_map(|o| [(o, Hidden::Skip), (o, Hidden::Keep)])
            {
                let runs = map_with(&tree, &camera, |_| opacity).crossings(hidden).unwrap();
                assert!(runs.iter().all(|run| run.is_visible));
                let pairs: Vec<_> = runs.iter().map(|run| (run.polygon, run.kind)).collect();
                let expected = (0..count).map(|k| (k, EdgeKind::Crossing(count + k)));
                assert_eq!(pairs, expected.collect::<Vec<_>>(), "{camera:?}, {hidden:?}");
            }
        }
    }
}

/// The visible parts of a crossing that meet are one run, from however many cells they come.
#[test]
fn runs_of_two_polygons_do_not_meet() {
    let mut dice = Dice(10);
    let mut compared = 0;
    for round in 0..times(12) {
        let polygons = triangles(&mut dice, 60, [-1.0, 1.0], 0.8);
        let tree = BspTree::build(&polygons).unwrap();
        let eye = dice.point(-1.0, 1.0).normalize() * 4.0;
        let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]).unwrap();
        let opacity = if round % 2 == 0 { 1.0 } else { 0.5 };
        let runs = map_with(&tree, &camera, |_| opacity).crossings(Hidden::Skip).unwrap();
        for (k, one) in runs.iter().enumerate() {
            let same = |run: &&EdgeRun| (run.polygon, run.kind) == (one.polygon, one.kind);
            for other in runs[k + 1..].iter().filter(same) {
                let ends = one.ends.into_iter().flat_map(|p| other.ends.map(|q| [p, q]));
                let gap = ends.map(|[p, q]| DVec2::from(p).distance(q.into()));
                let gap = gap.fold(f64::INFINITY, f64::min);
                assert!(gap >= 1e-6, "{gap}: {one:?} {other:?}");
                compared += 1;
            }
            let length = DVec2::from(one.ends[0]).distance(one.ends[1].into());
            assert!(length > 9e-7, "{one:?}");
        }
    }
    enough!(compared > 20; "{compared}");
}

/// A small polygon lies on a floor within the tolerance. Far away its plane leaves the floor on both sides, so the
/// floor has corners on both sides of it. It is divided into triangles, but it does not cross the floor there.
#[test]
fn a_divided_polygon_on_a_floor_does_not_cross_it() {
    let tolerance = 1e-3;
    let floor: Corners = rectangle([-2.0, -2.0], [2.0, 2.0], 0.0);
    let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    for turns in 0..6 {
        let mut l: Corners =
            l.map(|[x, y]| dvec3(0.1 * x, 0.1 * y, 0.8 * tolerance * (x - 1.0))).to_vec();
        l.rotate_left(turns);
        let camera =
            Camera::parallel(dvec3(0.2, 0.1, -1.0), DVec3::Y, DVec3::ZERO, 5.0, [80, 80]).unwrap();
        for polygons in [[l.clone(), floor.clone()], [floor.clone(), l.clone()]] {
            let options = BuildOptions::DEFAULT.with_tolerance(tolerance);
            let tree: BspTree = options.build(&polygons).unwrap();
            assert!(tree.faces().len() > 2);
            for hidden in [Hidden::Skip, Hidden::Keep, Hidden::Count] {
                let runs = map_with(&tree, &camera, |_| 0.5).crossings(hidden).unwrap();
                assert_eq!(runs, [], "{turns}, {hidden:?}");
            }
        }
    }
}
