//! Rays of narrow views are at their true positions, or there are no rays.

use binspace::view::Projection;
use dashu_int::IBig;
use dashu_ratio::RBig;
use testkit::prelude::*;
use testkit::rational::{Point, exact, point, product, scalar};

/// The coefficients of a vector as a sum of three other vectors.
fn coefficients(vector: &Point, of: [&Point; 3]) -> Point {
    let [a, b, c] = of;
    let whole = scalar(a, &product(b, c));
    let parts = [(vector, b, c), (a, vector, c), (a, b, vector)];
    parts.map(|(a, b, c)| scalar(a, &product(b, c)) / &whole)
}

fn is_parallel(camera: &Camera) -> bool {
    matches!(camera.projection(), Projection::Parallel { .. })
}

/// The distance, in pixels, of a camera's rays from their true positions at the corners of the picture; for
/// parallel rays, relative to the middle of the picture. `None` if there are no rays.
fn off(camera: &Camera, faces: &Faces, samples: u32) -> Option<f64> {
    let rays = Rays::sampled(camera, faces, samples).ok()?;
    let axes = [camera.forward(), camera.right(), -camera.up()].map(point);
    let axes = axes.each_ref();
    let rational = |v: [i128; 3]| v.map(|c| RBig::from(IBig::from(c)));
    let [width, height] = rays.size();
    let mut most = 0.0_f64;
    for [x, y] in [[0, 0], [width - 1, 0], [0, height - 1], [width - 1, height - 1]] {
        let [start, way] = rays.ray(x, y).map(rational);
        let found = if is_parallel(camera) {
            // The difference of two opposite corners is twice the value at the middle.
            let opposite = rational(rays.ray(width - 1 - x, height - 1 - y)[0]);
            let arm = std::array::from_fn(|i| (&start[i] - &opposite[i]) / exact(2.0));
            let pixel = exact(faces.lattice().length_to_lattice(camera.pixel_size()[1]));
            coefficients(&arm, axes).map(|c| c / &pixel)
        } else {
            let [ahead, right, down] = coefficients(&way, axes);
            let pixel = ahead.clone() * exact(camera.pixel_size()[1]);
            [ahead, right / &pixel, down / &pixel]
        };
        let place =
            |at: u32, side: u32| (f64::from(at) - 0.5 * f64::from(side - 1)) / f64::from(samples);
        let expected = [place(x, width), place(y, height)].map(exact);
        let off = [0, 1].map(|i: usize| (&found[i + 1] - &expected[i]).to_f64().value());
        most = most.max(off[0].hypot(off[1]));
    }
    Some(most)
}

#[test]
fn rays_are_less_than_a_thousandth_of_a_pixel_off() {
    let (mut random, mut dice) = (Dice(3), Dice(3));
    let cube = [[DVec3::ZERO, DVec3::X, DVec3::ONE], [DVec3::Y, DVec3::Z, DVec3::ONE]];
    let (faces, _) = Faces::new(cube, Some(0.0)).unwrap();
    let (mut worst, mut refused, mut accepted) = (0.0_f64, 0, 0);
    let sizes = [[1000, 1000], [4000, 4000], [64, 48], [1, 1], [2, 65536], [640, 480]];
    for round in 0..3000 {
        let size = sizes[round % 6];
        let eye = random.point(-3.0, 3.0);
        // From a wide view to one with extremely small pixels.
        let narrow = 10.0_f64.powf(-13.0 * dice.share());
        let camera = match dice.below(3) {
            0 => Camera::parallel(eye, DVec3::Z, random.point(0.0, 1.0), narrow, size),
            _ => Camera::perspective(eye, random.point(0.0, 1.0), DVec3::Z, narrow, size),
        };
        let (camera, samples) = (camera.unwrap(), [1, 1, 3][dice.below(3)]);
        match off(&camera, &faces, samples) {
            Some(off) => {
                assert!(off < 1e-3, "{off} px: {camera:?}");
                (worst, accepted) = (worst.max(off), accepted + 1);
            }
            None => {
                let sides = size.map(f64::from);
                let unit = if is_parallel(&camera) { 4e-12 } else { 4e-14 };
                let least = unit * (sides[0] + sides[1]).max(8.0);
                assert!(camera.pixel_size()[1] < least, "{camera:?}");
                refused += 1;
            }
        }
    }
    assert!(accepted > 1_000 && refused > 100, "{accepted} {refused}");
    assert!(worst > 2e-4, "the nearest to the limit: {worst}");
}
