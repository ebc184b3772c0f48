//! Orders without what cannot be seen: outside of a region, or from the wrong side.

mod marks;

use std::cmp::Ordering;
use std::ops::Range;

use super::BspTree;
use super::bounds::Bounds;
use super::bounds::boxes::BLOCK;
use super::bounds::normals::Arms;
use super::node_record::Ranges;
use super::order::eye_sides::View;
use super::order::indices::write_from_nodes;
use crate::bits::bits;
use crate::exact::{Eye, PlaneId};
use crate::frustum::Frustum;
use crate::viewpoint::Viewpoint;
use marks::Marks;

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
    /// Boxes count as larger by some 10⁻⁶ of the scene's extent and 10⁻¹⁵ of the largest coordinate:
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
    /// Takes O(depth) memory, and a bit for each fragment and each block of 16.
    ///
    /// [`Triangles::write_order`](crate::mesh::Triangles::write_order) turns the list into indices of
    /// triangles.
    ///
    /// # Panics
    ///
    /// If the bounds are those of another tree.
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
    /// If the bounds are those of another tree.
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

/// Subtrees of no more fragments are put in order as a whole, before what is left out is taken off. Smaller:
/// more stops of the walk, each with branches that no processor can predict; larger: more is put in order in
/// vain. At most a block.
const FEW: usize = BLOCK;

/// Subtrees of no more fragments are put in order in one go if all are marked. Smaller: more stops of the
/// walk; larger: more marks are read again at each level of the tree.
const LONG: usize = 64 * BLOCK;

/// A subtree, or fragments alone.
#[derive(Clone, Debug)]
struct Listed {
    /// None for fragments alone.
    nodes: Range<u32>,
    fragments: Range<u32>,
    /// Whether they may show either side.
    is_mixed: bool,
}

/// A tree, a viewpoint, and what is left out.
struct Cull<'t> {
    tree: &'t BspTree,
    bounds: &'t Bounds,
    view: View,
    eye: Eye,
    arms: Arms,
    marks: Marks,
    /// Which side is drawn.
    side: Option<Ordering>,
}

impl<'t> Cull<'t> {
    fn new(tree: &'t BspTree, viewpoint: Viewpoint, culling: &Culling<'t>) -> Self {
        let (bounds, lattice) = (culling.bounds, tree.faces.lattice());
        bounds.expect(tree);
        let eye = Eye::new(viewpoint, lattice);
        Self {
            tree,
            bounds,
            view: View::new(tree, viewpoint),
            eye,
            arms: Arms::new(&eye),
            marks: Marks::new(bounds, &culling.frustum, lattice),
            side: match culling.sides {
                Sides::Both => None,
                Sides::Front => Some(Ordering::Greater),
                Sides::Back => Some(Ordering::Less),
            },
        }
    }

    fn write(&self, order: &mut Vec<u32>) {
        let nodes = 0..self.tree.nodes.len() as u32;
        let fragments = 0..self.tree.len() as u32;
        let mut pending = vec![Listed { nodes, fragments, is_mixed: self.side.is_some() }];
        while let Some(part) = pending.pop() {
            self.descend(part, &mut pending, order);
        }
    }

    /// Writes the furthest fragments of a part, and puts the rest on the stack.
    fn descend(&self, mut part: Listed, pending: &mut Vec<Listed>, order: &mut Vec<u32>) {
        while self.marks.any(&part.fragments) {
            if part.nodes.is_empty() {
                return self.write_run(&part, order);
            }
            let len = part.fragments.len();
            if len <= LONG && !part.is_mixed && self.marks.all(&part.fragments) {
                return write_from_nodes(self.tree, &self.view, part.nodes, part.fragments, order);
            }
            if len <= FEW {
                return self.write_few(part, order);
            }
            let node = part.nodes.start as usize;
            if let Some(side) = self.side.filter(|_| part.is_mixed) {
                let seen = self.bounds.seen(node, &self.arms);
                if seen.is_some_and(|seen| seen != side) {
                    return;
                }
                part.is_mixed = seen.is_none();
            }
            let record = &self.tree.nodes[node];
            let Ranges { own, front, back } = record.ranges(part.fragments);
            let middle = part.nodes.start + 1 + record.front_nodes;
            let of = |nodes, fragments| Listed { nodes, fragments, is_mixed: part.is_mixed };
            let front = of(part.nodes.start + 1..middle, front);
            let back = of(middle..part.nodes.end, back);
            let is_in_front = self.view.is_in_front(self.tree, node);
            let (far, near) = if is_in_front { (back, front) } else { (front, back) };
            // Back to front: the far side, what is on the plane, the near side.
            for part in [near, of(0..0, own)] {
                if !part.fragments.is_empty() {
                    pending.push(part);
                }
            }
            part = far;
        }
    }

    /// Writes those of a small subtree that are not left out.
    fn write_few(&self, part: Listed, order: &mut Vec<u32>) {
        let mut shown = self.marks.of_few(&part.fragments);
        if part.is_mixed {
            shown = self.show_side(part.fragments.clone(), shown);
        }
        if shown == 0 {
            return;
        }
        let (first, begin) = (part.fragments.start, order.len());
        write_from_nodes(self.tree, &self.view, part.nodes, part.fragments, order);
        // Without a branch on what is shown.
        let mut end = begin;
        for k in begin..order.len() {
            let fragment = order[k];
            order[end] = fragment;
            end += (shown >> (fragment - first) & 1) as usize;
        }
        order.truncate(end);
    }

    /// Writes those of some fragments alone that are not left out.
    fn write_run(&self, part: &Listed, order: &mut Vec<u32>) {
        for (first, mut shown) in self.marks.words(&part.fragments) {
            if part.is_mixed {
                let end = part.fragments.end.min(first + BLOCK as u32);
                shown = self.show_side(first..end, shown);
            }
            if shown == marks::ALL {
                order
                    .extend_from_slice(&std::array::from_fn::<u32, BLOCK, _>(|k| first + k as u32));
                continue;
            }
            order.extend(bits(shown.into()).map(|bit| first + bit as u32));
        }
    }

    /// Of up to 16 fragments from some number on, those that have a bit and show the side that is drawn.
    fn show_side(&self, run: Range<u32>, fragments: u32) -> u32 {
        let [fronts, backs] = self.view.sure_sides(&self.bounds.planes, run.clone());
        let Some(side) = self.side else { return fragments };
        let mut shown = fragments & if side.is_gt() { fronts } else { backs };
        for bit in bits((fragments & !(fronts | backs)).into()) {
            let face = self.tree.records[run.start as usize + bit].face;
            let facing = self.tree.faces.plane(PlaneId::face(face)).facing(&self.eye);
            shown |= u32::from(facing == side) << bit;
        }
        shown
    }
}
