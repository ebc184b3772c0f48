//! The judge: a depth buffer, and the comparison of a painted picture with it, pixel by pixel.

use std::cmp::Ordering;
use std::ops::Range;

use super::coverage::{Coverage, Outline};
use super::exact::{Plane, PlanePair};
use super::line::{ROUNDING, Seen};
use super::painter::{Image, NONE};
use super::rays::{Given, Rays};
use crate::exact::{Faces, PlaneId};
use crate::random::mix;

/// The nearest [face](super) in each pixel, and the [depth](Self::depths) of that face.
#[derive(Clone, Debug)]
pub struct DepthImage {
    image: Image,
    /// 1/t for a perspective and −t for a parallel projection, where t is the parameter at which the ray
    /// meets the face: larger is nearer.
    nearness: Vec<f64>,
    unit: f64,
    perspective: bool,
}

impl DepthImage {
    /// Returns the picture of the nearest faces.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Converts into the picture of the nearest faces.
    pub fn into_image(self) -> Image {
        self.image
    }

    /// Returns the depth of the nearest face in each pixel, row by row from the top left, in the polygons'
    /// unit and rounded. In pixels without a face, the depth is infinite.
    ///
    /// Depth is measured along the direction in which the camera looks. It is measured from the eye, or, in a
    /// parallel view, from the plane through the middle of the scene. So depths may be negative in parallel
    /// views.
    pub fn depths(&self) -> impl Iterator<Item = f64> {
        self.image.faces.iter().zip(&self.nearness).map(|(&face, &nearness)| {
            if face == NONE {
                f64::INFINITY
            } else if self.perspective {
                self.unit / nearness
            } else {
                -nearness * self.unit
            }
        })
    }
}

/// The nearness of a face, as a rounded linear function of the pixel, with a bound on the rounding error.
#[derive(Clone, Copy)]
struct Nearness {
    k: [f64; 3],
    error: f64,
}

impl Nearness {
    fn new(seen: &Seen<'_>) -> Self {
        let sheet = &seen.sheet;
        let factor = if seen.rays.is_perspective() { -1.0 } else { 1.0 } / sheet.kappa;
        // φ is off by 12 roundings of the size of φ, κ by 8 roundings of the size of κ. The quotient and the
        // evaluation add a few roundings. If κ is uncertain by a quarter, no bound is known.
        let uncertainty = 9.0 * ROUNDING * sheet.kappa_size / sheet.kappa.abs();
        let error = if uncertainty < 0.25 {
            sheet.phi_size * factor.abs() * (20.0 * ROUNDING + 2.0 * uncertainty)
        } else {
            f64::INFINITY
        };
        Self { k: sheet.phi.map(|c| c * factor), error }
    }

    fn at(&self, x: u32, y: u32) -> f64 {
        self.k[0] + f64::from(y) * self.k[2] + f64::from(x) * self.k[1]
    }
}

/// Returns the nearest [face](super) in each pixel. If faces are at exactly the same distance, the face of
/// the polygon that is later in input order counts as nearest, as if it were painted over the others.
///
/// # Panics
///
/// If the rays were made for another [grid](crate::BspTree::grid) than the grid of the faces.
pub fn zbuffer(rays: &Rays, faces: &Faces) -> DepthImage {
    zbuffer_and(rays, faces, |_, _, _| {})
}

/// The nearest face in each pixel, and all faces that cover each pixel.
pub(crate) fn zbuffer_layers(rays: &Rays, faces: &Faces) -> (DepthImage, Layers) {
    let mut layers = Layers::new(rays);
    let depth = zbuffer_and(rays, faces, |face, y, columns| layers.add(face, y, columns));
    (depth, layers)
}

/// Like [`zbuffer`], and calls `also` with each run of pixels that a face covers: the face, the row, and the
/// columns.
fn zbuffer_and(
    rays: &Rays,
    faces: &Faces,
    mut also: impl FnMut(u32, u32, Range<u32>),
) -> DepthImage {
    rays.expect(faces);
    let mut image = Image::new(rays.size());
    let mut nearness = vec![f64::NEG_INFINITY; image.faces.len()];
    let mut errors = vec![0.0f64; image.faces.len()];
    let width = rays.size()[0] as usize;
    for face in 0..faces.len() as u32 {
        let Some(coverage) = Coverage::new(rays, faces, face, Outline::Whole) else { continue };
        let near = Nearness::new(&coverage.seen);
        coverage.for_each_run(&mut |y, columns| {
            image.drawn += columns.len() as u64;
            also(face, y, columns.clone());
            for x in columns {
                let i = y as usize * width + x as usize;
                let value = near.at(x, y);
                // Rounded values decide if their difference exceeds their errors; otherwise integers decide.
                let doubt = errors[i] + near.error;
                let wins = if image.faces[i] == NONE || value - nearness[i] > doubt {
                    true
                } else if nearness[i] - value > doubt {
                    false
                } else {
                    is_drawn_over(rays, faces, face, image.faces[i], x, y)
                };
                if wins {
                    image.faces[i] = face;
                    nearness[i] = value;
                    errors[i] = near.error;
                }
            }
        });
    }
    DepthImage { image, nearness, unit: rays.depth_unit, perspective: rays.is_perspective() }
}

