//! Which fragments have boxes that reach into a region.

use std::ops::Range;

use smallvec::SmallVec;

use crate::bits::bits;
use crate::exact::Lattice;
use crate::frustum::Frustum;
use crate::tree::bounds::Bounds;
use crate::tree::bounds::boxes::BLOCK;
use crate::tree::bounds::half_space::HalfSpace;

/// The most planes of a region that are used.
const PLANES: usize = 32;

/// The most levels of boxes: a tree has fewer than 16⁸ fragments.
const LEVELS: usize = 8;

/// The bits of a block that is marked as a whole.
pub(super) const ALL: u32 = (1 << BLOCK) - 1;

/// A bit for each fragment whose box reaches into a region, and for each block of fragments and of blocks
/// with such a one, as [`Bounds`] has them.
pub(super) struct Marks {
    /// For each level, a word for each block, and one more to read past the end.
    words: Vec<u16>,
    /// Where the words of each level begin.
    levels: [usize; LEVELS],
}

/// A block of boxes that a region may not hold as a whole.
#[derive(Clone, Copy, Debug)]
struct Doubt {
    level: usize,
    block: usize,
    /// A bit for each plane of the region that the block may cross.
    planes: u32,
}

impl Marks {
    pub(super) fn new(bounds: &Bounds, region: &Frustum, lattice: &Lattice) -> Self {
        let planes = region.planes().iter().take(PLANES);
        let planes: SmallVec<[HalfSpace; 6]> =
            planes.map(|&plane| HalfSpace::new(plane, lattice)).collect();
        let (mut levels, mut words) = ([0; LEVELS], 0);
        for (begin, blocks) in levels.iter_mut().zip(&bounds.levels) {
            *begin = words;
            words += blocks.len() + 1;
        }
        let mut marks = Self { words: vec![0; words], levels };
        let all = u32::MAX.checked_shr((PLANES - planes.len()) as u32).unwrap_or(0);
        let (top, mut pending) = (bounds.levels.len() - 1, Vec::new());
        if !bounds.levels[top].is_empty() {
            pending.push(Doubt { level: top, block: 0, planes: all });
        }
        while let Some(doubt) = pending.pop() {
            marks.look(bounds, &planes, doubt, &mut pending);
        }
        marks
    }

    /// Compares the boxes of a block with planes.
    fn look(&mut self, bounds: &Bounds, all: &[HalfSpace], doubt: Doubt, pending: &mut Vec<Doubt>) {
        let Doubt { level, block, planes } = doubt;
        let boxes = &bounds.levels[level][block];
        let mut met = ALL;
        // For each plane, the boxes that it may cross.
        let mut crossed = [0; PLANES];
        for plane in bits(planes.into()) {
            met &= all[plane].meets(boxes);
            if level > 0 {
                crossed[plane] = !all[plane].holds(boxes);
            }
        }
        let (first, len) = (block * BLOCK, bounds.len_of(level));
        if first + BLOCK > len {
            met &= (1 << (len - first)) - 1;
        }
        self.words[self.levels[level] + block] = met as u16;
        if level == 0 {
            return;
        }
        for k in bits(met.into()) {
            let planes = bits(planes.into())
                .fold(0, |left, plane| left | (crossed[plane] >> k & 1) << plane);
            let doubt = Doubt { level: level - 1, block: first + k, planes };
            if planes == 0 { self.mark(bounds, doubt) } else { pending.push(doubt) }
        }
    }

    /// Marks all of a block.
    fn mark(&mut self, bounds: &Bounds, Doubt { level, block, .. }: Doubt) {
        let mut blocks = block..block + 1;
        for level in (0..=level).rev() {
            blocks.end = blocks.end.min(bounds.levels[level].len());
            let begin = self.levels[level];
            self.words[begin + blocks.start..begin + blocks.end].fill(ALL as u16);
            blocks = blocks.start * BLOCK..blocks.end * BLOCK;
        }
    }

    /// Whether some of these are marked. It may say so of 256 and more of which none is, as it looks at
    /// blocks.
    #[inline]
    pub(super) fn any(&self, fragments: &Range<u32>) -> bool {
        if fragments.is_empty() {
            return false;
        }
        let (mut first, mut last) = (fragments.start, fragments.end - 1);
        // At most 17 boxes of this level hold them.
        let level = ((last - first) | 1).ilog2() / BLOCK.ilog2();
        (first, last) = (first >> (level * BLOCK.ilog2()), last >> (level * BLOCK.ilog2()));
        let len = last - first + 1;
        self.window(level as usize, first) & ((1 << len) - 1) != 0
    }

    /// Whether all are marked.
    pub(super) fn all(&self, fragments: &Range<u32>) -> bool {
        fragments.clone().step_by(BLOCK).all(|first| {
            let len = (fragments.end - first).min(BLOCK as u32);
            let all = (1 << len) - 1;
            self.window(0, first) & all == all
        })
    }

    /// A bit for each of at most 16 fragments that is marked.
    #[inline]
    pub(super) fn of_few(&self, fragments: &Range<u32>) -> u32 {
        self.window(0, fragments.start) & ((1 << fragments.len()) - 1)
    }

    /// The marked fragments by the block: the number of its first, and a bit for each.
    pub(super) fn words(
        &self,
        fragments: &Range<u32>,
    ) -> impl Iterator<Item = (u32, u32)> + use<'_> {
        let Range { start, end } = *fragments;
        let step = BLOCK as u32;
        (start / step..end.div_ceil(step)).filter_map(move |block| {
            let first = block * step;
            let before = start.saturating_sub(first);
            let len = (end - first).min(step);
            let word = u32::from(self.words[block as usize]) >> before << before & ((1 << len) - 1);
            (word != 0).then_some((first, word))
        })
    }

    /// At least 17 bits of a level, from some number on.
    #[inline]
    fn window(&self, level: usize, first: u32) -> u32 {
        let word = self.levels[level % LEVELS] + first as usize / BLOCK;
        let words = self.words.get(word..word + 2);
        let [low, high] = words.map_or([0; 2], |words| [words[0], words[1]].map(u32::from));
        (low | high << BLOCK) >> (first as usize % BLOCK)
    }
}
