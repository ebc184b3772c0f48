//! Orders without what cannot be seen: outside of a region, or from the wrong side.

use std::cmp::Ordering;
use std::ops::Range;

use smallvec::SmallVec;

use super::BspTree;
use super::bounds::normals::Arms;
use super::bounds::{BLOCK, Bounds};
use super::facing::facing;
use super::node_record::Ranges;
use super::order::sides::View;
use crate::exact::Eye;
use crate::frustum::{Flat, Frustum, HalfSpace};
use crate::viewpoint::Viewpoint;

/// What is left out of an order: [`BspTree::culled_back_to_front_into`].
///
/// ```
/// use binspace::glam::DVec3;
/// use binspace::{BspTree, Culling, Frustum, Sides, Viewpoint};
///
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build((0..100).map(|k| square(f64::from(k))))?;
/// // Once.
/// let bounds = tree.bounds()?;
/// // Every frame.
/// let below_ten = Frustum::new([(DVec3::NEG_Z, -10.0)]);
/// let culling = Culling::new(&bounds).with_frustum(below_ten).with_sides(Sides::Front);
/// let mut order = Vec::new();
/// tree.culled_back_to_front_into(Viewpoint::eye([0.5, 0.5, 5.5]), &culling, &mut order);
/// // The eye sees the fronts of those below it.
/// let polygons: Vec<usize> = order.iter().map(|&f| tree.fragment(f).polygon()).collect();
/// assert_eq!(polygons, [0, 1, 2, 3, 4, 5]);
/// # Ok::<(), binspace::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Culling<'b> {
    bounds: &'b Bounds,
    frustum: Frustum,
    sides: Sides,
}

/// From which sides polygons are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sides {
    /// From both.
    #[default]
    Both,
    /// From the front only: back-face culling.
    Front,
    /// From the back only.
    Back,
}

impl<'b> Culling<'b> {
    /// Nothing is left out.
    pub fn new(bounds: &'b Bounds) -> Self {
        Self { bounds, frustum: Frustum::default(), sides: Sides::Both }
    }

    /// Leaves out what is outside of a region: fragments whose boxes
    /// ([`Bounds::of_fragment`]) lie behind one of its planes. At most 32 planes are used. For speed it goes
    /// by boxes: [`Bounds::fragments_in`] is exact.
    ///
    /// Boxes count as larger by one step of the scene's grid and some 10⁻¹⁵ of the largest coordinate:
    /// more than the rounding of the test, and of an eye in the apex of the region.
    #[must_use]
    pub fn with_frustum(self, frustum: Frustum) -> Self {
        Self { frustum, ..self }
    }

    /// Leaves out what shows the other side to the viewpoint, or is seen edge-on. This is exact, as
    /// [`Fragment::facing`](crate::Fragment::facing) is.
    #[must_use]
    pub fn with_sides(self, sides: Sides) -> Self {
        Self { sides, ..self }
    }
}

impl BspTree {
    /// Writes the numbers of the fragments that are not left out, back to front, into a buffer, and
    /// replaces its contents: [`back_to_front_into`](Self::back_to_front_into) without the rest.
    ///
    /// Subtrees outside of the region, and those of which only the wrong side is seen, are left out
    /// as a whole. So the time follows what is left and what surrounds it, not the size of the tree.
    /// Takes O(depth) memory.
    ///
    /// [`Triangles::write_order`](crate::Triangles::write_order) turns the list into indices of
    /// triangles.
    ///
    /// # Panics
    ///
    /// If the bounds are not those of the tree, as far as the numbers of its nodes and fragments tell.
    /// Those of another tree with the same numbers give wrong answers.
    pub fn culled_back_to_front_into(
        &self,
        viewpoint: Viewpoint,
        culling: &Culling<'_>,
        order: &mut Vec<u32>,
    ) {
        order.clear();
        Cull::new(self, viewpoint, culling).write(order);
    }

    /// Writes the numbers of the fragments that are not left out, front to back: the reverse of
    /// [`culled_back_to_front_into`](Self::culled_back_to_front_into).
    ///
    /// # Panics
    ///
    /// If the bounds are not those of the tree, as far as the numbers of its nodes and fragments tell.
    /// Those of another tree with the same numbers give wrong answers.
    pub fn culled_front_to_back_into(
        &self,
        viewpoint: Viewpoint,
        culling: &Culling<'_>,
        order: &mut Vec<u32>,
    ) {
        self.culled_back_to_front_into(viewpoint, culling, order);
        order.reverse();
    }
}

/// What is still to be decided of a subtree or a run of fragments.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Doubts {
    /// A bit for each plane of the region that it may cross.
    planes: u32,
    /// Whether it may show either side.
    sides: bool,
}

/// A subtree, or fragments alone, and what is still to be decided of them.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// [`LEAF`] for fragments alone.
    node: u32,
    first: u32,
    end: u32,
    doubts: Doubts,
}

const LEAF: u32 = u32::MAX;

/// The boxes of subtrees of no more fragments are not looked at, only those of the fragments. Smaller:
/// more boxes are looked at of what is in view; larger: of what is not.
const FEW: u32 = 2;

/// A tree, a viewpoint, and what is left out.
struct Cull<'t> {
    tree: &'t BspTree,
    bounds: &'t Bounds,
    view: View,
    eye: Eye,
    arms: Arms<'t>,
    planes: SmallVec<[HalfSpace; 6]>,
    /// Which side is drawn.
    side: Option<Ordering>,
}

