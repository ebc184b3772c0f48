//! Pieces that can be separated from a set without a cut.

use std::ops::Range;

use smallvec::{SmallVec, smallvec};

use super::coplanar::larger;
use super::set::{LANES, PackedBox, PackedPieces, PackedPlane, Set};
use super::tuning::Tuning;
use crate::bits::bits;
use crate::exact::{PlaneId, Side};
use crate::progress::Watch;

/// Pieces that are separated from a set one after the other. The plane of each piece cuts none of the
/// remaining pieces.
#[derive(Debug, Default)]
pub(crate) struct Peeled {
    layers: Vec<Layer>,
    /// The pieces of all layers, by their numbers in the set.
    pieces: Vec<u32>,
}

/// The pieces on one plane, separated from a set together.
#[derive(Debug)]
pub(crate) struct Layer {
    pub(crate) plane: PlaneId,
    /// The side of the plane on which all remaining pieces lie.
    pub(crate) rest: Side,
    /// The places of the layer's pieces in the list of all layers.
    range: Range<usize>,
}

impl Peeled {
    /// The layers in the order in which they are separated.
    pub(crate) fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// The pieces of a layer, by their numbers in the set.
    pub(crate) fn pieces(&self, layer: &Layer) -> &[u32] {
        &self.pieces[layer.range.clone()]
    }

    fn push(&mut self, plane: PlaneId, rest: Side, pieces: &[u32]) {
        let start = self.pieces.len();
        self.pieces.reserve(pieces.len());
        self.pieces.extend_from_slice(pieces);
        self.layers.push(Layer { plane, rest, range: start..self.pieces.len() });
    }
}

/// Finds the pieces of a set whose planes have all remaining pieces on one side. Removes each such piece
/// before trying the next. Reuses the search's lists.
///
/// Separating such a piece first never adds a fragment: a tree of the whole set, without the piece and its
/// plane, is a tree of the remaining pieces with no more fragments. A set in convex position is divided
/// entirely if all places are tried.
///
/// The result is exact: only certain results of the packed pieces are used, and exact arithmetic decides on
/// pieces near a plane. A tree of boxes around the pieces classifies all pieces except the neighbours of a
/// piece. So a set in convex position takes O(n log n) time if boxes can decide. If many pieces share a
/// vertex, like the sides of a cone, the set takes O(n²) time.
#[derive(Debug, Default)]
pub(super) struct Peeler {
    boxes: Boxes,
    /// For each group of the packed pieces, a bit for each remaining piece.
    left: Vec<u8>,
    /// The two pieces that prevent the current piece from being separated: a piece in front of the current
    /// piece's plane, and a piece behind that plane. A piece that crosses the plane is stored twice.
    witnesses: [u32; 2],
    /// Pieces that are not certainly on one side of the current plane.
    near: Vec<u32>,
    /// Boxes still to be compared.
    stack: Vec<Node>,
    /// The current piece and the pieces on its plane, which are separated together.
    own: Vec<u32>,
    /// Other pieces near the current plane, by their numbers in the set.
    beside: Vec<u32>,
}

/// Indices into `witnesses`.
const FRONT: usize = 0;
const BACK: usize = 1;

/// The place of a witness that is not found yet.
const NO_PIECE: u32 = u32::MAX;

impl Peeler {
    /// Searches a set for peelable pieces, and returns the pieces found, if any. All pieces of
    /// the set must be packed. If there are more groups than `tuning.groups_per_box`, each group's pieces
    /// must be near one another (see [`arrange`]), or the boxes decide nothing.
    pub(super) fn search(
        &mut self,
        set: &Set<'_>,
        sketch: &PackedPieces,
        tuning: &Tuning,
        watch: &Watch<'_>,
    ) -> Option<Peeled> {
        let groups = sketch.groups();
        self.boxes.fill(sketch, tuning.groups_per_box);
        self.left.clear();
        self.left.reserve(groups);
        self.left.extend((0..groups).map(|group| sketch.lanes(group)));
        let (peeled, left) = (Peeled::default(), sketch.len());
        let mut search = Search { lists: self, set, sketch, watch, peeled, left };
        search.pass();
        let peeled = search.peeled;
        (!peeled.layers.is_empty()).then_some(peeled)
    }
}

