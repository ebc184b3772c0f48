//! Fragments, the items of a tree's orders, one by one and as arrays; planes and points in a tree's grid.

use std::cmp::Ordering;
use std::fmt;
use std::iter::FusedIterator;

use glam::DVec3;
use smallvec::SmallVec;

use super::BspTree;
use super::parts::{Record, Stored};
use crate::error::{Error, Kind};
use crate::exact::{EdgeLine, Eye, Faces, PlaneId, PlaneKind, StoredVertex, VertexId, integers};
use crate::viewpoint::{Facing, Viewpoint};

/// A convex piece of a polygon, or the whole polygon. The manual states [which planes](BspTree#contents) cut
/// polygons into pieces.
#[derive(Clone, Copy)]
pub struct Fragment<'t> {
    pub(crate) faces: &'t Faces,
    index: u32,
    pub(super) face: u32,
    stored: &'t [StoredVertex],
    /// The rounded positions of the vertices, if stored.
    positions: &'t [[f64; 3]],
}

impl BspTree {
    /// Returns a fragment, given its number: from 0 to [`len`](Self::len) − 1.
    ///
    /// # Panics
    ///
    /// If no fragment has this number.
    pub fn fragment(&self, index: u32) -> Fragment<'_> {
        Fragment::new(&self.faces, self.stored(), index as usize, index)
    }

    pub(crate) fn stored(&self) -> Stored<'_> {
        let Self { records, vertices, positions, .. } = self;
        Stored { records, vertices, positions }
    }
}

impl<'t> Fragment<'t> {
    /// The fragment stored at `record`; `index` is its number in orders.
    pub(crate) fn new(faces: &'t Faces, stored: Stored<'t>, record: usize, index: u32) -> Self {
        let Stored { records, vertices, positions } = stored;
        let next = records.get(record + 1);
        let end = next.map_or(vertices.len(), |next| next.vertices as usize);
        let Record { face, vertices: start } = records[record];
        let range = start as usize..end;
        let positions = positions.get(range.clone()).unwrap_or_default();
        Self { faces, index, face, stored: &vertices[range], positions }
    }

