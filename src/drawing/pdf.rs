//! Vector pictures as PDF (ISO 32000-1): one page, a point for each pixel.

use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::types::{LineCapStyle, LineJoinStyle, TextRenderingMode};
use pdf_writer::writers::{ExtGraphicsState, Type1Font};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};

use super::picture::{Node, Paint, PaintedShape, Shape, Steps, Stroke, VectorPicture, units};

/// The level of compression, up to 10. Too large: more time for little effect. Too small: longer files.
const LEVEL: u8 = 7;
/// The name of the font in the page.
const FONT: Name<'_> = Name(b"F");

impl VectorPicture {
    /// Returns the picture as a PDF of one page. A pixel becomes a point, which is 1/72 inch.
    ///
    /// ```
    /// use binspace::drawing::VectorPicture;
    ///
    /// let mut picture = VectorPicture::new([200, 100]);
    /// picture.add_label([100.0, 50.0], "Hello", 24.0, [0, 0, 0]);
    /// assert!(picture.to_pdf().starts_with(b"%PDF"));
    /// ```
    ///
    /// Viewers may reject pages with a side of more than 14 400 points (ISO 32000-1, annex C). Labels are in
    /// Helvetica, which every viewer has: see [`add_label`](Self::add_label). Without a background, the page
    /// has the colour of the paper.
    pub fn to_pdf(&self) -> Vec<u8> {
        let [catalog, pages, page, content, font] = [1, 2, 3, 4, 5].map(Ref::new);
        let [width, height] = self.size.map(|side| side as f32);
        let compressed = compress_to_vec_zlib(&painted(self), LEVEL);
        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let mut only = pdf.page(page);
        only.parent(pages).media_box(Rect::new(0.0, 0.0, width, height)).contents(content);
        let mut resources = only.resources();
        let mut states = resources.ext_g_states();
        for opacity in opacities(self) {
            let name = state_name(opacity);
            let mut state = states.insert(Name(name.as_bytes())).start::<ExtGraphicsState<'_>>();
            state.stroking_alpha(opacity).non_stroking_alpha(opacity);
        }
        states.finish();
        let has_labels = items(self).any(|item| matches!(item.shape, Shape::Label { .. }));
        if has_labels {
            resources.fonts().pair(FONT, font);
        }
        resources.finish();
        only.finish();
        pdf.stream(content, &compressed).filter(Filter::FlateDecode);
        if has_labels {
            let mut helvetica: Type1Font<'_> = pdf.type1_font(font);
            helvetica.base_font(Name(b"Helvetica"));
            helvetica.encoding_predefined(Name(b"WinAnsiEncoding"));
        }
        pdf.finish()
    }
}

fn items(picture: &VectorPicture) -> impl Iterator<Item = &PaintedShape> {
    picture.nodes.iter().filter_map(|node| match node {
        Node::Shape(item) => Some(item),
        Node::Group { .. } => None,
    })
}

/// The opacities of fills and strokes, each once; empty if all are opaque.
fn opacities(picture: &VectorPicture) -> Vec<f32> {
    let mut all: Vec<f32> = Vec::new();
    for Paint { fill, opacity, stroke } in items(picture).map(PaintedShape::own_paint) {
        all.extend(fill.map(|_| opacity as f32));
        all.extend(stroke.map(|stroke| stroke.opacity as f32));
    }
    all.sort_by(f32::total_cmp);
    all.dedup();
    if all == [1.0] { vec![] } else { all }
}

/// The name of the graphics state with an opacity.
fn state_name(opacity: f32) -> String {
    format!("A{:08x}", opacity.to_bits())
}

