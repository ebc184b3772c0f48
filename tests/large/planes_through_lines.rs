//! Planes through one line.

use testkit::as_given::scene::{Point, Scene, add, between, each, tilt, times};
use testkit::prelude::*;

/// Strips along both rulings of z = x y: each crosses all strips of the other ruling.
pub(crate) fn rulings(dice: &mut Dice, n: usize) -> Scene {
    let patches = (n / 60).max(1);
    let mut polygons = Vec::new();
    for patch in 0..patches as i64 {
        let half = 15;
        let from = add([0, 0, 0], times(200, [patch % 4, patch / 4 % 4, 8 * (patch / 16)]));
        for i in -half..half {
            let one = [[i, -half, -half * i], [i, half, half * i]];
            let other = one.map(|[x, y, z]| [y, x, z]);
            // A strip along the line, and flat, steep or upright across it.
            let (flat, upright) = (between(dice, -1, 1), between(dice, 1, 6));
            for (line, arm) in [(one, [flat, 0, upright]), (other, [0, flat, upright])] {
                let [a, b] = line.map(|p| add(from, p));
                polygons.push(vec![a, b, add(b, arm), add(a, arm)]);
            }
        }
    }
    Scene::new("rulings", polygons).shuffled(dice)
}

/// Rectangles around an axis. Some begin at the axis, and some go through it.
pub(crate) fn fans(dice: &mut Dice, n: usize) -> Scene {
    let mut polygons = Vec::new();
    for fan in 0..(n / 50) as i64 {
        let place = times(400, [fan % 3, fan / 3 % 3, fan / 9]);
        let turn: fn(Point) -> Point =
            [|p| p, tilt, |[x, y, z]: Point| [z, x, y]][fan as usize % 3];
        for _ in 0..50 {
            let [x, y] = loop {
                let arm = [0; 2].map(|_| between(dice, -30, 30));
                if arm != [0; 2] {
                    break arm;
                }
            };
            let start = [0, 0, -1, -2][dice.below(4)];
            let (low, high) = (between(dice, -60, 0), between(dice, 1, 60));
            let corner = |k: i64, z: i64| add(place, turn([k * x, k * y, z]));
            polygons.push(vec![
                corner(start, low),
                corner(1, low),
                corner(1, high),
                corner(start, high),
            ]);
        }
    }
    Scene::new("fans", polygons).shuffled(dice)
}

/// Fans of triangles. Their planes all contain one line, which no triangle touches.
pub(crate) fn far_line(dice: &mut Dice, n: usize) -> Scene {
    let triangle = |_| {
        let [x, y] = [between(dice, 1, 40), between(dice, -40, 40)];
        let mut corner = || {
            let k = between(dice, 20, 60);
            [k * x, k * y, between(dice, -2000, 2000)]
        };
        vec![corner(), corner(), corner()]
    };
    let triangles = super::heaps::with_area((0..n).map(triangle).collect());
    Scene::new("far line", each(triangles, tilt))
}
