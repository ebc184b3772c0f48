//! What can be wrong with a tree.

use std::fmt;

use crate::exact::{PlaneId, Side};

/// What is wrong with a tree, and at which node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Invalid {
    /// The number of the node, depth first.
    pub node: usize,
    pub(super) what: Fault,
}

impl fmt::Display for Invalid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "node {}: {}", self.node, self.what)
    }
}

impl std::error::Error for Invalid {}

/// What is wrong at a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    Counts,
    CrowdedLeaf,
    IdlePlane,
    Plane(PlaneId),
    Outline { fragment: u32 },
    ListedWhole { fragment: u32 },
    Tolerance,
    Side { fragment: u32, expected: Side, found: Side },
    OwnOrder { fragment: u32 },
    Overlap(Culprit),
    Cut(Culprit),
    Incomplete(Culprit),
    Splits { counted: usize, found: usize },
    RoundedPlanes,
    OutOfMemory,
    Schedule,
    Positions,
}

/// A face whose pieces do not cover it once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Culprit {
    pub(super) face: u32,
    pub(super) polygon: usize,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Counts => f.write_str("the sizes of its subtrees contradict each other"),
            Self::CrowdedLeaf => f.write_str("a leaf has more than one fragment"),
            Self::IdlePlane => f.write_str("its plane separates no fragments"),
            Self::Plane(plane) => {
                write!(f, "its plane {plane:?} names a face or corner that does not exist")
            }
            Self::Outline { fragment } => {
                write!(f, "fragment {fragment} does not have three or more known vertices")
            }
            Self::ListedWhole { fragment } => {
                write!(f, "fragment {fragment} was never cut, but is stored as a cut piece")
            }
            Self::Tolerance => {
                f.write_str("at its plane the tolerance is not the length that it should be")
            }
            Self::Side { fragment, expected, found } => {
                write!(f, "fragment {fragment} is {found:?}, not {expected:?} as its place says")
            }
            Self::OwnOrder { fragment } => {
                write!(f, "fragment {fragment} on its plane comes before one of an earlier polygon")
            }
            Self::Overlap(culprit) => {
                write!(f, "a piece of {culprit} occurs twice, or another piece overlaps it")
            }
            Self::Cut(culprit) => {
                write!(f, "the pieces of {culprit} on its two sides do not fit along the cut")
            }
            Self::Incomplete(culprit) => write!(f, "the pieces of {culprit} do not add up to it"),
            Self::Splits { counted, found } => {
                write!(f, "the builder counted {counted} cuts, but the pieces show {found}")
            }
            Self::OutOfMemory => f.write_str("there is not enough memory to check the layout"),
            Self::RoundedPlanes => f.write_str("the rounded planes are not those of the nodes"),
            Self::Schedule => f.write_str("the layout for orders does not match the nodes"),
            Self::Positions => f.write_str("the positions are not those of the vertices"),
        }
    }
}

impl fmt::Display for Culprit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "polygon {} (face {})", self.polygon, self.face)
    }
}
