//! The plots and their content.

use binspace_evidence::Family;

use super::figures::{EXACT, Section};
use super::growth::{Growth, Size};
use super::summary::{Summary, label};
use crate::chart::{Chart, Marker, Series, Style};
use binspace_cli::failure::Failure;

/// The methods in the plots, with their styles: trees are round and blue, depth buffers have corners and warm
/// colours. More methods would not be distinguishable. Earlier methods are drawn later, and smaller than the
/// markers that they may hide.
const SHOWN: [(&str, Style); 12] = [
    (EXACT, Style::new([0, 0, 0], Marker::Ring, 8)),
    ("bsp f64 1e-12", Style::new([0, 60, 160], Marker::Circle, 3)),
    ("bsp f64 1e-9", Style::new([30, 130, 220], Marker::Circle, 4)),
    ("bsp f64 1e-6", Style::new([90, 190, 240], Marker::Circle, 5)),
    ("bsp f32 1e-4", Style::new([120, 70, 200], Marker::Circle, 6)),
    ("newell", Style::new([0, 140, 90], Marker::Diamond, 7)),
    // The arms of the cross remain visible if its middle is hidden.
    ("centroid", Style::new([130, 130, 130], Marker::Cross, 8)),
    ("z 16", Style::new([150, 80, 20], Marker::Square, 3)),
    ("z 24", Style::new([215, 60, 20], Marker::Square, 5)),
    ("z f32", Style::new([245, 150, 30], Marker::Triangle, 4)),
    ("z f32 reversed", Style::new([205, 175, 0], Marker::Triangle, 5)),
    ("w f32", Style::new([215, 80, 150], Marker::Triangle, 6)),
];

/// Wrong pixels against the time for a picture, one point per method; `None` without families.
pub(super) fn speed(sections: &[Section]) -> Result<Option<String>, Failure> {
    let summaries = Summary::of_families(sections);
    let series: Vec<Series> = SHOWN
        .iter()
        .filter_map(|&(name, style)| {
            let summary = summaries.iter().find(|summary| summary.method == name)?;
            let point = (summary.time(), summary.wrong_share());
            (summary.ended > 0)
                .then(|| Series::new(&summary.label(), style, vec![point]).without_line())
        })
        .collect();
    if series.is_empty() {
        return Ok(None);
    }
    let chart = Chart {
        title: "Speed against error, over all families",
        x_label: "time for a picture: order and drawing [s], geometric mean",
        y_label: "wrong pixels / covered pixels",
        ticks: None,
        falls: false,
        zero: true,
        series,
    };
    chart.draw().map(Some)
}

/// Wrong pixels against the difficulty of a family.
pub(super) fn against_difficulty(section: &Section, family: Family) -> Result<String, Failure> {
    let series = SHOWN.iter().filter_map(|&(name, style)| {
        let points: Vec<(f64, f64)> = section
            .of(name)
            .filter_map(|row| {
                let figures = row.found.as_ref().ok()?;
                Some((row.difficulty?, figures.picture.wrong_share()))
            })
            .collect();
        let name = label(name, points.len(), section.of(name).count());
        (!points.is_empty()).then(|| Series::new(&name, style, points))
    });
    let sweep = section.of(EXACT).filter_map(|row| row.difficulty).collect::<Vec<f64>>();
    let title = format!("{family}: error against difficulty");
    let chart = Chart {
        title: &title,
        x_label: family.parameter(),
        y_label: "wrong pixels / covered pixels",
        // A short axis of small numbers shows every value.
        falls: sweep.first() > sweep.last(),
        ticks: sweep.iter().all(|&d| (1.0..1000.0).contains(&d)).then_some(sweep),
        zero: true,
        series: series.collect(),
    };
    chart.draw()
}

/// Build time against the number of polygons.
pub(super) fn growth_build(rows: &[Growth]) -> Result<String, Failure> {
    growth(rows, "Time to build a tree", "build [s]", false, |size, _| size.build)
}

/// Fragments per polygon minus 1, against the number of polygons. An unsplit polygon is one fragment, so the
/// difference counts the fragments that splits add.
pub(super) fn growth_fragments(rows: &[Growth]) -> Result<String, Failure> {
    let title = "Fragments per polygon that splits add";
    growth(rows, title, "fragments / polygons − 1", true, |size, polygons| {
        size.fragments as f64 / polygons as f64 - 1.0
    })
}

/// The colours of scenes, in order; more would not be distinguishable.
const COLOURS: [[u8; 3]; 9] = [
    [0, 140, 90],
    [30, 110, 220],
    [215, 60, 20],
    [150, 80, 180],
    [200, 150, 0],
    [0, 0, 0],
    [215, 80, 150],
    [120, 120, 120],
    [110, 70, 30],
];

/// The names of the scenes, each once.
fn scenes(rows: &[Growth]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&row.scene.as_str()) {
            names.push(&row.scene);
        }
    }
    names
}

fn growth(
    rows: &[Growth],
    title: &str,
    y_label: &str,
    zero: bool,
    value: impl Fn(&Size, usize) -> f64,
) -> Result<String, Failure> {
    let mut series = Vec::new();
    for (number, scene) in scenes(rows).into_iter().enumerate() {
        let colour = COLOURS[number % COLOURS.len()];
        // Where both values are equal, the small marker is within the large one.
        for (is_exact, marker, reach) in [(true, Marker::Ring, 7), (false, Marker::Cross, 3)] {
            let of_it = |row: &&Growth| row.scene == scene && (row.method == EXACT) == is_exact;
            let points: Vec<(f64, f64)> = rows
                .iter()
                .filter(of_it)
                .filter_map(|row| {
                    let size = row.found.as_ref().ok()?;
                    Some((row.polygons as f64, value(size, row.polygons)))
                })
                .collect();
            if let Some(row) = rows.iter().find(of_it).filter(|_| !points.is_empty()) {
                let method = row.method.trim_start_matches("bsp ");
                let name = format!("{scene}, {method}");
                series.push(Series::new(&name, Style::new(colour, marker, reach), points));
            }
        }
    }
    let chart =
        Chart { title, x_label: "polygons", y_label, ticks: None, falls: false, zero, series };
    chart.draw()
}
