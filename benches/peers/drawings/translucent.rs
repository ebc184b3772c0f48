//! Drawings in which nothing is hidden: the number of pieces for each polygon.

use super::cpu_time;
use super::fill::{Picture, Pixel};
use binspace::BspTree;
use binspace::drawing::{Drawing, ViewOptions};
use binspace::paint::paint_tree;
use binspace::raster::Rays;
use binspace::view::Camera;
use std::collections::HashSet;
use std::time::Duration;
use support::{Table, ratio, time};
use testkit::fragment_pixels::for_each_pixel;

/// The figures of a scene.
pub(super) fn row(tree: &BspTree, camera: &Camera, name: &str, building: Duration) -> Vec<String> {
    let rays = Rays::new(camera, tree.faces()).expect("a picture");
    let (taken, drawing) = cpu_time(|| {
        Drawing::translucent(tree, camera, &ViewOptions::DEFAULT, None).expect("memory")
    });
    let judged = check(tree, camera, &rays, &drawing, name);
    let polygons: HashSet<usize> = drawing.paths().map(|path| path.polygon()).collect();
    let pieces = drawing.paths().len() as f64 / polygons.len() as f64;
    vec![
        name.to_owned(),
        polygons.len().to_string(),
        tree.len().to_string(),
        drawing.paths().len().to_string(),
        format!("{pieces:.2}"),
        time(taken),
        ratio(taken, building),
        judged.to_string(),
        "0".to_owned(),
    ]
}

pub(super) fn print(rows: &[Vec<String>]) {
    let table = Table::new(
        "Drawings with nothing hidden",
        &[
            "scene",
            "polygons drawn",
            "fragments",
            "paths",
            "paths / polygon",
            "time",
            "÷ tree",
            "pixels",
            "wrong",
        ],
    );
    rows.iter().for_each(|row| table.row(row));
}

/// Checks that, in each judged pixel, the number of covering paths equals the number of covering fragments of
/// the tree, and that the last path and the last fragment have the same polygon. Returns the number of judged
/// pixels.
fn check(tree: &BspTree, camera: &Camera, rays: &Rays, drawing: &Drawing, name: &str) -> usize {
    let truth = paint_tree(tree, camera.viewpoint(), rays);
    let layers = layers(tree, rays);
    let found = Picture::of(drawing);
    let mut judged = 0;
    for (i, &face) in truth.faces().iter().enumerate() {
        let expected = match face {
            u32::MAX => Pixel::Nothing,
            face => Pixel::Polygon(tree.faces().polygon(face)),
        };
        if found.pixels[i] == Pixel::Unsure {
            continue;
        }
        judged += 1;
        assert_eq!(found.pixels[i], expected, "{name}: pixel {i}");
        assert_eq!(found.layers[i], layers[i], "{name}: pixel {i}");
    }
    assert!(judged * 10 > layers.len() * 9, "{name}: {judged}");
    judged
}

/// The number of fragments that cover each pixel.
fn layers(tree: &BspTree, rays: &Rays) -> Vec<u32> {
    let [width, height] = rays.size().map(|side| side as usize);
    let mut layers = vec![0; width * height];
    for fragment in tree.fragments() {
        for_each_pixel(tree, &fragment, rays, |pixel| layers[pixel] += 1);
    }
    layers
}
