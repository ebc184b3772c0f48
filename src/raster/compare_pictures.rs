//! Compares a painted picture with a depth buffer's, pixel by pixel, and says how deep the errors are.

use std::cmp::Ordering;

use super::coverage::{Coverage, Outline};
use super::exact::{Plane, PlanePair};
use super::painter::{Image, NONE};
use super::rays::{Given, Rays};
use crate::exact::{Faces, PlaneId};

/// The verdict on one pixel of a painted picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Verdict {
    /// Nothing is there, and nothing is painted.
    Empty,
    /// The right polygon is painted.
    Right,
    /// Another polygon is painted than the nearest, but the tolerance allows either in front.
    Contested,
    /// A polygon is painted that another one hides.
    WrongOrder,
    /// Nothing is painted where there is a polygon.
    Hole,
    /// A polygon is painted where there is none.
    Spill,
}

/// How a painted picture differs from the true one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Comparison {
    /// Pixels in which the true picture shows a polygon.
    pub covered: usize,
    /// Pixels that show another polygon than the nearest, where the tolerance allows for both.
    pub contested: usize,
    /// Pixels that show a polygon which another one hides.
    pub wrong_order: usize,
    /// Pixels that show nothing where there is a polygon.
    pub holes: usize,
    /// Pixels that show a polygon where there is none.
    pub spills: usize,
    /// The verdict on each pixel, row by row from the top left.
    pub verdicts: Vec<Verdict>,
}

impl Comparison {
    /// How many pixels are wrong: all that differ but the contested ones.
    pub fn wrong(&self) -> usize {
        self.wrong_order + self.holes + self.spills
    }
}

/// Added to the tolerance, in lattice units, for corners that are on their face's plane only by
/// definition: each is stored rounded, off by up to 1 unit, and up to 4 such errors add up. If the
/// tolerance is 0, no corner is moved and nothing is added.
const MOVED_CORNERS: f64 = 4.0;

/// Compares a painted picture with a true one, both made with the same rays.
///
/// Polygons are compared, not faces: two faces of one polygon are the same. A pixel is *contested*
/// if, along its ray, the painted face and the true one are at exactly the same distance, or the
/// ray meets *each* of them within 2 τ of the plane of the other, where τ is the tolerance. For two
/// polygons that are each within τ of a partition plane may both count as part of that plane, and
/// then they are painted in input order. With τ = 0 only ties are contested.
///
/// So a view along one of the two planes excuses nothing by itself: the other polygon, which the
/// ray meets at an angle, has to be as near. This rule knows the polygons, not the partition planes;
/// [`verify`](crate::verify::verify()) knows both.
///
/// # Panics
///
/// If the rays were made for another grid.
pub fn compare(rays: &Rays, faces: &Faces, painted: &Image, truth: &Image) -> Comparison {
    rays.expect(faces);
    let tolerance = faces.tolerance();
    let allowed = if tolerance > 0.0 { 2.0 * tolerance + MOVED_CORNERS } else { 0.0 };
    compare_by(rays, faces, [painted, truth], allowed, |_, _| false)
}

