//! What a painted picture shows that the depth buffer does not, pixel by pixel.

use super::image::{Image, NONE};
use super::plane::{determinant, kappa, phi};
use super::rays::{Given, Rays};
use crate::geom::{Faces, Plane, PlaneId};

/// What is to be said of one pixel of a painted picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Nothing is there, and nothing is painted.
    Empty,
    /// The right polygon is painted.
    Right,
    /// Another polygon is painted than the nearest, but the tolerance makes the two equals.
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

/// Rounded corners that still count as on a plane, in lattice units: a corner on a plane by
/// definition alone is kept rounded, by up to 1 unit; 4 such may come together. Nothing is
/// allowed for where the tolerance is 0 and no corner is moved.
const MOVED_CORNERS: f64 = 4.0;

/// Compares a painted picture with a true one, both made with the same rays.
///
/// Polygons are compared, not faces: two faces of one polygon are the same. A pixel is *contested*
/// if, along its ray, the painted face and the true one are equally far, exactly, or one is met
/// within 2 τ of the plane of the other, τ being the tolerance. That is what the tolerance can do:
/// two polygons, each within τ of a plane that divides the scene, both count as part of that plane,
/// and then their order is that of the input. With τ = 0, ties alone are contested.
///
/// The rule knows the polygons, not the planes that divided the scene; for these see [`is_open`].
pub fn compare(rays: &Rays, faces: &Faces, painted: &Image, truth: &Image) -> Comparison {
    let width = rays.size()[0] as usize;
    let mut result = Comparison::default();
    let judge = |(i, (&shown, &nearest)): (usize, (&u32, &u32))| match (shown, nearest) {
        (NONE, NONE) => Verdict::Empty,
        (NONE, _) => Verdict::Hole,
        (_, NONE) => Verdict::Spill,
        _ if faces.polygon(shown) == faces.polygon(nearest) => Verdict::Right,
        _ if is_contested(rays, faces, shown, nearest, (i % width) as u32, (i / width) as u32) => {
            Verdict::Contested
        }
        _ => Verdict::WrongOrder,
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

/// Whether the tolerance makes equals of the faces `p` and `q` on the ray of a pixel.
fn is_contested(rays: &Rays, faces: &Faces, p: u32, q: u32, x: u32, y: u32) -> bool {
    let [p, q] = [p, q].map(|face| faces.plane(PlaneId::face(face)));
    let pixel = rays.pixel(x, y);
    // Either plane where the ray meets the other is this, over the other's divisor.
    let met = |to, on| distance(rays, to, on, pixel);
    let tolerance = faces.tolerance();
    let allowed = if tolerance > 0.0 { 2.0 * tolerance + MOVED_CORNERS } else { 0.0 };
    met(&p, &q).min(met(&q, &p)) <= allowed
}

/// How far from a plane the ray of a pixel meets another, in lattice units, rounded.
fn distance(rays: &Rays, to: &Plane, on: &Plane, pixel: Given) -> f64 {
    let divisor = if rays.is_perspective() { phi(on, pixel) } else { kappa(rays, on) };
    let value = determinant(rays, to, on, pixel).to_f64().abs();
    value / (divisor.to_f64().abs() * to.normal_f64().length())
}

/// Whether the tolerance leaves the order of two faces open along the ray of a pixel, given the
/// plane between their pieces: the ray meets the nearer one within the tolerance of that plane, and
/// meets the other, or begins, within it as well.
///
/// That is all that a tolerance can do. Say the eye is in front of the plane, and a piece that the
/// order puts in front is hidden by one that it puts behind. Along the ray, the height above the
/// plane is linear. It is positive at the eye, at most τ where the ray meets the hiding piece, and
/// at least −τ further on, at the hidden one. Where it falls, both pieces are met within τ; where it
/// rises, it is at most τ from the eye to the hiding piece.
pub fn is_open(
    rays: &Rays,
    faces: &Faces,
    plane: PlaneId,
    [nearest, other]: [u32; 2],
    [x, y]: [u32; 2],
) -> bool {
    let tolerance = faces.tolerance();
    if tolerance == 0.0 {
        return false;
    }
    let allowed = tolerance + MOVED_CORNERS;
    let plane = faces.plane(plane);
    let pixel = rays.pixel(x, y);
    let meets = |face| distance(rays, &plane, &faces.plane(PlaneId::face(face)), pixel) <= allowed;
    let begins = || {
        let height = kappa(rays, &plane).to_f64().abs() / plane.normal_f64().length();
        rays.is_perspective() && height <= allowed
    };
    meets(nearest) && (meets(other) || begins())
}
