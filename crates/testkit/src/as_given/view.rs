//! Exactly known viewpoints, most of them at places where sides are hard to decide.

use super::exact::{Vector, wide};
use super::ray::Ray;
use super::scene::{Point, Scene, add, between, minus, times};
use crate::prelude::*;

/// The viewpoint: integers over a power of two, or a direction whose largest component is a power of two, so
/// that the library does not round it.
#[derive(Clone, Debug)]
pub enum Place {
    Eye(Vector, i128),
    Direction(Vector),
}

/// A viewpoint, and the target of rays from there.
#[derive(Clone, Debug)]
pub struct View {
    pub place: Place,
    /// The polygons that most rays aim at; all polygons if this is empty.
    about: Vec<usize>,
    /// A point that the first ray aims at: numerators and a denominator.
    target: Option<(Vector, i128)>,
}

/// The number of bits that a viewpoint may have beyond the bits of the scene's coordinates, so that all bits
/// together fit the lattice and an `f64`.
fn spare_bits(scene: &Scene) -> u32 {
    50 - (scene.size() as u64).next_power_of_two().ilog2()
}

/// The least distance from a plane or a point is one unit divided by this number.
fn hair(scene: &Scene) -> i128 {
    1 << spare_bits(scene).min(18)
}

impl View {
    fn new(place: Place) -> Self {
        Self { place, about: vec![], target: None }
    }

    fn eye(p: Point) -> Self {
        Self::new(Place::Eye(wide(p), 1))
    }

    fn about(self, about: Vec<usize>) -> Self {
        Self { about, ..self }
    }

    pub fn viewpoint(&self) -> Viewpoint {
        match self.place {
            Place::Eye(numerators, below) => {
                Viewpoint::Eye(DVec3::from_array(numerators.map(|c| c as f64 / below as f64)))
            }
            Place::Direction(direction) => {
                Viewpoint::Direction(DVec3::from_array(direction.map(|c| c as f64)))
            }
        }
    }

    /// Returns a ray to a corner, a point of an edge or a point inside a polygon; `None` if the eye is there.
    pub fn some_ray(&self, scene: &Scene, generic: bool, dice: &mut Dice) -> Option<Ray> {
        let all = self.about.is_empty() || dice.below(4) == 0;
        let polygon = if all {
            dice.below(scene.polygons.len())
        } else {
            self.about[dice.below(self.about.len())]
        };
        let corners = &scene.polygons[polygon];
        let first = dice.below(corners.len());
        let corner = |k: usize| corners[(first + k) % corners.len()];
        let mut weight = |most| 1 + dice.below(most) as i128;
        let parts: Vec<(Point, i128)> = match weight(8) {
            1 if !generic => vec![(corner(0), 1)],
            2 if !generic => vec![(corner(0), weight(4)), (corner(1), weight(4))],
            3 if !generic => (0..corners.len()).map(|k| (corner(k), 1)).collect(),
            _ => (0..corners.len()).map(|k| (corner(k), weight(30))).collect(),
        };
        let total: i128 = parts.iter().map(|&(_, weight)| weight).sum();
        let target: Vector =
            std::array::from_fn(|i| parts.iter().map(|&(p, w)| w * i128::from(p[i])).sum());
        self.ray_to(target, total)
    }

    /// Returns the ray to the view's target, if the view has a target.
    pub fn first_ray(&self) -> Option<Ray> {
        self.target.and_then(|(target, total)| self.ray_to(target, total))
    }

    fn ray_to(&self, target: Vector, total: i128) -> Option<Ray> {
        let ray = match self.place {
            Place::Eye(eye, below) => {
                let direction = std::array::from_fn(|i| below * target[i] - total * eye[i]);
                Ray { origin: eye, below, direction, endless: false }
            }
            Place::Direction(direction) => {
                Ray { origin: target, below: total, direction, endless: true }
            }
        };
        (ray.direction != [0; 3]).then_some(ray)
    }
}

fn some_corner(scene: &Scene, dice: &mut Dice) -> (usize, Point) {
    let polygon = dice.below(scene.polygons.len());
    let corners = &scene.polygons[polygon];
    (polygon, corners[dice.below(corners.len())])
}

/// A point on a polygon's plane, within a few diameters of the polygon.
fn on_plane(scene: &Scene, polygon: usize, dice: &mut Dice) -> Point {
    let corners = &scene.polygons[polygon];
    let arm = |k: usize| minus(corners[k], corners[0]);
    let (s, t) = (between(dice, -3, 3), between(dice, -3, 3));
    add(corners[0], add(times(s, arm(1)), times(t, arm(corners.len() - 1))))
}

