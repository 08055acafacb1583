//! Marks that a file has in place of missing values.

use super::MeasuredFault;
use super::form::MissingMark;
use super::table::Table;

/// Numbers that loggers write for missing values.
const USUAL: [f64; 5] = [-999.0, -9999.0, -99999.0, -999_999.0, -999.25];

/// Help for a cell that is no number.
pub const CELL_HELP: &str =
    "correct the cell, or delete the row; marks of missing values are stated: `missing: [-9999, \"n/a\"]`";

impl Table {
    /// True if a cell has a mark.
    fn is_mark(&self, cell: &str, marks: &[MissingMark]) -> bool {
        marks.iter().any(|mark| match mark {
            MissingMark::Text(text) => cell.eq_ignore_ascii_case(text.trim()),
            MissingMark::Number(number) => {
                cell.starts_with(|c: char| !c.is_ascii_alphabetic()) && self.numbers.number(cell) == Some(*number)
            }
        })
    }

    /// Empties the cells with marks of missing values.
    pub fn empty_marks(&mut self, marks: &[MissingMark]) {
        if marks.is_empty() {
            return;
        }
        let mut rows = std::mem::take(&mut self.rows);
        for cell in rows.iter_mut().flat_map(|(_, cells)| cells) {
            if self.is_mark(cell, marks) {
                cell.clear();
            }
        }
        self.rows = rows;
    }

    /// Removes the rows with marks of missing values in these columns, and returns the place of each.
    pub fn omit_marked(&mut self, columns: &[usize], marks: &[MissingMark]) -> Vec<String> {
        let mut omitted = Vec::new();
        if marks.is_empty() {
            return omitted;
        }
        let mut rows = std::mem::take(&mut self.rows);
        rows.retain(|(line, cells)| {
            let cell = |place: &usize| cells.get(*place).map_or("", String::as_str);
            let marked = columns.iter().find(|place| self.is_mark(cell(place), marks));
            if let Some(place) = marked {
                omitted.push(self.describe(*line, *place));
            }
            marked.is_none()
        });
        self.rows = rows;
        omitted
    }

    /// The error for a number that usually marks a missing value and is far below all others of its column.
    pub fn unstated_mark(&self, place: usize) -> Option<MeasuredFault> {
        let cells = || {
            let cell = |cells: &'_ (u64, Vec<String>)| cells.1.get(place).map(|cell| (cells.0, cell.clone()));
            self.rows.iter().filter_map(cell)
        };
        let usual = |cell: &str| {
            let number = cell.starts_with("-9").then(|| self.numbers.number(cell))??;
            USUAL.contains(&number).then_some(number)
        };
        let found = self.rows.iter().find_map(|(line, cells)| {
            let number = usual(cells.get(place)?)?;
            Some((*line, number))
        });
        let (line, mark) = found?;
        let others = cells().filter_map(|(_, cell)| self.numbers.number(&cell));
        let least = others
            .filter(|number| !USUAL.contains(number))
            .fold(f64::INFINITY, f64::min);
        // A grid that goes on to -999 has neighbours of that size.
        if least < 0.75 * mark {
            return None;
        }
        Some(MeasuredFault::new(
            "missing",
            format!(
                "{}: {mark} is a usual mark of a missing value",
                self.describe(line, place)
            ),
            format!("state `missing: [{mark}]` if it is one, or `missing: []` if it is a value"),
        ))
    }
}
