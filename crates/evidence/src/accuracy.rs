//! Compares a tree's fragments with their exact definitions.

use dashu_int::IBig;
use num_traits::{FromPrimitive, Zero};

use crate::place::{Place, Plane};
use crate::residue::{Residue, twice_area};
use crate::tree::{self, Node, Tree};
use binspace::internals::{Faces, PlaneId, PlaneKind, Side, VertexId};

/// The errors of the vertices of a tree's fragments; see [`accuracy`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Accuracy {
    /// Vertices of all fragments.
    pub vertices: usize,
    /// Vertices that, by more than the tolerance, lie on the wrong side of a partition plane above their
    /// fragment, or off the plane on which their fragment was put. Their exact definitions decide.
    pub misplaced: usize,
    /// Vertices without a position, because the planes that define them are parallel.
    pub undefined: usize,
    /// Faces whose area differs from the sum of the areas of their fragments. Areas are computed from the
    /// exact definitions of the vertices. A difference is missed with a probability of 2⁻⁶¹.
    pub torn: usize,
    /// The largest difference between a vertex's coordinate and the exact coordinate, in steps of the scene's
    /// lattice. A step is 2⁻⁵² to 2⁻⁵⁰ of the extent: the unit in the last place of a coordinate at the
    /// scene's boundary.
    pub drift_max: f64,
    /// The largest difference of the three coordinates of a vertex, averaged over all vertices, in steps of
    /// the lattice.
    pub drift_mean: f64,
}

/// A partition plane above a fragment, and the side on which the fragment was put.
struct Above {
    id: PlaneId,
    plane: Plane,
    /// The plane, each number rounded once.
    normal: [f64; 3],
    offset: f64,
    /// The tolerance times the length of the normal, a whole number.
    band: f64,
    side: Side,
}

/// The exact position of a vertex.
struct Vertex {
    vertex_id: VertexId,
    place: Place,
    /// The position, each coordinate within three roundings.
    rounded: [f64; 3],
}

/// Compares the position of every vertex with its definition, and the definition with every partition plane
/// above the fragment, exactly. Takes O(n · mean depth) time.
///
/// The library's tree misplaces nothing, and its vertices are off only by their last rounding. This function
/// computes planes and vertices in its own big integers, behind its own filter. So a mistake in the library's
/// arithmetic is counted and not repeated. Tests repeat the counts in rationals, on hard scenes of up to some
/// hundred faces.
pub fn accuracy(tree: &Tree) -> Accuracy {
    let mut count = Count::new(&tree.faces);
    let mut path: Vec<Above> = Vec::new();
    for node in &tree.nodes {
        extend_path(&tree.faces, &mut path, node);
        let leaf = |side: &tree::Side| match side {
            tree::Side::Leaf(fragments) => fragments.clone(),
            tree::Side::Node(_) => 0..0,
        };
        let (on, front, back) = (node.on.clone(), leaf(&node.front), leaf(&node.back));
        for (range, side) in [(on, Side::Coplanar), (front, Side::Front), (back, Side::Back)] {
            if let Some(last) = path.last_mut() {
                last.side = side;
            }
            range.for_each(|fragment| count.judge(tree, fragment, &path));
        }
    }
    count.finish()
}

fn extend_path(faces: &Faces, path: &mut Vec<Above>, node: &Node) {
    path.truncate(node.depth - 1);
    if let Some(parent) = path.last_mut() {
        parent.side = if node.is_front { Side::Front } else { Side::Back };
    }
    path.push(Above::new(faces, node.plane));
}

/// The counts of the faces visited.
struct Count<'a> {
    faces: &'a Faces,
    result: Accuracy,
    drift_sum: f64,
    /// For each face, the sum of its fragments' areas; `None` if a vertex has no position.
    areas: Vec<Option<Residue>>,
}

impl<'a> Count<'a> {
    fn new(faces: &'a Faces) -> Self {
        let areas = vec![Some(Residue::ZERO); faces.len()];
        Self { faces, result: Accuracy::default(), drift_sum: 0.0, areas }
    }

