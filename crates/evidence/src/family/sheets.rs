//! Thin differences: planes that almost coincide, and triangles that have almost no width.

use glam::{DVec2, DVec3};

use super::pose::{Pose, empty, push_shuffled};
use super::trial::Trial;
use binspace::internals::SplitMix64;
use binspace::internals::unit_circle;

/// Six triangles around one point. Triangle `i` rises by `angle` in its own direction, a sixth of a turn from
/// the next one's. So neighbours cross at `angle`, and other triangles at up to twice this angle.
pub(super) fn angle(angle: f64, seed: u64) -> Trial {
    let mut random = SplitMix64::new(seed);
    let mut pose = Pose::random(&mut random);
    pose.origin = random.point(0.0, 1.0);
    let mut scene = empty("angle", angle);
    let triangles = (0..6).map(|i| {
        let rise = unit_circle(i, 6);
        let corner = |k: u64| {
            let at = unit_circle(3 * i + 35 * k, 105);
            pose.place(at.extend(angle * at.dot(rise)))
        };
        (0..3).map(corner).collect()
    });
    push_shuffled(&mut scene, triangles.collect(), &mut random);
    let looks = pose.looks(2.5, 0.6, &mut random);
    Trial::new(scene, looks)
}

/// Twelve triangles above each other. Each is smaller than the triangle below, lies `gap` times the extent
/// above it, and is rotated a little, so that all triangles are visible.
pub(super) fn gap(gap: f64, seed: u64) -> Trial {
    const LAYERS: u32 = 12;
    let mut random = SplitMix64::new(seed);
    let mut pose = Pose::random(&mut random);
    pose.origin = random.point(0.0, 1.0);
    let mut scene = empty("gap", gap);
    let corners = [0, 1, 2].map(|k| unit_circle(k, 3));
    let lowest = corners.map(|c| pose.place(c.extend(0.0)));
    let [low, high] = [DVec3::min, DVec3::max].map(|f| f(f(lowest[0], lowest[1]), lowest[2]));
    let rise = gap * (high - low).max_element();
    let layers = (0..LAYERS).map(|i| {
        let size = f64::from(LAYERS + 2 - i) / f64::from(LAYERS + 2);
        corners.iter().map(|&c| pose.place((c * size).extend(f64::from(i) * rise))).collect()
    });
    push_shuffled(&mut scene, layers.collect(), &mut random);
    let looks = pose.looks(2.5, 0.6, &mut random);
    Trial::new(scene, looks)
}

/// Sixteen triangles of length 1 and, where they meet, width `width`: eight across eight. Each triangle is
/// rotated about its long axis and lifted by about its width, so that most triangles penetrate each other.
/// The views are as near as the width requires.
pub(super) fn sliver(width: f64, seed: u64) -> Trial {
    const EACH: i32 = 8;
    /// The position along the length at which the others cross.
    const BEFORE: f64 = 0.25;
    let mut random = SplitMix64::new(seed);
    let mut pose = Pose::random(&mut random);
    pose.origin = random.point(0.0, 1.0);
    let mut scene = empty("sliver", width);
    let mut slivers = Vec::new();
    for across in [false, true] {
        for i in 0..EACH {
            let side = 1.3 * width * (f64::from(i) - 0.5 * f64::from(EACH - 1));
            let (roll, lift) = (random.range(-0.7, 0.7), random.range(-0.5, 0.5) * width);
            // A base of `base` and a tip: `width` wide at 0.
            let base = width / (1.0 - BEFORE);
            let corner = |along: f64, aside: f64| {
                let at = DVec2::new(along, side + aside);
                let at = if across { DVec2::new(-at.y, at.x) } else { at };
                pose.place(at.extend(lift + roll * aside))
            };
            slivers.push(vec![
                corner(-BEFORE, -0.5 * base),
                corner(1.0 - BEFORE, 0.0),
                corner(-BEFORE, 0.5 * base),
            ]);
        }
    }
    push_shuffled(&mut scene, slivers, &mut random);
    let reach = 6.0 * width;
    let looks = pose.looks(3.0 * reach, reach, &mut random);
    Trial::new(scene, looks)
}
