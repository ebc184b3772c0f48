//! SVG drawings: the fragments themselves, in order, for a medium without a depth buffer.

use std::io::{self, Write};

use binspace::scene::Scene;

use crate::colours::BACKGROUND;
use crate::pictures::Drawing;
use crate::shading::{hex, shaded};

/// The width of the outline that opaque fragments get in their own colour, in pixels. Too small: the
/// background shows through the seams between neighbours, as viewers blend each fragment with it. Too large:
/// thin fragments grow.
const OUTLINE: f64 = 0.6;

/// Writes the fragments of a scene's tree as a camera sees them, back to front.
pub(crate) fn write(out: &mut dyn Write, drawing: &Drawing<'_>, scene: &Scene) -> io::Result<()> {
    begin(out, drawing.camera.size())?;
    write_fragments(out, drawing, scene)?;
    end(out)
}

/// Writes the end of a picture.
pub(crate) fn end(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "</svg>")
}

/// Writes the fragments alone.
pub(crate) fn write_fragments(
    out: &mut dyn Write,
    drawing: &Drawing<'_>,
    scene: &Scene,
) -> io::Result<()> {
    let Drawing { tree, camera, colours, cull, .. } = *drawing;
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
        let fill = hex(shaded(colours.rgb(polygon), scene.polygon(polygon), camera));
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
    writeln!(out, "</g>")
}

/// Writes the beginning of a picture, with its background.
pub(crate) fn begin(out: &mut dyn Write, [width, height]: [u32; 2]) -> io::Result<()> {
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">"
    )?;
    let background = hex(BACKGROUND);
    writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"{background}\"/>")
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
