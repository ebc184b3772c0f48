//! A tree's fragments as vertices and triangles, for renderers.

mod assemble;
mod lines;
mod outline;
mod points;
mod survey;
mod triangles;

use glam::DVec3;

use self::assemble::{Assembled, assemble};
use super::BspTree;
use crate::Error;
pub use triangles::Triangles;

/// The fragments of a tree as vertices and triangles: what a renderer keeps in its buffers.
///
/// It stands beside the tree and is made on demand ([`BspTree::mesh`],
/// [`BspTree::welded_mesh`]). Upload the vertices once; every frame, write the indices in the
/// order of the viewpoint ([`Triangles::write_back_to_front`]).
///
/// ```
/// use binspace::{BspTree, Viewpoint};
///
/// let flat = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
/// let upright = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
/// let uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]; // of the four corners of both
/// let tree = BspTree::build([flat, upright])?;
///
/// // Once: a vertex buffer of position and texture coordinates.
/// let mesh = tree.welded_mesh()?;
/// let vertices: Vec<([f32; 3], [f32; 2])> = mesh
///     .vertices()
///     .map(|vertex| {
///         let at = |axis: usize| vertex.interpolate(|corner| uv[corner][axis]) as f32;
///         (vertex.position.as_vec3().to_array(), [at(0), at(1)])
///     })
///     .collect();
///
/// // Every frame: an index buffer, which may be mapped memory.
/// let mut order = Vec::new();
/// let mut indices = vec![0; mesh.triangles().indices().len()];
/// let eye = Viewpoint::eye([3.0, 0.0, 5.0]);
/// let count = mesh.triangles().write_back_to_front(&tree, eye, &mut order, &mut indices)?;
/// assert_eq!((vertices.len(), count / 3), (10, 6));
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # Points and vertices
///
/// A *point* is a place where fragments meet. Two fragments share a point because of what it is, not
/// because its rounded coordinates are equal: the same corner as given, the same plane that cuts the
/// same edge, or the same planes that cut the same polygon. That several planes cut an edge in one
/// point is decided exactly.
///
/// A *vertex* is a point as a corner of one polygon's fragments. It has weights over the polygon's
/// corners, to interpolate its attributes. So polygons share points, and fragments of one polygon
/// share vertices.
///
/// # Welded
///
/// A cut that ends on an edge makes a vertex there in the polygon that is cut, but not in its
/// neighbour: a T-junction, where a renderer may miss pixels. A welded mesh has that vertex in the
/// neighbour too, and likewise between the fragments of one polygon. Then a closed body stays closed:
/// if every edge of its polygons is run through once in each direction, so is every edge of its
/// triangles, from point to point.
///
/// Edges are welded that lie on one line as given, also where a corner of one is inside the other.
/// What is not welded: a corner inside a polygon, and polygons that cross each other, as these have
/// no edge in common.
#[derive(Clone, Debug)]
pub struct Mesh {
    parts: Assembled,
    triangles: Triangles,
}

/// A vertex of a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshVertex<'m> {
    /// The number of its point, the same in all polygons that meet there.
    pub point: u32,
    /// Where it is: the point's position.
    pub position: DVec3,
    /// The index, in the input, of its polygon.
    pub polygon: usize,
    /// Weights over the polygon's corners: up to three pairs of a corner's number and its weight.
    /// They sum to 1, up to rounding.
    pub weights: &'m [(u32, f64)],
}

impl MeshVertex<'_> {
    /// An attribute here, given its value at each of the polygon's corners.
    pub fn interpolate(&self, attribute: impl Fn(usize) -> f64) -> f64 {
        self.weights.iter().map(|&(corner, weight)| weight * attribute(corner as usize)).sum()
    }
}

impl BspTree {
    /// The fragments as vertices and triangles. Each fragment has the vertices that it has in the
    /// tree, so that there are T-junctions; see [`Mesh`].
    ///
    /// O(n log n) for n vertices of fragments.
    ///
    /// # Errors
    ///
    /// If memory runs out, or there would be more than 2³² indices.
    pub fn mesh(&self) -> Result<Mesh, Error> {
        let (parts, triangles) = assemble(self, false)?;
        Ok(Mesh { parts, triangles })
    }

    /// Like [`mesh`](Self::mesh), without T-junctions: where polygons have an edge in common, or
    /// fragments a cut, and one has a vertex inside it, all have.
    ///
    /// O(n log n) for n vertices, those that are inserted included. (Where many polygons have one
    /// edge in common, and all are cut in other places, those are n² for n polygons.)
    ///
    /// # Errors
    ///
    /// As for [`mesh`](Self::mesh).
    pub fn welded_mesh(&self) -> Result<Mesh, Error> {
        let (parts, triangles) = assemble(self, true)?;
        Ok(Mesh { parts, triangles })
    }
}

impl Mesh {
    /// How many vertices there are.
    pub fn len(&self) -> usize {
        self.parts.vertices.len()
    }

    /// Whether there are no vertices.
    pub fn is_empty(&self) -> bool {
        self.parts.vertices.is_empty()
    }

    /// A vertex by its number, below [`len`](Self::len).
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    pub fn vertex(&self, vertex: u32) -> MeshVertex<'_> {
        let vertex = vertex as usize;
        let record = self.parts.vertices[vertex];
        let start = vertex.checked_sub(1).map_or(0, |last| self.parts.vertices[last].weights_end);
        MeshVertex {
            point: record.point,
            position: self.parts.positions[record.point as usize],
            polygon: record.polygon as usize,
            weights: &self.parts.weights[start..record.weights_end],
        }
    }

    /// All vertices, in the order of their numbers; those of one polygon follow one another.
    pub fn vertices(&self) -> impl DoubleEndedIterator<Item = MeshVertex<'_>> + ExactSizeIterator {
        (0..self.len() as u32).map(|vertex| self.vertex(vertex))
    }

    /// Where each point is.
    ///
    /// Corners are where they were given, but for the grid that they are rounded to, even if the
    /// tolerance moved them in the tree. Other points are rounded; each coordinate is within 2⁻⁵¹ of
    /// the scene's extent, plus one step of `f64`, of its exact value.
    pub fn positions(&self) -> &[DVec3] {
        &self.parts.positions
    }

    /// The triangles of all fragments. They face as their polygons do.
    pub fn triangles(&self) -> &Triangles {
        &self.triangles
    }

    /// The triangles of some polygons, given by their indices in the input: those that a renderer
    /// draws in one pass. The fragments of others have none.
    ///
    /// # Errors
    ///
    /// If memory runs out.
    pub fn triangles_of(&self, keep: impl Fn(usize) -> bool) -> Result<Triangles, Error> {
        let polygon = |first: u32| self.parts.vertices[first as usize].polygon as usize;
        self.triangles.of_fragments(|fragment| {
            let range = self.triangles.range(fragment);
            self.triangles.indices()[range].first().is_some_and(|&first| keep(polygon(first)))
        })
    }

    /// The resident size in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.parts.positions)
            + size_of_val(&*self.parts.vertices)
            + size_of_val(&*self.parts.weights)
            + self.triangles.bytes()
    }
}
