//! All kinds of scenes.

use super::{copies, heaps, layers, planes_through_lines, round_bodies};
use testkit::as_given::scene::Scene;
use testkit::prelude::*;

type Make = fn(&mut Dice, usize) -> Scene;

const SHAPED: [Make; 19] = [
    layers::parallel,
    layers::tilted,
    layers::nearly_parallel,
    layers::crossing_planes,
    layers::one_plane,
    layers::bricks,
    layers::t_junctions,
    heaps::lattice,
    heaps::heap,
    heaps::duplicates,
    heaps::tangent,
    round_bodies::sphere,
    round_bodies::rough_globe,
    round_bodies::shells,
    round_bodies::cones,
    round_bodies::pipe,
    planes_through_lines::rulings,
    planes_through_lines::fans,
    planes_through_lines::far_line,
];

/// The number of kinds without a tolerance.
pub(crate) const KINDS: usize = SHAPED.len() + copies::FAMILIES;

/// A scene of a kind, of about `n` polygons.
pub(crate) fn scene(kind: usize, dice: &mut Dice, n: usize) -> Scene {
    match SHAPED.get(kind) {
        Some(make) => make(dice, n),
        None => copies::of_family(kind - SHAPED.len(), dice, n),
    }
}

/// A scene with a tolerance.
pub(crate) fn noisy(kind: usize, dice: &mut Dice, n: usize) -> Scene {
    if kind.is_multiple_of(2) {
        layers::noisy_plane(dice, n)
    } else {
        layers::noisy_layers(dice, n)
    }
}
