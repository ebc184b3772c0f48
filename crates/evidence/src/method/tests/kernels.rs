//! Kernels with an epsilon against the exact one.

use glam::DVec3;

use super::{cameras, disjoint, faces, judge};
use crate::Float;
use crate::method::Bsp;
use binspace::BuildOptions;
use binspace::internals::SplitMix64;
use binspace::internals::{Exact, Faces, Kernel, Piece, PlaneId, Side, Vertex, split};
use binspace::scene;

/// Where a whole face lies against the plane of another.
fn side<K: Kernel>(kernel: K, faces: &Faces, face: u32, plane: u32) -> Side {
    let splitter = kernel.splitter(faces, PlaneId::face(plane));
    kernel.classify(faces, &splitter, Piece { face, cut: None })
}

/// The least distance of positions from the plane of a face, as a share of half the extent and of
/// up to four times that: what an epsilon is a share of.
fn least_distance(faces: &Faces, positions: &[[f64; 3]], plane: u32) -> f64 {
    let [p, q, r] = faces.reference_triangle(plane).map(|c| DVec3::from(faces.corner(c)));
    let normal = (q - p).cross(r - p).normalize();
    let distance = |position: &[f64; 3]| (DVec3::from(*position) - p).dot(normal).abs();
    let least = positions.iter().map(distance).fold(f64::INFINITY, f64::min);
    least / 2f64.powi(51)
}

/// What a plane's rounding grows by: a sliver's plane is as uncertain as its corners are, times its
/// length over its width.
fn reach(faces: &Faces, plane: u32) -> f64 {
    let [p, q, r] = faces.reference_triangle(plane).map(|c| DVec3::from(faces.corner(c)));
    let longest = (q - p).length().max((r - p).length()).max((r - q).length());
    let width = (q - p).cross(r - p).length() / longest;
    2f64.powi(53) / width
}

/// Asserts that a kernel agrees with the exact one wherever no distance is within the epsilon and
/// its own rounding, and gives back how many times it does not elsewhere.
fn disagreements<K: Kernel>(kernel: K, epsilon: f64, rounding: f64, faces: &Faces) -> usize {
    let (mut agreed, mut differ) = (0, 0);
    for plane in 0..faces.len() as u32 {
        let slack = epsilon + rounding * reach(faces, plane);
        for face in (0..faces.len() as u32).filter(|&face| face != plane) {
            let same = side(kernel, faces, face, plane) == side(Exact, faces, face, plane);
            if least_distance(faces, faces.corners(face), plane) > slack {
                assert!(same, "face {face} against {plane}");
                agreed += 1;
            } else if !same {
                differ += 1;
            }
        }
    }
    assert!(agreed > faces.len(), "only {agreed} pairs are far enough apart");
    differ
}

/// Crossing and disjoint triangles, and such as lie but for a little in the plane of another.
fn with_close_calls() -> Faces {
    let mut random = SplitMix64::new(3);
    let mut polygons = disjoint(3, 4);
    polygons.extend((0..30).map(|_| (0..3).map(|_| random.point(-1.0, 1.0)).collect()));
    // Lifted by a little from the plane of another, now to one side, now to both.
    for i in 0..30 {
        let base = polygons[i].clone();
        let normal = (base[1] - base[0]).cross(base[2] - base[0]).normalize();
        let lift = |k: usize| normal * 10f64.powi(-3 - (i % 8) as i32) * [1.0, -0.5, 0.7][k];
        polygons.push((0..3).map(|k| base[k] + lift(k)).collect());
    }
    faces(&polygons, Some(0.0))
}

#[test]
fn beyond_the_epsilon_rounded_sides_are_the_exact_ones() {
    let faces = with_close_calls();
    for epsilon in [1e-3, 1e-6, 1e-9, 1e-12] {
        let count = disagreements(Float::<f64>::new(epsilon), epsilon, 1e-15, &faces);
        assert_eq!(count > 0, epsilon > 1e-11, "{epsilon:e}: {count}");
    }
    for epsilon in [1e-3, 1e-4, 1e-5, 1e-6] {
        assert!(disagreements(Float::<f32>::new(epsilon), epsilon, 4e-7, &faces) > 0);
    }
}

/// A face's pieces, by the exact kernel and by a rounded one, as the same planes cut them.
struct Twins<K: Kernel> {
    face: u32,
    exact: Vec<<Exact as Kernel>::Vertex>,
    rounded: Vec<K::Vertex>,
    cuts: usize,
}

impl<K: Kernel> Twins<K> {
    fn new(kernel: K, faces: &Faces, face: u32) -> Self {
        let count = faces.corners(face).len() as u32;
        let exact = (0..count).map(|k| Exact.corner(faces, face, k)).collect();
        let rounded = (0..count).map(|k| kernel.corner(faces, face, k)).collect();
        Self { face, exact, rounded, cuts: 0 }
    }