    /// The stored vertices; empty for a whole face.
    pub(super) fn stored(&self) -> &'t [StoredVertex] {
        self.stored
    }

    /// Returns the fragment's number in the tree, as in [`back_to_front_into`](BspTree::back_to_front_into).
    pub fn index(&self) -> u32 {
        self.index
    }

    /// Returns the index, in input order, of the polygon that this fragment is a piece of.
    pub fn polygon(&self) -> usize {
        self.faces.polygon(self.face)
    }

    /// Returns the face that this fragment is a piece of, one of [`BspTree::faces`]. The face is the polygon,
    /// or a triangle of the triangulated polygon.
    #[doc(hidden)]
    pub fn face(&self) -> u32 {
        self.face
    }

    /// Returns the unit normal of the fragment's plane. The normal points to the front, the side from which
    /// vertices are counter-clockwise. All fragments of a convex polygon have the same normal, bit for bit,
    /// and so have all fragments of one triangle of a triangulated polygon.
    ///
    /// The error of each coordinate is at most 2⁻⁵⁰, however thin the polygon is.
    /// [`grid_points`](Self::grid_points) returns the plane exactly.
    pub fn normal(&self) -> DVec3 {
        unit_normal(self.faces, PlaneId::face(self.face))
    }

    /// Returns the distance of the plane from the origin along the normal, in the polygons' unit. The plane
    /// contains the points p with `normal().dot(p) == offset()`. The front of the plane contains the points
    /// with `normal().dot(p) > offset()`.
    ///
    /// The distance is rounded to within 2⁻⁴⁸ of the largest coordinate of the polygon. A distance that is
    /// too large for `f64` is infinite.
    pub fn offset(&self) -> f64 {
        offset(self.faces, PlaneId::face(self.face))
    }

    /// Returns the exact plane of the fragment: three points of the plane on the tree's
    /// [grid](BspTree::grid), counter-clockwise seen from the front.
    pub fn grid_points(&self) -> [[i64; 3]; 3] {
        plane_points(self.faces, PlaneId::face(self.face))
    }

    /// Returns whether the fragment is a whole polygon, or a whole triangle of a triangulated polygon: no
    /// plane has cut the fragment.
    pub fn is_whole(&self) -> bool {
        self.stored.is_empty()
    }

    /// Returns the number of vertices, three or more.
    pub fn vertex_count(&self) -> usize {
        if self.is_whole() { self.faces.corners(self.face).len() } else { self.stored.len() }
    }

    /// Returns the vertices in the polygon's own orientation: counter-clockwise seen from the polygon's
    /// front.
    ///
    /// The polygon's corners are rounded to the tree's [grid](BspTree::grid), and moved onto the polygon's
    /// plane if they were off the plane by less than the [tolerance](BspTree#exactness). The vertices made by
    /// cuts are rounded: the error of each coordinate is at most 2⁻⁵¹ of the scene's extent (the longest side
    /// of the scene's bounding box) plus one [step](BspTree#which-tolerance) of `f64`.
    ///
    /// Two fragments of one polygon that share a vertex return the same bits for that vertex. Exception: if
    /// three cuts meet in the vertex, the coordinates may differ by one rounding.
    ///
    /// Each call computes the vertices made by cuts, in about 0.1 µs per vertex. Trees of a
    /// [`FrameBuilder`](crate::FrameBuilder) store all vertices instead.
    pub fn vertices(
        &self,
    ) -> impl DoubleEndedIterator<Item = DVec3> + ExactSizeIterator + Clone + use<'t> {
        let lattice = self.faces.lattice();
        self.lattice_vertices().map(move |position| lattice.to_world(position))
    }

    /// Returns the vertices in lattice units, rounded.
    #[doc(hidden)]
    pub fn lattice_vertices(
        &self,
    ) -> impl DoubleEndedIterator<Item = [f64; 3]> + ExactSizeIterator + Clone + use<'t> {
        let Self { faces, face, stored, .. } = *self;
        let corners = faces.corners(face);
        // The vertices with known positions: for a whole face, its corners.
        let known = if stored.is_empty() { corners } else { self.positions };
        (0..self.vertex_count()).map(move |i| match (known.get(i), stored.get(i)) {
            (Some(&position), _) => position,
            (None, Some(stored)) => stored.restored(faces, face).position(),
            (None, None) => corners[i],
        })
    }

    /// Returns, for each edge of the fragment (from a vertex to the next), the number of the polygon's edge
    /// that contains the fragment's edge. `None` if a cut or triangulation made the fragment's edge.
    ///
    /// The number of a polygon's edge is the number of the corner where the edge begins. If the polygon
    /// repeats that corner, the last of the equal corners counts. If triangulation joined collinear edges,
    /// the joined edge has the number of the first edge.
    pub fn edges(
        &self,
    ) -> impl DoubleEndedIterator<Item = Option<u32>> + ExactSizeIterator + Clone + use<'t> {
        let (faces, face) = (self.faces, self.face);
        self.lines().map(move |line| faces.outline_edge(face, line.as_edge()?))
    }

    /// Returns, for each edge from a vertex to the next, the line that contains the edge.
    #[doc(hidden)]
    pub fn lines(
        &self,
    ) -> impl DoubleEndedIterator<Item = EdgeLine> + ExactSizeIterator + Clone + use<'t> {
        let stored = self.stored;
        (0..self.vertex_count()).map(move |i| match stored.get(i) {
            Some(stored) => stored.line(),
            None => EdgeLine::edge(i as u32),
        })
    }

    /// Returns, for each vertex, the exact definition on the fragment's face.
    #[doc(hidden)]
    pub fn vertex_ids(
        &self,
    ) -> impl DoubleEndedIterator<Item = VertexId> + ExactSizeIterator + Clone + use<'t> {
        let stored = self.stored;
        (0..self.vertex_count())
            .map(move |i| stored.get(i).map_or(VertexId::corner(i as u32), StoredVertex::vertex_id))
    }

    /// Returns, for each vertex, weights over the polygon's corners: pairs of a corner's number and the
    /// corner's weight. The weights of a vertex sum to 1, up to rounding. To interpolate an attribute of the
    /// corners, such as a texture coordinate, add weight · attribute for all pairs.
    ///
    /// | vertex | pairs |
    /// |---|---|
    /// | a corner of the polygon | 1 |
    /// | on an edge of the polygon, or of a triangle of a triangulated polygon | 2 |
    /// | inside the polygon or the triangle | 3 |
    pub fn weights(
        &self,
    ) -> impl DoubleEndedIterator<Item = SmallVec<[(u32, f64); 3]>> + ExactSizeIterator + Clone + use<'t>
    {
        let (faces, face) = (self.faces, self.face);
        self.vertex_ids().map(move |vertex_id| {
            let mut weights = faces.barycentric(face, vertex_id);
            weights.iter_mut().for_each(|(k, _)| *k = faces.corner_number(face, *k));
            weights
        })
    }

    /// Returns the side of the fragment that a viewpoint sees: the front, from which the vertices are
    /// counter-clockwise; the back; or neither, if the eye lies on the fragment's plane or the direction of
    /// view is parallel to the plane.
    ///
    /// The viewpoint is rounded as [`Viewpoint`] states; for the rounded viewpoint, the result is exact. So
    /// the result is the same for all fragments of a convex polygon. The triangles of a non-planar polygon
    /// can lie in different planes, so their results can differ. Takes constant time.
    ///
    /// To leave out fragments seen from behind, such as the walls between the eye and the inside of a room:
    ///
    /// ```
    /// use binspace::{BspTree, Facing, Viewpoint};
    ///
    /// let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let ceiling = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]];
    /// let tree = BspTree::build([floor, ceiling])?;
    ///
    /// let above = Viewpoint::eye([0.5, 0.5, 3.0]);
    /// let is_seen = |fragment: &binspace::Fragment<'_>| fragment.facing(above) == Facing::Front;
    /// let seen = tree.back_to_front(above).filter(is_seen);
    /// assert!(seen.map(|fragment| fragment.polygon()).eq([0]));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn facing(&self, viewpoint: Viewpoint) -> Facing {
        let faces = self.faces;
        facing(faces, self.face, &Eye::new(viewpoint, faces.lattice())).into()
    }
}

