//! What is written of a view: filled polygons in an order to paint them, and lines above them.

use binspace::drawing::Path;
use binspace::scene::Scene;
use binspace::view::Camera;

use crate::colours::Colours;
use crate::fill_order::by_fill;
use crate::shading::shaded;
use crate::strokes::Strokes;
use crate::traps::{Outline, trapped};

/// The width of visible lines, in pixels.
pub(crate) const WIDTH: f64 = 1.0;
/// The width of hidden lines, and how long their dashes and the gaps between them are, in pixels.
pub(crate) const HIDDEN_WIDTH: f64 = 0.6;
pub(crate) const DASHES: [f64; 2] = [3.0, 2.0];

/// A filled path.
#[derive(Debug)]
pub(crate) struct Filled<'a> {
    pub(crate) polygon: usize,
    /// The name of its material, if paths are to be named.
    pub(crate) material: &'a str,
    pub(crate) fill: [u8; 3],
    pub(crate) outlines: Vec<Outline>,
}

/// All of a file.
#[derive(Debug)]
pub(crate) struct Drawn<'a> {
    pub(crate) size: [u32; 2],
    pub(crate) fills: Vec<Filled<'a>>,
    pub(crate) strokes: Vec<Strokes>,
    /// Whether polygons, materials and edges are named.
    pub(crate) ids: bool,
}

/// Where the colours of paths come from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) camera: &'a Camera,
    pub(crate) colours: &'a Colours<'a>,
    pub(crate) ids: bool,
}

/// Paths as they are written: those of one colour together where nothing lies between them, and each
/// extended under its later neighbours.
pub(crate) fn filled<'a>(paths: &[Path<'_>], style: &Style<'a>) -> Vec<Filled<'a>> {
    let Style { scene, camera, colours, ids } = *style;
    let material = |path: &Path<'_>| {
        if ids { scene.material(path.polygon()).name.as_str() } else { "" }
    };
    let fill = |path: &Path<'_>| {
        let polygon = path.polygon();
        shaded(colours.rgb(polygon), scene.polygon(polygon), camera)
    };
    let looks: Vec<(&str, [u8; 3])> =
        paths.iter().map(|path| (material(path), fill(path))).collect();
    let order = by_fill(paths, &looks, camera.size());
    let paths: Vec<Path<'_>> = order.iter().map(|&number| paths[number]).collect();
    let outlines = trapped(&paths, camera.size());
    let all = paths.iter().zip(outlines).zip(&order);
    let filled = all.map(|((path, outlines), &number)| {
        let (material, fill) = looks[number];
        Filled { polygon: path.polygon(), material, fill, outlines }
    });
    filled.collect()
}
