//! A hilly height field.

use super::{Material, Scene};
use crate::random::SplitMix64;
use glam::DVec3;

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