/// Returns a viewpoint around the scene, within it, on a corner or a plane, just off a plane, far out at the
/// height of a corner, or collinear with two corners; or a direction along an edge or a plane, or next to
/// one.
pub fn some_view(scene: &Scene, kind: usize, dice: &mut Dice) -> View {
    let size = scene.size();
    let anywhere = |dice: &mut Dice, n: i64| [0; 3].map(|_| between(dice, -n, n));
    let polygon = dice.below(scene.polygons.len());
    match kind % KINDS {
        0 => View::eye(anywhere(dice, 4 * size)),
        1 => View::eye(anywhere(dice, size)),
        2 => View::eye(some_corner(scene, dice).1),
        3 => View::eye(on_plane(scene, polygon, dice)).about(vec![polygon]),
        4 => {
            // Fewer bits are spare, because eyes are up to a few diameters from the scene.
            let below = hair(scene) >> 4;
            let mut eye = wide(on_plane(scene, polygon, dice)).map(|c| c * below);
            eye[dice.below(3)] += [-1, 1][dice.below(2)];
            View::new(Place::Eye(eye, below)).about(vec![polygon])
        }
        5 => {
            let (a, b) = (some_corner(scene, dice), some_corner(scene, dice));
            View::eye(add(a.1, times(between(dice, 1, 3), minus(a.1, b.1)))).about(vec![a.0, b.0])
        }
        6 => {
            let mut eye = some_corner(scene, dice).1;
            let axis = dice.below(3);
            let far = (spare_bits(scene) - 1).min(11 + dice.below(8) as u32);
            eye[axis] = [-1, 1][dice.below(2)] * ((size as u64).next_power_of_two() << far) as i64;
            View::eye(eye)
        }
        7 => {
            let edge = minus(some_corner(scene, dice).1, some_corner(scene, dice).1);
            direction(edge, scene.size(), dice)
        }
        8 => along_plane(scene, polygon, dice).about(vec![polygon]),
        _ => direction(anywhere(dice, 3), 3, dice),
    }
}

/// The number of kinds of views.
pub const KINDS: usize = 10;

/// Returns an eye collinear with points of two consecutive polygons, which may be near each other; rays aim
/// at both.
pub fn in_line(scene: &Scene, dice: &mut Dice) -> View {
    let first = dice.below(scene.polygons.len());
    let second = (first + 1 + dice.below(3)) % scene.polygons.len();
    // A quarter of the sum of four corners, one of them twice in a triangle.
    let mut inside = |polygon: usize| {
        let corners = &scene.polygons[polygon];
        let from = dice.below(corners.len());
        (0..4).fold([0; 3], |sum, k| add(sum, corners[(from + k) % corners.len()]))
    };
    let (a, b) = (inside(first), inside(second));
    let eye = add(a, times(between(dice, 1, 3), minus(a, b)));
    let view = View::new(Place::Eye(wide(eye), 4)).about(vec![first, second]);
    View { target: Some((wide(a), 4)), ..view }
}

/// A direction near a given one. Its largest component is a power of two, along the axis in which the given
/// direction is longest.
fn direction(near: Point, size: i64, dice: &mut Dice) -> View {
    let axis = (0..3).max_by_key(|&i| near[i].abs()).unwrap_or(0);
    let mut rounded = wide(near);
    let longest = rounded[axis];
    let power = (longest.unsigned_abs().max(1)).next_power_of_two() as i128;
    if power != longest.abs() && dice.below(2) == 0 {
        // Next to the given direction, up to rounding.
        let unit = (size as u64).next_power_of_two() as i128;
        rounded = rounded.map(|c| c * unit / longest.abs().max(1));
        rounded[axis] = unit * if longest < 0 { -1 } else { 1 };
    } else {
        rounded[axis] = power * if longest < 0 { -1 } else { 1 };
    }
    View::new(Place::Direction(rounded))
}

/// A direction along a polygon's plane, if an exact one is found; otherwise just off it.
fn along_plane(scene: &Scene, polygon: usize, dice: &mut Dice) -> View {
    let corners = &scene.polygons[polygon];
    let arm = |k: usize| minus(corners[k], corners[0]);
    let (u, v) = (arm(1), arm(corners.len() - 1));
    for _ in 0..64 {
        let (s, t) = (between(dice, -8, 8), between(dice, -8, 8));
        let mut along = wide(add(times(s, u), times(t, v)));
        let longest = |v: Vector| v.map(i128::unsigned_abs).into_iter().max().unwrap_or(0);
        if !longest(along).is_power_of_two() {
            continue;
        }
        if dice.below(2) == 0 {
            along = along.map(|c| c * hair(scene));
            let axis = (0..3).min_by_key(|&i| along[i].abs()).unwrap_or(0);
            along[axis] += [-1, 1][dice.below(2)];
        }
        if longest(along).is_power_of_two() {
            return View::new(Place::Direction(along));
        }
    }
    direction(minus(corners[1], corners[0]), scene.size(), dice)
}
