//! A tree's fragments as vertices and triangles, for renderers.

mod survey;
mod triangles;

use std::collections::HashMap;

use glam::DVec3;

use super::BspTree;
use super::parts::Stored;
use crate::error::{Error, Kind};
use crate::exact::{VertexId, VertexKind};
use crate::memory::{empty, reserve};
pub(crate) use survey::Source;
use survey::{FragmentEdge, Node, OutlineVertex, Points, Survey, coordinate, ends, triangulate};

pub use triangles::Triangles;

/// The [fragments](crate::Fragment) of a tree as vertices and triangles, for a renderer's buffers.
///
/// [`BspTree::mesh`] and [`BspTree::welded_mesh`] make a mesh, which is stored separately from the tree.
/// Upload the mesh's vertices once. Every frame, write the indices in the order of the viewpoint
/// ([`Triangles::write_back_to_front`]).
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
/// A *point* is a position, which all fragments that meet there share. A *vertex* is a point as a corner of
/// one polygon's fragments. A vertex has weights over that polygon's corners, which interpolate attributes.
/// So different polygons share points, and the fragments of one polygon share vertices.
///
/// Fragments share a point if the point has the same exact definition in all of them; rounded coordinates do
/// not matter. There are three kinds of points:
///
/// - a corner of the input;
/// - the intersection of an edge and a plane that cuts the edge;
/// - the intersection of a polygon and two planes that cut the polygon.
///
/// If several planes cut an edge, an exact test decides whether the planes cut the edge in one point.
///
/// # Welded
///
/// A cut that ends on an edge makes a vertex on the edge in the polygon that is cut, but not in the
/// neighbour. Such a vertex is a T-junction, where a renderer may miss pixels. A welded mesh has that vertex
/// in the neighbour too, also if the neighbour is another fragment of the same polygon.
///
/// A closed body stays closed in a welded mesh: if the body's polygons traverse every edge once in each
/// direction, so do the body's triangles, from point to point.
///
/// Collinear edges that overlap are welded, even if a corner of one edge is inside the other edge. Where
/// there is no common edge, nothing is welded: a corner inside a polygon, and polygons that cross each other.
#[derive(Clone, Debug)]
pub struct Mesh {
    parts: Assembled,
    triangles: Triangles,
}

/// A vertex of a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshVertex<'m> {
    /// The number of the vertex's [point](Mesh#points-and-vertices). All polygons that meet at the point
    /// share this number.
    pub point: u32,
    /// The position of the vertex's point.
    pub position: DVec3,
    /// The index of the vertex's polygon, in input order.
    pub polygon: usize,
    /// Weights over the polygon's corners: up to three pairs of a corner's number and the corner's weight.
    /// The weights sum to 1, up to rounding. If the tolerance moved corners of the polygon, they are for the place on the
    /// moved polygon, not for the position.
    pub weights: &'m [(u32, f64)],
}

impl MeshVertex<'_> {
    /// Interpolates an attribute, given the attribute's value at each of the polygon's corners.
    pub fn interpolate(&self, attribute: impl Fn(usize) -> f64) -> f64 {
        self.weights.iter().map(|&(corner, weight)| weight * attribute(corner as usize)).sum()
    }
}

impl BspTree {
    /// Returns the fragments as vertices and triangles. No vertices are added to the fragments, so the mesh
    /// can have T-junctions; see [`Mesh`].
    ///
    /// Takes O(n log n) time for n vertices of fragments.
    ///
    /// # Errors
    ///
    /// If memory runs out, or there would be more than 2³² indices.
    pub fn mesh(&self) -> Result<Mesh, Error> {
        Mesh::new(self.mesh_source(), false)
    }

    /// Returns a [`mesh`](Self::mesh) without T-junctions. If several polygons share an edge, and one of them
    /// has a vertex inside the edge, all of these polygons have that vertex. Fragments of one polygon on the
    /// two sides of a cut also have the same vertices along the cut.
    ///
    /// Takes O(n log n) time for n vertices, including the inserted vertices. (If m polygons share one edge,
    /// and each polygon is cut at other places, about m² vertices are inserted.)
    ///
    /// # Errors
    ///
    /// As for [`mesh`](Self::mesh).
    pub fn welded_mesh(&self) -> Result<Mesh, Error> {
        Mesh::new(self.mesh_source(), true)
    }

    fn mesh_source(&self) -> Source<'_> {
        let Self { faces, records, vertices, positions, generation, .. } = self;
        let stored = Stored { records, vertices, positions };
        let first_corner = faces.corners_of_cell();
        Source { faces, stored, generation: *generation, first: 0, first_corner }
    }
}

