//! The lecture as one self-contained page.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::chapter::{Chapter, Part, Picture};
use binspace_cli::png_file;

const STYLE: &str = include_str!("lecture.css");

/// Writes the chapters as a page.
pub(crate) fn write(out: &mut dyn Write, chapters: &[Chapter]) -> io::Result<()> {
    write!(
        out,
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Visible surfaces</title>\n<style>\n{STYLE}</style>\n\
         <header>\n<h1>Visible surfaces</h1>\n\
         <p>The subjects of a course on visibility. One run of <code>binspace-lab lecture</code> made all \
         pictures and figures on this page, and judged them by exact arithmetic.</p>\n<nav><ol>\n",
    )?;
    for (number, chapter) in (1..).zip(chapters) {
        writeln!(out, "<li><a href=\"#c{number}\">{}</a>", escaped(chapter.title))?;
    }
    writeln!(out, "</ol></nav>\n</header>\n<main>")?;
    for (number, chapter) in (1..).zip(chapters) {
        writeln!(out, "<section id=\"c{number}\">\n<h2>{}</h2>", escaped(chapter.title))?;
        chapter.parts.iter().try_for_each(|part| write_part(out, part))?;
        writeln!(out, "</section>")?;
    }
    writeln!(out, "</main>\n</html>")
}

fn write_part(out: &mut dyn Write, part: &Part) -> io::Result<()> {
    match part {
        Part::Heading(text) => writeln!(out, "<h3>{}</h3>", readable(text)),
        Part::Text(text) => writeln!(out, "<p>{}</p>", readable(text)),
        Part::Pictures(pictures) => {
            // Three large pictures fill a row, so a fourth would be alone.
            let is_large = pictures.iter().all(|picture| picture.size[0] > 240);
            let is_pairs = pictures.len() == 4 && is_large;
            let class = if is_pairs { "pictures pairs" } else { "pictures" };
            writeln!(out, "<div class=\"{class}\">")?;
            pictures.iter().try_for_each(|picture| write_picture(out, picture))?;
            writeln!(out, "</div>")
        }
        Part::Graph(svg) => writeln!(out, "<figure class=\"graph\">{svg}</figure>"),
        Part::Table(head, rows) => write_table(out, head, rows),
    }
}

fn write_picture(out: &mut dyn Write, picture: &Picture) -> io::Result<()> {
    let Picture { size, rgb, caption } = picture;
    let mut png = Vec::new();
    png_file::write(&mut png, *size, rgb)?;
    let ([width, height], alt, caption) = (size, escaped(caption), readable(caption));
    writeln!(
        out,
        "<figure style=\"width: {width}px\"><img width=\"{width}\" height=\"{height}\" alt=\"{alt}\" \
         src=\"data:image/png;base64,{}\"><figcaption>{caption}</figcaption></figure>",
        STANDARD.encode(png),
    )
}

fn write_table(out: &mut dyn Write, head: &[String], rows: &[Vec<String>]) -> io::Result<()> {
    write!(out, "<div class=\"table\"><table>\n<tr>")?;
    let is_number = |column: usize| {
        let mut cells = rows.iter().filter_map(|row| row.get(column));
        cells.all(|cell| {
            cell.starts_with(|c: char| c.is_ascii_digit()) || ["-", "none"].contains(&&**cell)
        })
    };
    let class = |column| if is_number(column) { " class=\"number\"" } else { "" };
    let classes: Vec<&str> = (0..head.len()).map(class).collect();
    for (cell, class) in head.iter().zip(&classes) {
        write!(out, "<th{class}>{}", escaped(cell))?;
    }
    writeln!(out)?;
    for row in rows {
        write!(out, "<tr>")?;
        for (cell, class) in row.iter().zip(&classes) {
            write!(out, "<td{class}>{}", readable(cell))?;
        }
        writeln!(out)?;
    }
    writeln!(out, "</table></div>")
}

/// Converts a text to HTML: groups the digits of whole numbers of five digits or more, and marks text between
/// backticks as code.
fn readable(text: &str) -> String {
    let parts = escaped(text);
    let parts = parts.split('`').zip([false, true].into_iter().cycle());
    let part = |(part, is_command): (&str, bool)| match is_command {
        true => format!("<code>{part}</code>"),
        false => grouped(part),
    };
    parts.map(part).collect()
}

fn grouped(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, from) = rest.split_at(start);
        let end = from.find(|c: char| !c.is_ascii_digit()).unwrap_or(from.len());
        let (digits, after) = from.split_at(end);
        result.push_str(before);
        // Digits after a decimal point, and digits in names, are not grouped.
        let is_whole = digits.len() > 4
            && !result.ends_with(|c: char| c == '.' || c == ':' || c.is_alphabetic());
        for (k, digit) in digits.chars().enumerate() {
            if is_whole && k > 0 && (digits.len() - k).is_multiple_of(3) {
                result.push('\u{202f}');
            }
            result.push(digit);
        }
        rest = after;
    }
    result + rest
}

/// Escapes a text for HTML contents and quoted attributes.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::readable;

    #[test]
    fn large_numbers_are_in_groups_and_commands_as_they_are() {
        let narrow = '\u{202f}';
        assert_eq!(
            readable("12345 of 1234567"),
            format!("12{narrow}345 of 1{narrow}234{narrow}567")
        );
        let same = ["1980", "0.123456", "city:260000", "x12345"];
        assert_eq!(same.map(readable), same);
        assert_eq!(readable("type `a 12345 < b`."), "type <code>a 12345 &lt; b</code>.");
    }
}
