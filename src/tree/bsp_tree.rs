//! The tree and its statistics.

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

/// A binary space partition of polygons. The tree returns the exact back-to-front or front-to-back order of
/// the polygons for any viewpoint.
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
/// Build the tree once for static polygons, then read an order from it every frame. An
/// [`Overlay`](crate::overlay::Overlay) adds moving polygons, lines and points. If most polygons move, as in
/// a compositor of layers, use a [`FrameBuilder`](crate::FrameBuilder), which builds a tree every frame.
///
/// # Contents
///
/// The polygons are prepared first. A convex polygon that is planar within the tolerance is one *face*. Other
/// polygons are triangulated, and each triangle is a face. Polygons without area are dropped
/// ([`dropped`](Self::dropped) lists them).
///
/// The tree cuts the faces by *partition planes* into *fragments*, which are convex. A face that no plane
/// cuts is one fragment. So no face was cut if [`len`](Self::len), the number of fragments, equals
/// [`face_count`](Self::face_count).
///
/// Fragments are numbered from 0 to [`len`](Self::len) − 1. A number is valid for its own tree only. A
/// [`Fragment`](crate::Fragment) returns:
///
/// - the index of its polygon in input order;
/// - its vertices, and their weights over the polygon's corners;
/// - which of its edges are edges of the polygon;
/// - which of its sides a viewpoint [sees](crate::Fragment::facing).
///
/// # Order
///
/// In back-to-front order, no fragment hides a later fragment. Front-to-back order is the exact reverse.
///
/// In back-to-front order, coplanar polygons follow each other in input order, from whichever side they are
/// seen. So the later of two decals is painted over the earlier decal. (There is an [exception](#exactness)
/// close to other partition planes.)
///
/// An eye on a partition plane may be treated as lying on either side of the plane.
/// [`Viewpoint`](crate::Viewpoint) defines the effect of a NaN, an infinite eye or a zero direction.
///
/// | order of n fragments | time | memory |
/// |---|---|---|
/// | a list of numbers: [`write_into`](crate::Order::write_into) | O(n) | your buffer |
/// | indices of triangles: [`Triangles::write_back_to_front`](crate::mesh::Triangles::write_back_to_front) | O(n) | your buffers |
/// | an iterator, from either end: [`order`](Self::order) | O(n) for the whole order | O(depth) |
/// | a walk that can skip subtrees: [`walk`](crate::Order::walk) | O(subtrees and fragments visited) | O(depth) |
///
/// Writing the list is fastest: 1.4 to 4 ns per fragment on one thread.
/// [`back_to_front_into`](Self::back_to_front_into) is a shorthand for the list, and
/// [`back_to_front`](Self::back_to_front) for the iterator.
///
/// # Drawing a frame
///
/// A [`Mesh`](crate::mesh::Mesh) contains the fragments as vertices and triangles. Upload the vertices once.
/// Every frame, write the indices back to front into a reused buffer or mapped memory:
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
/// // Every frame; once `order` is large enough, nothing is allocated.
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
/// The indices of an earlier frame are still right if [`same_order`](Self::same_order) returns true for the
/// old and the new eye: then no partition plane lies between the two eyes.
///
/// If most polygons are opaque, draw the opaque polygons first, in any order, with a depth buffer. Then draw
/// the translucent polygons back to front, with the depth test on and depth writes off.
/// [`Mesh::triangles_of`](crate::mesh::Mesh::triangles_of) returns the triangles of either kind. There is one
/// difference from a picture drawn entirely in order: where an opaque and a translucent polygon touch, at
/// equal depth, the translucent polygon is always drawn last.
///
/// # Culling
///
/// A [culled](crate::Order::culled) order leaves out fragments that are outside a camera's
/// [`Frustum`](crate::Frustum) or seen from the wrong side. A culled order takes time proportional to the
/// number of remaining fragments. A [walk](crate::Order::walk) skips the subtrees that you choose, for
/// instance by their [boxes](crate::Node::bounds). With the feature `raster`, a coverage mask tests boxes for
/// occlusion. The first call that needs boxes computes them for the whole tree.
///
/// # Rays, lines of sight and points
///
/// [`hits`](Self::hits) iterates lazily over the hits of a [`Ray`](crate::Ray), nearest first.
/// [`is_occluded`](Self::is_occluded) returns whether a polygon lies between two points,
/// [`winding_number`](Self::winding_number) returns whether a point is inside a closed body, and
/// [`locate`](Self::locate) returns the leaf of a point. [`fragments_in`](Self::fragments_in) finds the
/// fragments in a box or in front of planes. All these queries decide exactly for the given numbers: a ray
/// through an edge or a corner never slips between two polygons that share that edge or corner. (Exception:
/// the tolerance moved a corner of one of the two polygons, which
/// [`Preparation::flattened`](crate::Preparation::flattened) counts.)
///
/// ```
/// use binspace::{BspTree, Ray};
///
/// # let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// # let tree = BspTree::build([square(2.0), square(0.0), square(1.0)])?;
/// // The polygon under the mouse.
/// let ray = Ray::new([0.25, 0.25, 9.0], [0.0, 0.0, -1.0]);
/// assert_eq!(tree.hits(ray).next().map(|hit| hit.polygon()), Some(0));
/// // Whether one point is seen from another.
/// assert!(tree.is_occluded(Ray::between([0.5, 0.5, 3.0], [0.5, 0.5, 1.5])));
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # Attributes
///
/// A vertex made by a cut needs texture coordinates, colours or normals like a corner.
/// [`Fragment::weights`](crate::Fragment::weights) returns the weights of each vertex over the corners of the
/// polygon. Each [`MeshVertex`](crate::mesh::MeshVertex) also stores weights:
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
/// The corners are rounded once, to a grid. The rounding changes each coordinate by at most 2⁻⁵² of the
/// scene's extent (the longest side of the scene's bounding box). After this rounding, every decision is
/// exact, however often a polygon is cut. Only the vertices that you read are rounded again, to `f64`; no
/// decision uses them. [`grid`](Self::grid) and the `grid_points` of nodes, fragments and hits return the
/// exact numbers.
///
/// The order is right up to the coplanar tolerance τ, a length
/// ([`BuildOptions::tolerance`](crate::BuildOptions::tolerance)). A polygon that reaches across a partition
/// plane by less than τ is not cut there, but treated as lying on one side of the plane or on the plane. So
/// two polygons that meet the same line of sight can be painted in the wrong order. This can happen only if
/// a part of the line of sight stays within τ of the partition plane: the part between the two polygons, or
/// the part between the eye and the nearer polygon. There are three cases:
///
/// - two layers that both lie within τ of one partition plane, and so up to 2 τ apart: they can be in the
///   wrong order from any viewpoint;
/// - two polygons seen along a partition plane: they can be in the wrong order at any distance from each
///   other;
/// - two overlapping polygons in one plane, in a few cases that the guide lists: they can lose their input order.
///
/// With a tolerance of 0 the order is exactly right. The guide ([`guide::exact`](crate::guide::exact)) says what holds
/// for each kind of answer.
///
/// # Which tolerance
///
/// The [default](crate::Tolerance::Default) depends on the input, so you rarely need to change it. (The
/// *step* of a coordinate is the distance from the coordinate to the next larger `f32` or `f64`.)
///
/// | input | default | when to change it |
/// |---|---|---|
/// | `f64` | 10⁻⁹ of the extent; beyond a million extents from the origin, four steps of the largest coordinate | use 0 if even very thin layers must never be exchanged |
/// | `f32` | four steps of the largest coordinate: near the origin, 2·10⁻⁷ to 5·10⁻⁷ of the extent; further away, a larger share | use 0 for coordinates without rounding errors, such as integers |
/// | an OBJ file | four units of the last decimal place that the file's coordinates use (trailing zeros do not count), at most 10⁻⁵ of the extent; the distance from the origin does not matter | use a larger length if coarse rounding has [`bent`](crate::Preparation::bent) most quads |
/// | your own [`Polygon`](crate::Polygon) type | as for `f32` or `f64`, whichever the coordinates of the points are; or the polygon's own [`precision`](crate::Polygon::precision), between 10⁻⁹ and 10⁻⁵ of the extent | |
/// | thin layers in a scene of large extent | as for the type of the coordinates | use a length of less than half the distance between the layers |
///
/// Too small: polygons that were meant to be coplanar cut each other into slivers, and quads bent by rounding
/// are triangulated. Too large: layers that were meant to be apart are painted in input order.
///
/// Three counts show the effect of the tolerance. Each count comes with the largest distance of a corner from
/// the plane of the polygon or, for the third count, from the partition plane:
///
/// | count | counts |
/// |---|---|
/// | [`Preparation::bent`](crate::Preparation::bent) | polygons triangulated because they are bent by little more than the tolerance |
/// | [`Preparation::flattened`](crate::Preparation::flattened) | polygons made planar, because they are bent by less than the tolerance |
/// | [`Stats::nearly_coplanar`](crate::Stats::nearly_coplanar) | faces treated as lying on a partition plane because of the tolerance |
///
/// The extent includes *all* corners. So a stray vertex far away makes a relative tolerance larger: remove
/// the vertex, or set a length.
///
/// # T-junctions
///
/// A plane cuts only the polygons that reach both of its sides. Suppose that a cut ends on an edge that a
/// *neighbouring* polygon shares. If the neighbour is not cut there, the neighbour has no vertex at the end
/// of the cut. This place is a *T-junction*. The two neighbours can also be fragments of one polygon. A
/// rasteriser can miss pixels at a T-junction, because the rounded vertex is not exactly on the neighbour's
/// edge. If both neighbours have the vertex, the vertex's coordinates are bit for bit equal in both
/// neighbours, unless the tolerance moved a corner of one polygon.
///
/// [`welded_mesh`](Self::welded_mesh) returns a mesh without T-junctions: the mesh has the missing vertex in
/// the neighbour too, so a closed body stays closed. Fragments themselves are never changed.
///
/// # Building
///
/// The build time usually grows a little faster than n log n. On one thread, scenes of 100 000 faces take 1.1
/// to 1.8 µs per face with few cuts, and up to 12 µs with many cuts. The build takes O(n²) time if each plane
/// separates only a few polygons from the others, as in nested shells or the sides of a cone. If n polygons
/// all cross one another, there can be n³ / 6 fragments.
///
/// Modelled scenes and scans have 1.0 to 2.3 fragments per face. Random triangles that cross each other have
/// many more fragments: about 12 per triangle for 1000 triangles, and the ratio grows with n.
/// [`max_fragments`](crate::BuildOptions::max_fragments) sets a limit. The finished tree takes 100 to 160
/// bytes per fragment ([`memory_usage`](Self::memory_usage)); the build takes up to 2.7 times as much memory.
///
/// With the feature `save`, `BspTree::write` and `BspTree::read` store a tree bit for bit; reading takes a
/// quarter to a half of the build time.
///
/// Nothing recurses over the data: a chain of a million polygons needs no more stack than one polygon. The
/// same input and options make bit for bit the same tree with any number of threads.
///
/// [`BuildOptions`](crate::BuildOptions) sets the heuristic, the tolerance and budgets, reports
/// progress, and can cancel.
///
/// # Limits
///
/// - Not a renderer: the tree computes an order, and you draw. (The feature `raster` has a painter that
///   checks orders.)
/// - Not dynamic: polygons cannot be moved or removed, and [`extend`](Self::extend), which adds polygons,
///   builds the tree again. An [`Overlay`](crate::overlay::Overlay) puts moving polygons, lines and points in
///   one order with the tree's polygons.
/// - Not a spatial index: for overlaps, nearest neighbours or only ray casts, use a bounding volume
///   hierarchy, which is much faster to build.
/// - Not for solids: the library has no Boolean operations.
#[derive(Clone)]
pub struct BspTree {
    pub(crate) faces: Faces,
    pub(crate) preparation: Preparation,
    pub(crate) nodes: Vec<NodeRecord>,
    pub(crate) planes: Planes,
    /// `None` in a tree for one view, which is the tree of a [`FrameBuilder`](crate::FrameBuilder).
    pub(super) layout: Option<OrderLayout>,
    pub(crate) records: Vec<Record>,
    pub(super) vertices: Vec<StoredVertex>,
    /// Rounded positions of the vertices, in lattice units; only in a tree for one view.
    pub(super) positions: Vec<[f64; 3]>,
    /// The number of times that the builder cut a piece in two.
    pub(super) cuts: usize,
    /// Identifies the tree, so that overlays and meshes of other trees are rejected. Clones share this
    /// number.
    pub(crate) generation: u64,
    /// The boxes; computed by the first query that needs boxes.
    pub(super) bounds: OnceLock<Bounds>,
    /// The open edges of bodies: for each edge, the face and the edge's number in the face. Computed by the
    /// first query that needs open edges.
    pub(crate) open_edges: OnceLock<Vec<[u32; 2]>>,
}

