//! Catalogues of linked crates: a gearbox names a few of many rows, so a row is read when it is asked for.

use std::borrow::Cow;
use std::sync::OnceLock;

use super::catalogue::{self, CatalogueRow, CatalogueTable};
use crate::document::data::cells::name_and_unit;

/// The catalogues of a section. Their texts are plain CSV: commas, decimal points, no quotes, comments with `#`, the designation first.
#[derive(Debug, Default)]
pub struct LinkedCatalogue {
    /// Columns of each text.
    texts: Vec<Vec<(String, Option<String>)>>,
    /// In the order of the designations.
    lines: Vec<(&'static str, Line)>,
    table: OnceLock<CatalogueTable>,
}

/// A row that is not read.
#[derive(Debug, Clone, Copy)]
struct Line {
    /// Index of its text.
    text: usize,
    number: usize,
    cells: &'static str,
}

impl LinkedCatalogue {
    /// Adds a text, but none of its rows that is already there.
    ///
    /// # Errors
    /// What is wrong with its form, or the first designation that another text has, too.
    pub(crate) fn add(&mut self, csv: &'static str) -> Result<(), Fault> {
        if csv.contains('"') {
            return Err(Fault::Form("quotes are not read in a linked catalogue".to_owned()));
        }
        let lines = csv.lines().zip(1..);
        let mut lines = lines.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
        let header = lines.next().map_or("", |(line, _)| line);
        if header.split(',').next() != Some("designation") {
            return Err(Fault::Form("the first column is not `designation`".to_owned()));
        }
        let mut columns = Vec::new();
        for cell in header.split(',') {
            let (key, symbol) = name_and_unit(cell);
            let unit = symbol.map(|symbol| match catalogue::unit_of_column(&symbol) {
                Some(unit) => Ok(unit.to_owned()),
                None => Err(Fault::Form(format!("column `{key} [{symbol}]`: unknown unit"))),
            });
            columns.push((key, unit.transpose()?));
        }
        let text = self.texts.len();
        self.texts.push(columns);
        for (cells, number) in lines {
            let designation = cells.split(',').next().unwrap_or_default();
            if designation.is_empty() {
                return Err(Fault::Form(format!("line {number}: no designation")));
            }
            self.lines.push((designation, Line { text, number, cells }));
        }
        self.lines
            .sort_by_key(|(designation, line)| (*designation, line.text, line.number));
        let mut pairs = self.lines.windows(2);
        let twice = pairs
            .find(|pair| pair[0].0 == pair[1].0)
            .map(|pair| (pair[1], pair[0].1.text == text));
        self.lines.dedup_by_key(|(designation, _)| *designation);
        match twice {
            None => Ok(()),
            Some(((designation, line), true)) => Err(Fault::Form(format!(
                "line {}: `{designation}` occurs twice",
                line.number
            ))),
            Some(((designation, _), false)) => Err(Fault::Twice(designation)),
        }
    }

    /// The designations, in order.
    pub fn designations(&self) -> impl Iterator<Item = &'static str> + Clone {
        self.lines.iter().map(|(designation, _)| *designation)
    }

    /// The row of a designation as it is written.
    ///
    /// # Errors
    /// A cell that is not a number.
    pub fn row(&self, designation: &str) -> Option<Result<CatalogueRow, String>> {
        let place = self.lines.binary_search_by_key(&designation, |(known, _)| known).ok()?;
        Some(self.read(&self.lines[place].1))
    }

    fn read(&self, line: &Line) -> Result<CatalogueRow, String> {
        let columns: Vec<(&str, Option<&str>)> = self.texts[line.text]
            .iter()
            .map(|(key, unit)| (key.as_str(), unit.as_deref()))
            .collect();
        let number =
            |cell: &'static str| Some((cell.parse().ok().filter(|x: &f64| x.is_finite())?, Cow::Borrowed(cell)));
        catalogue::row(&columns, line.cells.split(','), number)
            .map_err(|wrong| format!("line {}: {wrong}", line.number))
    }

    /// Rows that cannot be read, each with the reason.
    pub fn faults(&self) -> impl Iterator<Item = String> {
        self.lines.iter().filter_map(|(_, line)| self.read(line).err())
    }

    /// All rows; those that [cannot be read](Self::faults) are left out.
    pub fn table(&self) -> &CatalogueTable {
        self.table.get_or_init(|| {
            let rows = self.lines.iter();
            let rows = rows.filter_map(|(name, line)| Some(((*name).to_owned(), self.read(line).ok()?)));
            CatalogueTable(rows.collect())
        })
    }
}

/// Why a linked catalogue is refused.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// Its form.
    Form(String),
    /// A designation that another catalogue has.
    Twice(&'static str),
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const ROWS: &str = "# Two bearings.\ndesignation,kind,bore [mm],e [-],estimated,basis\n6208,deep_groove_ball,40,,e,a\nX1,,12.5,0.3,,b\n";

    fn added(csv: &'static str) -> Fault {
        LinkedCatalogue::default().add(csv).unwrap_err()
    }

    #[test]
    fn rows_are_those_of_the_reader_of_files() {
        let mut linked = LinkedCatalogue::default();
        linked.add(ROWS).unwrap();
        let table = CatalogueTable::from_file(ROWS).unwrap();
        assert_eq!(format!("{:?}", linked.table()), format!("{table:?}"));
        for name in linked.designations() {
            assert_eq!(
                format!("{:?}", linked.row(name).unwrap().unwrap()),
                format!("{:?}", table.0[name])
            );
        }
        assert!(linked.row("6209").is_none());
    }

    #[test]
    fn a_text_of_another_form_is_refused() {
        let form = |message: &str| Fault::Form(message.to_owned());
        assert_eq!(
            added("bore [mm],designation\n"),
            form("the first column is not `designation`")
        );
        assert_eq!(
            added("designation,bore [mn]\n"),
            form("column `bore [mn]`: unknown unit")
        );
        assert_eq!(
            added("designation,basis\n\"a\",b\n"),
            form("quotes are not read in a linked catalogue")
        );
        assert_eq!(added("designation,bore [mm]\n,5\n"), form("line 2: no designation"));
        assert_eq!(
            added("designation,bore [mm]\na,5\na,6\n"),
            form("line 3: `a` occurs twice")
        );
        let mut linked = LinkedCatalogue::default();
        linked.add(ROWS).unwrap();
        assert_eq!(
            linked.add("designation,bore [mm]\n6208,41\nX2,3\n"),
            Err(Fault::Twice("6208"))
        );
        assert_eq!(linked.row("6208").unwrap().unwrap().values[1].1, "40 mm");
    }

    #[test]
    fn a_row_with_a_wrong_number_is_named() {
        let mut linked = LinkedCatalogue::default();
        linked.add("designation,bore [mm]\na,5\nb,five\nc,inf\n").unwrap();
        let wrong = "line 3: column `bore`: `five` is not a number";
        assert_eq!(linked.row("b").unwrap().unwrap_err(), wrong);
        assert_eq!(
            linked.faults().collect::<Vec<_>>(),
            [wrong, "line 4: column `bore`: `inf` is not a number"]
        );
        assert_eq!(linked.table().0.len(), 1);
    }
}
