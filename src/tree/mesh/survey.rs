//! Finds vertices of fragments that are the same point, and collinear edges of fragments.

use std::cmp::Ordering;
use std::collections::{HashMap, TryReserveError};

use crate::error::{Error, Kind};
use crate::exact::vertex::Fraction;
use crate::exact::{Faces, POSITION_OFF, PlaneId, VertexId, VertexKind};
use crate::memory::{empty, reserve};
use crate::tree::Fragment;
use crate::tree::parts::Stored;
use crate::union::Union;

/// A vertex as one face names it: a corner, or the intersection of planes with the face. The first nodes are
/// the corners of all faces; the other nodes are the items of [`Survey::cuts`].
pub(super) type Node = u32;

/// An edge of a fragment. The edge ends where the fragment's next edge begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct FragmentEdge {
    pub(super) carrier: u32,
    pub(super) from: Node,
}

/// The fragments that a mesh is made of: the fragments of a tree, or an overlay's pieces of polygons.
#[derive(Clone, Copy)]
pub(crate) struct Source<'t> {
    pub(crate) faces: &'t Faces,
    pub(crate) stored: Stored<'t>,
    /// The generation of the tree.
    pub(crate) generation: u64,
    /// The number of the first fragment in orders.
    pub(crate) first: usize,
    /// The first corner of the fragments' faces.
    pub(crate) first_corner: usize,
}

impl<'t> Source<'t> {
    /// The number of fragments, including pieces of lines and points.
    pub(super) fn len(&self) -> usize {
        self.stored.records.len()
    }

    /// The fragment with the number `at`, counted from 0.
    pub(super) fn fragment(&self, at: u32) -> Fragment<'t> {
        Fragment::new(self.faces, self.stored, at as usize, at)
    }
}

/// The edges of all fragments, face by face.
pub(super) struct Survey<'t> {
    pub(super) source: Source<'t>,
    pub(super) faces: &'t Faces,
    /// The numbers of all fragments, face by face.
    pub(super) fragments: Vec<u32>,
    /// The first edge of each of `fragments`, and the end of the last fragment's edges.
    pub(super) starts: Vec<u32>,
    pub(super) edges: Vec<FragmentEdge>,
    /// Nodes that are not corners, each as a face and a vertex on the face.
    pub(super) cuts: Vec<(u32, VertexId)>,
    pub(super) carriers: Vec<Carrier>,
}

impl<'t> Survey<'t> {
    pub(super) fn new(source: Source<'t>) -> Result<Self, Error> {
        let faces = source.faces;
        let fragments = by_face(source)?;
        let (starts, edges) = (Vec::new(), Vec::new());
        let mut survey = Self {
            source,
            faces,
            fragments,
            starts,
            edges,
            cuts: Vec::new(),
            carriers: Vec::new(),
        };
        let all = 0..source.len() as u32;
        let edges = all.map(|fragment| source.fragment(fragment).vertex_count()).sum();
        u32::try_from(2 * edges).map_err(|_| Kind::Indices.error())?;
        reserve(&mut survey.edges, edges)?;
        reserve(&mut survey.starts, survey.fragments.len() + 1)?;
        let mut names = Names::default();
        for at in 0..survey.fragments.len() {
            let fragment = source.fragment(survey.fragments[at]);
            names.enter(faces, fragment.face())?;
            survey.make_room(&mut names, fragment.vertex_count())?;
            survey.starts.push(survey.edges.len() as u32);
            for (vertex_id, line) in fragment.vertex_ids().zip(fragment.lines()) {
                let from = survey.node(&mut names, vertex_id);
                let carrier = match line.as_cut() {
                    Some(plane) => survey.carrier_of_cut(&mut names, plane),
                    None => survey.carrier_of_edge(&mut names, line.as_edge().unwrap_or(0)),
                };
                survey.edges.push(FragmentEdge { carrier, from });
            }
        }
        survey.starts.push(survey.edges.len() as u32);
        Ok(survey)
    }

    /// Reserves memory for a fragment with `vertices` vertices, all of which may be new.
    fn make_room(&mut self, names: &mut Names, vertices: usize) -> Result<(), Error> {
        reserve(&mut self.cuts, vertices)?;
        reserve(&mut self.carriers, vertices)?;
        let rooms = [
            names.vertex_ids.try_reserve(vertices),
            names.planes.try_reserve(vertices),
            names.lines.try_reserve(vertices),
        ];
        rooms.into_iter().collect::<Result<(), _>>().map_err(|_| Error::out_of_memory())
    }

