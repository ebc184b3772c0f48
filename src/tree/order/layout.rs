//! Lays out a tree: divides it into branches, twigs and runs.

use std::collections::HashMap;

use super::schedule::{Branch, LIST, NEXT, NOBODY, ROOT, Run, Schedule, Twig};
use super::twig::{FRAGMENTS, NODES, TwigShape};
use crate::Error;
use crate::memory::push;
use crate::tree::node_record::NodeRecord;

/// Shorter lists are stored as ordinary branches: to branch on a list costs more than a short one
/// saves.
const SHORTEST_LIST: usize = 8;

impl Schedule {
    /// Lays out a tree. O(nodes).
    pub(in crate::tree) fn new(nodes: &[NodeRecord], fragments: u32) -> Result<Self, Error> {
        let mut layout = Layout { nodes, schedule: Self::default(), rows: HashMap::new(), next: 0 };
        layout.fill(fragments)?;
        let mut schedule = layout.schedule;
        schedule.number();
        schedule.branches.shrink_to_fit();
        schedule.twigs.shrink_to_fit();
        schedule.runs.shrink_to_fit();
        Ok(schedule)
    }

    /// Replaces numbers within a kind by part numbers, once the size of each kind is known.
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

/// The bits that tell the kind of a part while parts are numbered within their kind. They are free
/// because a tree has fewer than 2²⁹ fragments.
const KIND: u32 = TWIG | RUN;
const TWIG: u32 = 1 << 31;
const RUN: u32 = 1 << 30;

/// A side of a branch.
enum BranchSide {
    Front,
    Back,
}

struct Layout<'a> {
    nodes: &'a [NodeRecord],
    schedule: Schedule,
    rows: HashMap<TwigShape, u32>,
    /// The first fragment that is not yet in a part.
    next: u32,
}

/// A subtree still to be laid out.
struct Unplaced {
    node: usize,
    nodes: usize,
    fragments: u32,
    /// The branch above it, and on which side of that it is.
    parent: Option<(usize, BranchSide)>,
}

impl Layout<'_> {
    fn fill(&mut self, fragments: u32) -> Result<(), Error> {
        let all = Unplaced { node: 0, nodes: self.nodes.len(), fragments, parent: None };
        let mut stack = if self.nodes.is_empty() { vec![] } else { vec![all] };
        while let Some(subtree) = stack.pop() {
            let is_twig = subtree.nodes <= NODES && subtree.fragments as usize <= FRAGMENTS;
            let part = if is_twig {
                let nodes = &self.nodes[subtree.node..][..subtree.nodes];
                self.twig(subtree.node, TwigShape::of(nodes, subtree.fragments), subtree.fragments)?
            } else {
                self.branch(&subtree, &mut stack)?
            };
            if let Some((branch, side)) = subtree.parent {
                // Parents are laid out before their children, so the parent learns the number here.
                // A child right behind its parent gets `NEXT`, which the writing loop can recognise
                // without reading memory.
                let part = if part == ROOT + branch as u32 + 1 { NEXT } else { part };
                let branch = &mut self.schedule.branches[branch];
                match side {
                    BranchSide::Front => branch.front_part = part,
                    BranchSide::Back => branch.back_part = part,
                }
            }
        }
        Ok(())
    }

    fn branch(&mut self, subtree: &Unplaced, stack: &mut Vec<Unplaced>) -> Result<u32, Error> {
        let index = self.schedule.branches.len();
        let mut links = self.links(subtree);
        let first = self.next;
        if links >= SHORTEST_LIST {
            // A list looks like its last node to everything below. The other nodes each have one
            // fragment, and these follow each other, so it is enough to count them.
            self.next += links as u32 - 1;
        } else {
            links = 1;
        }
        let node_index = subtree.node + links - 1;
        let node = &self.nodes[node_index];
        let (own, front) = (node.own(), node.front_len);
        let back = subtree.fragments - (links as u32 - 1) - own - front;
        let own_first = if own <= 1 { self.take(own) } else { self.leaf(own)? };
        let front_nodes = node.front_nodes as usize;
        let front_part = if front_nodes == 0 { self.leaf(front)? } else { NOBODY };
        let back_part = if node.back_is_node() { NOBODY } else { self.leaf(back)? };
        // The back goes on the stack first, so that the front comes off first: branches, twigs and
        // fragments must be numbered depth first, as they stand in memory.
        if node.back_is_node() {
            let parent = Some((index, BranchSide::Back));
            let nodes = subtree.nodes - links - front_nodes;
            let node = node_index + 1 + front_nodes;
            push(stack, Unplaced { node, nodes, fragments: back, parent })?;
        }
        if front_nodes > 0 {
            let parent = Some((index, BranchSide::Front));
            let node = node_index + 1;
            push(stack, Unplaced { node, nodes: front_nodes, fragments: front, parent })?;
        }
        let (own, own_first) =
            if links > 1 { (LIST | links as u32, first) } else { (own, own_first) };
        let node = subtree.node as u32;
        let branch = Branch { node, own, front, back, front_part, back_part, own_first };
        push(&mut self.schedule.branches, branch)?;
        Ok(ROOT + index as u32)
    }

    /// How many nodes at the top of a subtree form a list.
    fn links(&self, subtree: &Unplaced) -> usize {
        let mut fragments = subtree.fragments;
        let side = |node: &NodeRecord, fragments: u32| {
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
                // Stops where the side changes: the rest would no longer lie between the two ends.
                let same = first.is_some() && side(node, fragments) == first;
                fragments -= u32::from(same);
                same
            })
            .count()
    }

    /// Makes a part of fragments that no node separates.
    fn leaf(&mut self, fragments: u32) -> Result<u32, Error> {
        match fragments {
            0 => Ok(NOBODY),
            _ if fragments as usize <= FRAGMENTS => {
                self.twig(0, TwigShape::leaf(fragments), fragments)
            }
            _ => {
                let first = self.take(fragments);
                push(&mut self.schedule.runs, Run { first, len: fragments })?;
                Ok(RUN | (self.schedule.runs.len() as u32 - 1))
            }
        }
    }

    /// Makes a twig; twigs of one shape share a row of the table.
    fn twig(&mut self, node: usize, shape: TwigShape, fragments: u32) -> Result<u32, Error> {
        // The table has a row for each shape, of which there is a fixed number.
        let permutations = &mut self.schedule.permutations;
        let row = *self.rows.entry(shape).or_insert_with(|| {
            permutations.push(shape.permutations());
            permutations.len() as u32 - 1
        });
        let first = self.take(fragments);
        push(&mut self.schedule.twigs, Twig { node: node as u32, first, row })?;
        Ok(TWIG | (self.schedule.twigs.len() as u32 - 1))
    }

    /// Assigns the next fragments to a part, and returns the number of the first.
    fn take(&mut self, fragments: u32) -> u32 {
        let first = self.next;
        self.next += fragments;
        first
    }
}
