//! The plot as a vector picture: one path for each quad that shows, then lines, dashed where surfaces hide
//! them, and the markers and labels that show.

use super::{Line, Plot, SIZE, TOWARDS_EYE, UNIT, project};
use binspace::drawing::{Hidden, ViewOptions, polylines};
use binspace::glam::{DVec2, DVec3};
use binspace::view::Camera;
use std::error::Error;
use std::fmt::Write;

/// The camera of which `project` gives the picture.
pub(crate) fn camera() -> Result<Camera, Box<dyn Error>> {
    let ahead = TOWARDS_EYE.normalize();
    let right = DVec3::Z.cross(ahead).normalize();
    let down = right.cross(ahead);
    let [width, height] = SIZE.map(|side| side as f64);
    let off = (DVec2::new(width, height) * 0.5 - project(DVec3::ZERO)) / UNIT;
    let centre = right * off.x + down * off.y;
    let size = SIZE.map(|side| side as u32);
    Ok(Camera::parallel(-TOWARDS_EYE, DVec3::Z, centre, height / UNIT, size)?)
}

pub(crate) fn text(plot: &Plot) -> Result<String, Box<dyn Error>> {
    let map = plot.tree.visibility(&camera()?, &ViewOptions::DEFAULT)?;
    let [width, height] = SIZE;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#f7f7f2\"/>\n"
    );
    for path in map.drawing()?.paths() {
        let [r, g, b, _] = plot.colour(path.polygon()).map(|c| (c * 255.0).round());
        // As wide as seams.
        write!(out, "<path fill=\"rgb({r},{g},{b})\" stroke=\"rgb({r},{g},{b})\" d=\"")?;
        path.outlines().try_for_each(|outline| data(&mut out, outline, true))?;
        writeln!(out, "\" stroke-width=\".3\"/>")?;
    }
    let visible = map.edges(Hidden::Skip)?;
    write!(
        out,
        "<g fill=\"none\" stroke-linejoin=\"round\"><path stroke=\"#000\" stroke-opacity=\".16\" d=\""
    )?;
    for line in polylines(visible.iter().map(|run| run.ends))? {
        data(&mut out, &line.points, false)?;
    }
    writeln!(out, "\" stroke-width=\".7\"/>")?;
    let runs = map.lines(&plot.overlay, Hidden::Keep)?;
    for is_visible in [false, true] {
        for (number, Line { width, colour, .. }) in plot.lines.iter().enumerate() {
            let own = runs.iter().filter(|run| run.line == number && run.is_visible == is_visible);
            let [r, g, b, opacity] = *colour;
            let [r, g, b] = [r, g, b].map(|c| (c * 255.0).round());
            let style = match is_visible {
                true => format!(
                    "stroke-width=\"{width}\" stroke-opacity=\"{opacity}\" stroke-linecap=\"round\""
                ),
                false => format!(
                    "stroke-width=\"{}\" stroke-opacity=\"{}\" stroke-dasharray=\"4 4\"",
                    width * 0.5,
                    opacity * 0.7
                ),
            };
            for line in polylines(own.map(|run| run.ends))? {
                write!(out, "<path {style} stroke=\"rgb({r},{g},{b})\" d=\"")?;
                data(&mut out, &line.points, false)?;
                writeln!(out, "\"/>")?;
            }
        }
    }
    writeln!(out, "</g>\n<g font-family=\"sans-serif\" font-size=\"16\" text-anchor=\"middle\">")?;
    for marker in map.markers(&plot.overlay)?.into_iter().filter(|marker| marker.is_visible) {
        let ([x, y], mark) = (marker.at, &plot.marks[marker.point]);
        if mark.text.is_empty() {
            writeln!(
                out,
                "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"5.7\" fill=\"#ffd64d\" stroke=\"#1f212b\" stroke-width=\"1.5\"/>"
            )?;
        } else {
            // A light rim below, so that it can be read on anything.
            writeln!(
                out,
                "<text x=\"{x:.2}\" y=\"{:.2}\" fill=\"#1f212b\" stroke=\"#fff\" stroke-opacity=\".6\" \
                 stroke-width=\"3\" paint-order=\"stroke\">{}</text>",
                y + 5.5,
                mark.text
            )?;
        }
    }
    writeln!(out, "</g>\n</svg>")?;
    Ok(out)
}

fn data(out: &mut String, points: &[[f64; 2]], is_closed: bool) -> std::fmt::Result {
    for (i, [x, y]) in points.iter().enumerate() {
        write!(out, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' })?;
    }
    if is_closed { write!(out, "Z") } else { Ok(()) }
}