    fn node(&mut self, names: &mut Names, vertex_id: VertexId) -> Node {
        if let VertexKind::Corner(k) = vertex_id.kind() {
            return names.first_corner + k;
        }
        let corners = self.faces.corner_count();
        *names.vertex_ids.entry(vertex_id).or_insert_with(|| {
            self.cuts.push((names.face, vertex_id));
            (corners + self.cuts.len() - 1) as u32
        })
    }

    fn carrier_of_cut(&mut self, names: &mut Names, plane: PlaneId) -> u32 {
        *names.planes.entry(plane).or_insert_with(|| {
            let axis = self.faces.axis_of_cut(names.face, plane);
            self.carriers.push(Carrier { axis, face: Some(names.face) });
            self.carriers.len() as u32 - 1
        })
    }

    fn carrier_of_edge(&mut self, names: &mut Names, k: u32) -> u32 {
        let known = &mut names.edges[k as usize];
        *known.get_or_insert_with(|| {
            let ends = ends(self.faces, names.face, k);
            names.lines.number(ends, &mut self.carriers)
        })
    }

    /// The face and vertex of a node; `None` for a corner.
    pub(super) fn cut(&self, node: Node) -> Option<(u32, VertexId)> {
        let at = (node as usize).checked_sub(self.faces.corner_count())?;
        self.cuts.get(at).copied()
    }

    /// The number of nodes.
    pub(super) fn nodes(&self) -> usize {
        self.faces.corner_count() + self.cuts.len()
    }
}

/// The ends of a face's edge: the given corners, before the tolerance moved them.
pub(super) fn ends(faces: &Faces, face: u32, k: u32) -> [[f64; 3]; 2] {
    let range = faces.corner_range(face);
    let next = if k as usize + 1 == range.len() { 0 } else { k + 1 };
    [k, next].map(|k| faces.given_corner(range.start as u32 + k))
}

/// The numbers assigned so far. The numbers of lines are shared by all faces; all other numbers belong to the
/// current face.
#[derive(Default)]
struct Names {
    face: u32,
    first_corner: u32,
    vertex_ids: HashMap<VertexId, Node>,
    planes: HashMap<PlaneId, u32>,
    edges: Vec<Option<u32>>,
    lines: Lines,
}

impl Names {
    fn enter(&mut self, faces: &Faces, face: u32) -> Result<(), Error> {
        if face == self.face && !self.edges.is_empty() {
            return Ok(());
        }
        let corners = faces.corner_range(face);
        (self.face, self.first_corner) = (face, corners.start as u32);
        empty(&mut self.vertex_ids);
        empty(&mut self.planes);
        self.edges.clear();
        reserve(&mut self.edges, corners.len())?;
        self.edges.resize(corners.len(), None);
        Ok(())
    }
}

/// The numbers of all fragments, face by face.
fn by_face(source: Source<'_>) -> Result<Vec<u32>, Error> {
    let faces = source.faces;
    let mut ends = Vec::new();
    reserve(&mut ends, faces.first_thin())?;
    ends.resize(faces.first_thin(), 0_u32);
    // Segments and points of an overlay have no triangles.
    let records = source.stored.records.iter().zip(0..source.len() as u32);
    let records = records.filter(|(record, _)| (record.face as usize) < faces.first_thin());
    records.clone().for_each(|(record, _)| ends[record.face as usize] += 1);
    let mut sum = 0;
    for end in &mut ends {
        sum += *end;
        *end = sum;
    }
    let mut fragments = Vec::new();
    reserve(&mut fragments, sum as usize)?;
    fragments.resize(sum as usize, 0);
    for (record, number) in records.rev() {
        let end = &mut ends[record.face as usize];
        *end -= 1;
        fragments[*end as usize] = number;
    }
    Ok(fragments)
}

/// A line that contains edges of fragments: either the line of a given edge, which all faces share, or the
/// line in which a plane cuts one face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carrier {
    /// An axis along which the line is not constant.
    pub(super) axis: usize,
    /// The face that is cut; `None` for the line of a given edge.
    pub(super) face: Option<u32>,
}

