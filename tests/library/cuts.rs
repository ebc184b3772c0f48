//! Cuts that other libraries get wrong, and cuts that neighbours must agree on.

use binspace::glam::DVec3;
use binspace::internals::{Faces, PlaneId, PreparedPlane, Side, Vertex, VertexKind, split};
use proptest::prelude::*;
use std::collections::HashMap;
use testkit::enough;
use testkit::hard;
use testkit::model::{self, Face};
use testkit::rational;
use testkit::shapes::Corners;
use testkit::tally::tally;

fn faces(polygons: &[Corners]) -> Faces {
    Faces::new(polygons, None).expect("finite").0
}

fn corners(points: &[[f64; 3]]) -> Corners {
    points.iter().map(|&p| p.into()).collect()
}

fn classify(faces: &Faces, plane: PlaneId, face: u32) -> Side {
    (PreparedPlane::new(faces, plane)).classify(faces, face, None)
}

fn outline(faces: &Faces, face: u32) -> Vec<Vertex> {
    let count = faces.corners(face).len() as u32;
    (0..count).map(|k| Vertex::corner(faces, face, k)).collect()
}

fn parts(faces: &Faces, plane: PlaneId, face: u32) -> [Vec<Vertex>; 2] {
    let (mut front, mut back) = (Vec::new(), Vec::new());
    let prepared = PreparedPlane::new(faces, plane);
    let whole = outline(faces, face);
    split(faces, &prepared, face, &whole, &mut front, &mut back);
    [front, back]
}

fn has_area(faces: &Faces, face: u32, part: &[Vertex]) -> bool {
    let exact = Face::new(faces, face);
    let points: Vec<_> = part.iter().map(|v| exact.resolve(faces, v.vertex_id())).collect();
    rational::area(&points).iter().any(|c| !c.is_zero())
}

#[test]
fn a_pentagon_with_corners_next_to_the_plane_gives_two_proper_pieces() {
    let pentagon = corners(&[
        [9.0, 9.0, 5.0],
        [1.0, 1.0, 0.001],
        [1.0, 1.0, 0.0],
        [1.002, 1.002, -0.005],
        [9.0, 9.0, -4.0],
    ]);
    let ground = corners(&[[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 9.0, 0.0], [0.0, 9.0, 0.0]]);
    let faces = faces(&[pentagon, ground]);
    assert_eq!(faces.len(), 2);
    for plane in [PlaneId::face(1), PlaneId::axis(2, 2), PlaneId::axis(2, 6)] {
        assert_eq!(classify(&faces, plane, 0), Side::Spanning);
        let [above, below] = parts(&faces, plane, 0);
        // The corner on the plane belongs to both, with one new vertex on the far edge.
        assert_eq!((above.len(), below.len()), (4, 4));
        for part in [&above, &below] {
            assert!(has_area(&faces, 0, part));
            let on_plane = part.iter().filter(|v| v.line().as_cut() == Some(plane)).count();
            assert_eq!(on_plane, 1);
        }
        let ground_level = faces.corner(2)[2];
        assert!(above.iter().all(|v| v.position()[2] >= ground_level));
        assert!(below.iter().all(|v| v.position()[2] <= ground_level));
    }
}

#[test]
fn a_square_that_touches_the_plane_with_an_edge_is_not_cut() {
    let ground = corners(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]);
    let standing = |height: f64| {
        let (base, top) =
            ([[-0.5, 0.1, 0.0], [0.7, 0.3, 0.0]], [[0.7, 0.3, height], [-0.5, 0.1, height]]);
        corners(&[base[0], base[1], top[0], top[1]])
    };
    let corner_down = corners(&[[0.0, 0.0, 0.0], [0.5, 0.0, 0.5], [-0.5, 0.0, 0.5]]);
    let faces = faces(&[ground, standing(1.0), standing(-1.0), corner_down]);
    for plane in [PlaneId::face(0), PlaneId::axis(2, 0)] {
        let sides = [1, 2, 3].map(|face| classify(&faces, plane, face));
        assert_eq!(sides, [Side::Front, Side::Back, Side::Front]);
    }
}

