//! Checks drawings of translucent polygons in separate integers: the centre of each pixel must have the same
//! polygons in the same order as the fragments of the tree. If some polygons are opaque, only the nearest
//! opaque polygon and the polygons in front of it count.

use std::collections::{HashMap, HashSet};

use super::fill::{Picture, Pixel, ray, with_opacities};
use super::fragment_pixels::for_each_pixel;
use binspace::drawing::{Drawing, ViewOptions, VisibilityMap};
use binspace::raster::Rays;
use binspace::view::Camera;
use binspace::{BspTree, Facing};

/// Counts of compared pixels, their layers, polygons, paths, regions and rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Layers {
    pub pixels: usize,
    pub unsure: usize,
    pub layers: usize,
    pub polygons: usize,
    pub fragments: usize,
    pub paths: usize,
    /// Small polygons: drawn although no pixel shows them, or not visible at all.
    pub small: usize,
    pub hidden: usize,
    /// Paths that are parts of opaque polygons.
    pub clipped: usize,
    pub rays: usize,
    pub regions: usize,
}

/// The polygons at the centre of each pixel, back to front.
fn truth(tree: &BspTree, camera: &Camera) -> Result<Vec<Vec<usize>>, String> {
    let rays = &Rays::new(camera, tree.faces()).map_err(|error| error.to_string())?;
    let [width, height] = rays.size().map(|side| side as usize);
    let mut pixels = vec![vec![]; width * height];
    for fragment in tree.back_to_front(camera.viewpoint()) {
        let polygon = fragment.polygon();
        for_each_pixel(tree, &fragment, rays, |pixel| pixels[pixel].push(polygon));
    }
    Ok(pixels)
}

pub fn check_layers(tree: &BspTree, camera: &Camera, score: &mut Layers) -> Result<(), String> {
    check_translucent(&truth(tree, camera)?, tree, camera, score)
}

fn check_translucent(
    truth: &[Vec<usize>],
    tree: &BspTree,
    camera: &Camera,
    score: &mut Layers,
) -> Result<(), String> {
    let drawing = Drawing::translucent(tree, camera, &ViewOptions::DEFAULT, None).expect("memory");
    let is_unsure = vec![false; truth.len()];
    let is_flat = tree.preparation().flattened == 0;
    compare(&drawing, truth, is_unsure, is_flat, &|_| 0.5, score)?;
    score.fragments += tree.len();
    Ok(())
}

/// Runs all checks of this module: of translucent polygons, and of polygons with opacities.
pub fn check_all(
    tree: &BspTree,
    camera: &Camera,
    opacity: &dyn Fn(usize) -> f64,
    [all, mixed]: [&mut Layers; 2],
) -> Result<(), String> {
    let truth = truth(tree, camera)?;
    check_translucent(&truth, tree, camera, all)?;
    let map = tree.visibility(camera, &with_opacities(tree, opacity)).expect("memory");
    check_map(&map, &truth, tree, opacity, mixed)?;
    check_sight(&map, tree, camera, opacity, mixed)
}

/// Runs the check of this module for polygons with opacities.
pub fn check_mixed(
    tree: &BspTree,
    camera: &Camera,
    opacity: &dyn Fn(usize) -> f64,
    score: &mut Layers,
) -> Result<(), String> {
    let map = tree.visibility(camera, &with_opacities(tree, opacity)).expect("memory");
    check_map(&map, &truth(tree, camera)?, tree, opacity, score)
}

/// Compares a map, its regions and its drawing with the polygons at each pixel.
fn check_map(
    map: &VisibilityMap<'_>,
    truth: &[Vec<usize>],
    tree: &BspTree,
    opacity: &dyn Fn(usize) -> f64,
    score: &mut Layers,
) -> Result<(), String> {
    let drawing = map.drawing().expect("memory");
    // Outlines do not contain parts thinner than this.
    let mut by_cells = Picture::new(map.size());
    for cell in map.cells() {
        let corners: Vec<[f64; 2]> = cell.corners().collect();
        by_cells.fill(cell.polygon(), std::iter::once(&corners[..]));
    }
    let is_unsure: Vec<bool> = by_cells.pixels.iter().map(|p| *p == Pixel::Unsure).collect();
    check_regions(map, truth, &is_unsure, opacity, score)?;
    let is_flat = tree.preparation().flattened == 0;
    let paths = compare(&drawing, truth, is_unsure, is_flat, opacity, score)?;
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
    // Exactly the visible polygons are drawn.
    let shown: Vec<_> = map.polygons().collect();
    if shown.len() != paths.len() || shown.iter().any(|shown| !paths.contains_key(&shown.polygon)) {
        return Err(format!("shown {shown:?}, drawn {paths:?}"));
    }
    Ok(())
}

