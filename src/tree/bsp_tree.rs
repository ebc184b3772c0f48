//! The tree, and its figures.

use std::fmt;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use super::bounds::Bounds;
use super::node::{NodeRecord, Sizes, Walk, finish, make_room};
use super::order::eye::Planes;
use super::order::layout::OrderLayout;
use super::parts::{Parts, RawNode, Record};
use crate::Error;
use crate::exact::{Faces, Plane, PlaneId, StoredVertex};
use crate::faces::Preparation;

/// A binary space partition of polygons, which gives their exact back-to-front or front-to-back
/// order for any viewpoint.
///
/// # Use
///
/// ```
/// use binspace::{BspTree, Viewpoint};
///
/// // Three squares above each other: number 0 is the highest.
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build([square(2.0), square(0.0), square(1.0)])?;
///
/// let from_above = Viewpoint::eye([0.5, 0.5, 10.0]);
/// let order: Vec<usize> = tree.back_to_front(from_above).map(|f| f.polygon()).collect();
/// assert_eq!(order, [1, 2, 0]);
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// Build the tree once for static polygons, then ask it for an order every frame. An
/// [`Overlay`](crate::overlay::Overlay) holds what moves, and lines and points; where most polygons move, as in a
/// compositor of layers, a [`FrameBuilder`](crate::FrameBuilder) builds a tree every frame.
///
/// # What it holds
///
/// The tree stores every polygon that has area, as one or more *fragments*: convex pieces. A
/// polygon that no partition plane cuts is one fragment, so if there are as many fragments as faces
/// ([`len`](Self::len) is [`face_count`](Self::face_count)), nothing was cut. Polygons without area are dropped
/// ([`dropped`](Self::dropped) lists them). Polygons that are not convex, or not planar within the
/// tolerance, are triangulated first.
///
/// A [`Fragment`](crate::Fragment) knows the index of its polygon in the input, its vertices, which of its edges are
/// edges of the polygon, the weights of each vertex over the polygon's corners, and which side of it
/// [faces](crate::Fragment::facing) a viewpoint. Fragments are numbered from 0 to
/// [`len`](Self::len) − 1. A number is valid for its own tree only.
///
/// # Order
///
/// In back-to-front order, no fragment hides one that comes later. Front to back is exactly the
/// reverse. Coplanar polygons come in input order in the former, from whichever side they are seen,
/// so the later of two decals is painted over the earlier, [except](#exactness) within the tolerance of
/// a third polygon that all but lies in their plane. An eye that lies on a plane may
/// count as on either side of it. [`Viewpoint`](crate::Viewpoint) says what a NaN, an infinite eye
/// or a zero direction does.
///
/// | order of n fragments | time | memory |
/// |---|---|---|
/// | [`order`](Self::order), written as a list of numbers: [`write_into`](crate::Order::write_into) | O(n) | your buffer |
/// | [`Triangles::write_back_to_front`](crate::mesh::Triangles::write_back_to_front), indices of triangles | O(n) | your buffers |
/// | iterated over, from both ends | O(n) if read to its end | O(depth) |
/// | walked by subtrees, some skipped: [`walk`](crate::Order::walk) | O(subtrees and fragments visited) | O(depth) |
///
/// The list takes 1.4 to 4 ns a fragment on one thread, and is the fastest.
/// [`back_to_front`](Self::back_to_front) and [`back_to_front_into`](Self::back_to_front_into) are short
/// for the iterator and the list.
/// [`same_order`](Self::same_order) tells whether an order is needed at all when the eye has moved.
///
/// # Drawing a frame
///
/// A [`Mesh`](crate::mesh::Mesh) has the fragments as vertices and triangles. Upload its vertices once. Every
/// frame, write the indices back to front, into a buffer that you keep or into mapped memory:
///
/// ```
/// use binspace::{BspTree, Viewpoint};
///
/// # let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// # let tree = BspTree::build([square(2.0), square(0.0)])?;
/// // Once.
/// let mesh = tree.welded_mesh()?;
/// let vertices: Vec<[f32; 3]> =
///     mesh.vertices().map(|vertex| vertex.position.as_vec3().to_array()).collect();
/// // Every frame: nothing is allocated once `order` has grown to its size.
/// let mut order = Vec::new();
/// let mut indices = vec![0; mesh.triangles().indices().len()];
/// # for _ in 0..2 {
/// let eye = Viewpoint::eye([0.5, 0.5, 9.0]);
/// mesh.triangles().write_back_to_front(&tree, eye, &mut order, &mut indices)?;
/// # assert_eq!((indices.len(), indices[0]), (12, 4));
/// # }
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// If [`same_order`](Self::same_order) says that no partition plane lies between the eye and that of
/// an earlier frame, the indices of that frame are still right.
///
/// Where most polygons are opaque, let a depth buffer draw those, in any order, and only the
/// translucent ones back to front after them, with the depth test on and writing depths off.
/// [`Mesh::triangles_of`](crate::mesh::Mesh::triangles_of) gives the triangles of either. The picture is the
/// same as that of all in order, except where polygons touch: at the same depth a translucent polygon
/// is drawn over an opaque one, whichever comes first in the input.
///
/// # What need not be drawn
///
/// A [culled](crate::Order::culled) order leaves out fragments outside of a camera's
/// [`Frustum`](crate::Frustum), or seen from the wrong side, in time proportional to the rest. A
/// [walk](crate::Order::walk) skips the subtrees that you choose, by their [boxes](crate::Node::bounds)
/// for instance; the feature `raster` has a mask that tells which of them are hidden. The first use of
/// boxes makes those of the whole tree, once.
///
/// # Rays, lines of sight and points
///
/// [`hits`](Self::hits) gives what a [`Ray`](crate::Ray) hits, the nearest first, as far as you read it;
/// [`is_occluded`](Self::is_occluded) tells whether anything lies between two points, and
/// [`winding_number`](Self::winding_number) whether a point is inside a closed body, and
/// [`locate`](Self::locate) in which leaf it is.
/// [`fragments_in`](Self::fragments_in) gives what is in a box or in front of planes. All of
/// them decide exactly for the numbers that they are given: a ray through an edge or a corner never slips
/// between two polygons that share it (if neither was flattened: see [`Preparation::flattened`](crate::Preparation::flattened)).
///
/// ```
/// use binspace::{BspTree, Ray};
///
/// # let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// # let tree = BspTree::build([square(2.0), square(0.0), square(1.0)])?;
/// // What is under the mouse.
/// let ray = Ray::new([0.25, 0.25, 9.0], [0.0, 0.0, -1.0]);
/// assert_eq!(tree.hits(ray).next().map(|hit| hit.polygon()), Some(0));
/// // Whether one point is seen from another.
/// assert!(tree.is_occluded(Ray::between([0.5, 0.5, 3.0], [0.5, 0.5, 1.5])));
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # Attributes
///
/// A cut vertex needs texture coordinates, colours or normals as the corners have them.
/// [`Fragment::weights`](crate::Fragment::weights) gives the weights of each vertex over the corners of the polygon,
/// and so does each [`MeshVertex`](crate::mesh::MeshVertex):
///
/// ```
/// # let flat = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
/// # let upright = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
/// # let tree = binspace::BspTree::build([flat, upright])?;
/// let uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]; // of each polygon's four corners
/// for fragment in tree.fragments() {
///     for weights in fragment.weights() {
///         let coordinate = |axis: usize| -> f64 {
///             weights.iter().map(|&(corner, weight)| weight * uv[corner as usize][axis]).sum()
///         };
///         let interpolated = [coordinate(0), coordinate(1)];
///         # assert!(interpolated.iter().all(|c| [0.0, 0.5, 1.0].contains(c)));
///     }
/// }
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # Exactness
///
/// The corners are rounded once, to a grid of 2⁻⁵² of the scene's extent (the longest side of its
/// bounding box). After that, every decision is the one that exact arithmetic makes, however often
/// a polygon is cut. Only the vertices that you read are rounded again, to `f64`; no decision uses
/// them. [`grid`](Self::grid) and the `grid_points` of nodes, fragments and hits give the exact numbers.
///
/// The order is right up to the coplanar tolerance τ, a length
/// ([`BuildOptions::tolerance`](crate::BuildOptions::tolerance)). Where polygons reach across a
/// partition plane by less than τ, those parts may be painted in either order. It shows along lines
/// of sight that stay within τ of such a plane from one polygon to the other, or from the eye to the
/// nearer polygon:
///
/// - layers up to 2 τ apart, one on each side of a plane, can be exchanged from any viewpoint;
/// - seen along a plane, polygons can be exchanged however far apart they are;
/// - polygons in exactly one plane can come out of input order where they overlap, if all of the overlap
///   is within τ of a partition plane that crosses theirs: one of them is then treated as in front of it,
///   and the other as behind it or on it.
///
/// With a tolerance of 0 the order is exactly right.
///
/// # Which tolerance
///
/// The [default](crate::Tolerance::Default) follows the input, so it need rarely be changed:
///
/// | input | default | take instead |
/// |---|---|---|
/// | `f64` | 10⁻⁹ of the extent; beyond a million extents from the origin four steps of the largest coordinate, which are more | 0 if layers, however thin, must never be exchanged |
/// | `f32`, computed or not | four steps of the largest coordinate: 2·10⁻⁷ to 5·10⁻⁷ of the extent, more far from the origin | 0 if no computation has touched them, as on integers |
/// | an OBJ file | four units in the last decimal that its coordinates need (zeros at the end aside), at most 10⁻⁵ of the extent, however far it lies from the origin | a larger length if most quads are [`bent`](crate::Preparation::bent) by a coarse rounding |
/// | a [`Polygon`](crate::Polygon) of your own | that of its point type, as above; or its own [`precision`](crate::Polygon::precision), between 10⁻⁹ and 10⁻⁵ of the extent | |
/// | thin layers in a scene of large extent | | a length below half the distance of the layers |
///
/// Too small, and polygons that were meant to be coplanar cut each other into slivers, and quads
/// that rounding has bent are triangulated. Too large, and layers that were meant to be apart come
/// in input order. [`Preparation`](crate::Preparation) tells how many polygons are
/// [`bent`](crate::Preparation::bent) by little more than the tolerance, and how many it
/// [`flattened`](crate::Preparation::flattened), [`Stats`](crate::Stats) how many it made
/// [coplanar](crate::Stats::nearly_coplanar), and both by how much. A share of the extent is one of *all* corners: a stray vertex far off makes it larger,
/// so remove the vertex, or give a length.
///
/// # T-junctions
///
/// A cut goes through the polygons that span the plane, and no others: where it ends on an edge that a
/// *neighbouring* polygon shares, the neighbour may not be cut there, and then has no vertex there. The
/// same is so between two fragments of one polygon, if only one of them is cut further. A rasteriser can
/// miss pixels at such a T-junction, because the rounded vertex is not exactly on the other's edge.
/// Where both sides have a vertex, they have it bit for bit, unless the tolerance moved a corner of one.
///
/// [`welded_mesh`](Self::welded_mesh) has no T-junctions: it inserts the vertex on the other side, so
/// that a closed body stays closed. Fragments themselves are never changed.
///
/// # Building
///
/// Time grows a little faster than n log n. On one thread, scenes of 100 000 faces take 1.1 to 1.8 µs a
/// face where little is cut, and up to 12 µs where much is. Where nothing has to be cut, the worst case
/// is n²: each plane takes only a few polygons off the rest, as in nested shells or the sides of a cone.
/// Polygons that all cross one another can have n³ / 6 fragments.
///
/// Modelled scenes and scans have 1.0 to 2.3 fragments a face; triangles at random that cross each
/// other have many more (1000 of them about 12 each, and more the more there are).
/// [`max_fragments`](crate::BuildOptions::max_fragments) sets a limit. The finished tree takes 100 to
/// 160 bytes a fragment ([`memory_usage`](Self::memory_usage)), and up to 2.7 times that while it is built.
///
/// With the feature `save`, a tree is written to a file and read from it, bit for bit, which takes a
/// small part of the time to build it: `BspTree::write` and `BspTree::read`.
///
/// Nothing recurses over the data: a chain of a million polygons needs no more stack than one. The
/// same input and options give the same tree, bit for bit, with any number of threads.
///
/// [`BuildOptions`](crate::BuildOptions) sets the heuristic, the tolerance and budgets, reports
/// progress, and can cancel.
///
/// # What it is not
///
/// - Not a renderer: it gives an order, and you draw. (The feature `raster` has a painter that
///   checks orders.)
/// - Not dynamic: polygons cannot be moved or removed, and [`extend`](Self::extend), which adds some,
///   builds the tree anew. An [`Overlay`](crate::overlay::Overlay) puts moving polygons, lines and points in one
///   order with the tree's.
/// - Not a spatial index: for overlaps or nearest neighbours, or ray casts alone, take a bounding
///   volume hierarchy, which is much faster to build.
/// - Not for solids: it does no Boolean operations.
#[derive(Clone)]
pub struct BspTree {
    pub(crate) faces: Faces,
    pub(crate) preparation: Preparation,
    pub(crate) nodes: Vec<NodeRecord>,
    pub(crate) planes: Planes,
    /// None in a tree for one view.
    pub(super) layout: Option<OrderLayout>,
    pub(crate) records: Vec<Record>,
    pub(super) vertices: Vec<StoredVertex>,
    /// Rounded positions of the vertices, in lattice units; only in a tree for one view.
    pub(super) positions: Vec<[f64; 3]>,
    /// How many times the builder cut a piece in two.
    pub(super) cuts: usize,
    /// Identifies the tree, so that overlays and meshes of other trees are refused. Clones share it.
    pub(crate) generation: u64,
    /// Made by the first query that needs them.
    pub(super) bounds: OnceLock<Bounds>,
    /// Edges that keep bodies from being closed, by face and number. Made by the first query that needs them.
    pub(crate) open_edges: OnceLock<Vec<[u32; 2]>>,
}