#[test]
fn of_two_crossing_squares_either_cuts_the_other_in_two() {
    let flat = corners(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]);
    let upright = flat.iter().map(|p| DVec3::new(p.x, 0.0, p.y)).collect();
    let faces = faces(&[flat, upright]);
    for (plane, face) in [(0, 1), (1, 0)] {
        let plane = PlaneId::face(plane);
        assert_eq!(classify(&faces, plane, face), Side::Spanning);
        assert_eq!(parts(&faces, plane, face).map(|part| part.len()), [4, 4]);
    }
}

#[test]
fn a_square_beside_another_s_plane_is_cut_only_the_other_way_round() {
    let wide = corners(&[[-2.0, -1.0, 0.0], [2.0, -1.0, 0.0], [2.0, 1.0, 0.0], [-2.0, 1.0, 0.0]]);
    let above = corners(&[[0.5, -1.0, 0.5], [0.5, 1.0, 0.5], [0.5, 1.0, 2.5], [0.5, -1.0, 2.5]]);
    let faces = faces(&[wide, above]);
    assert_eq!(classify(&faces, PlaneId::face(0), 1), Side::Front);
    assert_eq!(classify(&faces, PlaneId::face(1), 0), Side::Spanning);
}

#[test]
fn nested_squares_in_one_plane_are_coplanar_whichever_way_they_face() {
    let square = |r: f64| {
        let around = [[-r, -r], [r, -r], [r, r], [-r, r]];
        around.map(|[x, y]| DVec3::new(x, y, 0.3 * x + 0.7 * y)).to_vec()
    };
    let mut reversed = square(0.2);
    reversed.reverse();
    let faces = faces(&[square(1.0), square(0.6), reversed]);
    for (plane, face) in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)] {
        assert_eq!(classify(&faces, PlaneId::face(plane), face), Side::Coplanar);
    }
}

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

/// Where a plane cuts edge `k` of a face, if it does.
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
    // Corners 0, 2 and 3 span most: corner 1 is moved.
    let last = a + (c - b) * 1.2 + DVec3::splat(1e-10);
    let cutting = |k: u32| {
        let at = a + (last - a) * (0.1 + 0.02 * f64::from(k));
        vec![at, at + DVec3::new(0.7, 0.1, 0.2), at + DVec3::new(0.3, -0.1 * f64::from(k), 0.5)]
    };
    let polygons: Vec<_> =
        [vec![a, b, c, last], vec![a, last, -c]].into_iter().chain((0..40).map(cutting)).collect();
    let faces = faces(&polygons);
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

#[test]
fn a_vertex_on_an_axis_plane_is_on_it_to_the_last_bit() {
    let vertices = tally(file!(), 300, hard::scene(), |vertices: &mut usize, scene| {
        let faces = scene.faces();
        for face in 0..faces.len() as u32 {
            let exact = Face::new(&faces, face);
            for corner in 0..faces.corner_range(faces.len() as u32 - 1).end.min(16) as u32 {
                let axis = corner as usize % 3;
                let plane = PlaneId::axis(axis, corner);
                if classify(&faces, plane, face) != Side::Spanning {
                    continue;
                }
                let (at, by) = (faces.corner(corner)[axis], model::plane(&faces, plane));
                let [front, back] = parts(&faces, plane, face);
                for vertex in front.iter().chain(&back) {
                    let exact = by.at(&exact.resolve(&faces, vertex.vertex_id()));
                    let corner = matches!(vertex.vertex_id().kind(), VertexKind::Corner(_));
                    prop_assert!(corner || exact.is_zero());
                    prop_assert!(corner || vertex.position()[axis] == at);
                    *vertices += usize::from(!corner);
                }
            }
        }
        Ok(())
    });
    enough!(vertices > 5000; "{vertices} vertices");
}
