//! Scenes so large that they are prepared in parts: the result is the same as in one part.

use binspace::Preparation;
use testkit::prelude::*;

/// More than the sixteen parts of 1024 polygons that are prepared at once.
const COUNT: usize = 20_000;
/// The polygons stand on a square grid with this many cells a side.
const ACROSS: usize = 150;

const TOLERANCE: f64 = 1e-3;

/// One of several kinds of polygons, in a separate cell. The number of kinds and the number of polygons in a
/// part are coprime, so that parts begin and end with different kinds. Two parts have only triangles.
fn polygon(i: usize) -> Corners {
    let kind = if [3, 17].contains(&(i / 1024)) { 0 } else { i % 7 };
    let flat: &[[f64; 3]] = match kind {
        // Its corner numbers count up from 0, like in all polygons that stay whole.
        0 => &[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 1.0]],
        // A corner given twice.
        1 => &[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 3.0, 0.0], [0.0, 3.0, 0.0]],
        // Not convex.
        2 => &[
            [0.0, 0.0, 0.0],
            [3.0, 0.0, 0.0],
            [3.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 3.0, 0.0],
            [0.0, 3.0, 0.0],
        ],
        // Without area.
        3 => &[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [3.0, 3.0, 0.0]],
        // Not planar: cut along its shorter diagonal, from corner 1 to 3.
        4 => &[[0.0, 1.5, 1.0], [1.5, 1.0, 0.0], [3.0, 1.5, 1.0], [1.5, 2.0, 0.0]],
        // Planar within the tolerance, so that a corner is moved.
        5 => &[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 2.0, 2f64.powi(-11)], [0.0, 3.0, 0.0]],
        // Not convex, and a corner given thrice.
        _ => &[
            [0.0, 0.0, 0.0],
            [3.0, 0.0, 1.0],
            [1.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 3.0, 0.0],
        ],
    };
    let cell = DVec3::new((i % ACROSS) as f64, (i / ACROSS) as f64, (i % 5) as f64);
    flat.iter().map(|&corner| cell * 4.0 + DVec3::from_array(corner)).collect()
}

/// A triangle whose bounding box contains all polygons, so that this triangle alone determines the lattice.
fn ground() -> Corners {
    let side = 4.0 * ACROSS as f64;
    [[-1.0, -1.0, -1.0], [side, -1.0, 20.0], [-1.0, side, 3.0]].map(DVec3::from).into()
}

fn scene(count: usize) -> Vec<Corners> {
    std::iter::once(ground()).chain((1..count).map(polygon)).collect()
}

fn prepare(polygons: &[Corners]) -> (Faces, Preparation) {
    Faces::new(polygons, Some(TOLERANCE)).expect("finite")
}

/// Corners, their numbers, the polygon's edges, and the corners that span the plane.
type FaceFacts = (Vec<[f64; 3]>, Vec<u32>, Vec<Option<u32>>, [u32; 3]);

fn facts(faces: &Faces, face: u32) -> FaceFacts {
    let corners = faces.corners(face);
    let all = 0..corners.len() as u32;
    let start = faces.corner_range(face).start as u32;
    (
        corners.to_vec(),
        all.clone().map(|k| faces.corner_number(face, k)).collect(),
        all.map(|k| faces.outline_edge(face, k)).collect(),
        faces.reference_triangle(face).map(|corner| corner - start),
    )
}

#[test]
fn every_polygon_is_prepared_as_beside_the_ground_alone() {
    let polygons = scene(COUNT);
    let (faces, report) = prepare(&polygons);
    let mut expected = Preparation::default();
    expected.polygons = 1;
    let mut dropped = Vec::new();
    let mut face = 1;
    for (i, polygon) in polygons.iter().enumerate().skip(1) {
        let (alone, found) = prepare(&[ground(), polygon.clone()]);
        for of_alone in 1..alone.len() as u32 {
            assert_eq!(faces.polygon(face), i);
            assert_eq!(facts(&faces, face), facts(&alone, of_alone), "face {face}, polygon {i}");
            face += 1;
        }
        expected.polygons += 1;
        expected.dropped += found.dropped;
        expected.triangulated += found.triangulated;
        expected.crossing += found.crossing;
        expected.flattened += found.flattened;
        expected.flattened_by = found.flattened_by.max(expected.flattened_by);
        expected.bent += found.bent;
        expected.bent_by = found.bent_by.max(expected.bent_by);
        dropped.extend((found.dropped > 0).then_some(i));
    }
    assert_eq!((face as usize, report), (faces.len(), expected));
    assert!(faces.dropped(report.polygons).eq(dropped));
    enough!(report.dropped > 1000, report.triangulated > 1000; "{report:?}");
}