/// The numbers of the lines of edges. The key of a line consists of its shortest integer direction with a
/// positive first nonzero coordinate, and of its moment.
#[derive(Default)]
pub(super) struct Lines(HashMap<([i64; 3], [i128; 3]), u32>);

impl Lines {
    pub(super) fn try_reserve(&mut self, more: usize) -> Result<(), TryReserveError> {
        self.0.try_reserve(more)
    }

    /// The number of the line through two lattice points; a new line is added to `carriers`.
    pub(super) fn number(&mut self, ends: [[f64; 3]; 2], carriers: &mut Vec<Carrier>) -> u32 {
        let [a, b] = ends.map(|end| end.map(|c| c as i64));
        let arm: [i64; 3] = std::array::from_fn(|i| b[i] - a[i]);
        let size = |axis: usize| arm[axis].abs();
        let axis = (1..3).fold(0, |best, axis| if size(axis) > size(best) { axis } else { best });
        let common = arm.into_iter().fold(0, divisor).max(1);
        let first = arm.into_iter().find(|&c| c != 0).unwrap_or(1);
        let direction = arm.map(|c| c / common * first.signum());
        let moment = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let product = |j: usize, k: usize| i128::from(a[j]) * i128::from(direction[k]);
            product(j, k) - product(k, j)
        });
        *self.0.entry((direction, moment)).or_insert_with(|| {
            carriers.push(Carrier { axis, face: None });
            carriers.len() as u32 - 1
        })
    }
}

/// The greatest common divisor (Stein 1967: shifts and differences).
fn divisor(a: i64, b: i64) -> i64 {
    let (mut a, mut b) = (a.unsigned_abs(), b.unsigned_abs());
    if a == 0 || b == 0 {
        return (a | b) as i64;
    }
    let twos = (a | b).trailing_zeros();
    a >>= a.trailing_zeros();
    while b != 0 {
        b >>= b.trailing_zeros();
        (a, b) = (a.min(b), a.abs_diff(b));
    }
    (a << twos) as i64
}

/// A vertex of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct OutlineVertex {
    pub(super) vertex: u32,
    /// Whether the outline is straight at this vertex.
    pub(super) straight: bool,
}

/// Calls `triangle` n − 2 times for an outline of n vertices. The triangles have the outline's orientation
/// and fill the outline. No triangle has all its vertices on one side of the outline, so each triangle has
/// area.
///
/// Each edge of the outline belongs to one triangle. An outline of two vertices or fewer has no triangles.
pub(super) fn triangulate(outline: &[OutlineVertex], mut triangle: impl FnMut([u32; 3])) {
    let n = outline.len();
    let at = |k: usize| outline[k % n];
    let mut emit = |a: usize, b: usize, c: usize| triangle([a, b, c].map(|k| at(k).vertex));
    // A fan from a true corner would have flat triangles on an adjacent side that contains vertices. A fan
    // from a vertex inside a side has flat triangles only on that side.
    let first = (0..n).find(|&k| at(k).straight && !at(k + n - 1).straight);
    let apex = first.unwrap_or(0);
    // The number of edges to the end of the apex's side.
    let length = first.and_then(|apex| (1..n).find(|&k| !at(apex + k).straight)).unwrap_or(1);
    let mut next = apex + 1;
    if length > 1 && length + 1 < n {
        // The rest of that side is filled from the first vertex beyond it.
        next = apex + length + 1;
        (apex..apex + length).for_each(|k| emit(k, k + 1, next));
    }
    (next + 1..apex + n).for_each(|k| emit(apex, k - 1, k));
}

/// Two rounded coordinates are in their true order if they differ by more than this share of the larger
/// coordinate, plus [`POSITION_OFF`] for each coordinate. Each coordinate is off by at most three roundings
/// of its own size, and the difference by one rounding. Too small: wrong orders. Too large: integers decide
/// more cases.
const ERROR: f64 = 5.0 * f64::EPSILON;

/// The points of all lines.
pub(super) struct Points {
    /// Unites the nodes that are the same point.
    same: Union,
    /// A node of each point, line after line, in order along each line.
    pub(super) on_lines: Vec<Node>,
    /// For each edge, the places of its two ends in `on_lines`.
    pub(super) ends: Vec<[u32; 2]>,
}

