//! The cone of rays from an eye through a face.

use binspace::internals::{Faces, PlaneId, VertexId};
use dashu_int::IBig;
use num_traits::Signed;

use crate::place::{Place, Plane};

/// A point or a plane in homogeneous coordinates. The weight of a point is not negative. Points in front of a
/// plane have a positive product with it.
type Quad = [IBig; 4];

/// A face as an eye sees it.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    corners: Vec<Quad>,
    /// The face's plane, with the eye in front.
    plane: Quad,
    /// The planes through the eye and each edge, with the face in front. The region in front of all of them
    /// is the cone of rays from the eye through the face. It contains nothing behind the eye, because the eye
    /// is its apex.
    sides: Vec<Quad>,
}

impl Seen {
    /// Returns `None` for a face that the eye sees edge-on, because no ray goes through its inside.
    pub(super) fn new(faces: &Faces, face: u32, eye: &Quad) -> Option<Self> {
        let plane = Plane::of(faces, PlaneId::face(face));
        let count = faces.corners(face).len() as u32;
        let corners: Vec<Quad> = (0..count)
            .filter_map(|k| Place::of(faces, face, &plane, VertexId::corner(k)))
            .map(|place| place.homogeneous())
            .collect();
        let triangle = faces.reference_triangle(face).map(|c| faces.corner(c));
        let [p, q, r] = triangle.map(|[x, y, z]| [x, y, z, 1.0].map(|c| IBig::from(c as i64)));
        let plane = through(&p, &q, &r);
        let side = product(&plane, eye);
        if side.is_zero() {
            return None;
        }
        let plane = if side.is_negative() { negative(plane) } else { plane };
        let sides = (0..corners.len()).map(|k| {
            let next = &corners[(k + 1) % corners.len()];
            let side = through(&corners[k], next, eye);
            let behind = corners.iter().any(|corner| product(&side, corner).is_negative());
            if behind { negative(side) } else { side }
        });
        let sides = sides.collect();
        Some(Self { corners, plane, sides })
    }

    /// Whether this face hides a part of another face, and whether the other face hides a part of this face.
    pub(super) fn against(&self, other: &Self) -> [bool; 2] {
        let part = self.within(other);
        let sides = || part.iter().map(|vertex| product(&other.plane, vertex));
        [sides().any(|d| d.is_positive()), sides().any(|d| d.is_negative())]
    }

    /// The vertices of the part of this face that is seen through another face; an empty list if this part
    /// has no inside.
    pub(super) fn within(&self, other: &Self) -> Vec<Quad> {
        let mut part = self.corners.clone();
        for side in &other.sides {
            let at: Vec<IBig> = part.iter().map(|vertex| product(side, vertex)).collect();
            // A convex polygon with a corner inside has an area there.
            if !at.iter().any(Signed::is_positive) {
                return Vec::new();
            }
            if at.iter().any(Signed::is_negative) {
                part = front(&part, &at);
            }
        }
        part
    }
}

/// The part of a polygon in front of a plane, given the plane's product with each vertex.
fn front(polygon: &[Quad], at: &[IBig]) -> Vec<Quad> {
    let mut kept = Vec::new();
    for (i, here) in polygon.iter().enumerate() {
        let k = (i + 1) % polygon.len();
        if !at[i].is_negative() {
            kept.push(here.clone());
        }
        if at[i].is_positive() && at[k].is_negative() || at[i].is_negative() && at[k].is_positive()
        {
            let (a, b) = (at[i].abs(), at[k].abs());
            kept.push(std::array::from_fn(|c| &here[c] * &b + &polygon[k][c] * &a));
        }
    }
    kept
}

/// The plane through three points.
pub(super) fn through(p: &Quad, q: &Quad, r: &Quad) -> Quad {
    // The determinant of the three points and a fourth point is a linear function of the fourth point; these
    // are its coefficients.
    let minor = |[a, b, c]: [usize; 3]| {
        let pair = |i: usize, j: usize| &q[i] * &r[j] - &q[j] * &r[i];
        &p[a] * pair(b, c) + &p[b] * pair(c, a) + &p[c] * pair(a, b)
    };
    [-minor([1, 2, 3]), minor([0, 2, 3]), -minor([0, 1, 3]), minor([0, 1, 2])]
}

pub(super) fn product(plane: &Quad, point: &Quad) -> IBig {
    plane.iter().zip(point).map(|(a, b)| a * b).sum()
}

fn negative(plane: Quad) -> Quad {
    plane.map(|c| -c)
}
