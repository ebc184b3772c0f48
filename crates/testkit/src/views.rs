//! Exactly known viewpoints, many of them on a plane or a corner.

use super::dice::Dice;
use super::rational::{self, Plane, Point, Rational};
use super::rays::{Rays, Vector, vector};
use binspace::Viewpoint;
use binspace::glam::DVec3;
use binspace::internals::{Faces, Lattice};
use dashu_int::IBig;
use num_traits::Signed;
use std::cmp::Ordering;

/// A viewpoint, and its rounding by the library.
#[derive(Clone, Debug)]
pub struct View {
    pub viewpoint: Viewpoint,
    /// The eye in lattice units, rounded; or the direction of view, in integers.
    lattice: DVec3,
    /// The eye as the library rounds it; `None` for a direction, and for an eye that is so far away that it
    /// counts as a direction.
    eye: Option<Point>,
}

impl View {
    /// Creates a view from the nearest eye to a point of the lattice.
    pub fn eye(faces: &Faces, point: DVec3) -> Self {
        let world = faces.lattice().to_world(point.round().to_array());
        let lattice = DVec3::from(faces.lattice().to_lattice(world)).round();
        let eye = rounded_eye(in_lattice(faces.lattice(), world));
        Self { viewpoint: Viewpoint::Eye(world), lattice, eye }
    }

    /// Creates a view along a direction, rounded to 2⁻⁵² of the largest power of two in its largest
    /// component.
    pub fn direction(direction: DVec3) -> Self {
        let lattice = whole_direction(direction);
        Self { viewpoint: Viewpoint::Direction(direction), lattice, eye: None }
    }

    pub fn is_parallel(&self) -> bool {
        matches!(self.viewpoint, Viewpoint::Direction(_))
    }

    /// Returns the side of a plane on which the viewpoint is; `Equal` if it is on the plane, or looks along
    /// the plane.
    pub fn side(&self, plane: &Plane) -> Ordering {
        let towards = if self.is_parallel() { -self.lattice } else { self.lattice };
        rational::sign(&match &self.eye {
            Some(point) => plane.at(point),
            None => rational::scalar(&plane.normal, &rational::point(whole_direction(towards))),
        })
    }

    /// Returns the line of sight through a point: its start and direction.
    pub fn ray_to(&self, target: DVec3) -> (Vector, Vector) {
        let lattice = || vector(self.lattice.to_array());
        match self.viewpoint {
            Viewpoint::Eye(_) => {
                let direction = ((target - self.lattice) * 256.0).round();
                // An integer, but not always exact in `f64`.
                let exact = |eye: &Point| eye.each_ref().map(|c| c.numerator().clone());
                let origin = self.eye.as_ref().map_or_else(lattice, exact);
                (origin, vector(direction.to_array()))
            }
            Viewpoint::Direction(_) => (vector(target.round().to_array()), lattice()),
        }
    }
}

/// A direction scaled by a power of two to integers. The largest is from 2⁵² to 2⁵³.
fn whole_direction(direction: DVec3) -> DVec3 {
    let size = direction.abs().max_element();
    // The bits without the fraction.
    let power = f64::from_bits(size.to_bits() >> 52 << 52);
    (direction / power * (1u64 << 52) as f64).round()
}

/// Returns an eye as documented, in lattice units: rounded to an integer, or, beyond 2⁶¹, to a multiple of
/// the power of two that keeps 61 bits. `None` if it is too far to be a point.
pub fn rounded_eye(exact: Point) -> Option<Point> {
    let size = exact.iter().map(Signed::abs).max().expect("three");
    let fits = |&shift: &u32| size <= power_of_two(61 + shift);
    let unit = power_of_two((0..=360).find(fits)?);
    Some(exact.map(|c| (c / &unit).round() * &unit))
}

/// Returns a point of the world in lattice units.
pub fn in_lattice(lattice: &Lattice, point: DVec3) -> Point {
    let step = rational::step(lattice);
    let origin = rational::point(lattice.to_world([0.0; 3]));
    rational::difference(&rational::point(point), &origin).map(|c| c / &step)
}

pub fn power_of_two(exponent: u32) -> Rational {
    Rational::from(IBig::from(1) << exponent as usize)
}

/// Returns a viewpoint around, inside, on a plane or a corner of the scene, or collinear with two of its
/// fragments. There must be fragments.
pub fn some_view(faces: &Faces, rays: &Rays<'_>, dice: &mut Dice) -> View {
    let corner =
        |dice: &mut Dice| DVec3::from(faces.corner(dice.below(faces.corner_count()) as u32));
    let cube = |dice: &mut Dice| dice.point(-1.0, 1.0);
    let extent = (1u64 << 51) as f64;
    match dice.below(9) {
        0 => View::eye(faces, cube(dice) * extent * 4.0),
        1 => View::eye(faces, cube(dice) * extent),
        2 => View::eye(faces, corner(dice)),
        3 => {
            let face = dice.below(faces.len()) as u32;
            let [p, q, r] = faces.reference_triangle(face).map(|c| DVec3::from(faces.corner(c)));
            let (s, t) = (dice.around_zero(3), dice.around_zero(3));
            View::eye(faces, p + (q - p) * s + (r - p) * t)
        }
        4 | 5 => {
            let (a, b) = (rays.some_point(dice), rays.some_point(dice));
            View::eye(faces, a + (a - b) * (0.1 + 3.0 * dice.share()))
        }
        6 => {
            let mut eye = cube(dice) * extent;
            let axis = dice.below(3);
            eye[axis] = corner(dice)[axis];
            View::eye(faces, eye)
        }
        7 => {
            let direction = corner(dice) - corner(dice);
            View::direction(if direction == DVec3::ZERO { DVec3::X } else { direction })
        }
        _ => {
            let small = dice.whole_point(2);
            View::direction(if small == DVec3::ZERO { DVec3::NEG_Z } else { small })
        }
    }
}
