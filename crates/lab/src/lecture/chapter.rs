//! The components of a chapter.

use std::fmt::Display;

use crate::chart::Chart;
use binspace_cli::failure::Failure;

/// A chapter of the lecture.
#[derive(Debug)]
pub(crate) struct Chapter {
    pub(super) title: &'static str,
    pub(super) parts: Vec<Part>,
}

/// A part of a chapter, from top to bottom.
#[derive(Debug)]
pub(super) enum Part {
    /// A heading.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// Pictures side by side, each with a caption.
    Pictures(Vec<Picture>),
    /// A graph, as SVG.
    Graph(String),
    /// A table: its head and its rows. Columns of numbers are aligned to the right.
    Table(Vec<String>, Vec<Vec<String>>),
}

/// Pixels with a caption.
#[derive(Debug)]
pub(crate) struct Picture {
    pub(super) size: [u32; 2],
    pub(super) rgb: Vec<u8>,
    pub(super) caption: String,
}

impl Picture {
    /// RGB pixels, row by row from the top left.
    pub(crate) fn new(size: [u32; 2], rgb: Vec<u8>, caption: impl Into<String>) -> Self {
        Self { size, rgb, caption: caption.into() }
    }
}

impl Chapter {
    /// An empty chapter.
    pub(super) fn new(title: &'static str) -> Self {
        Self { title, parts: vec![] }
    }

    /// Adds a heading within the chapter.
    pub(super) fn heading(&mut self, text: impl Into<String>) {
        self.parts.push(Part::Heading(text.into()));
    }

    /// Adds a paragraph.
    pub(super) fn text(&mut self, text: impl Into<String>) {
        self.parts.push(Part::Text(text.into()));
    }

    /// Adds pictures side by side.
    pub(super) fn pictures(&mut self, pictures: impl IntoIterator<Item = Picture>) {
        self.parts.push(Part::Pictures(pictures.into_iter().collect()));
    }

    /// Adds a graph.
    pub(super) fn graph(&mut self, chart: &Chart<'_>) -> Result<(), Failure> {
        self.parts.push(Part::Graph(chart.draw()?));
        Ok(())
    }

    /// Adds a drawing, as SVG.
    pub(super) fn svg(&mut self, svg: String) {
        self.parts.push(Part::Graph(svg));
    }

    /// Adds a table.
    pub(super) fn table<const N: usize>(
        &mut self,
        head: [&str; N],
        rows: impl IntoIterator<Item = [String; N]>,
    ) {
        let head = head.iter().map(ToString::to_string).collect();
        let rows = rows.into_iter().map(|row| row.map(|cell| cell.to_string()).to_vec());
        self.parts.push(Part::Table(head, rows.collect()));
    }
}

/// Converts any error to a failure of the lecture.
pub(super) fn failure(error: impl Display) -> Failure {
    Failure::about("the lecture", error)
}

/// Formats a share in percent: without decimals from 10 % and for 0, otherwise with two.
pub(super) fn percent(part: impl Into<f64>, whole: impl Into<f64>) -> impl Display {
    let share = 100.0 * part.into() / whole.into();
    format!("{share:.*} %", if share == 0.0 || share >= 10.0 { 0 } else { 2 })
}
