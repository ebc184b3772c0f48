//! Pieces of a set in groups that are near one another, and boxes around these.

use std::ops::Range;

use crate::Error;
use crate::build::choose::set::Set;
use crate::build::choose::sketch::{LANES, Sketch, SketchBox};
use crate::memory::{collect, reserve};

/// The pieces of a large set in an order in which groups, and ranges of groups, are near one
/// another: by halving the longest side of their box again and again.
pub(in crate::build::choose) fn arrange(
    set: &Set<'_>,
    groups_per_box: usize,
) -> Result<Vec<usize>, Error> {
    let mut order = collect(0..set.len())?;
    let middle = |piece: usize, axis: usize| {
        let live = &set.pieces[piece];
        live.min[axis] + live.max[axis]
    };
    let all = 0..set.len().div_ceil(LANES);
    let mut stack = vec![all];
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
    Ok(order)
}

/// A balanced tree of boxes around the groups of a sketch: the children of node i are 2i + 1 and
/// 2i + 2. If the root is a leaf, there are no boxes.
#[derive(Debug, Default)]
pub(super) struct Boxes {
    pub(super) around: Vec<SketchBox>,
    /// The most groups in a leaf.
    groups_per_box: usize,
}

/// A node of the tree.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) index: usize,
    pub(super) groups: Range<usize>,
}

impl Boxes {
    pub(super) fn fill(&mut self, sketch: &Sketch, groups_per_box: usize) -> Result<(), Error> {
        self.groups_per_box = groups_per_box;
        self.around.clear();
        if sketch.groups() <= groups_per_box {
            return Ok(());
        }
        let mut stack = vec![Node { index: 0, groups: 0..sketch.groups() }];
        while let Some(node) = stack.pop() {
            if self.around.len() <= node.index {
                let missing = node.index + 1 - self.around.len();
                reserve(&mut self.around, missing)?;
                self.around.resize(node.index + 1, SketchBox::default());
            }
            self.around[node.index] = sketch.bounds(node.groups.clone());
            stack.extend(self.children(&node).into_iter().flatten());
        }
        Ok(())
    }

    pub(super) fn children(&self, node: &Node) -> Option<[Node; 2]> {
        let [low, high] = halves(&node.groups, self.groups_per_box)?;
        let index = 2 * node.index;
        Some([Node { index: index + 1, groups: low }, Node { index: index + 2, groups: high }])
    }
}

/// The ranges of a node's children, if it has more than `most` groups.
fn halves(groups: &Range<usize>, most: usize) -> Option<[Range<usize>; 2]> {
    let middle = groups.start + groups.len() / 2;
    (groups.len() > most).then_some([groups.start..middle, middle..groups.end])
}