/// Whether a face hides another face in a pixel: the hiding face is nearer, or at the same distance and of
/// the later polygon.
///
/// Nearness is ∓φ/κ, so the sign of ∓(φ_a κ_b − φ_b κ_a), times the signs of both κ, decides which face is
/// nearer.
#[cold]
fn is_drawn_over(rays: &Rays, faces: &Faces, face: u32, other: u32, x: u32, y: u32) -> bool {
    let pair = PlanePair::new(rays, [face, other].map(|face| Plane::of(faces, face)));
    // κ_a φ_b − κ_b φ_a, so the sign is reversed once more.
    let across = pair.at(rays.pixel(x, y)).determinant.sign().reverse();
    let [a, b] = pair.kappas.map(|kappa| kappa.sign().is_lt());
    let nearer = if a ^ b ^ rays.is_perspective() { across.reverse() } else { across };
    let rank = |face| (faces.polygon(face), face);
    nearer.then(rank(face).cmp(&rank(other))).is_gt()
}

/// For every pixel, the multiset of faces that cover it.
///
/// Stored as a hash, the sum of a pseudo-random number for each face: the hashes of two different
/// multisets are equal with a probability of 2⁻³².
#[derive(Clone, Debug)]
pub(crate) struct Layers {
    width: usize,
    sums: Vec<u32>,
}

impl Layers {
    /// No faces in any pixel.
    pub(crate) fn new(rays: &Rays) -> Self {
        let [width, height] = rays.size().map(|side| side as usize);
        Self { width, sums: vec![0; width * height] }
    }

    /// Adds a face in some columns of a row.
    pub(crate) fn add(&mut self, face: u32, y: u32, columns: Range<u32>) {
        let term = mix(u64::from(face)) as u32;
        let row = &mut self.sums[y as usize * self.width..][..self.width];
        for sum in &mut row[columns.start as usize..columns.end as usize] {
            *sum = sum.wrapping_add(term);
        }
    }

    /// The number of pixels in which the faces differ from the faces in `other`.
    pub(crate) fn differences(&self, other: &Self) -> usize {
        self.sums.iter().zip(&other.sums).filter(|(a, b)| a != b).count()
    }
}

/// The verdict on one pixel of a painted picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Verdict {
    /// There is no polygon, and nothing is painted.
    Empty,
    /// The right polygon is painted.
    Right,
    /// The painted polygon is not the nearest, but the tolerance allows either order: see [`compare`].
    Contested,
    /// Another polygon hides the painted polygon.
    WrongOrder,
    /// Nothing is painted, but there is a polygon.
    Hole,
    /// A polygon is painted, but there is no polygon.
    Spill,
}

/// The differences between a painted picture and the true picture: the result of [`compare`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Comparison {
    /// The number of pixels in which the true picture shows a polygon.
    pub covered: usize,
    /// The number of pixels that show another polygon than the nearest polygon, where the tolerance allows
    /// either order of these two polygons: see [`compare`].
    pub contested: usize,
    /// The number of pixels that show a polygon that another polygon hides.
    pub wrong_order: usize,
    /// The number of pixels that show nothing where there is a polygon.
    pub holes: usize,
    /// The number of pixels that show a polygon where there is no polygon.
    pub spills: usize,
    /// The verdict on each pixel, row by row from the top left.
    pub verdicts: Vec<Verdict>,
}

impl Comparison {
    /// Returns the number of wrong pixels: all pixels that differ, except contested pixels.
    pub fn wrong(&self) -> usize {
        self.wrong_order + self.holes + self.spills
    }
}

/// Added to the tolerance, in lattice units, for corners that are on their face's plane only by definition:
/// each stored corner is off by up to 1 unit, and up to 4 such errors add up. If the tolerance is 0, no
/// corner is moved and nothing is added.
const MOVED_CORNERS: f64 = 4.0;

/// Compares a painted picture with a true picture, both made with the same rays.
///
/// Polygons are compared, not faces: two faces of one polygon are equal. Let τ be the coplanar
/// [tolerance](crate::BspTree#exactness). A pixel that shows the wrong polygon is *contested*, not wrong, in
/// one of these cases:
///
/// - the pixel's ray meets the painted face and the true face at exactly the same distance;
/// - the ray meets the painted face within 2 τ of the true face's plane, and the true face within 2 τ of the
///   painted face's plane.
///
/// The reason for the second case: if two polygons are both within τ of a [partition
/// plane](crate::BspTree#contents), both count as lying on this plane, and they are painted in input order.
/// With τ = 0 only the first case occurs.
///
/// This rule uses only the polygons. [`verify`](crate::verify::verify()) also uses the partition planes.
///
/// # Panics
///
/// If the rays were made for another [grid](crate::BspTree::grid) than the grid of the faces.
pub fn compare(rays: &Rays, faces: &Faces, painted: &Image, truth: &Image) -> Comparison {
    rays.expect(faces);
    let tolerance = faces.tolerance();
    let allowed = if tolerance > 0.0 { 2.0 * tolerance + MOVED_CORNERS } else { 0.0 };
    compare_by(rays, faces, [painted, truth], allowed, |_, _| false)
}