#[test]
fn fragments_know_their_polygon_s_corners_and_edges() {
    let polygons = scene(5000);
    let options = BuildOptions::DEFAULT.with_tolerance(TOLERANCE);
    let tree: BspTree = options.build(&polygons).expect("finite");
    let mut outline = vec![0.0; polygons.len()];
    for fragment in tree.fragments() {
        let corners = &polygons[fragment.polygon()];
        let vertices: Vec<DVec3> = fragment.vertices().collect();
        for (vertex, weights) in vertices.iter().zip(fragment.weights()) {
            let sum: DVec3 = weights.iter().map(|&(k, weight)| corners[k as usize] * weight).sum();
            assert!(sum.distance(*vertex) <= 2.0 * TOLERANCE, "{fragment:?}");
        }
        for (k, edge) in fragment.edges().enumerate() {
            let Some(edge) = edge.map(|edge| edge as usize) else { continue };
            let [a, b] = [corners[edge], corners[(edge + 1) % corners.len()]];
            let ends = [vertices[k], vertices[(k + 1) % vertices.len()]];
            for end in ends {
                let beside = (b - a).normalize().cross(end - a).length();
                assert!(beside <= 2.0 * TOLERANCE, "edge {edge} of {fragment:?}");
            }
            outline[fragment.polygon()] += ends[0].distance(ends[1]);
        }
    }
    // Each edge of each polygon occurs once.
    let dropped: Vec<usize> = tree.dropped().collect();
    for (i, corners) in polygons.iter().enumerate() {
        let next = corners.iter().cycle().skip(1);
        let length: f64 = corners.iter().zip(next).map(|(a, b)| a.distance(*b)).sum();
        let expected = if dropped.binary_search(&i).is_ok() { 0.0 } else { length };
        assert!((outline[i] - expected).abs() <= 8.0 * TOLERANCE, "polygon {i}");
    }
}

/// Some polygons are built, and the rest extends the finished tree. A mesh has the given corners, also where
/// corners were moved onto a plane.
#[test]
fn a_tree_extended_by_several_parts_equals_the_tree_of_all_polygons() {
    let polygons = scene(5000);
    let options = BuildOptions::DEFAULT.with_tolerance(TOLERANCE);
    let expected = options.build(&polygons).expect("finite");
    let mut extended = options.build(&polygons[..1500]).expect("finite");
    extended.extend(&polygons[1500..]).expect("on the ground");
    for tree in [&expected, &extended] {
        assert_eq!(tree.preparation(), expected.preparation());
        assert!(tree.dropped().eq(expected.dropped()));
        let (mesh, mut moved) = (tree.mesh().expect("memory"), 0);
        for fragment in tree.fragments().filter(|fragment| fragment.is_whole()) {
            let k = fragment.polygon();
            // The polygon is of the kind that is planar within the tolerance.
            if polygons[k].len() == 4 && polygons[k][2].z.fract() == 2f64.powi(-11) {
                let range = mesh.triangles().range(fragment.index());
                for vertex in &mesh.triangles().indices()[range] {
                    let found = mesh.positions()[*vertex as usize];
                    assert!(polygons[k].contains(&found), "{k}: {found} for {:?}", polygons[k]);
                    moved += 1;
                }
            }
        }
        enough!(moved > 1500; "{moved} corners");
    }
}

#[test]
fn polygons_given_again_in_another_part_are_counted() {
    let mut polygons = scene(COUNT);
    let is_kept = |i: &usize| prepare(&[ground(), polygon(*i)]).1.dropped == 0;
    let again: Vec<usize> = (1..COUNT).step_by(311).filter(is_kept).collect();
    for (turn, &i) in again.iter().enumerate() {
        let mut copy = polygon(i);
        copy.rotate_left(turn % 3);
        polygons.push(copy);
    }
    assert_eq!(prepare(&polygons).0.duplicates(), again.len());
}
