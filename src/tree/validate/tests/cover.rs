//! Faces that fragments do not cover once, in trees where all sizes and sides agree.

use super::{
    Dismantled, Stored, assert_fault, build, crossing, decals, square, tilted, trees, verdict,
};
use crate::build::{BuildOptions, Heuristic};
use crate::exact::{EdgeLine, PlaneId, PreparedPlane, VertexId};
use crate::tree::BspTree;
use crate::tree::parts::{RawChild, RawNode};

const INCOMPLETE: &str = "do not add up to it";
const OVERLAP: &str = "occurs twice, or another piece overlaps it";
const CUT: &str = "on its two sides do not fit along the cut";

/// The node whose plane or leaf contains a fragment, and the place at that node: 0 on the plane, 1 in front,
/// 2 behind.
fn place(tree: &BspTree, fragment: u32) -> (usize, usize) {
    let is_here = |range: &std::ops::Range<u32>| range.contains(&fragment);
    let mut walk = crate::tree::node::Walk::new(tree);
    while let Some(visit) = walk.next(tree) {
        let groups = [visit.own, visit.front, visit.back];
        if let Some(group) = groups.iter().position(is_here) {
            return (visit.node, group);
        }
    }
    panic!("no fragment {fragment}");
}

/// Removes a fragment from the tree.
fn remove(tree: &BspTree, fragment: u32) -> Dismantled {
    let mut parts = Dismantled::of(tree);
    let (node, group) = place(tree, fragment);
    let node = &mut parts.nodes[node];
    match group {
        0 => node.own -= 1,
        1 => node.front = RawChild::Leaf(0),
        _ => node.back = RawChild::Leaf(0),
    }
    parts.pieces.remove(fragment as usize);
    parts
}

/// Duplicates a fragment in a leaf or on a plane. A leaf becomes a node with the plane of the fragment's
/// face.
fn double(tree: &BspTree, fragment: u32) -> Dismantled {
    let mut parts = Dismantled::of(tree);
    let (node, group) = place(tree, fragment);
    let piece = parts.pieces[fragment as usize].clone();
    let (own, sides) = (tree.nodes[node].own(), [1, 2]);
    if group == 0 {
        parts.nodes[node].own = own + 1;
        parts.pieces.insert(fragment as usize, piece);
        return parts;
    }
    assert!(sides.contains(&group));
    // A subtree that replaces a leaf is stored after the other side's leaf, and before or after the other
    // side's subtree.
    let raw = &mut parts.nodes[node];
    let child = if group == 1 { &mut raw.front } else { &mut raw.back };
    *child = RawChild::Node;
    let plane = PlaneId::face(piece.0);
    let doubled = RawNode { plane, own: 2, front: RawChild::Leaf(0), back: RawChild::Leaf(0) };
    parts.pieces.remove(fragment as usize);
    let handle = tree.nodes().nth(node).expect("the node");
    let front_nodes = tree.nodes[node].front_nodes as usize;
    let (at_node, at_piece) = if group == 1 {
        // After the node's own fragments and the back's leaf.
        let back_leaf = if tree.nodes[node].back_is_node() { 0 } else { handle.behind().len() };
        (node + 1, handle.on().end as usize + back_leaf)
    } else {
        let in_front = if front_nodes > 0 { handle.in_front().end } else { handle.behind().start };
        (
            node + 1 + front_nodes,
            if front_nodes > 0 { in_front as usize - 1 } else { in_front as usize },
        )
    };
    parts.nodes.insert(at_node, doubled);
    parts.pieces.insert(at_piece, piece.clone());
    parts.pieces.insert(at_piece, piece);
    parts
}

fn small_trees() -> impl Iterator<Item = (String, BspTree)> {
    trees().into_iter().filter(|(_, tree)| (1..120).contains(&tree.len()))
}