/// As [`compare`], with a rule of its own: contested are two faces that are each met within a
/// length, in lattice units, of the plane of the other; and what `is_open` says so of, given the
/// nearest face, the painted one and the pixel.
pub(crate) fn compare_by(
    rays: &Rays,
    faces: &Faces,
    [painted, truth]: [&Image; 2],
    allowed: f64,
    mut is_open: impl FnMut([u32; 2], [u32; 2]) -> bool,
) -> Comparison {
    let width = rays.size()[0] as usize;
    let mut result = Comparison::default();
    let mut pair = LastPair::new(rays, faces);
    let judge = |(i, (&shown, &nearest)): (usize, (&u32, &u32))| match (shown, nearest) {
        (NONE, NONE) => Verdict::Empty,
        (NONE, _) => Verdict::Hole,
        (_, NONE) => Verdict::Spill,
        _ if faces.polygon(shown) == faces.polygon(nearest) => Verdict::Right,
        _ => {
            let [x, y] = [(i % width) as u32, (i / width) as u32];
            let apart = distances(rays, pair.of([shown, nearest]), rays.pixel(x, y));
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

/// The planes of two faces, kept from one pixel to the next: the same two meet in many.
pub(super) struct LastPair<'a> {
    rays: &'a Rays,
    faces: &'a Faces,
    last: Option<([u32; 2], PlanePair)>,
}

impl<'a> LastPair<'a> {
    pub(super) fn new(rays: &'a Rays, faces: &'a Faces) -> Self {
        Self { rays, faces, last: None }
    }

    pub(super) fn of(&mut self, both: [u32; 2]) -> &PlanePair {
        let last = self.last.take().filter(|&(last, _)| last == both);
        let planes = || both.map(|face| Plane::of(self.faces, face));
        let pair = || (both, PlanePair::new(self.rays, planes()));
        &self.last.insert(last.unwrap_or_else(pair)).1
    }
}

/// The distances from each of two planes of the point where the ray of a pixel meets the other, in
/// lattice units, rounded.
fn distances(rays: &Rays, pair: &PlanePair, pixel: Given) -> [f64; 2] {
    let at = pair.at(pixel);
    let divisors = pair.divisors(rays, &at);
    // The determinant is exact and is rounded only here, so a tie gives exactly 0. A ray within the
    // plane that it is to meet gives 0 / 0 = NaN, which compares as too far.
    let value = at.determinant.to_f64().abs();
    [0, 1].map(|to| value / (divisors[1 - to].abs() * pair.planes[to].normal().length()))
}

/// Whether the tolerance leaves the order of two faces open along the ray of a pixel, given the
/// partition plane between their pieces: the nearer face and the other one, each with the side of
/// the plane to which its piece belongs (`Greater` is the front, `Equal` the plane itself). It does if
/// the ray meets the nearer face within the tolerance of that plane, and either meets the other face,
/// or begins, within it as well; and if one of the two pieces reaches across the plane there.
///
/// A tolerance can cause no other wrong pixels. Suppose the eye is in front of the plane, and a
/// piece that the order puts in front is hidden by one that it puts behind. Along the ray, the
/// height above the plane is linear. It is positive at the eye, at most τ where the ray meets the
/// hiding piece, and at least −τ further on, at the hidden piece. If the height falls along the
/// ray, both pieces are met within τ of the plane; if it rises, it is at most τ from the eye to the
/// hiding piece. If neither piece reached across, the height would fall to 0 or less at the hiding
/// piece, and not be below 0 further on. (Only along a ray within the plane can it be 0 at both.)
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

/// How far behind the nearest polygon the painted ones are; see [`depth_error`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DepthError {
    /// Wrong pixels in which the painted face is met at all.
    pub pixels: usize,
    /// The largest difference of depths, in world units along the direction of view.
    pub max: f64,
    /// The sum of the differences of all these pixels.
    pub sum: f64,
}

/// The difference in depth between the painted face and the nearest, over the pixels with the
/// verdict [wrong order](Verdict::WrongOrder). Pixels whose ray does not meet the painted face at
/// all are left out.
///
/// # Panics
///
/// If the rays were made for another grid.
pub fn depth_error(
    rays: &Rays,
    faces: &Faces,
    painted: &Image,
    truth: &Image,
    comparison: &Comparison,
) -> DepthError {
    rays.expect(faces);
    let width = rays.size()[0] as usize;
    let mut result = DepthError::default();
    let mut pairs = LastPair::new(rays, faces);
    let mut last = None;
    let pixels = painted.faces().iter().zip(truth.faces()).zip(&comparison.verdicts).enumerate();
    for (i, ((&shown, &nearest), &verdict)) in pixels {
        if verdict != Verdict::WrongOrder {
            continue;
        }
        let (x, y) = ((i % width) as u32, (i / width) as u32);
        // The same face mostly shows in the next wrong pixel, too.
        let (_, coverage) = last
            .take()
            .filter(|&(face, _)| face == shown)
            .unwrap_or_else(|| (shown, Coverage::new(rays, faces, shown, Outline::Whole)));
        let is_met = coverage.as_ref().is_some_and(|coverage| coverage.covers(x, y));
        last = Some((shown, coverage));
        if is_met {
            let pair = pairs.of([shown, nearest]);
            let depth = difference(rays, pair, x, y);
            result.pixels += 1;
            result.max = result.max.max(depth);
            result.sum += depth;
        }
    }
    result
}

/// The distance along the ray of a pixel between its points on two planes. The points are at −κ/φ
/// for a perspective, at −φ/κ for parallel rays; they are subtracted exactly before anything is
/// rounded.
fn difference(rays: &Rays, pair: &PlanePair, x: u32, y: u32) -> f64 {
    let at = pair.at(rays.pixel(x, y));
    let [p, q] = pair.divisors(rays, &at);
    (at.determinant.to_f64() / p / q * rays.depth_unit).abs()
}
