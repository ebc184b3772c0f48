//! Scenes that a few rules generate.

use super::{Material, Scene};
use crate::random::SplitMix64;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// A scene in which z points upwards, with the materials of [`Material::palette`].
fn of_eight_colours(name: String) -> Scene {
    let mut scene = Scene::new(name, DVec3::Z);
    Material::palette().for_each(|material| {
        scene.add_material(material);
    });
    scene
}

/// Three bars in a cycle: each covers a part of the next, so no order of whole bars is right and one must
/// be cut. 18 rectangles; up is z.
///
/// The classic counterexample to sorting by depth, after M. E. Newell, R. G. Newell and T. L.
/// Sancha, "A solution to the hidden surface problem", ACM 1972. Here the bars are axis-aligned
/// boxes of 9 × 1 × 1 along x, y and z that do not touch, each the cyclic permutation of the other;
/// seen from (1, 1, 1) the bar along y covers that along x, z covers y, and x covers z.
pub fn newell_bars() -> Scene {
    let mut scene = Scene::new("newell", DVec3::Z).with_view(DVec3::splat(9.0), DVec3::ZERO);
    let mut low = DVec3::new(-4.5, 0.5, -1.5);
    let mut high = DVec3::new(4.5, 1.5, -0.5);
    let hues = [[0.80, 0.25, 0.20], [0.25, 0.65, 0.30], [0.25, 0.40, 0.80]];
    // Without lighting, opposite faces share a colour and the three axes differ.
    for (bar, rgb) in ["x", "y", "z"].into_iter().zip(hues) {
        let shades = [0.7, 0.85, 1.0].map(|shade: f32| {
            let color = rgb.map(|channel: f32| channel * shade);
            scene.add_material(Material::new(format!("bar along {bar}"), color))
        });
        for (side, face) in cuboid(low, high).into_iter().enumerate() {
            scene.push(face, shades[side / 2]);
        }
        low = DVec3::new(low.z, low.x, low.y);
        high = DVec3::new(high.z, high.x, high.y);
    }
    scene
}

/// `count` upright squares of side 2 that all cross in the z axis, like the leaves of a revolving
/// door; up is z.
///
/// Square `i` is turned by `i`/`count` of half a turn, so two are perpendicular. `2·count` pieces
/// suffice for an order.
pub fn crossing(count: u32) -> Scene {
    let mut scene = of_eight_colours(format!("crossing:{count}"))
        .with_view(DVec3::new(2.5, -4.5, 2.0), DVec3::ZERO);
    for index in 0..count {
        let reach = unit_circle(index.into(), 2 * u64::from(count));
        let (near, far) = (reach.extend(0.0), -reach.extend(0.0));
        let square = [far - DVec3::Z, near - DVec3::Z, near + DVec3::Z, far + DVec3::Z];
        scene.push(square, index % 8);
    }
    scene
}

/// The side of the terrain.
const SIDE: f64 = 100.0;

/// Octaves of noise: cells on a side at the coarsest, and the height it adds.
const OCTAVES: [(usize, f64); 5] = [(3, 14.0), (7, 6.0), (15, 2.5), (31, 1.0), (63, 0.4)];

/// A hilly terrain of about `triangles` triangles, 100 × 100, up is z.
///
/// A height field over `side` × `side` squares of two triangles, with `side` = √(`triangles`/2)
/// rounded, at least 1. Heights are value noise in five octaves, mostly within ±12 and never beyond
/// ±24. Every triangle faces up; no two cross.
pub fn terrain(triangles: u32, seed: u64) -> Scene {
    let side = (f64::from(triangles) / 2.0).sqrt().round().max(1.0) as usize;
    let mut scene = Scene::new(format!("terrain:{triangles}"), DVec3::Z)
        .with_view(DVec3::new(-30.0, -45.0, 55.0), DVec3::new(45.0, 45.0, 0.0));
    let shades: Vec<u32> = (0..8)
        .map(|step| {
            let t = step as f32 / 7.0;
            let color = [0.25 + 0.55 * t, 0.45 + 0.35 * t, 0.20 + 0.50 * t];
            scene.add_material(Material::new(format!("height {step}"), color))
        })
        .collect();
    let noise = noise(seed);
    let at = |column: usize, row: usize| {
        let (u, v) = (column as f64 / side as f64, row as f64 / side as f64);
        DVec3::new(u * SIDE, v * SIDE, height(&noise, u, v))
    };
    let mut below: Vec<DVec3> = (0..=side).map(|column| at(column, 0)).collect();
    for row in 0..side {
        let above: Vec<DVec3> = (0..=side).map(|column| at(column, row + 1)).collect();
        for column in 0..side {
            let (a, b) = (below[column], below[column + 1]);
            let (d, c) = (above[column], above[column + 1]);
            let triangles = if (row + column) % 2 == 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            for triangle in triangles {
                let mean = (triangle[0].z + triangle[1].z + triangle[2].z) / 3.0;
                let step = ((mean + 12.0) / 3.0).clamp(0.0, 7.0) as usize;
                scene.push(triangle, shades[step]);
            }
        }
        below = above;
    }
    scene
}

