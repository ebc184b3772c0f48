//! Vector pictures as SVG.
//!
//! Coordinates are whole numbers of a small unit, relative to the previous point, so the numbers are short.
//! The look of a shape is its paint and the size of its font. Consecutive shapes with the same look are
//! written as a group, which states the look once.

use std::borrow::Cow;
use std::fmt::{self, Write};

use super::picture::{
    Line, Node, Paint, PaintedShape, Part, Shape, Steps, Stroke, VectorPicture, units,
};

impl VectorPicture {
    /// Returns the picture as the text of an SVG file.
    ///
    /// Labels are text, in the fonts of the viewer. [Groups](Self::group) have attributes.
    pub fn to_svg(&self) -> String {
        let mut out = String::new();
        // Writing to a string does not fail.
        let _ = self.write_svg(&mut out);
        out
    }

    fn write_svg(&self, out: &mut String) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">"
        )?;
        if let Some(colour) = self.background {
            let fill = hex(colour);
            writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"{fill}\"/>")?;
        }
        let scale = f64::from(units(self.size));
        writeln!(out, "<g transform=\"scale({})\">", 1.0 / scale)?;
        if self.adds_up {
            writeln!(out, "<style>.binspace-sum path{{mix-blend-mode:plus-lighter}}</style>")?;
        }
        write_nodes(&self.nodes, |part| match part {
            Written::Begin { attributes, look } => {
                write!(out, "<g{attributes}")?;
                write_look(out, look, scale)?;
                writeln!(out, ">")
            }
            Written::Item { item, attributes, look } => {
                write_item(out, item, attributes, look, scale)
            }
            Written::End => writeln!(out, "</g>"),
        })?;
        writeln!(out, "</g>\n</svg>")
    }
}

/// The attributes that shapes may have in common: their paint, and the size of their font.
pub(super) type Look = (Paint, Option<f64>);

/// A part of a file, in the order of writing. A look is `None` if an enclosing group states it.
pub(super) enum Written<'a> {
    /// The beginning of a group.
    Begin { attributes: &'a str, look: Option<Look> },
    /// A shape, with the attributes of a group that contains only this shape.
    Item { item: &'a PaintedShape, attributes: &'a str, look: Option<Look> },
    /// The end of the last open group.
    End,
}

/// A group that is being written: its end, and the look that the group states for its contents, if any.
struct Open {
    end: usize,
    look: Option<Look>,
}

