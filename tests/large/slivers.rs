//! Slivers among other polygons, at the default tolerance of `f64`: 10⁻⁹ of the extent.

use super::all_scenes::{self, KINDS};
use super::layers;
use super::trial::Trial;
use testkit::as_given::scene::{Point, Scene, add, each, times, world};
use testkit::as_given::trees_by_rays::Score;
use testkit::prelude::*;
use testkit::slivers::{Sliver, along, whole};

/// Coordinates are below this. Too large: viewpoints cannot have enough exact digits.
const SIZE: i64 = 1 << 43;
/// About half of the default tolerance.
const NEAR: i64 = SIZE / 1_000_000_000;

/// A scene of a kind, scaled up. It is mixed in any order with slivers, with layers parallel to the slivers
/// at distances of up to a few tolerances, and with a plane with noise of about the tolerance.
fn scene(kind: usize, dice: &mut Dice, n: usize) -> Scene {
    let plain = all_scenes::scene(kind, dice, n);
    let scale = (SIZE / (plain.size() as u64).next_power_of_two() as i64).max(1);
    let mut polygons = each(plain.polygons, |p| times(scale, p));
    for _ in 0..2 {
        let Sliver { corners, steps } = Sliver::new(dice, SIZE);
        polygons.push(corners.to_vec());
        polygons.extend([0; 4].map(|_| layer(corners[0], steps, dice)));
    }
    let from = [0; 3].map(|_| whole(dice, SIZE / 2));
    let noisy = layers::noisy_plane(dice, n / 4).polygons;
    polygons.extend(each(noisy, |p| add(from, times(NEAR, p))));
    let name = format!("{} and slivers", plain.name);
    let scene = Scene::new(&name, polygons).shuffled(dice);
    let corners = |polygon: &Vec<Point>| polygon.iter().map(|&p| world(p)).collect::<Vec<DVec3>>();
    let tree = BspTree::build(scene.polygons.iter().map(corners)).expect("within budget");
    let tolerance = tree.stats().tolerance;
    scene.with_tolerance(tolerance)
}

/// A parallelogram along a plane.
fn layer(from: Point, steps: [Point; 2], dice: &mut Dice) -> Vec<Point> {
    let off = [0; 3].map(|_| whole(dice, 6 * NEAR));
    let [s, t] = [0; 2].map(|_| whole(dice, SIZE / 64));
    let [a, b] = [0; 2].map(|_| SIZE / 64 + whole(dice, SIZE / 128));
    let corners = [[s, t], [s + a, t], [s + a, t + b], [s, t + b]];
    corners.map(|corner| add(along(from, steps, corner), off)).to_vec()
}

const TRIAL: Trial<'static> = Trial { heuristics: Heuristic::ALL, views: 10, rays: 10, most: 200 };

#[test]
fn scenes_with_slivers_are_in_order_up_to_the_default_tolerance() {
    let scores = TRIAL.hold_all(KINDS, 4, |kind, dice| scene(kind, dice, 80));
    let all = Score::total(&scores);
    assert!(all.given_up == 0 && all.pairs > 200_000, "{all:?}");
    assert!(all.excused > 0 && all.excused < all.pairs / 20, "{all:?}");
}
