//! The parts of a tree that a ray may meet, nearest first.
//!
//! A partition plane divides the ray: the ray can meet one side of the tree only before the plane, and the
//! other side only after the plane. But the tolerance lets fragments reach across the plane, and the walk
//! reads planes that are rounded to `f32`. So each side, and the fragments *on* the plane, are visited up to
//! a small distance beyond the plane. So the walk also visits some parts that the ray does not meet. These
//! visits change no result: the module `ray` decides which fragments are met, and in which order.

use std::ops::Range;

use smallvec::SmallVec;

use super::ray::RayQuery;
use crate::exact::LATTICE_LIMIT;
use crate::exact::lattice::MAX_CORNER;
use crate::tree::bounds::Bounds;
use crate::tree::node::Ranges;
use crate::tree::{BspTree, Flat};

/// The parts of a tree that a ray has not reached yet.
#[derive(Clone, Debug)]
pub(super) struct Walk<'t> {
    tree: &'t BspTree,
    boxes: Option<Boxes<'t>>,
    /// A stack: the nearest part is on top.
    pending: SmallVec<[Pending; 24]>,
    /// The ray in units of 2⁵¹ lattice steps, like the tree's planes.
    origin: [f64; 3],
    direction: [f64; 3],
    /// The largest distance by which a fragment on one side of a plane may reach across the plane, or a
    /// fragment on a plane may reach off the plane.
    slack: f64,
    /// Fragments that the ray has reached.
    run: Range<u32>,
    /// The parameters between which the ray may meet the fragments of `run`.
    span: [f64; 2],
}

/// A part of the tree (a subtree, or fragments without nodes), and the parameters between which the ray may
/// meet the part.
#[derive(Clone, Copy, Debug)]
struct Pending {
    /// The root of the subtree; [`LEAF`] for fragments without nodes.
    node: u32,
    first: u32,
    end: u32,
    from: f64,
    to: f64,
    /// The ray meets neither this part nor the parts below it on the stack before this parameter.
    floor: f64,
}

const LEAF: u32 = u32::MAX;

/// Error bound of a plane that is rounded to `f32`, at points of the scene, in units of 2⁵¹ lattice steps:
/// 2⁻²⁴ of the normal's coordinates, times the point's coordinates of at most 1.014, and 2⁻²⁴ of the offset.
/// The normal is a unit vector, so the error is at most 2⁻²⁴ · 1.014 · (√3 + √3). Too small: fragments that
/// are met are missed. Too large: more fragments are visited without success.
const PLANE_ERROR: f64 = 2.2e-7;

/// Error bound of a plane's distance from a point of the ray, as a share of the query's reach.
const REACH_ERROR: f64 = 16.0 * f64::EPSILON;

impl<'t> Walk<'t> {
    /// Begins a walk of the whole tree.
    pub(super) fn new(tree: &'t BspTree, query: &RayQuery) -> Self {
        let unit = 1.0 / LATTICE_LIMIT;
        let tolerance = tree.faces.tolerance() * unit * (1.0 + 1e-6);
        let mut walk = Self {
            tree,
            boxes: Boxes::new(query, tree.boxes()),
            pending: SmallVec::new(),
            origin: query.origin.map(|c| c * unit),
            direction: query.direction.map(|c| c * unit),
            slack: PLANE_ERROR + tolerance + REACH_ERROR * query.reach * unit,
            run: 0..0,
            span: [0.0; 2],
        };
        if let Some([from, to]) = walk.within_reach(query) {
            let node = if tree.nodes.is_empty() { LEAF } else { 0 };
            walk.push(node, 0..tree.len() as u32, [from, to]);
        }
        walk
    }

