//! Points of a circle, the same on every machine.

use glam::DVec2;
use std::f64::consts::PI;

/// The point of the unit circle at `step`/`steps` of a full turn, counter-clockwise from (1, 0),
/// within a few units in the last place.
///
/// Not `f64::sin_cos`, whose last bits depend on the platform. The circle's eightfold symmetry is
/// kept exactly: quarter turns give exact zeros and ones.
pub fn unit_circle(step: u64, steps: u64) -> DVec2 {
    let eighths = 8 * (step % steps);
    let (octant, rest) = (eighths / steps, eighths % steps);
    // Odd octants are mirror images: measure back from their end.
    let from_axis = if octant % 2 == 0 { rest } else { steps - rest };
    let (sin, cos) = small_sin_cos(from_axis as f64 / steps as f64 * (PI / 4.0));
    match octant {
        0 => DVec2::new(cos, sin),
        1 => DVec2::new(sin, cos),
        2 => DVec2::new(-sin, cos),
        3 => DVec2::new(-cos, sin),
        4 => DVec2::new(-cos, -sin),
        5 => DVec2::new(-sin, -cos),
        6 => DVec2::new(sin, -cos),
        _ => DVec2::new(cos, -sin),
    }
}

/// Taylor series for 0 ≤ x ≤ π/4; the terms left out are below 1e-20.
fn small_sin_cos(x: f64) -> (f64, f64) {
    let square = x * x;
    let (mut sin, mut cos) = (1.0, 1.0);
    for k in (1..=9).rev() {
        let even = f64::from(2 * k);
        sin = 1.0 - square / (even * (even + 1.0)) * sin;
        cos = 1.0 - square / ((even - 1.0) * even) * cos;
    }
    (x * sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        for step in 0..1000 {
            let angle = 2.0 * PI * step as f64 / 1000.0;
            let distance = unit_circle(step, 1000).distance(DVec2::from_angle(angle));
            // The angle itself is rounded by up to half of 8.9e-16.
            assert!(distance < 1.5e-15, "step {step}: {distance:e}");
        }
    }

    #[test]
    fn quarter_turns_are_exact() {
        let quarters = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
        for (quarter, expected) in quarters.into_iter().enumerate() {
            assert_eq!(unit_circle(quarter as u64 * 25, 100), expected);
        }
    }
}
