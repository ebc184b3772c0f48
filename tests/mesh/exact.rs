//! Points, triangles and weights compared with exact rationals.

use super::open_edges;
use binspace::internals::{EdgeLine, LATTICE_LIMIT};
use binspace::mesh::Mesh;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use std::collections::HashMap;
use testkit::hard::Tolerance;
use testkit::model::{Face, main_axis};
use testkit::prelude::*;
use testkit::rational::{Point, difference, product};

/// The counts of checks.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    pub(crate) triangles: usize,
    inserted: usize,
    fragments: usize,
    /// Fragments of faces that have moved corners.
    moved: usize,
    /// Fragments that are not judged, because two vertices are too near to each other to be distinguished.
    skipped: usize,
}

/// The exact place of each point, from the fragments that have it as a vertex.
fn places(
    tree: &BspTree,
    mesh: &Mesh,
    faces: &[Face],
) -> Result<Vec<Option<Point>>, TestCaseError> {
    let mut places: Vec<Option<Point>> = vec![None; mesh.positions().len()];
    for fragment in tree.fragments() {
        let face = &faces[fragment.face() as usize];
        let mut vertices =
            mesh.triangles().indices()[mesh.triangles().range(fragment.index())].to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        for (vertex_id, rounded) in fragment.vertex_ids().zip(fragment.vertices()) {
            let distance = |&v: &u32| mesh.vertex(v).position.distance(rounded);
            vertices.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
            prop_assert!(vertices.len() >= 3, "a fragment without triangles");
            prop_assert!(distance(&vertices[0]) <= 1e-12 * hard_size(tree));
            // Rounding may have exchanged two vertices, so neither position is known from this fragment.
            if distance(&vertices[1]) <= 4e-12 * hard_size(tree) {
                continue;
            }
            let exact = face.resolve(tree.faces(), vertex_id);
            let place = &mut places[mesh.vertex(vertices[0]).point as usize];
            prop_assert!(
                place.as_ref().is_none_or(|place| *place == exact),
                "one point, two places"
            );
            *place = Some(exact);
        }
    }
    Ok(places)
}

fn hard_size(tree: &BspTree) -> f64 {
    let size = |p: DVec3| p.abs().max_element();
    tree.fragments().flat_map(|f| f.vertices()).map(size).fold(f64::MIN_POSITIVE, f64::max)
}

fn check(tree: &BspTree, polygons: &[Vec<DVec3>], seen: &mut Seen) -> Result<(), TestCaseError> {
    let faces: Vec<Face> =
        (0..tree.faces().len() as u32).map(|face| Face::new(tree.faces(), face)).collect();
    let mesh = tree.welded_mesh().unwrap();
    let places = places(tree, &mesh, &faces)?;
    let place = |vertex: u32| places[mesh.vertex(vertex).point as usize].as_ref();
    for fragment in tree.fragments() {
        let face = &faces[fragment.face() as usize];
        let axis = main_axis(&face.plane);
        let facing = rational::sign(&face.plane.normal[axis]);
        let outline: Vec<Point> =
            fragment.vertex_ids().map(|vertex_id| face.resolve(tree.faces(), vertex_id)).collect();
        let whole = rational::area(&outline);
        let mut sum = [0.0; 3].map(rational::exact);
        let triangles = &mesh.triangles().indices()[mesh.triangles().range(fragment.index())];
        seen.fragments += 1;
        if triangles.iter().any(|&vertex| place(vertex).is_none()) {
            seen.skipped += 1;
            continue;
        }
        seen.inserted += triangles.len() / 3 + 2 - fragment.vertex_count();
        for triangle in triangles.chunks(3) {
            let [Some(a), Some(b), Some(c)] = [0, 1, 2].map(|k| place(triangle[k])) else {
                continue;
            };
            let area = product(&difference(b, a), &difference(c, a));
            prop_assert_eq!(
                rational::sign(&area[axis]),
                facing,
                "a triangle without area or turned"
            );
            sum = rational::sum(&sum, &area);
            seen.triangles += 1;
        }
        prop_assert_eq!(sum, whole, "the triangles do not fill fragment {}", fragment.index());
    }
    weights_match(&mesh, polygons, 1e-9 * hard_size(tree))?;
    inner_edges_match(tree, &mesh, 1e-11 * hard_size(tree))
}

/// Checks that the weights of every vertex give its place, up to the length `slack`.
fn weights_match(mesh: &Mesh, polygons: &[Vec<DVec3>], slack: f64) -> Result<(), TestCaseError> {
    for vertex in mesh.vertices() {
        let sum: f64 = vertex.weights.iter().map(|&(_, weight)| weight).sum();
        prop_assert!((sum - 1.0).abs() < 1e-12);
        let at: DVec3 = vertex
            .weights
            .iter()
            .map(|&(corner, weight)| polygons[vertex.polygon][corner as usize] * weight)
            .sum();
        prop_assert!(at.distance(vertex.position) <= slack, "{vertex:?}");
    }
    Ok(())
}