impl Mesh {
    pub(crate) fn new(source: Source<'_>, weld: bool) -> Result<Self, Error> {
        let (parts, mut triangles) = assemble(source, weld)?;
        triangles.vertices = parts.vertices.len() as u32;
        Ok(Self { parts, triangles })
    }

    /// Returns the number of vertices.
    pub fn len(&self) -> usize {
        self.parts.vertices.len()
    }

    /// Returns whether there are no vertices.
    pub fn is_empty(&self) -> bool {
        self.parts.vertices.is_empty()
    }

    /// Returns a vertex, given its number: from 0 to [`len`](Self::len) − 1.
    ///
    /// # Panics
    ///
    /// If no vertex has this number.
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

    /// Returns all vertices, in the order of their numbers; the vertices of one polygon are consecutive.
    pub fn vertices(&self) -> impl DoubleEndedIterator<Item = MeshVertex<'_>> + ExactSizeIterator {
        (0..self.len() as u32).map(|vertex| self.vertex(vertex))
    }

    /// Returns the position of each point.
    ///
    /// Corners are at their given positions, rounded to the [grid](BspTree::grid), even if the
    /// [tolerance](BspTree#exactness) moved the corners in the tree. Other points are rounded: the error of
    /// each coordinate is at most 2⁻⁵¹ of the scene's extent (the longest side of the scene's bounding box)
    /// plus one [step](BspTree#which-tolerance) of `f64`.
    pub fn positions(&self) -> &[DVec3] {
        &self.parts.positions
    }

    /// Returns the triangles of all fragments, with the orientation of their polygons. (Triangles not much wider than the
    /// [tolerance](BspTree#exactness), of polygons whose corners it moved, may be turned over.)
    pub fn triangles(&self) -> &Triangles {
        &self.triangles
    }

    /// Returns the triangles of some polygons, such as the polygons drawn in one pass. `keep` is called with
    /// the index of a polygon in input order, and returns whether the polygon's triangles are included.
    ///
    /// # Errors
    ///
    /// If memory runs out.
    pub fn triangles_of(&self, keep: impl Fn(usize) -> bool) -> Result<Triangles, Error> {
        let polygon = |first: u32| self.parts.vertices[first as usize].polygon as usize;
        self.triangles
            .of_fragments(|indices| indices.first().is_some_and(|&first| keep(polygon(first))))
    }

    /// Returns the size of the heap memory in bytes.
    pub fn memory_usage(&self) -> usize {
        size_of_val(&*self.parts.positions)
            + size_of_val(&*self.parts.vertices)
            + size_of_val(&*self.parts.weights)
            + self.triangles.bytes()
    }
}

/// The contents of a mesh.
#[derive(Clone, Debug, Default)]
struct Assembled {
    /// The position of each point.
    positions: Vec<DVec3>,
    /// For each vertex, the point, the polygon, and the end of the vertex's weights.
    vertices: Vec<Record>,
    weights: Vec<(u32, f64)>,
}

/// A stored vertex.
#[derive(Clone, Copy, Debug)]
struct Record {
    point: u32,
    polygon: u32,
    weights_end: usize,
}

/// A mesh, welded or not.
fn assemble(source: Source<'_>, weld: bool) -> Result<(Assembled, Triangles), Error> {
    let survey = Survey::new(source)?;
    let points = Points::new(&survey)?;
    let mut lengths = Vec::new();
    reserve(&mut lengths, source.len())?;
    lengths.resize(source.len(), 0_u32);
    for (at, &fragment) in survey.fragments.iter().enumerate() {
        let range = survey.starts[at] as usize..survey.starts[at + 1] as usize;
        let steps = points.ends[range].iter().map(|&[from, to]| match from.abs_diff(to) {
            steps if weld => steps,
            steps => steps.min(1),
        });
        let triangles = steps.sum::<u32>().saturating_sub(2);
        lengths[fragment as usize] = triangles.checked_mul(3).ok_or(Kind::Indices.error())?;
    }
    let Source { generation, first, .. } = source;
    let mut triangles = Triangles::with_lengths(generation, first, lengths.into_iter())?;
    let mut assembler = Assembler::new(&survey, &points)?;
    for (at, &fragment) in survey.fragments.iter().enumerate() {
        assembler.outline(at, weld)?;
        let mut places = triangles.of_mut(fragment as usize).as_chunks_mut::<3>().0.iter_mut();
        triangulate(&assembler.outline, |triangle| {
            if let Some(place) = places.next() {
                *place = triangle;
            }
        });
    }
    Ok((assembler.made, triangles))
}

/// The number that stands for no point, and for no corner.
const NONE: u32 = u32::MAX;

/// Identifies a vertex of a polygon: the point, and the corners that have weights at the vertex. (A polygon
/// that touches itself has several corners at one point.)
type Key = (u32, [u32; 3]);

