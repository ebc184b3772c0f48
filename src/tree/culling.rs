//! Orders without fragments that are outside a region or seen from the wrong side.

use std::cmp::Ordering;
use std::ops::Range;

use smallvec::SmallVec;

use super::bounds::{Arms, BLOCK, Bounds, Flat, HalfSpace};
use super::node::Ranges;
use super::order::eye::View;
use super::order::write_from_nodes;
use super::{BspTree, Node};
use crate::bits::bits;
use crate::exact::{Plane, PlaneId};
use crate::viewpoint::{Facing, Frustum, Viewpoint};

/// The [fragments](crate::Fragment) that an order leaves out: [`Order::culled`](crate::Order::culled).
///
/// ```
/// use binspace::glam::DVec3;
/// use binspace::{BspTree, Culling, Facing, Frustum, Viewpoint};
///
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build((0..100).map(|k| square(f64::from(k))))?;
/// let below_ten = Frustum::new([(DVec3::NEG_Z, -10.0)]);
/// let culling = Culling::NONE.with_frustum(below_ten).with_facing(Facing::Front);
/// let order = tree.order(Viewpoint::eye([0.5, 0.5, 5.5])).culled(&culling);
/// // The eye sees the fronts of the squares below it.
/// assert!(order.into_iter().map(|fragment| fragment.polygon()).eq([0, 1, 2, 3, 4, 5]));
/// # Ok::<(), binspace::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Culling {
    pub(crate) frustum: Frustum,
    /// The side that is drawn; `None` for both sides.
    pub(crate) facing: Option<Facing>,
}

impl Culling {
    /// The culling that leaves out nothing.
    pub const NONE: Self = Self { frustum: Frustum::EVERYWHERE, facing: None };

    /// Leaves out each fragment whose bounding box lies behind a plane of a frustum. Only the frustum's first
    /// 32 planes are used. The test is fast, but keeps some fragments outside the frustum;
    /// [`BspTree::fragments_in`] is exact, but slower.
    ///
    /// The test enlarges each box by about 10⁻⁶ of the scene's extent (the longest side of the scene's
    /// bounding box) plus 10⁻¹⁵ of the largest coordinate. This margin is larger than the rounding error of
    /// the test. If the frustum's planes meet in the eye, the margin is also larger than the rounding error
    /// of the eye.
    #[must_use]
    pub fn with_frustum(self, frustum: Frustum) -> Self {
        Self { frustum, ..self }
    }

    /// Keeps only the fragments whose [`facing`](crate::Fragment::facing) is `facing`: with
    /// [`Facing::Front`], this is back-face culling. The test is exact.
    #[must_use]
    pub fn with_facing(self, facing: Facing) -> Self {
        Self { facing: Some(facing), ..self }
    }
}

/// Subtrees of at most this many fragments are ordered as a whole before fragments are left out. The number
/// must not be larger than a block. Too small: the walk visits more nodes, each with branches that no
/// processor can predict. Too large: more fragments are ordered and then discarded.
const FEW: usize = BLOCK;

/// Fully marked subtrees of at most this many fragments are ordered at once. Too small: the walk visits
/// more nodes. Too large: more marks are read again at each level of the tree.
const LONG: usize = 64 * BLOCK;

/// A subtree, or fragments without nodes.
#[derive(Clone, Debug)]
pub(crate) struct Subtree {
    /// The numbers of the subtree's nodes; empty for fragments without nodes.
    pub(crate) nodes: Range<u32>,
    pub(crate) fragments: Range<u32>,
}

/// A subtree that is still to be written.
#[derive(Clone, Debug)]
pub(crate) struct Listed {
    subtree: Subtree,
    /// Whether the fragments of the subtree may show different sides.
    is_mixed: bool,
}

/// A tree, a viewpoint, and the fragments to leave out.
pub(crate) struct Cull<'t> {
    tree: &'t BspTree,
    bounds: &'t Bounds,
    pub(crate) view: View,
    arms: Arms,
    planes: SmallVec<[HalfSpace; 6]>,
    marks: Marks,
    /// The side that is drawn.
    side: Option<Ordering>,
}

impl<'t> Cull<'t> {
    pub(crate) fn new(tree: &'t BspTree, viewpoint: Viewpoint, culling: &Culling) -> Self {
        let (bounds, lattice) = (tree.boxes(), tree.faces.lattice());
        let view = View::new(tree, viewpoint);
        let planes = culling.frustum.planes().iter().take(PLANES);
        let planes: SmallVec<[HalfSpace; 6]> =
            planes.map(|&plane| HalfSpace::new(plane, lattice)).collect();
        Self {
            tree,
            bounds,
            arms: Arms::new(view.eye()),
            view,
            marks: Marks::new(bounds, &planes),
            planes,
            side: culling.facing.map(Ordering::from),
        }
    }

