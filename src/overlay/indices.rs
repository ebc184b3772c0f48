//! One order as a list of numbers, in linear passes.

use std::hint::select_unpredictable;

use super::Overlay;
use super::skeleton::{Branch, Group};
use crate::error::Error;
use crate::memory::reserve;
use crate::tree::BspTree;
use crate::tree::order::eye_sides::View;
use crate::viewpoint::Viewpoint;

/// How many places of an order are in a word of marks.
const WORD: usize = u32::BITS as usize;

impl Overlay {
    /// Writes the numbers of all fragments and pieces, back to front, into a buffer, and replaces its
    /// contents. Numbers below the tree's [`len`](BspTree::len) are those of its fragments, the others
    /// those of [pieces](Self::piece).
    ///
    /// It takes the time of [`BspTree::back_to_front_into`], of a copy of the list, and of a look at
    /// each plane on the way to the pieces. An empty overlay adds nothing. The buffer is working space
    /// as well; once it has grown to its size, nothing is allocated.
    ///
    /// # Errors
    ///
    /// If the tree is neither the one that the overlay was made for nor a clone of it, or if memory runs
    /// out.
    pub fn back_to_front_into(
        &self,
        tree: &BspTree,
        viewpoint: Viewpoint,
        order: &mut Vec<u32>,
    ) -> Result<(), Error> {
        self.expect(tree)?;
        tree.back_to_front_into(viewpoint, order);
        if !self.is_empty() {
            self.insert(&View::new(tree, viewpoint), order)?;
        }
        Ok(())
    }

    /// Writes the numbers of all fragments and pieces, front to back: the reverse of
    /// [`back_to_front_into`](Self::back_to_front_into).
    ///
    /// # Errors
    ///
    /// If the tree is neither the one that the overlay was made for nor a clone of it, or if memory runs
    /// out.
    pub fn front_to_back_into(
        &self,
        tree: &BspTree,
        viewpoint: Viewpoint,
        order: &mut Vec<u32>,
    ) -> Result<(), Error> {
        self.back_to_front_into(tree, viewpoint, order)?;
        order.reverse();
        Ok(())
    }

    /// Inserts the pieces into the tree's order.
    ///
    /// Every side of the skeleton knows how many fragments and pieces it has, so where a side begins
    /// is known before it is read, as in the tree's own order.
    fn insert(&self, view: &View, order: &mut Vec<u32>) -> Result<(), Error> {
        let (fragments, pieces) = (order.len(), self.len());
        let all = fragments + pieces;
        let (slots, words) = (self.skeleton.slots(), all.div_ceil(WORD));
        // One buffer for all: the caller's, so that a frame allocates nothing.
        let room = all + slots + 2 * words + 2 * pieces;
        reserve(order, room - fragments)?;
        order.resize(room, 0);
        let (order_itself, rest) = order.split_at_mut(all);
        let (begins, rest) = rest.split_at_mut(slots);
        let (marks, rest) = rest.split_at_mut(words);
        let (before, rest) = rest.split_at_mut(words);
        let (places, numbers) = rest.split_at_mut(pieces);
        self.write_begins(view, begins);
        let groups = &begins[self.skeleton.branches.len()..];
        self.sort(groups, (marks, before), (places, numbers), fragments as u32);
        spread(order_itself, fragments, places, numbers);
        order.truncate(all);
        Ok(())
    }

    /// Writes where each slot begins in the order of both parts.
    ///
    /// The loop has no branch on the eye's side, which no processor can predict.
    fn write_begins(&self, view: &View, begins: &mut [u32]) {
        begins[self.skeleton.root().slot as usize] = 0;
        for (i, branch) in self.skeleton.branches.iter().enumerate() {
            let &Branch { plane, rounded, own, pieces, front, back } = branch;
            let is_in_front = view.is_in_front_of(&self.faces, plane, rounded);
            let begin = begins[i];
            let on_plane = own + pieces.len;
            // The order is: far side, own, near side. The far side is the back if the eye is in front.
            let to_front = select_unpredictable(is_in_front, back.len + on_plane, 0);
            let to_back = select_unpredictable(is_in_front, 0, front.len + on_plane);
            let to_pieces = own + select_unpredictable(is_in_front, back.len, front.len);
            begins[front.slot as usize] = begin + to_front;
            begins[back.slot as usize] = begin + to_back;
            begins[pieces.slot as usize] = begin + to_pieces;
        }
    }

    /// Writes the places of all pieces in ascending order, and their numbers, by marks on the places
    /// and how many are marked before each word.
    fn sort(
        &self,
        begins: &[u32],
        (marks, before): (&mut [u32], &mut [u32]),
        (places, numbers): (&mut [u32], &mut [u32]),
        first_number: u32,
    ) {
        let pieces = || {
            let groups = self.skeleton.groups.iter().zip(begins);
            groups.flat_map(|(&Group { first, len }, &begin)| (begin..begin + len).zip(first..))
        };
        for (place, _) in pieces() {
            marks[place as usize / WORD] |= 1 << (place as usize % WORD);
        }
        let mut count = 0;
        for (before, mark) in before.iter_mut().zip(&*marks) {
            *before = count;
            count += mark.count_ones();
        }
        for (place, piece) in pieces() {
            let word = place as usize / WORD;
            let lower = marks[word] & !(u32::MAX << (place as usize % WORD));
            let rank = (before[word] + lower.count_ones()) as usize;
            (places[rank], numbers[rank]) = (place, first_number + piece);
        }
    }
}

/// Inserts numbers into a list at ascending places, from its end on, so that each of the others moves
/// to its final place at once.
fn spread(order: &mut [u32], others: usize, places: &[u32], numbers: &[u32]) {
    let mut end = others;
    for (rank, (&place, &number)) in places.iter().zip(numbers).enumerate().rev() {
        let (place, start) = (place as usize, place as usize - rank);
        order.copy_within(start..end, place + 1);
        order[place] = number;
        end = start;
    }
}
