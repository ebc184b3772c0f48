//! Randomly broken trees. The oracle cuts the faces by the planes again and compares the pieces.

use super::{Dismantled, Stored, build, crossing, decals, tilted, verdict};
use crate::build::Heuristic;
use crate::exact::{EdgeLine, PlaneId, PreparedPlane, Side, Vertex, split};
use crate::random::SplitMix64;
use crate::scene;
use crate::tree::BspTree;
use crate::tree::parts::{RawChild, RawNode};

/// A piece of a face, or the whole face if it has no vertices.
type Live = (u32, Vec<Vertex>);

/// Whether a tree's pieces are the faces, cut by the tree's planes from the root down.
fn is_right(tree: &BspTree, parts: &Dismantled) -> bool {
    let faces = &tree.faces;
    let mut pieces = parts.pieces.iter();
    let mut nodes = parts.nodes.iter();
    let whole = (0..faces.len() as u32).map(|face| (face, Vec::new())).collect();
    let mut stack: Vec<Vec<Live>> = vec![whole];
    let mut cuts = 0;
    while let Some(set) = stack.pop() {
        let Some(node) = nodes.next() else { return set.is_empty() && pieces.next().is_none() };
        let (mut own, mut front, mut back) = (vec![], vec![], vec![]);
        let prepared = PreparedPlane::new(faces, node.plane);
        for (face, vertices) in set {
            let cut = (!vertices.is_empty()).then_some(&vertices[..]);
            match prepared.classify(faces, face, cut) {
                Side::Coplanar => own.push((face, vertices)),
                Side::Front => front.push((face, vertices)),
                Side::Back => back.push((face, vertices)),
                Side::Spanning => {
                    let all: Vec<_> = Vertex::corners(faces, face).collect();
                    let outline = if vertices.is_empty() { &all } else { &vertices };
                    let [mut before, mut behind] = [vec![], vec![]];
                    split(faces, &prepared, face, outline, &mut before, &mut behind);
                    front.push((face, before));
                    back.push((face, behind));
                    cuts += 1;
                }
            }
        }
        let is_idle = own.is_empty() && (front.is_empty() || back.is_empty());
        own.sort_by_key(|&(face, _)| face);
        let mut take =
            |list: &[Live]| list.iter().all(|live| pieces.next().is_some_and(|p| same(p, live)));
        let fits = |child: RawChild, list: &[Live]| match child {
            RawChild::Leaf(len) => len as usize == list.len() && len <= 1,
            RawChild::Node => true,
        };
        let leaf = |child: RawChild| matches!(child, RawChild::Leaf(_));
        if is_idle
            || own.len() != node.own as usize
            || !fits(node.front, &front)
            || !fits(node.back, &back)
            || !take(&own)
            || leaf(node.front) && !take(&front)
            || leaf(node.back) && !take(&back)
        {
            return false;
        }
        if node.back == RawChild::Node {
            stack.push(back);
        }
        if node.front == RawChild::Node {
            stack.push(front);
        }
    }
    nodes.next().is_none() && pieces.next().is_none() && cuts == parts.cuts
}

/// Whether a stored piece has the expected face and outline; the outline may start at another vertex.
fn same((face, stored): &(u32, Vec<Stored>), (expected, vertices): &Live) -> bool {
    let outline: Vec<Stored> = vertices.iter().map(|vertex| vertex.stored()).collect();
    let n = outline.len();
    let turned = |by: usize| (0..n).all(|k| outline[(k + by) % n] == stored[k]);
    face == expected && stored.len() == n && (n == 0 || (0..n).any(turned))
}

