//! Dense sets: corners on a small lattice, random triangles, duplicates, polygons that touch.

use testkit::as_given::exact::Plane;
use testkit::as_given::scene::{Point, Scene, add, between, minus, point_within, times, turned};
use testkit::prelude::*;

/// The polygons that are not points or lines.
pub(crate) fn with_area(polygons: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    polygons.into_iter().filter(|polygon| Plane::of(polygon).is_proper()).collect()
}

/// Triangles with corners on a lattice, so close together that everything coincides.
pub(crate) fn lattice(dice: &mut Dice, n: usize) -> Scene {
    let across = (2.0 * n as f64).cbrt().ceil() as i64;
    let triangle = |_| {
        let place = point_within(dice, across);
        (0..3).map(|_| add(place, point_within(dice, 2))).collect()
    };
    Scene::new("lattice", with_area((0..n + n / 8).map(triangle).collect()))
}

/// Triangles of all sizes anywhere.
pub(crate) fn heap(dice: &mut Dice, n: usize) -> Scene {
    let triangle = |_| {
        let place = point_within(dice, 1 << 20);
        let size = 1 << between(dice, 12, 19);
        (0..3).map(|_| add(place, point_within(dice, size))).collect()
    };
    Scene::new("heap", with_area((0..n).map(triangle).collect()))
}

/// Every triangle one to four times, some reversed.
pub(crate) fn duplicates(dice: &mut Dice, n: usize) -> Scene {
    let mut polygons = Vec::new();
    let across = (n as f64).cbrt().ceil() as i64;
    while polygons.len() < n {
        let place = times(3, point_within(dice, across));
        let triangle: Vec<Point> = (0..3).map(|_| add(place, point_within(dice, 4))).collect();
        for triangle in with_area(vec![triangle]) {
            polygons.extend(vec![triangle; 1 + dice.below(4)]);
        }
    }
    Scene::new("duplicates", polygons).shuffled(dice)
}

/// Triangles, and other triangles with corners in the planes of these: inside, outside, on edges and on
/// corners.
pub(crate) fn tangent(dice: &mut Dice, n: usize) -> Scene {
    let across = ((n / 5) as f64).cbrt().ceil() as i64;
    let mut polygons = Vec::new();
    for k in 0..n as i64 / 5 {
        let place = times(40, [k % across, k / across % across, k / across / across]);
        let mut corner = || add(place, times(8, [0; 3].map(|_| between(dice, -3, 3))));
        let [a, b, c] = std::array::from_fn(|_| corner());
        let on = |s: i64, t: i64| -> Point {
            std::array::from_fn(|i| a[i] + (b[i] - a[i]) / 8 * s + (c[i] - a[i]) / 8 * t)
        };
        let mut some = || on(between(dice, -1, 8), between(dice, -1, 8));
        let (p, q, r, s) = (some(), some(), some(), some());
        let mut apex = || add(place, [0; 3].map(|_| between(dice, -20, 20)));
        let (u, v, w) = (apex(), apex(), apex());
        let others = [vec![p, q, u], vec![r, v, w], vec![a, b, v], vec![p, r, s]];
        polygons.push(vec![a, b, c]);
        polygons.extend(others);
    }
    Scene::new("tangent", with_area(polygons)).shuffled(dice)
}

/// Scenes side by side, each rotated differently.
pub(crate) fn copies(
    name: &str,
    dice: &mut Dice,
    n: usize,
    mut one: impl FnMut(&mut Dice) -> Vec<Vec<Point>>,
) -> Scene {
    let mut parts: Vec<Vec<Vec<Point>>> = Vec::new();
    let (mut count, mut size) = (0, 1);
    while count < n {
        let part = with_area(one(dice));
        count += part.len();
        size = part.iter().flatten().flatten().map(|c| c.abs()).fold(size, i64::max);
        // A rotated copy of the same scene, next to the first.
        for _ in 0..1 + dice.below(3) {
            count += part.len();
            parts.push(part.clone());
        }
        parts.push(part);
    }
    let across = (parts.len() as f64).cbrt().ceil() as i64;
    // Scenes are next to each other, or overlap by a third.
    let step = size + size * between(dice, 0, 2) / 2;
    let mut polygons = Vec::new();
    for (k, part) in (0..).zip(parts) {
        let place = times(
            step,
            minus([k % across, k / across % across, k / across / across], [across / 2; 3]),
        );
        let which = dice.below(48);
        for polygon in part {
            polygons.push(polygon.into_iter().map(|p| add(place, turned(p, which))).collect());
        }
    }
    Scene::new(name, polygons)
}
