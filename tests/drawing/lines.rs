//! Visible and hidden runs of edges, by hand and against rays.

use super::map_of;
use binspace::drawing::{EdgeKind, EdgeRun};
use binspace::internals::cuboid;
use binspace::view::views;
use testkit::fill::ray;
use testkit::hard::bounds;
use testkit::prelude::*;
use testkit::scenes::{polygons, triangles};

fn edges(tree: &BspTree, camera: &Camera) -> Vec<EdgeRun> {
    map_of(tree, camera).edges(Hidden::Keep).unwrap()
}

#[test]
fn a_cube_shows_nine_edges_and_six_are_its_silhouette() {
    let cube = cuboid(-DVec3::ONE, DVec3::ONE);
    let tree = BspTree::build(cube).unwrap();
    let eye = DVec3::new(4.0, 3.0, 5.0);
    let perspective = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.9, [300, 200]).unwrap();
    let parallel = Camera::parallel(-eye, DVec3::Z, DVec3::ZERO, 5.0, [300, 200]).unwrap();
    for camera in [perspective, parallel] {
        let runs = edges(&tree, &camera);
        let (visible, hidden): (Vec<&EdgeRun>, Vec<&EdgeRun>) =
            runs.iter().partition(|run| run.is_visible);
        assert_eq!((visible.len(), hidden.len()), (9, 3));
        let silhouette: Vec<_> =
            visible.iter().filter(|run| run.kind == EdgeKind::Silhouette).collect();
        assert_eq!(silhouette.len(), 6);
        // Of the two polygons at a silhouette, the run names the one that is seen from its front.
        let map = map_of(&tree, &camera);
        let shown: Vec<usize> = map.polygons().map(|polygon| polygon.polygon).collect();
        assert!(silhouette.iter().all(|run| shown.contains(&run.polygon)));
        // Each run leads from corner to corner as its polygon does.
        for run in &runs {
            let start = run.edge.expect("of the outline") as usize;
            for (end, corner) in run.ends.into_iter().zip([start, (start + 1) % 4]) {
                let at = DVec2::from(camera.project(cube[run.polygon][corner]).unwrap());
                assert!(at.distance(end.into()) < 1e-9, "{run:?}");
            }
        }
        // The silhouette is closed: each end belongs to two runs.
        for end in silhouette.iter().flat_map(|run| run.ends) {
            let is_there = |other: &[f64; 2]| (0..2).all(|i| (end[i] - other[i]).abs() < 1e-9);
            let ends = silhouette.iter().flat_map(|run| run.ends);
            assert_eq!(ends.filter(is_there).count(), 2);
        }
        for run in
            hidden.iter().chain(visible.iter().filter(|run| run.kind != EdgeKind::Silhouette))
        {
            let EdgeKind::Crease(angle) = run.kind else { panic!("{run:?}") };
            assert!((angle - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        }
    }
}

#[test]
fn a_bar_hides_the_middle_of_an_edge() {
    let square = [[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]];
    let bar = [[-0.5, -3.0, 1.0], [0.5, -3.0, 1.0], [0.5, 3.0, 1.0], [-0.5, 3.0, 1.0]];
    let tree = BspTree::build([square, bar]).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    let runs = edges(&tree, &camera);
    assert!(runs.iter().all(|run| run.kind == EdgeKind::Border));
    // The lower and the upper edge, ten pixels per unit.
    for edge in [0, 2] {
        let mut parts: Vec<(bool, f64)> = runs
            .iter()
            .filter(|run| run.polygon == 0 && run.edge == Some(edge))
            .map(|run| (run.is_visible, (run.ends[1][0] - run.ends[0][0]).abs()))
            .collect();
        parts.iter_mut().for_each(|part| part.1 = (part.1 * 1e6).round() / 1e6);
        assert_eq!(parts, [(true, 15.0), (false, 10.0), (true, 15.0)]);
    }
    assert_eq!(runs.iter().filter(|run| run.polygon == 1 && run.is_visible).count(), 4);
}

/// Consecutive edges on one line, of one polygon and of two polygons side by side. Each edge has its own run.
#[test]
fn edges_on_one_line_have_separate_runs() {
    let wall = [[-3.0, 0.0], [-2.0, 0.0], [0.0, 0.0], [0.0, 2.0], [-3.0, 2.0]];
    let beside = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [1.0, 2.0], [0.0, 2.0]];
    let post = [[-1.5, -1.0], [-0.5, -1.0], [-0.5, 3.0], [-1.5, 3.0]];
    let at = |z: f64| move |[x, y]: [f64; 2]| [x, y, z];
    let walls = [wall, beside].map(|wall| wall.map(at(0.0)).to_vec());
    let tree = BspTree::build(walls.iter().cloned().chain([post.map(at(1.0)).to_vec()])).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    let runs = edges(&tree, &camera);
    for (polygon, wall) in walls.iter().enumerate() {
        for (k, [ax, ay, _]) in wall.iter().enumerate() {
            let [bx, by, _] = wall[(k + 1) % wall.len()];
            // The part that the post hides, in units of the scene.
            let hides = |x: f64| -1.5 < x && x < -0.5 && polygon == 0 && ay == &by;
            let mut expected = [0.0, 0.0];
            for step in 0..1000 {
                let share = (f64::from(step) + 0.5) / 1000.0;
                let is_hidden = hides(ax + (bx - ax) * share);
                expected[usize::from(is_hidden)] += (bx - ax).hypot(by - ay) / 1000.0;
            }
            let mut found = [0.0, 0.0];
            for run in &runs {
                let [a, b] = run.ends;
                // The two walls lie in one plane, so they have no edge between them.
                if (run.polygon, run.edge) == (polygon, Some(k as u32)) {
                    found[usize::from(!run.is_visible)] += (b[0] - a[0]).hypot(b[1] - a[1]) / 10.0;
                }
            }
            let is_common = (*ax, bx) == (0.0, 0.0);
            let expected = if is_common { [0.0; 2] } else { expected };
            assert!(
                (0..2).all(|i| (found[i] - expected[i]).abs() < 0.01),
                "{polygon} {k}: {found:?} {expected:?}"
            );
        }
    }
}

