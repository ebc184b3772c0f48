//! The exact positions of planes and vertices, from their definitions, in big integers.
//!
//! Shares no arithmetic with the library: planes are coefficients, and vertices are computed as crossings of
//! segments or by Cramer's rule. Its input is the corners on the lattice, the corners that define each face's
//! plane, and the names of planes and vertices.

use binspace::internals::{Eye, Faces, PlaneId, PlaneKind, VertexId, VertexKind};
use dashu_int::IBig;
use num_traits::{One, Signed};

/// The plane normal · x = offset. In front of it, normal · x is larger.
#[derive(Clone, Debug)]
pub(crate) struct Plane {
    pub(crate) normal: [IBig; 3],
    offset: IBig,
}

impl Plane {
    /// A plane of the scene.
    pub(crate) fn of(faces: &Faces, id: PlaneId) -> Self {
        match id.kind() {
            PlaneKind::Axis(axis, corner) => {
                let mut normal = [IBig::ZERO, IBig::ZERO, IBig::ZERO];
                normal[axis] = IBig::one();
                Self { normal, offset: integer(faces.corner(corner)[axis]) }
            }
            PlaneKind::Face(face) => Self::of_face(faces, face),
        }
    }

    /// The plane of a face.
    pub(crate) fn of_face(faces: &Faces, face: u32) -> Self {
        Self::through(faces.reference_triangle(face).map(|c| faces.corner(c)))
    }

    /// The plane through three lattice points, by Newell's sums over their edges: below 2¹⁰⁷.
    fn through(points: [[f64; 3]; 3]) -> Self {
        let points = points.map(|point| point.map(|c| c as i128));
        let normal: [i128; 3] = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let edges = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (points[a], points[b]));
            edges.iter().map(|(a, b)| (a[j] - b[j]) * (a[k] + b[k])).sum()
        });
        let normal = normal.map(IBig::from);
        let offset = dot(&normal, &points[0].map(IBig::from));
        Self { normal, offset }
    }

    /// The plane through three places in homogeneous coordinates. A place of weight 0 is a direction of the
    /// plane. The coefficients are the minors of the three rows.
    pub(crate) fn joining([p, q, r]: [&[IBig; 4]; 3]) -> Self {
        let minor = |i: usize, j: usize, k: usize| {
            let of = |a: &IBig, b: &IBig, c: &IBig| {
                a * (&q[j] * &r[k] - &q[k] * &r[j]) - b * (&q[i] * &r[k] - &q[k] * &r[i])
                    + c * (&q[i] * &r[j] - &q[j] * &r[i])
            };
            of(&p[i], &p[j], &p[k])
        };
        Self { normal: [minor(1, 2, 3), -minor(0, 2, 3), minor(0, 1, 3)], offset: minor(0, 1, 2) }
    }

    /// The same plane with the opposite front.
    pub(crate) fn flipped(&self) -> Self {
        Self { normal: self.normal.each_ref().map(|c| -c), offset: -&self.offset }
    }

    /// The direction of the normal, in homogeneous coordinates.
    pub(crate) fn direction(&self) -> [IBig; 4] {
        let [x, y, z] = self.normal.clone();
        [x, y, z, IBig::ZERO]
    }

    /// The distance of a place times the length of the normal and the place's weight.
    pub(crate) fn at(&self, place: &Place) -> IBig {
        dot(&self.normal, &place.coordinates) - &self.offset * &place.weight
    }

    /// The value of the plane at an eye in homogeneous coordinates, positive in front: Ax + By + Cz + D, or
    /// Ax + By + Cz for a direction.
    pub(crate) fn at_eye(&self, eye: &[IBig; 4]) -> IBig {
        let [x, y, z, w] = eye;
        let [a, b, c] = &self.normal;
        a * x + b * y + c * z - &self.offset * w
    }

    /// The normal and the offset, each number rounded once.
    pub(crate) fn rounded(&self) -> ([f64; 3], f64) {
        (self.normal.each_ref().map(float), float(&self.offset))
    }

    /// The first of the axes along which the normal is longest.
    pub(crate) fn main_axis(&self) -> usize {
        let size = |axis: usize| self.normal[axis].abs();
        (1..3).fold(0, |best, axis| if size(axis) > size(best) { axis } else { best })
    }
}

/// An exact point: coordinates over a weight above 0.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    coordinates: [IBig; 3],
    weight: IBig,
}

impl Place {
    /// The position of a vertex of a face; `None` if the planes that define the vertex are parallel. `plane`
    /// is the plane of the face.
    pub(crate) fn of(faces: &Faces, face: u32, plane: &Plane, vertex: VertexId) -> Option<Self> {
        match vertex.kind() {
            VertexKind::Corner(k) => Some(Self::corner(faces, face, plane, k as usize)),
            VertexKind::OnEdge(k, by) => {
                let (k, len) = (k as usize, faces.corners(face).len());
                let ends = [k, (k + 1) % len].map(|k| Self::corner(faces, face, plane, k));
                Self::crossing(&ends, &Plane::of(faces, by))
            }
            VertexKind::Inside(g, h) => {
                Self::meeting([plane, &Plane::of(faces, g), &Plane::of(faces, h)])
            }
        }
    }

