//! Tables, as Markdown and as plain text.

use tabled::builder::Builder;
use tabled::grid::config::Offset;
use tabled::settings::formatting::AlignmentStrategy;
use tabled::settings::object::{Columns, Object, Rows};
use tabled::settings::style::LineChar;
use tabled::settings::{Alignment, Padding, Style};

use super::figures::{Figures, Row, Section};
use binspace_cli::units::{bytes, time};

/// A table of text: a column of names, and columns of figures to the right of this column.
pub(super) struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(super) fn new(columns: &[impl AsRef<str>]) -> Self {
        let columns = columns.iter().map(|column| column.as_ref().to_owned()).collect();
        Self { columns, rows: Vec::new() }
    }

    pub(super) fn push(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }

    /// Aligns names to the left and figures to the right.
    fn aligned(&self, titles: Vec<String>, cell: impl Fn(&String) -> String) -> tabled::Table {
        let rows = self.rows.iter().map(|row| row.iter().map(&cell).collect::<Vec<_>>());
        let mut builder = Builder::from_iter(rows);
        builder.insert_record(0, titles);
        let mut table = builder.build();
        table.with(Alignment::right()).modify(Columns::first(), Alignment::left());
        table
    }

    /// Returns the table as Markdown.
    pub(super) fn markdown(&self) -> String {
        let mut table = self.aligned(self.columns.clone(), |cell| escaped(cell));
        // In the rule above the first row.
        let colon = LineChar::horizontal(':', Offset::End(0));
        table.with(Style::markdown()).modify(Rows::new(1..2).intersect(Columns::new(1..)), colon);
        format!("{table}\n")
    }

    /// Returns the table as columns for a terminal, with one word of a title per line.
    pub(super) fn plain(&self) -> String {
        // A slash stays with the word before it.
        let title = |title: &String| title.replace(" / ", "/ ").replace(' ', "\n");
        let mut table = self.aligned(self.columns.iter().map(title).collect(), String::clone);
        table
            .with(Style::empty())
            .with(AlignmentStrategy::PerLine)
            .with(Padding::new(2, 0, 0, 0))
            .modify(Columns::first(), Padding::zero())
            .modify(Rows::first(), Alignment::bottom());
        table.to_string().lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
    }
}

/// Escapes a text for one line of Markdown.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        if r"\`*_[]<>&|~#$".contains(c) {
            escaped.push('\\');
        }
        escaped.push(if c.is_control() { ' ' } else { c });
    }
    escaped
}

/// Wrong pixels at each step: a row per method, a column per step.
pub(super) fn steps(section: &Section, methods: &[&str]) -> Table {
    let first = methods.first().copied().unwrap_or_default();
    let mut columns = vec!["wrong pixels".to_owned()];
    columns.extend(section.of(first).filter_map(|row| row.difficulty).map(difficulty));
    let mut table = Table::new(&columns);
    for method in methods {
        let cell = |row: &Row| match &row.found {
            Ok(figures) => share(figures.picture.wrong(), figures.picture.covered),
            Err(_) => "gave up".to_owned(),
        };
        let mut cells = vec![(*method).to_owned()];
        cells.extend(section.of(method).map(cell));
        table.push(cells);
    }
    table
}

/// All figures of each method's last row, which is the hardest step of a sweep.
pub(super) fn details(section: &Section, methods: &[&str]) -> Table {
    let mut table = Table::new(&[
        "method",
        "wrong order",
        "holes",
        "spills",
        "contested",
        "deepest error",
        "vertices misplaced",
        "drift [ulp]",
        "drift [extent]",
        "torn",
        "area error",
        "pieces",
        "build",
        "order",
        "draw",
        "memory",
    ]);
    for method in methods {
        let mut cells = vec![(*method).to_owned()];
        match section.of(method).last().map(|row| &row.found) {
            Some(Ok(figures)) => cells.extend(detail(figures)),
            Some(Err(failure)) => {
                cells.push(format!("gave up: {failure}"));
                cells.extend(vec![String::new(); 14]);
            }
            None => continue,
        }
        table.push(cells);
    }
    table
}