#[test]
fn a_fragment_that_is_lost_is_missed() {
    let [mut incomplete, mut cut, mut idle] = [0; 3];
    for (name, tree) in small_trees() {
        for fragment in 0..tree.len() as u32 {
            let said = verdict(&remove(&tree, fragment).tree(&tree));
            assert!(!said.is_empty(), "{name} without {fragment}");
            incomplete += usize::from(said.contains(INCOMPLETE));
            cut += usize::from(said.contains(CUT));
            idle += usize::from(said.contains("its plane separates no fragments"));
        }
    }
    assert!(incomplete > 200 && cut > 30 && idle > 100, "{incomplete} {cut} {idle}");
}

#[test]
fn a_face_without_any_fragment_is_missed() {
    for (scene, face) in [(decals(), 0), (decals(), 8), (tilted(&decals()), 3)] {
        let tree = build(&scene, Heuristic::First);
        let mut parts = Dismantled::of(&tree);
        while let Some(fragment) = parts.pieces.iter().position(|&(of, _)| of == face) {
            parts = remove(&parts.tree(&tree), fragment as u32);
        }
        let said = verdict(&parts.tree(&tree));
        assert!(said.contains(&format!("polygon {face} (face {face}) {INCOMPLETE}")), "{said}");
    }
}

#[test]
fn a_duplicate_fragment_is_found() {
    let mut doubled = [0; 3];
    for (name, tree) in small_trees() {
        for fragment in 0..tree.len() as u32 {
            let said = verdict(&double(&tree, fragment).tree(&tree));
            assert!(said.contains(OVERLAP), "{name}, {fragment}: {said:?}");
            doubled[place(&tree, fragment).1] += 1;
        }
    }
    assert!(doubled.iter().all(|&doubled| doubled > 50), "{doubled:?}");
}

/// A sum of areas would not find this fault.
#[test]
fn a_missing_half_and_a_duplicate_of_the_other_half_are_found() {
    let tree = crossing(2);
    let halves: Vec<u32> =
        tree.fragments().filter(|half| !half.is_whole()).map(|half| half.index()).collect();
    for (lost, kept) in [(halves[0], halves[1]), (halves[1], halves[0])] {
        let doubled = double(&tree, kept).tree(&tree);
        let (_, vertices) = &Dismantled::of(&tree).pieces[lost as usize];
        let is_lost = |parts: &Dismantled| parts.pieces.iter().position(|(_, v)| v == vertices);
        let at = is_lost(&Dismantled::of(&doubled)).expect("the other half");
        let broken = remove(&doubled, at as u32).tree(&tree);
        assert_eq!(broken.len(), tree.len());
        assert!(verdict(&broken).contains(OVERLAP));
    }
}

#[test]
fn a_half_in_place_of_the_other_half_s_quarter_is_found() {
    // The first square cuts the third in two, the second cuts one half in two again.
    let upright = |x: f64| square(1.0, x).map(|p| glam::DVec3::new(p.z, p.x, p.y));
    let polygons = [upright(0.0), upright(0.5), square(1.0, 0.0)];
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let tree = options.build(polygons).expect("finite");
    assert_eq!(verdict(&tree), "");
    let pieces: Vec<u32> =
        tree.fragments().filter(|piece| piece.face() == 2).map(|piece| piece.index()).collect();
    assert_eq!(pieces.len(), 3);
    for &a in &pieces {
        for &b in pieces.iter().filter(|&&b| b != a) {
            let edit = |parts: &mut Dismantled| {
                let vertices = parts.pieces[b as usize].1.clone();
                parts.pieces[a as usize].1 = vertices;
            };
            assert_fault(&tree, edit, "but its place requires");
        }
        assert!(!verdict(&remove(&tree, a).tree(&tree)).is_empty());
    }
}

/// Changes one vertex of one fragment at a time. Returns the number of changes that are found when pieces are
/// glued.
fn change_vertices(tree: &BspTree, change: impl Fn(u32, &Stored) -> Stored) -> usize {
    let mut found = 0;
    for fragment in tree.fragments() {
        for k in 0..fragment.stored().len() {
            let mut parts = Dismantled::of(tree);
            let vertex = &mut parts.pieces[fragment.index() as usize].1[k];
            let changed = change(fragment.face(), vertex);
            if changed == *vertex {
                continue;
            }
            *vertex = changed;
            let said = verdict(&parts.tree(tree));
            assert!(!said.is_empty(), "{fragment:?}, vertex {k}");
            found += usize::from(said.contains(CUT) || said.contains(INCOMPLETE));
        }
    }
    found
}

