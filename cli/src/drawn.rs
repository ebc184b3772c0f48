//! What is written of a view: filled polygons in an order to paint them, and lines above them.

use binspace::drawing::{Path, Region};
use binspace::scene::Scene;
use binspace::view::Camera;

use crate::colours::Colours;
use crate::fill_order::by_fill;
use crate::seams::Seams;
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
    /// What shows, front to back: one, but for regions where something shows through.
    pub(crate) polygons: Vec<usize>,
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
    /// Whether fills are regions side by side, to be added up.
    pub(crate) are_regions: bool,
}

/// Where the colours of paths come from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) camera: &'a Camera,
    pub(crate) colours: &'a Colours<'a>,
    pub(crate) ids: bool,
    /// Whether all polygons are drawn as if they were opaque.
    pub(crate) is_opaque: bool,
    pub(crate) seams: Seams,
}

impl<'a> Style<'a> {
    pub(crate) fn opacity(&self, polygon: usize) -> f32 {
        if self.is_opaque { 1.0 } else { self.colours.opacity(polygon) }
    }

    pub(crate) fn fill(&self, polygon: usize) -> [u8; 3] {
        shaded(self.colours.rgb(polygon), self.scene.polygon(polygon), self.camera)
    }

    fn material(&self, polygon: usize) -> &'a str {
        if self.ids { &self.scene.material(polygon).name } else { "" }
    }

    /// The colour of polygons one behind the other, front to back, times its opacity, and that: from 0 to 1.
    pub(crate) fn blended(&self, polygons: &[usize]) -> [f64; 4] {
        let over = |below: [f64; 4], &polygon: &usize| {
            let opacity = f64::from(self.opacity(polygon));
            let [r, g, b] = self.fill(polygon).map(|channel| f64::from(channel) / 255.0);
            let own = [r, g, b, 1.0];
            std::array::from_fn(|i| own[i] * opacity + below[i] * (1.0 - opacity))
        };
        polygons.iter().rev().fold([0.0; 4], over)
    }
}

/// Regions as they are written: those that look alike together.
pub(crate) fn filled_regions<'a>(regions: &[Region], style: &Style<'a>) -> Vec<Filled<'a>> {
    let filled = regions.iter().map(|region| {
        let [r, g, b, opacity] = style.blended(region.polygons());
        let front = region.polygons().first().copied().unwrap_or_default();
        Filled {
            polygons: region.polygons().to_vec(),
            material: style.material(front),
            fill: [r, g, b].map(|channel| (255.0 * channel / opacity).round() as u8),
            // Four decimals are finer than 256 levels.
            opacity: (1e4 * opacity).round() as f32 / 1e4,
            outlines: region.outlines().map(<[_]>::to_vec).collect(),
        }
    });
    let mut filled: Vec<Filled<'_>> = filled.collect();
    filled.sort_by_key(|filled| (filled.material, filled.fill, filled.opacity.to_bits()));
    filled
}

/// Paths as they are written: those that look alike together where nothing lies between them, and opaque
/// ones extended under their later neighbours.
pub(crate) fn filled<'a>(paths: &[Path<'_>], style: &Style<'a>) -> Vec<Filled<'a>> {
    let size = style.camera.size();
    // Opacities from 0 to 1 are in the order of their bits.
    let look = |path: &Path<'_>| {
        let polygon = path.polygon();
        (style.material(polygon), style.fill(polygon), style.opacity(polygon).to_bits())
    };
    let looks: Vec<(&str, [u8; 3], u32)> = paths.iter().map(look).collect();
    let order = by_fill(paths, &looks, size);
    let paths: Vec<Path<'_>> = order.iter().map(|&number| paths[number]).collect();
    let is_trapped =
        |number: usize| style.seams == Seams::Trap && style.opacity(paths[number].polygon()) == 1.0;
    let outlines = trapped(&paths, size, is_trapped);
    let all = paths.iter().zip(outlines).zip(&order);
    let filled = all.map(|((path, outlines), &number)| {
        let (material, fill, opacity) = looks[number];
        let opacity = f32::from_bits(opacity);
        Filled { polygons: vec![path.polygon()], material, fill, opacity, outlines }
    });
    filled.collect()
}