/// A number that no earlier tree of this process has.
pub(super) fn next_generation() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl BspTree {
    /// An empty tree.
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

    /// Empties the tree and returns its lists.
    pub(crate) fn take_parts(&mut self) -> (Faces, Parts) {
        let Self { faces, nodes, planes, records, vertices, positions, .. } =
            std::mem::replace(self, Self::empty());
        (self.nodes, self.planes) = (nodes, planes);
        self.nodes.clear();
        self.planes.clear();
        (faces, Parts { nodes: vec![], records, vertices, positions, cuts: 0 })
    }

    /// Replaces the tree's contents and returns the builder's list of nodes for reuse. `sizes` is working
    /// space.
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

    /// Returns the number of fragments.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Returns whether there are no fragments.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Returns the number of faces: polygons with area, where a triangulated polygon counts once for each
    /// triangle. Takes constant time.
    ///
    /// If the number of fragments, [`len`](Self::len), equals the number of faces, then no face was cut, and
    /// no face crosses another face by more than the tolerance. If there are more fragments than faces, faces
    /// need not cross: a partition plane may cut a face that crosses no other face.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Returns the faces that the fragments are pieces of, for `raster`.
    #[cfg_attr(not(feature = "raster"), doc(hidden))]
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// Returns whether the tree is the tree of one cell of a [`Partition`](crate::partition::Partition). The
    /// tree of a cell contains the parts of polygons inside the cell.
    pub fn is_of_cell(&self) -> bool {
        self.faces.corners_of_cell() > 0
    }

    /// Returns counts of the polygons dropped or triangulated before the tree was built.
    pub fn preparation(&self) -> &Preparation {
        &self.preparation
    }

    /// Counts the polygons that have the same corners as an earlier polygon, in the same cyclic order or in
    /// the reverse order. Corners are compared after rounding to the [grid](Self::grid). The tree keeps all
    /// duplicates. Like all coplanar polygons, duplicates are painted in input order.
    ///
    /// Some corners of triangulated polygons are ignored: corners that no triangle has, such as a corner on a
    /// straight side, and, in the tree of a cell, the corners of triangles outside the cell.
    ///
    /// Takes O(n log n) time and as much memory as the polygons' corners.
    pub fn duplicates(&self) -> usize {
        self.faces.duplicates()
    }

    /// Returns the indices of the polygons that have no fragments: polygons without area, and, in the tree of
    /// a cell, polygons outside the cell.
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

/// Statistics of a tree: [`BspTree::stats`]. [`BspTree::preparation`] returns statistics of the polygons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Stats {
    /// The number of faces: polygons with area, where a triangulated polygon counts once for each triangle
    /// ([`BspTree::face_count`]).
    pub faces: usize,
    /// The number of [fragments](crate::Fragment) in the tree.
    pub fragments: usize,
    /// The number of [nodes](crate::Node), each of which has one [partition plane](BspTree#contents).
    pub nodes: usize,
    /// The largest number of nodes on a path from the root.
    pub depth_max: usize,
    /// The mean number of nodes on the path from the root to a fragment, over all fragments.
    pub depth_mean: f64,
    /// The number of cuts. Each cut divides a face, or a part of a face, in two.
    pub splits: usize,
    /// The size of the tree in bytes ([`BspTree::memory_usage`]), including the [bounding
    /// boxes](BspTree::bounds) if a query has computed the boxes.
    pub bytes: usize,
    /// The coplanar [tolerance](BspTree#exactness) that the tree was built with, a length.
    pub tolerance: f64,
    /// The number of faces that are treated as lying on a partition plane, although a corner is off that
    /// plane by a distance within the tolerance. The faces on one partition plane are painted in input order.
    pub nearly_coplanar: usize,
    /// The largest distance of a corner of a [`nearly_coplanar`](Self::nearly_coplanar) face from the
    /// partition plane on which the face is treated as lying, a length.
    pub nearly_coplanar_by: f64,
}

impl BspTree {
    /// Returns statistics of the tree. Takes O(fragments) time.
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

    /// The largest distance of a face's corners from a plane in lattice units, rounded; 0 only if all corners
    /// lie exactly on the plane.
    fn off(&self, face: u32, plane: &Plane) -> f64 {
        let values = self.faces.corners(face).iter().map(|corner| plane.at(corner).to_f64().abs());
        values.fold(0.0, f64::max) / plane.normal_f64().length()
    }

    /// Returns the size of the tree in bytes, including the heap. The size includes the boxes of
    /// [`bounds`](Self::bounds), as soon as a call has computed them.
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