/// An end of an edge, on the edge's line.
#[derive(Clone, Copy, Default)]
struct End {
    node: Node,
    /// Twice the edge's number; plus 1 for the edge's second end.
    slot: u32,
    rounded: f64,
}

impl Points {
    pub(super) fn new(survey: &Survey<'_>) -> Result<Self, Error> {
        let same = Union::new(survey.nodes() as u32)?;
        let mut points = Self { same, on_lines: Vec::new(), ends: Vec::new() };
        points.unite_corners(survey)?;
        let (mut all, starts) = by_line(survey)?;
        reserve(&mut points.ends, survey.edges.len())?;
        points.ends.resize(survey.edges.len(), [0; 2]);
        reserve(&mut points.on_lines, all.len() / 2)?;
        // Lines shared by faces come first: if corners were moved, the given edge decides, and not the faces
        // that share the edge.
        for shared in [true, false] {
            for (line, range) in starts.windows(2).enumerate() {
                if survey.carriers[line].face.is_none() == shared {
                    let ends = &mut all[range[0] as usize..range[1] as usize];
                    points.order(survey, line, ends)?;
                }
            }
        }
        Ok(points)
    }

    /// The node that represents a node's point: the least node of that point. The least node is a corner if
    /// any node of the point is a corner.
    pub(super) fn root(&self, node: Node) -> Node {
        self.same.root(node)
    }

    fn unite_corners(&mut self, survey: &Survey<'_>) -> Result<(), Error> {
        let faces = survey.faces;
        let mut known: HashMap<[u64; 3], Node> = HashMap::new();
        known.try_reserve(faces.corner_count() / 4).map_err(|_| Error::out_of_memory())?;
        for corner in survey.source.first_corner as u32..faces.corner_count() as u32 {
            let place = faces.given_corner(corner).map(f64::to_bits);
            known.try_reserve(1).map_err(|_| Error::out_of_memory())?;
            self.same.unite(*known.entry(place).or_insert(corner), corner);
        }
        Ok(())
    }

    /// Sorts the ends on one line, unites ends at the same place, and stores the places.
    fn order(&mut self, survey: &Survey<'_>, line: usize, ends: &mut [End]) -> Result<(), Error> {
        ends.sort_unstable_by(|a, b| compare(survey, line, a, b));
        reserve(&mut self.on_lines, ends.len())?;
        let mut last: Option<End> = None;
        // If corners of a face were moved, two ends that are one point on the given edges may have two places
        // on a line of the face.
        let is_one = |same: &Union, a: &End, b: &End| {
            same.root(a.node) == same.root(b.node) || compare(survey, line, a, b).is_eq()
        };
        for end in ends.iter() {
            match last {
                Some(last) if is_one(&self.same, &last, end) => {
                    self.same.unite(last.node, end.node);
                }
                _ => self.on_lines.push(end.node),
            }
            last = Some(*end);
            let place = self.on_lines.len() as u32 - 1;
            self.ends[end.slot as usize / 2][end.slot as usize % 2] = place;
        }
        Ok(())
    }
}

/// Compares two ends on a line by their [`coordinate`]s on that line, even if both ends are the same point.
/// So the order is total.
fn compare(survey: &Survey<'_>, line: usize, a: &End, b: &End) -> Ordering {
    let slack = ERROR * a.rounded.abs().max(b.rounded.abs()) + 2.0 * POSITION_OFF;
    // An unreliable rounded coordinate is NaN, and then no difference is large.
    if (a.rounded - b.rounded).abs() > slack {
        return a.rounded.total_cmp(&b.rounded);
    }
    if a.node == b.node || is_same_place(survey, line, a, b) {
        return Ordering::Equal;
    }
    let [a, b] = [a, b].map(|end| coordinate(survey, line, end.node));
    a.compare(&b)
}

/// Whether two ends on a line shared by faces are corners given in one place, or cuts by the same plane.
fn is_same_place(survey: &Survey<'_>, line: usize, a: &End, b: &End) -> bool {
    let plane = |(face, vertex_id): (u32, VertexId)| match vertex_id.kind() {
        VertexKind::OnEdge(_, plane) if !is_moved(survey, face) => Some(plane),
        _ => None,
    };
    survey.carriers[line].face.is_none()
        && match [a, b].map(|end| survey.cut(end.node)) {
            [None, None] => a.rounded == b.rounded,
            [Some(a), Some(b)] => plane(a).is_some() && plane(a) == plane(b),
            _ => false,
        }
}

