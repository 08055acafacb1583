//! Published tables, independently transcribed, for tests that compare model constants cell by cell.
//!
//! The CSV files are in `tests/tables`, each with its source in the header. They were typed without reference to the code.

/// Rows of a table; cells are looked up by column name.
pub struct Printed {
    columns: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

pub struct Row<'a> {
    columns: &'a [&'static str],
    cells: &'a [&'static str],
}

impl Printed {
    /// Reads a table; lines that begin with `#` state the source.
    #[track_caller]
    pub fn read(text: &'static str) -> Self {
        assert!(text.starts_with("# "), "a table without its source");
        let mut lines = text.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
        let cells = |line: &'static str| line.split(',').collect::<Vec<_>>();
        let columns = lines.next().map(cells).unwrap_or_default();
        let rows: Vec<_> = lines.map(cells).collect();
        for row in &rows {
            assert_eq!(row.len(), columns.len(), "{row:?}");
        }
        assert!(!rows.is_empty(), "an empty table");
        Self { columns, rows }
    }

    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row {
            columns: &self.columns,
            cells,
        })
    }
}

impl Row<'_> {
    /// A cell as text.
    #[track_caller]
    pub fn text(&self, column: &str) -> &'static str {
        let i = self.columns.iter().position(|c| *c == column);
        self.cells[i.unwrap_or_else(|| panic!("no column `{column}` in {:?}", self.columns))]
    }

    #[track_caller]
    pub fn number(&self, column: &str) -> f64 {
        let text = self.text(column);
        text.parse()
            .unwrap_or_else(|_| panic!("`{text}` in column `{column}` of {:?}", self.cells))
    }

    /// A number, if the source states one.
    #[track_caller]
    pub fn cell(&self, column: &str) -> Option<f64> {
        (!self.text(column).is_empty()).then(|| self.number(column))
    }

    /// Compares a constant of the code with a cell; only binary rounding may differ.
    #[track_caller]
    pub fn is(&self, column: &str, coded: f64) {
        let printed = self.number(column);
        assert!(
            (coded - printed).abs() <= 1e-12 * printed.abs(),
            "{column} of {:?} is {printed} in the source and {coded} in the code",
            self.cells
        );
    }
}
