//! Orders as lists of fragment numbers, in linear passes over the tree.

#[cfg(test)]
mod tests;

use std::hint::select_unpredictable;

use super::BspTree;
use super::planes::View;
use super::schedule::{Branch, List, NEXT, ROOT, Run, Schedule};
use super::twig::{FRAGMENTS, NODES};
use crate::geom::{Kernel, Viewpoint};

/// A twig is written as if it had the most fragments, so there is room for more behind an order.
const ROOM: usize = FRAGMENTS;

impl<K: Kernel> BspTree<K> {
    /// Writes the numbers of all fragments, back to front, into a buffer, in place of what it
    /// held. The buffer is working space as well: it grows to one or two numbers for each
    /// fragment, at most to four and sixteen more, and once it has, nothing is allocated.
    ///
    /// Where the fragments of a subtree begin in the order is known before the subtree is walked,
    /// as every node knows how many lie on each of its sides. So the nodes are taken as they stand
    /// in memory, without a stack, and each fragment's number is written to its final place:
    /// first it is decided for all nodes, four at once, on which side the eye is; then each subtree
    /// gets its place; last, subtrees of up to four fragments take their order from a table.
    /// Nothing branches on the eye's side: what is not there has a place that nobody reads.
    pub fn back_to_front_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        let view = View::new(self, viewpoint);
        write_order(&self.schedule, self.records.len(), self.planes.words(), order, |signs| {
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

/// Writes an order of so many fragments, given what writes on which side of each node the eye is,
/// a bit each, into so many words.
#[inline]
fn write_order(
    schedule: &Schedule,
    fragments: usize,
    words: usize,
    order: &mut Vec<u32>,
    write_signs: impl FnOnce(&mut [u32]),
) {
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

/// Writes what is on the planes of branches, and notes where the parts on their sides begin.
fn write_branches(branches: &[Branch], signs: &[u32], begins: &mut [u32], numbers: &mut [u32]) {
    let nowhere = numbers.len() - 1;
    let mut begin = 0;
    for (branch, next) in branches.iter().zip(ROOT as usize + 1..) {
        let &Branch { own, front, back, .. } = branch;
        let is_in_front = is_in_front(signs, branch.node);
        // Far, own, near.
        let mut to_front = select_unpredictable(is_in_front, back + own, 0);
        let mut to_back = select_unpredictable(is_in_front, 0, front + own);
        let to_own = select_unpredictable(is_in_front, back, front);
        if own <= 1 {
            let place = select_unpredictable(own == 1, (begin + to_own) as usize, nowhere);
            numbers[place] = branch.own_first;
        } else if let Some(list) = branch.list() {
            let to_rest = write_list(&list, signs, begin, numbers);
            (to_front, to_back) = (to_rest, to_rest);
        } else {
            begins[branch.own_first as usize] = begin + to_own;
        }
        begins[branch.front_part as usize] = begin + to_front;
        begins[branch.back_part as usize] = begin + to_back;
        // Where the next branch begins is mostly known here, and not worth a way through memory.
        let stored = begins[next];
        let from_back = select_unpredictable(branch.back_part == NEXT, begin + to_back, stored);
        begin = select_unpredictable(branch.front_part == NEXT, begin + to_front, from_back);
    }
}

fn write_twigs(schedule: &Schedule, signs: &[u32], begins: &[u32], numbers: &mut [u32]) {
    for (twig, &begin) in schedule.twigs.iter().zip(begins) {
        let word = twig.node as usize / 32;
        let words = u64::from(signs[word]) | u64::from(signs[word + 1]) << 32;
        let signs = (words >> (twig.node % 32)) as usize % (1 << NODES);
        let places = schedule.permutations[twig.row as usize][signs] as usize;
        let room = numbers[begin as usize..].first_chunk_mut::<FRAGMENTS>();
        let Some(numbers) = room else { continue };
        // Those that are not there first: they share the place of the first.
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

/// Writes the nodes of a list from the outside in, and gives how many fragments come before what
/// they leave.
fn write_list(list: &List, signs: &[u32], begin: u32, numbers: &mut [u32]) -> u32 {
    let places = &mut numbers[begin as usize..][..(list.nodes + list.rest) as usize];
    let (mut far, mut near) = (0, places.len() - 1);
    for (node, number) in (list.first_node..).zip(list.first..).take(list.nodes as usize) {
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
