//! The Utah teapot.

use super::{Material, Scene};
use glam::DVec3;

/// A bicubic Bézier patch: rows of control points.
type Patch = [[DVec3; 4]; 4];

/// Four profile points of a surface of revolution: radius, tangential reach of the two inner
/// control points of a quarter circle, height.
type Profile = [[f64; 3]; 4];

/// Four cross-sections of a tube that is symmetric in y: x and z of one end, x and z of the other,
/// and half the width.
type Tube = [[f64; 5]; 4];

const RIM: Profile =
    [[1.4, 0.784, 2.4], [1.3375, 0.749, 2.53125], [1.4375, 0.805, 2.53125], [1.5, 0.84, 2.4]];
const BODY_UPPER: Profile =
    [[1.5, 0.84, 2.4], [1.75, 0.98, 1.875], [2.0, 1.12, 1.35], [2.0, 1.12, 0.9]];
const BODY_LOWER: Profile =
    [[2.0, 1.12, 0.9], [2.0, 1.12, 0.45], [1.5, 0.84, 0.225], [1.5, 0.84, 0.15]];
const LID_KNOB: Profile =
    [[0.0, 0.0, 3.15], [0.8, 0.45, 3.15], [0.0, 0.0, 2.85], [0.2, 0.112, 2.7]];
const LID: Profile = [[0.2, 0.112, 2.7], [0.4, 0.224, 2.55], [1.3, 0.728, 2.55], [1.3, 0.728, 2.4]];
const BOTTOM: Profile =
    [[1.5, 0.84, 0.15], [1.5, 0.84, 0.075], [1.425, 0.798, 0.0], [0.0, 0.0, 0.0]];
const HANDLE_UPPER: Tube = [
    [-1.6, 2.025, -1.5, 2.25, 0.3],
    [-2.3, 2.025, -2.5, 2.25, 0.3],
    [-2.7, 2.025, -3.0, 2.25, 0.3],
    [-2.7, 1.8, -3.0, 1.8, 0.3],
];
const HANDLE_LOWER: Tube = [
    [-2.7, 1.8, -3.0, 1.8, 0.3],
    [-2.7, 1.575, -3.0, 1.35, 0.3],
    [-2.5, 1.125, -2.65, 0.9375, 0.3],
    [-2.0, 0.9, -1.9, 0.6, 0.3],
];
const SPOUT_LOWER: Tube = [
    [1.7, 1.425, 1.7, 0.6, 0.66],
    [2.6, 1.425, 3.1, 0.825, 0.66],
    [2.3, 2.1, 2.4, 2.025, 0.25],
    [2.7, 2.4, 3.3, 2.4, 0.25],
];
const SPOUT_UPPER: Tube = [
    [2.7, 2.4, 3.3, 2.4, 0.25],
    [2.8, 2.475, 3.525, 2.49375, 0.25],
    [2.9, 2.475, 3.45, 2.5125, 0.15],
    [2.8, 2.4, 3.2, 2.4, 0.15],
];

