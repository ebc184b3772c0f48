//! The raw figures.

use std::fmt::Display;
use std::fmt::Write;

use super::figures::{Row, Section};
use super::growth::Growth;

/// Errors: the same for the same seed, on any machine. Empty where a figure does not exist.
pub(super) fn errors(sections: &[Section]) -> String {
    let head = "subject,difficulty,method,faces,views,covered,wrong,wrong_order,holes,spills,\
                contested,depth_max_extents,depth_mean_extents,vertices,misplaced_vertices,\
                undefined_vertices,torn_faces,drift_max_ulps,drift_mean_ulps,drift_max_extents,\
                area_error_worst,area_error_total,pieces,failure\n";
    each_row(head, sections, |row| match &row.found {
        Err(failure) => format!("{}{}", ",".repeat(18), quoted(failure)),
        Ok(figures) => {
            let (p, a) = (&figures.picture, figures.accuracy);
            let pixels = [p.covered, p.wrong(), p.wrong_order, p.holes, p.spills, p.contested];
            let mut cells: Vec<String> = pixels.iter().map(usize::to_string).collect();
            cells.extend([p.depth_max, p.depth_mean].map(number));
            cells.extend([
                optional(a.map(|a| a.vertices)),
                optional(a.map(|a| a.misplaced)),
                optional(a.map(|a| a.undefined)),
                optional(a.map(|a| a.torn)),
                optional(a.map(|a| number(a.drift_max))),
                optional(a.map(|a| number(a.drift_mean))),
                optional(figures.drift().map(number)),
                optional(figures.area.map(|a| number(a.worst))),
                optional(figures.area.map(|a| number(a.total))),
                figures.pieces.to_string(),
                String::new(),
            ]);
            cells.join(",")
        }
    })
}

/// Times and memory, which are the machine's.
pub(super) fn times(sections: &[Section]) -> String {
    let head = "subject,difficulty,method,faces,views,build_seconds,order_seconds_per_view,\
                draw_seconds_per_view,bytes\n";
    each_row(head, sections, |row| match &row.found {
        Err(_) => ",,,".to_owned(),
        Ok(f) => {
            format!("{},{},{},{}", number(f.build), number(f.order), number(f.draw), f.bytes)
        }
    })
}

/// Growth with the number of polygons.
pub(super) fn growth(rows: &[Growth]) -> String {
    let mut text = "scene,polygons,method,fragments,depth,bytes,build_seconds,\
                    order_seconds,failure\n"
        .to_owned();
    for row in rows {
        let (scene, method) = (quoted(row.scene.name()), quoted(row.method));
        let cells = match &row.found {
            Ok(f) => format!(
                "{},{},{},{},{},",
                f.fragments,
                f.depth,
                f.bytes,
                number(f.build),
                number(f.order)
            ),
            Err(failure) => format!(",,,,,{}", quoted(failure)),
        };
        let _ = writeln!(text, "{scene},{},{method},{cells}", row.polygons);
    }
    text
}

fn each_row(head: &str, sections: &[Section], cells: impl Fn(&Row) -> String) -> String {
    let mut text = head.to_owned();
    for section in sections {
        for row in &section.rows {
            let difficulty = row.difficulty.map_or(String::new(), number);
            let (subject, method) = (quoted(section.subject.name()), quoted(&row.method));
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "{subject},{difficulty},{method},{},{},{}",
                row.faces,
                row.views,
                cells(row)
            );
        }
    }
    text
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:e}") }
}

fn optional(value: Option<impl Display>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::{errors, quoted, times};
    use crate::commands::report::figures::{Row, Section, Subject};

    #[test]
    fn cells_that_hold_commas_are_quoted() {
        assert_eq!(quoted("bsp f64 1e-6"), "bsp f64 1e-6");
        assert_eq!(
            quoted("more than 2 pieces, \"raise\" it"),
            "\"more than 2 pieces, \"\"raise\"\" it\""
        );
    }

    #[test]
    fn a_failure_fills_as_many_columns_as_figures() {
        let mut section = Section::new(Subject::Scene("a,b".into()));
        let found = Err("over budget".into());
        section.rows.push(Row {
            difficulty: None,
            faces: 1,
            views: 2,
            method: "newell".into(),
            found,
        });
        for text in [errors(std::slice::from_ref(&section)), times(&[section])] {
            let columns = text.lines().next().unwrap().split(',').count();
            for line in text.lines().skip(1) {
                assert_eq!(line.replace("\"a,b\"", "ab").split(',').count(), columns, "{text}");
            }
        }
    }
}