/// Like [`compare`], with another rule: two faces are contested if each is met within a length, in lattice
/// units, of the plane of the other, or if `is_open` returns true for the nearest face, the painted face and
/// the pixel.
pub(crate) fn compare_by(
    rays: &Rays,
    faces: &Faces,
    [painted, truth]: [&Image; 2],
    allowed: f64,
    mut is_open: impl FnMut([u32; 2], [u32; 2]) -> bool,
) -> Comparison {
    let width = rays.size()[0] as usize;
    let mut result = Comparison::default();
    let judge = |(i, (&shown, &nearest)): (usize, (&u32, &u32))| match (shown, nearest) {
        (NONE, NONE) => Verdict::Empty,
        (NONE, _) => Verdict::Hole,
        (_, NONE) => Verdict::Spill,
        _ if faces.polygon(shown) == faces.polygon(nearest) => Verdict::Right,
        _ => {
            let [x, y] = [(i % width) as u32, (i / width) as u32];
            let pair = PlanePair::new(rays, [shown, nearest].map(|face| Plane::of(faces, face)));
            let apart = distances(rays, &pair, rays.pixel(x, y));
            if apart.iter().all(|&apart| apart <= allowed) || is_open([nearest, shown], [x, y]) {
                Verdict::Contested
            } else {
                Verdict::WrongOrder
            }
        }
    };
    result.verdicts = painted.faces().iter().zip(truth.faces()).enumerate().map(judge).collect();
    let count = |verdict| result.verdicts.iter().filter(|&&v| v == verdict).count();
    result.covered = truth.covered();
    result.contested = count(Verdict::Contested);
    result.wrong_order = count(Verdict::WrongOrder);
    result.holes = count(Verdict::Hole);
    result.spills = count(Verdict::Spill);
    result
}

/// For each of two planes, the plane's distance from the point where the ray of a pixel meets the other
/// plane, in lattice units, rounded.
fn distances(rays: &Rays, pair: &PlanePair, pixel: Given) -> [f64; 2] {
    let at = pair.at(pixel);
    let divisors = pair.divisors(rays, &at);
    // The determinant is exact and is rounded only here, so a tie results in exactly 0. A ray in the plane
    // that it should meet results in 0 / 0 = NaN, which compares as too far.
    let value = at.determinant.to_f64().abs();
    [0, 1].map(|to| value / (divisors[1 - to].abs() * pair.planes[to].normal().length()))
}

/// Whether the tolerance leaves the order of two faces open along the ray of a pixel, given the partition
/// plane between their pieces. `pieces` are the nearer and the further face, each with the side of the plane
/// to which its piece belongs (`Greater` is the front, `Equal` the plane itself). Two conditions must hold.
/// First, the ray meets the nearer face within the tolerance of the plane; within the tolerance, too, the ray
/// meets the further face or begins. Second, one of the two pieces reaches across the plane where the ray
/// meets the piece.
///
/// A tolerance can cause no other wrong pixels. Suppose that the eye is in front of the plane, and that a
/// piece which the order puts behind hides a piece which it puts in front. Along the ray, the height above
/// the plane is linear. This height is positive at the eye, at most τ at the hiding piece, and at least −τ
/// further away, at the hidden piece. If the height falls along the ray, both pieces are met within τ of the
/// plane; if the height rises, it is at most τ from the eye to the hiding piece. If neither piece reached
/// across, the height would fall to 0 or less at the hiding piece, and not be below 0 further away. (Only
/// along a ray in the plane can the height be 0 at both pieces.)
pub(crate) fn is_open(
    rays: &Rays,
    faces: &Faces,
    plane: PlaneId,
    pieces: [(u32, Ordering); 2],
    [x, y]: [u32; 2],
) -> bool {
    let tolerance = faces.tolerance();
    if tolerance == 0.0 {
        return false;
    }
    let allowed = tolerance + MOVED_CORNERS;
    let plane = Plane::new(faces, plane);
    let pixel = rays.pixel(x, y);
    let pair = |face| PlanePair::new(rays, [plane, Plane::of(faces, face)]);
    let meets = |face| distances(rays, &pair(face), pixel)[0] <= allowed;
    let begins = || {
        let height = plane.kappa(rays).to_f64().abs() / plane.normal().length();
        rays.is_perspective() && height <= allowed
    };
    let is_within = || plane.kappa(rays).sign().is_eq() && plane.phi(pixel).sign().is_eq();
    let reaches_across = |(face, side)| {
        let found = pair(face).side_of_first(pixel);
        found.is_ne() && found != side
    };
    let [nearest, other] = pieces.map(|(face, _)| face);
    meets(nearest)
        && (meets(other) || begins())
        && (pieces.into_iter().any(reaches_across) || is_within())
}