/// A search in one set.
struct Search<'a, 'w> {
    lists: &'a mut Peeler,
    set: &'a Set<'a>,
    sketch: &'a PackedPieces,
    watch: &'a Watch<'w>,
    peeled: Peeled,
    /// The number of pieces left.
    left: usize,
}

impl Search<'_, '_> {
    /// Separates pieces in one pass over the set.
    fn pass(&mut self) {
        for p in 0..self.sketch.len() {
            if self.left <= 1 {
                break;
            }
            if !self.is_left(p) {
                continue;
            }
            let number = self.sketch.number(p);
            let plane = self.sketch.plane(self.set, number);
            let (work, may_be_taken) = self.look(p, &plane);
            if self.watch.work(work).is_err() {
                break;
            }
            if may_be_taken {
                self.left -= self.take(p, self.set.own_plane(number));
            }
        }
    }

    /// Whether a witness on each side prevents the current piece from being separated.
    fn is_held(&self) -> bool {
        !self.lists.witnesses.contains(&NO_PIECE)
    }

    fn is_left(&self, p: usize) -> bool {
        self.lists.left[p / LANES] >> (p % LANES) & 1 == 1
    }

    /// Compares the other pieces with a piece's plane until a piece is found on each side. Returns the number
    /// of comparisons, and whether one side may be empty.
    fn look(&mut self, p: usize, plane: &PackedPlane) -> (usize, bool) {
        self.lists.witnesses = [NO_PIECE; 2];
        let mut work = 0;
        self.lists.near.clear();
        self.lists.stack.clear();
        self.lists.stack.push(Node { index: 0, groups: 0..self.sketch.groups() });
        while let Some(node) = self.lists.stack.pop() {
            work += LANES;
            if let Some(around) = self.lists.boxes.around.get(node.index)
                && let Some(side) = self.sketch.side_of_box(plane, around)
            {
                let seen = &mut self.lists.witnesses[side];
                if *seen == NO_PIECE
                    && let Some(group) =
                        node.groups.clone().find(|&group| self.lists.left[group] > 0)
                {
                    *seen = (group * LANES) as u32 + self.lists.left[group].trailing_zeros();
                }
            } else if let Some(children) = self.lists.boxes.children(&node) {
                self.lists.stack.extend(children);
                continue;
            } else {
                for group in node.groups {
                    if self.lists.left[group] == 0 {
                        continue;
                    }
                    work += LANES;
                    self.see(p, plane, group);
                    if self.is_held() {
                        return (work, false);
                    }
                }
            }
            if self.is_held() {
                return (work, false);
            }
        }
        (work, true)
    }

    /// Records the remaining pieces of a group that are witnesses against piece `p`, and the pieces near the
    /// plane.
    #[inline]
    fn see(&mut self, p: usize, plane: &PackedPlane, group: usize) {
        let others = if p / LANES == group { !(1 << (p % LANES)) } else { u8::MAX };
        let left = self.lists.left[group] & others;
        let Peeler { witnesses, near, .. } = &mut *self.lists;
        self.sketch.for_each_reach(plane, group..group + 1, |_, reach| {
            let first = (group * LANES) as u32;
            if reach.front & left != 0 {
                witnesses[FRONT] = first + (reach.front & left).trailing_zeros();
            }
            if reach.back & left != 0 {
                witnesses[BACK] = first + (reach.back & left).trailing_zeros();
            }
            near.extend(bits((reach.near & left).into()).map(|bit| first + bit as u32));
        });
    }