/// Edges that leave the picture, or run behind the eye, are drawn up to the boundary of the picture.
#[test]
fn edges_end_with_the_picture() {
    let floor =
        [[-99.0, -1.0, 99.0], [99.0, -1.0, 99.0], [99.0, -1.0, -99.0], [-99.0, -1.0, -99.0]];
    let tree = BspTree::build([floor]).unwrap();
    let camera = Camera::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 1.6, [200, 100]).unwrap();
    let runs = edges(&tree, &camera);
    assert!(!runs.is_empty());
    for [x, y] in runs.iter().flat_map(|run| run.ends) {
        assert!((-0.001..=200.001).contains(&x) && (-0.001..=100.001).contains(&y), "{x} {y}");
    }
}

/// Points nearer to the end of a run, in pixels, are not judged: rays of pictures are rounded, by up to a
/// thousandth of a pixel.
const NEAR: f64 = 2.1e-3;

/// The counts of comparisons.
#[derive(Debug, Default)]
struct Score {
    visible: usize,
    hidden: usize,
    unsure: usize,
}

/// Tests by rays whether points of runs are hidden by polygons that do not contain the edge. Points where
/// rays slightly to the left and to the right do not agree are left out.
fn check_runs(
    tree: &BspTree,
    polygons: &[Vec<DVec3>],
    camera: &Camera,
    (dice, each): (&mut Dice, usize),
    score: &mut Score,
) {
    for run in edges(tree, camera) {
        let corners = &polygons[run.polygon];
        let edge = run.edge.expect("an edge") as usize;
        let [a, b] = [edge, (edge + 1) % corners.len()].map(|k| corners[k]);
        let has_edge = |polygon: usize| {
            let corners = &polygons[polygon];
            (0..corners.len()).any(|k| {
                let ends = [corners[k], corners[(k + 1) % corners.len()]];
                ends == [a, b] || ends == [b, a]
            })
        };
        let way = [0, 1].map(|i: usize| run.ends[1][i] - run.ends[0][i]);
        let length = way[0].hypot(way[1]);
        for _ in 0..each {
            let share = dice.share();
            if share.min(1.0 - share) * length < NEAR {
                score.unsure += 1;
                continue;
            }
            let point = [0, 1].map(|i: usize| run.ends[0][i] + way[i] * share);
            let across = [-way[1] / length * 0.005, way[0] / length * 0.005];
            let is_hidden = |off: f64| {
                let at = [0, 1].map(|i: usize| point[i] + off * across[i]);
                let ray = ray(camera, at);
                let depth = nearest(ray, a, b);
                let before =
                    tree.hits(ray).take_while(|hit| hit.parameter() < depth * (1.0 - 1e-6));
                before.filter(|hit| hit.parameter() > 0.0).any(|hit| !has_edge(hit.polygon()))
            };
            let answers = [-1.0, 0.0, 1.0].map(is_hidden);
            if answers.contains(&true) && answers.contains(&false) {
                score.unsure += 1;
                continue;
            }
            assert_eq!(answers[0], !run.is_visible, "{run:?} at {point:?}, {camera:?}");
            if run.is_visible {
                score.visible += 1;
            } else {
                score.hidden += 1;
            }
        }
    }
}

/// The parameter at which a ray is nearest to a line.
fn nearest(ray: binspace::Ray, a: DVec3, b: DVec3) -> f64 {
    let binspace::Ray::Endless { from, direction } = ray else { panic!("a view has no end") };
    let (u, v, w) = (direction, b - a, from - a);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    (uv * v.dot(w) - vv * u.dot(w)) / (uu * vv - uv * uv)
}

#[test]
fn rays_agree_with_runs() {
    let (mut score, mut dice) = (Score::default(), Dice(1));
    let mut random = Dice(3);
    let mut scenes: Vec<(Vec<Vec<DVec3>>, DVec3)> = vec![
        (triangles(&mut random, 120, [0.0, 1.0], 0.3), DVec3::Z),
        (triangles(&mut random, 300, [0.0, 1.0], 0.05), DVec3::Z),
    ];
    for (builtin, size) in [(Builtin::City, 200), (Builtin::Sphere, 200), (Builtin::Terrain, 200)] {
        let scene = builtin.build(Some(size), 2);
        scenes.push((polygons(&scene), scene.up()));
    }
    for (polygons, up) in &scenes {
        let tree = BspTree::build(polygons).unwrap();
        let bounds = bounds(polygons).unwrap();
        for camera in views(bounds, *up, 2, [320, 240], 7).unwrap() {
            assert!(matches!(camera.viewpoint(), Viewpoint::Eye(_)));
            check_runs(&tree, polygons, &camera, (&mut dice, times(20)), &mut score);
        }
    }
    enough!(score.visible > 12_500, score.hidden > 12_500; "{score:?}");
    enough!(score.visible + score.hidden > 50_000; "{score:?}");
    assert!(score.unsure * 10 < score.visible + score.hidden, "{score:?}");
}
