//! Many triangles around one vertex. The number of cells is linear in the number of triangles, not quadratic.

use super::map_of;
use testkit::prelude::*;
use testkit::shapes::fan;

/// Views of a vertex above the origin. It is in the middle of the picture in some views, and elsewhere in
/// others.
fn cameras(height: f64) -> Vec<Camera> {
    let tip = DVec3::new(0.0, 0.0, height);
    let from =
        [DVec3::new(0.01, 0.02, 1.0), DVec3::new(1.0, 0.3, 0.4), DVec3::new(0.3, -0.9, 0.05)];
    let (size, up) = ([400, 300], DVec3::Z);
    let views = from.iter().flat_map(|from| {
        [tip, tip + DVec3::new(0.1, 0.2, -0.3)].map(|at| (from.normalize() * 4.0, at))
    });
    views.map(|(from, at)| Camera::perspective(at + from, at, up, 0.7, size).unwrap()).collect()
}

/// The largest number of cells per visible polygon in a picture. Each visible polygon is one whole path.
fn most_cells(polygons: &[Vec<DVec3>], height: f64) -> f64 {
    let tree = BspTree::build(polygons).unwrap();
    let cells = |camera: &Camera| {
        let map = map_of(&tree, camera);
        let drawing = map.drawing().unwrap();
        let visible = map.polygons().count();
        assert_eq!(drawing.paths().len(), visible);
        assert!(drawing.paths().all(|path| !path.is_clipped()));
        map.cells().count() as f64 / visible as f64
    };
    cameras(height).iter().map(cells).fold(0.0, f64::max)
}

#[test]
fn cells_of_fans_and_cones_grow_with_their_triangles() {
    for height in [0.0, 1.5, -1.5] {
        for count in [100, 600, 3_000] {
            let most = most_cells(&fan(count, height), height);
            assert!(most < 10.0, "{count} triangles, {height} high: {most} cells each");
        }
    }
}

/// A globe. Each pole is a vertex of one triangle per slice.
#[test]
fn cells_of_poles_grow_with_their_triangles() {
    for slices in [100, 300, 1_000] {
        let at = |slice: usize, ring: usize| {
            let angle = std::f64::consts::TAU * (slice % slices) as f64 / slices as f64;
            let (width, height) = [(0.0, 1.0), (0.6, 0.8), (0.6, -0.8), (0.0, -1.0)][ring];
            DVec3::new(width * angle.cos(), width * angle.sin(), height)
        };
        let mut polygons = Vec::new();
        for slice in 0..slices {
            for ring in 0..3 {
                let [a, b] = [ring, ring + 1].map(|ring| at(slice, ring));
                let [c, d] = [ring + 1, ring].map(|ring| at(slice + 1, ring));
                polygons.extend([vec![a, b, c], vec![a, c, d]]);
            }
        }
        polygons.retain(|corners| {
            (corners[1] - corners[0]).cross(corners[2] - corners[0]) != DVec3::ZERO
        });
        let most = most_cells(&polygons, 1.0);
        assert!(most < 14.0, "{slices} slices: {most} cells each");
    }
}
