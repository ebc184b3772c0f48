//! The exact kernel: a certified floating-point filter, and integers where it cannot tell.

use std::cmp::Ordering;

use super::exact::Plane;
use super::kernel::{Kernel, Piece, Side, Vertex};
use super::label::{Line, PlaneId, PlaneKind, Symbol};
use super::lattice::LIMIT;
use super::{Eye, Faces};

/// Decides exactly, at about the price of an epsilon.
///
/// A piece is held against a plane by these rules, in which τ is the coplanar tolerance and a
/// *corner* is one of the uncut face's:
///
/// - if no corner is further than τ from the plane, the piece is coplanar;
/// - if corners are further than τ in front, but none behind, the piece is in front, and likewise
///   behind: it is not cut for less than τ;
/// - else the exact signs of its own vertices decide, and it is cut where they differ.
///
/// With τ = 0 there is no tolerance left: every decision is that of real arithmetic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact;

/// A plane ready for the filter.
#[derive(Clone, Copy, Debug)]
pub struct ExactSplitter {
    plane: PlaneId,
    normal: [f64; 3],
    offset: f64,
    /// What the rounded distance of a rounded vertex may be off by.
    bound: f64,
    /// The tolerance times the length of the normal, rounded down to an integer.
    band: f64,
}

impl ExactSplitter {
    /// The plane.
    pub(crate) fn plane(&self) -> PlaneId {
        self.plane
    }

    #[inline]
    fn distance(&self, p: [f64; 3]) -> f64 {
        let n = self.normal;
        n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - self.offset
    }
}

/// A vertex with its rounded position.
#[derive(Clone, Copy, Debug)]
pub struct ExactVertex {
    position: [f64; 3],
    symbol: Symbol,
    line: Line,
}

/// A vertex by its definition alone: the position is computed anew whenever it is asked for, and
/// so costs no memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExactStored {
    symbol: Symbol,
    line: Line,
}

impl Vertex for ExactVertex {
    #[inline]
    fn position(&self) -> [f64; 3] {
        self.position
    }
    fn symbol(&self) -> Symbol {
        self.symbol
    }
    #[inline]
    fn line(&self) -> Line {
        self.line
    }
    #[inline]
    fn with_line(self, line: Line) -> Self {
        Self { line, ..self }
    }
}

/// What a position kept in `f64` may be off by in each coordinate, in lattice units: three
/// roundings of at most 2⁻⁵³ of a coordinate of at most 2⁵¹ come to 0.75 (see
/// [`Faces::position`]); a corner moved onto its face's plane is rounded to an integer as well.
const POSITION_ERROR: f64 = 1.5;

/// The error of a face's plane at a rounded vertex, for each unit of
/// π = Σ over components of |u_j w_k| + |u_k w_j|.
///
/// With ε = 2⁻⁵³, m the largest coordinate, u and w the exact edges of the triangle, n their
/// rounded product, v the rounded vertex and p the point on the plane:
///
/// - each component of n is off by at most 2.01 ε times its share of π, and |v − p| ≤ 2 m: 4.02 επm;
/// - n·v and n·p are rounded by at most 3.01 ε |n|₁ m each, their difference, below 2 |n|₁ m, by
///   ε times that, and |n|₁ ≤ π (1 + 2.01 ε): 8.1 επm together;
/// - v is off by `POSITION_ERROR` in each coordinate: π (1 + 2.01 ε) times that.
///
/// That is 12.2 επm + 1.5 π; 16 and 1.01 leave room for the rounding of π and of the bound itself.
/// Smaller, and wrong decisions pass; larger, and integers decide what floats could.
const FACE_ERROR: f64 = 16.0 * (f64::EPSILON / 2.0) * LIMIT + 1.01 * POSITION_ERROR;

/// The error of an axis-aligned plane at a rounded vertex: the vertex's own, and the rounding of
/// one subtraction.
const AXIS_ERROR: f64 = POSITION_ERROR + 1.0;

impl Kernel for Exact {
    const IS_EXACT: bool = true;
    type Splitter = ExactSplitter;
    type Vertex = ExactVertex;
    type Stored = ExactStored;

    fn splitter(&self, faces: &Faces, plane: PlaneId) -> ExactSplitter {
        match plane.kind() {
            PlaneKind::Axis(axis, corner) => {
                let mut normal = [0.0; 3];
                normal[axis] = 1.0;
                let offset = faces.corner(corner)[axis];
                let band = faces.tolerance().floor();
                ExactSplitter { plane, normal, offset, bound: AXIS_ERROR, band }
            }
            PlaneKind::Face(face) => {
                let [p, q, r] = faces.reference_triangle(face).map(|c| faces.corner(c));
                let (mut normal, mut size) = ([0.0; 3], 0.0);
                for (i, component) in normal.iter_mut().enumerate() {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    let a = (q[j] - p[j]) * (r[k] - p[k]);
                    let b = (q[k] - p[k]) * (r[j] - p[j]);
                    *component = a - b;
                    size += a.abs() + b.abs();
                }
                let [x, y, z] = normal;
                let offset = x * p[0] + y * p[1] + z * p[2];
                let band = (faces.tolerance() * (x * x + y * y + z * z).sqrt()).floor();
                ExactSplitter { plane, normal, offset, bound: FACE_ERROR * size, band }
            }
        }
    }

