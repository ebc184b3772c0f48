//! Meshes of an overlay's pieces, and indices of both meshes in one order.

use std::collections::HashMap;

use binspace::mesh::Mesh;
use binspace::overlay::{Overlay, Shapes};
use binspace::{Culling, ErrorKind, Facing};
use proptest::prelude::*;
use testkit::prelude::*;
use testkit::shapes::{cuboid, rotation};

use super::{Divided, divide};

/// The area of some triangles as a vector.
fn area(triangles: &[u32], position: impl Fn(u32) -> DVec3) -> DVec3 {
    let of = |triangle: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|k| position(triangle[k]));
        (b - a).cross(c - a) * 0.5
    };
    triangles.chunks(3).map(of).sum()
}

/// One buffer contains both meshes. Each fragment and piece of the order has triangles with its polygon,
/// orientation and area.
#[test]
fn one_list_of_indices_draws_the_order_of_both() {
    let cases = (hard::scene(), any::<u64>(), hard::heuristic(), any::<u64>());
    let counts = tally(file!(), 128, cases, |counts: &mut [usize; 3], (scene, bits, by, seed)| {
        let Divided { tree, moving, .. } = divide(&scene, bits, by)?;
        let mut overlay = Overlay::new(&tree);
        let (lines, points) = (moving.iter().take(3), moving.iter().map(|polygon| polygon[0]));
        let shapes = Shapes::NONE.with_polygons(&moving).with_lines(lines).with_points(points);
        overlay.replace_with(&tree, shapes).map_err(fail)?;
        let (still, moved) =
            (tree.welded_mesh().map_err(fail)?, overlay.welded_mesh().map_err(fail)?);
        let vertices: Vec<(DVec3, usize)> =
            still.vertices().chain(moved.vertices()).map(|v| (v.position, v.polygon)).collect();
        let extent = hard::extent(&scene.polygons);
        let corners = scene.polygons.iter().flatten();
        let largest = corners.map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
        // Vertices are rounded, and corners that the tolerance moved are drawn at their given positions. The
        // tolerance of an overlay may be larger than the tree's.
        let faces = overlay.faces();
        let tolerance = faces.lattice().length_to_world(faces.tolerance());
        let slack = (1e-12 * extent + 1e-14 * largest + 8.0 * tolerance) * extent;
        let eye = Viewpoint::Eye(Dice(seed).point(-2.0, 2.0) * extent);
        let culling = Culling::NONE.with_facing(Facing::Front);
        let order = overlay.order(&tree, eye).map_err(fail)?;
        for order in [order, order.culled(&culling)] {
            let (mut numbers, mut indices) = (vec![], vec![u32::MAX; 9 * vertices.len()]);
            order.write_into(&mut numbers);
            let (still, moved) = (still.triangles(), moved.triangles());
            let count = still.write_order_with(moved, &numbers, &mut indices).map_err(fail)?;
            prop_assert!(indices[count..].iter().all(|&index| index == u32::MAX));
            let mut rest = &indices[..count];
            for shape in order {
                let Some(fragment) = shape.fragment() else { continue };
                let is_piece = fragment.index() as usize >= tree.len();
                let of = if is_piece { moved } else { still };
                let (own, later) = rest.split_at(of.range(fragment.index()).len());
                rest = later;
                prop_assert!(own.iter().all(|&v| vertices[v as usize].1 == fragment.polygon()));
                let outline: Vec<DVec3> = fragment.vertices().collect();
                let fan: Vec<u32> =
                    (1..outline.len() as u32 - 1).flat_map(|k| [0, k, k + 1]).collect();
                let expected = area(&fan, |k| outline[k as usize]);
                let off = area(own, |v| vertices[v as usize].0) - expected;
                prop_assert!(off.length() < slack, "{off} of {expected}");
                counts[usize::from(is_piece)] += 1;
            }
            prop_assert!(rest.is_empty());
        }
        // Only the pieces, by their numbers in the order.
        let mut numbers: Vec<u32> = vec![];
        overlay.order(&tree, eye).map_err(fail)?.write_into(&mut numbers);
        numbers.retain(|&number| number as usize >= tree.len());
        let mut indices = vec![0; moved.triangles().indices().len()];
        let count = moved.triangles().write_order(&numbers, &mut indices).map_err(fail)?;
        prop_assert_eq!(count, indices.len());
        let mut sorted = [moved.triangles().indices(), &indices].map(<[u32]>::to_vec);
        sorted.iter_mut().for_each(|list| list.sort_unstable());
        prop_assert!(sorted[0] == sorted[1]);
        counts[2] += 1;
        Ok(())
    });
    assert!(counts[0] > 300 && counts[1] > 500 && counts[2] > 100, "{counts:?}");
}