/// The operators that paint a page.
fn painted(picture: &VectorPicture) -> Vec<u8> {
    let [width, height] = picture.size.map(|side| side as f32);
    let units = units(picture.size) as f32;
    let mut page = Page {
        content: Content::new(),
        units,
        fill: None,
        stroke: None,
        opacity: 1.0,
        width: None,
        dashes: None,
        has_round_ends: false,
    };
    if let Some(colour) = picture.background {
        page.set_fill(colour, 1.0);
        page.content.rect(0.0, 0.0, width, height).fill_nonzero();
    }
    // The coordinates of a page grow upwards.
    page.content.transform([1.0 / units, 0.0, 0.0, -1.0 / units, 0.0, height]);
    for item in items(picture) {
        let paint = item.own_paint();
        match &item.shape {
            Shape::Path(steps) => page.paint(paint, |content| add_path(content, steps)),
            Shape::Marker { at, radius } => {
                let radius = *radius as f32 * units;
                page.paint(paint, |content| add_circle(content, *at, radius));
            }
            Shape::Label { at, size, text } => page.write(paint, *at, *size as f32, text),
        }
    }
    page.content.finish().into_vec()
}

/// A page with the state of its graphics, so that only changes are written.
struct Page {
    content: Content,
    /// The number of units of a pixel.
    units: f32,
    fill: Option<[u8; 3]>,
    stroke: Option<[u8; 3]>,
    opacity: f32,
    width: Option<f32>,
    dashes: Option<[f32; 2]>,
    has_round_ends: bool,
}

impl Page {
    /// Fills and strokes a path that a function adds.
    fn paint(&mut self, paint: Paint, add: impl Fn(&mut Content)) {
        if let Some(colour) = paint.fill {
            self.set_fill(colour, paint.opacity);
            add(&mut self.content);
            self.content.fill_nonzero();
        }
        if let Some(stroke) = paint.stroke {
            self.set_stroke(stroke);
            add(&mut self.content);
            self.content.stroke();
        }
    }

    /// Writes a text with the middle of its baseline at a point, the strokes of its letters first.
    fn write(&mut self, paint: Paint, at: [i64; 2], size: f32, text: &str) {
        let (text, size) = (win_ansi(text), size * self.units);
        let width = text.iter().map(|&code| f32::from(width(code))).sum::<f32>() / 1000.0 * size;
        let [x, y] = at.map(|c| c as f32);
        let show = |page: &mut Self, mode: TextRenderingMode| {
            let content = page.content.begin_text();
            content.set_font(FONT, size).set_text_rendering_mode(mode);
            // Flips y, so that letters are upright although coordinates grow downwards.
            content.set_text_matrix([1.0, 0.0, 0.0, -1.0, x - 0.5 * width, y]);
            content.show(Str(&text)).end_text();
        };
        if let Some(stroke) = paint.stroke {
            self.set_stroke(stroke);
            show(self, TextRenderingMode::Stroke);
        }
        if let Some(colour) = paint.fill {
            self.set_fill(colour, paint.opacity);
            show(self, TextRenderingMode::Fill);
        }
    }

    fn set_fill(&mut self, colour: [u8; 3], opacity: f64) {
        self.set_opacity(opacity);
        if self.fill.replace(colour) != Some(colour) {
            let [r, g, b] = colour.map(share);
            self.content.set_fill_rgb(r, g, b);
        }
    }

    fn set_stroke(&mut self, stroke: Stroke) {
        let Stroke { width, colour, opacity, dashes, round_ends } = stroke;
        self.set_opacity(opacity);
        match self.stroke.replace(colour) {
            Some(last) if last == colour => {}
            last => {
                if last.is_none() {
                    self.content.set_line_join(LineJoinStyle::RoundJoin);
                }
                let [r, g, b] = colour.map(share);
                if r == g && g == b {
                    self.content.set_stroke_gray(r);
                } else {
                    self.content.set_stroke_rgb(r, g, b);
                }
            }
        }
        let width = width as f32 * self.units;
        if self.width.replace(width) != Some(width) {
            self.content.set_line_width(width);
        }
        let dashes = dashes.map(|lengths| lengths.map(|length| length as f32 * self.units));
        if dashes != self.dashes {
            self.dashes = dashes;
            self.content.set_dash_pattern(dashes.into_iter().flatten(), 0.0);
        }
        if round_ends != self.has_round_ends {
            self.has_round_ends = round_ends;
            let caps = [LineCapStyle::ButtCap, LineCapStyle::RoundCap];
            self.content.set_line_cap(caps[usize::from(round_ends)]);
        }
    }

