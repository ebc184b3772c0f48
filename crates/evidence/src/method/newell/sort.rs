//! The sorted list, the marks, and the cutting of cycles.

use super::super::MethodError;
use super::super::space::CameraSpace;
use super::compare::{is_behind, is_in_front, why_not_hidden};
use super::decisions::Decisions;
use super::options::Newell;
use super::pieces::Pieces;
use super::split::{Halves, by_outline, by_plane};

/// The state of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Waiting,
    /// In the chain.
    Marked,
    /// Painted, or cut up.
    Gone,
}

/// The next piece to paint, unless it hides another piece. It hides no piece of the list from `place` on.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    piece: u32,
    place: usize,
}

pub(super) struct Sorter<'a> {
    method: &'a Newell,
    space: &'a CameraSpace,
    pieces: &'a mut Pieces,
    /// Pieces by their furthest depths, the furthest last; removed pieces may still be there.
    list: Vec<u32>,
    state: Vec<State>,
    /// Candidates, each of which has taken the place of the candidate before it.
    chain: Vec<Candidate>,
    /// The number of removed pieces in the list.
    gone: usize,
    comparisons: u64,
    decisions: Decisions,
}

impl<'a> Sorter<'a> {
    pub(super) fn new(
        method: &'a Newell,
        space: &'a CameraSpace,
        pieces: &'a mut Pieces,
    ) -> Result<Self, MethodError> {
        let mut list: Vec<u32> = (0..pieces.len() as u32).collect();
        let far = |piece: u32| pieces.get(piece).far;
        // If two faces have the same depth, the earlier is painted first, so it is later in the list.
        list.sort_unstable_by(|&a, &b| far(a).total_cmp(&far(b)).then(b.cmp(&a)));
        let state = vec![State::Waiting; list.len()];
        let (chain, gone, comparisons) = (Vec::new(), 0, 0);
        let decisions = Decisions { begun: list.len(), ..Decisions::default() };
        let sorter =
            Self { method, space, pieces, list, state, chain, gone, comparisons, decisions };
        sorter.check_pieces()?;
        Ok(sorter)
    }

    fn check_pieces(&self) -> Result<(), MethodError> {
        let limit = self.method.max_pieces;
        if self.pieces.len() > limit { Err(MethodError::pieces(limit)) } else { Ok(()) }
    }

    /// Returns all pieces, the furthest first, and the counts of the deciding tests.
    pub(super) fn sort(mut self) -> Result<(Vec<u32>, Decisions), MethodError> {
        let mut order = Vec::with_capacity(self.list.len());
        while let Some(candidate) = self.next() {
            let Some(q) = self.hidden_by(candidate)? else {
                order.push(candidate.piece);
                self.drop(candidate.piece);
                self.chain.pop();
                continue;
            };
            let marked = self.state[q as usize] == State::Marked;
            if !marked && self.may_precede(q, candidate.piece) {
                self.mark(q);
                self.decisions.moved += 1;
            } else if let Some((piece, halves)) = self.cut_for(q) {
                self.replace(piece, &halves)?;
                self.decisions.cuts += 1;
            } else {
                // Everything is within the epsilon: the search continues past the pair.
                self.decisions.passed += 1;
            }
        }
        self.decisions.painted = order.len();
        Ok((order, self.decisions))
    }

    /// The next piece: the end of the chain, or the furthest remaining one.
    fn next(&mut self) -> Option<Candidate> {
        if self.chain.is_empty() {
            if 2 * self.gone > self.list.len() {
                let state = &self.state;
                self.list.retain(|&piece| state[piece as usize] != State::Gone);
                self.gone = 0;
            }
            while self.list.last().is_some_and(|&piece| self.state[piece as usize] == State::Gone) {
                self.list.pop();
                self.gone -= 1;
            }
            self.mark(*self.list.last()?);
        }
        self.chain.last().copied()
    }

    fn mark(&mut self, piece: u32) {
        self.state[piece as usize] = State::Marked;
        self.chain.push(Candidate { piece, place: self.list.len() });
    }

    fn drop(&mut self, piece: u32) {
        self.state[piece as usize] = State::Gone;
        self.gone += 1;
    }

    /// The next piece that the candidate, the end of the chain, may hide.
    fn hidden_by(&mut self, candidate: Candidate) -> Result<Option<u32>, MethodError> {
        let (p, near) = (candidate.piece, self.pieces.get(candidate.piece).near);
        let mut found = None;
        let mut place = candidate.place;
        while place > 0 && found.is_none() {
            place -= 1;
            let q = self.list[place];
            if self.pieces.get(q).far <= near {
                break;
            }
            self.comparisons += 1;
            let there = q != p && self.state[q as usize] != State::Gone;
            if there {
                let reason = why_not_hidden(self.pieces, p, q, self.method.epsilon);
                self.decisions.add(reason);
                found = reason.is_none().then_some(q);
            }
        }
        if let Some(last) = self.chain.last_mut() {
            last.place = place;
        }
        let limit = self.method.max_comparisons;
        if self.comparisons > limit { Err(MethodError::comparisons(limit)) } else { Ok(found) }
    }

    /// Whether a plane proves that Q, which P may hide, may be painted before P.
    fn may_precede(&self, q: u32, p: u32) -> bool {
        let epsilon = self.method.epsilon;
        is_behind(self.pieces, q, p, epsilon) || is_in_front(self.pieces, p, q, epsilon)
    }

    /// Cuts a piece so that the end of the chain and `q`, which the end may hide, can be put in order. One of
    /// the two is cut. If `q` is in the chain, one of two neighbours in the cycle that begins at `q` is cut.
    fn cut_for(&self, q: u32) -> Option<(u32, Halves)> {
        let begin = self.chain.iter().position(|candidate| candidate.piece == q);
        let cycle = begin.map_or(&[][..], |begin| &self.chain[begin..]);
        let mut pairs = vec![(self.chain.last()?.piece, q)];
        pairs.extend(cycle.windows(2).map(|pair| (pair[0].piece, pair[1].piece)));
        let (pieces, epsilon, space) = (&*self.pieces, self.method.epsilon, self.space);
        let both = |&(p, q): &(u32, u32)| [(p, q), (q, p)];
        let plane = |(piece, by)| Some((piece, by_plane(pieces, piece, by, epsilon)?));
        let outline = |(piece, by)| Some((piece, by_outline(space, pieces, piece, by)?));
        let cut = pairs.iter().flat_map(both).find_map(plane);
        cut.or_else(|| pairs.iter().flat_map(both).find_map(outline))
    }

    /// Replaces a piece by its two halves, and begins again with the furthest piece.
    fn replace(&mut self, piece: u32, halves: &Halves) -> Result<(), MethodError> {
        for candidate in self.chain.drain(..) {
            self.state[candidate.piece as usize] = State::Waiting;
        }
        self.drop(piece);
        let face = self.pieces.get(piece).face;
        for half in halves {
            let new = self.pieces.add(self.space, face, half, false);
            self.state.push(State::Waiting);
            let far = self.pieces.get(new).far;
            let place = self.list.partition_point(|&other| self.pieces.get(other).far < far);
            self.list.insert(place, new);
        }
        self.check_pieces()
    }
}