    /// The next fragment that the ray may meet; `None` if the ray meets no further fragment up to a limit.
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
            if self.floor() > limit {
                return None;
            }
            let part = self.pending.pop()?;
            self.descend(part, limit);
        }
    }

    /// The ray meets no pending part before this parameter.
    fn floor(&self) -> f64 {
        self.pending.last().map_or(f64::INFINITY, |part| part.floor)
    }

    /// Descends on the near side of a subtree to the first fragments, and pushes the other parts onto the
    /// stack.
    fn descend(&mut self, part: Pending, limit: f64) {
        let Pending { mut node, first, end, mut from, mut to, .. } = part;
        let mut all = first..end;
        // The number of fragments of the last box compared; initially no box was compared.
        let mut boxed = u32::MAX;
        while node != LEAF {
            let index = node as usize;
            let len = all.end - all.start;
            if let Some(boxes) = self.boxes.as_ref().filter(|_| len < boxed - boxed / 4) {
                boxed = len;
                let [enter, leave] = boxes.within(&boxes.bounds.nodes[index]);
                from = if enter > from { enter } else { from };
                to = if leave < to { leave } else { to };
                if from > to {
                    return;
                }
                if from > limit && self.floor() > limit {
                    return self.push(node, all, [from, to]);
                }
            }
            let record = &self.tree.nodes[index];
            let Ranges { own, front, back } = record.ranges(all);
            let child = |node: Option<usize>| node.map_or(LEAF, |node| node as u32);
            let front = (front, child(record.front_node(index)));
            let back = (back, child(record.back_node(index)));
            // The distance of the ray from the plane is start + t · slope.
            let [x, y, z, offset] = self.tree.planes.get(index).to_array().map(f64::from);
            let ([a, b, c], [d, e, f]) = (self.origin, self.direction);
            let (start, slope) = (x * a + y * b + z * c - offset, x * d + y * e + z * f);
            let [begin, end] = [from, to].map(|t| start + slope * t);
            if begin > self.slack && end > self.slack {
                (all, node) = front;
                continue;
            }
            if begin < -self.slack && end < -self.slack {
                (all, node) = back;
                continue;
            }
            let (near, far, toward) =
                if slope >= 0.0 { (back, front, -start) } else { (front, back, start) };
            // Between the parameters `enter` and `leave`, the ray is within the slack of the plane. If the
            // slope is 0, the parameters are infinite or NaN; every comparison with NaN is false.
            let [enter, leave] =
                [toward - self.slack, toward + self.slack].map(|d| d / slope.abs());
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

    fn push(&mut self, node: u32, fragments: Range<u32>, [from, to]: [f64; 2]) {
        if !fragments.is_empty() {
            let Range { start: first, end } = fragments;
            let floor = from.min(self.floor());
            self.pending.push(Pending { node, first, end, from, to, floor });
        }
    }

    /// The parameters between which the ray is in the cube that contains all corners; `None` if the ray
    /// misses the cube.
    fn within_reach(&self, query: &RayQuery) -> Option<[f64; 2]> {
        let reach = MAX_CORNER / LATTICE_LIMIT + self.slack;
        // An endless ray without a direction is also a point.
        let is_endless = query.is_endless && query.speed > 0.0;
        let (mut from, mut to) = (0.0_f64, if is_endless { f64::INFINITY } else { 1.0 });
        for (start, slope) in self.origin.into_iter().zip(self.direction) {
            // If the slope is 0, both parameters are infinite or NaN; `min` and `max` ignore NaN.
            let [a, b] = [-reach, reach].map(|side| (side - start) / slope);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from <= to).then_some([from, to])
    }
}

/// A ray and the boxes of fragments, in the unit of the boxes.
#[derive(Clone, Debug)]
pub(super) struct Boxes<'t> {
    bounds: &'t Bounds,
    /// For each axis: the origin plus and minus the slack, and 1 divided by the direction.
    origins: [[f64; 2]; 3],
    inverses: [f64; 3],
}

/// Boxes count as larger by this share of the largest coordinate. The roundings of the direction, the
/// inverse, the distance to a side and the product of the last two are together a fourth of this share. Too
/// small: fragments that are met are missed. Too large: more fragments are visited without success.
const PARAMETER_ERROR: f64 = 8.0 * f64::EPSILON;

/// The largest inverse of a direction's coordinate: larger and infinite inverses are replaced by this value.
const STEEP: f64 = 1e250;

/// The sizes of origins and directions, relative to the scene, for which boxes are used. Outside this range,
/// the boxes' floats would overflow or lose digits.
const SIZES: Range<f64> = 1e-200..1e200;

impl<'t> Boxes<'t> {
    /// Prepares a ray for comparisons with boxes. `None` if floats would overflow or lose digits.
    pub(super) fn new(query: &RayQuery, bounds: &'t Bounds) -> Option<Self> {
        let unit = 1.0 / LATTICE_LIMIT;
        let [reach, speed] = [query.reach * unit, query.speed * unit];
        if !SIZES.contains(&reach) || speed > 0.0 && !SIZES.contains(&speed) {
            return None;
        }
        let slack = PARAMETER_ERROR * reach;
        Some(Self {
            bounds,
            origins: query.origin.map(|c| [c * unit + slack, c * unit - slack]),
            inverses: query.direction.map(|c| {
                let inverse = 1.0 / (c * unit);
                if inverse.abs() < STEEP { inverse } else { STEEP.copysign(c) }
            }),
        })
    }

    /// The parameters between which the line of the ray may be in a box. If the first is larger, the line
    /// does not meet the box.
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

    /// The next fragment whose box the ray meets between two parameters.
    #[inline]
    pub(super) fn next(&self, run: &mut Range<u32>, [from, to]: [f64; 2]) -> Option<u32> {
        let is_passed = |bounds: &Flat| {
            let [enter, leave] = self.within(bounds);
            !(enter <= leave && enter <= to && leave >= from)
        };
        self.bounds
            .next_block(run, |bounds| is_passed(bounds).then_some(false))
            .map(|(block, _)| block.start)
    }
}
