//! A tree laid out for writing orders: branches, and twigs that are ordered by a table.

use std::collections::HashMap;

use super::node::Node;
use super::twig::{FRAGMENTS, NODES, Permutations, Shape};

/// The part that is not there.
pub(super) const NOBODY: u32 = 0;
/// The part that is the next branch, whose number needs no looking up.
pub(super) const NEXT: u32 = 1;
/// The part of the whole tree.
pub(super) const ROOT: u32 = 2;

/// A tree's fragments as *parts*, each of which has one place in an order, in one piece: a branch
/// is a node with all that is on its sides; a twig a subtree or a leaf of at most [`FRAGMENTS`]
/// fragments and [`NODES`] nodes; a run more fragments than that in the order of their numbers,
/// such as many in one plane. Parts are numbered from [`ROOT`] on, branches first, then twigs,
/// then runs, each depth first.
///
/// There are fewer than two parts to a fragment. Call *ends* the twigs, the runs, and the fragments
/// that are alone on the plane of a branch: each end has a fragment that no other has. A node has
/// fragments on its plane, or on both sides. So a branch holds two ends or branches at least, and
/// branches are fewer than ends; but for those with nothing beside the plane, each of which holds
/// one run, of more than [`FRAGMENTS`].
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Schedule {
    pub(super) branches: Vec<Branch>,
    pub(super) twigs: Vec<Twig>,
    pub(super) runs: Vec<Run>,
    /// How the signs of a twig's nodes permute its fragments.
    pub(super) permutations: Vec<Permutations>,
}

/// A node whose subtree is more than a twig; or several such nodes in a row, see [`List`].
///
/// What `own` and `own_first` mean depends on the former:
///
/// | `own` | is | `own_first` |
/// |---|---|---|
/// | 0 | nothing on the plane | any number |
/// | 1 | one fragment on the plane | the fragment |
/// | 2 or more, below [`LIST`] | so many fragments on the plane | the part that they are |
/// | [`LIST`] + n | a list of n nodes | the fragment of the first |
///
/// All that is written of an order is known from here but for the signs: with the eye in front,
/// what is behind comes first, then what is on the plane, then what is in front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Branch {
    /// The node, or the first of a list.
    pub(super) node: u32,
    pub(super) own: u32,
    /// How many fragments are in front and behind, those of all levels below; for a list, in front
    /// and behind of its last node.
    pub(super) front: u32,
    pub(super) back: u32,
    /// Which parts these are: [`NOBODY`], [`NEXT`], or a number. For a list, one is [`NOBODY`].
    pub(super) front_part: u32,
    pub(super) back_part: u32,
    pub(super) own_first: u32,
}

/// Marks a [`Branch`] that is a list.
const LIST: u32 = 1 << 31;

/// Shorter lists are branches like others: to tell them apart would cost more.
const SHORTEST_LIST: usize = 8;

/// Nodes in a row, each with one fragment on its plane and all others below one further node,
/// always on the same side: the order fills up from both ends, and what they leave comes between.
pub(super) struct List {
    pub(super) first_node: u32,
    pub(super) nodes: u32,
    /// The fragment of the first node; the others follow.
    pub(super) first: u32,
    /// How many fragments are left behind the last node, or in front of it.
    pub(super) rest: u32,
    pub(super) rest_is_front: bool,
}

impl Branch {
    /// The list that it stands for.
    #[inline]
    pub(super) fn list(&self) -> Option<List> {
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
pub(super) struct Twig {
    /// Its first node; any, if it is a leaf.
    pub(super) node: u32,
    /// Its first fragment.
    pub(super) first: u32,
    /// Its row of [`Schedule::permutations`].
    pub(super) row: u32,
}

/// Fragments in the order of their numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Run {
    pub(super) first: u32,
    pub(super) len: u32,
}

impl Schedule {
    /// Lays out a tree of so many fragments. O(nodes).
    pub(super) fn new(nodes: &[Node], fragments: u32) -> Self {
        let mut layout = Layout { nodes, schedule: Self::default(), rows: HashMap::new(), next: 0 };
        layout.fill(fragments);
        let mut schedule = layout.schedule;
        schedule.number();
        schedule.branches.shrink_to_fit();
        schedule.twigs.shrink_to_fit();
        schedule.runs.shrink_to_fit();
        schedule
    }

    /// How many parts there are, [`NOBODY`] and [`NEXT`] included.
    pub(super) fn parts(&self) -> usize {
        ROOT as usize + self.branches.len() + self.twigs.len() + self.runs.len()
    }

    /// The resident size in bytes, apart from its own.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.branches)
            + size_of_val(&*self.twigs)
            + size_of_val(&*self.runs)
            + size_of_val(&*self.permutations)
    }

    /// Numbers the parts, now that it is known how many there are of each kind.
    fn number(&mut self) {
        let twigs = ROOT + self.branches.len() as u32;
        let runs = twigs + self.twigs.len() as u32;
        for branch in &mut self.branches {
            let parts = [&mut branch.front_part, &mut branch.back_part];
            let own = (branch.own > 1 && branch.own & LIST == 0).then_some(&mut branch.own_first);
            for part in parts.into_iter().chain(own) {
                *part = match *part & KIND {
                    TWIG => twigs + (*part & !KIND),
                    RUN => runs + (*part & !KIND),
                    _ => *part,
                };
            }
        }
    }
}