    /// Whether a subtree may have a fragment that is drawn.
    pub(super) fn shows_some(&self, node: &Node<'_>) -> bool {
        let seen = self.side.zip(self.bounds.seen(node.index(), &self.arms));
        self.marks.any(&node.fragments()) && seen.is_none_or(|(side, seen)| seen == side)
    }

    /// Whether a box reaches into the frustum.
    pub(crate) fn shows_box(&self, bounds: &Flat) -> bool {
        !self.planes.iter().any(|plane| plane.is_behind(bounds))
    }

    /// Whether a plane shows the drawn side.
    pub(crate) fn shows_plane(&self, plane: impl FnOnce() -> Plane) -> bool {
        self.side.is_none_or(|side| plane().facing(self.view.eye()) == side)
    }

    /// Whether a fragment is drawn.
    pub(crate) fn shows(&self, fragment: u32) -> bool {
        let run = fragment..fragment + 1;
        let mut shown = self.marks.of_few(&run);
        if shown != 0 && self.side.is_some() {
            shown = self.show_side(run, shown);
        }
        shown != 0
    }

    pub(super) fn write(&self, order: &mut Vec<u32>) {
        self.write_subtree(self.whole(), &mut vec![], order);
    }

    /// The numbers of all nodes and all fragments.
    pub(crate) fn whole(&self) -> Subtree {
        Subtree { nodes: 0..self.tree.nodes.len() as u32, fragments: 0..self.tree.len() as u32 }
    }

    /// Appends the drawn fragments of a subtree to an order. `pending` is working space, empty before and
    /// after.
    pub(crate) fn write_subtree(
        &self,
        subtree: Subtree,
        pending: &mut Vec<Listed>,
        order: &mut Vec<u32>,
    ) {
        pending.push(Listed { subtree, is_mixed: self.side.is_some() });
        while let Some(part) = pending.pop() {
            self.descend(part, pending, order);
        }
    }

    /// The three parts of a subtree, divided by the plane of its first node: front, fragments on the plane,
    /// back.
    pub(crate) fn divide(&self, subtree: &Subtree) -> [Subtree; 3] {
        let Subtree { nodes, fragments } = subtree.clone();
        let record = &self.tree.nodes[nodes.start as usize];
        let Ranges { own, front, back } = record.ranges(fragments);
        let middle = nodes.start + 1 + record.front_nodes;
        let of = |nodes, fragments| Subtree { nodes, fragments };
        [of(nodes.start + 1..middle, front), of(0..0, own), of(middle..nodes.end, back)]
    }

    /// Writes the furthest fragments of a part, and pushes the other parts onto the stack.
    fn descend(&self, part: Listed, pending: &mut Vec<Listed>, order: &mut Vec<u32>) {
        let Listed { mut subtree, mut is_mixed } = part;
        while self.marks.any(&subtree.fragments) {
            let Subtree { nodes, fragments } = &subtree;
            if nodes.is_empty() {
                return self.write_run(fragments, is_mixed, order);
            }
            let len = fragments.len();
            if len <= LONG && !is_mixed && self.marks.all(fragments) {
                return write_from_nodes(
                    self.tree,
                    &self.view,
                    subtree.nodes,
                    subtree.fragments,
                    order,
                );
            }
            if len <= FEW {
                return self.write_few(subtree, is_mixed, order);
            }
            let node = nodes.start as usize;
            if let Some(side) = self.side.filter(|_| is_mixed) {
                let seen = self.bounds.seen(node, &self.arms);
                if seen.is_some_and(|seen| seen != side) {
                    return;
                }
                is_mixed = seen.is_none();
            }
            let [front, own, back] = self.divide(&subtree);
            let is_in_front = self.view.is_in_front(self.tree, node);
            let (far, near) = if is_in_front { (back, front) } else { (front, back) };
            // Back to front: the far side, the fragments on the plane, the near side.
            for subtree in [near, own] {
                if !subtree.fragments.is_empty() {
                    pending.push(Listed { subtree, is_mixed });
                }
            }
            subtree = far;
        }
    }

    /// Writes the drawn fragments of a small subtree.
    fn write_few(&self, subtree: Subtree, is_mixed: bool, order: &mut Vec<u32>) {
        let Subtree { nodes, fragments } = subtree;
        let mut shown = self.marks.of_few(&fragments);
        if is_mixed {
            shown = self.show_side(fragments.clone(), shown);
        }
        if shown == 0 {
            return;
        }
        let (first, begin) = (fragments.start, order.len());
        write_from_nodes(self.tree, &self.view, nodes, fragments, order);
        // No branch on the mask.
        let mut end = begin;
        for k in begin..order.len() {
            let fragment = order[k];
            order[end] = fragment;
            end += (shown >> (fragment - first) & 1) as usize;
        }
        order.truncate(end);
    }

