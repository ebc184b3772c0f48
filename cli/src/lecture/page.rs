//! The lecture as one page that stands alone.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::chapter::{Chapter, Part, Picture};
use crate::png_file;

const STYLE: &str = include_str!("lecture.css");

/// Writes the chapters as a page.
pub(crate) fn write(out: &mut dyn Write, chapters: &[Chapter]) -> io::Result<()> {
    write!(
        out,
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Visible surfaces</title>\n<style>\n{STYLE}</style>\n\
         <header>\n<h1>Visible surfaces</h1>\n\
         <p>What a course on visibility teaches. Every picture and every figure on this page was made by \
         one run of <code>binspace lecture</code>, and judged against exact arithmetic.</p>\n<nav><ol>\n",
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
        Part::Heading(text) => writeln!(out, "<h3>{}</h3>", escaped(text)),
        Part::Text(text) => writeln!(out, "<p>{}</p>", escaped(text)),
        Part::Pictures(pictures) => {
            writeln!(out, "<div class=\"pictures\">")?;
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
    let ([width, height], caption) = (size, escaped(caption));
    writeln!(
        out,
        "<figure><img width=\"{width}\" height=\"{height}\" alt=\"{caption}\" \
         src=\"data:image/png;base64,{}\"><figcaption>{caption}</figcaption></figure>",
        STANDARD.encode(png),
    )
}

fn write_table(out: &mut dyn Write, head: &[String], rows: &[Vec<String>]) -> io::Result<()> {
    write!(out, "<div class=\"table\"><table>\n<tr>")?;
    head.iter().try_for_each(|cell| write!(out, "<th>{}", escaped(cell)))?;
    writeln!(out)?;
    for row in rows {
        write!(out, "<tr>")?;
        for cell in row {
            let is_number = cell.starts_with(|c: char| c.is_ascii_digit());
            let class = if is_number { " class=\"number\"" } else { "" };
            write!(out, "<td{class}>{}", escaped(cell))?;
        }
        writeln!(out)?;
    }
    writeln!(out, "</table></div>")
}

/// A text in HTML, in its contents or in quotes.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
