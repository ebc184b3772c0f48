//! Compares decisions by rounded planes and an epsilon with exact decisions.

use super::{cameras, disjoint, faces, judge};
use crate::method::Bsp;
use crate::{Precision, RoundedPiece, RoundedPlane};
use binspace::internals::{PreparedPlane, Side, SplitMix64, Vertex, split};
use testkit::prelude::*;

/// The least distance of positions from the plane of a face, in the unit of an epsilon: 2⁵¹ lattice steps.
fn least_distance(faces: &Faces, positions: &[[f64; 3]], plane: u32) -> f64 {
    let [p, q, r] = faces.reference_triangle(plane).map(|c| DVec3::from(faces.corner(c)));
    let normal = (q - p).cross(r - p).normalize();
    let distance = |position: &[f64; 3]| (DVec3::from(*position) - p).dot(normal).abs();
    let least = positions.iter().map(distance).fold(f64::INFINITY, f64::min);
    least / 2f64.powi(51)
}

/// The factor by which the plane of a triangle magnifies the rounding of its corners: the triangle's length
/// over its width.
fn reach(faces: &Faces, plane: u32) -> f64 {
    let [p, q, r] = faces.reference_triangle(plane).map(|c| DVec3::from(faces.corner(c)));
    let longest = (q - p).length().max((r - p).length()).max((r - q).length());
    let width = (q - p).cross(r - p).length() / longest;
    2f64.powi(53) / width
}

/// Crossing and disjoint triangles, and triangles that almost lie in the plane of another.
fn with_close_calls() -> Faces {
    let mut random = SplitMix64::new(3);
    let mut polygons = disjoint(3, 4);
    polygons.extend((0..30).map(|_| (0..3).map(|_| random.point(-1.0, 1.0)).collect()));
    // Each triangle is lifted slightly from the plane of another, to one side or to both sides.
    for i in 0..30 {
        let base = polygons[i].clone();
        let normal = (base[1] - base[0]).cross(base[2] - base[0]).normalize();
        let lift = |k: usize| normal * 10f64.powi(-3 - (i % 8) as i32) * [1.0, -0.5, 0.7][k];
        polygons.push((0..3).map(|k| base[k] + lift(k)).collect());
    }
    faces(&polygons, Some(0.0))
}

/// A piece of a face, cut by the same planes in exact and in rounded arithmetic.
struct Twins {
    face: u32,
    exact: Vec<Vertex>,
    rounded: RoundedPiece,
    cuts: usize,
}

impl Twins {
    fn new<T: Precision>(faces: &Faces, face: u32) -> Self {
        let count = faces.corners(face).len() as u32;
        let exact = (0..count).map(|k| Vertex::corner(faces, face, k)).collect();
        Self { face, exact, rounded: RoundedPiece::whole::<T>(faces, face), cuts: 0 }
    }

    /// The largest distance between the two positions of a vertex, as a share of half the extent.
    fn drift(&self) -> f64 {
        let pairs = self.exact.iter().map(Vertex::position).zip(self.rounded.positions());
        let apart = |(a, b)| (DVec3::from(a) - DVec3::from(b)).length() / 2f64.powi(51);
        pairs.map(apart).fold(0.0, f64::max)
    }

    /// Cuts both pieces, and keeps either the parts in front or the parts behind.
    fn cut<T: Precision>(
        &mut self,
        faces: &Faces,
        exact: &PreparedPlane,
        rounded: &RoundedPlane<T>,
        in_front: bool,
    ) {
        let (mut front, mut back) = (Vec::new(), Vec::new());
        split(faces, exact, self.face, &self.exact, &mut front, &mut back);
        let [rounded_front, rounded_back] = rounded.split(&self.rounded);
        (self.exact, self.rounded) =
            if in_front { (front, rounded_front) } else { (back, rounded_back) };
        self.cuts += 1;
        assert!(self.exact.iter().map(Vertex::vertex_id).eq(self.rounded.vertex_ids()));
    }
}