fn detail(figures: &Figures) -> Vec<String> {
    let dash = || "–".to_owned();
    let picture = &figures.picture;
    let counts = [picture.wrong_order, picture.holes, picture.spills, picture.contested];
    let mut cells: Vec<String> = counts.map(grouped).to_vec();
    cells.extend([
        exponent(picture.depth_max),
        figures.accuracy.map_or_else(dash, |a| grouped(a.misplaced + a.undefined)),
        figures.accuracy.map_or_else(dash, |a| exponent(a.drift_max)),
        figures.drift().map_or_else(dash, exponent),
        figures.accuracy.map_or_else(dash, |a| grouped(a.torn)),
        figures.area.map_or_else(dash, |area| exponent(area.worst)),
        grouped(figures.pieces),
        time(figures.build),
        if figures.order > 0.0 { time(figures.order) } else { dash() },
        time(figures.draw),
        bytes(figures.bytes),
    ]);
    cells
}

/// Formats a difficulty: counts below 100 000 in full, others in scientific notation.
pub(super) fn difficulty(value: f64) -> String {
    if (1.0..100_000.0).contains(&value) { grouped(value as usize) } else { format!("{value:e}") }
}

/// Formats a share in percent; "0" only if it is 0.
pub(super) fn share(part: usize, whole: usize) -> String {
    let percent = 100.0 * part as f64 / whole.max(1) as f64;
    match percent {
        _ if part == 0 => "0".to_owned(),
        p if p >= 9.95 => format!("{p:.0} %"),
        p if p >= 0.0995 => format!("{p:.1} %"),
        p => format!("{} %", exponent(p)),
    }
}

/// Formats a number with one or two digits and a power of ten; "0" only if it is 0.
pub(super) fn exponent(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        v if v.is_infinite() => "∞".to_owned(),
        v if (0.095..9.95).contains(&v) => format!("{v:.1}"),
        v => format!("{v:.0e}"),
    }
}

/// Formats a count in groups of three digits.
pub(super) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Table, difficulty, exponent, grouped, share};

    #[test]
    fn nothing_but_zero_is_written_as_zero() {
        assert_eq!([0.0, 1e-17, 0.21, 2e13].map(exponent), ["0", "1e-17", "0.2", "2e13"]);
        assert_eq!([0, 1, 1234].map(|n| share(n, 1_000_000)), ["0", "1e-4 %", "0.1 %"]);
        assert_eq!(share(5, 10), "50 %");
        assert_eq!([7, 1234, 12345, 1_234_567].map(grouped), ["7", "1234", "12 345", "1 234 567"]);
        assert_eq!([1e-3, 10_000.0, 1e9].map(difficulty), ["1e-3", "10 000", "1e9"]);
    }

    #[test]
    fn a_table_is_written_in_two_ways() {
        let mut table = Table::new(&["method", "wrong pixels", "pieces / polygon"]);
        table.push(vec!["bsp".into(), "0".into(), "1".into()]);
        let markdown = "\
            | method | wrong pixels | pieces / polygon |\n\
            |--------|-------------:|-----------------:|\n\
            | bsp    |            0 |                1 |\n";
        assert_eq!(table.markdown(), markdown);
        let plain = "         wrong  pieces/\nmethod  pixels  polygon\nbsp          0        1";
        assert_eq!(table.plain(), plain);
    }

    /// A file name is plain text in one cell of Markdown; a terminal gets it unchanged.
    #[test]
    fn cells_are_text() {
        let mut table = Table::new(&["scene", "polygons"]);
        table.push(vec!["a|*b*_<i>\n#".into(), "1".into()]);
        let markdown = "\
            | scene              | polygons |\n\
            |--------------------|---------:|\n\
            | a\\|\\*b\\*\\_\\<i\\> \\# |        1 |\n";
        assert_eq!(table.markdown(), markdown);
        assert!(table.plain().contains("a|*b*_<i>"));
    }
}
