//! SVG drawings: the fragments themselves, in order, for a medium without a depth buffer.

use std::io::{self, Write};

use binspace::glam::DVec3;
use binspace::raster::brightness;
use binspace::scene::Scene;
use binspace::view::{Camera, Projection};

use crate::colours::BACKGROUND;
use crate::pictures::Drawing;

/// The width of the outline that opaque fragments get in their own colour, in pixels. Smaller: the
/// background shows through the seams between neighbours, as viewers blend each fragment with it;
/// larger: thin fragments grow.
const OUTLINE: f64 = 0.6;

/// Writes the fragments of a scene's tree as a camera sees them, back to front.
pub(crate) fn write(out: &mut dyn Write, drawing: &Drawing<'_>, scene: &Scene) -> io::Result<()> {
    let Drawing { tree, camera, colours, cull, .. } = *drawing;
    let [width, height] = camera.size();
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">"
    )?;
    let background = hex(BACKGROUND);
    writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"{background}\"/>")?;
    writeln!(out, "<g stroke-width=\"{OUTLINE}\" stroke-linejoin=\"round\">")?;
    let mut corners = Vec::new();
    for fragment in tree.back_to_front(camera.viewpoint()) {
        if !cull.shows(&fragment, camera.viewpoint()) {
            continue;
        }
        corners.clear();
        corners.extend(fragment.vertices());
        let outline = camera.clip(&corners);
        if outline.len() < 3 {
            continue;
        }
        let polygon = fragment.polygon();
        let share = polygon_brightness(scene.polygon(polygon), camera);
        let fill = hex(colours.rgb(polygon).map(|c| (f64::from(c) * share).round() as u8));
        // Adding 0 turns -0 into 0.
        let opacity = colours.opacity(polygon) + 0.0;
        // The outlines of translucent neighbours would show where they overlap.
        let paint = if opacity < 1.0 {
            format!("fill=\"{fill}\" fill-opacity=\"{opacity}\"")
        } else {
            format!("fill=\"{fill}\" stroke=\"{fill}\"")
        };
        writeln!(out, "<path {paint} d=\"{}\"/>", path(&outline))?;
    }
    writeln!(out, "</g>\n</svg>")
}

/// The brightness of a polygon: as in the painter's pictures, but constant over the polygon, so
/// that the seams of its fragments do not show.
fn polygon_brightness(polygon: &[DVec3], camera: &Camera) -> f64 {
    let share = 1.0 / polygon.len() as f64;
    let middle: DVec3 = polygon.iter().map(|&corner| corner * share).sum();
    // Newell's normal, as polygons need not be planar.
    let arms = polygon.iter().map(|&corner| corner - middle);
    let next = arms.clone().cycle().skip(1);
    let normal: DVec3 = arms.zip(next).map(|(arm, next)| arm.cross(next)).sum();
    let direction = match *camera.projection() {
        Projection::Perspective { eye, .. } => (middle - eye).normalize_or_zero(),
        Projection::Parallel { .. } => camera.forward(),
    };
    brightness(normal.normalize_or_zero(), direction)
}

/// A closed path, to a hundredth of a pixel.
fn path(outline: &[[f64; 2]]) -> String {
    let mut path = String::new();
    for (i, &[x, y]) in outline.iter().enumerate() {
        path += if i == 0 { "M" } else { "L" };
        path += &format!("{} {}", short(x), short(y));
    }
    path + "Z"
}

fn short(coordinate: f64) -> f64 {
    // Adding 0 turns "-0" into "0".
    (coordinate * 100.0).round() / 100.0 + 0.0
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