    fn judge(&mut self, tree: &Tree, fragment: u32, path: &[Above]) {
        let face = tree.face(fragment);
        let id = PlaneId::face(face);
        let plane = Plane::of(self.faces, id);
        let axis = plane.main_axis();
        let mut outline = Some(Vec::new());
        for (vertex_id, position) in tree.vertex_ids(fragment).zip(tree.lattice_vertices(fragment))
        {
            self.result.vertices += 1;
            let Some(place) = Place::of(self.faces, face, &plane, vertex_id) else {
                self.result.undefined += 1;
                outline = None;
                continue;
            };
            let drift = place.drift(position);
            self.drift_sum += drift;
            self.result.drift_max = self.result.drift_max.max(drift);
            let point = Residue::place(&place, axis);
            outline = outline.zip(point).map(|(mut outline, point)| {
                outline.push(point);
                outline
            });
            let vertex = Vertex { vertex_id, rounded: place.rounded(), place };
            let is_wrong = path.iter().any(|above| above.has_misplaced(id, &vertex));
            self.result.misplaced += usize::from(is_wrong);
        }
        let sum = &mut self.areas[face as usize];
        *sum = sum.zip(outline).map(|(sum, outline)| sum.plus(twice_area(&outline)));
    }

    /// Twice a face's own area, seen along its plane's main axis.
    fn area(&self, face: u32) -> Option<Residue> {
        let plane = Plane::of(self.faces, PlaneId::face(face));
        let axis = plane.main_axis();
        let corners = (0..self.faces.corners(face).len() as u32).map(VertexId::corner);
        let point = |corner| Residue::place(&Place::of(self.faces, face, &plane, corner)?, axis);
        let outline: Option<Vec<_>> = corners.map(point).collect();
        outline.map(|outline| twice_area(&outline))
    }

    fn finish(self) -> Accuracy {
        let torn = (0..).zip(&self.areas).filter(|&(face, &sum)| sum != self.area(face)).count();
        let drift_mean = self.drift_sum / self.result.vertices.max(1) as f64;
        Accuracy { torn, drift_mean, ..self.result }
    }
}

/// The largest error of a rounded distance from a plane, per unit of the sum of the magnitudes of its terms
/// n₀x₀, n₁x₁, n₂x₂, the offset and the threshold. In units of 2⁻⁵³, a conversion from a big integer has an
/// error of at most 2. A coordinate is the quotient of two conversions: 5. A component of the normal is one
/// conversion: 2. The product of both: 8. The four sums that follow add 4. The rest covers the rounding of
/// the sum of magnitudes, and terms of second order.
const ERROR: f64 = 16.0 * (f64::EPSILON / 2.0);

impl Above {
    fn new(faces: &Faces, id: PlaneId) -> Self {
        let plane = Plane::of(faces, id);
        let (normal, offset) = plane.rounded();
        let length = match id.kind() {
            PlaneKind::Face(_) => normal.map(|c| c * c).iter().sum::<f64>().sqrt(),
            PlaneKind::Axis(..) => 1.0,
        };
        let band = (faces.tolerance() * length).floor();
        Self { id, plane, normal, offset, band, side: Side::Coplanar }
    }

    /// Whether the exact position of a vertex contradicts the sides on which its fragment was put. `own` is
    /// the plane of the fragment's face.
    fn has_misplaced(&self, own: PlaneId, vertex: &Vertex) -> bool {
        if self.id == own {
            return self.side != Side::Coplanar;
        }
        // A vertex lies on the planes that define it.
        if vertex.vertex_id.is_on(self.id) {
            return false;
        }
        match self.side {
            Side::Front => self.is_beyond(vertex, -1.0),
            Side::Back => self.is_beyond(vertex, 1.0),
            Side::Coplanar | Side::Spanning => {
                self.is_beyond(vertex, 1.0) || self.is_beyond(vertex, -1.0)
            }
        }
    }

    /// Whether a vertex is further from the plane than the tolerance: in front, if `sign` is 1, or
    /// behind, if it is −1.
    fn is_beyond(&self, vertex: &Vertex, sign: f64) -> bool {
        let terms: [f64; 3] = std::array::from_fn(|i| self.normal[i] * vertex.rounded[i]);
        let distance = terms[0] + terms[1] + terms[2] - self.offset;
        let size = terms.map(f64::abs).iter().sum::<f64>() + self.offset.abs() + self.band;
        let excess = sign * distance - self.band;
        if excess.abs() > ERROR * size {
            return excess > 0.0;
        }
        let distance = self.plane.at(&vertex.place);
        let distance = if sign < 0.0 { -distance } else { distance };
        let band = IBig::from_f64(self.band).unwrap_or_else(IBig::zero);
        distance > band * vertex.place.weight()
    }
}
