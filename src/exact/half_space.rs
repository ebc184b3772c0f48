//! On which side of any plane the vertices of a fragment lie, and whether a fragment meets several half-spaces.
//!
//! Normals are at most 2¹¹⁷ and offsets at most 2¹⁸⁰ (see `lattice`), so a half-space at a
//! lattice point takes 182 bits. A vertex is a combination of lattice points with weights of up to 320
//! bits, where it is one of the fragment's own (see `vertex`), and of up to 364, where the half-spaces
//! themselves made it: then the sum takes 548 bits.

use std::cmp::Ordering;

use glam::DVec3;
use smallvec::SmallVec;

use super::lattice::{HalfSpaceNumbers, Lattice};
use super::names::VertexId;
use super::plane::{dot, relative_to};
use super::vertex::Weights;
use super::{Faces, Int};

/// The points on the front of a plane, and on the plane.
#[derive(Clone, Debug)]
pub(crate) struct ExactHalfSpace {
    exact: HalfSpaceNumbers,
    normal: [f64; 3],
    offset: f64,
}

/// A line in the plane of a face: the plane that cuts the face there, at the corners of its reference
/// triangle.
pub(crate) type LineValues = [Int<3>; 3];

/// A vertex of a fragment, or of a part of it.
#[derive(Clone, Copy, Debug)]
enum PartVertex {
    /// One of the fragment's own.
    Own(VertexId),
    /// Where two lines meet, by their numbers.
    Crossing(usize, usize),
}

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

    /// How far in front a point is that is off by up to some lengths along the axes: the least and the most,
    /// in a unit of its own.
    pub(crate) fn range(&self, point: &[f64; 3], off: [f64; 3]) -> [f64; 2] {
        let (mut sum, mut size, mut slack) = (-self.offset, self.offset.abs(), 0.0);
        for axis in 0..3 {
            sum += self.normal[axis] * point[axis];
            size += (self.normal[axis] * point[axis]).abs();
            slack += self.normal[axis].abs() * off[axis];
        }
        // Three products and sums, of numbers that are rounded once; twice that.
        let error = slack * (1.0 + 1e-9) + size * (8.0 * f64::EPSILON);
        [sum - error, sum + error]
    }
}

/// Whether a fragment of a face, by its vertices and the lines from each to the next, has a point in
/// all of some half-spaces: it is cut by one after the other (Sutherland and Hodgman 1974), and every
/// vertex is named by what defines it. Exact.
pub(crate) fn meets(
    faces: &Faces,
    face: u32,
    outline: impl Iterator<Item = (VertexId, LineValues)>,
    half_spaces: &[&ExactHalfSpace],
) -> bool {
    let triangle = faces.triangle(face);
    let mut lines = SmallVec::<[LineValues; 12]>::new();
    let mut part = SmallVec::<[(PartVertex, usize); 12]>::new();
    for (vertex_id, line) in outline {
        part.push((PartVertex::Own(vertex_id), lines.len()));
        lines.push(line);
    }
    for half_space in half_spaces {
        let values = triangle.map(|point| half_space.at(&point));
        let side = |corner: PartVertex| match corner {
            PartVertex::Own(vertex_id) => side(half_space, faces.weights(face, vertex_id)),
            PartVertex::Crossing(a, b) => side_of_crossing([&lines[a], &lines[b]], &values),
        };
        let sides: SmallVec<[Ordering; 12]> =
            part.iter().map(|&(corner, _)| side(corner)).collect();
        let cut = lines.len();
        lines.push(values);
        part = clip(&part, &sides, cut);
        if part.is_empty() {
            return false;
        }
    }
    true
}

/// The part of an outline that is in front of a line or on it, which may be a point or an edge alone.
fn clip(
    outline: &[(PartVertex, usize)],
    sides: &[Ordering],
    cut: usize,
) -> SmallVec<[(PartVertex, usize); 12]> {
    let mut part = SmallVec::new();
    for (i, &(corner, line)) in outline.iter().enumerate() {
        let next = sides[if i + 1 == sides.len() { 0 } else { i + 1 }];
        match (sides[i], next) {
            (Ordering::Greater, Ordering::Less) => {
                part.push((corner, line));
                part.push((PartVertex::Crossing(line, cut), cut));
            }
            (Ordering::Equal, Ordering::Less) => part.push((corner, cut)),
            (Ordering::Less, Ordering::Greater) => {
                part.push((PartVertex::Crossing(line, cut), line));
            }
            (Ordering::Less, _) => {}
            _ => part.push((corner, line)),
        }
    }
    part
}

/// The side of a half-space's plane on which a combination of lattice points is.
fn side(half_space: &ExactHalfSpace, weights: Weights) -> Ordering {
    match weights {
        Weights::Corner(point) => half_space.at(&point).sign(),
        Weights::Edge([a, b], [wa, wb]) => {
            let [at_a, at_b] = [a, b].map(|point| half_space.at(&point));
            let sum = wa.times::<3, 6>(&at_a) + wb.times::<3, 6>(&at_b);
            relative_to(sum.sign(), (wa + wb).sign())
        }
        Weights::Inside(points, [a, b, c]) => {
            let term = |weight: Int<5>, point| weight.times::<3, 9>(&half_space.at(point));
            let sum = term(a, &points[0]) + term(b, &points[1]) + term(c, &points[2]);
            relative_to(sum.sign(), (a + b + c).sign())
        }
    }
}

/// The side of a third line on which two lines meet; all by their values at the same three points. As
/// in `vertex`, the weights of the point over these are a vector product.
fn side_of_crossing([g, h]: [&LineValues; 2], line: &LineValues) -> Ordering {
    let weights: [Int<6>; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        g[j].times::<3, 6>(&h[k]) - g[k].times::<3, 6>(&h[j])
    });
    let term = |i: usize| weights[i].times::<3, 9>(&line[i]);
    let total = weights[0] + weights[1] + weights[2];
    relative_to((term(0) + term(1) + term(2)).sign(), total.sign())
}
