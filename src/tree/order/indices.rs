//! Orders as lists of fragment numbers, in linear passes over the tree.

#[cfg(test)]
mod tests;

use std::hint::select_unpredictable;
use std::ops::Range;

use super::eye_sides::View;
use super::schedule::{Branch, List, NEXT, ROOT, Run, Schedule};
use super::twig::{FRAGMENTS, NODES};
use crate::tree::BspTree;
use crate::viewpoint::Viewpoint;

/// Spare places behind an order: a twig always writes as many numbers as the largest has.
const ROOM: usize = FRAGMENTS;

impl BspTree {
    /// Writes the numbers of all fragments, back to front, into a buffer, and replaces its contents.
    ///
    /// The buffer is working space as well. Its capacity grows to one or two numbers per fragment,
    /// at most four per fragment plus sixteen; after that, nothing is allocated.
    ///
    /// O(n), without a stack: every node stores how many fragments lie on each of its sides, so the
    /// place of a subtree in the order is known before the subtree is read, and each number is
    /// written to its final place.
    pub fn back_to_front_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        let view = View::new(self, viewpoint);
        let Some(schedule) = &self.schedule else {
            order.clear();
            let (nodes, fragments) = (self.nodes.len() as u32, self.len() as u32);
            return write_from_nodes(self, &view, 0..nodes, 0..fragments, order);
        };
        write_order(schedule, self.records.len(), self.planes.words(), order, |signs| {
            view.write_signs(self, signs);
        });
    }

    /// Writes the numbers of all fragments, front to back, into a buffer: the reverse of
    /// [`back_to_front_into`](Self::back_to_front_into).
    pub fn front_to_back_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        self.back_to_front_into(viewpoint, order);
        order.reverse();
    }
}

/// Adds the order of a subtree, or of all, from the nodes themselves.
pub(in crate::tree) fn write_from_nodes(
    tree: &BspTree,
    view: &View,
    nodes: Range<u32>,
    fragments: Range<u32>,
    order: &mut Vec<u32>,
) {
    let (begin, len) = (order.len(), fragments.len());
    order.resize(begin + len + 2 * nodes.len(), 0);
    // Where the subtree at each node begins in the order, and how many fragments it has.
    let (numbers, subtrees) = order[begin..].split_at_mut(len);
    match subtrees.first_chunk_mut() {
        Some(root) => *root = [0, len as u32],
        None => {
            numbers.iter_mut().zip(fragments.clone()).for_each(|(place, number)| *place = number)
        }
    }
    // Fragments are numbered in the order in which nodes are met here.
    let mut next = fragments.start;
    let mut write = |begin: u32, len: u32| {
        let places = &mut numbers[begin as usize..][..len as usize];
        places.iter_mut().zip(next..).for_each(|(place, number)| *place = number);
        next += len;
    };
    for (i, index) in (nodes.start as usize..nodes.end as usize).enumerate() {
        let node = &tree.nodes[index];
        let [begin, all] = [subtrees[2 * i], subtrees[2 * i + 1]];
        let (own, front) = (node.own(), node.front_len);
        let back = all - own - front;
        let is_in_front = view.is_in_front(tree, index);
        let to_own = begin + select_unpredictable(is_in_front, back, front);
        let to_front = begin + select_unpredictable(is_in_front, back + own, 0);
        let to_back = begin + select_unpredictable(is_in_front, 0, front + own);
        write(to_own, own);
        let sides = [(node.front_node(i), to_front, front), (node.back_node(i), to_back, back)];
        for (child, begin, len) in sides {
            match child {
                Some(child) => subtrees[2 * child..][..2].copy_from_slice(&[begin, len]),
                None => write(begin, len),
            }
        }
    }
    order.truncate(begin + len);
}

/// Writes an order in three passes over the tree's memory: on which side of each node the eye is,
/// then where each subtree begins in the order, then the fragments of subtrees too small for that.
///
/// `write_signs` fills `words` words with a bit for each node, 1 if the eye is in front.
#[inline]
fn write_order(
    schedule: &Schedule,
    fragments: usize,
    words: usize,
    order: &mut Vec<u32>,
    write_signs: impl FnOnce(&mut [u32]),
) {
    // One buffer for all: the caller's, so that a frame allocates nothing.
    order.resize(fragments + ROOM + schedule.parts() + words, 0);
    let (numbers, rest) = order.split_at_mut(fragments + ROOM);
    // Where each part begins in the order.
    let (begins, signs) = rest.split_at_mut(schedule.parts());
    if let Some(root) = begins.get_mut(ROOT as usize) {
        *root = 0;
    }
    write_signs(signs);
    write_branches(&schedule.branches, signs, begins, numbers);
    let begins = &begins[ROOT as usize + schedule.branches.len()..];
    let (of_twigs, of_runs) = begins.split_at(schedule.twigs.len());
    write_twigs(schedule, signs, of_twigs, numbers);
    write_runs(&schedule.runs, of_runs, numbers);
    order.truncate(fragments);
}