struct Assembler<'s, 't> {
    survey: &'s Survey<'t>,
    points: &'s Points,
    made: Assembled,
    /// For each node that represents a point ([`Points::root`]), the number of the point, or [`NONE`].
    numbers: Vec<u32>,
    /// The vertices of the current polygon.
    known: HashMap<Key, u32>,
    polygon: usize,
    /// The outline of the current fragment.
    outline: Vec<OutlineVertex>,
}

impl<'s, 't> Assembler<'s, 't> {
    fn new(survey: &'s Survey<'t>, points: &'s Points) -> Result<Self, Error> {
        let mut numbers = Vec::new();
        reserve(&mut numbers, survey.nodes())?;
        numbers.resize(survey.nodes(), NONE);
        let (made, known) = (Assembled::default(), HashMap::new());
        let (polygon, outline) = (usize::MAX, Vec::new());
        Ok(Self { survey, points, made, numbers, known, polygon, outline })
    }

    /// Makes the outline of a fragment, given its place in [`Survey::fragments`].
    fn outline(&mut self, at: usize, weld: bool) -> Result<(), Error> {
        let (survey, points) = (self.survey, self.points);
        let face = survey.source.stored.records[survey.fragments[at] as usize].face;
        if survey.faces.polygon(face) != self.polygon {
            self.polygon = survey.faces.polygon(face);
            empty(&mut self.known);
        }
        self.outline.clear();
        let range = survey.starts[at] as usize..survey.starts[at + 1] as usize;
        let edges = &survey.edges[range.clone()];
        let lines = survey.source.fragment(survey.fragments[at]).lines();
        let places = &points.ends[range];
        let mut before = last_carrier(edges, places);
        for ((edge, &[from, to]), line) in edges.iter().zip(places).zip(lines) {
            // Two collinear edges: the polygon's outline is straight here.
            let straight = before == Some(edge.carrier);
            if from == to {
                continue;
            }
            before = Some(edge.carrier);
            let vertex = self.own_vertex(face, edge.from)?;
            reserve(&mut self.outline, 1 + from.abs_diff(to) as usize)?;
            self.outline.push(OutlineVertex { vertex, straight });
            if weld {
                let inside = from.min(to) + 1..from.max(to);
                for k in 0..inside.len() as u32 {
                    let place = if from < to { inside.start + k } else { inside.end - 1 - k };
                    let node = points.on_lines[place as usize];
                    let vertex = match line.as_edge() {
                        Some(k) => self.vertex_on_edge(face, k, edge.carrier, node)?,
                        None => self.own_vertex(face, node)?,
                    };
                    self.outline.push(OutlineVertex { vertex, straight: true });
                }
            }
        }
        Ok(())
    }

    /// A vertex of the face itself.
    fn own_vertex(&mut self, face: u32, node: Node) -> Result<u32, Error> {
        let faces = self.survey.faces;
        let vertex_id = match self.survey.cut(node) {
            Some((_, vertex_id)) => vertex_id,
            None => VertexId::corner(node - faces.corner_range(face).start as u32),
        };
        let number = |k: u32| faces.corner_number(face, k);
        let corners = match vertex_id.kind() {
            VertexKind::Corner(k) => [number(k), NONE, NONE],
            VertexKind::OnEdge(k, _) => pair(edge_numbers(self.survey, face, k)),
            VertexKind::Inside(..) => {
                let first = faces.corner_range(face).start as u32;
                faces.reference_triangle(face).map(|corner| number(corner - first))
            }
        };
        self.vertex(node, corners, || {
            let weights = faces.barycentric(face, vertex_id).into_iter();
            weights.map(|(k, weight)| (number(k), weight)).collect()
        })
    }

    /// A vertex of another face inside an edge of this face.
    fn vertex_on_edge(&mut self, face: u32, k: u32, line: u32, node: Node) -> Result<u32, Error> {
        let survey = self.survey;
        let numbers = edge_numbers(survey, face, k);
        self.vertex(node, pair(numbers), || {
            let axis = survey.carriers[line as usize].axis;
            let [a, b] = ends(survey.faces, face, k).map(|end| end[axis]);
            let share = coordinate(survey, line as usize, node).share(a, b).clamp(0.0, 1.0);
            vec![(numbers[0], 1.0 - share), (numbers[1], share)]
        })
    }

