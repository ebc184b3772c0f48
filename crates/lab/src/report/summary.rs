//! All families together: one row per method.

use binspace_evidence::method::Space;

use super::figures::{EXACT, Row, Section, Subject};
use super::tables::{Table, exponent, grouped, share};
use binspace_cli::units::{bytes, time};

/// The methods of the headline: one of each kind.
const HEADLINE: [&str; 6] = [EXACT, "bsp f64 1e-9", "bsp f32 1e-4", "newell", "z 24", "centroid"];

/// The sum of a method's figures over all families.
pub(super) struct Summary<'a> {
    pub(super) method: &'a str,
    /// Families in which something is wrong.
    wrong_families: usize,
    wrong: usize,
    covered: usize,
    depth: f64,
    misplaced: Option<usize>,
    drift: Option<f64>,
    pieces: usize,
    /// The sum of the shares of faces that a step before the method leaves out.
    removed: f64,
    faces: usize,
    pub(super) ended: usize,
    failed: usize,
    /// The sums of the logarithms of build times, and of times for a picture.
    build: f64,
    picture: f64,
    bytes: usize,
    /// The space in which the method decides; `None` without trials.
    space: Option<Space>,
}

impl<'a> Summary<'a> {
    /// Returns a summary for each method, in order, over its finished trials; an empty list without families.
    pub(super) fn of_families(sections: &'a [Section]) -> Vec<Self> {
        Self::of_trials(sections, |_, _| true)
    }

    /// Returns the same sums over the trials that every method finished.
    fn of_common_trials(sections: &'a [Section]) -> Vec<Self> {
        Self::of_trials(sections, |family, row| {
            let mut same = family.rows.iter().filter(|other| other.difficulty == row.difficulty);
            same.all(|other| other.found.is_ok())
        })
    }

    fn of_trials(
        sections: &'a [Section],
        counts: impl Copy + Fn(&Section, &Row) -> bool,
    ) -> Vec<Self> {
        let families: Vec<&Section> = sections
            .iter()
            .filter(|section| matches!(section.subject, Subject::Family(_)))
            .collect();
        let methods = families.first().map_or(Vec::new(), |section| section.methods());
        methods.into_iter().map(|method| Self::of(method, &families, counts)).collect()
    }

    fn of(
        method: &'a str,
        families: &[&'a Section],
        counts: impl Fn(&Section, &Row) -> bool,
    ) -> Self {
        let mut summary = Self {
            method,
            wrong_families: 0,
            wrong: 0,
            covered: 0,
            depth: 0.0,
            misplaced: None,
            drift: None,
            pieces: 0,
            removed: 0.0,
            faces: 0,
            ended: 0,
            failed: 0,
            build: 0.0,
            picture: 0.0,
            bytes: 0,
            space: None,
        };
        for family in families {
            let before = summary.wrong;
            let rows = family.of(method).filter(|row| counts(family, row));
            rows.for_each(|row| summary.add(row));
            summary.wrong_families += usize::from(summary.wrong > before);
        }
        summary
    }

    fn add(&mut self, row: &Row) {
        self.space = Some(row.space);
        let Ok(figures) = &row.found else {
            self.failed += 1;
            return;
        };
        self.ended += 1;
        self.wrong += figures.picture.wrong();
        self.covered += figures.picture.covered;
        self.depth = self.depth.max(figures.picture.depth_max);
        if let (Some(accuracy), Some(drift)) = (figures.accuracy, figures.drift()) {
            *self.misplaced.get_or_insert(0) += accuracy.misplaced + accuracy.undefined;
            self.drift = Some(self.drift.unwrap_or(0.0).max(drift));
        }
        self.pieces += figures.pieces;
        self.removed += figures.removed;
        self.faces += row.faces;
        // The clock may not have advanced; the logarithm needs a positive time.
        self.build += figures.build.max(1e-9).ln();
        self.picture += (figures.order + figures.draw).max(1e-9).ln();
        self.bytes = self.bytes.max(figures.bytes);
    }

    /// Returns the method's name, and the number of finished trials if it gave up in others.
    pub(super) fn label(&self) -> String {
        label(self.method, self.ended, self.ended + self.failed)
    }

    /// The share of wrong pixels.
    pub(super) fn wrong_share(&self) -> f64 {
        self.wrong as f64 / self.covered.max(1) as f64
    }

    /// The seconds for a picture, order and drawing: the geometric mean over the finished trials.
    pub(super) fn time(&self) -> f64 {
        (self.picture / self.ended.max(1) as f64).exp()
    }

    fn build_time(&self) -> f64 {
        (self.build / self.ended.max(1) as f64).exp()
    }

    /// The mean share of faces that are left out as back faces; a dash if no face is left out.
    fn removed_share(&self) -> String {
        match self.removed / self.ended.max(1) as f64 {
            0.0 => "–".to_owned(),
            share => format!("{:.0} %", 100.0 * share),
        }
    }

    fn cells(&self) -> Vec<String> {
        let dash = || "–".to_owned();
        vec![
            self.method.to_owned(),
            share(self.wrong, self.covered),
            self.wrong_families.to_string(),
            exponent(self.depth),
            self.misplaced.map_or_else(dash, grouped),
            self.drift.map_or_else(dash, exponent),
            format!("{:.2}", self.pieces as f64 / self.faces.max(1) as f64),
            if self.misplaced.is_some() { time(self.build_time()) } else { dash() },
            time(self.time()),
            format!("{} of {}", self.ended, self.ended + self.failed),
        ]
    }
}

/// A method's name, and the number of finished trials if it did not finish all.
pub(super) fn label(method: &str, ended: usize, trials: usize) -> String {
    if ended == trials { method.to_owned() } else { format!("{method}, {ended} of {trials}") }
}

const COLUMNS: [&str; 10] = [
    "method",
    "wrong pixels",
    "families wrong",
    "deepest error",
    "vertices misplaced",
    "largest drift",
    "pieces / polygon",
    "build",
    "picture",
    "ended",
];

/// The table of six methods.
pub(super) fn headline(sections: &[Section]) -> Table {
    six(Summary::of_families(sections))
}

/// Returns the same table over the trials that every method finished; `None` if every method finished all
/// trials.
pub(super) fn in_common(sections: &[Section]) -> Option<Table> {
    let all = Summary::of_families(sections);
    all.iter().any(|summary| summary.failed > 0).then(|| six(Summary::of_common_trials(sections)))
}

fn six(summaries: Vec<Summary<'_>>) -> Table {
    let mut table = Table::new(&COLUMNS);
    for summary in summaries {
        if HEADLINE.contains(&summary.method) {
            table.push(summary.cells());
        }
    }
    table
}

/// The table of all methods.
pub(super) fn everything(sections: &[Section]) -> Table {
    let mut columns = COLUMNS.to_vec();
    columns.extend(["most memory", "removed by back faces", "decides in"]);
    let mut table = Table::new(&columns);
    for summary in Summary::of_families(sections) {
        let mut cells = summary.cells();
        cells.extend([
            bytes(summary.bytes),
            summary.removed_share(),
            summary.space.map_or_else(String::new, |space| space.to_string()),
        ]);
        table.push(cells);
    }
    table
}