    /// How far apart the two are, as a share of half the extent, at most.
    fn drift(&self) -> f64 {
        let pairs = self.exact.iter().zip(&self.rounded);
        let apart = |(a, b): (&<Exact as Kernel>::Vertex, &K::Vertex)| {
            (DVec3::from(a.position()) - DVec3::from(b.position())).length() / 2f64.powi(51)
        };
        pairs.map(apart).fold(0.0, f64::max)
    }

    /// The sides of both against a plane.
    fn sides(&self, kernel: K, faces: &Faces, plane: PlaneId) -> [Side; 2] {
        let piece = Piece { face: self.face, cut: Some(&self.exact[..]) };
        let exact = Exact.classify(faces, &Exact.splitter(faces, plane), piece);
        let piece = Piece { face: self.face, cut: Some(&self.rounded[..]) };
        [exact, kernel.classify(faces, &kernel.splitter(faces, plane), piece)]
    }

    /// Cuts both, and keeps the part in front or that behind.
    fn cut(&mut self, kernel: K, faces: &Faces, plane: PlaneId, in_front: bool) {
        self.exact = part(Exact, faces, plane, self.face, &self.exact, in_front);
        self.rounded = part(kernel, faces, plane, self.face, &self.rounded, in_front);
        self.cuts += 1;
        let symbols = self.exact.iter().map(Vertex::symbol);
        assert!(symbols.eq(self.rounded.iter().map(Vertex::symbol)), "{plane:?}");
    }
}

fn part<K: Kernel>(
    kernel: K,
    faces: &Faces,
    plane: PlaneId,
    face: u32,
    vertices: &[K::Vertex],
    in_front: bool,
) -> Vec<K::Vertex> {
    let (mut front, mut back) = (Vec::new(), Vec::new());
    let splitter = kernel.splitter(faces, plane);
    split(&kernel, faces, &splitter, face, vertices, &mut front, &mut back);
    if in_front { front } else { back }
}

/// Cuts every face again and again, and asserts that the kernels agree on each piece wherever none
/// of its vertices is within the epsilon, what it was moved by rounding, and the kernel's own
/// rounding of a plane. Gives back how many times they do not elsewhere.
fn disagreements_on_pieces<K: Kernel>(
    kernel: K,
    epsilon: f64,
    rounding: f64,
    faces: &Faces,
) -> usize {
    let mut random = SplitMix64::new(5);
    let count = faces.len() as u32;
    let (mut agreed, mut differ) = ([0; 7], 0);
    for face in 0..count {
        let mut twins = Twins::new(kernel, faces, face);
        for _ in 0..60 {
            let plane = (random.next() % u64::from(count)) as u32;
            if plane == face || twins.cuts == 6 {
                continue;
            }
            let positions: Vec<[f64; 3]> = twins.exact.iter().map(Vertex::position).collect();
            let least = least_distance(faces, &positions, plane);
            let slack = epsilon + rounding * reach(faces, plane) + twins.drift();
            let [exact, rounded] = twins.sides(kernel, faces, PlaneId::face(plane));
            if least <= slack {
                differ += usize::from(exact != rounded);
                continue;
            }
            assert_eq!(exact, rounded, "face {face} against {plane}, {} cuts", twins.cuts);
            agreed[twins.cuts] += 1;
            if exact == Side::Spanning {
                let in_front = random.range(-1.0, 1.0) > 0.0;
                twins.cut(kernel, faces, PlaneId::face(plane), in_front);
            }
        }
    }
    assert!(agreed[..4].iter().all(|&number| number > faces.len()), "{agreed:?}");
    differ
}

#[test]
fn beyond_the_epsilon_rounded_sides_of_cut_pieces_are_the_exact_ones() {
    let faces = with_close_calls();
    for epsilon in [1e-3, 1e-6, 1e-9, 1e-12] {
        let kernel = Float::<f64>::new(epsilon);
        let count = disagreements_on_pieces(kernel, epsilon, 1e-15, &faces);
        assert_eq!(count > 0, epsilon > 1e-11, "{epsilon:e}: {count}");
    }
    for epsilon in [1e-3, 1e-4, 1e-5, 1e-6] {
        let kernel = Float::<f32>::new(epsilon);
        assert!(disagreements_on_pieces(kernel, epsilon, 4e-7, &faces) > 0, "{epsilon:e}");
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
        // Cuts are rounded to about 1e-7 of the extent: a pixel on one may be missing.
        let method = Bsp::single(BuildOptions::DEFAULT, 1e-6);
        assert!(judge(&method, &faces, &camera).wrong() <= 2);
    }
}

#[test]
fn layers_within_the_epsilon_are_mistaken_for_one() {
    // Squares 1e-5 apart, and half the extent is 1; reversed, so that the lowest comes last.
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