    fn set_opacity(&mut self, opacity: f64) {
        let opacity = opacity as f32;
        if opacity != self.opacity {
            self.opacity = opacity;
            self.content.set_parameters(Name(state_name(opacity).as_bytes()));
        }
    }
}

/// A channel of a colour from 0 to 1. Four decimals are enough to tell 256 values apart.
fn share(channel: u8) -> f32 {
    (f32::from(channel) / 255.0 * 1e4).round() / 1e4
}

fn add_path(content: &mut Content, steps: &Steps) {
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

/// Adds a circle as four cubic curves.
fn add_circle(content: &mut Content, at: [i64; 2], radius: f32) {
    // Off by less than a 3000th of the radius.
    const ARM: f32 = 0.552_284_8;
    let [x, y] = at.map(|c| c as f32);
    content.move_to(x + radius, y);
    for [ax, ay] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0_f32]] {
        // From the end of one arm to the end of the next arm, a quarter turn further.
        let place = |along: f32, across: f32| {
            [x + radius * (along * ax - across * ay), y + radius * (along * ay + across * ax)]
        };
        let [[x1, y1], [x2, y2], [x3, y3]] = [place(1.0, ARM), place(ARM, 1.0), place(0.0, 1.0)];
        content.cubic_to(x1, y1, x2, y2, x3, y3);
    }
    content.close_path();
}

/// A text in WinAnsiEncoding, which is Windows-1252. Minus signs become dashes, which are as wide; other
/// characters that the encoding lacks become question marks.
fn win_ansi(text: &str) -> Vec<u8> {
    // The characters from 0x80 on; a space for a missing character.
    const SPECIAL: &str = "€ ‚ƒ„…†‡ˆ‰Š‹Œ Ž  ‘’“”•–—˜™š›œ žŸ";
    let code = |c: char| match c {
        ' '..='~' | '\u{a0}'..='\u{ff}' => c as u8,
        '−' => 0x96,
        _ => SPECIAL.chars().position(|special| special == c).map_or(b'?', |i| 0x80 + i as u8),
    };
    text.chars().map(code).collect()
}

/// The width of a character of WinAnsiEncoding in Helvetica, in thousandths of the font's height.
fn width(code: u8) -> u16 {
    usize::from(code).checked_sub(0x20).map_or(0, |at| WIDTHS[at])
}