/// One random change to a tree.
fn change(parts: &mut Dismantled, tree: &BspTree, random: &mut SplitMix64) {
    let mut below = |n: usize| (random.next() % n.max(1) as u64) as usize;
    let (a, b) = (below(parts.pieces.len()), below(parts.pieces.len()));
    let (node, kind) = (below(parts.nodes.len()), below(16));
    let (k, other) = (below(12), below(12));
    let faces = &tree.faces;
    let (face, from) = (parts.pieces[a].0, parts.pieces[b].1.clone());
    let RawNode { own, front, back, plane } = &mut parts.nodes[node];
    let vertices = &mut parts.pieces[a].1;
    let n = vertices.len().max(1);
    match kind {
        0 => parts.pieces.swap(a, b),
        1 => std::mem::swap(front, back),
        2 => *plane = PlaneId::face(below(faces.len()) as u32),
        3 => *plane = PlaneId::axis(below(3), below(faces.corner_count()) as u32),
        4 => vertices.clear(),
        5 => parts.pieces[a] = parts.pieces[b].clone(),
        6 => parts.pieces[a].0 = below(faces.len()) as u32,
        7 => vertices.reverse(),
        8 => vertices.rotate_left(k % n),
        9 if n > 1 => drop(vertices.remove(k % n)),
        10 if n > 1 => vertices.insert(k % n, vertices[other % n]),
        11 if n > 1 => vertices.swap(k % n, other % n),
        12 | 13 if n > 1 && !from.is_empty() => {
            // Takes the line of a vertex, or a vertex without its line, from another piece.
            let [here, there] = [vertices[k % n], from[other % from.len()]]
                .map(|vertex| vertex.restored(faces, face));
            let (vertex, line) =
                if kind == 12 { (here, there.line()) } else { (there, here.line()) };
            vertices[k % n] = vertex.with_line(line).stored();
        }
        14 if n > 1 => {
            let here = (vertices[k % n]).restored(faces, face);
            if let Some(plane) = here.line().as_cut() {
                let line = EdgeLine::cut(plane, !here.line().is_behind());
                vertices[k % n] = here.with_line(line).stored();
            }
        }
        _ => {
            // One fragment more on the plane, or one fragment less.
            if other % 2 == 0 {
                *own += 1;
                let piece = parts.pieces[a].clone();
                parts.pieces.insert(b, piece);
            } else if *own > 0 {
                *own -= 1;
                parts.pieces.remove(b);
            }
        }
    }
}

#[test]
fn randomly_broken_trees_are_valid_only_if_their_pieces_are_the_faces_cut_by_their_planes() {
    let mut random = SplitMix64::new(7);
    let (mut valid, mut cover, mut broken) = (0, 0, 0);
    for scene in [
        scene::crossing(5),
        decals(),
        tilted(&decals()),
        scene::random_triangles(14, 3),
        scene::newell_bars(),
        scene::layers(5, 1e-4),
    ] {
        for by in [Heuristic::First, Heuristic::FreePlanes, Heuristic::default()] {
            let tree = build(&scene, by);
            assert!(is_right(&tree, &Dismantled::of(&tree)), "{} by {by}", scene.name());
            for _ in 0..700 {
                let mut parts = Dismantled::of(&tree);
                change(&mut parts, &tree, &mut random);
                if random.next().is_multiple_of(4) {
                    change(&mut parts, &tree, &mut random);
                }
                let said = verdict(&parts.tree(&tree));
                let right = is_right(&tree, &parts);
                assert_eq!(said.is_empty(), right, "{} by {by}: {said}", scene.name());
                valid += usize::from(right);
                broken += usize::from(!right);
                cover += usize::from(said.contains("polygon ") && said.contains("(face"));
            }
        }
    }
    assert!(valid > 300 && broken > 3000 && cover > 500, "{valid} {broken} {cover}");
}

#[test]
fn the_oracle_itself_sees_a_piece_that_is_missing_or_changed() {
    let tree = crossing(4);
    let mut parts = Dismantled::of(&tree);
    parts.pieces.pop();
    assert!(!is_right(&tree, &parts));
    let mut parts = Dismantled::of(&tree);
    let vertices = &mut parts.pieces.last_mut().expect("a piece").1;
    assert!(vertices.len() > 2);
    vertices.swap(0, 1);
    assert!(!is_right(&tree, &parts));
    let mut parts = Dismantled::of(&tree);
    parts.cuts += 1;
    assert!(!is_right(&tree, &parts));
}
