//! Areas in pixels against rational numbers, and known properties of sums.

use std::array::from_fn;
use testkit::prelude::*;

use binspace::view::views;
use binspace_evidence::antialias::{Areas, blended, distance, supersampled};
use dashu_int::IBig;
use dashu_ratio::RBig;

type Point = [RBig; 2];

const SIZE: [u32; 2] = [8, 8];

fn rational(n: i64, d: i64) -> RBig {
    RBig::from_parts_signed(IBig::from(n), IBig::from(d))
}

/// The cross product of q - p and r - p.
fn cross(p: &Point, q: &Point, r: &Point) -> RBig {
    (&q[0] - &p[0]) * (&r[1] - &p[1]) - (&q[1] - &p[1]) * (&r[0] - &p[0])
}

/// The intersection of two convex polygons, both counter-clockwise.
fn common(a: &[Point], b: &[Point]) -> Vec<Point> {
    if area(b).is_zero() {
        return vec![];
    }
    let mut left = a.to_vec();
    for (i, from) in b.iter().enumerate() {
        let to = &b[(i + 1) % b.len()];
        let all = std::mem::take(&mut left);
        for (k, p) in all.iter().enumerate() {
            let q = &all[(k + 1) % all.len()];
            let (at_p, at_q) = (cross(from, to, p), cross(from, to, q));
            let zero = RBig::zero();
            if at_p >= zero {
                left.push(p.clone());
            }
            if (at_p > zero) != (at_q > zero) && at_p != at_q && at_p != zero && at_q != zero {
                let t = &at_p / (&at_p - &at_q);
                left.push(from_fn(|axis| &p[axis] + &t * (&q[axis] - &p[axis])));
            }
        }
    }
    left
}

fn area(polygon: &[Point]) -> RBig {
    let Some(first) = polygon.first() else { return RBig::zero() };
    let triangles = polygon.windows(2).map(|pair| cross(first, &pair[0], &pair[1]));
    let twice = testkit::rational::total(triangles);
    twice / rational(2, 1)
}

/// A counter-clockwise triangle with corners in eighths of pixels.
fn triangle(dice: &mut Dice) -> [[i64; 2]; 3] {
    loop {
        let [p, q, r]: [[i64; 2]; 3] = from_fn(|_| from_fn(|_| (dice.roll() % 65) as i64));
        let turn = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        if turn > 0 {
            return [p, q, r];
        }
    }
}

/// The shares of a pixel in which each of three triangles is visible, with the first on top: by inclusion and
/// exclusion.
fn owned(pixel: &[Point], [a, b, c]: &[Vec<Point>; 3]) -> [f64; 3] {
    let [a, b, c] = [a, b, c].map(|triangle| common(triangle, pixel));
    let (ab, ac, bc) = (common(&a, &b), common(&a, &c), common(&b, &c));
    let abc = common(&ab, &bc);
    let c = area(&c) - area(&ac) - area(&bc) + area(&abc);
    [area(&a), area(&b) - area(&ab), c].map(|share| share.to_f64().value())
}

#[test]
fn areas_in_pixels_agree_with_rationals() {
    let (mut dice, mut parts) = (Dice(5), 0);
    for _ in 0..times(40) {
        let triangles: [[[i64; 2]; 3]; 3] = from_fn(|_| triangle(&mut dice));
        let mut scene = Scene::new("three", DVec3::Y);
        for (depth, corners) in (0..).zip(&triangles) {
            let at = |p: &[i64; 2]| dvec3(p[0] as f64 / 8.0, p[1] as f64 / 8.0, -f64::from(depth));
            scene.push(corners.iter().map(at), 0);
        }
        let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build(scene.polygons()).unwrap();
        let centre = dvec3(4.0, 4.0, 0.0);
        let camera = Camera::parallel(-DVec3::Z, DVec3::Y, centre, 8.0, SIZE).unwrap();
        let areas = Areas::of(&tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap());
        let outlines: [Vec<Point>; 3] =
            from_fn(|k| triangles[k].iter().map(|p| p.map(|c| rational(c, 8))).collect());
        for (k, shares) in (0..).zip(areas.pixels()) {
            // Rows run down, y up.
            let (x, y) = (k % 8, 7 - k / 8);
            let square = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
            let truth = owned(&square.map(|p| p.map(|c| rational(c, 1))), &outlines);
            for (polygon, truth) in truth.into_iter().enumerate() {
                let found = shares.iter().find(|share| share.0 == polygon).map_or(0.0, |s| s.1);
                assert!((found - truth).abs() < 1e-9, "{found} for {truth}");
                parts += usize::from(truth > 0.0 && truth < 1.0);
            }
        }
    }
    enough!(parts > 1000; "{parts}");
}

fn colour(polygon: usize) -> [f32; 3] {
    binspace::raster::colour_of(polygon).map(|c| f32::from(c) / 255.0)
}

#[test]
fn areas_sum_to_the_picture_and_samples_approximate_them() {
    for scene in [scene::crossing(7), scene::random_triangles(60, 2), scene::newell_bars()] {
        let tree = BspTree::build(scene.polygons()).unwrap();
        let (low, high) = scene.bounds().unwrap();
        for camera in views([low, high], scene.up(), 2, [48, 36], 3).unwrap() {
            let map = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap();
            let areas = Areas::of(&map);
            let mut sums = vec![0.0; scene.len()];
            for shares in areas.pixels() {
                assert!(shares.iter().map(|s| s.1).sum::<f64>() < 1.0 + 1e-9);
                shares.iter().for_each(|&(polygon, area)| sums[polygon] += area);
            }
            for shown in map.polygons() {
                assert!((sums[shown.polygon] - shown.area).abs() < 1e-6 * shown.area.max(1.0));
            }
            let exact = areas.picture(colour, [1.0; 3]);
            let off = [1, 4, 16].map(|side| {
                let found = supersampled(&camera, tree.faces(), side, colour, [1.0; 3]).unwrap();
                distance(&found, &exact).1
            });
            assert!(off[1] < 0.6 * off[0] && off[2] < 0.5 * off[1], "{off:?}");
        }
    }
}

/// A square in parts of one colour.
#[test]
fn a_constant_surface_is_constant_by_areas_and_has_seams_by_blending() {
    let mut scene = Scene::new("fan", DVec3::Y);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let at = |[x, y]: [f64; 2]| dvec3(x, y, 0.0);
    for (i, &p) in corners.iter().enumerate() {
        scene.push([dvec3(0.1, 0.2, 0.0), at(p), at(corners[(i + 1) % 4])], 0);
    }
    let tree = BspTree::build(scene.polygons()).unwrap();
    // Inside of the square.
    let centre = dvec3(0.1, 0.1, 0.0);
    let camera = Camera::parallel(-DVec3::Z, DVec3::Y, centre, 1.4, [40, 40]).unwrap();
    let areas = Areas::of(&tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap());
    let (black, white) = (|_| [0.0; 3], [1.0; 3]);
    let exact = areas.picture(black, white);
    assert!(exact.iter().flatten().all(|c| c.abs() < 1e-6));
    let found = blended(&tree, &camera, black, white);
    // Two halves of a pixel leave a quarter of the background, n parts (1 - 1/n)^n at most.
    let (worst, _) = distance(&found, &exact);
    assert!(worst > 0.2 && worst < 0.37, "{worst}");
    let seams = found.iter().filter(|pixel| pixel[0] > 0.01).count();
    assert!(seams > 60 && seams < 400, "{seams}");
}
