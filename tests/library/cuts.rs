//! Cuts that neighbours must agree on.

use binspace::internals::{PreparedPlane, Vertex};
use proptest::prelude::*;
use std::collections::HashMap;
use testkit::model::Face;
use testkit::prelude::*;

/// Every edge between corners that the tolerance did not move, by its ends.
fn edges(faces: &Faces) -> HashMap<[[u64; 3]; 2], (u32, u32)> {
    let mut edges = HashMap::new();
    for face in 0..faces.len() as u32 {
        let (corners, exact) = (faces.corners(face), Face::new(faces, face));
        let stays = |k: usize| exact.corners[k] == rational::point(corners[k]);
        for k in 0..corners.len() {
            let next = (k + 1) % corners.len();
            if !stays(k) || !stays(next) {
                continue;
            }
            let ends = [corners[k], corners[next]];
            edges.insert(ends.map(|end| end.map(f64::to_bits)), (face, k as u32));
        }
    }
    edges
}

/// The point where a plane cuts edge `k` of a face, if it does.
fn cut_edge(faces: &Faces, plane: PlaneId, (face, k): (u32, u32)) -> Option<[f64; 3]> {
    let prepared = PreparedPlane::new(faces, plane);
    let next = (k + 1) % faces.corners(face).len() as u32;
    let [from, to] = [k, next].map(|k| Vertex::corner(faces, face, k));
    let side = |vertex| prepared.side(faces, face, vertex);
    if side(&from).is_eq() || side(&to) != side(&from).reverse() {
        return None;
    }
    Some(from.cut(faces, face, &prepared).position())
}

fn with_neighbours(mut polygons: Vec<Corners>, apex: DVec3) -> Vec<Corners> {
    let next_to = |polygon: &Corners| vec![polygon[1], polygon[0], apex];
    let neighbours: Vec<Corners> = polygons.iter().map(next_to).collect();
    polygons.extend(neighbours);
    polygons
}

#[test]
fn a_moved_corner_elsewhere_does_not_change_the_bits_of_a_common_edge() {
    let [a, b] = [DVec3::new(-1.0, 0.3, 0.7), DVec3::new(0.9, 0.1, -0.8)];
    let c = DVec3::new(1.1, 1.3, -0.1);
    // Corners 0, 2 and 3 span the largest triangle: corner 1 is moved.
    let last = a + (c - b) * 1.2 + DVec3::splat(1e-10);
    let cutting = |k: u32| {
        let at = a + (last - a) * (0.1 + 0.02 * f64::from(k));
        vec![at, at + DVec3::new(0.7, 0.1, 0.2), at + DVec3::new(0.3, -0.1 * f64::from(k), 0.5)]
    };
    let polygons: Vec<_> =
        [vec![a, b, c, last], vec![a, last, -c]].into_iter().chain((0..40).map(cutting)).collect();
    let faces = Faces::new(&polygons, None).expect("finite").0;
    assert!(faces.corners(0).len() == 4 && Face::new(&faces, 0).moved);
    let planes = || (2..42).map(PlaneId::face);
    assert!(planes().filter_map(|plane| cut_edge(&faces, plane, (0, 3))).count() > 20);
    for plane in planes() {
        assert_eq!(cut_edge(&faces, plane, (0, 3)), cut_edge(&faces, plane, (1, 0)));
    }
}

#[test]
fn neighbours_cut_their_common_edge_in_the_same_bits() {
    let scenes = (hard::scene(), prop::array::uniform3(-1.0..1.0f64));
    let counts = tally(file!(), 300, scenes, |[shared, cuts]: &mut [usize; 2], (scene, apex)| {
        let apex = scene.polygons[0][0] + DVec3::from_array(apex) * hard::extent(&scene.polygons);
        let tolerance = scene.tolerance();
        let polygons = with_neighbours(scene.polygons, apex);
        let (faces, _) = Faces::new(&polygons, tolerance).expect("finite");
        let edges = edges(&faces);
        let corners = (0..faces.len() as u32).map(|face| faces.corners(face).len() as u32).sum();
        let axes = (0..corners).map(|corner| PlaneId::axis(corner as usize % 3, corner));
        let planes: Vec<_> = (0..faces.len() as u32).map(PlaneId::face).chain(axes).collect();
        for (&[a, b], &here) in &edges {
            let Some(&there) = edges.get(&[b, a]) else { continue };
            *shared += 1;
            for &plane in planes.iter().take(24) {
                let pair = [here, there].map(|edge| cut_edge(&faces, plane, edge));
                prop_assert_eq!(pair[0], pair[1]);
                *cuts += usize::from(pair[0].is_some());
            }
        }
        Ok(())
    });
    let [shared, cuts] = counts;
    enough!(shared > 1500, cuts > 1500; "{shared} edges run both ways, {cuts} cuts");
}