/// A number that no tree of this process has had.
pub(super) fn next_generation() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl BspTree {
    /// A tree of nothing.
    pub(crate) fn empty() -> Self {
        Self {
            faces: Faces::default(),
            preparation: Preparation::default(),
            nodes: vec![],
            planes: Planes::default(),
            layout: None,
            records: vec![],
            vertices: vec![],
            positions: vec![],
            cuts: 0,
            generation: next_generation(),
            bounds: OnceLock::new(),
            open_edges: OnceLock::new(),
        }
    }

    /// Empties the tree, and gives its lists back.
    pub(crate) fn take_parts(&mut self) -> (Faces, Parts) {
        let Self { faces, nodes, planes, records, vertices, positions, .. } =
            std::mem::replace(self, Self::empty());
        (self.nodes, self.planes) = (nodes, planes);
        self.nodes.clear();
        self.planes.clear();
        (faces, Parts { nodes: vec![], records, vertices, positions, cuts: 0 })
    }

    /// Replaces what the tree consists of, and gives back the list that the builder wrote its nodes
    /// into. `sizes` is working space.
    pub(crate) fn refill(
        &mut self,
        faces: Faces,
        preparation: Preparation,
        parts: Parts,
        sizes: &mut Vec<Sizes>,
    ) -> Result<Vec<RawNode>, Error> {
        make_room(parts.nodes.len(), sizes, &mut self.nodes)?;
        finish(parts.nodes.iter().copied(), sizes, &mut self.nodes);
        if let Err(error) = self.planes.fill(&faces, &self.nodes) {
            // The tree is empty after an error.
            self.nodes.clear();
            self.planes.clear();
            return Err(error);
        }
        (self.faces, self.preparation) = (faces, preparation);
        (self.bounds, self.open_edges) = (OnceLock::new(), OnceLock::new());
        let Parts { nodes, records, vertices, positions, cuts } = parts;
        (self.records, self.vertices, self.positions) = (records, vertices, positions);
        self.cuts = cuts;
        Ok(nodes)
    }

    /// A tree for many orders.
    pub(crate) fn new(faces: Faces, preparation: Preparation, parts: Parts) -> Result<Self, Error> {
        let mut tree = Self::empty();
        drop(tree.refill(faces, preparation, parts, &mut Vec::new())?);
        tree.nodes.shrink_to_fit();
        tree.records.shrink_to_fit();
        tree.vertices.shrink_to_fit();
        tree.layout = Some(OrderLayout::new(&tree.nodes, tree.records.len() as u32)?);
        Ok(tree)
    }

    /// How many fragments there are.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Whether there are no fragments.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// How many faces there are: polygons with area, of which those that were triangulated have
    /// a face for each triangle. O(1).
    ///
    /// If [`len`](Self::len) is the same, no face was cut: each is drawn whole, and none goes through
    /// another by more than the tolerance. (If it is larger, some may have been cut only because a
    /// partition plane goes through them.)
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The faces that the fragments are pieces of, for `raster`.
    #[cfg_attr(not(feature = "raster"), doc(hidden))]
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// Whether it is the tree of a cell of a [`Partition`](crate::partition::Partition), not of whole polygons.
    pub fn is_of_cell(&self) -> bool {
        self.faces.corners_of_cell() > 0
    }

    /// How many polygons were dropped or triangulated before the tree was built.
    pub fn preparation(&self) -> &Preparation {
        &self.preparation
    }

    /// Counts the polygons that have the same corners as an earlier one, rounded to the
    /// [grid](Self::grid), in the same cyclic order or its reverse. The tree keeps all of them, and the
    /// last one is painted last, as coplanar polygons come in input order.
    ///
    /// Takes O(n log n) time and as much memory as the polygons' corners. The tree knows the corners of
    /// its faces only: where triangles have replaced a polygon, a corner without a triangle is ignored,
    /// as one on a straight side can be. In the tree of a cell, so are corners of triangles outside the
    /// cell.
    pub fn duplicates(&self) -> usize {
        self.faces.duplicates()
    }

    /// The indices of the polygons that have no fragments: those without area, and in a tree of a cell
    /// those of which nothing is in it.
    pub fn dropped(&self) -> impl Iterator<Item = usize> + Clone {
        self.faces.dropped(self.preparation.polygons)
    }
}