    #[inline]
    fn distance(splitter: &ExactSplitter, position: [f64; 3]) -> f64 {
        splitter.distance(position)
    }

    #[inline]
    fn slack(splitter: &ExactSplitter) -> f64 {
        splitter.bound + splitter.band
    }

    fn corner(&self, faces: &Faces, face: u32, k: u32) -> ExactVertex {
        let symbol = Symbol::corner(k);
        ExactVertex { position: faces.position(face, symbol), symbol, line: Line::edge(k) }
    }

    #[inline]
    fn classify(
        &self,
        faces: &Faces,
        splitter: &ExactSplitter,
        piece: Piece<'_, ExactVertex>,
    ) -> Side {
        if splitter.plane == PlaneId::face(piece.face) {
            return Side::Coplanar;
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut see = |position| {
            let s = splitter.distance(position);
            low = low.min(s);
            high = high.max(s);
        };
        match piece.cut {
            None => faces.corners(piece.face).iter().for_each(|&corner| see(corner)),
            Some(vertices) => vertices.iter().for_each(|vertex| see(vertex.position)),
        }
        let (near, far) = (splitter.bound, splitter.band + splitter.bound);
        // A whole face may reach behind by the tolerance and still be in front; a piece of one
        // may not, unless all of its face does.
        let allowed = if piece.cut.is_none() { near - splitter.band } else { near };
        if high > far && low >= allowed {
            Side::Front
        } else if low < -far && high <= -allowed {
            Side::Back
        } else if high > far && low < -far {
            Side::Spanning
        } else {
            classify_exactly(faces, splitter, piece)
        }
    }

    #[inline]
    fn side(
        &self,
        faces: &Faces,
        splitter: &ExactSplitter,
        face: u32,
        vertex: &ExactVertex,
    ) -> Ordering {
        compare(faces, splitter, face, vertex.symbol, vertex.position, 0.0)
    }

    fn cut(
        &self,
        faces: &Faces,
        splitter: &ExactSplitter,
        face: u32,
        [from, _]: [&ExactVertex; 2],
    ) -> ExactVertex {
        let symbol = Symbol::crossing(from.line, splitter.plane);
        ExactVertex { position: faces.position(face, symbol), symbol, line: from.line }
    }

    fn store(&self, vertex: &ExactVertex) -> ExactStored {
        ExactStored { symbol: vertex.symbol, line: vertex.line }
    }

    fn restore(&self, faces: &Faces, face: u32, stored: &ExactStored) -> ExactVertex {
        let ExactStored { symbol, line } = *stored;
        ExactVertex { position: faces.position(face, symbol), symbol, line }
    }

    fn symbol(stored: &ExactStored) -> Symbol {
        stored.symbol
    }

    fn line(stored: &ExactStored) -> Line {
        stored.line
    }

    fn eye_side(&self, faces: &Faces, plane: PlaneId, eye: &Eye) -> Ordering {
        match plane.kind() {
            PlaneKind::Axis(axis, corner) => Plane::axis_at_eye(axis, faces.corner(corner), eye),
            PlaneKind::Face(_) => faces.plane(plane).at_eye(eye),
        }
    }
}

/// How a vertex's distance from a plane compares with a threshold: by the filter where it can
/// tell, else by integers.
#[inline]
fn compare(
    faces: &Faces,
    splitter: &ExactSplitter,
    face: u32,
    vertex: Symbol,
    position: [f64; 3],
    threshold: f64,
) -> Ordering {
    let excess = splitter.distance(position) - threshold;
    // The threshold is exact, and so large a difference of two nearby numbers loses at most an
    // ulp of the larger: the bound has room for it.
    if excess > splitter.bound {
        Ordering::Greater
    } else if excess < -splitter.bound {
        Ordering::Less
    } else {
        faces.compare(&faces.plane(splitter.plane), face, vertex, threshold)
    }
}

/// The rules of [`Exact`], every comparison certified.
#[cold]
fn classify_exactly(
    faces: &Faces,
    splitter: &ExactSplitter,
    piece: Piece<'_, ExactVertex>,
) -> Side {
    let face = piece.face;
    let corners = faces.corners(face);
    let corner = |k: usize, threshold| {
        compare(faces, splitter, face, Symbol::corner(k as u32), corners[k], threshold)
    };
    let count = corners.len();
    let band = splitter.band;
    let in_front = (0..count).any(|k| corner(k, band).is_gt());
    let behind = (0..count).any(|k| corner(k, -band).is_lt());
    match (in_front, behind) {
        (false, false) => return Side::Coplanar,
        (true, false) => return Side::Front,
        (false, true) => return Side::Back,
        (true, true) => {}
    }
    let Some(vertices) = piece.cut else { return Side::Spanning };
    let (mut in_front, mut behind) = (false, false);
    for vertex in vertices {
        match compare(faces, splitter, face, vertex.symbol, vertex.position, 0.0) {
            Ordering::Greater => in_front = true,
            Ordering::Less => behind = true,
            Ordering::Equal => {}
        }
    }
    match (in_front, behind) {
        (true, true) => Side::Spanning,
        (true, false) => Side::Front,
        (false, true) => Side::Back,
        // A piece has three vertices that are not on one line, and its face is not coplanar.
        (false, false) => Side::Coplanar,
    }
}
