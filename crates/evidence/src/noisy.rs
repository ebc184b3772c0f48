//! A substitute for real scans: no scan is part of this project.

use binspace::glam::DVec3;
use binspace::internals::SplitMix64;
use binspace::scene::{Scene, sphere};

/// The distance by which noise moves corners, as a share of a triangle's side. Scans are worse where surfaces
/// are shiny, and better where they were smoothed.
const NOISE: f64 = 0.2;

/// Returns a closed surface of about `triangles` small triangles: a sphere with a few bulges, whose corners
/// are moved along their radii by noise. As in real scans, hardly two triangles are in one plane, and
/// neighbours bend inwards as often as outwards.
pub fn noisy_sphere(triangles: u32, seed: u64) -> Scene {
    let smooth = sphere(triangles / 2);
    let mut scene = Scene::new(format!("noisy sphere:{triangles}"), DVec3::Z);
    smooth.materials().iter().for_each(|material| {
        scene.add_material(material.clone());
    });
    // Rows of quads from pole to pole.
    let side = std::f64::consts::PI / (f64::from(triangles) / 4.0).sqrt().max(2.0);
    for (number, polygon) in (0..).zip(smooth.polygons()) {
        let corners: Vec<DVec3> =
            polygon.points().iter().map(|&p| moved(p, NOISE * side, seed)).collect();
        for k in 2..corners.len() {
            scene.push([corners[0], corners[k - 1], corners[k]], number % 2);
        }
    }
    scene
}

/// A corner of the sphere with a bulge and noise, which depend only on the corner's position.
fn moved(corner: DVec3, noise: f64, seed: u64) -> DVec3 {
    // No coordinate is a negative zero.
    let at = corner + DVec3::ZERO;
    let bits = at.to_array().map(f64::to_bits);
    let key = bits.into_iter().fold(seed, |key, bits| SplitMix64::new(key ^ bits).next());
    let bulge = 0.25 * at.x * at.y + 0.15 * at.z * (at.x - at.y) - 0.2 * at.x * at.x * at.z;
    at * (1.0 + bulge + SplitMix64::new(key).range(-noise, noise))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn it_is_closed_and_noisy() {
        let scene = noisy_sphere(4000, 1);
        assert!((3500..4500).contains(&scene.len()), "{}", scene.len());
        let mut edges = HashSet::new();
        let bits = |p: DVec3| p.to_array().map(f64::to_bits);
        let triangles: Vec<[DVec3; 3]> =
            scene.polygons().map(|p| [p.points()[0], p.points()[1], p.points()[2]]).collect();
        for [a, b, c] in &triangles {
            for [p, q] in [[a, b], [b, c], [c, a]] {
                assert!(edges.insert([bits(*p), bits(*q)]));
            }
        }
        assert!(edges.iter().all(|&[p, q]| edges.contains(&[q, p])));
        // Near a triangle's plane, about as many corners of other triangles are in front of the plane as
        // behind it.
        let mut sides = [0, 0];
        for pair in triangles.windows(2) {
            let [a, b, c] = pair[0];
            let other = pair[1].iter().find(|p| !pair[0].contains(p)).unwrap();
            sides[usize::from((b - a).cross(c - a).dot(*other - a) > 0.0)] += 1;
        }
        assert!(sides.iter().all(|&count| count > 1000), "{sides:?}");
        assert_ne!(scene.polygon(9), noisy_sphere(4000, 2).polygon(9));
    }
}
