//! All fragments as arrays of numbers, for other languages, files and devices.

use super::BspTree;
use crate::error::{Error, Kind};

/// All fragments of a tree as arrays of numbers: [`BspTree::arrays`] and [`BspTree::arrays_f32`].
///
/// Fragment `i` is that of the tree's orders. It has the vertices, and the edges from each vertex to the next,
/// from `offsets[i]` to `offsets[i + 1]`. Vertex `v` has the weights from `weight_offsets[v]` to
/// `weight_offsets[v + 1]`. The numbers are those that [`Fragment`](crate::Fragment) returns.
///
/// Both lists of offsets are those of sparse matrices by rows (CSR). The weights are such a matrix, which maps
/// attributes of corners to attributes of vertices. It has a row for each vertex. Its columns are the corners of
/// all polygons, one polygon after the other, if you add to each of `weight_corners` the number of corners of
/// all polygons before:
///
/// ```
/// use binspace::BspTree;
///
/// let flat = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
/// let upright = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
/// let heat = [0.0, 1.0, 1.0, 0.0, /* of the second */ 5.0, 5.0, 9.0, 9.0];
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
/// To draw translucent polygons on a GPU, take a [`Mesh`](crate::mesh::Mesh): its fragments share vertices.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FragmentArrays<T> {
    /// The vertices of all fragments, in the polygons' orientation, in their unit.
    pub vertices: Vec<[T; 3]>,
    /// For each fragment, where its vertices begin; and last, how many vertices there are. (n + 1 numbers for n
    /// fragments.)
    pub offsets: Vec<u32>,
    /// For each fragment, the index of its polygon in the input.
    pub polygons: Vec<u32>,
    /// For each vertex, the edge of the polygon on which the edge from it to the next lies, by the number of the
    /// corner where it begins; −1 if a cut or triangulation made it.
    pub edges: Vec<i32>,
    /// For each vertex, where its weights begin; and last, how many weights there are.
    pub weight_offsets: Vec<u32>,
    /// For each weight, the number of the corner in its polygon.
    pub weight_corners: Vec<u32>,
    /// Weights over the polygon's corners, one to three for a vertex. They sum to 1, up to rounding.
    pub weights: Vec<T>,
}

impl BspTree {
    /// All fragments as arrays, in the order of their numbers.
    ///
    /// O(n) time and space for n vertices: per vertex 24 bytes for the position, 8 for the edge and the offset, and
    /// 12 for each of one to three weights; per fragment 8 bytes. Vertices that cuts have made are computed from
    /// their exact definition, 0.2 to 0.4 µs each.
    ///
    /// # Errors
    ///
    /// If there are 2³² or more weights.
    pub fn arrays(&self) -> Result<FragmentArrays<f64>, Error> {
        FragmentArrays::of(self, |number| number)
    }

    /// The same as [`arrays`](Self::arrays), each position and weight rounded once more, to `f32`. A coordinate
    /// beyond the range of `f32` is infinite.
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
            // A polygon has at most 2²² corners.
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

/// The length of an array as the place where what follows begins.
fn end(len: usize) -> Result<u32, Error> {
    u32::try_from(len).map_err(|_| Kind::Indices.error())
}