impl fmt::Debug for BspTree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BspTree")
            .field("polygons", &self.preparation.polygons)
            .field("faces", &self.faces.len())
            .field("nodes", &self.nodes.len())
            .field("fragments", &self.records.len())
            .finish_non_exhaustive()
    }
}

/// Statistics of a tree: [`BspTree::stats`]. What became of its polygons before they were divided is in
/// [`BspTree::preparation`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Stats {
    /// Convex faces: polygons, and the triangles of polygons that were triangulated;
    /// [`BspTree::face_count`].
    pub faces: usize,
    /// Fragments in the tree.
    pub fragments: usize,
    /// Partition planes.
    pub nodes: usize,
    /// The most nodes on a path from the root.
    pub depth_max: usize,
    /// The mean number of nodes on the path from the root to a fragment, over all fragments.
    pub depth_mean: f64,
    /// How many times the builder cut a piece in two.
    pub splits: usize,
    /// The size of the tree in bytes, with its boxes once they are made: [`BspTree::memory_usage`].
    pub bytes: usize,
    /// The coplanar tolerance that the tree was built with, a length.
    pub tolerance: f64,
    /// Faces that the tolerance alone made coplanar with a partition plane: the order of those on
    /// one plane is that of the input.
    pub nearly_coplanar: usize,
    /// How far their corners are off that plane at most, a length.
    pub nearly_coplanar_by: f64,
}

