//! Closed bodies stay closed if they are cut and welded. Without welding, they do not.

use super::{is_closed_once, open_edges};
use binspace::Tolerance;
use binspace::glam::vec3;
use std::ops::Range;
use testkit::prelude::*;
use testkit::real_scenes;
use testkit::scenes::polygons;
use testkit::shapes::{cuboid, rotation};

/// Boxes that cross each other, rotated so that their quads are bent by rounding.
fn boxes(count: usize) -> Vec<Vec<DVec3>> {
    let at = |k: usize, a: f64| (k as f64 * a).sin();
    (0..count)
        .flat_map(|k| {
            let turn = rotation([at(k, 1.3) * 3.0, at(k, 2.7), at(k, 0.7) * 2.0]);
            let centre = DVec3::new(at(k, 5.1), at(k, 3.3), at(k, 4.9));
            cuboid(turn, centre, DVec3::new(0.6, 0.5 + 0.2 * at(k, 9.1), 0.8))
        })
        .collect()
}

/// Checks that the welded mesh of a body is closed. Returns the number of open edges without welding.
fn check(name: &str, polygons: &[Vec<DVec3>], heuristic: Heuristic, tolerance: Tolerance) -> usize {
    let mut options = BuildOptions::DEFAULT.with_heuristic(heuristic);
    options.tolerance = tolerance;
    let tree = options.build(polygons).unwrap();
    let mesh = tree.welded_mesh().unwrap();
    assert!(is_closed_once(&mesh), "{name} by {heuristic}, {tolerance:?}");
    let loose = tree.mesh().unwrap();
    let all: Vec<u32> = (0..tree.len() as u32).collect();
    let open = open_edges(&loose, loose.triangles(), &all).len();
    let splits = tree.stats().splits;
    assert!(open == 0 || splits > 0, "{name}: open where nothing is cut");
    open
}

#[test]
fn closed_bodies_stay_closed() {
    let bodies = [
        ("sphere", polygons(&scene::sphere(300))),
        ("one box", boxes(1)),
        ("boxes", boxes(9)),
        ("newell", polygons(&scene::newell_bars())),
    ];
    let mut open = 0;
    for (name, polygons) in &bodies {
        for &heuristic in Heuristic::ALL {
            for tolerance in [Tolerance::Default, Tolerance::Length(0.0), Tolerance::Relative(1e-4)]
            {
                open += check(name, polygons, heuristic, tolerance);
            }
        }
    }
    enough!(open > 1000; "only {open} edges to be welded: the cases show little");
}

/// A body in `f32` with bent quads, among random triangles that cut it. The body comes first or last in the
/// input. If it is last, other polygons are prepared before it, in other parts.
#[test]
fn a_body_that_others_cut_stays_closed() {
    let body: Vec<Vec<[f32; 3]>> = boxes(2)
        .into_iter()
        .skip(6)
        .map(|side| side.into_iter().map(|p| p.as_vec3().to_array()).collect())
        .collect();
    let others: Vec<Vec<[f32; 3]>> = scene::random_triangles(1200, 5)
        .polygons()
        .map(|triangle| {
            let corner = |p: &DVec3| (p.as_vec3() * 2.0 - vec3(1.9, 1.15, 1.98)).to_array();
            triangle.points().iter().map(corner).collect()
        })
        .collect();
    check_cut_body(&[&body[..], &others].concat(), 0..body.len());
    check_cut_body(&[&others[..], &body].concat(), others.len()..others.len() + body.len());
}

fn check_cut_body(all: &[Vec<[f32; 3]>], body: Range<usize>) {
    // The default heuristic divides by the planes of the body first, and so leaves it whole.
    let heuristic = Heuristic::Random { seed: 1 };
    let tree = BuildOptions::DEFAULT.with_heuristic(heuristic).build(all).unwrap();
    assert!(tree.preparation().flattened > 0, "no corner is moved");
    let mesh = tree.welded_mesh().unwrap();
    let own: Vec<u32> =
        tree.fragments().filter(|f| body.contains(&f.polygon())).map(|f| f.index()).collect();
    enough!(own.len() > 30; "{}", own.len());
    assert_eq!(open_edges(&mesh, mesh.triangles(), &own).len(), 0);
    let part = mesh.triangles_of(|polygon| body.contains(&polygon)).unwrap();
    assert_eq!(open_edges(&mesh, &part, &own).len(), 0);
    assert_eq!(part.indices().len(), own.iter().map(|&f| part.range(f).len()).sum::<usize>());
    let loose = tree.mesh().unwrap();
    assert!(open_edges(&loose, loose.triangles(), &own).len() > 20, "nothing to weld");
}

/// Hexahedra of any eight corners: bent quads that cross each other, and overlap themselves in projections.
#[test]
fn hexahedra_of_bent_quads_stay_closed() {
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut dice, mut splits) = (Dice(47), 0);
    for _ in 0..times(100) {
        let corners: Vec<DVec3> = (0..8).map(|_| dice.whole_point(40)).collect();
        let quads = sides.map(|side| side.map(|k: usize| corners[k]));
        let tree = BspTree::build(quads).unwrap();
        let mesh = tree.welded_mesh().unwrap();
        let all: Vec<u32> = (0..tree.len() as u32).collect();
        assert_eq!(open_edges(&mesh, mesh.triangles(), &all).len(), 0, "{quads:?}");
        splits += tree.stats().splits;
    }
    enough!(splits > 300; "{splits}");
}

/// A quad beside two quads that share its long edge: a T-junction of the input.
#[test]
fn corners_inside_an_edge_are_welded() {
    let quad = |x: f64, y: f64, w: f64, h: f64| {
        [[x, y, 0.0], [x + w, y, 0.0], [x + w, y + h, 0.0], [x, y + h, 0.0]]
    };
    let tree = BspTree::build([
        quad(0.0, 0.0, 3.0, 1.0),
        quad(0.0, 1.0, 1.0, 1.0),
        quad(1.0, 1.0, 2.0, 1.0),
    ])
    .unwrap();
    let counts =
        [tree.mesh(), tree.welded_mesh()].map(|mesh| mesh.unwrap().triangles().indices().len());
    assert_eq!(counts, [18, 21]);
    let mesh = tree.welded_mesh().unwrap();
    let inserted: Vec<_> = mesh
        .vertices()
        .filter(|v| v.polygon == 0 && v.weights.len() == 2)
        .map(|v| (v.position, v.weights.to_vec()))
        .collect();
    assert_eq!(inserted.len(), 1);
    assert_eq!(inserted[0].0, DVec3::new(1.0, 1.0, 0.0));
    let x: f64 = inserted[0].1.iter().map(|&(k, w)| w * [0.0, 3.0, 3.0, 0.0][k as usize]).sum();
    assert!((x - 1.0).abs() < 1e-15);
}

#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn the_bunny_of_the_real_scenes_stays_closed() {
    let folder = real_scenes::folder();
    let (scene, _) = Scene::read_obj(folder.join("bunny_4k.obj")).unwrap();
    let tree = BspTree::build(scene.polygons()).unwrap();
    let loose = tree.mesh().unwrap();
    let all: Vec<u32> = (0..tree.len() as u32).collect();
    assert!(open_edges(&loose, loose.triangles(), &all).len() > 500, "the case shows nothing");
    assert!(is_closed_once(&tree.welded_mesh().unwrap()));
}