impl fmt::Debug for Fragment<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Fragment")
            .field("index", &self.index)
            .field("polygon", &self.polygon())
            .field("vertices", &self.vertices().collect::<Vec<_>>())
            .finish_non_exhaustive()
    }
}

impl BspTree {
    /// Returns all fragments, in the order of their numbers.
    pub fn fragments(
        &self,
    ) -> impl DoubleEndedIterator<Item = Fragment<'_>>
    + ExactSizeIterator
    + FusedIterator
    + Clone
    + fmt::Debug {
        (0..self.len() as u32).map(|index| self.fragment(index))
    }
}

/// Error bound: a rounded distance is off by at most `ERROR` times the sum of the magnitudes of all
/// its terms.
///
/// With u = 2⁻⁵³: differences of corners are exact, so a component of the normal is off by 2u of the
/// component's two products. The rounded eye minus a corner is off by 2u of both terms (a direction is
/// exact). The products and sums add 3u. Too small: wrong signs pass. Too large: more faces are decided by
/// integers.
const ERROR: f64 = 5.0 * f64::EPSILON;

/// The side of a face that an eye sees: by floats where the bound allows, otherwise exactly.
pub(super) fn facing(faces: &Faces, face: u32, eye: &Eye) -> Ordering {
    let [p, q, r] = faces.triangle(face);
    let (at, w) = eye.homogeneous();
    let (mut distance, mut size) = (0.0, 0.0);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let a = (q[j] - p[j]) * (r[k] - p[k]);
        let b = (q[k] - p[k]) * (r[j] - p[j]);
        distance += (a - b) * (at[i] - w * p[i]);
        size += (a.abs() + b.abs()) * (at[i].abs() + w * p[i].abs());
    }
    if distance.abs() > ERROR * size {
        return distance.total_cmp(&0.0);
    }
    faces.plane(PlaneId::face(face)).facing(eye)
}