#[test]
fn lines_that_name_the_wrong_side_or_plane_or_edge_are_found() {
    for tree in [crossing(6), build(&decals(), Heuristic::First)] {
        let restored = |face, vertex: &Stored| vertex.restored(&tree.faces, face);
        let with = |face, vertex: &Stored, line| (restored(face, vertex).with_line(line)).stored();
        let turned = change_vertices(&tree, |face, vertex| match vertex.line().as_cut() {
            Some(plane) => with(face, vertex, EdgeLine::cut(plane, !vertex.line().is_behind())),
            None => *vertex,
        });
        let planes = change_vertices(&tree, |face, vertex| match vertex.line().as_cut() {
            Some(_) => with(face, vertex, EdgeLine::cut(PlaneId::face(3), false)),
            None => with(face, vertex, EdgeLine::cut(PlaneId::face(0), true)),
        });
        let edges = change_vertices(&tree, |face, vertex| match vertex.line().as_edge() {
            Some(edge) => with(face, vertex, EdgeLine::edge((edge + 1) % 4)),
            None => with(face, vertex, EdgeLine::edge(0)),
        });
        assert!(turned >= 8 && planes >= 30 && edges >= 30, "{turned} {planes} {edges}");
    }
}

/// A square cut along its diagonal: the cut could also name the corners there.
#[test]
fn names_of_the_right_place_but_the_wrong_vertex_are_found() {
    let upright = square(2.0, 0.0).map(|p| glam::DVec3::new(p.x, p.x, p.y));
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let tree = options.build([upright, square(1.0, 0.0)]).expect("finite");
    assert_eq!((tree.len(), verdict(&tree)), (3, String::new()));
    let plane = PlaneId::face(0);
    let prepared = PreparedPlane::new(&tree.faces, plane);
    let renamed = |vertex: &Stored, edge: u32| {
        let vertex = vertex.restored(&tree.faces, 1);
        let on_edge = vertex.with_line(EdgeLine::edge(edge));
        on_edge.cut(&tree.faces, 1, &prepared).with_line(vertex.line()).stored()
    };
    // Corner 0 as the point where the diagonal crosses the edge that ends or begins there: in one piece, and
    // in both pieces.
    for edge in [3, 0] {
        for pieces in [vec![1], vec![2], vec![1, 2]] {
            let edit = |parts: &mut Dismantled| {
                for &piece in &pieces {
                    for vertex in &mut parts.pieces[piece].1 {
                        if vertex.vertex_id() == VertexId::corner(0) {
                            *vertex = renamed(vertex, edge);
                        }
                    }
                }
            };
            let mut parts = Dismantled::of(&tree);
            edit(&mut parts);
            let said = verdict(&parts.tree(&tree));
            // A crossing that is not between the ends of its edge may be reported as a wrong side first.
            let faults =
                [if pieces.len() == 1 { CUT } else { INCOMPLETE }, "but its place requires"];
            assert!(faults.iter().any(|fault| said.contains(fault)), "{said:?}");
        }
    }
    // Another vertex at corner 0: an edge without length, in either of the pieces that have an edge there.
    for long in [0, 3] {
        let edit = |parts: &mut Dismantled| {
            for (_, vertices) in &mut parts.pieces[1..] {
                let at = vertices.iter().position(|v| v.vertex_id() == VertexId::corner(0));
                let at = at.expect("the corner");
                let corner = vertices[at].restored(&tree.faces, 1);
                let made = (renamed(&vertices[at], long)).restored(&tree.faces, 1);
                let begins_edge = corner.line() == EdgeLine::edge(0);
                match (long, begins_edge) {
                    // The edge continues to the corner, and from there to the cut.
                    (0, false) => {
                        vertices[at] = corner.with_line(EdgeLine::edge(0)).stored();
                        vertices.insert(at + 1, made.with_line(corner.line()).stored());
                    }
                    // The cut leads to an edge that ends at the corner.
                    (3, true) => vertices.insert(at, made.with_line(EdgeLine::edge(3)).stored()),
                    _ => vertices[at] = made.stored(),
                }
            }
        };
        let mut parts = Dismantled::of(&tree);
        edit(&mut parts);
        let said = verdict(&parts.tree(&tree));
        assert!(
            [CUT, "but its place requires"].iter().any(|fault| said.contains(fault)),
            "{said:?}"
        );
    }
}