    /// The number of a vertex. Adds the vertex if the polygon has no equal vertex yet.
    fn vertex(
        &mut self,
        node: Node,
        corners: [u32; 3],
        weights: impl FnOnce() -> Vec<(u32, f64)>,
    ) -> Result<u32, Error> {
        let point = self.point(node)?;
        if let Some(&vertex) = self.known.get(&(point, corners)) {
            return Ok(vertex);
        }
        let weights = weights();
        reserve(&mut self.made.weights, weights.len())?;
        self.made.weights.extend(weights);
        reserve(&mut self.made.vertices, 1)?;
        self.known.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        let (polygon, weights_end) = (self.polygon as u32, self.made.weights.len());
        let vertex = self.made.vertices.len() as u32;
        self.made.vertices.push(Record { point, polygon, weights_end });
        self.known.insert((point, corners), vertex);
        Ok(vertex)
    }

    /// The number of a node's point.
    fn point(&mut self, node: Node) -> Result<u32, Error> {
        let root = self.points.root(node);
        let number = self.numbers[root as usize];
        if number != NONE {
            return Ok(number);
        }
        let faces = self.survey.faces;
        let place = match self.survey.cut(root) {
            None => faces.given_corner(root),
            Some((face, vertex_id)) => place_of_cut(self.survey, face, vertex_id),
        };
        reserve(&mut self.made.positions, 1)?;
        self.made.positions.push(faces.lattice().to_world(place));
        let number = self.made.positions.len() as u32 - 1;
        self.numbers[root as usize] = number;
        Ok(number)
    }
}

/// The line of a fragment's last edge, given the ends of each edge. Edges without length are ignored.
fn last_carrier(edges: &[FragmentEdge], places: &[[u32; 2]]) -> Option<u32> {
    let long = edges.iter().zip(places).rev().find(|(_, [from, to])| from != to);
    long.map(|(edge, _)| edge.carrier)
}

/// The position of a vertex that is not a corner, in lattice units. A vertex on a given edge is placed on
/// that edge, so that all faces at the edge agree.
fn place_of_cut(survey: &Survey<'_>, face: u32, vertex_id: VertexId) -> [f64; 3] {
    let faces = survey.faces;
    match vertex_id.kind() {
        VertexKind::OnEdge(k, plane) if faces.moved_axis(face).is_some() => {
            let cut = faces.cut_of_segment(ends(faces, face, k), plane);
            cut.map_or_else(|| faces.position(face, vertex_id), |cut| cut.position())
        }
        _ => faces.position(face, vertex_id),
    }
}

fn pair([a, b]: [u32; 2]) -> [u32; 3] {
    [a.min(b), a.max(b), NONE]
}

/// The numbers, within the polygon, of the corners at the ends of a face's edge.
fn edge_numbers(survey: &Survey<'_>, face: u32, k: u32) -> [u32; 2] {
    let faces = survey.faces;
    let len = faces.corner_range(face).len() as u32;
    [k, if k + 1 == len { 0 } else { k + 1 }].map(|k| faces.corner_number(face, k))
}

#[cfg(test)]
mod assemble_tests {
    use super::{Assembler, FragmentEdge, Points, Survey, last_carrier};
    use crate::{BuildOptions, Heuristic};

    #[test]
    fn an_edge_without_length_is_not_the_last_edge() {
        let edges = [7, 8, 9].map(|carrier| FragmentEdge { carrier, from: 0 });
        assert_eq!(last_carrier(&edges, &[[0, 1], [5, 4], [2, 3]]), Some(9));
        assert_eq!(last_carrier(&edges, &[[0, 1], [5, 4], [2, 2]]), Some(8));
        assert_eq!(last_carrier(&edges, &[[0, 0], [5, 5], [2, 2]]), None);
    }

    /// A square under walls whose planes cut it into strips.
    #[test]
    fn a_polygon_with_many_cuts_does_not_slow_later_polygons() {
        const WALLS: u32 = 500;
        let (side, wide) = (f64::from(WALLS), [-0.5, 1.5]);
        let square = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let square = square.map(|(i, j)| [[-0.5, side][i], wide[j], -1.0]);
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let walls = (0..WALLS).map(|k| corners.map(|(y, z)| [f64::from(k), y, z]));
        let balanced = BuildOptions::DEFAULT.with_heuristic(Heuristic::Balanced);
        let tree = balanced.build(std::iter::once(square).chain(walls)).unwrap();
        let survey = Survey::new(tree.mesh_source()).unwrap();
        let points = Points::new(&survey).unwrap();
        let mut assembler = Assembler::new(&survey, &points).unwrap();
        // The largest capacity for the square's vertices, for the vertices of the first wall after it, and
        // for all later vertices.
        let mut most = [0; 3];
        for at in 0..survey.fragments.len() {
            assembler.outline(at, true).unwrap();
            let most = &mut most[assembler.polygon.min(2)];
            *most = assembler.known.capacity().max(*most);
        }
        assert!(most[0] > 1000 && most[2] < 100, "{most:?} vertices");
    }
}