    /// Separates a piece, and the pieces on its plane, if all other remaining pieces are on one side of the
    /// plane. Returns the number of separated pieces.
    fn take(&mut self, p: usize, plane: PlaneId) -> usize {
        let prepared = self.set.prepare(plane);
        let Peeler { left, witnesses, near, own, beside, .. } = &mut *self.lists;
        own.clear();
        own.push(p as u32);
        beside.clear();
        let held = witnesses;
        for &q in &*near {
            let side = self.set.classify(&prepared, self.sketch.number(q as usize));
            match side {
                Side::Coplanar => own.push(q),
                _ => beside.push(self.sketch.number(q as usize) as u32),
            }
            if matches!(side, Side::Front | Side::Spanning) {
                held[FRONT] = q;
            }
            if matches!(side, Side::Back | Side::Spanning) {
                held[BACK] = q;
            }
            if !held.contains(&NO_PIECE) {
                return 0;
            }
        }
        let rest = match *held {
            [NO_PIECE, _] => Side::Back,
            [_, NO_PIECE] => Side::Front,
            _ => return 0,
        };
        let numbers = |places: &[u32]| -> SmallVec<[u32; 8]> {
            places.iter().map(|&q| self.sketch.number(q as usize) as u32).collect()
        };
        let separated = numbers(own);
        // A piece beside the plane that is coplanar with one of these comes first, with its own plane.
        let pieces: [&[u32]; 2] = [&separated, beside];
        if !matches!(larger(self.set, &prepared, pieces, |_| false, &[], self.watch), Ok(None)) {
            return 0;
        }
        for (q, number) in own.iter_mut().zip(separated) {
            left[*q as usize / LANES] &= !(1 << (*q as usize % LANES));
            *q = number;
        }
        self.peeled.push(plane, rest, own);
        own.len()
    }
}

/// Writes the numbers of a set's pieces, sorted so that the pieces of each group, and of each range of groups,
/// are near one another. Repeatedly divides the pieces in half along the longest side of their box.
pub(super) fn arrange(set: &Set<'_>, groups_per_box: usize, order: &mut Vec<usize>) {
    order.clear();
    order.extend(0..set.len());
    let middle = |piece: usize, axis: usize| {
        let piece = &set.pieces[piece];
        piece.min[axis] + piece.max[axis]
    };
    let all = 0..set.len().div_ceil(LANES);
    let mut stack: SmallVec<[_; 32]> = smallvec![all];
    while let Some(groups) = stack.pop() {
        let Some([low, high]) = halves(&groups, groups_per_box) else { continue };
        let part = &mut order[groups.start * LANES..set.len().min(groups.end * LANES)];
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &piece in part.iter() {
            for axis in 0..3 {
                min[axis] = min[axis].min(middle(piece, axis));
                max[axis] = max[axis].max(middle(piece, axis));
            }
        }
        let longest = |&a: &usize, &b: &usize| (max[a] - min[a]).total_cmp(&(max[b] - min[b]));
        let axis = (0..3).max_by(longest).unwrap_or(0);
        part.select_nth_unstable_by(low.len() * LANES, |&a, &b| {
            middle(a, axis).total_cmp(&middle(b, axis)).then(a.cmp(&b))
        });
        stack.extend([low, high]);
    }
}

/// A balanced tree of boxes around the groups of packed pieces: the children of node i are nodes 2i + 1 and
/// 2i + 2. If the root is a leaf, there are no boxes.
#[derive(Debug, Default)]
struct Boxes {
    around: Vec<PackedBox>,
    /// The largest number of groups in a leaf.
    groups_per_box: usize,
}

/// A node of the tree.
#[derive(Debug)]
struct Node {
    index: usize,
    groups: Range<usize>,
}

impl Boxes {
    fn fill(&mut self, sketch: &PackedPieces, groups_per_box: usize) {
        self.groups_per_box = groups_per_box;
        self.around.clear();
        if sketch.groups() <= groups_per_box {
            return;
        }
        let mut stack = vec![Node { index: 0, groups: 0..sketch.groups() }];
        while let Some(node) = stack.pop() {
            if self.around.len() <= node.index {
                let missing = node.index + 1 - self.around.len();
                self.around.reserve(missing);
                self.around.resize(node.index + 1, PackedBox::default());
            }
            self.around[node.index] = sketch.bounds(node.groups.clone());
            stack.extend(self.children(&node).into_iter().flatten());
        }
    }

    fn children(&self, node: &Node) -> Option<[Node; 2]> {
        let [low, high] = halves(&node.groups, self.groups_per_box)?;
        let index = 2 * node.index;
        Some([Node { index: index + 1, groups: low }, Node { index: index + 2, groups: high }])
    }
}

/// The ranges of a node's children, if the node has more than `most` groups.
fn halves(groups: &Range<usize>, most: usize) -> Option<[Range<usize>; 2]> {
    let middle = groups.start + groups.len() / 2;
    (groups.len() > most).then_some([groups.start..middle, middle..groups.end])
}

#[cfg(test)]
mod tests;
