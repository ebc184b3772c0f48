//! Large sets in convex position, such as the side of a cylinder: lists, found in n log n.

use super::gather::reach;
use super::live::Live;
use super::progress::Watch;
use super::taken::TakenApart;
use crate::geom::{Faces, Kernel, PlaneId, Side, Vertex};

/// The most points of a leaf of the box tree. Larger: points looked at one by one; smaller: boxes.
const LEAF: usize = 8;

/// To find what is near one plane is about as much work as to look at so many pieces.
const LOOKS: usize = 256;

/// The least part of a set that is worth it. Larger: sets that are convex but for some pieces are
/// taken apart one piece at a time; smaller: this search at many nodes, for little each.
const WORTH: usize = 4;

/// Takes those pieces off a set whose planes have all others on one side, or on them: in any order,
/// then, nothing is ever cut. Tells whether they are at least a part of [`WORTH`].
///
/// Exact: only what is certain by rounded distances is believed. A tree of boxes around the
/// vertices tells for all but the neighbours of a piece that they are on one side of its plane, so
/// this takes O(n log n) where boxes can tell at all; where many pieces have a vertex in common, as
/// the sides of a cone, each is a neighbour of each, and it takes O(n²).
pub(super) fn take_apart<K: Kernel>(
    (kernel, faces): (&K, &Faces),
    (pieces, arena): (&[Live], &[K::Vertex]),
    watch: &Watch<'_>,
    taken: &mut TakenApart,
) -> bool {
    taken.clear();
    let boxes = BoxTree::new::<K>(faces, pieces, arena);
    let mut gone = vec![false; pieces.len()];
    let mut near = Vec::new();
    for p in 0..pieces.len() {
        if gone[p] {
            continue;
        }
        if watch.work(LOOKS).is_err() {
            return false;
        }
        let plane = PlaneId::face(pieces[p].face);
        let splitter = kernel.splitter(faces, plane);
        let rest = match reach::<K>(&splitter, std::iter::once(boxes.middle)) {
            (true, _) => Side::Front,
            (_, true) => Side::Back,
            _ => continue,
        };
        if !boxes.near::<K>(&splitter, rest, &mut near) {
            continue;
        }
        if watch.work(near.len()).is_err() {
            return false;
        }
        let side = |&q: &u32| kernel.classify(faces, &splitter, pieces[q as usize].piece(arena));
        near.retain(|&q| q as usize != p && !gone[q as usize]);
        near.sort_unstable();
        near.dedup();
        if near.iter().any(|q| side(q) != rest && side(q) != Side::Coplanar) {
            continue;
        }
        near.retain(|q| side(q) == Side::Coplanar);
        near.push(p as u32);
        near.iter().for_each(|&q| gone[q as usize] = true);
        taken.push(plane, rest, &near);
    }
    taken.pieces() >= pieces.len() / WORTH
}

/// A balanced tree of boxes around points: the children of node i are 2i + 1 and 2i + 2.
struct BoxTree {
    boxes: Vec<[[f64; 3]; 2]>,
    /// The points with their pieces; a node's are a range.
    points: Vec<([f64; 3], u32)>,
    middle: [f64; 3],
}

impl BoxTree {
    fn new<K: Kernel>(faces: &Faces, pieces: &[Live], arena: &[K::Vertex]) -> Self {
        let mut points = Vec::new();
        for (i, live) in pieces.iter().enumerate() {
            let mut push = |point| points.push((point, i as u32));
            match live.piece(arena).cut {
                None => faces.corners(live.face).iter().for_each(|&corner| push(corner)),
                Some(cut) => cut.iter().for_each(|vertex| push(vertex.position())),
            }
        }
        let mut middle = [0.0; 3];
        for (point, _) in &points {
            for axis in 0..3 {
                middle[axis] += point[axis] / points.len() as f64;
            }
        }
        let mut tree = Self { boxes: vec![], points, middle };
        let mut stack = vec![(0, 0..tree.points.len())];
        while let Some((node, range)) = stack.pop() {
            let around = bounds(&tree.points[range.clone()]);
            if tree.boxes.len() <= node {
                tree.boxes.resize(node + 1, [[0.0; 3]; 2]);
            }
            tree.boxes[node] = around;
            if let Some([low, high]) = halves(&range) {
                let [min, max] = around;
                let longest =
                    |&a: &usize, &b: &usize| (max[a] - min[a]).total_cmp(&(max[b] - min[b]));
                let axis = (0..3).max_by(longest).unwrap_or(0);
                let middle = low.len();
                tree.points[range]
                    .select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
                stack.push((2 * node + 1, low));
                stack.push((2 * node + 2, high));
            }
        }
        tree
    }

    /// The pieces that are not certainly all on one side of a plane; `None` if one is certainly not.
    fn near<K: Kernel>(&self, splitter: &K::Splitter, side: Side, near: &mut Vec<u32>) -> bool {
        near.clear();
        let slack = K::slack(splitter);
        // How far on that side, at least.
        let height = |point| {
            let s = K::distance(splitter, point);
            if side == Side::Front { s } else { -s }
        };
        let mut stack = vec![(0, 0..self.points.len())];
        while let Some((node, range)) = stack.pop() {
            let corners = corners(&self.boxes[node]).map(height);
            if corners.iter().all(|&h| h > slack) {
                continue;
            }
            if let Some([low, high]) = halves(&range) {
                stack.push((2 * node + 1, low));
                stack.push((2 * node + 2, high));
                continue;
            }
            for &(point, piece) in &self.points[range] {
                let h = height(point);
                if h < -slack {
                    return false;
                }
                if h <= slack {
                    near.push(piece);
                }
            }
        }
        true
    }
}

/// The ranges of a node's children, if it has any.
fn halves(range: &std::ops::Range<usize>) -> Option<[std::ops::Range<usize>; 2]> {
    let middle = range.start + range.len() / 2;
    (range.len() > LEAF).then_some([range.start..middle, middle..range.end])
}

fn bounds(points: &[([f64; 3], u32)]) -> [[f64; 3]; 2] {
    let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (point, _) in points {
        for axis in 0..3 {
            min[axis] = min[axis].min(point[axis]);
            max[axis] = max[axis].max(point[axis]);
        }
    }
    [min, max]
}

fn corners([min, max]: &[[f64; 3]; 2]) -> [[f64; 3]; 8] {
    std::array::from_fn(|i| {
        std::array::from_fn(|axis| if i >> axis & 1 == 0 { min[axis] } else { max[axis] })
    })
}