fn is_moved(survey: &Survey<'_>, face: u32) -> bool {
    survey.faces.moved_axis(face).is_some()
}

/// The coordinate of a node on a line, along the line's axis.
///
/// On the line of a given edge, this is the coordinate of a given corner, or of the point where the plane
/// cuts the given edge. So all faces agree. On a line inside a face, this is the coordinate of the vertex on
/// the face's plane.
pub(super) fn coordinate(survey: &Survey<'_>, line: usize, node: Node) -> Fraction {
    let (faces, carrier) = (survey.faces, survey.carriers[line]);
    match (survey.cut(node), carrier.face) {
        (None, None) => Fraction::whole(faces.given_corner(node)[carrier.axis]),
        (None, Some(face)) => {
            let first = faces.corner_range(face).start as u32;
            faces.along(face, VertexId::corner(node - first), carrier.axis)
        }
        (Some((face, vertex_id)), None) => {
            let given = match vertex_id.kind() {
                VertexKind::OnEdge(k, plane) => faces.cut_of_segment(ends(faces, face, k), plane),
                _ => None,
            };
            // The plane may cut the moved edge and not the given edge; then the moved edge decides.
            given.map_or_else(
                || faces.along(face, vertex_id, carrier.axis),
                |cut| cut.along(carrier.axis),
            )
        }
        (Some((face, vertex_id)), Some(_)) => faces.along(face, vertex_id, carrier.axis),
    }
}

/// The ends of all edges, line by line, and the start of each line.
fn by_line(survey: &Survey<'_>) -> Result<(Vec<End>, Vec<u32>), Error> {
    let mut starts = Vec::new();
    reserve(&mut starts, survey.carriers.len() + 1)?;
    starts.resize(survey.carriers.len() + 1, 0_u32);
    survey.edges.iter().for_each(|edge| starts[edge.carrier as usize] += 2);
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut all = Vec::new();
    reserve(&mut all, 2 * survey.edges.len())?;
    all.resize(2 * survey.edges.len(), End::default());
    let places = rounded_places(survey)?;
    let faces = survey.faces;
    for range in survey.starts.windows(2) {
        let edges = &survey.edges[range[0] as usize..range[1] as usize];
        for (i, edge) in edges.iter().enumerate() {
            let carrier = survey.carriers[edge.carrier as usize];
            let to = edges[if i + 1 == edges.len() { 0 } else { i + 1 }].from;
            for (node, second) in [(edge.from, 0), (to, 1)] {
                let rounded = match survey.cut(node) {
                    None if carrier.face.is_none() => faces.given_corner(node)[carrier.axis],
                    None => faces.corner(node)[carrier.axis],
                    Some(_) => places[node as usize - faces.corner_count()][carrier.axis],
                };
                let moved = match (survey.cut(node), carrier.face) {
                    (Some((face, _)), _) | (None, Some(face)) => is_moved(survey, face),
                    (None, None) => false,
                };
                let rounded = if moved { f64::NAN } else { rounded };
                let start = &mut starts[edge.carrier as usize];
                *start -= 1;
                let slot = 2 * (range[0] + i as u32) + second;
                all[*start as usize] = End { node, slot, rounded };
            }
        }
    }
    Ok((all, starts))
}

/// The rounded position of each item of [`Survey::cuts`] on the item's face.
fn rounded_places(survey: &Survey<'_>) -> Result<Vec<[f64; 3]>, Error> {
    let mut places = Vec::new();
    reserve(&mut places, survey.cuts.len())?;
    let faces = survey.faces;
    places.extend(survey.cuts.iter().map(|&(face, vertex_id)| faces.position(face, vertex_id)));
    Ok(places)
}

#[cfg(test)]
mod points_tests;

#[cfg(test)]
mod tests {
    use super::{Names, PlaneId, VertexId};
    use crate::BspTree;
    use crate::exact::EdgeLine;