/// Compares every face with all planes, and cuts it several times. Asserts that the rounded side of a piece
/// is the exact one if all vertices are further from the plane than the epsilon, the drift and the plane's
/// rounding together. Returns the number of nearer pieces whose rounded side is wrong.
fn disagreements<T: Precision>(epsilon: f64, rounding: f64, faces: &Faces) -> usize {
    let mut random = SplitMix64::new(5);
    let count = faces.len() as u32;
    let (mut agreed, mut differ) = ([0; 7], 0);
    for face in 0..count {
        let mut twins = Twins::new::<T>(faces, face);
        let some: Vec<u32> = (0..60).map(|_| (random.next() % u64::from(count)) as u32).collect();
        let planes = (0..count).map(|plane| (plane, false));
        for (plane, may_cut) in planes.chain(some.into_iter().map(|plane| (plane, true))) {
            if plane == face || twins.cuts == 6 {
                continue;
            }
            let positions: Vec<[f64; 3]> = twins.exact.iter().map(Vertex::position).collect();
            let least = least_distance(faces, &positions, plane);
            let is_whole = twins.cuts == 0;
            let drift = if is_whole { 0.0 } else { twins.drift() };
            let slack = epsilon + rounding * reach(faces, plane) + drift;
            let exact = PreparedPlane::new(faces, PlaneId::face(plane));
            let rounded = RoundedPlane::<T>::new(faces, plane, epsilon);
            let vertices = if is_whole { None } else { Some(&twins.exact[..]) };
            let side = exact.classify(faces, face, vertices);
            let rounded_side = rounded.classify(&twins.rounded);
            if least <= slack {
                differ += usize::from(side != rounded_side);
                continue;
            }
            assert_eq!(side, rounded_side, "face {face} against {plane}, {} cuts", twins.cuts);
            agreed[twins.cuts] += 1;
            if side == Side::Spanning && may_cut {
                let in_front = random.range(-1.0, 1.0) > 0.0;
                twins.cut(faces, &exact, &rounded, in_front);
            }
        }
    }
    assert!(agreed[..4].iter().all(|&number| number > faces.len()), "{agreed:?}");
    differ
}

#[test]
fn beyond_the_epsilon_rounded_sides_of_faces_and_pieces_are_the_exact_ones() {
    let faces = with_close_calls();
    for epsilon in [1e-3, 1e-6, 1e-9, 1e-12] {
        let count = disagreements::<f64>(epsilon, 1e-15, &faces);
        assert_eq!(count > 0, epsilon > 1e-11, "{epsilon:e}: {count}");
    }
    for epsilon in [1e-3, 1e-4, 1e-5, 1e-6] {
        assert!(disagreements::<f32>(epsilon, 4e-7, &faces) > 0, "{epsilon:e}");
    }
}

#[test]
fn trees_without_close_calls_paint_the_same() {
    let polygons = disjoint(4, 8);
    let faces = faces(&polygons, Some(0.0));
    for camera in cameras(&polygons, [64, 48], 8) {
        for epsilon in [1e-12, 1e-9] {
            let method = Bsp::double(BuildOptions::DEFAULT, epsilon);
            assert_eq!(judge(&method, &faces, &camera).wrong(), 0, "{epsilon:e}");
        }
        // Cuts are rounded to about 1e-7 of the extent, so a pixel on a cut may be missing.
        let method = Bsp::single(BuildOptions::DEFAULT, 1e-6);
        assert!(judge(&method, &faces, &camera).wrong() <= 2);
    }
}

#[test]
fn layers_within_the_epsilon_are_mistaken_for_one() {
    // Squares 1e-5 apart; half the extent is 1. The list is reversed, so that the lowest square comes last.
    let mut polygons = super::polygons_of(&scene::layers(6, 1e-5));
    polygons.reverse();
    let faces = faces(&polygons, Some(0.0));
    let eye = DVec3::new(0.8, -1.6, 2.6);
    let camera =
        binspace::view::Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [64, 48]).unwrap();
    let wrong = |epsilon| {
        let double = Bsp::double(BuildOptions::DEFAULT, epsilon);
        judge(&double, &faces, &camera).wrong_order
    };
    assert_eq!(wrong(1e-9), 0);
    assert_eq!(wrong(1e-6), 0);
    assert!(wrong(1e-3) > 100);
    let single = |epsilon| Bsp::single(BuildOptions::DEFAULT, epsilon);
    assert_eq!(judge(&single(1e-6), &faces, &camera).wrong_order, 0);
    assert!(judge(&single(1e-3), &faces, &camera).wrong_order > 100);
}
