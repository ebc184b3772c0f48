//! The plot as a vector picture: one path for each visible quad, then lines, dashed where surfaces hide them,
//! and the visible markers and labels.

use super::{INK, Line, Plot, SIZE, TOWARDS_EYE, UNIT, project};
use binspace::drawing::{Hidden, Paint, Stroke, VectorPicture, ViewOptions, polylines};
use binspace::glam::{DVec2, DVec3};
use binspace::view::Camera;
use std::error::Error;

/// The camera whose projection is `project`.
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

fn rgb([r, g, b, _]: [f64; 4]) -> [u8; 3] {
    [r, g, b].map(|c| (c * 255.0).round() as u8)
}

pub(crate) fn picture(plot: &Plot) -> Result<VectorPicture, Box<dyn Error>> {
    let map = plot.tree.visibility(&camera()?, &ViewOptions::DEFAULT)?;
    let mut picture = VectorPicture::new(map.size()).with_background([247, 247, 242]);
    picture.add_drawing(&map.drawing()?, |quad| rgb(plot.colour(quad)));
    let mesh = polylines(map.edges(Hidden::Skip)?.iter().map(|run| run.ends))?;
    picture.add_lines(mesh, Stroke::new(0.7, [0; 3]).with_opacity(0.16));
    let runs = map.lines(&plot.overlay, Hidden::Keep)?;
    for is_visible in [false, true] {
        for (number, &Line { width, colour, .. }) in plot.lines.iter().enumerate() {
            let own = runs.iter().filter(|run| run.line == number && run.is_visible == is_visible);
            let opacity = colour[3];
            let stroke = match is_visible {
                true => Stroke::new(width, rgb(colour)).with_opacity(opacity),
                false => Stroke::new(width * 0.5, rgb(colour))
                    .with_opacity(opacity * 0.7)
                    .with_dashes(4.0, 4.0),
            };
            picture.add_lines(polylines(own.map(|run| run.ends))?, stroke);
        }
    }
    let dot = Paint::from([255, 214, 77]).with_stroke(Stroke::new(1.5, rgb(INK)));
    // A light outline below, so that the text is readable on any background.
    let label = Paint::from(rgb(INK)).with_stroke(Stroke::new(3.0, [255; 3]).with_opacity(0.6));
    for marker in map.markers(&plot.overlay)?.into_iter().filter(|marker| marker.is_visible) {
        match &*plot.marks[marker.point].text {
            "" => picture.add_marker(marker.position, 5.7, dot),
            text => picture.add_label(marker.position, text, 16.0, label),
        }
    }
    Ok(picture)
}