    /// Writes the drawn fragments of a range without nodes.
    fn write_run(&self, fragments: &Range<u32>, is_mixed: bool, order: &mut Vec<u32>) {
        for (first, mut shown) in self.marks.words(fragments) {
            if is_mixed {
                let end = fragments.end.min(first + BLOCK as u32);
                shown = self.show_side(first..end, shown);
            }
            if shown == ALL {
                order
                    .extend_from_slice(&std::array::from_fn::<u32, BLOCK, _>(|k| first + k as u32));
                continue;
            }
            order.extend(bits(shown.into()).map(|bit| first + bit as u32));
        }
    }

    /// Clears the bits of fragments that do not show the drawn side. Bit 0 stands for the first fragment of
    /// `run`, which has at most 16.
    fn show_side(&self, run: Range<u32>, fragments: u32) -> u32 {
        let [fronts, backs] = self.view.sure_sides(&self.bounds.planes, run.clone());
        let Some(side) = self.side else { return fragments };
        let sure = match side {
            Ordering::Greater => fronts,
            Ordering::Less => backs,
            Ordering::Equal => 0,
        };
        let mut shown = fragments & sure;
        for bit in bits((fragments & !(fronts | backs)).into()) {
            let face = self.tree.records[run.start as usize + bit].face;
            let facing = self.tree.faces.plane(PlaneId::face(face)).facing(self.view.eye());
            shown |= u32::from(facing == side) << bit;
        }
        shown
    }
}

/// The largest number of planes of a region that are used.
const PLANES: usize = 32;

/// The largest number of levels of boxes: a tree has fewer than 16⁸ fragments.
const LEVELS: usize = 8;

/// The bits of a fully marked block.
const ALL: u32 = (1 << BLOCK) - 1;

/// A bit for each fragment and each block in [`Bounds`], in the same layout. A fragment or block is *marked*
/// (the bit is set) if its box reaches into a region.
struct Marks {
    /// For each level, a word for each block, and one more word to read past the end.
    words: Vec<u16>,
    /// The start of each level's words.
    levels: [usize; LEVELS],
}

/// A block of boxes that may lie partly outside a region.
#[derive(Clone, Copy, Debug)]
struct Doubt {
    level: usize,
    block: usize,
    /// A bit for each plane of the region that the block may cross.
    planes: u32,
}

impl Marks {
    fn new(bounds: &Bounds, planes: &[HalfSpace]) -> Self {
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
            marks.look(bounds, planes, doubt, &mut pending);
        }
        marks
    }

    /// Tests the boxes of a block against planes.
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

    /// Marks a whole block.
    fn mark(&mut self, bounds: &Bounds, Doubt { level, block, .. }: Doubt) {
        let mut blocks = block..block + 1;
        for level in (0..=level).rev() {
            blocks.end = blocks.end.min(bounds.levels[level].len());
            let begin = self.levels[level];
            self.words[begin + blocks.start..begin + blocks.end].fill(ALL as u16);
            blocks = blocks.start * BLOCK..blocks.end * BLOCK;
        }
    }

    /// Whether a fragment of a range may be marked. The result is exact for up to 16 fragments; for more,
    /// whole blocks are tested.
    #[inline]
    fn any(&self, fragments: &Range<u32>) -> bool {
        if fragments.is_empty() {
            return false;
        }
        let (mut first, mut last) = (fragments.start, fragments.end - 1);
        // At most 17 boxes of this level contain them.
        let level = ((last - first) | 1).ilog2() / BLOCK.ilog2();
        (first, last) = (first >> (level * BLOCK.ilog2()), last >> (level * BLOCK.ilog2()));
        let len = last - first + 1;
        self.window(level as usize, first) & ((1 << len) - 1) != 0
    }

    /// Whether all fragments of a range are marked.
    fn all(&self, fragments: &Range<u32>) -> bool {
        fragments.clone().step_by(BLOCK).all(|first| {
            let len = (fragments.end - first).min(BLOCK as u32);
            let all = (1 << len) - 1;
            self.window(0, first) & all == all
        })
    }

    /// A bit for each of at most 16 fragments, set if the fragment is marked.
    #[inline]
    fn of_few(&self, fragments: &Range<u32>) -> u32 {
        self.window(0, fragments.start) & ((1 << fragments.len()) - 1)
    }

    /// The marked fragments, block by block: the number of the block's first fragment, and a bit for each
    /// fragment.
    fn words(&self, fragments: &Range<u32>) -> impl Iterator<Item = (u32, u32)> + use<'_> {
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

    /// At least 17 bits of a level; the first is the bit of box `first`.
    #[inline]
    fn window(&self, level: usize, first: u32) -> u32 {
        let word = self.levels[level % LEVELS] + first as usize / BLOCK;
        let words = self.words.get(word..word + 2);
        let [low, high] = words.map_or([0; 2], |words| [words[0], words[1]].map(u32::from));
        (low | high << BLOCK) >> (first as usize % BLOCK)
    }
}