impl BspTree {
    /// Statistics of the tree. O(fragments).
    pub fn stats(&self) -> Stats {
        let (mut depth_max, mut depth_sum) = (0, 0);
        let (mut is_near, mut nearly_coplanar_by) = (vec![false; self.faces.len()], 0.0);
        let mut walk = Walk::new(self);
        while let Some(visit) = walk.next(self) {
            depth_max = depth_max.max(visit.depth);
            depth_sum += visit.depth * (visit.own.len() + visit.leaves());
            let id = self.nodes[visit.node].plane;
            let plane = self.faces.plane(id);
            for fragment in visit.own {
                let face = self.records[fragment as usize].face;
                let off = if id == PlaneId::face(face) { 0.0 } else { self.off(face, &plane) };
                is_near[face as usize] |= off > 0.0;
                nearly_coplanar_by = off.max(nearly_coplanar_by);
            }
        }
        let fragments = self.len();
        let lattice = self.faces.lattice();
        Stats {
            faces: self.faces.len(),
            fragments,
            nodes: self.nodes.len(),
            depth_max,
            depth_mean: depth_sum as f64 / fragments.max(1) as f64,
            splits: self.cuts,
            bytes: self.memory_usage(),
            tolerance: lattice.length_to_world(self.faces.tolerance()),
            nearly_coplanar: is_near.into_iter().filter(|&is_near| is_near).count(),
            nearly_coplanar_by: lattice.length_to_world(nearly_coplanar_by),
        }
    }

    /// How far a face's corners are off a plane at most, in lattice units, rounded; 0 only if all of
    /// them are exactly on it.
    fn off(&self, face: u32, plane: &Plane) -> f64 {
        let values = self.faces.corners(face).iter().map(|corner| plane.at(corner).to_f64().abs());
        values.fold(0.0, f64::max) / plane.normal_f64().length()
    }

    /// The size in bytes, heap included. It grows by the boxes when the first query makes them.
    pub fn memory_usage(&self) -> usize {
        size_of::<Self>()
            + self.faces.memory_usage()
            + size_of_val(&*self.nodes)
            + self.planes.bytes()
            + self.layout.as_ref().map_or(0, |layout| layout.bytes())
            + size_of_val(&*self.records)
            + size_of_val(&*self.vertices)
            + size_of_val(&*self.positions)
            + self.bounds.get().map_or(0, |bounds| bounds.bytes())
            + self.open_edges.get().map_or(0, |edges| size_of_val(&**edges))
    }
}
