//! The number of polygons in front of hidden edges, compared with rays in rationals.

use super::map_of;
use super::on_grid;
use super::overlay::{between, place_in};
use super::sightlines::Sightlines;
use binspace::drawing::EdgeRun;
use testkit::hard::bounds;
use testkit::prelude::*;
use testkit::rational::Point;
use testkit::scenes::{polygons, triangles};
use testkit::shapes::rectangle;

fn in_layers(tree: &BspTree, camera: &Camera) -> Vec<EdgeRun> {
    let map = map_of(tree, camera);
    let runs = map.edges(Hidden::Keep).unwrap();
    let layered = map.edges(Hidden::Count).unwrap();
    // These are the same runs, divided further.
    let mut rest = layered.iter();
    for run in &runs {
        assert_eq!(run.layers, None);
        let mut end = run.ends[0];
        while end != run.ends[1] {
            let part = rest.next().expect("a part");
            assert_eq!(part.ends[0], end, "{part:?} of {run:?}");
            end = part.ends[1];
            let mut same = *part;
            (same.layers, same.ends) = (None, run.ends);
            assert_eq!(same, *run);
            assert_eq!(part.layers == Some(0), run.is_visible);
        }
    }
    assert_eq!(rest.next(), None);
    layered
}

/// Squares one before another, each smaller. Behind k squares there are k layers.
#[test]
fn squares_before_one_another_are_counted() {
    let side = |k: u32| f64::from(5 - k);
    let squares: Vec<Vec<DVec3>> =
        (0..4).map(|k| rectangle([-side(k), -0.5], [side(k), 0.5], f64::from(k))).collect();
    // The edge is behind all squares.
    let bar = rectangle([-6.0, -0.25], [6.0, 0.25], -1.0);
    let tree = BspTree::build(squares.iter().chain([&bar])).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 16.0, [160, 160]).unwrap();
    let runs = in_layers(&tree, &camera);
    let edge: Vec<(u32, f64)> = runs
        .iter()
        .filter(|run| run.polygon == 4 && run.edge == Some(0))
        .map(|run| (run.layers.unwrap(), ((run.ends[1][0] - run.ends[0][0]) * 1e6).round() / 1e6))
        .collect();
    let expected = [0, 1, 2, 3, 4, 3, 2, 1, 0];
    let lengths = [10.0, 10.0, 10.0, 10.0, 40.0, 10.0, 10.0, 10.0, 10.0];
    assert_eq!(edge, expected.into_iter().zip(lengths).collect::<Vec<_>>());
    // The ends of runs are hidden only where a polygon other than the edge's own lies before them.
    let ends = runs.iter().filter(|run| run.polygon == 0 && run.edge == Some(1));
    assert_eq!(ends.map(|run| run.layers.unwrap()).collect::<Vec<_>>(), [0]);
}

#[test]
fn edges_have_as_many_layers_as_rays_meet() {
    let (mut random, mut dice) = (Dice(8), Dice(8));
    let mut scenes: Vec<Vec<Vec<DVec3>>> = [(40, 0.8), (120, 0.3), (200, 0.1)]
        .map(|(count, edge)| triangles(&mut random, count, [-1.0, 1.0], edge))
        .to_vec();
    for builtin in [Builtin::City, Builtin::Sphere] {
        scenes.push(polygons(&builtin.build(Some(100), 2)));
    }
    let (mut judged, mut most, mut on_walls) = ([0; 4], 0, 0);
    for polygons in &scenes {
        let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build(polygons).unwrap();
        let [low, high] = bounds(polygons).unwrap();
        let lattice = *tree.faces().lattice();
        for far in [2.0, 0.2] {
            let (middle, size) = ((low + high) * 0.5, high - low);
            let eye = middle + random.point(-1.0, 1.0).normalize() * size * far;
            let eye = on_grid(&tree, eye);
            let camera = Camera::perspective(eye, middle, DVec3::Z, 0.8, [320, 240]).unwrap();
            let Some(sightlines) = Sightlines::of(&tree, &camera) else { continue };
            for run in in_layers(&tree, &camera) {
                let edge = run.edge.unwrap() as usize;
                let corners = &polygons[run.polygon];
                let ends = [edge, (edge + 1) % corners.len()]
                    .map(|k| rational::point(lattice.snap(corners[k])));
                for _ in 0..3 {
                    let share = dice.below(1 << 12) as f64 / f64::from(1 << 12);
                    let point: Point = between(&ends, share);
                    let Some(at) = sightlines.project(&point) else { continue };
                    if place_in(run.ends, at) != Some(true) {
                        continue;
                    }
                    // Polygons that contain the edge are not before it, although they may hide the edge's
                    // polygon.
                    let mut layers = sightlines.polygons_before(&point).len();
                    // (For example, edges of a town's blocks on its ground, seen from below.)
                    on_walls += usize::from(layers == 0 && !run.is_visible);
                    layers = layers.max(usize::from(!run.is_visible));
                    assert_eq!(run.layers, Some(layers as u32), "{run:?} at {share}, {camera:?}");
                    judged[layers.min(3)] += 1;
                    most = most.max(layers);
                }
            }
        }
    }
    assert!(judged.iter().all(|&count| count > 120) && most > 5, "{judged:?} {most}");
    assert!(on_walls * 4 < judged[1], "{on_walls} {judged:?}");
}

