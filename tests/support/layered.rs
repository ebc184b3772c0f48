//! Drawings in which nothing is hidden: at the centre of each pixel, the same polygons in the same
//! order as the fragments of the tree, by integers of another hand.

use std::collections::HashMap;

use super::fill::{Picture, Pixel, for_each_pixel};
use binspace::BspTree;
use binspace::drawing::Drawing;
use binspace::raster::Rays;
use binspace::view::Camera;

/// What was compared.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Layers {
    pub(crate) pixels: usize,
    pub(crate) unsure: usize,
    pub(crate) layers: usize,
    pub(crate) polygons: usize,
    pub(crate) fragments: usize,
    pub(crate) paths: usize,
}

/// The polygons at the centre of each pixel, back to front.
fn truth(tree: &BspTree, camera: &Camera, rays: &Rays) -> Vec<Vec<usize>> {
    let [width, height] = rays.size().map(|side| side as usize);
    let mut pixels = vec![vec![]; width * height];
    for fragment in tree.back_to_front(camera.viewpoint()) {
        let polygon = fragment.polygon();
        for_each_pixel(tree, &fragment, rays, |pixel| pixels[pixel].push(polygon));
    }
    pixels
}

pub(crate) fn check_layers(
    tree: &BspTree,
    camera: &Camera,
    rays: Rays,
    score: &mut Layers,
) -> Result<(), String> {
    let truth = truth(tree, camera, &rays);
    let drawing = Drawing::translucent(tree, rays).expect("memory");
    let width = drawing.size()[0] as usize;
    let mut found: Vec<Vec<usize>> = vec![vec![]; truth.len()];
    let mut is_unsure = vec![false; truth.len()];
    let mut paths: HashMap<usize, [usize; 2]> = HashMap::new();
    for path in drawing.paths() {
        let [all, parts] = paths.entry(path.polygon()).or_default();
        *all += 1;
        *parts += usize::from(path.is_clipped());
        let mut picture = Picture::new(drawing.size());
        picture.fill(path.polygon(), path.outlines());
        for (i, pixel) in picture.pixels.iter().enumerate() {
            match pixel {
                Pixel::Nothing => {}
                // Overlapping outlines of one path would count once.
                Pixel::Polygon(polygon) => found[i].push(*polygon),
                Pixel::Unsure => is_unsure[i] = true,
            }
        }
    }
    for (i, (found, truth)) in found.iter().zip(&truth).enumerate() {
        if is_unsure[i] {
            score.unsure += 1;
            continue;
        }
        score.pixels += 1;
        score.layers += truth.len();
        if found != truth {
            let [x, y] = [i % width, i / width];
            return Err(format!("({x}, {y}): {found:?}, not {truth:?}"));
        }
    }
    score.polygons += paths.len();
    score.fragments += tree.len();
    score.paths += drawing.paths().len();
    // A polygon is in one path, or each of its paths is a part.
    if paths.values().any(|&[all, parts]| all > 1 && parts != all) {
        return Err(format!("parts: {paths:?}"));
    }
    Ok(())
}