#[test]
fn a_vertex_that_both_pieces_call_by_the_name_of_the_other_end_of_the_cut_is_found() {
    let tree = crossing(2);
    let vertex_ids = |piece: usize| Dismantled::of(&tree).pieces[piece].1.clone();
    let halves: Vec<usize> = (0..3).filter(|&piece| !vertex_ids(piece).is_empty()).collect();
    let on_cut: Vec<Stored> = vertex_ids(halves[0])
        .into_iter()
        .filter(|v| vertex_ids(halves[1]).iter().any(|w| w.vertex_id() == v.vertex_id()))
        .collect();
    let [p, q] = on_cut[..] else { panic!("two vertices on the cut") };
    let edit = |parts: &mut Dismantled| {
        for &half in &halves {
            for vertex in &mut parts.pieces[half].1 {
                if vertex.vertex_id() == p.vertex_id() {
                    let other = q.restored(&tree.faces, 1);
                    *vertex = other.with_line(vertex.line()).stored();
                }
            }
        }
    };
    assert_fault(&tree, edit, CUT);
}

#[test]
fn outlines_that_are_turned_round_or_lack_a_vertex_are_found() {
    for (name, tree) in small_trees() {
        let (mut found, mut edits) = (0, 0);
        for fragment in tree.fragments().filter(|fragment| !fragment.is_whole()) {
            for edit in 0..3 {
                let mut parts = Dismantled::of(&tree);
                let vertices = &mut parts.pieces[fragment.index() as usize].1;
                match edit {
                    0 => vertices.reverse(),
                    1 => drop(vertices.pop()),
                    _ => vertices.insert(1, vertices[0]),
                }
                found += usize::from(!verdict(&parts.tree(&tree)).is_empty());
                edits += 1;
            }
            // An outline may start at any vertex.
            let mut parts = Dismantled::of(&tree);
            parts.pieces[fragment.index() as usize].1.rotate_left(1);
            assert_eq!(verdict(&parts.tree(&tree)), "", "{name}");
        }
        assert_eq!(found, edits, "{name}");
    }
}

#[test]
fn a_plane_that_is_coplanar_with_the_cutting_plane_is_found() {
    // Two squares in one plane, and a square that their plane cuts.
    let upright = square(1.0, 0.2).map(|p| glam::DVec3::new(p.z, p.x, p.y));
    let polygons = [square(1.0, 0.0), square(2.0, 0.0), upright];
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let tree = options.build(polygons).expect("finite");
    assert_eq!((tree.len(), tree.nodes[0].own()), (4, 2));
    let edit = |parts: &mut Dismantled| parts.nodes[0].plane = PlaneId::face(1);
    assert_fault(&tree, edit, CUT);
    // If nothing is cut, either order is right.
    let tree = options.build(&polygons[..2]).expect("finite");
    let mut parts = Dismantled::of(&tree);
    parts.nodes[0].plane = PlaneId::face(1);
    assert_eq!(verdict(&parts.tree(&tree)), "");
}

#[test]
fn cuts_that_are_counted_wrongly_are_found() {
    let tree = build(&tilted(&decals()), Heuristic::default());
    for cuts in [0, tree.cuts - 1, tree.cuts + 1] {
        let fault = format!("the builder counted {cuts} cuts, but the pieces have {}", tree.cuts);
        assert_fault(&tree, |parts| parts.cuts = cuts, &fault);
    }
}
