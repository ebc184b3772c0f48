//! Drawings as vector pictures: filled polygons in an order to paint them, and lines above them.

use std::ops::ControlFlow;

use binspace::drawing::{Drawing, EdgeKind, EdgeRun, Paint, Path, Region, Stroke, VectorPicture};
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace::{Error, Progress};
use clap::ValueEnum;

use crate::colours::Colours;
use crate::shading::shaded;
use crate::strokes::Strokes;

/// The width of hidden lines, as a share of the width of visible lines.
pub(crate) const HIDDEN_WIDTH: f64 = 0.6;

/// The lengths of dashes and of gaps in hidden lines of a depth. `width` is the width of visible lines.
pub(crate) fn dashes(depth: u32, width: f64) -> [f64; 2] {
    let lengths = match depth {
        0 | 1 => [3.0, 2.0],
        2 => [2.0, 3.0],
        3 => [1.0, 3.0],
        _ => [1.0, 6.0],
    };
    lengths.map(|length: f64| length * width)
}

/// The treatment of seams. Viewers blend each path with the paint below it. Along an edge of two polygons that
/// both cover half of a pixel, a quarter of the background shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Seams {
    /// Extend opaque polygons a little under opaque neighbours that are painted later; translucent
    /// polygons keep their seams
    #[default]
    Trap,
    /// SVG only: write a path for each region in which the same polygons are visible, in their blended
    /// colour; viewers add the paths up (`mix-blend-mode: plus-lighter`), and no seam remains
    PlusLighter,
    /// Leave the seams: each path is exactly its polygon
    None,
}

/// The source of the colours of paths.
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

    /// The blend of polygons given front to back: the premultiplied colour and the opacity, each from 0 to 1.
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

/// Adds regions, which viewers add up. Regions of the same look are added together.
pub(crate) fn add_regions(picture: &mut VectorPicture, regions: &[Region], style: &Style<'_>) {
    let front = |region: &Region| region.polygons().first().copied().unwrap_or_default();
    let filled = regions.iter().map(|region| {
        let [r, g, b, opacity] = style.blended(region.polygons());
        let fill = [r, g, b].map(|channel| (255.0 * channel / opacity).round() as u8);
        (style.material(front(region)), fill, opacity, region)
    });
    let mut filled: Vec<_> = filled.collect();
    // As finely as opacities are written.
    filled.sort_by_key(|&(material, fill, opacity, _)| {
        (material, fill, (1e4 * opacity).round() as u32)
    });
    picture.added_up(|picture| {
        for run in filled.chunk_by(|a, b| a.0 == b.0) {
            named(picture, run[0].0, |picture| {
                for &(_, fill, opacity, region) in run {
                    let numbers: Vec<String> =
                        region.polygons().iter().map(usize::to_string).collect();
                    let name = if numbers.len() == 1 { "data-polygon" } else { "data-polygons" };
                    let names = [(name, &*numbers.join(" "))];
                    picture.group(if style.ids { &names } else { &[] }, |picture| {
                        let paint = Paint::from(fill).with_opacity(opacity);
                        picture.add_area(region.outlines(), paint);
                    });
                }
            });
        }
    });
}

/// Adds the paths of a drawing. Paths of the same look are added together if nothing lies between them.
pub(crate) fn add_drawing(
    picture: &mut VectorPicture,
    drawing: &Drawing,
    style: &Style<'_>,
    progress: Option<&(dyn Fn(Progress) -> ControlFlow<()> + Sync)>,
) -> Result<(), Error> {
    let opacity = |polygon| style.opacity(polygon);
    // Opacities from 0 to 1 are in the order of their bits.
    let look = |polygon| (style.material(polygon), style.fill(polygon), opacity(polygon).to_bits());
    let traps = |polygon| style.seams == Seams::Trap && opacity(polygon) == 1.0;
    let batched = drawing.batched(look);
    let drawing = match progress {
        Some(progress) => batched.trapped_with_progress(traps, progress)?,
        None => batched.trapped(traps),
    };
    let paths: Vec<Path<'_>> = drawing.paths().collect();
    let material = |path: &Path<'_>| style.material(path.polygon());
    for run in paths.chunk_by(|a, b| material(a) == material(b)) {
        named(picture, material(&run[0]), |picture| {
            for path in run {
                let polygon = path.polygon();
                let number = polygon.to_string();
                let names = [("data-polygon", &*number)];
                picture.group(if style.ids { &names } else { &[] }, |picture| {
                    let opacity = f64::from(opacity(polygon));
                    let paint = Paint::from(style.fill(polygon)).with_opacity(opacity);
                    picture.add_area(path.outlines(), paint);
                });
            }
        });
    }
    Ok(())
}

/// Adds shapes inside a group that names their material, if materials are named.
fn named(picture: &mut VectorPicture, material: &str, add: impl FnOnce(&mut VectorPicture)) {
    if material.is_empty() {
        add(picture);
    } else {
        picture.group(&[("data-material", material)], add);
    }
}

/// Adds lines: one path for each kind of edges or, with names, for each run of an edge.
pub(crate) fn add_strokes(picture: &mut VectorPicture, all: &[Strokes], width: f64, ids: bool) {
    for same in all.chunk_by(|a, b| a.depth == b.depth) {
        let (depth, stroke) = (same[0].depth, stroke(same[0].depth, width));
        let class = match depth {
            0 => "visible".to_owned(),
            1 => "hidden".to_owned(),
            // A second class for lines behind several polygons.
            _ => format!("hidden layers-{depth}"),
        };
        picture.group(&[("class", &class)], |picture| {
            for Strokes { class, runs, lines, .. } in same {
                picture.group(&[("class", class)], |picture| {
                    if !ids {
                        picture.add_lines(lines, stroke);
                        return;
                    }
                    for line in lines {
                        for (ends, &number) in line.points.windows(2).zip(&line.segments) {
                            add_run(picture, &runs[number], ends, stroke);
                        }
                    }
                });
            }
        });
    }
}

/// Adds a run of an edge with the names of its polygon and of the edge.
fn add_run(picture: &mut VectorPicture, run: &EdgeRun, ends: &[[f64; 2]], stroke: Stroke) {
    let polygon = run.polygon.to_string();
    let second = match (run.edge, run.kind) {
        (Some(edge), _) => Some(("data-edge", edge.to_string())),
        (_, EdgeKind::Crossing(other)) => Some(("data-crosses", other.to_string())),
        _ => None,
    };
    let mut names = vec![("data-polygon", &*polygon)];
    names.extend(second.iter().map(|(name, number)| (*name, &**number)));
    picture.group(&names, |picture| picture.add_lines([ends], stroke));
}

fn stroke(depth: u32, width: f64) -> Stroke {
    if depth == 0 {
        return Stroke::new(width, [0; 3]);
    }
    let [dash, gap] = dashes(depth, width);
    Stroke::new(HIDDEN_WIDTH * width, [0; 3]).with_dashes(dash, gap)
}
