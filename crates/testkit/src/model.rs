//! The library's faces and pieces in exact rationals, by separate formulas: planes by their coefficients,
//! vertices as crossings of segments and by Cramer's rule, pieces by Sutherland–Hodgman.

use super::rational::{self, Plane, Point, Rational};
use super::vector;
use binspace::internals::{EdgeLine, Faces, PlaneId, PlaneKind, Side, VertexId, VertexKind};
use std::cmp::Ordering;

/// A vertex of a piece, and the line that bounds the piece from it to the next.
#[derive(Clone, Debug)]
pub struct Vertex {
    pub point: Point,
    pub line: EdgeLine,
}

/// A face in rationals.
#[derive(Clone, Debug)]
pub struct Face {
    pub plane: Plane,
    pub corners: Vec<Point>,
    /// Whether the tolerance moved a corner onto the plane.
    pub moved: bool,
}

impl Face {
    pub fn new(faces: &Faces, face: u32) -> Self {
        let plane = plane(faces, PlaneId::face(face));
        let mut corners: Vec<Point> = faces.corners(face).iter().map(|&c| lattice(c)).collect();
        let moved = corners.iter().any(|corner| rational::sign(&plane.at(corner)).is_ne());
        let axis = main_axis(&plane);
        for corner in &mut corners {
            // The point where the line through the corner along the axis meets the plane.
            let step = plane.at(corner) / &plane.normal[axis];
            corner[axis] -= step;
        }
        Self { plane, corners, moved }
    }

    /// Returns the whole face as a piece.
    pub fn outline(&self) -> Vec<Vertex> {
        let lines = (0..).map(EdgeLine::edge);
        self.corners.iter().zip(lines).map(|(c, line)| Vertex { point: c.clone(), line }).collect()
    }

    /// Returns the point that has a name.
    pub fn resolve(&self, faces: &Faces, vertex_id: VertexId) -> Point {
        match vertex_id.kind() {
            VertexKind::Corner(k) => self.corners[k as usize].clone(),
            VertexKind::OnEdge(k, by) => {
                let k = k as usize;
                let ends = [&self.corners[k], &self.corners[(k + 1) % self.corners.len()]];
                let by = plane(faces, by);
                let values = ends.map(|end| by.at(end));
                rational::crossing(ends, [&values[0], &values[1]])
            }
            VertexKind::Inside(g, h) => {
                rational::meeting(&self.plane, &plane(faces, g), &plane(faces, h))
            }
        }
    }

    /// Returns whether a point of the plane is inside the outline, on it, or outside.
    pub fn place(&self, point: &Point) -> Ordering {
        let next = self.corners.iter().cycle().skip(1);
        let turn = |(a, b): (&Point, &Point)| {
            let turn =
                rational::product(&rational::difference(b, a), &rational::difference(point, a));
            rational::sign(&rational::scalar(&turn, &self.plane.normal))
        };
        self.corners.iter().zip(next).map(turn).min().expect("corners")
    }

    /// Returns every answer that the rules of the library allow. There is one answer, unless the distance of
    /// a corner from the plane equals the tolerance up to rounding.
    pub fn classify(
        &self,
        (faces, face): (&Faces, u32),
        (id, by): (PlaneId, &Plane),
        vertices: &[Rational],
    ) -> Vec<Side> {
        if id == PlaneId::face(face) {
            return vec![Side::Coplanar];
        }
        let values: Vec<Rational> = self.corners.iter().map(|corner| by.at(corner)).collect();
        let [low, high] = band(faces.tolerance(), by);
        let beyond = |limit: &Rational, sign: i32| {
            let sign = Rational::from(sign);
            values.iter().any(|value| &(value * &sign) > limit)
        };
        let either = |sign| {
            let (far, near) = (beyond(&high, sign), beyond(&low, sign));
            if far == near { vec![far] } else { vec![far, near] }
        };
        let mut allowed = Vec::new();
        for in_front in either(1) {
            for &behind in &either(-1) {
                let side = match (in_front, behind) {
                    (false, false) => Side::Coplanar,
                    (true, false) => Side::Front,
                    (false, true) => Side::Back,
                    (true, true) => by_vertices(vertices),
                };
                allowed.push(side);
            }
        }
        allowed
    }
}

fn by_vertices(values: &[Rational]) -> Side {
    let has = |side| values.iter().any(|value| rational::sign(value) == side);
    match (has(Ordering::Greater), has(Ordering::Less)) {
        (true, true) => Side::Spanning,
        (true, false) => Side::Front,
        (false, true) => Side::Back,
        (false, false) => Side::Coplanar,
    }
}

/// Returns the tolerance in the unit of a plane's value: first rounded down to an integer, then not rounded.
pub fn band(tolerance: f64, plane: &Plane) -> [Rational; 2] {
    let square = rational::scalar(&plane.normal, &plane.normal);
    let length = square.to_f64().value().sqrt() * tolerance;
    let share = 2f64.powi(-49);
    [(length * (1.0 - share)).floor(), length * (1.0 + share)].map(rational::exact)
}

/// Returns a partition plane.
pub fn plane(faces: &Faces, id: PlaneId) -> Plane {
    match id.kind() {
        PlaneKind::Face(face) => {
            let [p, q, r] = faces.reference_triangle(face).map(|c| lattice(faces.corner(c)));
            Plane::through([&p, &q, &r])
        }
        PlaneKind::Axis(axis, corner) => {
            rational::perpendicular_to_axis(axis, &lattice(faces.corner(corner)))
        }
    }
}

/// Returns the first of the axes along which a plane's normal is longest.
pub fn main_axis(plane: &Plane) -> usize {
    vector::main_axis(&plane.normal)
}

fn lattice(corner: [f64; 3]) -> Point {
    corner.map(|c| Rational::from(rational::integer(c)))
}

/// Returns the part of a convex piece in front of a plane, or behind it; `values` are the plane's values at
/// the piece's vertices.
pub fn clip(piece: &[Vertex], values: &[Rational], plane: PlaneId, behind: bool) -> Vec<Vertex> {
    let inside = if behind { Ordering::Less } else { Ordering::Greater };
    let cut = EdgeLine::cut(plane, behind);
    let mut part = Vec::new();
    for (i, vertex) in piece.iter().enumerate() {
        let j = (i + 1) % piece.len();
        let (here, next) = (rational::sign(&values[i]), rational::sign(&values[j]));
        let leaves = next == inside.reverse();
        let crossing =
            || rational::crossing([&vertex.point, &piece[j].point], [&values[i], &values[j]]);
        if here == inside {
            part.push(vertex.clone());
            if leaves {
                part.push(Vertex { point: crossing(), line: cut });
            }
        } else if here.is_eq() {
            let line = if leaves { cut } else { vertex.line };
            part.push(Vertex { line, ..vertex.clone() });
        } else if next == inside {
            part.push(Vertex { point: crossing(), line: vertex.line });
        }
    }
    part
}