/// The grid to which a tree rounds the corners of polygons: [`BspTree::grid`].
///
/// A grid point is three integers g. The position of the grid point in the polygons' unit is
/// `base + g * 2^exponent`. This position is exact, except in scenes smaller than about 10⁻²⁹⁰ or further
/// from the origin than 2⁵⁸ times the scene's size: in such scenes, `base` cannot store all digits.
///
/// The tree stores each plane as three grid points, which [`Fragment::grid_points`] and
/// [`Node::grid_points`](crate::Node::grid_points) return. With these points you can repeat the tree's
/// decisions in integers or fractions. The point x is in front of the plane through p, q and r if the
/// determinant of q − p, r − p and x − p is positive.
///
/// ```
/// use binspace::BspTree;
///
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build([square(0.0), square(0.75)])?;
/// let grid = tree.grid();
/// let [p, _, _] = tree.fragment(1).grid_points();
/// let height = grid.base.z + p[2] as f64 * 2f64.powi(grid.exponent);
/// assert!(height == 0.0 || height == 0.75);
/// # Ok::<(), binspace::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Grid {
    /// The position of the grid point (0, 0, 0).
    pub base: DVec3,
    /// The step of the grid is 2 to this power, in the polygons' unit.
    pub exponent: i32,
}

impl BspTree {
    /// Returns the grid that corners are rounded to.
    pub fn grid(&self) -> Grid {
        let lattice = self.faces.lattice();
        Grid { base: lattice.to_world([0.0; 3]), exponent: -lattice.exponent() }
    }
}

/// The unit normal of a plane; each coordinate has a few rounding errors.
pub(super) fn unit_normal(faces: &Faces, plane: PlaneId) -> DVec3 {
    faces.plane(plane).normal_f64().normalize()
}

/// The distance of a plane from the origin along its unit normal.
pub(super) fn offset(faces: &Faces, plane: PlaneId) -> f64 {
    let corner = match plane.kind() {
        PlaneKind::Face(face) => faces.reference_triangle(face)[0],
        PlaneKind::Axis(_, corner) => corner,
    };
    unit_normal(faces, plane).dot(faces.lattice().to_world(faces.corner(corner)))
}

/// Three lattice points of a plane, counter-clockwise seen from the plane's front.
pub(crate) fn plane_points(faces: &Faces, plane: PlaneId) -> [[i64; 3]; 3] {
    match plane.kind() {
        PlaneKind::Face(face) => faces.triangle(face).map(integers),
        PlaneKind::Axis(axis, corner) => {
            let point = integers(faces.corner(corner));
            [point, along(point, (axis + 1) % 3), along(point, (axis + 2) % 3)]
        }
    }
}

/// The next point along an axis.
pub(crate) fn along(mut point: [i64; 3], axis: usize) -> [i64; 3] {
    point[axis] += 1;
    point
}

/// All fragments of a tree as arrays of numbers: [`BspTree::arrays`] and [`BspTree::arrays_f32`].
///
/// All values are the values that the methods of [`Fragment`] return. Fragments have the same numbers as in
/// the tree's orders.
///
/// | items | range |
/// |---|---|
/// | `vertices` and `edges` of fragment `i` | `offsets[i]..offsets[i + 1]` |
/// | `weights` and `weight_corners` of vertex `v` | `weight_offsets[v]..weight_offsets[v + 1]` |
///
/// The weights are a sparse matrix in the form of compressed sparse rows (CSR). The matrix maps attributes of
/// corners to attributes of vertices. The matrix has a row for each vertex, and a column for each corner of
/// all polygons. The column of a corner is the corner's number in the polygon, as in `weight_corners`, plus
/// the number of corners of all earlier polygons:
///
/// ```
/// use binspace::BspTree;
///
/// let flat = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
/// let upright = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
/// let heat = [0.0, 1.0, 1.0, 0.0, /* the second square */ 5.0, 5.0, 9.0, 9.0];
/// let first = [0, 4]; // of the corners of each polygon, in `heat`
/// let arrays = BspTree::build([flat, upright])?.arrays()?;
///
/// let mut heat_of_vertices = Vec::new();
/// for (fragment, &polygon) in arrays.polygons.iter().enumerate() {
///     for vertex in arrays.offsets[fragment]..arrays.offsets[fragment + 1] {
///         let [start, end] = [0, 1].map(|k| arrays.weight_offsets[vertex as usize + k] as usize);
///         let heat = |k: usize| heat[first[polygon as usize] + arrays.weight_corners[k] as usize];
///         heat_of_vertices.push((start..end).map(|k| arrays.weights[k] * heat(k)).sum::<f64>());
///     }
/// }
/// assert_eq!(heat_of_vertices.len(), arrays.vertices.len());
/// // One square is whole, the other cut in two.
/// assert_eq!((arrays.polygons.len(), arrays.vertices.len(), arrays.weights.len()), (3, 12, 16));
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// To draw translucent polygons on a GPU, use a [`Mesh`](crate::mesh::Mesh): the fragments in a mesh share
/// vertices.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FragmentArrays<T> {
    /// The vertices of all fragments, in the orientation and the unit of the polygons.
    pub vertices: Vec<[T; 3]>,
    /// For each fragment, the number of its first vertex. For n fragments, the list has n + 1 numbers: the
    /// last number is the number of all vertices.
    pub offsets: Vec<u32>,
    /// For each fragment, the index of its polygon in input order.
    pub polygons: Vec<u32>,
    /// For each vertex, the number of the polygon's edge that contains the fragment's edge from this vertex
    /// to the next. The number of a polygon's edge is the number of the corner where the edge begins. −1 if a
    /// cut or triangulation made the fragment's edge.
    pub edges: Vec<i32>,
    /// For each vertex, the number of its first weight; at the end, the number of all weights.
    pub weight_offsets: Vec<u32>,
    /// For each weight, the number of the weighted corner in the polygon.
    pub weight_corners: Vec<u32>,
    /// Weights over the polygon's corners, one to three for a vertex. The weights of a vertex sum to 1, up to
    /// rounding.
    pub weights: Vec<T>,
}