/// The widths from 0x20 on, from Adobe's font metrics. Codes without a character have the width of a bullet.
#[rustfmt::skip]
const WIDTHS: [u16; 224] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584, 350,
    556, 350, 222, 556, 333, 1000, 556, 556, 333, 1000, 667, 333, 1000, 350, 611, 350,
    350, 222, 222, 333, 333, 350, 556, 1000, 333, 1000, 500, 333, 944, 350, 500, 667,
    278, 333, 556, 556, 556, 556, 260, 556, 333, 737, 370, 556, 584, 333, 737, 333,
    400, 584, 333, 333, 333, 556, 537, 278, 333, 333, 365, 556, 834, 834, 834, 611,
    667, 667, 667, 667, 667, 667, 1000, 722, 667, 667, 667, 667, 278, 278, 278, 278,
    722, 722, 778, 778, 778, 778, 778, 584, 778, 722, 722, 722, 722, 667, 667, 611,
    556, 556, 556, 556, 556, 556, 889, 500, 556, 556, 556, 556, 278, 278, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 584, 611, 556, 556, 556, 556, 500, 556, 500,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_have_the_codes_of_windows_1252() {
        assert_eq!(win_ansi("Az~ é€‚”ŸŒ™"), b"Az~\x20\xe9\x80\x82\x94\x9f\x8c\x99");
        assert_eq!(win_ansi("−1 日\n\u{81}"), b"\x961 ???");
    }

    /// A picture with a label, a marker and an area, all of whose numbers are equal.
    fn picture_of(number: f64) -> VectorPicture {
        let mut picture = VectorPicture::new([200, 100]).with_background([250; 3]);
        let stroke = Stroke { width: number, opacity: number, ..Stroke::new(1.0, [9, 8, 7]) };
        let paint = Paint::from([255, 0, 0]).with_opacity(number).with_stroke(stroke);
        picture.add_area([[[0.0, 0.0], [number, 1.0], [3.0, 4.0]]], paint);
        picture.add_lines([[[1.0, number], [5.0, 5.0]]], stroke.with_dashes(number, number));
        picture.add_marker([10.0, 20.0], number, paint);
        picture.add_label([100.0, 50.0], "(a\\b)", number, [0, 0, 255]);
        picture
    }

    #[test]
    fn the_table_of_objects_is_right() {
        for (picture, count) in [(VectorPicture::new([3, 4]), 5), (picture_of(0.5), 6)] {
            let bytes = picture.to_pdf();
            let head = format!("\nxref\n0 {count}\n");
            let table = bytes.windows(head.len()).position(|w| w == head.as_bytes()).unwrap();
            for object in 1..count {
                let entry = &bytes[table + head.len() + 20 * object..][..10];
                let at: usize = std::str::from_utf8(entry).unwrap().parse().unwrap();
                assert!(bytes[at..].starts_with(format!("{object} 0 obj").as_bytes()), "{object}");
            }
        }
    }

    #[test]
    fn odd_numbers_leave_shapes_out() {
        for (number, fills) in [
            // The background, the area, the marker and the label.
            (0.3, 4),
            (7.0, 4),
            // Too far away, or so large that they are clamped to the largest marker and label.
            (1e300, 3),
            (f64::INFINITY, 3),
            // The background alone.
            (1e-300, 1),
            (0.0, 1),
            (-1.0, 1),
            (f64::NAN, 1),
        ] {
            let text = painted(&picture_of(number));
            let text = String::from_utf8(text).unwrap();
            assert!(!text.contains("NaN") && !text.contains("inf"), "{number}: {text}");
            let count = text.split_whitespace().filter(|&token| token == "f" || token == "ET");
            assert_eq!(count.count(), fills, "{number}: {text}");
        }
    }

    /// The middle of a label of known width is at the label's point.
    #[test]
    fn labels_are_centred() {
        let mut picture = VectorPicture::new([600, 400]);
        picture.add_label([100.0, 50.0], "WW", 10.0, [0, 0, 0]);
        let text = painted(&picture);
        let text = String::from_utf8_lossy(&text);
        // Two letters of 0.944 of the font, and capitals of 0.718.
        let place = [50.0 * (100.0 - 9.44), (50.0_f64 * (50.0 + 3.59)).round()];
        assert!(text.contains(&format!("1 0 0 -1 {} {} Tm", place[0], place[1])), "{text}");
    }

    /// Letters with and without an accent are equally wide, and so are all digits.
    #[test]
    fn widths_match_the_characters() {
        let of = |text: &str| win_ansi(text).into_iter().map(width).collect::<Vec<_>>();
        assert_eq!(of("ÀÁÅÇÈËÌÏÑÒÖÙÜÝàåçèëñòöùüýÿŠšŽž"), of("AAACEEIINOOUUYaaceenoouuyySsZz"));
        assert_eq!(of("0123456789"), [556; 10]);
        assert_eq!(of("‘‚“„–—…"), [222, 222, 333, 333, 556, 1000, 1000]);
        assert_eq!(of("iMW@"), [222, 833, 944, 1015]);
    }
}