/// Stars, combs and polygons with corners on their edges, which are triangulated. Each edge has its layers
/// from its first end to its second end.
#[test]
fn edges_of_concave_polygons_have_as_many_layers_as_rays_meet() {
    let (mut random, mut dice) = (Dice(3), Dice(3));
    let outlines: Vec<Vec<[f64; 2]>> = vec![
        // A comb, with corners on its back.
        vec![
            [0.0, 0.0],
            [2.0, 0.0],
            [4.0, 0.0],
            [6.0, 0.0],
            [6.0, 4.0],
            [5.0, 4.0],
            [5.0, 1.0],
            [4.0, 1.0],
            [4.0, 4.0],
            [2.0, 4.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 4.0],
            [0.0, 4.0],
        ],
        // A star.
        (0..10)
            .map(|k| {
                let (angle, radius) = (f64::from(k) * 0.628, if k % 2 == 0 { 4.0 } else { 1.5 });
                [angle.cos() * radius, angle.sin() * radius].map(f64::round)
            })
            .collect(),
        // Two squares that touch in a corner.
        vec![
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [6.0, 3.0],
            [6.0, 6.0],
            [3.0, 6.0],
            [3.0, 3.0],
            [0.0, 3.0],
        ],
    ];
    let polygons: Vec<Vec<DVec3>> = (0..36)
        .map(|i| {
            let (at, x, y) =
                (random.point(-8.0, 8.0), random.point(-1.0, 1.0), random.point(-1.0, 1.0));
            // Corners are on a grid, so that all corners of a polygon are in one plane.
            let [at, x, y] = [at, x * 8.0, y * 8.0].map(|v| v.round() / 8.0);
            outlines[i % outlines.len()].iter().map(|[u, v]| at + x * *u + y * *v).collect()
        })
        .filter(|corners: &Vec<DVec3>| {
            let [a, b, c] = [corners[0], corners[1], corners[corners.len() - 1]];
            (b - a).cross(c - a).length() > 0.1
        })
        .collect();
    let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build(&polygons).unwrap();
    assert!(tree.faces().len() > 3 * polygons.len(), "they are triangulated");
    let lattice = *tree.faces().lattice();
    let (mut judged, mut told, mut along) = ([0; 3], 0, 0);
    for far in [30.0, 6.0] {
        for _ in 0..times(1) {
            let eye = random.point(-1.0, 1.0).normalize() * far;
            let eye = on_grid(&tree, eye);
            let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.9, [320, 240]).unwrap();
            let Some(sightlines) = Sightlines::of(&tree, &camera) else { continue };
            let runs = in_layers(&tree, &camera);
            for edge in runs.chunk_by(|a, b| (a.polygon, a.edge) == (b.polygon, b.edge)) {
                let corners = &polygons[edge[0].polygon];
                let number = edge[0].edge.unwrap() as usize;
                let ends = [number, (number + 1) % corners.len()]
                    .map(|k| rational::point(lattice.snap(corners[k])));
                // Runs go from the beginning of the edge to its end.
                let projected = ends.each_ref().map(|end| sightlines.project(end));
                if let [Some(a), Some(b)] = projected {
                    let way = [b[0] - a[0], b[1] - a[1]];
                    for run in edge {
                        let own = [0, 1].map(|i: usize| run.ends[1][i] - run.ends[0][i]);
                        assert!(own[0] * way[0] + own[1] * way[1] > 0.0, "{run:?} {a:?} {b:?}");
                    }
                    along += edge.len();
                }
                for pair in edge.windows(2) {
                    assert!(pair[0].ends[1] == pair[1].ends[0], "{pair:?}");
                }
                for _ in 0..4 {
                    let share = dice.below(1 << 12) as f64 / f64::from(1 << 12);
                    let point: Point = between(&ends, share);
                    let Some(at) = sightlines.project(&point) else { continue };
                    let Some(run) = edge.iter().find(|run| place_in(run.ends, at) == Some(true))
                    else {
                        continue;
                    };
                    let layers = sightlines.polygons_before(&point).len();
                    assert_eq!(run.layers, Some(layers as u32), "{run:?} at {share}, {camera:?}");
                    judged[layers.min(2)] += 1;
                }
                told += 1;
            }
        }
    }
    assert!(judged.iter().all(|&count| count > 80), "{judged:?}");
    enough!(told > 150, along > 150; "{told} {along}");
}