/// Writes nodes. Consecutive shapes of one look are grouped.
pub(super) fn write_nodes(
    nodes: &[Node],
    mut write: impl FnMut(Written<'_>) -> fmt::Result,
) -> fmt::Result {
    let looks = looks(nodes);
    let mut open: Vec<Open> = Vec::new();
    let mut at = 0;
    loop {
        while open.pop_if(|group| group.end == at).is_some() {
            write(Written::End)?;
        }
        let Some(node) = nodes.get(at) else { return Ok(()) };
        let known = open.last().and_then(|group| group.look);
        // The look of this node, unless an enclosing group states it.
        let look = if known.is_none() { looks[at] } else { None };
        if look.is_some() {
            let limit = open.last().map_or(nodes.len(), |group| group.end);
            let mut end = after(nodes, at);
            let is_alone = end == limit || looks[end] != look;
            while end < limit && looks[end] == look {
                end = after(nodes, end);
            }
            // A group for one node would make the file longer.
            if !is_alone {
                write(Written::Begin { attributes: "", look })?;
                open.push(Open { end, look });
                continue;
            }
        }
        match node {
            Node::Shape(item) => write(Written::Item { item, attributes: "", look })?,
            Node::Group { attributes, end } => match &nodes[at + 1..*end] {
                [] => {}
                [Node::Shape(item)] => {
                    at += 1;
                    write(Written::Item { item, attributes, look })?;
                }
                _ => {
                    write(Written::Begin { attributes, look })?;
                    open.push(Open { end: *end, look: known.or(look) });
                }
            },
        }
        at += 1;
    }
}

/// The number of the node after a node and its contents.
fn after(nodes: &[Node], at: usize) -> usize {
    match nodes[at] {
        Node::Group { end, .. } => end,
        Node::Shape(_) => at + 1,
    }
}

/// The look of each node; for a group, the common look of all its shapes, if any.
fn looks(nodes: &[Node]) -> Vec<Option<Look>> {
    let mut looks = vec![None; nodes.len()];
    for (at, node) in nodes.iter().enumerate().rev() {
        looks[at] = match node {
            Node::Shape(PaintedShape { paint, shape: Shape::Label { size, .. }, .. }) => {
                Some((*paint, Some(*size)))
            }
            Node::Shape(PaintedShape { paint, .. }) => Some((*paint, None)),
            Node::Group { end, .. } => {
                let mut inner = at + 1;
                let first = if inner < *end { looks[inner] } else { None };
                while inner < *end && looks[inner] == first {
                    inner = after(nodes, inner);
                }
                first.filter(|_| inner == *end)
            }
        };
    }
    looks
}

fn write_item(
    out: &mut String,
    item: &PaintedShape,
    attributes: &str,
    look: Option<Look>,
    scale: f64,
) -> fmt::Result {
    match &item.shape {
        Shape::Path(steps) => {
            write!(out, "<path{attributes}")?;
            match (look, item.part) {
                (None, Part::Fill) => write!(out, " stroke=\"none\"")?,
                (None, Part::Stroke) => write!(out, " fill=\"none\"")?,
                (None, Part::All) => {}
                (Some(_), _) => write_look(out, Some((item.own_paint(), None)), scale)?,
            }
            writeln!(out, " d=\"{}\"/>", data(steps))
        }
        Shape::Marker { at: [x, y], radius } => {
            write!(out, "<circle{attributes}")?;
            write_look(out, look, scale)?;
            writeln!(out, " cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>", short(radius * scale))
        }
        Shape::Label { at: [x, y], text, .. } => {
            write!(out, "<text{attributes}")?;
            write_look(out, look, scale)?;
            writeln!(out, " x=\"{x}\" y=\"{y}\">{}</text>", escaped(text))
        }
    }
}

fn write_look(out: &mut String, look: Option<Look>, scale: f64) -> fmt::Result {
    let Some((Paint { fill, opacity, stroke }, font)) = look else { return Ok(()) };
    match fill {
        Some(colour) => write!(out, " fill=\"{}\"", hex(colour))?,
        None => write!(out, " fill=\"none\"")?,
    }
    if fill.is_some() && opacity < 1.0 {
        write!(out, " fill-opacity=\"{opacity}\"")?;
    }
    if let Some(Stroke { width, colour, opacity, dashes, round_ends }) = stroke {
        let width = short(width * scale);
        write!(out, " stroke=\"{}\" stroke-width=\"{width}\"", hex(colour))?;
        if opacity < 1.0 {
            write!(out, " stroke-opacity=\"{opacity}\"")?;
        }
        if let Some([dash, gap]) = dashes.map(|lengths| lengths.map(|c| short(c * scale))) {
            write!(out, " stroke-dasharray=\"{dash} {gap}\"")?;
        }
        if round_ends && font.is_none() {
            write!(out, " stroke-linecap=\"round\"")?;
        }
        write!(out, " stroke-linejoin=\"round\"")?;
    }
    if let Some(size) = font {
        let size = short(size * scale);
        write!(out, " font-family=\"Helvetica,Arial,sans-serif\" font-size=\"{size}\"")?;
        write!(out, " text-anchor=\"middle\"")?;
        if stroke.is_some() {
            write!(out, " paint-order=\"stroke\"")?;
        }
    }
    Ok(())
}

/// A length in units, without decimals that are not visible.
fn short(length: f64) -> f64 {
    (length * 1e3).round() / 1e3
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The data of a path. Steps from one corner to the next are whole, so rounding errors do not add up.
fn data(steps: &Steps) -> String {
    let mut data = Data { text: String::new(), decimals: steps.decimals, had_point: false };
    let mut pen = [0; 2];
    for Line { corners, is_closed } in &steps.lines {
        data.command('m');
        let start = corners.first().copied().unwrap_or(pen);
        for &corner in corners {
            for axis in 0..2 {
                data.number(corner[axis] - pen[axis]);
            }
            pen = corner;
        }
        if *is_closed {
            data.command('z');
            pen = start;
        }
    }
    data.text
}

/// The text of a path's data, as short as its grammar allows.
struct Data {
    text: String,
    decimals: u32,
    /// Whether the previous number has a decimal point.
    had_point: bool,
}

impl Data {
    fn command(&mut self, letter: char) {
        self.text.push(letter);
        self.had_point = false;
    }

    /// Adds a number of steps. The number is separated from the previous number by its sign, by its decimal
    /// point if both numbers have one, or otherwise by a space.
    fn number(&mut self, steps: i64) {
        let unit = 10u64.pow(self.decimals);
        let (whole, rest) = (steps.unsigned_abs() / unit, steps.unsigned_abs() % unit);
        let begins_with_point = whole == 0 && rest > 0;
        let is_first = self.text.ends_with(|last: char| last.is_ascii_alphabetic());
        if steps < 0 {
            self.text.push('-');
        } else if !(is_first || begins_with_point && self.had_point) {
            self.text.push(' ');
        }
        if !begins_with_point {
            push(&mut self.text, whole);
        }
        self.had_point = rest > 0;
        if rest > 0 {
            let digits = format!("{rest:0width$}", width = self.decimals as usize);
            self.text.push('.');
            self.text.push_str(digits.trim_end_matches('0'));
        }
    }
}

fn push(text: &mut String, number: u64) {
    // Writing to a string does not fail.
    let _ = write!(text, "{number}");
}

/// Escapes a text for the value of an attribute or the text of an element. Characters that XML does not allow
/// are replaced.
pub(super) fn escaped(text: &str) -> Cow<'_, str> {
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
            // Parsers turn unescaped tabs and line ends into spaces.
            '\t' => escaped += "&#9;",
            '\n' => escaped += "&#10;",
            '\r' => escaped += "&#13;",
            _ => escaped.push(if is_plain(c) { c } else { char::REPLACEMENT_CHARACTER }),
        }
    }
    Cow::Owned(escaped)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(outlines: &[&[[f64; 2]]], units: u32) -> String {
        data(&Steps::filled(outlines, units))
    }

    #[test]
    fn steps_are_short_and_set_apart() {
        let outline = [[11.5, 4.1], [12.75, 3.0], [12.7, 3.0], [12.7, 3.05], [13.7, -0.5]];
        assert_eq!(filled(&[&outline], 100), "m1150 410 125-110-5 0 0 5 100-355z");
        let square = [[-0.5, -0.5], [0.0, -0.5], [0.0, 0.0]];
        let hole = [[0.75, 1.0], [1.0, 1.25], [1.25, 1.0]];
        assert_eq!(filled(&[&square, &hole], 100), "m-50-50 50 0 0 50zm125 150 25 25 25-25z");
    }

    #[test]
    fn lines_are_open_or_closed() {
        let corner = [[0.5, 0.5], [1.5, 0.5], [1.5, 2.5]];
        let ring = [[0.5, 1.5], [1.5, 1.5], [0.5, 2.5], [0.5, 1.5]];
        let dot = [[3.5, 3.5], [3.501, 3.5]];
        let lines: [&[[f64; 2]]; 4] = [&corner, &ring, &dot, &corner[..2]];
        let data = data(&Steps::drawn(lines.into_iter(), 10));
        // After an open line the pen is at its end, after a closed line at its start.
        assert_eq!(data, "m5 5 10 0 0 20m-10-10 10 0-10 10zm30 20 0 0m-30-30 10 0");
    }

    #[test]
    fn roundings_do_not_add_up() {
        // Each step is 0.004, which alone would be rounded to nothing.
        let mut outline: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i) * 0.004, 0.5]).collect();
        outline.push([2.0, 9.5]);
        let text = filled(&[&outline], 100);
        let ends = filled(&[&[outline[0], outline[999], outline[1000]]], 100);
        assert_eq!(ends, "m0 50 400 0-200 900z");
        assert!(text.starts_with("m0 50 1 0"), "{text}");
        assert!(text.ends_with(" 0-200 900z"), "{text}");
    }

    #[test]
    fn small_shapes_keep_an_area() {
        let speck = [[3.0, 3.0], [3.001, 3.0], [3.0, 3.0003]];
        assert_eq!(filled(&[&speck], 100), "m300 300 .1 0-.1.03z");
        // Smaller than all steps, but still a path.
        assert_eq!(filled(&[&[[3.0, 3.0], [3.0, 3.0], [3.0, 3.0]]], 100), "m300 300z");
        // Coincident corners are one, and the hole vanishes.
        let square = [[0.0, 0.0], [0.001, 0.0], [4.0, 0.0], [4.0, 4.0], [0.001, 0.001]];
        assert_eq!(filled(&[&square, &speck], 100), "m0 0 400 0 0 400z");
    }

    #[test]
    fn texts_are_escaped() {
        assert_eq!(escaped("a plain 'näme'"), "a plain 'näme'");
        assert_eq!(
            escaped("a<b>&\"c\"\t\u{1}\u{ffff}"),
            "a&lt;b&gt;&amp;&quot;c&quot;&#9;\u{fffd}\u{fffd}"
        );
    }
}
