//! Edges that meet at their ends only, as the sweep of `arrange` leaves them.

use super::edge::Edge;

/// How overlapping edges count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// By direction: opposite edges cancel, two of the same direction count 2.
    Signed,
    /// By parity: any two cancel.
    Parity,
}

/// Edges that meet at their ends only.
#[derive(Debug)]
pub(super) struct Arrangement {
    /// In the order of their first ends; those of one point from the lowest to the highest.
    pub(super) edges: Vec<Edge>,
    /// The points at which edges begin or end, in order.
    pub(super) stops: Vec<Stop>,
}

/// A point at which edges begin or end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    pub(super) point: u32,
    /// The edge next below it, or [`NONE`](super::sweep_line::NONE).
    pub(super) below: u32,
    /// The first edge that begins here, or the next one that begins anywhere.
    pub(super) first: u32,
}
