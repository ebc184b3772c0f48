//! Drawings as SVG: one path a polygon, in the order to paint them.

use std::borrow::Cow;
use std::io::{self, Write};

use binspace::drawing::Path;
use binspace::scene::Scene;
use binspace::view::Camera;

use crate::colours::Colours;
use crate::path_data::{decimals, path_data};
use crate::shading::{hex, shaded};
use crate::svg::begin;
use crate::traps::{Outline, trapped};

/// How to write a drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) camera: &'a Camera,
    pub(crate) colours: &'a Colours<'a>,
    /// Whether polygons and materials are named.
    pub(crate) ids: bool,
}

/// A path and its colour.
struct Filled {
    polygon: usize,
    outlines: Vec<Outline>,
    fill: [u8; 3],
}

/// Writes paths of a drawing. Those of one colour that follow one another share it in a group.
pub(crate) fn write(out: &mut dyn Write, paths: &[Path<'_>], style: &Style<'_>) -> io::Result<()> {
    let Style { scene, camera, colours, ids } = *style;
    begin(out, camera.size())?;
    let decimals = decimals(camera.size());
    let outlines = trapped(paths, camera.size());
    let filled = paths.iter().zip(outlines).map(|(path, outlines)| {
        let polygon = path.polygon();
        let fill = shaded(colours.rgb(polygon), scene.polygon(polygon), camera);
        Filled { polygon, outlines, fill }
    });
    let filled: Vec<Filled> = filled.collect();
    let name = |filled: &Filled| scene.material(filled.polygon).name.as_str();
    for run in filled.chunk_by(|a, b| !ids || name(a) == name(b)) {
        let material = run.first().filter(|_| ids).map_or("", name);
        if !material.is_empty() {
            writeln!(out, "<g data-material=\"{}\">", escaped(material))?;
        }
        for same in run.chunk_by(|a, b| a.fill == b.fill) {
            write_same(out, same, decimals, ids)?;
        }
        if !material.is_empty() {
            writeln!(out, "</g>")?;
        }
    }
    writeln!(out, "</svg>")
}

/// Writes paths of one colour.
fn write_same(out: &mut dyn Write, paths: &[Filled], decimals: u32, ids: bool) -> io::Result<()> {
    let fill =
        paths.first().map_or(String::new(), |first| format!(" fill=\"{}\"", hex(first.fill)));
    // For one path a group is longer than it saves.
    let is_group = paths.len() > 1;
    if is_group {
        writeln!(out, "<g{fill}>")?;
    }
    for Filled { polygon, outlines, .. } in paths {
        write!(out, "<path")?;
        if ids {
            write!(out, " data-polygon=\"{polygon}\"")?;
        }
        if !is_group {
            write!(out, "{fill}")?;
        }
        writeln!(out, " d=\"{}\"/>", path_data(outlines.iter().map(Vec::as_slice), decimals))?;
    }
    if is_group { writeln!(out, "</g>") } else { Ok(()) }
}

/// A text as the value of an attribute. Characters that XML cannot hold are replaced.
fn escaped(text: &str) -> Cow<'_, str> {
    let is_plain =
        |c: char| !matches!(c, '<' | '>' | '&' | '"' | '\u{fffe}' | '\u{ffff}') && c >= ' ';
    if text.chars().all(is_plain) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '&' => escaped += "&amp;",
            '"' => escaped += "&quot;",
            // As they stand, readers make spaces of them.
            '\t' => escaped += "&#9;",
            _ => escaped.push(if is_plain(c) { c } else { char::REPLACEMENT_CHARACTER }),
        }
    }
    Cow::Owned(escaped)
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn texts_are_escaped() {
        assert_eq!(escaped("a plain 'näme'"), "a plain 'näme'");
        assert_eq!(
            escaped("a<b>&\"c\"\t\u{1}\u{ffff}"),
            "a&lt;b&gt;&amp;&quot;c&quot;&#9;\u{fffd}\u{fffd}"
        );
    }
}