/// The number of edges of the triangles, from point to point, that do not run once in each direction.
fn open(mesh: &Mesh) -> usize {
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    for triangle in mesh.triangles().indices().chunks(3) {
        for k in 0..3 {
            let [a, b] = [triangle[k], triangle[(k + 1) % 3]].map(|v| mesh.vertex(v).point);
            *edges.entry([a.min(b), a.max(b)]).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    edges.values().filter(|&&sum| sum != 0).count()
}

/// A box that moves through the polygons of a tree, which cut it.
#[test]
fn a_body_that_moves_stays_closed() {
    let scene = scene::random_triangles(300, 3);
    let options = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-2.0), DVec3::splat(3.0));
    let tree = options.build(scene.polygons()).unwrap();
    let mut overlay = Overlay::new(&tree);
    let mut pieces = 0;
    for k in 0..20 {
        let turn = rotation([0.3 * f64::from(k), 0.2, 1.1]);
        let middle = DVec3::splat(0.05 * f64::from(k));
        let body = cuboid(turn, middle, DVec3::new(0.4, 0.3, 0.2));
        overlay.replace(&tree, &body).unwrap();
        let mesh = overlay.welded_mesh().unwrap();
        assert_eq!(open(&mesh), 0, "{k}");
        let first = tree.preparation().polygons;
        assert!(mesh.vertices().all(|v| (first..first + 6).contains(&v.polygon)));
        pieces += overlay.len();
    }
    assert!(pieces > 5000, "{pieces}");
}

#[test]
fn empty_overlays_and_other_trees() {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let [tree, other] = [(); 2].map(|()| BspTree::build([square(0.0), square(1.0)]).unwrap());
    let mesh = tree.welded_mesh().unwrap();
    let mut overlay = Overlay::new(&tree);
    let eye = Viewpoint::eye([0.5, 0.5, 5.0]);
    let (mut order, mut indices) = (vec![], vec![7; 18]);
    for count in [12, 18] {
        let moved = overlay.welded_mesh().unwrap();
        overlay.order(&tree, eye).unwrap().write_into(&mut order);
        let written = mesh.triangles().write_order_with(moved.triangles(), &order, &mut indices);
        assert_eq!(written.unwrap(), count);
        overlay.replace(&tree, [square(0.5)]).unwrap();
    }
    let moved = overlay.welded_mesh().unwrap();
    overlay.order(&tree, eye).unwrap().write_into(&mut order);
    let mut few = [7; 17];
    let error = mesh.triangles().write_order_with(moved.triangles(), &order, &mut few).unwrap_err();
    assert!(error.to_string().contains("18"), "{error}");
    assert_eq!(few, [7; 17], "nothing is written");
    let others = other.welded_mesh().unwrap();
    let mut write = |still: &Mesh, moved: &Mesh| {
        let written = still.triangles().write_order_with(moved.triangles(), &order, &mut indices);
        written.unwrap_err().kind()
    };
    assert_eq!(write(&others, &moved), ErrorKind::OtherTree);
    assert_eq!(write(&moved, &moved), ErrorKind::OtherTree);
    assert_eq!(write(&mesh, &mesh), ErrorKind::OtherTree);
    let error = moved.triangles().write_back_to_front(&tree, eye, &mut vec![], &mut [0; 18]);
    assert_eq!(error.unwrap_err().kind(), ErrorKind::OtherTree);
}

/// Meshes are distinguished even if their numbers of fragments are equal. A part of the triangles keeps the
/// pieces' numbers.
#[test]
fn a_mesh_of_pieces_is_neither_a_trees_nor_loses_its_numbers() {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let tree = BspTree::build([square(0.0), square(2.0)]).unwrap();
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, [square(1.0), square(1.5)]).unwrap();
    let (still, moved) = (tree.welded_mesh().unwrap(), overlay.welded_mesh().unwrap());
    let mut indices = vec![7; 24];
    let twice = moved.triangles().write_order_with(moved.triangles(), &[2, 3], &mut indices);
    assert_eq!(twice.unwrap_err().kind(), ErrorKind::OtherTree);
    let all = moved.triangles_of(|_| true).unwrap();
    let written = still.triangles().write_order_with(&all, &[0, 2, 3, 1], &mut indices);
    assert_eq!(written.unwrap(), 24);
    let polygons = indices.chunks(6).map(|piece| {
        let vertex = piece[0] as usize;
        if vertex < still.len() {
            still.vertex(vertex as u32).polygon
        } else {
            moved.vertex((vertex - still.len()) as u32).polygon
        }
    });
    assert!(polygons.eq([0, 2, 3, 1]));
}

/// The space after the indices of the last fragment is not a fragment.
#[test]
#[should_panic(expected = "out of bounds")]
fn a_tree_has_no_triangles_of_an_overlays_pieces() {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let mesh = BspTree::build([square(0.0), square(2.0)]).unwrap().welded_mesh().unwrap();
    let _ = mesh.triangles().write_order(&[2, 0], &mut [0; 24]);
}
