//! A floor, a column, a beam and balls, all opaque; panes and a bubble of glass that cross each other
//! and the opaque bodies.

use std::f64::consts::{PI, TAU};

use binspace::glam::{DVec3, dvec3};

/// A convex polygon of one colour. It is opaque if its opacity is 1.
#[derive(Clone, Debug)]
pub(crate) struct Polygon {
    pub(crate) corners: Vec<DVec3>,
    pub(crate) color: [f32; 3],
    pub(crate) opacity: f32,
}

impl Polygon {
    pub(crate) fn is_opaque(&self) -> bool {
        self.opacity == 1.0
    }
}

pub(crate) fn scene() -> Vec<Polygon> {
    let mut scene = vec![];
    let mut opaque = |corners: Vec<DVec3>, color: [f32; 3]| {
        scene.push(Polygon { color: lit(&corners, color), corners, opacity: 1.0 });
    };
    for (x, y) in (-6..6).flat_map(|x| (-6..6).map(move |y| (x, y))) {
        let tile = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let corners = tile.map(|(u, v)| dvec3(f64::from(x + u), f64::from(y + v), 0.0) * 0.6);
        opaque(
            corners.to_vec(),
            if (x + y) % 2 == 0 { [0.93, 0.91, 0.87] } else { [0.55, 0.53, 0.52] },
        );
    }
    // A column in the middle, where the panes cross, and a beam through all of them.
    for side in prism(DVec3::ZERO, DVec3::Z * 2.6, 0.28, 6) {
        opaque(side, [0.62, 0.50, 0.40]);
    }
    for side in prism(dvec3(-2.7, -0.9, 1.5), dvec3(5.4, 1.0, 0.0), 0.13, 4) {
        opaque(side, [0.36, 0.38, 0.44]);
    }
    for (middle, radius, color) in [
        (dvec3(0.5, -2.1, 0.45), 0.45, [0.95, 0.55, 0.20]), // in front
        (dvec3(-0.8, 1.9, 0.7), 0.7, [0.30, 0.50, 0.35]),   // behind
        (dvec3(1.6, 0.55, 0.5), 0.5, [0.60, 0.35, 0.62]),   // through a pane
    ] {
        ball(middle, radius).for_each(|quad| opaque(quad, color));
    }

    let mut glass = |corners: Vec<DVec3>, color, opacity| {
        scene.push(Polygon { corners, color, opacity });
    };
    for (angle, color) in
        [(0.35, [0.95, 0.25, 0.25]), (1.45, [0.15, 0.50, 0.95]), (2.45, [0.99, 0.80, 0.10])]
    {
        let (along, up) = (dvec3(f64::cos(angle), f64::sin(angle), 0.0) * 2.4, DVec3::Z * 2.1);
        let low = DVec3::Z * 0.05;
        glass(vec![low - along, low + along, low + along + up, low - along + up], color, 0.45);
    }
    // A tilted pane across the other three.
    let tilted = [(-1.7, -1.7, 0.5), (1.7, -1.7, 1.0), (1.7, 1.7, 1.9), (-1.7, 1.7, 1.4)];
    let tilted: Vec<DVec3> = tilted.map(|(x, y, z)| dvec3(x, y, z)).to_vec();
    glass(tilted, [0.20, 0.80, 0.55], 0.35);
    ball(dvec3(-0.75, -0.85, 1.3), 0.62).for_each(|quad| glass(quad, [0.85, 0.93, 1.0], 0.25));
    scene
}

/// The sides and both ends of a prism around an axis, with fronts outside.
fn prism(from: DVec3, axis: DVec3, radius: f64, sides: usize) -> Vec<Vec<DVec3>> {
    let (u, v) = axis.normalize().any_orthonormal_pair();
    let ring: Vec<DVec3> = (0..sides)
        .map(|k| (TAU * (k as f64 + 0.5) / sides as f64).sin_cos())
        .map(|(sin, cos)| from + (u * cos + v * sin) * radius)
        .collect();
    let far = || ring.iter().map(|&corner| corner + axis);
    let mut faces = vec![ring.iter().rev().copied().collect(), far().collect()];
    for k in 0..sides {
        let (a, b) = (ring[k], ring[(k + 1) % sides]);
        faces.push(vec![a, b, b + axis, a + axis]);
    }
    faces
}

/// A ball of quads; at its poles, two corners are equal.
fn ball(middle: DVec3, radius: f64) -> impl Iterator<Item = Vec<DVec3>> {
    const RINGS: usize = 10;
    const SIDES: usize = 20;
    let at = move |i: usize, k: usize| {
        let (tilt, turn) = (PI * i as f64 / RINGS as f64, TAU * (k % SIDES) as f64 / SIDES as f64);
        // The sine of π is not quite zero in floats.
        let around = if i.is_multiple_of(RINGS) { 0.0 } else { tilt.sin() };
        middle + radius * dvec3(around * turn.cos(), around * turn.sin(), tilt.cos())
    };
    (0..RINGS * SIDES).map(move |n| {
        let (i, k) = (n / SIDES, n % SIDES);
        vec![at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)]
    })
}

/// A colour in the light of a distant lamp. Sides that face the lamp are brighter.
fn lit(corners: &[DVec3], color: [f32; 3]) -> [f32; 3] {
    let fan = corners.windows(2).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0]));
    let normal = fan.sum::<DVec3>().normalize();
    let light = 0.72 + 0.28 * normal.dot(dvec3(0.45, -0.35, 0.82));
    color.map(|channel| channel * light as f32)
}
