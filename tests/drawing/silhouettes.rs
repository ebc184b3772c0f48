//! Silhouettes of closed bodies are closed: at each corner as many of their edges begin as end.

use std::collections::{BTreeMap, BTreeSet};

use binspace::BspTree;
use binspace::drawing::{EdgeKind, VisibilityMap};
use binspace::glam::DVec3;
use binspace::internals::SplitMix64;
use binspace::raster::Rays;
use binspace::view::Camera;

type Corners = Vec<Vec<DVec3>>;

/// A ring of quads, not convex, with lumps.
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
    let triangles = quads.flat_map(|(i, k)| {
        let [a, b, c, d] =
            [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)].map(|(i, k)| point(i, k));
        [vec![a, b, c], vec![a, c, d]]
    });
    triangles.collect()
}

#[test]
fn silhouettes_of_closed_bodies_are_closed() {
    let mut random = SplitMix64::new(9);
    let (mut edges, mut hidden) = (0, 0);
    for polygons in [torus(24, 12), torus(60, 30)] {
        let tree = BspTree::build(&polygons).unwrap();
        for _ in 0..12 {
            let eye = random.point(-1.0, 1.0).normalize() * 30.0;
            let up = DVec3::new(0.1, 0.2, 1.0);
            let camera = Camera::perspective(eye, DVec3::ZERO, up, 0.6, [320, 240]).unwrap();
            let rays = Rays::new(&camera, tree.faces()).unwrap();
            let runs = VisibilityMap::of(&tree, rays).unwrap().edges().unwrap();
            assert!(runs.iter().all(|run| run.kind != EdgeKind::Border));
            // Each edge once, in however many runs.
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
            // By the sides of planes, in floats: where they are far from the eye.
            edges += silhouette.len();
        }
    }
    assert!(edges > 2_000 && hidden > 200, "{edges} {hidden}");
}
