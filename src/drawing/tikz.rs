//! Vector pictures as TikZ, for LaTeX: a big point for each pixel.

use std::fmt::{self, Write};

use super::picture::{Line, Paint, PaintedShape, Shape, Steps, Stroke, VectorPicture, units};
use super::svg::{Look, Written, write_nodes};

/// The largest coordinate, in big points: TeX has no length beyond 16 383.99 TeX points.
const FURTHEST: f64 = 16_000.0;
/// The largest number of corners in one line of the file. Too large: pdfLaTeX refuses lines of 200 000 bytes.
/// Too small: files are longer.
const CORNERS: usize = 50;

/// The beginning of a file that LaTeX compiles alone or includes in a document.
const HEAD: &str = "\
% By itself: pdflatex FILE. In a document that has \\usepackage{tikz}: \\input{FILE}.
% Styles change it: \\tikzset{binspace/CLASS/.style={...}} before it, for the CLASS of a scope below.
\\ifdefined\\tikzpicture
\\let\\binspaceend\\relax
\\else
\\documentclass[tikz]{standalone}
\\begin{document}
\\def\\binspaceend{\\end{document}}
\\fi
\\begin{tikzpicture}[x=1bp,y=-1bp,line join=round]
";

impl VectorPicture {
    /// Returns the picture as TikZ, in a complete LaTeX file. `\input` includes the picture in a document
    /// that uses the package `tikz`.
    ///
    /// ```
    /// use binspace::drawing::{Stroke, VectorPicture};
    ///
    /// let mut picture = VectorPicture::new([200, 100]);
    /// picture.group(&[("class", "axis")], |picture| {
    ///     picture.add_lines([[[0.0, 50.0], [200.0, 50.0]]], Stroke::new(1.0, [0, 0, 0]));
    /// });
    /// assert!(picture.to_tikz().contains("binspace/axis/.try"));
    /// ```
    ///
    /// A pixel becomes a big point, which is 1/72 inch. Each word of the `class` of a [group](Self::group) is
    /// a style that the document may define, for example `\tikzset{binspace/axis/.style={draw=red}}`:
    ///
    /// | shape | its colour and line come from |
    /// |---|---|
    /// | a label in a group of several shapes | the label |
    /// | any other shape in a group whose shapes all have the same paint | the style, if the document defines it |
    /// | any other | the shape |
    ///
    /// Labels are in the document's font, which must contain their characters. Left out are
    ///
    /// - strokes of labels;
    /// - words of a `class` with characters other than letters, digits and hyphens, and all other attributes;
    /// - shapes that reach further than 16 000 pixels, or have a wider stroke or longer dashes, because TeX
    ///   has no lengths of this size.
    pub fn to_tikz(&self) -> String {
        let mut out = HEAD.to_owned();
        // Writing to a string does not fail.
        let _ = self.write_tikz(&mut out);
        out
    }

    fn write_tikz(&self, out: &mut String) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(out, "\\clip (0,0) rectangle ({width},{height});")?;
        if let Some(colour) = self.background {
            write!(out, "\\fill[fill={}", rgb(colour))?;
            writeln!(out, ",binspace/background/.try] (0,0) rectangle ({width},{height});")?;
        }
        let units = units(self.size);
        write_nodes(&self.nodes, |part| match part {
            Written::Begin { attributes, look } => {
                write!(out, "\\begin{{scope}}")?;
                write_options(out, paint_options(look.map(|(paint, _)| paint)), attributes)?;
                writeln!(out)
            }
            Written::Item { item, attributes, look } => {
                write_item(out, item, attributes, look, units)
            }
            Written::End => writeln!(out, "\\end{{scope}}"),
        })?;
        writeln!(out, "\\end{{tikzpicture}}%\n\\binspaceend")
    }
}

fn write_item(
    out: &mut String,
    item: &PaintedShape,
    attributes: &str,
    look: Option<Look>,
    units: u32,
) -> fmt::Result {
    let PaintedShape { shape, .. } = item;
    let paint = item.own_paint();
    let label = if let Shape::Label { size, .. } = shape { Some(*size) } else { None };
    if !fits(shape, units) || !stroke_fits(&paint) && label.is_none() {
        return Ok(());
    }
    let (command, options) = match (label, paint.fill, paint.stroke) {
        (Some(_), None, _) => return Ok(()),
        // A filled node would be a bar, and a drawn node would have a frame.
        (Some(size), Some(colour), _) => ("\\node", label_options(size, colour, paint.opacity)),
        (None, Some(_), Some(_)) => ("\\filldraw", paint_options(look.map(|_| paint))),
        (None, Some(_), None) => ("\\fill", paint_options(look.map(|_| paint))),
        (None, None, _) => ("\\draw", paint_options(look.map(|_| paint))),
    };
    write!(out, "{command}")?;
    write_options(out, options, attributes)?;
    match shape {
        Shape::Path(Steps { lines, decimals }) => {
            let steps = f64::from(units) * 10f64.powi(*decimals as i32);
            for (number, Line { corners, is_closed }) in lines.iter().enumerate() {
                for (i, corner) in corners.iter().enumerate() {
                    let [x, y] = corner.map(|c| short(c as f64 / steps));
                    let between = match (number, i) {
                        (0, 0) => " ",
                        (_, 0) => "\n",
                        _ if i % CORNERS == 0 => "\n--",
                        _ => "--",
                    };
                    write!(out, "{between}({x},{y})")?;
                }
                write!(out, "{}", if *is_closed { "--cycle" } else { "" })?;
            }
        }
        Shape::Marker { at, radius } => {
            let [x, y] = at.map(|c| short(c as f64 / f64::from(units)));
            write!(out, " ({x},{y}) circle[radius={}bp]", short(*radius))?;
        }
        Shape::Label { at, text, .. } => {
            let [x, y] = at.map(|c| short(c as f64 / f64::from(units)));
            write!(out, " at ({x},{y}) {{{}}}", escaped(text))?;
        }
    }
    writeln!(out, ";")
}

