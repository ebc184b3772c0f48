//! Drawings of translucent polygons: at the centre of each pixel, the same polygons in the same order as
//! the fragments of the tree, by integers of another hand; where some are opaque, those before the first
//! of these and itself.

use std::collections::{HashMap, HashSet};

use super::fill::{Picture, Pixel, for_each_pixel, ray};
use binspace::BspTree;
use binspace::drawing::{Drawing, VisibilityMap};
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
    /// Polygons that are drawn though no pixel shows them, and those that do not show at all.
    pub(crate) small: usize,
    pub(crate) hidden: usize,
    /// Paths of opaque polygons that are parts.
    pub(crate) clipped: usize,
    pub(crate) rays: usize,
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
    compare(&drawing, &truth, |_| 0.5, score)?;
    score.fragments += tree.len();
    Ok(())
}

/// The same of polygons with opacities.
pub(crate) fn check_mixed(
    tree: &BspTree,
    camera: &Camera,
    rays: Rays,
    opacity: &dyn Fn(usize) -> f64,
    score: &mut Layers,
) -> Result<(), String> {
    let truth = truth(tree, camera, &rays);
    let map = VisibilityMap::with_opacities(tree, rays, opacity).expect("memory");
    let drawing = map.drawing().expect("memory");
    let paths = compare(&drawing, &truth, opacity, score)?;
    score.fragments += tree.len();
    score.hidden += tree.preparation().polygons - paths.len();
    for (&polygon, [all, parts]) in &paths {
        if opacity(polygon) == 0.0 {
            return Err(format!("{polygon} is drawn"));
        }
        if opacity(polygon) == 1.0 {
            score.clipped += parts;
            if *all != 1 {
                return Err(format!("{polygon} is opaque and has {all} paths"));
            }
        }
    }
    // What is drawn shows, by rays, and what shows is drawn.
    let shown: Vec<_> = map.polygons().collect();
    if shown.len() != paths.len() || shown.iter().any(|shown| !paths.contains_key(&shown.polygon)) {
        return Err(format!("shown {shown:?}, drawn {paths:?}"));
    }
    for shown in shown.iter().filter(|shown| shown.area > 0.01) {
        score.rays += 1;
        let mut hits = tree.hits(ray(camera, shown.point)).filter(|hit| {
            hit.facing().is_ne() && hit.parameter() > 0.0 && opacity(hit.polygon()) > 0.0
        });
        let own = hits.clone().find(|hit| hit.polygon() == shown.polygon);
        let Some(own) = own else { return Err(format!("no ray meets {shown:?}")) };
        let hides =
            |hit: &binspace::Hit<'_>| opacity(hit.polygon()) == 1.0 && hit.compare(&own).is_lt();
        if let Some(hit) = hits.find(hides) {
            return Err(format!("{shown:?} is hidden by {hit:?}"));
        }
    }
    Ok(())
}

/// Compares what a drawing paints at each pixel with the polygons there, back to front; how many paths
/// each polygon has, and how many of these are parts.
fn compare(
    drawing: &Drawing,
    truth: &[Vec<usize>],
    opacity: impl Fn(usize) -> f64,
    score: &mut Layers,
) -> Result<HashMap<usize, [usize; 2]>, String> {
    // What opaque polygons are painted over does not show.
    let visible = |layers: &[usize]| -> Vec<usize> {
        let last = layers.iter().rposition(|&polygon| opacity(polygon) == 1.0);
        let rest = &layers[last.unwrap_or(0)..];
        rest.iter().copied().filter(|&polygon| opacity(polygon) > 0.0).collect()
    };
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
    let mut seen = HashSet::new();
    for (i, (found, truth)) in found.iter().zip(truth).enumerate() {
        let (found, truth) = (visible(found), visible(truth));
        seen.extend(truth.iter().copied());
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
    if let Some(polygon) = seen.iter().find(|polygon| !paths.contains_key(polygon)) {
        return Err(format!("{polygon} shows, but has no path"));
    }
    score.polygons += paths.len();
    score.paths += drawing.paths().len();
    score.small += paths.keys().filter(|polygon| !seen.contains(polygon)).count();
    // A polygon is in one path, or each of its paths is a part.
    if paths.values().any(|&[all, parts]| all > 1 && parts != all) {
        return Err(format!("parts: {paths:?}"));
    }
    Ok(paths)
}