/// Checks by rays that nothing opaque is in front of the visible polygons. (Where polygons within the
/// tolerance of one plane overlap, the order decides which is visible, and rays cannot judge it.)
fn check_sight(
    map: &VisibilityMap<'_>,
    tree: &BspTree,
    camera: &Camera,
    opacity: &dyn Fn(usize) -> f64,
    score: &mut Layers,
) -> Result<(), String> {
    for shown in map.polygons().filter(|shown| shown.area > 0.01) {
        score.rays += 1;
        let mut hits = tree.hits(ray(camera, shown.point)).filter(|hit| {
            hit.facing() != Facing::EdgeOn && hit.parameter() > 0.0 && opacity(hit.polygon()) > 0.0
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

/// Checks that each pixel is in the region of the polygons visible there, and in no other; and that regions
/// of a polygon have its area.
fn check_regions(
    map: &VisibilityMap<'_>,
    truth: &[Vec<usize>],
    is_unsure: &[bool],
    opacity: &dyn Fn(usize) -> f64,
    score: &mut Layers,
) -> Result<(), String> {
    let regions = map.regions().expect("memory");
    let mut picture = Picture::new(map.size());
    let mut areas: HashMap<usize, f64> = HashMap::new();
    for (number, region) in regions.iter().enumerate() {
        picture.fill(number, region.outlines());
        for &polygon in region.polygons() {
            *areas.entry(polygon).or_default() += region.outlines().map(area).sum::<f64>();
        }
    }
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let found = match pixel {
            _ if is_unsure[i] => continue,
            Pixel::Unsure => continue,
            Pixel::Nothing => vec![],
            Pixel::Polygon(number) => regions[*number].polygons().iter().rev().copied().collect(),
        };
        let expected = visible(&truth[i], opacity);
        if found != expected || picture.layers[i] > 1 {
            let layers = picture.layers[i];
            return Err(format!("pixel {i} is in {layers} regions: {found:?}, not {expected:?}"));
        }
    }
    // Outlines are off by 2⁻¹⁵ of a pixel where parts were joined.
    for shown in map.polygons() {
        let area = areas.remove(&shown.polygon).unwrap_or_default();
        if (area - shown.area).abs() > 3e-3 + 1e-4 * shown.area {
            return Err(format!("{shown:?}, but its regions have {area}"));
        }
    }
    score.regions += regions.len();
    if areas.is_empty() { Ok(()) } else { Err(format!("in no map: {areas:?}")) }
}

fn area(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

/// The visible layers of a list, back to front: an opaque layer hides all layers before it in the list.
fn visible(layers: &[usize], opacity: &dyn Fn(usize) -> f64) -> Vec<usize> {
    let last = layers.iter().rposition(|&polygon| opacity(polygon) == 1.0);
    let rest = &layers[last.unwrap_or(0)..];
    rest.iter().copied().filter(|&polygon| opacity(polygon) > 0.0).collect()
}

/// Compares the paint of a drawing at each pixel with the polygons there, back to front. Returns for each
/// polygon the number of its paths, and the number of paths that are parts. `is_flat`: no polygon was
/// flattened.
fn compare(
    drawing: &Drawing,
    truth: &[Vec<usize>],
    mut is_unsure: Vec<bool>,
    is_flat: bool,
    opacity: &dyn Fn(usize) -> f64,
    score: &mut Layers,
) -> Result<HashMap<usize, [usize; 2]>, String> {
    let width = drawing.size()[0] as usize;
    let mut found: Vec<Vec<usize>> = vec![vec![]; truth.len()];
    let mut paths: HashMap<usize, [usize; 2]> = HashMap::new();
    let mut picture = Picture::new(drawing.size());
    for path in drawing.paths() {
        let [all, parts] = paths.entry(path.polygon()).or_default();
        *all += 1;
        *parts += usize::from(path.is_clipped());
        picture.fill(path.polygon(), path.outlines());
        for i in picture.around(path.outlines()) {
            match std::mem::replace(&mut picture.pixels[i], Pixel::Nothing) {
                Pixel::Nothing => {}
                // If outlines of one path overlapped, the pixel would be covered only once.
                Pixel::Polygon(polygon) => found[i].push(polygon),
                Pixel::Unsure => is_unsure[i] = true,
            }
        }
    }
    let mut seen = HashSet::new();
    for (i, (found, truth)) in found.iter().zip(truth).enumerate() {
        let (found, truth) = (visible(found, opacity), visible(truth, opacity));
        // Flattened faces have gaps at common edges, where the tree's fragments show polygons behind them.
        if is_flat || !is_unsure[i] {
            seen.extend(truth.iter().copied());
        }
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