/// If corners are moved onto planes, points stay at their given places. Their weights, in `f64`, give the
/// positions in the face's plane. There, triangles fill their fragments up to the tolerance.
pub(crate) fn check_moved(
    tree: &BspTree,
    polygons: &[Vec<DVec3>],
    seen: &mut Seen,
) -> Result<(), TestCaseError> {
    let faces = tree.faces();
    let mesh = tree.welded_mesh().unwrap();
    let slack = (1e-9 * LATTICE_LIMIT + 8.0 * faces.tolerance()) * LATTICE_LIMIT;
    for fragment in tree.fragments() {
        let face = Face::new(faces, fragment.face());
        let axis = main_axis(&face.plane);
        let facing = if rational::sign(&face.plane.normal[axis]).is_gt() { 1.0 } else { -1.0 };
        let outline: Vec<Point> =
            fragment.vertex_ids().map(|vertex_id| face.resolve(faces, vertex_id)).collect();
        let whole = facing * rational::area(&outline)[axis].to_f64().value();
        let corners: HashMap<u32, DVec3> = (0..)
            .zip(&face.corners)
            .map(|(k, corner)| {
                let at = corner.each_ref().map(|coordinate| coordinate.to_f64().value());
                (faces.corner_number(fragment.face(), k), DVec3::from_array(at))
            })
            .collect();
        let place = |vertex: u32| -> DVec3 {
            mesh.vertex(vertex)
                .weights
                .iter()
                .map(|(corner, weight)| corners[corner] * *weight)
                .sum()
        };
        let triangles = &mesh.triangles().indices()[mesh.triangles().range(fragment.index())];
        let mut sum = 0.0;
        for triangle in triangles.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|k| place(triangle[k]));
            let area = facing * (b - a).cross(c - a)[axis];
            prop_assert!(area >= -slack, "a triangle is turned by more than the tolerance");
            sum += area;
            seen.triangles += 1;
        }
        // A sliver whose given corners have no area has no triangles.
        prop_assert!((sum - whole).abs() <= slack * fragment.vertex_count() as f64);
        seen.fragments += 1;
        seen.moved += usize::from(face.moved);
        // The vertices of a sliver may be one point in the given corners.
        seen.inserted += (triangles.len() / 3 + 2).saturating_sub(fragment.vertex_count());
    }
    let moved = 4.0 * faces.lattice().length_to_world(faces.tolerance());
    weights_match(&mesh, polygons, 1e-9 * hard_size(tree) + moved)?;
    inner_edges_match(tree, &mesh, 1e-11 * hard_size(tree) + moved)
}

/// No edge between fragments of a face is open: all open edges lie on the edges of the face.
fn inner_edges_match(tree: &BspTree, mesh: &Mesh, slack: f64) -> Result<(), TestCaseError> {
    let mut by_face: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut on_edges: HashMap<u32, usize> = HashMap::new();
    for fragment in tree.fragments() {
        by_face.entry(fragment.face()).or_default().push(fragment.index());
        // Edges shorter than the distance by which corners were moved may have no length in the input.
        let vertices: Vec<DVec3> = fragment.vertices().collect();
        let outer = |(k, line): &(usize, EdgeLine)| {
            let next = vertices[(k + 1) % vertices.len()];
            line.as_edge().is_some() && vertices[*k].distance(next) > slack
        };
        let outer = fragment.lines().enumerate().filter(outer).count();
        *on_edges.entry(fragment.face()).or_default() += outer;
    }
    for (face, fragments) in by_face {
        let open = open_edges(mesh, mesh.triangles(), &fragments);
        // The open edges are closed paths: at each point, the numbers of outgoing and incoming edges are
        // equal.
        let mut balance: HashMap<u32, i32> = HashMap::new();
        for (&[a, b], &count) in &open {
            *balance.entry(a).or_default() += count;
            *balance.entry(b).or_default() -= count;
            prop_assert_eq!(count.abs(), 1);
        }
        prop_assert!(balance.values().all(|&count| count == 0));
        let corners = tree.faces().corners(face).len();
        prop_assert!(open.len() >= corners.max(on_edges[&face]));
        let is_on_outline = |ends: &&[u32; 2]| is_on_outline(tree, mesh, face, **ends, slack);
        let on_outline = open.keys().filter(is_on_outline).count();
        prop_assert_eq!(on_outline, open.len(), "face {} is open inside", face);
    }
    Ok(())
}

/// Whether both ends are within `slack` of one edge of a face.
fn is_on_outline(tree: &BspTree, mesh: &Mesh, face: u32, ends: [u32; 2], slack: f64) -> bool {
    let lattice = tree.faces().lattice();
    let corners: Vec<DVec3> =
        tree.faces().corners(face).iter().map(|&corner| lattice.to_world(corner)).collect();
    (0..corners.len()).any(|k| {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        ends.iter().all(|&end| {
            let to = mesh.positions()[end as usize] - a;
            let foot = (b - a) * (to.dot(b - a) / (b - a).length_squared());
            to.distance(foot) <= slack
        })
    })
}

#[test]
fn triangles_fill_fragments_exactly() {
    let cases = (hard::scene(), hard::heuristic());
    let seen: Seen = tally(file!(), 64, cases, |seen: &mut Seen, (scene, by)| {
        let scene = scene.with_tolerance(Tolerance::Share(0.0));
        check(&scene.build(by).unwrap(), &scene.polygons, seen)
    });
    enough!(seen.triangles > 1500, seen.inserted > 75; "{seen:?}");
    assert!(3 * seen.skipped < seen.fragments, "{seen:?}");
}

#[test]
fn triangles_fill_fragments_of_moved_faces() {
    let shares = prop_oneof![
        Just(Tolerance::Default),
        (-12.0..-4.0f64).prop_map(|exponent| Tolerance::Share(10f64.powf(exponent))),
    ];
    let cases = (hard::scene(), shares, hard::heuristic());
    let seen: Seen = tally(file!(), 64, cases, |seen: &mut Seen, (scene, share, by)| {
        let scene = scene.with_tolerance(share);
        check_moved(&scene.build(by).unwrap(), &scene.polygons, seen)
    });
    enough!(seen.triangles > 1000, seen.inserted > 50, seen.moved > 35; "{seen:?}");
}