/// Whether all lengths of a stroke are within TeX's range.
fn stroke_fits(paint: &Paint) -> bool {
    paint.stroke.is_none_or(|Stroke { width, dashes, .. }| {
        let [dash, gap] = dashes.unwrap_or_default();
        [width, dash, gap].into_iter().all(|length| length <= FURTHEST)
    })
}

/// Whether all lengths of a shape are within TeX's range.
fn fits(shape: &Shape, units: u32) -> bool {
    let is_near = |point: &[i64; 2], decimals: u32, radius: f64| {
        let most = (FURTHEST - radius) * f64::from(units) * 10f64.powi(decimals as i32);
        point.iter().all(|c| c.unsigned_abs() as f64 <= most)
    };
    match shape {
        Shape::Path(Steps { lines, decimals }) => lines
            .iter()
            .flat_map(|line| &line.corners)
            .all(|corner| is_near(corner, *decimals, 0.0)),
        Shape::Marker { at, radius } => is_near(at, 0, *radius),
        Shape::Label { at, size, .. } => is_near(at, 0, 0.0) && *size <= FURTHEST,
    }
}

fn label_options(size: f64, colour: [u8; 3], opacity: f64) -> Vec<String> {
    let (size, colour) = (short(size), rgb(colour));
    vec![
        format!("anchor=base,inner sep=0pt,text={colour},text opacity={opacity}"),
        format!("font=\\fontsize{{{size}bp}}{{{size}bp}}\\selectfont"),
    ]
}

fn paint_options(paint: Option<Paint>) -> Vec<String> {
    let mut options = Vec::new();
    // Shapes whose stroke does not fit are left out.
    let Some(paint) = paint.filter(stroke_fits) else { return options };
    let Paint { fill, opacity, stroke } = paint;
    options.extend(fill.map(|colour| format!("fill={}", rgb(colour))));
    options.extend((opacity < 1.0).then(|| format!("fill opacity={opacity}")));
    if let Some(Stroke { width, colour, opacity, dashes, round_ends }) = stroke {
        options.push(format!("draw={},line width={}bp", rgb(colour), short(width)));
        options.extend((opacity < 1.0).then(|| format!("draw opacity={opacity}")));
        options.extend(dashes.map(|lengths| {
            let [dash, gap] = lengths.map(short);
            format!("dash pattern=on {dash}bp off {gap}bp")
        }));
        options.extend(round_ends.then(|| "line cap=round".to_owned()));
    }
    options
}

/// Writes the options of a scope or a shape, and then the styles of its classes. The styles override the
/// options.
fn write_options(out: &mut String, mut options: Vec<String>, attributes: &str) -> fmt::Result {
    // Values of other attributes do not contain these characters, because their quotation marks are escaped.
    let classes = attributes.split_once(" class=\"").and_then(|(_, rest)| rest.split_once('"'));
    let is_plain = |word: &&str| word.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
    let words = classes.map_or("", |(classes, _)| classes).split_whitespace().filter(is_plain);
    options.extend(words.map(|word| format!("binspace/{word}/.try")));
    if options.is_empty() { Ok(()) } else { write!(out, "[{}]", options.join(",")) }
}

/// A length in big points, without decimals that TeX does not use.
fn short(length: f64) -> f64 {
    (length * 1e4).round() / 1e4 + 0.0
}

fn rgb([r, g, b]: [u8; 3]) -> String {
    format!("{{rgb,255:red,{r};green,{g};blue,{b}}}")
}

