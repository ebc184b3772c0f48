//! Drawings as SVG: one path a polygon, in the order to paint them, and lines above.

use std::borrow::Cow;
use std::io::{self, Write};

use binspace::drawing::{EdgeKind, EdgeRun};

use crate::drawn::{Drawn, Filled, HIDDEN_WIDTH, WIDTH, dashes};
use crate::path_data::{Steps, points, units};
use crate::shading::hex;
use crate::strokes::Strokes;
use crate::svg::begin;

/// Writes a drawing. Paths of one colour that follow one another share it in a group.
///
/// Coordinates are whole numbers of a small unit, so that they need no points.
pub(crate) fn write(out: &mut dyn Write, drawn: &Drawn<'_>) -> io::Result<()> {
    begin(out, drawn.size)?;
    let units = units(drawn.size);
    writeln!(out, "<g transform=\"scale({})\">", 1.0 / f64::from(units))?;
    if drawn.are_regions {
        // Added up in a group of their own, and all together put on the background.
        writeln!(out, "<style>.regions path{{mix-blend-mode:plus-lighter}}</style>")?;
        writeln!(out, "<g class=\"regions\" style=\"isolation:isolate\">")?;
    }
    for run in drawn.fills.chunk_by(|a, b| a.material == b.material) {
        let material = run.first().map_or("", |filled| filled.material);
        if !material.is_empty() {
            writeln!(out, "<g data-material=\"{}\">", escaped(material))?;
        }
        for same in run.chunk_by(|a, b| (a.fill, a.opacity) == (b.fill, b.opacity)) {
            write_same(out, same, units, drawn.ids)?;
        }
        if !material.is_empty() {
            writeln!(out, "</g>")?;
        }
    }
    if drawn.are_regions {
        writeln!(out, "</g>")?;
    }
    for same in drawn.strokes.chunk_by(|a, b| a.depth == b.depth) {
        write_strokes(out, same, units, drawn.ids)?;
    }
    writeln!(out, "</g>\n</svg>")
}

/// Writes paths of one colour and opacity.
fn write_same(out: &mut dyn Write, paths: &[Filled<'_>], units: u32, ids: bool) -> io::Result<()> {
    let mut fill = String::new();
    if let Some(Filled { fill: colour, opacity, .. }) = paths.first() {
        fill = format!(" fill=\"{}\"", hex(*colour));
        if *opacity < 1.0 {
            fill += &format!(" fill-opacity=\"{opacity}\"");
        }
    }
    // For one path a group is longer than it saves.
    let is_group = paths.len() > 1;
    if is_group {
        writeln!(out, "<g{fill}>")?;
    }
    for Filled { polygons, outlines, .. } in paths {
        write!(out, "<path")?;
        match &polygons[..] {
            [polygon] if ids => write!(out, " data-polygon=\"{polygon}\"")?,
            all if ids => {
                let all: Vec<String> = all.iter().map(usize::to_string).collect();
                write!(out, " data-polygons=\"{}\"", all.join(" "))?;
            }
            _ => {}
        }
        if !is_group {
            write!(out, "{fill}")?;
        }
        let steps = Steps::filled(outlines.iter().map(Vec::as_slice), units);
        writeln!(out, " d=\"{}\"/>", steps.data())?;
    }
    if is_group { writeln!(out, "</g>") } else { Ok(()) }
}

/// Writes lines, all of one depth: one path for each kind of edges, or, named, for each
/// run of an edge.
fn write_strokes(out: &mut dyn Write, all: &[Strokes], units: u32, ids: bool) -> io::Result<()> {
    let scaled = |pixels: f64| pixels * f64::from(units);
    let depth = all.first().map_or(0, |strokes| strokes.depth);
    if depth == 0 {
        let width = scaled(WIDTH);
        write!(out, "<g class=\"visible\" stroke-width=\"{width}\" stroke-linecap=\"round\"")?;
    } else {
        let ([dash, gap], width) = (dashes(depth).map(scaled), scaled(HIDDEN_WIDTH));
        // A second class for those behind several polygons.
        let layers = if depth > 1 { format!(" layers-{depth}") } else { String::new() };
        write!(
            out,
            "<g class=\"hidden{layers}\" stroke-width=\"{width}\" stroke-dasharray=\"{dash} {gap}\""
        )?;
    }
    writeln!(out, " fill=\"none\" stroke=\"#000000\" stroke-linejoin=\"round\">")?;
    for Strokes { class, runs, lines, .. } in all {
        if !ids {
            let data = Steps::drawn(points(lines), units).data();
            writeln!(out, "<path class=\"{class}\" d=\"{data}\"/>")?;
            continue;
        }
        writeln!(out, "<g class=\"{class}\">")?;
        for line in lines {
            for (ends, &number) in line.points.windows(2).zip(&line.segments) {
                let data = Steps::drawn([ends].into_iter(), units).data();
                let EdgeRun { polygon, edge, kind, .. } = runs[number];
                write!(out, "<path data-polygon=\"{polygon}\"")?;
                match (edge, kind) {
                    (Some(edge), _) => write!(out, " data-edge=\"{edge}\"")?,
                    (_, EdgeKind::Crossing(other)) => write!(out, " data-crosses=\"{other}\"")?,
                    _ => {}
                }
                writeln!(out, " d=\"{data}\"/>")?;
            }
        }
        writeln!(out, "</g>")?;
    }
    writeln!(out, "</g>")
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