/// The random heights at the grid points of every octave.
fn noise(seed: u64) -> Vec<Vec<f64>> {
    let mut random = SplitMix64::new(seed);
    OCTAVES
        .iter()
        .map(|&(cells, reach)| {
            (0..(cells + 1) * (cells + 1)).map(|_| random.range(-reach, reach)).collect()
        })
        .collect()
}

/// The sum of all octaves, each interpolated with a smooth step.
fn height(noise: &[Vec<f64>], u: f64, v: f64) -> f64 {
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let mut sum = 0.0;
    for (&(cells, _), values) in OCTAVES.iter().zip(noise) {
        let (x, y) = (u * cells as f64, v * cells as f64);
        let column = (x as usize).min(cells - 1);
        let row = (y as usize).min(cells - 1);
        let (tx, ty) = (smooth(x - column as f64), smooth(y - row as f64));
        let first = row * (cells + 1) + column;
        let second = first + cells + 1;
        let near = mix(values[first], values[first + 1], tx);
        let far = mix(values[second], values[second + 1], tx);
        sum += mix(near, far, ty);
    }
    sum
}

/// A unit sphere of about `faces` faces, up is z: quads between parallels and meridians, triangles
/// at the poles.
///
/// It has `rows` × 2·`rows` faces, with `rows` = √(`faces`/2) rounded, at least 2 (an octahedron). Every
/// quad is an isosceles trapezium inscribed in the sphere, so all faces are planar and the body is convex,
/// up to the rounding of the corners. The worst case for trees whose planes are the faces' own: each plane
/// separates only its own face from the rest.
pub fn sphere(faces: u32) -> Scene {
    let rows = (f64::from(faces) / 2.0).sqrt().round().max(2.0) as u64;
    let columns = 2 * rows;
    let mut scene = Scene::new(format!("sphere:{faces}"), DVec3::Z);
    let shades = [0.95, 0.75]
        .map(|grey| scene.add_material(Material::new("sphere", [0.5 * grey, 0.7 * grey, grey])));
    let meridian: Vec<DVec2> = (0..=columns).map(|step| unit_circle(step, columns)).collect();
    // From the south pole, a quarter turn back, to the north pole.
    let parallel: Vec<DVec2> =
        (0..=rows).map(|row| unit_circle(3 * rows + 2 * row, 4 * rows)).collect();
    let corner =
        |row: usize, column: usize| (meridian[column] * parallel[row].x).extend(parallel[row].y);
    for row in 0..rows as usize {
        for column in 0..columns as usize {
            let material = shades[(row + column) % 2];
            let (a, b) = (corner(row, column), corner(row, column + 1));
            let (c, d) = (corner(row + 1, column + 1), corner(row + 1, column));
            scene.push_quad([a, b, c, d], material);
        }
    }
    scene
}

/// The side of a building plot with half the street around it, in metres.
const PLOT: f64 = 30.0;

/// A city of about `polygons` polygons in metres, up is z: a grid of houses on one ground square.
///
/// There are `side`² houses, with `side` = √((`polygons` − 1)/5) rounded, at least 1: axis-aligned
/// boxes without an underside, 12 to 24 wide and deep, 6 to 120 high, that stand apart. Low houses
/// are frequent, high ones rare.
pub fn city(polygons: u32, seed: u64) -> Scene {
    let wanted = (f64::from(polygons.saturating_sub(1)) / 5.0).sqrt();
    let side = wanted.round().max(1.0) as u32;
    let width = f64::from(side) * PLOT;
    let mut scene = Scene::new(format!("city:{polygons}"), DVec3::Z).with_view(
        DVec3::new(-0.35 * width, -0.45 * width, 0.35 * width + 100.0),
        DVec3::new(0.45 * width, 0.45 * width, 20.0),
    );
    let ground = scene.add_material(Material::new("ground", [0.35, 0.37, 0.35]));
    let walls = [0.55, 0.75, 0.62, 0.68]
        .map(|grey| scene.add_material(Material::new("wall", [grey, 0.95 * grey, 0.85 * grey])));
    let roof = scene.add_material(Material::new("roof", [0.70, 0.42, 0.35]));

    let square = [(0.0, 0.0), (width, 0.0), (width, width), (0.0, width)];
    scene.push(square.map(|(x, y)| DVec3::new(x, y, 0.0)), ground);
    let mut random = SplitMix64::new(seed);
    for plot in 0..u64::from(side) * u64::from(side) {
        let (column, row) = (plot % u64::from(side), plot / u64::from(side));
        let centre = DVec3::new(column as f64 + 0.5, row as f64 + 0.5, 0.0) * PLOT;
        let half_x = random.range(6.0, 12.0);
        let half_y = random.range(6.0, 12.0);
        let tallness = random.range(0.0, 1.0);
        let height = 6.0 + 114.0 * tallness * tallness * tallness;
        let faces = cuboid(
            centre - DVec3::new(half_x, half_y, 0.0),
            centre + DVec3::new(half_x, half_y, height),
        );
        for (face, material) in faces[..4].iter().zip(walls) {
            scene.push(*face, material);
        }
        scene.push(faces[5], roof);
    }
    scene
}

