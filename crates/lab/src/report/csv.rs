//! The raw figures, as comma-separated values. Cells are empty where a figure does not exist.

use serde::Serialize;

use super::figures::{Figures, Row, Section};
use super::growth::Growth;
use binspace_cli::failure::Failure;

/// The errors of a method on a scene: identical for the same seed, on any machine.
#[derive(Default, Serialize)]
struct Errors<'a> {
    subject: &'a str,
    difficulty: Option<String>,
    method: &'a str,
    faces: usize,
    views: usize,
    covered: Option<usize>,
    wrong: Option<usize>,
    wrong_order: Option<usize>,
    holes: Option<usize>,
    spills: Option<usize>,
    contested: Option<usize>,
    depth_max_extents: Option<String>,
    depth_mean_extents: Option<String>,
    vertices: Option<usize>,
    misplaced_vertices: Option<usize>,
    undefined_vertices: Option<usize>,
    torn_faces: Option<usize>,
    drift_max_ulps: Option<String>,
    drift_mean_ulps: Option<String>,
    drift_max_extents: Option<String>,
    area_error_worst: Option<String>,
    area_error_total: Option<String>,
    pieces: Option<usize>,
    removed_share: Option<String>,
    decides_in: String,
    failure: Option<&'a str>,
}

/// The times and the memory of a method on a scene, which depend on the machine.
#[derive(Serialize)]
struct Times<'a> {
    subject: &'a str,
    difficulty: Option<String>,
    method: &'a str,
    faces: usize,
    views: usize,
    build_seconds: Option<String>,
    order_seconds_per_view: Option<String>,
    draw_seconds_per_view: Option<String>,
    bytes: Option<usize>,
}

/// A tree of one size.
#[derive(Serialize)]
struct Size<'a> {
    scene: &'a str,
    polygons: usize,
    method: &'a str,
    fragments: Option<usize>,
    depth: Option<usize>,
    bytes: Option<usize>,
    build_seconds: Option<String>,
    order_seconds: Option<String>,
    failure: Option<&'a str>,
}

/// The errors of all methods on all scenes.
pub(super) fn errors(sections: &[Section]) -> Result<String, Failure> {
    table(each_row(sections).map(|(subject, row)| {
        let known = Errors {
            subject,
            difficulty: row.difficulty.map(number),
            method: &row.method,
            decides_in: row.space.to_string(),
            faces: row.faces,
            views: row.views,
            ..Errors::default()
        };
        match &row.found {
            Ok(figures) => known.with(figures),
            Err(failure) => Errors { failure: Some(failure), ..known },
        }
    }))
}

impl Errors<'_> {
    fn with(self, figures: &Figures) -> Self {
        let (picture, accuracy, area) = (&figures.picture, figures.accuracy, figures.area);
        Self {
            covered: Some(picture.covered),
            wrong: Some(picture.wrong()),
            wrong_order: Some(picture.wrong_order),
            holes: Some(picture.holes),
            spills: Some(picture.spills),
            contested: Some(picture.contested),
            depth_max_extents: Some(number(picture.depth_max)),
            depth_mean_extents: Some(number(picture.depth_mean)),
            vertices: accuracy.map(|a| a.vertices),
            misplaced_vertices: accuracy.map(|a| a.misplaced),
            undefined_vertices: accuracy.map(|a| a.undefined),
            torn_faces: accuracy.map(|a| a.torn),
            drift_max_ulps: accuracy.map(|a| number(a.drift_max)),
            drift_mean_ulps: accuracy.map(|a| number(a.drift_mean)),
            drift_max_extents: figures.drift().map(number),
            area_error_worst: area.map(|area| number(area.worst)),
            area_error_total: area.map(|area| number(area.total)),
            pieces: Some(figures.pieces),
            removed_share: Some(number(figures.removed)),
            ..self
        }
    }
}

/// The times of all methods on all scenes.
pub(super) fn times(sections: &[Section]) -> Result<String, Failure> {
    table(each_row(sections).map(|(subject, row)| {
        let figures = row.found.as_ref().ok();
        Times {
            subject,
            difficulty: row.difficulty.map(number),
            method: &row.method,
            faces: row.faces,
            views: row.views,
            build_seconds: figures.map(|f| number(f.build)),
            order_seconds_per_view: figures.map(|f| number(f.order)),
            draw_seconds_per_view: figures.map(|f| number(f.draw)),
            bytes: figures.map(|f| f.bytes),
        }
    }))
}

/// The growth of trees with the number of polygons.
pub(super) fn growth(rows: &[Growth]) -> Result<String, Failure> {
    table(rows.iter().map(|row| {
        let size = row.found.as_ref().ok();
        Size {
            scene: &row.scene,
            polygons: row.polygons,
            method: row.method,
            fragments: size.map(|s| s.fragments),
            depth: size.map(|s| s.depth),
            bytes: size.map(|s| s.bytes),
            build_seconds: size.map(|s| number(s.build)),
            order_seconds: size.map(|s| number(s.order)),
            failure: row.found.as_ref().err().map(String::as_str),
        }
    }))
}

/// All rows with their subjects.
fn each_row(sections: &[Section]) -> impl Iterator<Item = (&str, &Row)> {
    sections
        .iter()
        .flat_map(|section| section.rows.iter().map(move |row| (section.subject.name(), row)))
}

/// The titles, which are the names of the fields, and the rows.
fn table(rows: impl Iterator<Item = impl Serialize>) -> Result<String, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(unwritten)?;
    }
    let bytes = writer.into_inner().map_err(|error| unwritten(error.into_error()))?;
    String::from_utf8(bytes).map_err(unwritten)
}

fn unwritten(error: impl std::fmt::Display) -> Failure {
    Failure::about("the report's figures cannot be written", error)
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::{errors, times};
    use crate::report::figures::{Row, Section, Subject};
    use binspace_evidence::method::Space;

    #[test]
    fn a_failure_fills_as_many_columns_as_figures() {
        let mut section = Section::new(Subject::Scene("a,b".into()));
        let failure = "more than 2 pieces, \"raise\" it";
        section.rows.push(Row {
            difficulty: Some(-0.0),
            faces: 1,
            views: 2,
            method: "newell".into(),
            space: Space::Both,
            found: Err(failure.into()),
        });
        let sections = [section];
        for text in [errors(&sections), times(&sections)].map(Result::unwrap) {
            let mut reader = csv::Reader::from_reader(text.as_bytes());
            let columns = reader.headers().unwrap().len();
            let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
            assert_eq!((rows.len(), rows[0].len()), (1, columns), "{text}");
            let cells = [0, 1, 2, 3, 4].map(|k| &rows[0][k]);
            assert_eq!(cells, ["a,b", "0", "newell", "1", "2"]);
        }
        assert!(errors(&sections).unwrap().contains("pieces, \"\"raise\"\" it\"\n"));
    }

    #[test]
    fn numbers_are_written_as_powers_of_ten() {
        let texts = [0.0, -0.0, 1e-3, 42.0, 0.1].map(super::number);
        assert_eq!(texts, ["0", "0", "1e-3", "4.2e1", "1e-1"]);
    }
}
