//! The parts of a tree that a ray may meet, the nearest first.
//!
//! A partition plane divides the ray: one side of the tree is met only before it, the other only behind.
//! But the tolerance lets fragments reach across the plane, and the planes that are read here are rounded
//! to `f32`. So both sides are met up to a small distance beyond the plane, and what is *on* it within
//! this distance. That costs some parts that are looked at in vain, and no decision depends on it: which
//! fragments are met, and which of them first, is decided by `probe`.

use std::ops::Range;

use smallvec::SmallVec;

use super::probe::RayQuery;
use crate::exact::LATTICE_LIMIT;
use crate::exact::lattice::MAX_CORNER;
use crate::tree::node::Ranges;
use crate::tree::{BLOCK, Bounds, BspTree, Flat};

/// The parts of a tree that a ray has not come to.
#[derive(Clone, Debug)]
pub(super) struct Walk<'t> {
    tree: &'t BspTree,
    boxes: Option<Boxes<'t>>,
    /// The one to be looked at next is on top.
    pending: SmallVec<[Pending; 24]>,
    /// The ray in units of 2⁵¹ lattice steps, as the tree's planes are given.
    origin: [f64; 3],
    direction: [f64; 3],
    /// How far beyond a plane fragments may be that count as in front, behind or on it.
    slack: f64,
    /// Fragments that the ray has come to and may meet between these parameters.
    run: Range<u32>,
    span: [f64; 2],
}

/// A subtree, or fragments alone, and between which parameters the ray may meet them.
#[derive(Clone, Copy, Debug)]
struct Pending {
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
/// steps: 2⁻²⁴ of the normal's coordinates, which the point's are at most 1.014 times, and of the offset.
/// With a unit normal that is 2⁻²⁴ · 1.014 · (√3 + √3).
const PLANE_ERROR: f64 = 2.2e-7;

/// Rounding of a plane's distance at a point of the ray, as a share of the probe's reach.
const REACH_ERROR: f64 = 16.0 * f64::EPSILON;

impl<'t> Walk<'t> {
    /// The whole tree. With boxes, what the ray passes by is left out.
    pub(super) fn new(tree: &'t BspTree, bounds: Option<&'t Bounds>, probe: &RayQuery) -> Self {
        let unit = 1.0 / LATTICE_LIMIT;
        let tolerance = tree.faces.tolerance() * unit * (1.0 + 1e-6);
        let mut walk = Self {
            tree,
            boxes: bounds.and_then(|bounds| Boxes::new(probe, bounds)),
            pending: SmallVec::new(),
            origin: probe.origin.map(|c| c * unit),
            direction: probe.direction.map(|c| c * unit),
            slack: PLANE_ERROR + tolerance + REACH_ERROR * probe.reach * unit,
            run: 0..0,
            span: [0.0; 2],
        };
        if let Some([from, to]) = walk.within_reach(probe) {
            let node = if tree.nodes.is_empty() { LEAF } else { 0 };
            walk.push(node, 0..tree.len() as u32, [from, to]);
        }
        walk
    }

    /// The next fragment that the ray may meet; `None` if none is left that it meets at a limit or
    /// before.
    #[inline]
    pub(super) fn next(&mut self, limit: f64) -> Option<u32> {
        loop {
            let next = match &self.boxes {
                Some(boxes) => boxes.next(&mut self.run, self.span),
                None => self.run.next(),
            };
            if next.is_some() {
                return next;
            }
            if self.pending.last()?.floor > limit {
                return None;
            }
            let part = self.pending.pop()?;
            self.descend(part, limit);
        }
    }

    /// Goes down the near side of a subtree to the first fragments, and leaves the rest on the stack.
    fn descend(&mut self, part: Pending, limit: f64) {
        let Pending { mut node, first, end, mut from, mut to, .. } = part;
        let mut all = first..end;
        // How many fragments the last box that was looked at has; at first none was.
        let mut boxed = u32::MAX;
        while node != LEAF {
            let index = node as usize;
            let len = all.end - all.start;
            if let Some(boxes) = self.boxes.as_ref().filter(|_| len < boxed - boxed / 4) {
                boxed = len;
                let [enter, leave] = boxes.of_node(index);
                from = if enter > from { enter } else { from };
                to = if leave < to { leave } else { to };
                if from > to {
                    return;
                }
                let below = self.pending.last().map_or(f64::INFINITY, |part| part.floor);
                if from > limit && below > limit {
                    self.push(node, all, [from, to]);
                    return;
                }
            }
            let (own, [front, back]) = self.divided(index, all);
            let distance = self.distance(index);
            let [begin, end] = [from, to].map(|t| distance.start + distance.slope * t);
            if begin > self.slack && end > self.slack {
                (all, node) = front;
                continue;
            }
            if begin < -self.slack && end < -self.slack {
                (all, node) = back;
                continue;
            }
            let Crossing { enter, leave, is_forwards } = distance.crossing(self.slack);
            let (near, far) = if is_forwards { (back, front) } else { (front, back) };
            let begin = if enter > from { enter } else { from };
            let is_near = from <= leave;
            let end = if leave < to { leave } else { to };
            if begin <= to {
                self.push(far.1, far.0, [begin, to]);
                if is_near {
                    self.push(LEAF, own, [begin, end]);
                }
            }
            if !is_near {
                return;
            }
            to = end;
            (all, node) = near;
        }
        (self.run, self.span) = (all, [from, to]);
    }

    /// The fragments on a node's plane, and those on its sides, each side with the node that divides it.
    #[inline]
    fn divided(&self, node: usize, all: Range<u32>) -> (Range<u32>, [(Range<u32>, u32); 2]) {
        let record = &self.tree.nodes[node];
        let Ranges { own, front, back } = record.ranges(all);
        let child = |node: Option<usize>| node.map_or(LEAF, |node| node as u32);
        (own, [(front, child(record.front_node(node))), (back, child(record.back_node(node)))])
    }