/// The kind of a part while it is numbered among its kind only: fewer than 2²⁹ fragments leave
/// these bits.
const KIND: u32 = TWIG | RUN;
const TWIG: u32 = 1 << 31;
const RUN: u32 = 1 << 30;

/// Which part of a branch.
enum Side {
    Front,
    Back,
}

struct Layout<'a> {
    nodes: &'a [Node],
    schedule: Schedule,
    rows: HashMap<Shape, u32>,
    /// The first fragment that is in no part yet.
    next: u32,
}

/// A subtree that is to be laid out.
struct Subtree {
    node: usize,
    nodes: usize,
    fragments: u32,
    /// The branch that it is on a side of.
    parent: Option<(usize, Side)>,
}

impl Layout<'_> {
    fn fill(&mut self, fragments: u32) {
        let all = Subtree { node: 0, nodes: self.nodes.len(), fragments, parent: None };
        let mut stack = if self.nodes.is_empty() { vec![] } else { vec![all] };
        while let Some(subtree) = stack.pop() {
            let is_twig = subtree.nodes <= NODES && subtree.fragments as usize <= FRAGMENTS;
            let part = if is_twig {
                let nodes = &self.nodes[subtree.node..][..subtree.nodes];
                self.twig(subtree.node, Shape::of(nodes, subtree.fragments), subtree.fragments)
            } else {
                self.branch(&subtree, &mut stack)
            };
            if let Some((branch, side)) = subtree.parent {
                let part = if part == ROOT + branch as u32 + 1 { NEXT } else { part };
                let branch = &mut self.schedule.branches[branch];
                match side {
                    Side::Front => branch.front_part = part,
                    Side::Back => branch.back_part = part,
                }
            }
        }
    }

    fn branch(&mut self, subtree: &Subtree, stack: &mut Vec<Subtree>) -> u32 {
        let index = self.schedule.branches.len();
        let mut links = self.links(subtree);
        let first = self.next;
        if links >= SHORTEST_LIST {
            // The last node is laid out like one by itself; of the others, only the number counts.
            self.next += links as u32 - 1;
        } else {
            links = 1;
        }
        let node_index = subtree.node + links - 1;
        let node = &self.nodes[node_index];
        let (own, front) = (node.own(), node.front_len);
        let back = subtree.fragments - (links as u32 - 1) - own - front;
        let own_first = if own <= 1 { self.take(own) } else { self.leaf(own) };
        let front_nodes = node.front_nodes as usize;
        let front_part = if front_nodes == 0 { self.leaf(front) } else { NOBODY };
        let back_part = if node.back_is_node() { NOBODY } else { self.leaf(back) };
        if node.back_is_node() {
            stack.push(Subtree {
                node: node_index + 1 + front_nodes,
                nodes: subtree.nodes - links - front_nodes,
                fragments: back,
                parent: Some((index, Side::Back)),
            });
        }
        if front_nodes > 0 {
            stack.push(Subtree {
                node: node_index + 1,
                nodes: front_nodes,
                fragments: front,
                parent: Some((index, Side::Front)),
            });
        }
        let (own, own_first) =
            if links > 1 { (LIST | links as u32, first) } else { (own, own_first) };
        let node = subtree.node as u32;
        self.schedule.branches.push(Branch {
            node,
            own,
            front,
            back,
            front_part,
            back_part,
            own_first,
        });
        ROOT + index as u32
    }

    /// How many nodes at the top of a subtree make a list.
    fn links(&self, subtree: &Subtree) -> usize {
        let mut fragments = subtree.fragments;
        let side = |node: &Node, fragments: u32| {
            let rest_is_front = node.front_len + 1 == fragments;
            let rest_is_node =
                if rest_is_front { node.front_nodes > 0 } else { node.back_is_node() };
            let is_link = node.own() == 1 && rest_is_node && (rest_is_front || node.front_len == 0);
            is_link.then_some(rest_is_front)
        };
        let first = side(&self.nodes[subtree.node], fragments);
        self.nodes[subtree.node..]
            .iter()
            .take_while(|node| {
                let same = first.is_some() && side(node, fragments) == first;
                fragments -= u32::from(same);
                same
            })
            .count()
    }

    /// The part of fragments that no node tells apart.
    fn leaf(&mut self, fragments: u32) -> u32 {
        match fragments {
            0 => NOBODY,
            _ if fragments as usize <= FRAGMENTS => self.twig(0, Shape::leaf(fragments), fragments),
            _ => {
                let first = self.take(fragments);
                self.schedule.runs.push(Run { first, len: fragments });
                RUN | (self.schedule.runs.len() as u32 - 1)
            }
        }
    }

    fn twig(&mut self, node: usize, shape: Shape, fragments: u32) -> u32 {
        let permutations = &mut self.schedule.permutations;
        let row = *self.rows.entry(shape).or_insert_with(|| {
            permutations.push(shape.permutations());
            permutations.len() as u32 - 1
        });
        let first = self.take(fragments);
        self.schedule.twigs.push(Twig { node: node as u32, first, row });
        TWIG | (self.schedule.twigs.len() as u32 - 1)
    }

    /// The number of the first of so many fragments.
    fn take(&mut self, fragments: u32) -> u32 {
        let first = self.next;
        self.next += fragments;
        first
    }
}
