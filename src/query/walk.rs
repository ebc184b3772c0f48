//! The parts of a tree that a ray may meet, the nearest first.
//!
//! A partition plane divides the ray: one side of the tree is met only before it, the other only behind.
//! But the tolerance lets fragments reach across the plane, and the planes that are read here are rounded
//! to `f32`. So both sides are met up to a small distance beyond the plane, and what is *on* it within
//! this distance. That costs some parts that are looked at in vain, and no decision depends on it: which
//! fragments are met, and which of them first, is decided by `meeting`.

use std::ops::Range;

use smallvec::SmallVec;

use super::probe::{CORNERS, Probe};
use crate::exact::LATTICE_LIMIT;
use crate::tree::BspTree;
use crate::tree::node_record::Ranges;

/// The parts of a tree that a ray has not come to.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    /// The one to be looked at next is on top.
    pending: SmallVec<[Part; 24]>,
    /// The ray in units of 2⁵¹ lattice steps, as the tree's planes are given.
    origin: [f64; 3],
    direction: [f64; 3],
    /// How far beyond a plane fragments may be that count as in front, behind or on it.
    slack: f64,
}

/// A subtree, or fragments alone, and between which parameters the ray may meet them.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// [`LEAF`] for fragments alone.
    node: u32,
    first: u32,
    end: u32,
    from: f64,
    to: f64,
    /// Neither this part nor those below it on the stack are met before this.
    floor: f64,
}

const LEAF: u32 = u32::MAX;

/// Error bound of a plane that is rounded to `f32`, at points of the scene, in units of 2⁵¹ lattice
/// steps: 2⁻²⁴ of the normal's coordinates, which the point's are at most 1.02 times, and of the offset.
/// With a unit normal that is 2⁻²⁴ · 1.02 · (√3 + √3).
const PLANE_ERROR: f64 = 2.2e-7;

/// Rounding of a plane's distance at a point of the ray, as a share of the probe's reach.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

impl Walk {
    /// The whole tree.
    pub(super) fn new(tree: &BspTree, probe: &Probe) -> Self {
        let unit = 1.0 / LATTICE_LIMIT;
        let tolerance = tree.faces.tolerance() * unit * (1.0 + 1e-6);
        let slack = PLANE_ERROR + tolerance + ROUNDED * probe.reach * unit;
        let (origin, direction) =
            (probe.origin.map(|c| c * unit), probe.direction.map(|c| c * unit));
        let mut walk = Self { pending: SmallVec::new(), origin, direction, slack };
        if let Some([from, to]) = walk.within_reach(probe) {
            let node = if tree.nodes.is_empty() { LEAF } else { 0 };
            walk.push(node, 0..tree.len() as u32, [from, to]);
        }
        walk
    }

    /// The next run of fragments; `None` if none is left that is met before a limit or at it.
    pub(super) fn next(&mut self, tree: &BspTree, limit: f64) -> Option<Range<u32>> {
        while self.pending.last()?.floor <= limit {
            let part = self.pending.pop()?;
            if let Some(run) = self.descend(tree, part) {
                return Some(run);
            }
        }
        None
    }

    /// Goes down the near side of a subtree to the first fragments, and leaves the rest on the stack.
    fn descend(&mut self, tree: &BspTree, part: Part) -> Option<Range<u32>> {
        let Part { mut node, first, end, from, mut to, .. } = part;
        let mut all = first..end;
        while node != LEAF {
            let index = node as usize;
            let record = &tree.nodes[index];
            let Ranges { own, front, back } = record.ranges(all);
            let child = |node: Option<usize>| node.map_or(LEAF, |node| node as u32);
            let (front, back) =
                ((front, child(record.front_node(index))), (back, child(record.back_node(index))));
            let Crossing { enter, leave, is_forwards } = self.crossing(tree, index);
            let (near, far) = if is_forwards { (back, front) } else { (front, back) };
            let begin = if enter > from { enter } else { from };
            if begin <= to {
                self.push(far.1, far.0, [begin, to]);
                if from <= leave {
                    self.push(LEAF, own, [begin, if leave < to { leave } else { to }]);
                }
            }
            if from > leave {
                return None;
            }
            to = if leave < to { leave } else { to };
            (all, node) = near;
        }
        (!all.is_empty()).then_some(all)
    }

    /// Between which parameters the ray is near a node's plane.
    #[inline]
    fn crossing(&self, tree: &BspTree, node: usize) -> Crossing {
        let [x, y, z, offset] = tree.planes.get(node).to_array().map(f64::from);
        let ([a, b, c], [d, e, f]) = (self.origin, self.direction);
        let start = x * a + y * b + z * c - offset;
        let slope = x * d + y * e + z * f;
        let (toward, speed) = (if slope < 0.0 { start } else { -start }, slope.abs());
        // Without a slope these are infinite, or not a number, with which every comparison is false.
        let (enter, leave) = ((toward - self.slack) / speed, (toward + self.slack) / speed);
        Crossing { enter, leave, is_forwards: slope >= 0.0 }
    }

    fn push(&mut self, node: u32, fragments: Range<u32>, [from, to]: [f64; 2]) {
        if fragments.is_empty() {
            return;
        }
        let below = self.pending.last().map_or(f64::INFINITY, |part| part.floor);
        let Range { start: first, end } = fragments;
        self.pending.push(Part { node, first, end, from, to, floor: from.min(below) });
    }

    /// The parameters between which the ray is where corners can be; `None` if it never is.
    fn within_reach(&self, probe: &Probe) -> Option<[f64; 2]> {
        let reach = CORNERS / LATTICE_LIMIT + self.slack;
        let (mut from, mut to) = (0.0_f64, if probe.is_endless { f64::INFINITY } else { 1.0 });
        for (start, slope) in self.origin.into_iter().zip(self.direction) {
            // Without a slope these are infinite, or not a number, which `min` and `max` pass over.
            let [a, b] = [-reach, reach].map(|side| (side - start) / slope);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from <= to).then_some([from, to])
    }
}

/// Where a ray crosses a plane, give or take the slack.
struct Crossing {
    enter: f64,
    leave: f64,
    /// Whether the ray goes to the front.
    is_forwards: bool,
}
