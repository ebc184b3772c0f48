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
/// The width of hidden lines, in pixels.
pub(crate) const HIDDEN_WIDTH: f64 = 0.6;

/// How long the dashes of hidden lines and the gaps between them are, in pixels, by the lines' depth.
pub(crate) const fn dashes(depth: u32) -> [f64; 2] {
    match depth {
        0 | 1 => [3.0, 2.0],
        2 => [2.0, 3.0],
        3 => [1.0, 3.0],
        _ => [1.0, 6.0],
    }
}

/// A filled path.
#[derive(Debug)]
pub(crate) struct Filled<'a> {
    pub(crate) polygon: usize,
    /// The name of its material, if paths are to be named.
    pub(crate) material: &'a str,
    pub(crate) fill: [u8; 3],
    /// From 0 to 1.
    pub(crate) opacity: f32,
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
    /// Whether nothing is hidden, and polygons have their opacities.
    pub(crate) is_translucent: bool,
}

/// Paths as they are written: those that look alike together where nothing lies between them, and opaque
/// ones extended under their later neighbours.
pub(crate) fn filled<'a>(paths: &[Path<'_>], style: &Style<'a>) -> Vec<Filled<'a>> {
    let Style { scene, camera, colours, ids, is_translucent } = *style;
    let material = |path: &Path<'_>| {
        if ids { scene.material(path.polygon()).name.as_str() } else { "" }
    };
    let fill = |path: &Path<'_>| {
        let polygon = path.polygon();
        shaded(colours.rgb(polygon), scene.polygon(polygon), camera)
    };
    let opacity = |path: &Path<'_>| {
        if is_translucent { colours.opacity(path.polygon()).clamp(0.0, 1.0) } else { 1.0 }
    };
    // Opacities from 0 to 1 are in the order of their bits.
    let looks: Vec<(&str, [u8; 3], u32)> =
        paths.iter().map(|path| (material(path), fill(path), opacity(path).to_bits())).collect();
    let order = by_fill(paths, &looks, camera.size());
    let paths: Vec<Path<'_>> = order.iter().map(|&number| paths[number]).collect();
    let outlines = match is_translucent {
        true => paths.iter().map(|path| path.outlines().map(<[_]>::to_vec).collect()).collect(),
        false => trapped(&paths, camera.size()),
    };
    let all = paths.iter().zip(outlines).zip(&order);
    let filled = all.map(|((path, outlines), &number)| {
        let (material, fill, opacity) = looks[number];
        let opacity = f32::from_bits(opacity);
        Filled { polygon: path.polygon(), material, fill, opacity, outlines }
    });
    filled.collect()
}
