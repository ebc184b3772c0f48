//! A kernel like that of other libraries: rounded vertices, rounded planes, an epsilon.

use std::cmp::Ordering;
use std::fmt::Debug;

use binspace::internals::{
    Eye, Faces, Kernel, Line, Piece, PlaneId, PlaneKind, Side, Symbol, Vertex,
};

/// The precision of a [`Float`] kernel.
pub trait Precision: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// Rounds a number to this precision.
    fn round(value: f64) -> f64;
}

impl Precision for f64 {
    #[inline]
    fn round(value: f64) -> f64 {
        value
    }
}

impl Precision for f32 {
    #[inline]
    fn round(value: f64) -> f64 {
        f64::from(value as f32)
    }
}

/// Decides by rounded distances and an epsilon; every operation is rounded to `T`.
///
/// It errs wherever distances are near the epsilon or the precision: the
/// [`Exact`](binspace::internals::Exact) kernel is the one to use, this one shows the difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Float<T> {
    epsilon: f64,
    precision: std::marker::PhantomData<T>,
}

impl<T> Float<T> {
    /// A kernel that treats vertices as on a plane if they are no further from it than `epsilon`
    /// times half the scene's extent.
    pub fn new(epsilon: f64) -> Self {
        Self { epsilon, precision: std::marker::PhantomData }
    }
}

impl<T: Precision> Default for Float<T> {
    /// An epsilon of 1e-5, in the middle of what other libraries use.
    fn default() -> Self {
        Self::new(1e-5)
    }
}

/// A plane with a unit normal.
#[derive(Clone, Copy, Debug)]
pub struct FloatSplitter<T> {
    plane: PlaneId,
    normal: [f64; 3],
    offset: f64,
    epsilon: f64,
    precision: std::marker::PhantomData<T>,
}

impl<T: Precision> FloatSplitter<T> {
    #[inline]
    fn distance(&self, p: [f64; 3]) -> f64 {
        let n = self.normal;
        let term = |i: usize| T::round(n[i] * p[i]);
        T::round(T::round(T::round(term(0) + term(1)) + term(2)) - self.offset)
    }

    #[inline]
    fn side(&self, position: [f64; 3]) -> Ordering {
        let s = self.distance(position);
        if s > self.epsilon {
            Ordering::Greater
        } else if s < -self.epsilon {
            Ordering::Less
        } else {
            Ordering::Equal
        }
    }
}

/// A rounded vertex; its definition is kept only to tell where it came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatVertex {
    position: [f64; 3],
    symbol: Symbol,
    line: Line,
}

impl Vertex for FloatVertex {
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

impl<T: Precision> Kernel for Float<T> {
    type Splitter = FloatSplitter<T>;
    type Vertex = FloatVertex;
    type Stored = FloatVertex;

    fn splitter(&self, faces: &Faces, plane: PlaneId) -> FloatSplitter<T> {
        let (normal, point) = match plane.kind() {
            PlaneKind::Axis(axis, corner) => {
                let mut normal = [0.0; 3];
                normal[axis] = 1.0;
                (normal, faces.corner(corner).map(T::round))
            }
            PlaneKind::Face(face) => {
                let triangle = faces.reference_triangle(face);
                let [p, q, r] = triangle.map(|c| faces.corner(c).map(T::round));
                // Scaled to at most 1, so that products stay within the range of f32.
                let edge = |x: [f64; 3]| -> [f64; 3] {
                    std::array::from_fn(|i| T::round((x[i] - p[i]) * f64::EPSILON))
                };
                let (u, w) = (edge(q), edge(r));
                let product = |a: f64, b: f64| T::round(a * b);
                let normal: [f64; 3] = std::array::from_fn(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    T::round(product(u[j], w[k]) - product(u[k], w[j]))
                });
                let [x, y, z] = normal.map(|c| product(c, c));
                let length = T::round(T::round(T::round(x + y) + z).sqrt());
                let unit = normal.map(|c| if length > 0.0 { T::round(c / length) } else { 0.0 });
                (unit, p)
            }
        };
        let term = |i: usize| T::round(normal[i] * point[i]);
        let offset = T::round(T::round(term(0) + term(1)) + term(2));
        let epsilon = self.epsilon * binspace::internals::LATTICE_LIMIT;
        FloatSplitter { plane, normal, offset, epsilon, precision: std::marker::PhantomData }
    }

    fn plane(splitter: &FloatSplitter<T>) -> PlaneId {
        splitter.plane
    }

    fn corner(&self, faces: &Faces, face: u32, k: u32) -> FloatVertex {
        let position = faces.corners(face)[k as usize].map(T::round);
        FloatVertex { position, symbol: Symbol::corner(k), line: Line::edge(k) }
    }

    #[inline]
    fn classify(
        &self,
        faces: &Faces,
        splitter: &FloatSplitter<T>,
        piece: Piece<'_, FloatVertex>,
    ) -> Side {
        if splitter.plane == PlaneId::face(piece.face) {
            return Side::Coplanar;
        }
        let (mut in_front, mut behind) = (false, false);
        let mut see = |position| {
            let side = splitter.side(position);
            in_front |= side.is_gt();
            behind |= side.is_lt();
        };
        match piece.cut {
            None => faces.corners(piece.face).iter().for_each(|&c| see(c.map(T::round))),
            Some(vertices) => vertices.iter().for_each(|vertex| see(vertex.position)),
        }
        match (in_front, behind) {
            (true, true) => Side::Spanning,
            (true, false) => Side::Front,
            (false, true) => Side::Back,
            (false, false) => Side::Coplanar,
        }
    }

    #[inline]
    fn side(
        &self,
        _: &Faces,
        splitter: &FloatSplitter<T>,
        _: u32,
        vertex: &FloatVertex,
    ) -> Ordering {
        splitter.side(vertex.position)
    }

    fn cut(
        &self,
        _: &Faces,
        splitter: &FloatSplitter<T>,
        _: u32,
        [from, to]: [&FloatVertex; 2],
    ) -> FloatVertex {
        let (a, b) = (splitter.distance(from.position), splitter.distance(to.position));
        let t = T::round(a / T::round(a - b));
        let position = std::array::from_fn(|i| {
            let (p, q) = (from.position[i], to.position[i]);
            T::round(p + T::round(T::round(q - p) * t))
        });
        let symbol = Symbol::crossing(from.line, splitter.plane);
        FloatVertex { position, symbol, line: from.line }
    }

    fn store(&self, vertex: &FloatVertex) -> FloatVertex {
        *vertex
    }

    fn restore(&self, _: &Faces, _: u32, stored: &FloatVertex) -> FloatVertex {
        *stored
    }

    fn symbol(stored: &FloatVertex) -> Symbol {
        stored.symbol
    }

    fn line(stored: &FloatVertex) -> Line {
        stored.line
    }

    fn eye_side(&self, faces: &Faces, plane: PlaneId, eye: &Eye) -> Ordering {
        let splitter = self.splitter(faces, plane);
        let (e, w) = eye.homogeneous();
        let n = splitter.normal;
        let s = n[0] * e[0] + n[1] * e[1] + n[2] * e[2] - w * splitter.offset;
        T::round(s).total_cmp(&0.0)
    }
}
