//! Vector pictures as TikZ, for LaTeX: a big point for each pixel.

use std::fmt::{self, Write};

use super::picture::{Line, Paint, PaintedShape, Shape, Steps, Stroke, VectorPicture, units};
use super::svg::{Look, Written, write_nodes};

/// TeX has no length beyond 16 383.99 of its points; a coordinate beyond this, in big points, is an error.
const FURTHEST: f64 = 16_000.0;

/// Of a file that is compiled alone, the beginning.
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
    /// The picture as TikZ, in a LaTeX file that compiles by itself. `\input` puts the picture into a document
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
    /// A pixel is a big point, 1/72 inch. Each word of the `class` of a [group](Self::group) is a style that
    /// the document may define, for example `\tikzset{binspace/axis/.style={draw=red}}`; it overrides the
    /// colours and lines of the group. Words of other characters than letters, digits and hyphens, and other
    /// attributes, are left out. Labels are in the document's font, which must have their characters, and
    /// strokes of labels are left out. So is a shape that reaches further than 16 000 pixels, as TeX has no
    /// such length.
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
                write_options(out, look, attributes)?;
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
    let is_label = matches!(shape, Shape::Label { .. });
    if !fits(shape, units) || is_label && paint.fill.is_none() {
        return Ok(());
    }
    let command = match (paint.fill, paint.stroke) {
        _ if is_label => "\\node",
        (Some(_), Some(_)) => "\\filldraw",
        (Some(_), None) => "\\fill",
        (None, _) => "\\draw",
    };
    write!(out, "{command}")?;
    write_options(out, look.map(|(_, font)| (paint, font)), attributes)?;
    match shape {
        Shape::Path(Steps { lines, decimals }) => {
            let steps = f64::from(units) * 10f64.powi(*decimals as i32);
            for Line { corners, is_closed } in lines {
                for (i, corner) in corners.iter().enumerate() {
                    let [x, y] = corner.map(|c| short(c as f64 / steps));
                    write!(out, "{}({x},{y})", if i == 0 { " " } else { "--" })?;
                }
                write!(out, "{}", if *is_closed { "--cycle" } else { "" })?;
            }
        }
        Shape::Marker { at, radius } => {
            let [x, y] = at.map(|c| short(c as f64 / f64::from(units)));
            write!(out, " ({x},{y}) circle[radius={}bp]", short(*radius))?;
        }
        Shape::Label { at, size, text } => {
            let [x, y] = at.map(|c| short(c as f64 / f64::from(units)));
            let (size, colour) = (short(*size), rgb(paint.fill.unwrap_or_default()));
            write!(
                out,
                "[anchor=base,inner sep=0pt,text={colour},text opacity={},\
                 font=\\fontsize{{{size}bp}}{{{size}bp}}\\selectfont] at ({x},{y}) {{{}}}",
                paint.opacity,
                escaped(text),
            )?;
        }
    }
    writeln!(out, ";")
}

/// Whether TeX has all lengths of a shape.
fn fits(shape: &Shape, units: u32) -> bool {
    let is_near = |point: &[i64; 2], decimals: u32| {
        let most = FURTHEST * f64::from(units) * 10f64.powi(decimals as i32);
        point.iter().all(|c| c.unsigned_abs() as f64 <= most)
    };
    match shape {
        Shape::Path(Steps { lines, decimals }) => {
            lines.iter().flat_map(|line| &line.corners).all(|corner| is_near(corner, *decimals))
        }
        Shape::Marker { at, radius: length } | Shape::Label { at, size: length, .. } => {
            is_near(at, 0) && *length <= FURTHEST
        }
    }
}

/// The look of a scope or a shape, and the styles of its classes, which override it.
fn write_options(out: &mut String, look: Option<Look>, attributes: &str) -> fmt::Result {
    let mut options: Vec<String> = Vec::new();
    if let Some((Paint { fill, opacity, stroke }, _)) = look {
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
    }
    // Other attributes have no such characters: quotation marks in their values are escaped.
    let classes = attributes.split_once(" class=\"").and_then(|(_, rest)| rest.split_once('"'));
    let is_plain = |word: &&str| word.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
    let words = classes.map_or("", |(classes, _)| classes).split_whitespace().filter(is_plain);
    options.extend(words.map(|word| format!("binspace/{word}/.try")));
    if options.is_empty() { Ok(()) } else { write!(out, "[{}]", options.join(",")) }
}

/// A length in big points, without decimals that TeX does not have.
fn short(length: f64) -> f64 {
    (length * 1e4).round() / 1e4 + 0.0
}

fn rgb([r, g, b]: [u8; 3]) -> String {
    format!("{{rgb,255:red,{r};green,{g};blue,{b}}}")
}

/// A text without characters that are commands of TeX.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\\' => escaped += "\\textbackslash{}",
            '^' => escaped += "\\textasciicircum{}",
            '~' => escaped += "\\textasciitilde{}",
            '{' | '}' | '$' | '&' | '#' | '%' | '_' => escaped.extend(['\\', c]),
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
    }

    #[test]
    fn classes_become_styles() {
        let options = |attributes: &str| {
            let mut out = String::new();
            write_options(&mut out, None, attributes).unwrap();
            out
        };
        assert_eq!(options(""), "");
        assert_eq!(options(" data-a=\"b\""), "");
        let hidden = " id=\"x\" class=\"hidden layers-2 a,b\" data-a=\"b\"";
        assert_eq!(options(hidden), "[binspace/hidden/.try,binspace/layers-2/.try]");
    }

    #[test]
    fn what_reaches_too_far_for_tex_is_left_out() {
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
}
