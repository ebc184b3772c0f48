//! Planes, faces and vertices that name missing parts of the input.

use super::{Dismantled, Stored, assert_fault, build, crossing, verdict};
use crate::build::Heuristic;
use crate::exact::{EdgeLine, PlaneId, PreparedPlane, Vertex};
use crate::scene;
use crate::tree::BspTree;

const OUTLINE: &str = "does not have three or more known vertices";

/// The first fragment that is not a whole face.
fn cut_piece(parts: &Dismantled) -> usize {
    parts.pieces.iter().position(|(_, vertices)| !vertices.is_empty()).expect("a cut")
}

/// Replaces the first vertex of a cut piece, and asserts that validation does not know the new vertex.
#[track_caller]
fn assert_unknown(tree: &BspTree, vertex: Stored) {
    let edit = |parts: &mut Dismantled| {
        let piece = cut_piece(parts);
        parts.pieces[piece].1[0] = vertex;
    };
    assert_fault(tree, edit, OUTLINE);
}

#[test]
fn planes_of_missing_faces_and_corners_are_found() {
    for tree in [crossing(5), build(&scene::city(300, 1), Heuristic::default())] {
        let (faces, corners) = (tree.faces.len() as u32, tree.faces.corner_count() as u32);
        let unknown = [
            PlaneId::face(faces),
            PlaneId::face(u32::MAX >> 4),
            PlaneId::axis(0, corners),
            PlaneId::axis(2, u32::MAX >> 4),
            PlaneId::axis(3, 0),
            PlaneId::axis(4, 0),
        ];
        for plane in unknown {
            for node in [0, tree.nodes.len() / 2, tree.nodes.len() - 1] {
                // A missing plane cannot be rounded, so `Dismantled::tree` cannot make this tree.
                let mut tree = tree.clone();
                tree.nodes[node].plane = plane;
                let said = verdict(&tree);
                assert!(said.contains("names a face or corner that does not exist"), "{said}");
                assert!(said.starts_with(&format!("node {node}: ")), "{said}");
            }
        }
    }
}

#[test]
fn missing_faces_and_vertices_are_found() {
    let tree = crossing(5);
    let faces = tree.faces.len() as u32;
    assert_fault(&tree, |parts| parts.pieces[0].0 = faces, OUTLINE);
    assert_fault(&tree, |parts| parts.pieces[3].0 = u32::MAX, OUTLINE);

    // Vertices of a scene with more faces and corners.
    let large = crossing(9);
    let octagon: Vec<_> =
        (0..8).map(|k| glam::DVec2::from_angle(f64::from(k)).extend(f64::from(k))).collect();
    let other = BspTree::build([octagon]).expect("finite");
    if let Some(beyond) = (0..other.faces.len() as u32).find(|&f| other.faces.corners(f).len() > 5)
    {
        assert_unknown(&tree, (Vertex::corner(&other.faces, beyond, 5)).stored());
    }
    let corner = Vertex::corner(&large.faces, 1, 0);
    let on = |plane| {
        let prepared = PreparedPlane::new(&large.faces, plane);
        corner.cut(&large.faces, 1, &prepared)
    };
    let on_edge = on(PlaneId::face(8));
    assert_unknown(&tree, on_edge.stored());
    assert_unknown(&tree, (on(PlaneId::axis(1, 35))).stored());
    let along_cut = corner.with_line(EdgeLine::cut(PlaneId::axis(2, 0), true));
    let prepared = PreparedPlane::new(&large.faces, PlaneId::face(8));
    let inside = along_cut.cut(&large.faces, 1, &prepared);
    assert_unknown(&tree, inside.with_line(EdgeLine::edge(0)).stored());
    // A vertex of a known plane and an unknown plane, in either order.
    for (known, unknown) in [
        (PlaneId::face(0), PlaneId::face(8)),
        (PlaneId::face(0), PlaneId::axis(0, 35)),
        (PlaneId::axis(0, 0), PlaneId::face(8)),
    ] {
        let along_cut = corner.with_line(EdgeLine::cut(known, true));
        let prepared = PreparedPlane::new(&large.faces, unknown);
        let inside = along_cut.cut(&large.faces, 1, &prepared);
        assert_unknown(&tree, inside.with_line(EdgeLine::edge(0)).stored());
    }
}

#[test]
fn corners_and_lines_beyond_a_face_are_found() {
    let tree = crossing(5);
    let piece = cut_piece(&Dismantled::of(&tree));
    let vertex = Dismantled::of(&tree).pieces[piece].1[0].restored(&tree.faces, 1);
    for line in [
        EdgeLine::edge(4),
        EdgeLine::edge(u32::MAX >> 4),
        EdgeLine::cut(PlaneId::face(5), false),
        EdgeLine::cut(PlaneId::face(99), true),
        EdgeLine::cut(PlaneId::axis(0, 20), false),
        EdgeLine::cut(PlaneId::axis(4, 0), false),
    ] {
        assert_unknown(&tree, vertex.with_line(line).stored());
    }
    // Corner 3 of a square in a piece of a triangle.
    let triangles = build(&scene::random_triangles(40, 3), Heuristic::First);
    assert_unknown(
        &triangles,
        (Vertex::corner(&tree.faces, 0, 3).with_line(EdgeLine::edge(0))).stored(),
    );
}

#[test]
fn outlines_of_two_vertices_or_without_a_place_are_found() {
    let tree = crossing(5);
    let mut fragments = 0;
    for fragment in 0..tree.len() {
        let mut parts = Dismantled::of(&tree);
        let vertices = &mut parts.pieces[fragment].1;
        if vertices.is_empty() {
            continue;
        }
        vertices.truncate(2);
        let said = verdict(&parts.tree(&tree));
        assert!(said.contains(&format!("fragment {fragment} {OUTLINE}")), "{said}");
        fragments += 1;

        let mut tree = tree.clone();
        tree.records[fragment].vertices = tree.vertices.len() as u32 + 1;
        assert!(verdict(&tree).contains(OUTLINE));
    }
    assert!(fragments >= 8);
    let mut before = tree.clone();
    let last = before.records.len() - 1;
    before.records[last].vertices = 0;
    before.records[last - 1].vertices = 8;
    assert!(verdict(&before).contains(OUTLINE));
}

#[test]
fn vertices_that_belong_to_no_fragment_are_found() {
    let mut tree = crossing(5);
    let extra = tree.vertices[0];
    tree.vertices.insert(0, extra);
    tree.records.iter_mut().for_each(|record| record.vertices += 1);
    assert!(verdict(&tree).contains(&format!("fragment 0 {OUTLINE}")));
}

#[test]
fn a_whole_face_that_lists_its_corners_is_found() {
    let tree = build(&scene::random_triangles(40, 3), Heuristic::First);
    let whole = tree.fragments().find(|fragment| fragment.is_whole()).expect("one");
    let edit = |parts: &mut Dismantled| {
        let (face, vertices) = &mut parts.pieces[whole.index() as usize];
        let corner = |k| (Vertex::corner(&tree.faces, *face, k)).stored();
        vertices.extend((0..3).map(corner));
    };
    assert_fault(&tree, edit, "was never cut, but is stored as a cut piece");
}
