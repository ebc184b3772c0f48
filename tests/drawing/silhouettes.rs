//! Silhouettes of closed bodies are closed: at each corner, the number of edges that begin equals the number
//! that end.

use super::map_of;
use binspace::drawing::{EdgeKind, EdgeRun};
use std::collections::{BTreeMap, BTreeSet};
use testkit::prelude::*;

type Corners = Vec<Vec<DVec3>>;

/// A ring of quads with lumps. It is not convex, and no quad is planar.
fn torus(around: usize, across: usize) -> Corners {
    let point = |i: usize, k: usize| {
        let angle = |n: usize, of: usize| std::f64::consts::TAU * (n % of) as f64 / of as f64;
        let (a, b) = (angle(i, around), angle(k, across));
        let lump = 1.0 + 0.3 * (3.0 * a).sin() + 0.1 * (5.0 * b).cos();
        let out = 3.0 + lump * b.cos();
        // Numbers of few bits.
        DVec3::new(out * a.cos(), out * a.sin(), lump * b.sin())
            .map(|c| (c * 4096.0).round() / 4096.0)
    };
    let quads = (0..around).flat_map(|i| (0..across).map(move |k| (i, k)));
    let quad = |(i, k)| [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)].map(|(i, k)| point(i, k));
    quads.map(|place| quad(place).to_vec()).collect()
}

fn triangles(quads: Corners) -> Corners {
    let halves = |q: Vec<DVec3>| [vec![q[0], q[1], q[2]], vec![q[0], q[2], q[3]]];
    quads.into_iter().flat_map(halves).collect()
}

#[test]
fn silhouettes_of_closed_bodies_are_closed() {
    let mut dice = Dice(9);
    let (mut edges, mut hidden) = (0, 0);
    for polygons in [torus(24, 12), torus(60, 30)].map(triangles) {
        let tree = BspTree::build(&polygons).unwrap();
        for _ in 0..12 {
            let eye = dice.point(-1.0, 1.0).normalize() * 30.0;
            let up = DVec3::new(0.1, 0.2, 1.0);
            let camera = Camera::perspective(eye, DVec3::ZERO, up, 0.6, [320, 240]).unwrap();
            let runs = map_of(&tree, &camera).edges(Hidden::Keep).unwrap();
            assert!(runs.iter().all(|run| run.kind != EdgeKind::Border));
            // Each edge once, in any number of runs.
            let mut silhouette = BTreeSet::new();
            for run in runs.iter().filter(|run| run.kind == EdgeKind::Silhouette) {
                silhouette.insert((run.polygon, run.edge.unwrap() as usize));
                hidden += usize::from(!run.is_visible);
            }
            let mut degrees: BTreeMap<[u64; 3], usize> = BTreeMap::new();
            for &(polygon, k) in &silhouette {
                let corners = &polygons[polygon];
                for end in [corners[k], corners[(k + 1) % corners.len()]] {
                    *degrees.entry(end.to_array().map(f64::to_bits)).or_default() += 1;
                }
            }
            let open = degrees.values().filter(|&degree| degree % 2 == 1).count();
            assert_eq!(open, 0, "{eye}");
            // The sides of planes decide, in floats, where the planes are far from the eye.
            edges += silhouette.len();
        }
    }
    enough!(edges > 2_000, hidden > 200; "{edges} {hidden}");
}

/// Where a quad is seen from its front on one side of its diagonal, and from behind on the other, the
/// silhouette goes along the diagonal.
#[test]
fn silhouettes_of_quads_that_are_not_planar_are_closed() {
    let mut dice = Dice(9);
    let (mut runs_in_all, mut inside) = (0, 0);
    for quads in [torus(24, 12), torus(60, 30)] {
        let tree = BspTree::build(&quads).unwrap();
        for _ in 0..6 {
            let eye = dice.point(-1.0, 1.0).normalize() * 30.0;
            let up = DVec3::new(0.1, 0.2, 1.0);
            let camera = Camera::perspective(eye, DVec3::ZERO, up, 0.6, [320, 240]).unwrap();
            let map = map_of(&tree, &camera);
            let runs = map.edges(Hidden::Keep).unwrap();
            let layered = map.edges(Hidden::Count).unwrap();
            let count = |runs: &[EdgeRun]| runs.iter().filter(|run| run.edge.is_none()).count();
            assert!(count(&layered) >= count(&runs));
            assert!(runs.iter().all(|run| run.edge.is_some() || run.kind == EdgeKind::Silhouette));
            let outline: Vec<_> =
                runs.iter().filter(|run| run.kind == EdgeKind::Silhouette).collect();
            let ends: Vec<[f64; 2]> = outline.iter().flat_map(|run| run.ends).collect();
            // At each end, another run begins or ends.
            let near = |a: &[f64; 2], b: &[f64; 2]| (0..2).all(|i| (a[i] - b[i]).abs() < 1e-5);
            let is_open =
                |end: &&[f64; 2]| ends.iter().filter(|other| near(end, other)).count() % 2 == 1;
            assert_eq!(ends.iter().filter(is_open).count(), 0, "{eye}");
            (runs_in_all, inside) = (runs_in_all + outline.len(), inside + count(&runs));
        }
    }
    enough!(runs_in_all > 1_000, inside > 100; "{runs_in_all} {inside}");
}

/// Two polygons with their fronts on different sides traverse their common edge in one direction. The edge is a
/// crease where the upper sides of both are seen, and a silhouette where one is seen from below.
#[test]
fn a_polygon_with_its_front_on_the_other_side_counts_as_reversed() {
    // Lifted by less than the tolerance, a quad is not planar, and one of its corners is moved. The polygons still
    // share the edge.
    for (turns, lift) in (0..16).flat_map(|turns| [(turns, 0.0), (turns, 4e-4)]) {
        let mut flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, lift]];
        let mut ramp = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 0.5], [2.0, 0.0, 0.5 + lift]];
        flat.rotate_left(turns % 4);
        ramp.rotate_left(turns / 4);
        let mut turned = ramp;
        turned.reverse();
        for other in [ramp, turned] {
            let options = BuildOptions::DEFAULT.with_tolerance(1e-3);
            let tree: BspTree = options.build([flat, other]).unwrap();
            assert_eq!(tree.preparation().flattened, if lift > 0.0 { 2 } else { 0 });
            for (way, is_crease) in [([0.1, 0.2, -1.0], true), ([-1.0, 0.1, -0.2], false)] {
                let centre = DVec3::new(1.0, 0.5, 0.0);
                let camera = Camera::parallel(way.into(), DVec3::Y, centre, 6.0, [80, 80]).unwrap();
                let edges = map_of(&tree, &camera).edges(Hidden::Keep).unwrap();
                let kinds = edges.iter().map(|run| run.kind).filter(|k| *k != EdgeKind::Border);
                let kinds: Vec<EdgeKind> = kinds.collect();
                assert!(!kinds.is_empty(), "{way:?}");
                for kind in kinds {
                    match kind {
                        EdgeKind::Crease(angle) => {
                            let off = (angle - 0.5f64.atan()).abs();
                            assert!(is_crease && off < 1e-9 + 4.0 * lift, "{angle}, {turns}")
                        }
                        kind => assert!(!is_crease, "{kind:?}, {turns}, {lift}"),
                    }
                }
            }
        }
    }
}