impl<'t> Cull<'t> {
    fn new(tree: &'t BspTree, viewpoint: Viewpoint, culling: &Culling<'t>) -> Self {
        let (bounds, lattice) = (culling.bounds, tree.faces.lattice());
        bounds.expect(tree);
        let eye = Eye::new(viewpoint, lattice);
        let (reach, step) = (bounds.reach(), lattice.length_to_world(1.0));
        let planes = culling.frustum.planes().iter().take(32);
        Self {
            tree,
            bounds,
            view: View::new(tree, viewpoint),
            eye,
            arms: Arms::new(&eye, lattice),
            planes: planes.map(|&plane| HalfSpace::new(plane, reach, step)).collect(),
            side: match culling.sides {
                Sides::Both => None,
                Sides::Front => Some(Ordering::Greater),
                Sides::Back => Some(Ordering::Less),
            },
        }
    }

    fn write(&self, order: &mut Vec<u32>) {
        let planes = u32::MAX.checked_shr(32 - self.planes.len() as u32).unwrap_or(0);
        let doubts = Doubts { planes, sides: self.side.is_some() };
        let node = if self.tree.nodes.is_empty() { LEAF } else { 0 };
        let mut pending = vec![Part { node, first: 0, end: self.tree.len() as u32, doubts }];
        while let Some(part) = pending.pop() {
            self.descend(part, &mut pending, order);
        }
    }

    /// Writes the furthest run of a part, and puts the rest on the stack.
    fn descend(&self, part: Part, pending: &mut Vec<Part>, order: &mut Vec<u32>) {
        let Part { mut node, first, end, mut doubts } = part;
        let mut all = first..end;
        while node != LEAF {
            let index = node as usize;
            if all.end - all.start > FEW {
                let Some(left) = self.left_in(index, doubts) else { return };
                doubts = left;
            }
            let record = &self.tree.nodes[index];
            let Ranges { own, front, back } = record.ranges(all);
            let child = |node: Option<usize>| node.map_or(LEAF, |node| node as u32);
            let front = (child(record.front_node(index)), front);
            let back = (child(record.back_node(index)), back);
            let is_in_front = self.view.is_in_front(self.tree, index);
            let (far, near) = if is_in_front { (back, front) } else { (front, back) };
            // Back to front: the far side, what is on the plane, the near side.
            for (node, run) in [near, (LEAF, own)] {
                if !run.is_empty() {
                    pending.push(Part { node, first: run.start, end: run.end, doubts });
                }
            }
            (node, all) = far;
        }
        self.write_run(all, doubts, order);
    }

    /// What is left to be decided of a subtree; `None` if all of it is left out.
    #[inline]
    fn left_in(&self, node: usize, doubts: Doubts) -> Option<Doubts> {
        let planes = self.crossed(&self.bounds.nodes[node], doubts.planes)?;
        let sides = match self.side {
            Some(side) if doubts.sides => match self.bounds.seen(node, &self.arms) {
                Some(seen) if seen != side => return None,
                seen => seen.is_none(),
            },
            _ => false,
        };
        Some(Doubts { planes, sides })
    }

    /// Which of some planes a box may cross; `None` if it is behind one of them.
    #[inline]
    fn crossed(&self, bounds: &Flat, planes: u32) -> Option<u32> {
        let (mut left, mut crossed) = (planes, planes);
        while left != 0 {
            let bit = left.trailing_zeros();
            // Clears the lowest bit that is set.
            left &= left - 1;
            match self.planes[bit as usize].side(bounds) {
                Ordering::Less => return None,
                Ordering::Equal => {}
                Ordering::Greater => crossed &= !(1 << bit),
            }
        }
        Some(crossed)
    }

    /// Writes those of a run that are not left out: blocks of them at once, where it is long.
    #[inline]
    fn write_run(&self, run: Range<u32>, doubts: Doubts, order: &mut Vec<u32>) {
        if doubts.planes == 0 {
            return self.write_shown(run, doubts, order);
        }
        if run.end - run.start >= BLOCK as u32 {
            return self.write_blocks(run, doubts, order);
        }
        for fragment in run {
            let bounds = &self.bounds.fragments()[fragment as usize];
            if self.crossed(bounds, doubts.planes).is_some() {
                self.write_one(fragment, doubts, order);
            }
        }
    }

    fn write_blocks(&self, mut run: Range<u32>, doubts: Doubts, order: &mut Vec<u32>) {
        while !run.is_empty() {
            let (mut level, mut len) = self.bounds.block(&run);
            loop {
                let bounds = &self.bounds.levels[level][(run.start / len) as usize];
                let next = run.start + len;
                match self.crossed(bounds, doubts.planes) {
                    None => {}
                    Some(planes) if planes == 0 || level == 0 => {
                        self.write_shown(run.start..next, doubts, order);
                    }
                    Some(_) => {
                        (level, len) = (level - 1, len / BLOCK as u32);
                        continue;
                    }
                }
                run.start = next;
                break;
            }
        }
    }

    /// Writes those of a run that show the side that is drawn.
    #[inline]
    fn write_shown(&self, run: Range<u32>, doubts: Doubts, order: &mut Vec<u32>) {
        for fragment in run {
            self.write_one(fragment, doubts, order);
        }
    }

    /// Writes a fragment, if it shows the side that is drawn.
    #[inline]
    fn write_one(&self, fragment: u32, doubts: Doubts, order: &mut Vec<u32>) {
        if let Some(side) = self.side.filter(|_| doubts.sides) {
            let face = self.tree.records[fragment as usize].face;
            if facing(&self.tree.faces, face, &self.eye) != side {
                return;
            }
        }
        order.push(fragment);
    }
}