    /// How far the ray is from a node's plane.
    #[inline]
    fn distance(&self, node: usize) -> Distance {
        let [x, y, z, offset] = self.tree.planes.get(node).to_array().map(f64::from);
        let ([a, b, c], [d, e, f]) = (self.origin, self.direction);
        Distance { start: x * a + y * b + z * c - offset, slope: x * d + y * e + z * f }
    }

    fn push(&mut self, node: u32, fragments: Range<u32>, [from, to]: [f64; 2]) {
        if fragments.is_empty() {
            return;
        }
        let below = self.pending.last().map_or(f64::INFINITY, |part| part.floor);
        let Range { start: first, end } = fragments;
        self.pending.push(Pending { node, first, end, from, to, floor: from.min(below) });
    }

    /// The parameters between which the ray is where corners can be; `None` if it never is.
    fn within_reach(&self, probe: &RayQuery) -> Option<[f64; 2]> {
        let reach = MAX_CORNER / LATTICE_LIMIT + self.slack;
        // An endless ray without a direction is a point as well.
        let is_endless = probe.is_endless && probe.speed > 0.0;
        let (mut from, mut to) = (0.0_f64, if is_endless { f64::INFINITY } else { 1.0 });
        for (start, slope) in self.origin.into_iter().zip(self.direction) {
            // Without a slope these are infinite, or not a number, which `min` and `max` pass over.
            let [a, b] = [-reach, reach].map(|side| (side - start) / slope);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from <= to).then_some([from, to])
    }
}

/// The distance of a point of a ray from a plane: `start` + t · `slope`, positive in front.
struct Distance {
    start: f64,
    slope: f64,
}

/// Where a ray crosses a plane, give or take the slack.
struct Crossing {
    enter: f64,
    leave: f64,
    /// Whether the ray goes to the front.
    is_forwards: bool,
}

impl Distance {
    /// Between which parameters the ray is within the slack of the plane.
    #[inline]
    fn crossing(&self, slack: f64) -> Crossing {
        let is_forwards = self.slope >= 0.0;
        let toward = if is_forwards { -self.start } else { self.start };
        // Without a slope these are infinite, or not a number, with which every comparison is false.
        let speed = self.slope.abs();
        Crossing { enter: (toward - slack) / speed, leave: (toward + slack) / speed, is_forwards }
    }
}

/// A ray and a tree's boxes, in the unit of these.
#[derive(Clone, Debug)]
pub(super) struct Boxes<'t> {
    bounds: &'t Bounds,
    /// For each axis: the origin, with the slack added and taken off, and one over the direction.
    origins: [[f64; 2]; 3],
    inverses: [f64; 3],
}

/// Boxes count as larger by this share of the largest coordinate: what the direction, its inverse, the
/// way to a side and the product with it lose is a fourth of that.
/// Smaller: fragments that are met are passed over. Larger: more are looked at in vain.
const PARAMETER_ERROR: f64 = 8.0 * f64::EPSILON;

/// One over the smallest coordinate of a direction that counts.
const STEEP: f64 = 1e250;

/// Origins and directions of other sizes, beside that of the scene, are looked at without boxes, whose floats
/// would overflow or lose digits there.
const SIZES: Range<f64> = 1e-200..1e200;

impl<'t> Boxes<'t> {
    /// `None` if boxes cannot be trusted with a ray.
    pub(super) fn new(probe: &RayQuery, bounds: &'t Bounds) -> Option<Self> {
        let unit = 1.0 / LATTICE_LIMIT;
        let [reach, speed] = [probe.reach * unit, probe.speed * unit];
        if ![reach, speed].iter().all(|size| SIZES.contains(size)) {
            return None;
        }
        let slack = PARAMETER_ERROR * reach;
        Some(Self {
            bounds,
            origins: probe.origin.map(|c| [c * unit + slack, c * unit - slack]),
            inverses: probe.direction.map(|c| {
                let inverse = 1.0 / (c * unit);
                if inverse.abs() < STEEP { inverse } else { STEEP.copysign(c) }
            }),
        })
    }

    /// Between which parameters the line of the ray may be in a box; it is not if the first is larger.
    #[inline]
    fn within(&self, bounds: &Flat) -> [f64; 2] {
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let [low, high] = self.origins[axis];
            let a = (f64::from(bounds[axis]) - low) * self.inverses[axis];
            let b = (f64::from(bounds[axis + 3]) - high) * self.inverses[axis];
            let first = if a < b { a } else { b };
            let last = if a > b { a } else { b };
            enter = if first > enter { first } else { enter };
            leave = if last < leave { last } else { leave };
        }
        [enter, leave]
    }

    /// The same for the box of a subtree.
    #[inline]
    pub(super) fn of_node(&self, node: usize) -> [f64; 2] {
        self.within(&self.bounds.nodes[node])
    }

    /// Takes the fragments off a run whose boxes the ray does not meet between two parameters, up to the
    /// first that it may meet; gives that one.
    #[inline]
    pub(super) fn next(&self, run: &mut Range<u32>, [from, to]: [f64; 2]) -> Option<u32> {
        while run.start < run.end {
            let (mut level, mut len) = self.bounds.block(run);
            let is_met = loop {
                let [enter, leave] = self.within(&self.bounds.get(level, run.start / len));
                if !(enter <= leave && enter <= to && leave >= from) {
                    break false;
                }
                if level == 0 {
                    break true;
                }
                (level, len) = (level - 1, len / BLOCK as u32);
            };
            let first = run.start;
            run.start += len;
            if is_met {
                return Some(first);
            }
        }
        None
    }
}