/// The shortest and the longest edge of a random triangle.
const EDGES: (f64, f64) = (0.1, 0.3);

/// `count` triangles anywhere in the unit cube, every edge between 0.1 and 0.3 long; up is z. Most
/// of a dense scene's triangles cross others.
pub fn random_triangles(count: u32, seed: u64) -> Scene {
    let mut scene = of_eight_colours(format!("random:{count}"));
    let mut random = SplitMix64::new(seed);
    for index in 0..count {
        scene.push(random_triangle(&mut random), index % 8);
    }
    scene
}

/// Repeats until the triangle fits, which one in about 16 does. A thousand misses in a row are practically
/// impossible; then a fixed triangle ends the loop.
fn random_triangle(random: &mut SplitMix64) -> [DVec3; 3] {
    let draw = |_| {
        let a = random.point(0.0, 1.0);
        [a, a + random.point(-EDGES.1, EDGES.1), a + random.point(-EDGES.1, EDGES.1)]
    };
    let fixed = [DVec3::ZERO, DVec3::X * EDGES.1, DVec3::Y * EDGES.1 * 0.5];
    (0..1000).map(draw).find(fits).unwrap_or(fixed)
}

fn fits(&[a, b, c]: &[DVec3; 3]) -> bool {
    let edges = [b - a, c - b, a - c].map(DVec3::length_squared);
    let inside = |p: DVec3| p.min_element() >= 0.0 && p.max_element() <= 1.0;
    let fair = |square| (EDGES.0 * EDGES.0..=EDGES.1 * EDGES.1).contains(&square);
    inside(b) && inside(c) && edges.into_iter().all(fair)
}

/// `count` parallel squares, one behind the other; up is z.
///
/// Square `i` lies in the plane y = `i`, has side 10 and faces −y. No plane of one touches another. The
/// scene is hard because a tree of their own planes can be a list of depth `count`.
pub fn chain(count: u32) -> Scene {
    let mut scene = of_eight_colours(format!("chain:{count}"));
    for index in 0..count {
        let square = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)];
        scene.push(square.map(|(x, z)| DVec3::new(x, index.into(), z)), index % 8);
    }
    scene
}

/// `count` nested squares, `gap` above one another; up is z.
///
/// Square `i` lies at height `i`·`gap`, faces up, and is centred on the z axis; the lowest has side 2 and
/// each is smaller by a `count`-th than the one below, so that a strip of every layer stays visible from
/// above. A gap of 0 makes all of them coplanar; a small one distinguishes exact decisions from tolerances.
pub fn layers(count: u32, gap: f64) -> Scene {
    let mut scene = of_eight_colours(format!("layers:{count}"))
        .with_view(DVec3::new(0.8, -1.6, 2.6), DVec3::ZERO);
    for index in 0..count {
        let half = f64::from(count - index) / f64::from(count);
        let z = f64::from(index) * gap;
        let square = [(-half, -half), (half, -half), (half, half), (-half, half)];
        scene.push(square.map(|(x, y)| DVec3::new(x, y, z)), index % 8);
    }
    scene
}

/// The six rectangles of an axis-aligned box, counter-clockwise from outside, in the order −x +x −y
/// +y −z +z.
pub fn cuboid(low: DVec3, high: DVec3) -> [[DVec3; 4]; 6] {
    let ends = [low, high];
    let corner = |[x, y, z]: [usize; 3]| DVec3::new(ends[x].x, ends[y].y, ends[z].z);
    [
        [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]],
        [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
        [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]],
        [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
        [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    ]
    .map(|face| face.map(corner))
}

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

/// Taylor series for 0 ≤ x ≤ π/4; the omitted terms are below 1e-20.
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
    fn every_face_looks_outwards() {
        let outward = [DVec3::NEG_X, DVec3::X, DVec3::NEG_Y, DVec3::Y, DVec3::NEG_Z, DVec3::Z];
        let faces = cuboid(DVec3::ZERO, DVec3::ONE);
        for ([a, b, c, d], normal) in faces.into_iter().zip(outward) {
            assert_eq!((b - a).cross(c - b), normal);
            assert_eq!(a - b + c - d, DVec3::ZERO, "a parallelogram");
        }
    }

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
