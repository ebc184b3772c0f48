//! Tables whose rows are written one by one, as soon as they are measured.

/// A table: a column of names, and columns of figures to the right of this column.
///
/// Widths are fixed before the first row, because rows appear one by one, over seconds or minutes. Crates for
/// tables need all rows first.
#[derive(Debug)]
pub(crate) struct Table {
    columns: Vec<(&'static str, usize)>,
}

impl Table {
    /// A table with these columns. Each column is as wide as its title, and at least as wide as the given
    /// number.
    pub(crate) fn new(columns: &[(&'static str, usize)]) -> Self {
        let width = |&(title, width): &(&'static str, usize)| (title, width.max(title.len()));
        Self { columns: columns.iter().map(width).collect() }
    }

    /// The titles.
    pub(crate) fn head(&self) -> String {
        let titles: Vec<&str> = self.columns.iter().map(|&(title, _)| title).collect();
        self.row(&titles)
    }

    /// A row: the first cell is aligned to the left, the others to the right.
    pub(crate) fn row(&self, cells: &[impl AsRef<str>]) -> String {
        let mut line = String::new();
        for (i, (cell, &(_, width))) in cells.iter().zip(&self.columns).enumerate() {
            let cell = cell.as_ref();
            let padding = " ".repeat(width.saturating_sub(cell.chars().count()));
            let (before, after) = if i == 0 { ("", &padding[..]) } else { (&padding[..], "") };
            let gap = if i == 0 { "" } else { "  " };
            line += &format!("{gap}{before}{cell}{after}");
        }
        line
    }
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn figures_stand_to_the_right() {
        let table = Table::new(&[("name", 6), ("time", 7), ("n", 1)]);
        assert_eq!(table.head(), "name       time  n");
        assert_eq!(table.row(&["a", "1.0 µs", "12"]), "a        1.0 µs  12");
    }
}