    /// Corner `k` of a face. A corner off the face's plane is moved onto the plane along the plane's main
    /// axis.
    pub(crate) fn corner(faces: &Faces, face: u32, plane: &Plane, k: usize) -> Self {
        let point = faces.corners(face)[k];
        let mut place = Self { coordinates: point.map(integer), weight: IBig::one() };
        if faces.reference_triangle(face).iter().any(|&c| faces.corner(c) == point) {
            return place;
        }
        let off = plane.at(&place);
        if off.is_zero() {
            return place;
        }
        let axis = plane.main_axis();
        place.coordinates = place.coordinates.map(|c| c * &plane.normal[axis]);
        place.coordinates[axis] -= off;
        place.weight = plane.normal[axis].clone();
        place.with_positive_weight()
    }

    /// The point in which a segment meets a plane: the mean of both ends, each weighted by the value of the
    /// plane at the other end.
    fn crossing([a, b]: &[Self; 2], plane: &Plane) -> Option<Self> {
        let (at_a, at_b) = (plane.at(a), plane.at(b));
        let mean = |of_a: &IBig, of_b: &IBig| &at_a * of_b - &at_b * of_a;
        let weight = mean(&a.weight, &b.weight);
        let coordinates = std::array::from_fn(|i| mean(&a.coordinates[i], &b.coordinates[i]));
        (!weight.is_zero()).then(|| Self { coordinates, weight }.with_positive_weight())
    }

    /// The point in which three planes meet, by Cramer's rule.
    pub(crate) fn meeting([f, g, h]: [&Plane; 3]) -> Option<Self> {
        let pairs = [(g, h), (h, f), (f, g)].map(|(a, b)| cross(&a.normal, &b.normal));
        let weight = dot(&f.normal, &pairs[0]);
        if weight.is_zero() {
            return None;
        }
        let offsets = [&f.offset, &g.offset, &h.offset];
        let coordinates = std::array::from_fn(|i| {
            offsets[0] * &pairs[0][i] + offsets[1] * &pairs[1][i] + offsets[2] * &pairs[2][i]
        });
        Some(Self { coordinates, weight }.with_positive_weight())
    }

    fn with_positive_weight(self) -> Self {
        if self.weight.is_positive() {
            return self;
        }
        Self { coordinates: self.coordinates.map(|c| -c), weight: -self.weight }
    }

    /// The coordinates and the weight.
    pub(crate) fn homogeneous(&self) -> [IBig; 4] {
        let [x, y, z] = self.coordinates.clone();
        [x, y, z, self.weight.clone()]
    }

    /// The factor by which [`Plane::at`] multiplies distances of this place.
    pub(crate) fn weight(&self) -> &IBig {
        &self.weight
    }

    /// The numerators of the two coordinates that follow an axis, in cyclic order.
    pub(crate) fn along(&self, axis: usize) -> [&IBig; 2] {
        [&self.coordinates[(axis + 1) % 3], &self.coordinates[(axis + 2) % 3]]
    }

    /// The point, each coordinate within three roundings.
    pub(crate) fn rounded(&self) -> [f64; 3] {
        let weight = float(&self.weight);
        self.coordinates.each_ref().map(|c| float(c) / weight)
    }

    /// The largest difference between the coordinates of a position and of this point, within a few
    /// roundings. It is infinite if the position is NaN or further away than any useful error.
    pub(crate) fn drift(&self, position: [f64; 3]) -> f64 {
        let weight = float(&self.weight);
        let off = |i: usize| {
            if position[i].is_nan() || position[i].abs() > REACH {
                return f64::INFINITY;
            }
            // The difference from the whole part is exact, and small enough to be rounded.
            let whole = position[i].trunc();
            let rest = integer(whole) * &self.weight - &self.coordinates[i];
            ((position[i] - whole) + float(&rest) / weight).abs()
        };
        (0..3).map(off).fold(0.0, f64::max)
    }
}

/// An eye in homogeneous coordinates: the point and 1, or the direction towards it and 0.
pub(crate) fn eye(eye: &Eye) -> [IBig; 4] {
    let [x, y, z] = eye.integer().map(|c| IBig::from(c) << eye.shift().unwrap_or(0) as usize);
    [x, y, z, u8::from(eye.shift().is_some()).into()]
}

/// A larger coordinate counts as infinite. Rounded trees can have vertices at any distance, and 256 extents
/// are beyond any useful error.
const REACH: f64 = (1u64 << 59) as f64;

/// A whole number below 2⁶³.
fn integer(value: f64) -> IBig {
    IBig::from(value as i64)
}

fn float(value: &IBig) -> f64 {
    value.to_f64().value()
}

fn dot(a: &[IBig; 3], b: &[IBig; 3]) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &[IBig; 3], b: &[IBig; 3]) -> [IBig; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}
