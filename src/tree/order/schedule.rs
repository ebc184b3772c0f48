//! Where the fragments of a tree stand in memory, for orders to be written from: branches, and twigs that a
//! table puts in order.

use super::twig::Permutations;

/// Part number for "none".
pub(in crate::tree) const NOBODY: u32 = 0;
/// Part number for "the branch that follows in memory".
pub(in crate::tree) const NEXT: u32 = 1;
/// Part number of the whole tree.
pub(in crate::tree) const ROOT: u32 = 2;

/// A tree's fragments, divided into *parts*. The fragments of a part are contiguous in every order.
///
/// - A *branch* is a node with everything on its sides.
/// - A *twig* is a subtree or leaf of at most [`FRAGMENTS`](super::twig::FRAGMENTS) fragments and
///   [`NODES`](super::twig::NODES) nodes.
/// - A *run* is a longer sequence of fragments that always come in the order of their numbers, such
///   as many on one plane.
///
/// Parts are numbered from [`ROOT`]: branches first, then twigs, then runs, each depth first.
///
/// There are fewer than two parts per fragment. Proof: call *ends* the twigs, the runs, and the
/// fragments that are alone on the plane of a branch. Each end has a fragment of its own, so there
/// are at most as many ends as fragments. A node has fragments on its plane or on both sides, so a
/// branch contains at least two ends or branches, and there are fewer branches than ends. The
/// exception is a branch with nothing beside its plane; it contains one run, which has more than
/// [`FRAGMENTS`](super::twig::FRAGMENTS) fragments.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::tree) struct Schedule {
    pub(in crate::tree) branches: Vec<Branch>,
    pub(in crate::tree) twigs: Vec<Twig>,
    pub(in crate::tree) runs: Vec<Run>,
    /// For each shape of twig: how the signs of its nodes permute its fragments.
    pub(in crate::tree) permutations: Vec<Permutations>,
}

/// A node whose subtree is too large for a twig, or several such nodes in a row; see [`List`].
///
/// The value of `own` decides what `own` and `own_first` mean:
///
/// | `own` | meaning | `own_first` |
/// |---|---|---|
/// | 0 | no fragment on the plane | unused |
/// | 1 | one fragment on the plane | its number |
/// | 2 or more, below [`LIST`] | that many fragments on the plane | their part number |
/// | [`LIST`] + n | a list of n nodes | the number of the first node's fragment |
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tree) struct Branch {
    /// The node, or the first of a list.
    pub(in crate::tree) node: u32,
    pub(in crate::tree) own: u32,
    /// How many fragments are in front and behind, at all levels below; for a list, those of its last
    /// node.
    pub(in crate::tree) front: u32,
    pub(in crate::tree) back: u32,
    /// Their part numbers. For a list, one is [`NOBODY`].
    pub(in crate::tree) front_part: u32,
    pub(in crate::tree) back_part: u32,
    pub(in crate::tree) own_first: u32,
}

/// Marks a [`Branch`] that is a list.
pub(super) const LIST: u32 = 1 << 31;

/// Nodes in a row, each with one fragment on its plane and all others below a single child, always
/// on the same side. The order is written from both ends inwards; the rest comes in between.
pub(in crate::tree) struct List {
    pub(in crate::tree) first_node: u32,
    pub(in crate::tree) nodes: u32,
    /// The fragment of the first node; the others follow.
    pub(in crate::tree) first: u32,
    /// How many fragments are below the last node.
    pub(in crate::tree) rest: u32,
    pub(in crate::tree) rest_is_front: bool,
}

impl Branch {
    /// The list, if it is one.
    #[inline]
    pub(in crate::tree) fn list(&self) -> Option<List> {
        (self.own & LIST != 0).then(|| List {
            first_node: self.node,
            nodes: self.own & !LIST,
            first: self.own_first,
            rest: self.front + self.back,
            rest_is_front: self.front > 0,
        })
    }
}

/// A subtree or a leaf of few fragments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tree) struct Twig {
    /// Its first node; any, if it is a leaf.
    pub(in crate::tree) node: u32,
    /// Its first fragment.
    pub(in crate::tree) first: u32,
    /// Its row of [`Schedule::permutations`].
    pub(in crate::tree) row: u32,
}

/// Fragments in the order of their numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tree) struct Run {
    pub(in crate::tree) first: u32,
    pub(in crate::tree) len: u32,
}

impl Schedule {
    /// How many parts there are, [`NOBODY`] and [`NEXT`] included.
    pub(in crate::tree) fn parts(&self) -> usize {
        ROOT as usize + self.branches.len() + self.twigs.len() + self.runs.len()
    }

    /// The resident size in bytes, apart from its own.
    pub(in crate::tree) fn bytes(&self) -> usize {
        size_of_val(&*self.branches)
            + size_of_val(&*self.twigs)
            + size_of_val(&*self.runs)
            + size_of_val(&*self.permutations)
    }
}
