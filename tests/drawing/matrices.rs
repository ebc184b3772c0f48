//! Cameras from matrices: compares pictures and drawings with the matrix applied in floats.

use binspace::glam::{DMat4, DVec4};
use binspace::paint::paint_tree;
use binspace::raster::zbuffer;
use binspace::verify::verify;
use testkit::fill::{Score, check};
use testkit::prelude::*;
use testkit::scenes::triangles;

const SIZE: [u32; 2] = [90, 60];

/// Pixels are not compared if the distance to a triangle's edge, or to another depth, is a smaller share than
/// this.
const NEAR: f64 = 1e-6;

/// A triangle as a matrix shows it. In homogeneous coordinates, the vector (x, y, 1) of a place of the
/// picture is a weighted sum of the vectors of the corners. The weights are products of this vector with the
/// three stored vectors, and are positive inside the triangle (Olano & Greer 1997).
struct Shown {
    weights: [DVec3; 3],
    depths: [f64; 3],
}

impl Shown {
    fn new(matrix: &DMat4, triangle: &[DVec3]) -> Self {
        let clip = [0, 1, 2].map(|i: usize| *matrix * triangle[i].extend(1.0));
        let [a, b, c] = clip.map(|corner| DVec3::new(corner.x, corner.y, corner.w));
        let volume = a.dot(b.cross(c));
        let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|dual| dual / volume);
        Self { weights, depths: clip.map(|corner| corner.z) }
    }
}

/// The triangle in a place of the picture, or `u32::MAX`; `None` if this is uncertain. From an eye, w grows
/// with the distance; along a direction, z does.
fn shown(triangles: &[Shown], is_parallel: bool, at: DVec3) -> Option<u32> {
    let mut met: Vec<(f64, u32)> = Vec::new();
    for (number, Shown { weights, depths }) in triangles.iter().enumerate() {
        let [a, b, c] = weights.map(|dual| dual.dot(at));
        let (least, most) = (a.min(b).min(c), a.abs().max(b.abs()).max(c.abs()));
        // An edge-on triangle has infinite weights.
        if !most.is_finite() || [a, b, c].iter().any(|weight| weight.abs() < NEAR * most) {
            return None;
        }
        if least > 0.0 {
            let z = a * depths[0] + b * depths[1] + c * depths[2];
            let sum = a + b + c;
            met.push((if is_parallel { z / sum } else { 1.0 / sum }, number as u32));
        }
    }
    met.sort_by(|a, b| a.0.total_cmp(&b.0));
    match met[..] {
        [(first, _), (second, _), ..] if second - first < NEAR => None,
        [(_, number), ..] => Some(number),
        [] => Some(u32::MAX),
    }
}

/// A map of clip coordinates that stretches, shears and shifts the picture. For an eye, it also tilts the
/// picture.
fn skew(dice: &mut Dice, is_parallel: bool) -> DMat4 {
    let [x, y] = [dice.range(0.3, 2.0), dice.range(0.3, 2.0)];
    let [a, b] = [y * dice.range(-0.7, 0.7), x * dice.range(-0.7, 0.7)];
    let tilt = if is_parallel { 0.0 } else { 0.05 };
    let tilts = [x, y].map(|scale| scale * dice.range(-tilt, tilt));
    let shift = DVec4::new(dice.range(-0.7, 0.7), dice.range(-0.7, 0.7), 0.0, 1.0);
    let columns = [DVec4::new(x, b, 0.0, tilts[0]), DVec4::new(a, y, 0.0, tilts[1])];
    DMat4::from_cols(columns[0], columns[1], DVec4::Z, shift)
}

#[test]
fn pictures_of_any_matrix_are_right() {
    let mut dice = Dice(61);
    let (mut compared, mut covered, mut score) = (0, 0, Score::default());
    for round in 0..times(20) {
        let triangles = triangles(&mut dice, 40, [-1.0, 1.0], 1.2);
        let tree = BspTree::build(&triangles).unwrap();
        // Every second eye is among the triangles.
        let eye = dice.point(-1.0, 1.0) * [4.0, 0.7][round % 2];
        let (target, up) = (dice.point(-0.2, 0.2), dice.point(-1.0, 1.0));
        let camera = match round % 4 {
            0 | 1 => Camera::perspective(eye, target, up, 1.0, SIZE),
            _ => Camera::parallel(target - eye, up, target, 2.5, SIZE),
        };
        let camera = camera.unwrap();
        let is_parallel = camera.eye().is_none();
        let matrix = skew(&mut dice, is_parallel) * camera.matrix(1.0, 2.0);
        let camera = Camera::from_matrix(matrix, SIZE).unwrap();
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let (painted, depth) =
            (paint_tree(&tree, camera.viewpoint(), &rays), zbuffer(&rays, tree.faces()));
        let seen: Vec<Shown> =
            triangles.iter().map(|corners| Shown::new(&matrix, corners)).collect();
        let polygon = |face: u32| match face {
            u32::MAX => face,
            face => tree.faces().polygon(face) as u32,
        };
        for (i, (&painted, &nearest)) in
            painted.faces().iter().zip(depth.image().faces()).enumerate()
        {
            let [x, y] = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
            let place = |at: u32, side: u32| 2.0 * (f64::from(at) + 0.5) / f64::from(side) - 1.0;
            let at = DVec3::new(place(x, SIZE[0]), -place(y, SIZE[1]), 1.0);
            let Some(expected) = shown(&seen, is_parallel, at) else { continue };
            assert_eq!([painted, nearest].map(polygon), [expected; 2], "({x}, {y}) of {camera:?}");
            compared += 1;
            covered += usize::from(expected != u32::MAX);
        }
        let verdict = verify(&tree, &camera).unwrap();
        assert!(verdict.is_right(), "{camera:?}");
        check(&tree, &camera, &mut score).unwrap_or_else(|fault| panic!("{camera:?}: {fault}"));
    }
    enough!(compared > 100_000, covered > 40_000, score.pixels > 150_000; "{compared} {covered} {score:?}");
}
