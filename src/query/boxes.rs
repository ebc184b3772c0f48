//! Where a ray may meet the boxes of a tree's subtrees and fragments.

use std::ops::Range;

use super::probe::Probe;
use crate::exact::LATTICE_LIMIT;
use crate::tree::{BLOCK, Bounds, Flat};

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
    pub(super) fn new(probe: &Probe, bounds: &'t Bounds) -> Option<Self> {
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
