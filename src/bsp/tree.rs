//! The tree.

use std::fmt;

use super::assemble::{Output, Record};
use super::node::{Node, finish};
use super::planes::Planes;
use super::schedule::Schedule;
use super::{BuildOptions, Fragment};
use crate::Error;
use crate::geom::{Exact, Faces, Kernel, Polygon, Preparation};

/// A binary space partition of polygons: from it, an exact back-to-front or front-to-back order
/// for any viewpoint.
///
/// # Use
///
/// ```
/// use binspace::{BspTree, Viewpoint};
///
/// // Three squares one behind the other, 0 being the furthest up.
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build([square(2.0), square(0.0), square(1.0)])?;
///
/// let from_above = Viewpoint::eye([0.5, 0.5, 10.0]);
/// let order: Vec<usize> = tree.back_to_front(from_above).map(|f| f.polygon()).collect();
/// assert_eq!(order, [1, 2, 0]);
///
/// // The same as indices of fragments, into a buffer that is used again every frame.
/// let mut order = Vec::new();
/// tree.back_to_front_into(Viewpoint::direction([0.0, 0.0, 1.0]), &mut order);
/// assert_eq!(order.iter().map(|&i| tree.fragment(i).polygon()).collect::<Vec<_>>(), [0, 2, 1]);
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # What it holds
///
/// Every polygon with area is in the tree, as one or more *fragments*: convex pieces that lie in
/// front of, behind or on every partition plane above them. A fragment names the polygon it is of
/// by that polygon's index in the input, and tells its vertices, which of its edges are edges of
/// the polygon, and the weights of each vertex over the polygon's corners, to interpolate texture
/// coordinates or colours of yours. Polygons without area are dropped; polygons that are not
/// convex, or not planar within the tolerance, are triangulated first.
///
/// # Order
///
/// In back-to-front order no fragment hides one that comes after it. Coplanar polygons come in
/// input order, from whichever side they are seen, so of two decals the later one is painted
/// over the earlier. Front-to-back is exactly the reverse. An eye on a plane may count as on
/// either side of it.
///
/// | | time for n fragments | memory |
/// |---|---|---|
/// | [`back_to_front_into`](Self::back_to_front_into) | O(n), a linear pass | the caller's buffer |
/// | [`back_to_front`](Self::back_to_front) | O(n), or as far as it is read | O(depth) |
/// | [`visit_front_to_back`](Self::visit_front_to_back) | O(n), or as far as it goes on | O(depth) |
///
/// # Exactness
///
/// Corners are rounded once, to a grid of 2⁻⁵² of the scene's extent; after that every decision
/// is that of exact arithmetic, however often a polygon is cut (see [`Exact`]). The order is
/// right up to the coplanar tolerance, a length in
/// [`BuildOptions::tolerance`](crate::BuildOptions::tolerance): where polygons reach across a
/// partition plane by less than that, those parts of them may be painted in either order. That
/// shows where they are within the tolerance of each other, and to an eye (or along a ray) that
/// itself keeps within the tolerance of such a plane; [`verify`](crate::verify) tells such pixels
/// apart from wrong ones, of which there are none. With a tolerance of 0 the order is right
/// without qualification. Vertices are handed out rounded to `f64`, the same for neighbours.
///
/// # Building
///
/// Takes about n log n time, but n² where planes that cut nothing take only few polygons off the
/// rest, as in shells about shells, or where many share a corner of a convex body, as the sides of a
/// cone. No recursion: a chain of a million polygons needs no more stack than one. Same input and
/// options give the same tree, bit for bit, with any number of threads. It is a logic error to take
/// fragment numbers of one tree to another.
#[derive(Clone)]
pub struct BspTree<K: Kernel = Exact> {
    pub(super) kernel: K,
    pub(super) faces: Faces,
    pub(super) preparation: Preparation,
    pub(super) nodes: Vec<Node>,
    pub(super) planes: Planes,
    pub(super) schedule: Schedule,
    pub(super) records: Vec<Record>,
    pub(super) vertices: Vec<K::Stored>,
}

impl BspTree {
    /// Builds a tree with the default options.
    ///
    /// # Errors
    ///
    /// If a coordinate is infinite or not a number, naming the polygon; if there are more than
    /// 2²⁸ corners or [`BuildOptions::DEFAULT`] fragments.
    pub fn build<P: Polygon>(polygons: impl IntoIterator<Item = P>) -> Result<Self, Error> {
        BuildOptions::DEFAULT.build(polygons)
    }
}

impl<K: Kernel> BspTree<K> {
    pub(super) fn new(
        kernel: K,
        faces: Faces,
        preparation: Preparation,
        parts: Output<K::Stored>,
    ) -> Self {
        let nodes = finish(&parts.nodes);
        drop(parts.nodes);
        let planes = Planes::new(&faces, &nodes);
        let schedule = Schedule::new(&nodes, parts.records.len() as u32);
        let (mut records, mut vertices) = (parts.records, parts.vertices);
        records.shrink_to_fit();
        vertices.shrink_to_fit();
        Self { kernel, faces, preparation, nodes, planes, schedule, records, vertices }
    }

    /// How many fragments there are.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Whether there are no fragments.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// A fragment by its number, below [`len`](Self::len).
    ///
    /// # Panics
    ///
    /// If there is no such fragment.
    pub fn fragment(&self, index: u32) -> Fragment<'_, K> {
        Fragment::new(self, index)
    }

    /// All fragments, in the order of their numbers.
    pub fn fragments(&self) -> impl ExactSizeIterator<Item = Fragment<'_, K>> {
        (0..self.records.len() as u32).map(|index| self.fragment(index))
    }

    /// The faces that the fragments are pieces of.
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// What became of the polygons before the tree was built.
    pub fn preparation(&self) -> &Preparation {
        &self.preparation
    }

    /// The polygons without area, by number: no fragment is of them.
    pub fn dropped(&self) -> impl Iterator<Item = usize> {
        self.faces.dropped(&self.preparation)
    }
}

impl<K: Kernel> fmt::Debug for BspTree<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BspTree")
            .field("kernel", &self.kernel)
            .field("polygons", &self.preparation.polygons)
            .field("faces", &self.faces.len())
            .field("nodes", &self.nodes.len())
            .field("fragments", &self.records.len())
            .finish_non_exhaustive()
    }
}
