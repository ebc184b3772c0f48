//! Decides on which side of any plane a fragment's vertices lie, and whether a fragment meets several
//! half-spaces.
//!
//! Normals are at most 2¹¹⁷ and offsets at most 2¹⁸⁰ (see `lattice`), so the value of a half-space at a
//! lattice point takes 182 bits. A vertex is a combination of lattice points. The weights have up to 320 bits
//! for a vertex of the fragment (see `vertex`), and up to 364 bits for a vertex that a half-space made. With
//! weights of 364 bits, the weighted sum of three such values takes 548 bits.

use std::cmp::Ordering;

use glam::DVec3;
use smallvec::SmallVec;

use super::lattice::{HalfSpaceNumbers, Lattice};
use super::names::VertexId;
use super::plane::dot;
use super::vertex::Weights;
use super::{Faces, Int};

/// The points in front of a plane, and on the plane.
#[derive(Clone, Debug)]
pub(crate) struct ExactHalfSpace {
    exact: HalfSpaceNumbers,
    normal: [f64; 3],
    offset: f64,
}

/// A line in the plane of a face, given by a plane that cuts the face in this line: the plane's values at the
/// corners of the face's reference triangle.
pub(crate) type LineValues = [Int<3>; 3];

impl ExactHalfSpace {
    /// The points p of the world with `normal.dot(p) >= offset`. `None` if a number is infinite or NaN.
    pub(crate) fn new(normal: DVec3, offset: f64, lattice: &Lattice) -> Option<Self> {
        let exact = lattice.half_space(normal, offset)?;
        let normal = exact.normal.map(|c| c as f64);
        Some(Self { normal, offset: exact.offset.to_f64(), exact })
    }

    fn at(&self, point: &[f64; 3]) -> Int<3> {
        dot(self.exact.normal, point.map(|c| c as i64)) - self.exact.offset
    }

    /// The least and the greatest distance of a point in front of the plane, in a unit of the half-space. The
    /// point's coordinates are off by up to the lengths `off`.
    pub(crate) fn range(&self, point: &[f64; 3], off: [f64; 3]) -> [f64; 2] {
        let (mut sum, mut size, mut slack) = (-self.offset, self.offset.abs(), 0.0);
        for axis in 0..3 {
            sum += self.normal[axis] * point[axis];
            size += (self.normal[axis] * point[axis]).abs();
            slack += self.normal[axis].abs() * off[axis];
        }
        // Twice the error of three products and sums of numbers that are rounded once.
        let error = slack * (1.0 + 1e-9) + size * (8.0 * f64::EPSILON);
        [sum - error, sum + error]
    }
}

/// Whether a fragment of a face, given by its vertices and the lines between them, has a point in the
/// intersection of some half-spaces, exactly. The half-spaces cut the fragment one after the other
/// (Sutherland and Hodgman 1974), and every vertex is kept as exact weights.
pub(crate) fn meets(
    faces: &Faces,
    face: u32,
    outline: impl Iterator<Item = (VertexId, LineValues)>,
    half_spaces: &[&ExactHalfSpace],
) -> bool {
    let triangle = faces.triangle(face);
    let mut lines = SmallVec::<[LineValues; 12]>::new();
    let mut part = Part::new();
    for (vertex_id, line) in outline {
        part.push((faces.weights(face, vertex_id), lines.len()));
        lines.push(line);
    }
    for half_space in half_spaces {
        let side = |(vertex, _): &(Weights<6>, usize)| vertex.sign(|point| half_space.at(point));
        let sides: SmallVec<[Ordering; 12]> = part.iter().map(side).collect();
        let cut = lines.len();
        lines.push(triangle.map(|point| half_space.at(&point)));
        part =
            clip(part, &sides, cut, |line| Weights::meeting(triangle, &lines[line], &lines[cut]));
        if part.is_empty() {
            return false;
        }
    }
    true
}

/// A part of a fragment: its vertices, each with the number of the line to the next vertex.
type Part = SmallVec<[(Weights<6>, usize); 8]>;

/// The part of an outline that is in front of a line or on it; this part may be only a point or an edge.
fn clip(
    outline: Part,
    sides: &[Ordering],
    cut: usize,
    crossing: impl Fn(usize) -> Weights<6>,
) -> Part {
    let mut part = Part::new();
    for (i, (vertex, line)) in outline.into_iter().enumerate() {
        let next = sides[if i + 1 == sides.len() { 0 } else { i + 1 }];
        match (sides[i], next) {
            (Ordering::Greater, Ordering::Less) => {
                part.push((vertex, line));
                part.push((crossing(line), cut));
            }
            (Ordering::Equal, Ordering::Less) => part.push((vertex, cut)),
            (Ordering::Less, Ordering::Greater) => part.push((crossing(line), line)),
            (Ordering::Less, _) => {}
            _ => part.push((vertex, line)),
        }
    }
    part
}
