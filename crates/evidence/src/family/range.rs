//! Scenes of any scale, and scenes of many scales at once.

use glam::DVec3;

use super::crowds::push_crowd;
use super::pose::{Pose, empty};
use super::trial::{HALF_HEIGHT, Look, Trial};
use binspace::internals::SplitMix64;
use binspace::scene::{Scene, layers, newell_bars};

/// Twenty crossing triangles, ten layers 1e-4 apart and three bars in a cycle, side by side,
/// multiplied by `factor`.
pub(super) fn scale(factor: f64, seed: u64) -> Trial {
    let mut random = SplitMix64::new(seed);
    let pose = Pose::random(&mut random);
    let mut unscaled = empty("scale", factor);
    push_crowd(&mut unscaled, 20, pose.place(DVec3::new(-0.6, 0.5, 0.0)), &mut random);
    let bars = newell_bars();
    let (low, high) = bars.bounds().unwrap_or_default();
    let size = (high - low).max_element();
    for (part, shift, size) in [
        (&layers(10, 1e-4), DVec3::new(0.6, 0.5, 0.0), 2.0),
        (&bars, DVec3::new(0.0, -0.6, 0.0), size),
    ] {
        for (i, polygon) in part.polygons().enumerate() {
            let place = |&p: &DVec3| pose.place(p / size + shift);
            unscaled.push(polygon.points().iter().map(place), (i % 8) as u32);
        }
    }
    let mut scene = empty("scale", factor);
    for (i, polygon) in unscaled.polygons().enumerate() {
        scene.push(polygon.points().iter().map(|&p| p * factor), (i % 8) as u32);
    }
    let scaled =
        |look: Look| Look { eye: look.eye * factor, target: look.target * factor, up: look.up };
    let looks = pose.looks(3.6, 1.0, &mut random).into_iter().map(scaled).collect();
    Trial::new(scene, looks)
}

/// Nine pairs of triangles, each in its own place of the picture. The triangles of a pair cross at an angle
/// of 1/500. The depths of the pairs grow from 1 to `ratio` by a constant factor. Pairs grow with their
/// depths, so that all look equally large. Another triangle lies behind all pairs.
pub(super) fn depth_range(ratio: f64, seed: u64) -> Trial {
    /// The slope of one triangle of a pair against the other.
    const SLOPE: f64 = 2e-3;
    let mut random = SplitMix64::new(seed);
    let pose = Pose::random(&mut random);
    let mut scene = empty("depth-range", ratio);
    // The eighth root, by square roots, because these have the same result on every machine.
    let step = ratio.sqrt().sqrt().sqrt();
    let mut depth = 1.0;
    for level in 0..9u32 {
        let (column, row) = (f64::from(level % 3) - 1.0, f64::from(level / 3) - 1.0);
        push_pair(&mut scene, &pose, [column * 0.26, row * 0.21], depth, SLOPE, level);
        depth *= step;
    }
    let far = [(-2.0, -1.0), (2.0, -1.0), (0.0, 3.0)];
    scene.push(far.map(|(x, y)| pose.place(DVec3::new(x, y, 1.1) * ratio)), 7);
    let jitter = random.point(-0.02, 0.02);
    let eyes = [DVec3::ZERO, jitter, DVec3::new(0.1, 0.0, -0.2), DVec3::new(0.0, -0.1, 0.1)];
    let mut looks: Vec<Look> =
        eyes.iter().map(|&eye| pose.look(eye, DVec3::new(0.0, 0.0, ratio))).collect();
    looks.push(pose.look(DVec3::new(0.3, 0.2, 0.4) * ratio, DVec3::new(-0.3, 0.1, 1.0) * ratio));
    Trial { scene, looks, half_height: HALF_HEIGHT }
}

/// Two triangles around a point of the picture: one upright, the other crossing it.
fn push_pair(scene: &mut Scene, pose: &Pose, [x, y]: [f64; 2], depth: f64, slope: f64, level: u32) {
    for (tilt, flip, material) in [(0.0, 1.0, 2 * level), (slope, -1.0, 2 * level + 1)] {
        let corners = [(-0.12, -0.06), (0.12, -0.06), (0.0, 0.1)];
        let place = |(u, v): (f64, f64)| {
            let v = v * flip;
            pose.place(DVec3::new(x + u, y + v, 1.0 + tilt * u) * depth)
        };
        scene.push(corners.map(place), material % 8);
    }
}
