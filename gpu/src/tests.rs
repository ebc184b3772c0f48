//! Compares the pictures of the GPU with exact layers: the polygons that rays from the eye hit in a tree of
//! all polygons.

use std::collections::HashSet;

use binspace::Ray;

use super::*;

const SIZE: [u32; 2] = [200, 125];
const EYES: [DVec3; 4] =
    [dvec3(2.4, -7.2, 4.2), dvec3(-4.4, -4.9, 1.2), dvec3(-3.0, 5.5, 4.5), dvec3(5.8, 2.9, 2.0)];
/// The positions of the four samples of a pixel in WebGPU.
const SAMPLE_POINTS: [[f64; 2]; 4] =
    [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];
/// Devices round corners in the picture to a 16th of a pixel or less. The colour of a sample is certain if it
/// is the same at these offsets from the sample.
const AROUND: [[f64; 2]; 5] =
    [[0.0, 0.0], [-0.07, -0.07], [0.07, -0.07], [-0.07, 0.07], [0.07, 0.07]];

/// The counts of comparisons.
#[derive(Debug, Default)]
struct Counts {
    pixels: usize,
    /// Pixels with several panes before the first opaque polygon.
    of_several_panes: usize,
    /// Pairs of polygons, each of which is nearer than the other somewhere in one view: two panes, and a pane
    /// and an opaque polygon. Convex polygons with this property cross.
    crossing_panes: usize,
    panes_through_opaque: usize,
}

/// All polygons on the ray through a place of the picture, the nearest first.
fn hits(tree: &BspTree, camera: &Camera, [x, y]: [f64; 2]) -> impl Iterator<Item = usize> {
    let ([width, height], [across, down]) = (camera.size(), camera.pixel_size());
    let right = camera.right() * (x - 0.5 * f64::from(width)) * across;
    let up = camera.up() * (0.5 * f64::from(height) - y) * down;
    let eye = camera.eye().expect("a perspective");
    tree.hits(Ray::new(eye, camera.forward() + right + up)).map(|hit| hit.polygon())
}

/// Compares the pictures of a scene from each eye, at each pixel whose samples are certain.
///
/// Blending of bytes rounds at each pane. A device may have an error of 0.6 steps at each pane. It may also
/// round the colour and the opacity to bytes before, which adds at most half a step each: less than 2 steps
/// in all. Each sample and their mean are rounded once more.
fn compare(scene: &[Polygon]) -> Counts {
    let tree = BspTree::build(scene.iter().map(|polygon| &polygon.corners)).expect("a tree");
    let mut renderer = Renderer::new(scene, SIZE).expect("a graphics adapter");
    let mut counts = Counts::default();
    for eye in EYES {
        let camera = camera(eye, SIZE).expect("a camera");
        let picture = renderer.draw(&camera).expect("a picture");
        // The layers up to the first opaque polygon.
        let visible = |place: [f64; 2]| {
            let mut layers = vec![];
            for polygon in hits(&tree, &camera, place) {
                layers.push(polygon);
                if scene[polygon].is_opaque() {
                    break;
                }
            }
            layers
        };
        let certain = |[x, y]: [f64; 2]| {
            let layers = visible([x, y]);
            let is_certain =
                AROUND[1..].iter().all(|[right, down]| visible([x + right, y + down]) == layers);
            is_certain.then_some(layers)
        };
        let mut pairs = HashSet::new();
        let corners = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
        for (found, corner) in picture.chunks(4).zip(corners) {
            let [x, y] = corner.map(f64::from);
            let polygons: Vec<usize> = hits(&tree, &camera, [x + 0.5, y + 0.5]).collect();
            for (k, &near) in polygons.iter().enumerate() {
                pairs.extend(polygons[k + 1..].iter().map(|&far| [near, far]));
            }
            let samples = SAMPLE_POINTS.map(|[right, down]| certain([x + right, y + down]));
            let [Some(a), Some(b), Some(c), Some(d)] = samples else { continue };
            let samples = [a, b, c, d];
            let panes = |layers: &Vec<usize>| {
                layers.iter().filter(|&&polygon| !scene[polygon].is_opaque()).count()
            };
            let panes = samples.iter().map(panes).max().unwrap_or(0);
            for channel in 0..3 {
                let color = |layers: &Vec<usize>| {
                    layers.iter().rev().fold(BACKGROUND[channel], |color, &polygon| {
                        let Polygon { color: new, opacity, .. } = scene[polygon];
                        color + (f64::from(new[channel]) - color) * f64::from(opacity)
                    })
                };
                let expected = 255.0 * samples.iter().map(color).sum::<f64>() / 4.0;
                let off = (f64::from(found[channel]) - expected).abs();
                assert!(off < 1.2 + 2.0 * panes as f64, "{off} at {corner:?}: {samples:?}");
            }
            counts.pixels += 1;
            counts.of_several_panes += usize::from(panes > 1);
        }
        let is_pane = |polygon: usize| !scene[polygon].is_opaque();
        for &[near, far] in pairs.iter().filter(|&&[near, far]| pairs.contains(&[far, near])) {
            counts.crossing_panes += usize::from(near < far && is_pane(near) && is_pane(far));
            counts.panes_through_opaque += usize::from(is_pane(near) && !is_pane(far));
        }
    }
    counts
}

#[test]
#[ignore = "needs a graphics adapter, such as the one of Debian's package mesa-vulkan-drivers"]
fn opaque_pixels_have_the_nearest_polygon() {
    let mut scene = scene();
    scene.retain(Polygon::is_opaque);
    // Each polygon has a different colour.
    for (number, polygon) in scene.iter_mut().enumerate() {
        let digits = [number % 9, number / 9 % 9, number / 81];
        polygon.color = digits.map(|digit| (digit as f32) / 10.0);
    }
    let counts = compare(&scene);
    assert!(counts.pixels > 70_000, "{counts:?}");
}

#[test]
#[ignore = "needs a graphics adapter, such as the one of Debian's package mesa-vulkan-drivers"]
fn panes_have_the_colours_of_their_exact_order() {
    let counts = compare(&scene());
    assert!(counts.pixels > 70_000 && counts.of_several_panes > 10_000, "{counts:?}");
    assert!(counts.crossing_panes > 100 && counts.panes_through_opaque > 150, "{counts:?}");
}