/// Writes the fragments on the planes of branches, and notes where the parts on their sides begin.
///
/// The loop has no branch on the eye's side, which no processor can predict; missing parts and
/// fragments write to dummy slots.
fn write_branches(branches: &[Branch], signs: &[u32], begins: &mut [u32], numbers: &mut [u32]) {
    let nowhere = numbers.len() - 1;
    let mut begin = 0;
    for (branch, next) in branches.iter().zip(ROOT as usize + 1..) {
        let &Branch { own, front, back, .. } = branch;
        let is_in_front = is_in_front(signs, branch.node);
        // The order is: far side, own, near side. The far side is the back if the eye is in front.
        let mut to_front = select_unpredictable(is_in_front, back + own, 0);
        let mut to_back = select_unpredictable(is_in_front, 0, front + own);
        let to_own = select_unpredictable(is_in_front, back, front);
        if own <= 1 {
            let place = select_unpredictable(own == 1, (begin + to_own) as usize, nowhere);
            // Without an own fragment, the write goes to a spare place behind the order. That is
            // cheaper than a branch that is taken for every other node.
            numbers[place] = branch.own_first;
        } else if let Some(list) = branch.list() {
            let to_rest = write_list(&list, signs, begin, numbers);
            // One of the two sides is `NOBODY`; the other is what the list leaves.
            (to_front, to_back) = (to_rest, to_rest);
        } else {
            begins[branch.own_first as usize] = begin + to_own;
        }
        begins[branch.front_part as usize] = begin + to_front;
        begins[branch.back_part as usize] = begin + to_back;
        // The next branch mostly is a child of this one, and then its place has just been computed.
        // Passing it on in a register saves the loop from waiting for a store to be read back.
        let stored = begins[next];
        let from_back = select_unpredictable(branch.back_part == NEXT, begin + to_back, stored);
        begin = select_unpredictable(branch.front_part == NEXT, begin + to_front, from_back);
    }
}

/// Writes subtrees of up to four fragments, each by one look into a table.
fn write_twigs(schedule: &Schedule, signs: &[u32], begins: &[u32], numbers: &mut [u32]) {
    for (twig, &begin) in schedule.twigs.iter().zip(begins) {
        let word = twig.node as usize / 32;
        // The bits of a twig's nodes may lie across two words; `signs` has one word more than it needs.
        let words = u64::from(signs[word]) | u64::from(signs[word + 1]) << 32;
        let signs = (words >> (twig.node % 32)) as usize % (1 << NODES);
        let places = schedule.permutations[twig.row as usize][signs] as usize;
        let room = numbers[begin as usize..].first_chunk_mut::<FRAGMENTS>();
        let Some(numbers) = room else { continue };
        // Always four writes. A fragment that the twig does not have shares the place of the first
        // one, which is written last.
        numbers[places >> 6] = twig.first + 3;
        numbers[places >> 4 & 3] = twig.first + 2;
        numbers[places >> 2 & 3] = twig.first + 1;
        numbers[places & 3] = twig.first;
    }
}

fn write_runs(runs: &[Run], begins: &[u32], numbers: &mut [u32]) {
    for (run, &begin) in runs.iter().zip(begins) {
        let places = &mut numbers[begin as usize..][..run.len as usize];
        places.iter_mut().zip(run.first..).for_each(|(place, number)| *place = number);
    }
}

/// Writes the fragments of a list from both ends inwards. Returns how many of them come before the
/// rest, which lies behind or in front of the last node.
fn write_list(list: &List, signs: &[u32], begin: u32, numbers: &mut [u32]) -> u32 {
    let places = &mut numbers[begin as usize..][..(list.nodes + list.rest) as usize];
    let (mut far, mut near) = (0, places.len() - 1);
    for (node, number) in (list.first_node..).zip(list.first..).take(list.nodes as usize) {
        // The node's fragment is further than the rest if the rest and the eye are on one side.
        let is_far = is_in_front(signs, node) == list.rest_is_front;
        places[select_unpredictable(is_far, far, near)] = number;
        far += usize::from(is_far);
        near -= usize::from(!is_far);
    }
    far as u32
}

#[inline]
fn is_in_front(signs: &[u32], node: u32) -> bool {
    signs[node as usize / 32] >> (node % 32) & 1 == 1
}
