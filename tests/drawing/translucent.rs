//! Drawings in which nothing is hidden: at the centre of each pixel, the same polygons in the same
//! order as the fragments of the tree, by integers of another hand.

use std::collections::HashMap;

use super::fill::{Picture, Pixel};
use super::scenes::cameras;
use binspace::drawing::Drawing;
use binspace::glam::DVec3;
use binspace::internals::{Line, SplitMix64};
use binspace::raster::{Outline, Piece, Rays, for_each_run};
use binspace::scene::{Builtin, Scene};
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions};

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
        let lines: Vec<Line> = fragment.lines().collect();
        let vertices: Vec<[f64; 3]> = fragment.lattice_vertices().collect();
        let outline = match fragment.is_whole() {
            true => Outline::Whole,
            false => Outline::Lines { lines: &lines, vertices: &vertices },
        };
        let piece = Piece { face: fragment.face(), outline };
        for_each_run(rays, tree.faces(), piece, |y, columns| {
            for x in columns {
                pixels[y as usize * width + x as usize].push(polygon);
            }
        });
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
        *parts += usize::from(path.is_cut_out());
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

fn check_scene(scene: &Scene, score: &mut Layers) {
    let tree = BuildOptions::DEFAULT.build(scene.polygons()).unwrap();
    for camera in cameras(scene, 4, [96, 72]) {
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        check_layers(&tree, &camera, rays, score)
            .unwrap_or_else(|fault| panic!("{}, {camera:?}: {fault}", scene.name()));
    }
}

#[test]
fn layers_of_whole_scenes_are_those_of_the_tree() {
    let mut score = Layers::default();
    for builtin in Builtin::ALL {
        let size = builtin.default_size().map(|size| size.min(300));
        check_scene(&builtin.build(size, 3), &mut score);
    }
    assert!(score.pixels > 400_000 && score.layers > 500_000, "{score:?}");
    assert!(score.unsure < score.pixels / 100, "{score:?}");
    // Most cuts of the tree are undone.
    assert!(score.paths * 2 < score.polygons * 3, "{score:?}");
}

/// Polygons that cross have to be in parts; searches for an order end at their limit.
#[test]
fn layers_of_crossing_triangles() {
    let mut random = SplitMix64::new(1);
    let mut score = Layers::default();
    for (count, edge) in [(300, 0.1), (300, 0.5), (60, 1.0)] {
        let mut scene = Scene::new(format!("{count} triangles"), DVec3::Z);
        for _ in 0..count {
            let centre = random.point(0.0, 1.0);
            scene.push([(); 3].map(|()| centre + random.point(-1.0, 1.0) * edge), 0);
        }
        check_scene(&scene, &mut score);
    }
    assert!(score.layers > 300_000 && score.paths > 5 * score.polygons, "{score:?}");
}