    #[test]
    fn a_face_with_many_cuts_does_not_slow_later_faces() {
        let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
        let tree = BspTree::build([0.0, 1.0, 2.0].map(square)).unwrap();
        let mut names = Names::default();
        names.enter(&tree.faces, 0).unwrap();
        for k in 0..100_000 {
            let plane = PlaneId::face(k);
            names.vertex_ids.insert(VertexId::crossing(EdgeLine::edge(0), plane), k);
            names.planes.insert(plane, k);
        }
        // The many entries may slow the next face, but no later face.
        (1..3).for_each(|face| names.enter(&tree.faces, face).unwrap());
        let room = names.vertex_ids.capacity() + names.planes.capacity();
        assert!(room < 1000, "room for {room} names is emptied for each face");
    }
}

#[cfg(test)]
mod lines_tests {
    use super::{Lines, divisor};

    #[test]
    fn edges_on_one_line_have_one_number() {
        let (mut lines, mut carriers) = (Lines::default(), Vec::new());
        let mut number = |a, b| lines.number([a, b], &mut carriers);
        let first = number([1.0, 2.0, 3.0], [3.0, 6.0, -1.0]);
        assert_eq!(number([3.0, 6.0, -1.0], [1.0, 2.0, 3.0]), first);
        assert_eq!(number([4.0, 8.0, -3.0], [-1.0, -2.0, 7.0]), first);
        assert_ne!(number([1.0, 2.0, 4.0], [3.0, 6.0, 0.0]), first);
        assert_ne!(number([1.0, 2.0, 3.0], [3.0, 6.0, -2.0]), first);
        assert_eq!(carriers.iter().map(|c| c.axis).collect::<Vec<_>>(), [1, 1, 2]);
    }

    #[test]
    fn divisors() {
        for (a, b, common) in [(0, 0, 0), (0, -6, 6), (12, 18, 6), (-35, 14, 7), (1 << 52, 3, 1)] {
            assert_eq!((divisor(a, b), divisor(b, a)), (common, common), "{a} {b}");
        }
    }
}

#[cfg(test)]
mod outline_tests {
    use super::{OutlineVertex, triangulate};
    use std::collections::HashSet;

    /// Outlines of integer points on the sides of polygons. Each side has 0 to 3 points inside it, in all
    /// combinations.
    #[test]
    fn triangles_have_area_and_each_edge_of_the_outline_once() {
        let shapes: [&[[i64; 2]]; 3] = [
            &[[0, 0], [12, 0], [0, 12]],
            &[[0, 0], [12, 0], [12, 12], [0, 12]],
            &[[0, 0], [12, 0], [24, 12], [12, 24], [0, 12]],
        ];
        let mut tried = 0;
        for shape in shapes {
            let sides = shape.len();
            for pattern in 0..4_usize.pow(sides as u32) {
                let mut points = Vec::new();
                for (side, a) in shape.iter().enumerate() {
                    let b = shape[(side + 1) % sides];
                    let inside = (pattern / 4_usize.pow(side as u32) % 4) as i64;
                    points.push((*a, false));
                    points.extend((1..=inside).map(|k| {
                        let part = |i: usize| a[i] + (b[i] - a[i]) * k / (inside + 1);
                        ([part(0), part(1)], true)
                    }));
                }
                for turned in 0..points.len() {
                    points.rotate_left(turned.min(1));
                    check(&points, shape);
                    tried += 1;
                }
            }
        }
        assert!(tried > 10_000, "{tried}");
    }

    fn check(points: &[([i64; 2], bool)], shape: &[[i64; 2]]) {
        let outline: Vec<OutlineVertex> = (0..)
            .zip(points)
            .map(|(vertex, &(_, straight))| OutlineVertex { vertex, straight })
            .collect();
        let (mut area, mut count, mut edges) = (0, 0, HashSet::new());
        triangulate(&outline, |triangle| {
            let [a, b, c] = triangle.map(|k| points[k as usize].0);
            let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(twice > 0, "{points:?}");
            (area, count) = (area + twice, count + 1);
            for k in 0..3 {
                let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
                assert!(edges.insert((from, to)), "{points:?}");
            }
        });
        let n = points.len() as u32;
        assert_eq!(count, n - 2);
        edges.retain(|&(a, b)| b != (a + 1) % n || n == 3 && a == b);
        // The edges left beside the outline occur in pairs.
        assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a)) || (b + 1) % n == a));
        assert_eq!(edges.len() as u32, 2 * (n - 3));
        let next = shape.iter().cycle().skip(1);
        let whole: i64 = shape.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        assert_eq!(area, whole);
    }
}