impl BspTree {
    /// Returns all fragments as arrays, in the order of their numbers.
    ///
    /// Takes O(n) time and space for n vertices. A vertex takes 24 bytes for the position, 8 for the edge and
    /// the offset, and 12 for each of one to three weights. A fragment takes 8 bytes.
    ///
    /// # Errors
    ///
    /// If there are 2³² or more weights.
    pub fn arrays(&self) -> Result<FragmentArrays<f64>, Error> {
        FragmentArrays::of(self, |number| number)
    }

    /// Returns the [`arrays`](Self::arrays) with each position and weight rounded once more, to `f32`. A
    /// coordinate beyond the range of `f32` is infinite.
    ///
    /// # Errors
    ///
    /// As for [`arrays`](Self::arrays).
    pub fn arrays_f32(&self) -> Result<FragmentArrays<f32>, Error> {
        FragmentArrays::of(self, |number| number as f32)
    }
}

impl<T> FragmentArrays<T> {
    fn of(tree: &BspTree, rounded: impl Fn(f64) -> T) -> Result<Self, Error> {
        let (fragments, vertices) =
            (tree.len(), tree.fragments().map(|fragment| fragment.vertex_count()).sum());
        let mut arrays = Self {
            vertices: Vec::with_capacity(vertices),
            offsets: Vec::with_capacity(fragments + 1),
            polygons: Vec::with_capacity(fragments),
            edges: Vec::with_capacity(vertices),
            weight_offsets: Vec::with_capacity(vertices + 1),
            weight_corners: Vec::with_capacity(vertices),
            weights: Vec::with_capacity(vertices),
        };
        arrays.offsets.push(0);
        arrays.weight_offsets.push(0);
        for fragment in tree.fragments() {
            let vertices = fragment.vertices().map(|vertex| vertex.to_array().map(&rounded));
            arrays.vertices.extend(vertices);
            arrays.offsets.push(end(arrays.vertices.len())?);
            arrays.polygons.push(fragment.polygon() as u32);
            // A polygon has at most 2²² corners, so a number fits.
            arrays.edges.extend(fragment.edges().map(|edge| edge.map_or(-1, |edge| edge as i32)));
            for weights in fragment.weights() {
                arrays.weight_corners.extend(weights.iter().map(|&(corner, _)| corner));
                arrays.weights.extend(weights.iter().map(|&(_, weight)| rounded(weight)));
                arrays.weight_offsets.push(end(arrays.weights.len())?);
            }
        }
        Ok(arrays)
    }
}

/// The length of an array, as an offset.
fn end(len: usize) -> Result<u32, Error> {
    u32::try_from(len).map_err(|_| Kind::Indices.error())
}
