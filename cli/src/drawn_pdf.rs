//! Drawings as PDF: one page, a point for each pixel.

use std::io::{self, Write};

use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::writers::ExtGraphicsState;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref};

use crate::colours::BACKGROUND;
use crate::drawn::{Drawn, HIDDEN_WIDTH, WIDTH, dashes};
use crate::path_data::{Steps, points, units};
use crate::strokes::Strokes;

/// The longest side of a page, in points, as the standard has it (ISO 32000-1, annex C).
pub(crate) const LONGEST: u32 = 14_400;
/// How hard to compress, up to 10. Larger: more time for little.
const LEVEL: u8 = 7;

/// Writes a drawing.
pub(crate) fn write(out: &mut dyn Write, drawn: &Drawn<'_>) -> io::Result<()> {
    let [catalog, pages, page, content] = [1, 2, 3, 4].map(Ref::new);
    let [width, height] = drawn.size.map(|side| side as f32);
    let compressed = compress_to_vec_zlib(&painted(drawn), LEVEL);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([page]).count(1);
    let mut only = pdf.page(page);
    only.parent(pages).media_box(Rect::new(0.0, 0.0, width, height)).contents(content);
    let mut resources = only.resources();
    let mut states = resources.ext_g_states();
    for opacity in opacities(drawn) {
        let mut state =
            states.insert(Name(state_name(opacity).as_bytes())).start::<ExtGraphicsState<'_>>();
        state.non_stroking_alpha(opacity);
    }
    states.finish();
    resources.finish();
    only.finish();
    pdf.stream(content, &compressed).filter(Filter::FlateDecode);
    out.write_all(&pdf.finish())
}

/// The operators that paint a page.
fn painted(drawn: &Drawn<'_>) -> Vec<u8> {
    let [width, height] = drawn.size.map(|side| side as f32);
    let units = units(drawn.size);
    let scale = 1.0 / units as f32;
    let mut content = Content::new();
    fill_colour(&mut content, BACKGROUND);
    content.rect(0.0, 0.0, width, height).fill_nonzero();
    // Pages are measured upwards from below.
    content.transform([scale, 0.0, 0.0, -scale, 0.0, height]);
    let (mut last, mut last_opacity) = (BACKGROUND, 1.0);
    for filled in &drawn.fills {
        if filled.opacity != last_opacity {
            content.set_parameters(Name(state_name(filled.opacity).as_bytes()));
            last_opacity = filled.opacity;
        }
        if filled.fill != last {
            fill_colour(&mut content, filled.fill);
            last = filled.fill;
        }
        add(&mut content, &Steps::filled(filled.outlines.iter().map(Vec::as_slice), units));
        content.fill_nonzero();
    }
    content.set_line_join(LineJoinStyle::RoundJoin).set_stroke_gray(0.0);
    for same in drawn.strokes.chunk_by(|a, b| a.depth == b.depth) {
        let depth = same.first().map_or(0, |strokes| strokes.depth);
        if depth == 0 {
            content.set_line_cap(LineCapStyle::RoundCap);
            content.set_line_width(WIDTH as f32 / scale).set_dash_pattern([], 0.0);
        } else {
            let dashes = dashes(depth).map(|length| length as f32 / scale);
            content.set_line_width(HIDDEN_WIDTH as f32 / scale).set_dash_pattern(dashes, 0.0);
        }
        for Strokes { lines, .. } in same {
            add(&mut content, &Steps::drawn(points(lines), units));
            content.stroke();
        }
    }
    content.finish().into_vec()
}

/// The opacities of paths, each once; none if all are opaque.
fn opacities(drawn: &Drawn<'_>) -> Vec<f32> {
    let mut all: Vec<f32> = drawn.fills.iter().map(|filled| filled.opacity).collect();
    all.sort_by(f32::total_cmp);
    all.dedup();
    if all == [1.0] { vec![] } else { all }
}

/// What the graphics state with an opacity is called.
fn state_name(opacity: f32) -> String {
    format!("A{:08x}", opacity.to_bits())
}

fn fill_colour(content: &mut Content, colour: [u8; 3]) {
    // Four decimals are enough to tell 256 values apart.
    let [r, g, b] = colour.map(|channel| (f32::from(channel) / 255.0 * 1e4).round() / 1e4);
    content.set_fill_rgb(r, g, b);
}

/// Adds the outlines or lines of a path.
fn add(content: &mut Content, steps: &Steps) {
    let step = 10f32.powi(-(steps.decimals as i32));
    for line in &steps.lines {
        for (i, corner) in line.corners.iter().enumerate() {
            let [x, y] = corner.map(|c| c as f32 * step);
            if i == 0 {
                content.move_to(x, y)
            } else {
                content.line_to(x, y)
            };
        }
        if line.is_closed {
            content.close_path();
        }
    }
}