/// Returns the Utah teapot, with `segments` × `segments` quads for each of its 32 Bézier patches. Up is z,
/// and the spout points along +x.
///
/// Rim, body, handle, spout and lid are Martin Newell's patches of 1975, in the published proportions (3.15
/// high, the body 4 across). F. Crow added the bottom ("The origins of the teapot", IEEE Computer Graphics
/// and Applications 7(1), 1987). The patches are in the published order: 4 of the rim, 8 of the body, 4 of
/// the handle, 4 of the spout, 8 of the lid, 4 of the bottom.
///
/// There are 32 · `segments`² polygons, which face outwards. The 8 · `segments` polygons at the top of the
/// lid and the middle of the bottom are triangles. Neighbouring patches have the same corners, bit for bit.
/// As in the published teapot, there is a gap between lid and rim, and handle and spout pierce the body.
/// Fewer than 2 `segments` count as 2.
pub fn teapot(segments: u32) -> Scene {
    let mut scene = Scene::new(format!("teapot:{segments}"), DVec3::Z)
        .with_view(DVec3::new(3.5, -9.5, 5.5), DVec3::new(0.2, 0.0, 1.3));
    let parts: [(&str, [f32; 3], Vec<Patch>); 5] = [
        ("body", [0.82, 0.80, 0.74], [RIM, BODY_UPPER, BODY_LOWER].map(revolve).concat()),
        ("handle", [0.72, 0.62, 0.50], [HANDLE_UPPER, HANDLE_LOWER].map(mirror).concat()),
        ("spout", [0.66, 0.70, 0.74], [SPOUT_LOWER, SPOUT_UPPER].map(mirror).concat()),
        ("lid", [0.76, 0.72, 0.62], [LID_KNOB, LID].map(revolve).concat()),
        ("bottom", [0.60, 0.58, 0.54], revolve(BOTTOM).to_vec()),
    ];
    let weights = bernstein(segments.max(2));
    for (name, color, patches) in parts {
        let material = scene.add_material(Material::new(name, color));
        for patch in patches {
            push_patch(&mut scene, &patch, &weights, material);
        }
    }
    scene
}

/// Four quarters, clockwise as seen from above.
fn revolve(profile: Profile) -> [Patch; 4] {
    let quarter = profile.map(|[radius, reach, z]| {
        let row = [[radius, 0.0], [radius, -reach], [reach, -radius], [0.0, -radius]];
        row.map(|[x, y]| DVec3::new(x, y, z))
    });
    let turn = |patch: Patch| patch.map(|row| row.map(|p| DVec3::new(p.y, 0.0 - p.x, p.z)));
    let half = turn(quarter);
    let third = turn(half);
    [quarter, half, third, turn(third)]
}

/// The half at y ≤ 0, and its mirror image in the opposite direction.
fn mirror(tube: Tube) -> [Patch; 2] {
    let half = tube.map(|[x0, z0, x1, z1, width]| {
        [[x0, 0.0, z0], [x0, -width, z0], [x1, -width, z1], [x1, 0.0, z1]].map(DVec3::from)
    });
    let image = half.map(|[a, b, c, d]| [d, c, b, a].map(|p| DVec3::new(p.x, 0.0 - p.y, p.z)));
    [half, image]
}

/// The Bernstein polynomials of degree 3 at `0/n`, `1/n`, … `n/n`. Exact zeros and ones at the ends
/// make patches meet bit for bit.
fn bernstein(n: u32) -> Vec<[f64; 4]> {
    (0..=n)
        .map(|step| {
            let (t, s) = (f64::from(step) / f64::from(n), f64::from(n - step) / f64::from(n));
            [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
        })
        .collect()
}

/// A point of a cubic Bézier curve, clamped to the box of the control points. Without the clamp, rounding
/// could split poles and tilt level rows.
fn curve_point(w: &[f64; 4], [a, b, c, d]: [DVec3; 4]) -> DVec3 {
    let low = a.min(b).min(c.min(d));
    let high = a.max(b).max(c.max(d));
    (a * w[0] + b * w[1] + c * w[2] + d * w[3]).clamp(low, high)
}

fn push_patch(scene: &mut Scene, patch: &Patch, weights: &[[f64; 4]], material: u32) {
    let points = |w: &[f64; 4]| -> Vec<DVec3> {
        let [a, b, c, d] = *patch;
        let curve =
            [0, 1, 2, 3].map(|column| curve_point(w, [a[column], b[column], c[column], d[column]]));
        weights.iter().map(|v| curve_point(v, curve)).collect()
    };
    let mut upper = points(&weights[0]);
    for w in &weights[1..] {
        let lower = points(w);
        for column in 1..weights.len() {
            let (a, b) = (upper[column - 1], lower[column - 1]);
            let (c, d) = (lower[column], upper[column]);
            scene.push_quad([a, d, c, b], material);
        }
        upper = lower;
    }
}
