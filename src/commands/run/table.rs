//! Tables of results as files.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::fs;
use std::io::{BufWriter, Write as _};
use std::ops::Range;

use gearloss_studies::study::Write;

use super::Run;
use super::columns::{Column, Columns, number, word};
use super::parquet::ParquetTable;
use super::write::Place;
use crate::output::Failure;

/// A table that is written some rows at a time, so that it never stands in memory as a whole.
pub struct TableFile {
    csv: Option<(Place, BufWriter<fs::File>)>,
    parquet: Option<(Place, ParquetTable<BufWriter<fs::File>>)>,
    /// Number of columns.
    width: usize,
}

/// What rows of a table are made into.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    lines: bool,
    columns: bool,
    width: usize,
}

/// Rows as they go into the files of a table.
pub struct Rows {
    lines: Option<Lines>,
    columns: Option<Columns>,
}

/// Lines of CSV.
struct Lines {
    text: Vec<u8>,
    /// Where each ends in the text.
    ends: Vec<usize>,
}

/// Items whose rows are made together, so few that they stay in the nearest cache while one column after the other is filled.
const BLOCK: usize = 64;

impl Shape {
    /// A row for each item; asked for are the cells of some items, column by column.
    ///
    /// # Errors
    /// Rows of another length than the header.
    pub fn rows<T>(&self, items: &[T], cells: impl Fn(&[T], &mut Columns)) -> Result<Rows, Failure> {
        let mut rows = Rows {
            lines: None,
            columns: None,
        };
        if !(self.lines || self.columns) {
            return Ok(rows);
        }
        let mut columns = Columns::new(items.len());
        for some in items.chunks(BLOCK) {
            cells(some, &mut columns);
            columns.end(self.width).map_err(bug)?;
        }
        if self.lines {
            rows.lines = Some(Lines::of(&columns, items.len()).map_err(bug)?);
        }
        rows.columns = Some(columns).filter(|_| self.columns);
        Ok(rows)
    }
}

impl Lines {
    /// So many rows as lines.
    fn of(columns: &Columns, rows: usize) -> Result<Self, csv::Error> {
        let mut lines = csv::Writer::from_writer(Vec::new());
        let (mut ends, mut digits) = (Vec::with_capacity(rows), String::new());
        for row in 0..rows {
            for column in columns.all() {
                match column {
                    Column::Numbers(numbers) => {
                        digits.clear();
                        if let Some(x) = number(numbers[row]) {
                            let _ = write!(digits, "{x}");
                        }
                        lines.write_field(&digits)?;
                    }
                    Column::Texts(texts) => {
                        let text = texts.cells(row..row + 1).flatten().next();
                        lines.write_field(text.map(word).map(inert).unwrap_or_default().as_ref())?;
                    }
                }
            }
            lines.write_record(None::<&[u8]>)?;
            lines.flush()?;
            ends.push(lines.get_ref().len());
        }
        let text = lines.into_inner().map_err(csv::IntoInnerError::into_error)?;
        Ok(Self { text, ends })
    }

    /// Some of the lines.
    fn some(&self, own: Range<usize>) -> &[u8] {
        let ends = [own.start, own.end].map(|line| line.checked_sub(1).map_or(0, |last| self.ends[last]));
        &self.text[ends[0]..ends[1]]
    }
}

/// A text as a spreadsheet takes for one: what would begin a formula there stands behind an apostrophe, which spreadsheets read
/// as the sign of a text. Numbers keep their sign, and a sign alone, such as the unit `-`, is no formula.
fn inert(text: &str) -> Cow<'_, str> {
    let is_formula = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    if !is_formula || text.len() == 1 || text.parse().is_ok_and(f64::is_finite) {
        Cow::Borrowed(text)
    } else {
        Cow::Owned(format!("'{text}"))
    }
}

/// What cannot be but by a fault of the program.
fn bug(what: impl std::fmt::Display) -> Failure {
    Failure::input(format!("bug: {what}"), "report this")
}

impl TableFile {
    pub fn new(runner: &Run<'_>, name: &str, formats: &[Write], header: &[String]) -> Result<Self, Failure> {
        let mut table = Self {
            csv: None,
            parquet: None,
            width: header.len(),
        };
        if formats.contains(&Write::Csv) {
            let (place, file) = Place::new(runner, &format!("{name}.csv"))?;
            table.csv = Some((place, file));
            // So far the table is one of lines.
            table.push_all(&[header])?;
        }
        if formats.contains(&Write::Parquet) {
            let (place, file) = Place::new(runner, &format!("{name}.parquet"))?;
            table.parquet = Some((place, ParquetTable::new(header, file)));
        }
        Ok(table)
    }

    /// What rows have to be made into.
    pub fn shape(&self) -> Shape {
        Shape {
            lines: self.csv.is_some(),
            columns: self.parquet.is_some(),
            width: self.width,
        }
    }

    /// Adds rows of texts.
    pub fn push_all<R: AsRef<[String]>>(&mut self, rows: &[R]) -> Result<(), Failure> {
        let width = self.width;
        if rows.is_empty() {
            return Ok(());
        }
        if rows.iter().any(|row| row.as_ref().len() != width) {
            return Err(bug("rows of another length than the header"));
        }
        let made = self.shape().rows(rows, |rows, columns| {
            for place in 0..width {
                columns.texts(rows.iter().map(|row| row.as_ref()[place].as_str()));
            }
        });
        self.push_rows(vec![made], vec![(0, 0..rows.len())])
    }

    /// Adds rows that were made, in an order: number of those made together, and which of them follow.
    pub fn push_rows(
        &mut self,
        made: Vec<Result<Rows, Failure>>,
        order: Vec<(usize, Range<usize>)>,
    ) -> Result<(), Failure> {
        let (mut lines, mut columns) = (Vec::new(), Vec::new());
        for rows in made {
            let rows = rows?;
            lines.extend(rows.lines);
            columns.extend(rows.columns);
        }
        if let Some((place, file)) = &mut self.csv {
            let mut runs = order.iter().map(|(made, own)| lines[*made].some(own.clone()));
            let written = runs.try_for_each(|run| file.write_all(run));
            written.map_err(|e| place.cannot(&e))?;
        }
        if let Some((place, table)) = &mut self.parquet {
            let written = table.push(columns, order);
            written.map_err(|e| place.cannot(&e))?;
        }
        Ok(())
    }

    pub fn finish(self) -> Result<(), Failure> {
        if let Some((place, mut file)) = self.csv {
            place.done(file.flush().map_err(|e| e.to_string()))?;
        }
        if let Some((place, table)) = self.parquet {
            place.done(table.finish())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_no_formulas_in_a_spreadsheet_and_numbers_keep_their_sign() {
        for harmless in ["-5.5", "+1e-3", "12", "", "-0", "-"] {
            assert_eq!(inert(harmless), harmless);
        }
        for text in [
            "=1+1",
            "+cmd|' /C calc'!A0",
            "-2+3",
            "@SUM(A1)",
            "\t=1",
            "\r=1",
            "-inf",
            "+NaN",
        ] {
            assert_eq!(inert(text), format!("'{text}"));
        }
        assert_eq!(inert("a=b"), "a=b");
    }
}
