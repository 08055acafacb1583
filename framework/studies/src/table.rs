//! Results as columns: each with its name, its unit and what it means.
//!
//! Columns are plain vectors: numbers as NumPy and Arrow hold them, with NaN for a gap; texts as codes into the texts that occur, as in
//! an Arrow dictionary, because most columns of texts repeat a few.

use std::borrow::Cow;

/// A table of results.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Name; the first table of an analysis has that of the analysis.
    pub name: String,
    /// Columns of one length.
    pub columns: Vec<Column>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name, as in the header of a file.
    pub name: String,
    /// Unit; `-` for a number without one, empty for texts.
    pub unit: Cow<'static, str>,
    /// What it is.
    pub meaning: Cow<'static, str>,
    /// The cells.
    pub values: Values,
}

/// The cells of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers; NaN is a gap.
    Numbers(Vec<f64>),
    /// Texts.
    Texts(Texts),
}

/// Texts of which many are the same.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Texts {
    kinds: Vec<String>,
    codes: Vec<Option<u32>>,
}

/// One cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell<'a> {
    /// A number, or a gap.
    Number(Option<f64>),
    /// A text; an empty one is a gap.
    Text(Cow<'a, str>),
}

impl Column {
    /// A column of numbers.
    pub fn number(
        name: impl Into<String>,
        unit: impl Into<Cow<'static, str>>,
        meaning: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            meaning: meaning.into(),
            values: Values::Numbers(Vec::new()),
        }
    }

    /// A column of texts.
    pub fn text(name: impl Into<String>, meaning: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            unit: Cow::Borrowed(""),
            meaning: meaning.into(),
            values: Values::Texts(Texts::default()),
        }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        match &self.values {
            Values::Numbers(numbers) => numbers.len(),
            Values::Texts(texts) => texts.codes.len(),
        }
    }

    /// True without cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The numbers; absent for texts.
    pub fn numbers(&self) -> Option<&[f64]> {
        match &self.values {
            Values::Numbers(numbers) => Some(numbers),
            Values::Texts(_) => None,
        }
    }

    /// A cell as a file of texts has it: all digits of a number, nothing for a gap.
    pub fn cell(&self, row: usize) -> Cow<'_, str> {
        match &self.values {
            Values::Numbers(numbers) if numbers[row].is_nan() => Cow::Borrowed(""),
            Values::Numbers(numbers) => Cow::Owned(numbers[row].to_string()),
            Values::Texts(texts) => Cow::Borrowed(texts.get(row).unwrap_or_default()),
        }
    }
}

impl Texts {
    /// A text; absent for a gap.
    pub fn get(&self, row: usize) -> Option<&str> {
        self.codes[row].map(|code| self.kinds[code as usize].as_str())
    }

    /// The texts that occur; those of the codes.
    pub fn kinds(&self) -> &[String] {
        &self.kinds
    }

    /// The code of each cell; absent for a gap.
    pub fn codes(&self) -> &[Option<u32>] {
        &self.codes
    }

    fn push(&mut self, text: &str) {
        if text.is_empty() {
            return self.codes.push(None);
        }
        // Mostly the text of the row before.
        let known = self.kinds.iter().rposition(|kind| kind == text);
        let code = known.unwrap_or_else(|| {
            self.kinds.push(text.to_owned());
            self.kinds.len() - 1
        });
        self.codes.push(Some(code as u32));
    }
}

impl Table {
    /// An empty table.
    pub fn new(name: impl Into<String>, columns: impl IntoIterator<Item = Column>) -> Self {
        Self {
            name: name.into(),
            columns: columns.into_iter().collect(),
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, Column::len)
    }

    /// True without rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A column by its name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If the cells are not as many as the columns, or of another kind: a bug of the caller.
    pub fn push<'c>(&mut self, cells: impl IntoIterator<Item = Cell<'c>>) {
        let mut columns = self.columns.iter_mut();
        for cell in cells {
            let column = columns
                .next()
                .expect("a row has no more cells than the table has columns");
            match (&mut column.values, cell) {
                (Values::Numbers(numbers), Cell::Number(x)) => {
                    numbers.push(x.filter(|x| x.is_finite()).unwrap_or(f64::NAN));
                }
                (Values::Texts(texts), Cell::Text(text)) => texts.push(&text),
                (Values::Numbers(_), Cell::Text(text)) => panic!("`{}` takes numbers, not `{text}`", column.name),
                (Values::Texts(_), Cell::Number(x)) => panic!("`{}` takes texts, not {x:?}", column.name),
            }
        }
        assert!(columns.next().is_none(), "a row has a cell for every column");
    }
}

impl From<f64> for Cell<'_> {
    fn from(x: f64) -> Self {
        Self::Number(Some(x))
    }
}

impl From<Option<f64>> for Cell<'_> {
    fn from(x: Option<f64>) -> Self {
        Self::Number(x)
    }
}

impl From<usize> for Cell<'_> {
    fn from(count: usize) -> Self {
        Self::Number(Some(count as f64))
    }
}

impl<'c> From<&'c str> for Cell<'c> {
    fn from(text: &'c str) -> Self {
        Self::Text(Cow::Borrowed(text))
    }
}

impl<'c> From<&'c String> for Cell<'c> {
    fn from(text: &'c String) -> Self {
        Self::Text(Cow::Borrowed(text))
    }
}

impl From<String> for Cell<'_> {
    fn from(text: String) -> Self {
        Self::Text(Cow::Owned(text))
    }
}

/// Cells of a row, from numbers and texts.
#[macro_export]
macro_rules! cells {
    ($($cell:expr),* $(,)?) => { [$($crate::table::Cell::from($cell)),*] };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_columns_with_gaps() {
        let mut table = Table::new(
            "points",
            [Column::text("gear", "Gear"), Column::number("loss_w", "W", "Loss")],
        );
        table.push(cells!["first", 2.5]);
        table.push(cells!["", None::<f64>]);
        table.push(cells!["first", f64::INFINITY]);
        let column = |name: &str| -> Vec<String> {
            let column = table.column(name).expect("it is there");
            (0..table.len()).map(|row| column.cell(row).into_owned()).collect()
        };
        assert_eq!(column("gear"), ["first", "", "first"]);
        assert_eq!(column("loss_w"), ["2.5", "", ""]);
    }
}