/// Escapes the characters of a text that are commands of TeX.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\\' => escaped += "\\textbackslash{}",
            '^' => escaped += "\\textasciicircum{}",
            '~' => escaped += "\\textasciitilde{}",
            '{' | '}' | '$' | '&' | '#' | '%' | '_' => escaped.extend(['\\', c]),
            // In the font encoding OT1, other characters have the codes of these three.
            '<' => escaped += "\\textless{}",
            '>' => escaped += "\\textgreater{}",
            '|' => escaped += "\\textbar{}",
            // Packages for languages define the quotation mark as a command.
            '"' => escaped += "\\symbol{34}",
            '\u{2212}' => escaped += "$-$",
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_escaped() {
        let text = "50 % of {a_1} & \\b^2 ~ $3 #4\n\u{2212}ä";
        let expected = "50 \\% of \\{a\\_1\\} \\& \\textbackslash{}b\\textasciicircum{}2 \
                        \\textasciitilde{} \\$3 \\#4 $-$ä";
        assert_eq!(escaped(text), expected);
        let others = "\\textless{}\\textgreater{}\\textbar{}\\symbol{34}";
        assert_eq!(escaped("<>|\""), others);
    }

    #[test]
    fn classes_become_styles() {
        let options = |attributes: &str| {
            let mut out = String::new();
            write_options(&mut out, vec![], attributes).unwrap();
            out
        };
        assert_eq!(options(""), "");
        assert_eq!(options(" data-a=\"b\""), "");
        let hidden = " id=\"x\" class=\"hidden layers-2 a,b\" data-a=\"b\"";
        assert_eq!(options(hidden), "[binspace/hidden/.try,binspace/layers-2/.try]");
    }

    #[test]
    fn shapes_that_reach_too_far_for_tex_are_left_out() {
        let shapes = |far: f64| {
            let mut picture = VectorPicture::new([640, 480]);
            let stroke = Stroke::new(1.0, [0; 3]);
            picture.add_lines([[[0.0, 0.0], [far, 1.0]]], stroke);
            picture.add_area([[[0.0, 0.0], [1.0, far], [2.0, 0.0]]], [0; 3]);
            picture.add_marker([1.0, 1.0], far, [0; 3]);
            picture.add_label([far, 1.0], "a", 12.0, [0; 3]);
            let text = picture.to_tikz();
            ["\\draw", "\\fill", "circle", "\\node"].map(|word| text.matches(word).count())
        };
        assert_eq!(shapes(15_000.0), [1, 2, 1, 1]);
        assert_eq!(shapes(16_001.0), [0; 4]);
    }

    #[test]
    fn strokes_too_wide_or_with_too_long_dashes_for_tex_are_left_out() {
        let draws = |stroke: Stroke, count: usize| {
            let mut picture = VectorPicture::new([640, 480]);
            for y in 0..count {
                picture.add_lines([[[0.0, y as f64], [9.0, 1.0]]], stroke);
            }
            let text = picture.to_tikz();
            assert!(!text.contains("16001"), "{text}");
            text.matches("\\draw").count()
        };
        let narrow = Stroke::new(1.0, [0; 3]);
        // Several lines share their look in a scope.
        for count in [1, 3] {
            assert_eq!(draws(Stroke::new(16_000.0, [0; 3]), count), count);
            assert_eq!(draws(narrow.with_dashes(16_000.0, 1.0), count), count);
            assert_eq!(draws(Stroke::new(16_001.0, [0; 3]), count), 0);
            assert_eq!(draws(narrow.with_dashes(16_001.0, 1.0), count), 0);
            assert_eq!(draws(narrow.with_dashes(1.0, 16_001.0), count), 0);
        }
    }

    #[test]
    fn a_label_has_neither_a_background_nor_a_frame() {
        let mut picture = VectorPicture::new([640, 480]);
        let paint = Paint::from([1, 2, 3]).with_opacity(0.5);
        let stroke = Stroke::new(20_000.0, [4, 5, 6]);
        picture.group(&[("class", "title")], |picture| {
            picture.add_label([9.0, 9.0], "a", 12.0, paint.with_stroke(stroke));
        });
        let text = picture.to_tikz();
        let node = text.lines().find(|line| line.starts_with("\\node")).unwrap();
        let expected = "\\node[anchor=base,inner sep=0pt,text={rgb,255:red,1;green,2;blue,3},\
                        text opacity=0.5,font=\\fontsize{12bp}{12bp}\\selectfont,binspace/title/.try] at (";
        assert!(node.starts_with(expected) && node.ends_with(") {a};"), "{node}");
    }

    #[test]
    fn lines_are_short() {
        let mut picture = VectorPicture::new([640, 480]);
        let zigzag: Vec<[f64; 2]> = (0..15_000).map(|i| [f64::from(i % 7), f64::from(i)]).collect();
        picture.add_lines(vec![zigzag; 3], Stroke::new(1.0, [0; 3]));
        let ticks = (0..15_000).map(|i| [[f64::from(i), 0.0], [f64::from(i), 3.0]]);
        picture.add_lines(ticks, Stroke::new(1.0, [0; 3]));
        let text = picture.to_tikz();
        assert!(text.len() > 100_000, "{}", text.len());
        let longest = text.lines().map(str::len).max().unwrap();
        assert!(longest < 2_000, "{longest}");
    }
}
