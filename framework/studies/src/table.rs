//! Results as columns with name, unit and meaning.
//!
//! Columns are plain vectors: numbers as in NumPy and Arrow, with NaN for missing values; texts as codes into a dictionary as in Arrow,
//! because most columns repeat few texts.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use crate::analyses::Stopped;

/// A table of results.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Name; the first table of an analysis has the name of the analysis.
    pub name: String,
    /// Columns of one length.
    pub columns: Vec<Column>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name in the header of a file.
    pub name: String,
    /// Unit; `-` for a number without one, empty for texts.
    pub unit: Cow<'static, str>,
    /// Kind.
    pub meaning: Cow<'static, str>,
    /// The cells.
    pub values: Values,
}

/// The cells of a column, shared by copies.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers; NaN is a gap.
    Numbers(Arc<Vec<f64>>),
    /// Texts.
    Texts(Arc<Texts>),
}

/// Texts with many repetitions.
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
            values: Values::Numbers(Arc::default()),
        }
    }

    /// A column of texts.
    pub fn text(name: impl Into<String>, meaning: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            unit: Cow::Borrowed(""),
            meaning: meaning.into(),
            values: Values::Texts(Arc::default()),
        }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.values.len()
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

    /// A cell as text: all digits of a number, empty for a gap.
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

    /// The distinct texts, indexed by the codes.
    pub fn kinds(&self) -> &[String] {
        &self.kinds
    }

    /// The code of each cell; absent for a gap.
    pub fn codes(&self) -> &[Option<u32>] {
        &self.codes
    }

    /// The same text, repeated.
    pub fn repeated(text: &str, count: usize) -> Self {
        let code = (!text.is_empty()).then_some(0);
        Self {
            kinds: code.map(|_| text.to_owned()).into_iter().collect(),
            codes: vec![code; count],
        }
    }

    /// Codes of other texts in this dictionary.
    fn codes_of(&mut self, other: &Self) -> Vec<u32> {
        let code = |kind: &String| {
            let known = self.kinds.iter().position(|own| own == kind);
            known.unwrap_or_else(|| {
                self.kinds.push(kind.clone());
                self.kinds.len() - 1
            }) as u32
        };
        other.kinds.iter().map(code).collect()
    }

    fn push(&mut self, text: &str) {
        if text.is_empty() {
            return self.codes.push(None);
        }
        // Usually the text of the previous row.
        let known = self.kinds.iter().rposition(|kind| kind == text);
        let code = known.unwrap_or_else(|| {
            self.kinds.push(text.to_owned());
            self.kinds.len() - 1
        });
        self.codes.push(Some(code as u32));
    }
}

impl<'t> FromIterator<&'t str> for Texts {
    fn from_iter<I: IntoIterator<Item = &'t str>>(all: I) -> Self {
        let mut texts = Self::default();
        all.into_iter().for_each(|text| texts.push(text));
        texts
    }
}

impl Values {
    /// Number of cells.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Texts(texts) => texts.codes.len(),
        }
    }

    /// True without cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Numbers with gaps.
    pub fn from_numbers(numbers: impl Iterator<Item = Option<f64>>) -> Self {
        Self::Numbers(Arc::new(numbers.map(|x| x.unwrap_or(f64::NAN)).collect()))
    }

    /// Texts, of which the empty ones are gaps.
    pub fn from_texts<'t>(texts: impl Iterator<Item = &'t str>) -> Self {
        Self::Texts(Arc::new(texts.collect()))
    }

    /// Appends cells of others in order: index of one of them, and range of its cells.
    ///
    /// # Panics
    /// If numbers and texts are mixed: a bug of the caller.
    fn extend(&mut self, others: &[&Self], order: &[(usize, Range<usize>)]) {
        match self {
            Self::Numbers(own) => {
                let own = Arc::make_mut(own);
                for (number, cells) in order {
                    let Self::Numbers(other) = others[*number] else {
                        panic!("a column of numbers takes numbers");
                    };
                    own.extend_from_slice(&other[cells.clone()]);
                }
            }
            Self::Texts(own) => {
                let own = Arc::make_mut(own);
                let texts = |values: &&Self| match values {
                    Self::Texts(texts) => Arc::clone(texts),
                    Self::Numbers(_) => panic!("a column of texts takes texts"),
                };
                let others: Vec<Arc<Texts>> = others.iter().map(texts).collect();
                let codes: Vec<Vec<u32>> = others.iter().map(|other| own.codes_of(other)).collect();
                for (number, cells) in order {
                    let cells = others[*number].codes[cells.clone()].iter();
                    own.codes
                        .extend(cells.map(|code| code.map(|code| codes[*number][code as usize])));
                }
            }
        }
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

    /// Appends rows of parts with values for every column, in order: index of a part, and range of its rows.
    ///
    /// # Panics
    /// If a part has other columns: a bug of the caller.
    pub fn extend(&mut self, parts: &[Vec<Values>], order: &[(usize, Range<usize>)]) {
        self.columns.par_iter_mut().enumerate().for_each(|(place, column)| {
            let others: Vec<&Values> = parts.iter().map(|part| &part[place]).collect();
            column.values.extend(&others, order);
        });
    }

    /// The columns without their cells.
    pub fn header(&self) -> Self {
        let column = |column: &Column| Column {
            values: match column.values {
                Values::Numbers(_) => Values::Numbers(Arc::default()),
                Values::Texts(_) => Values::Texts(Arc::default()),
            },
            ..column.clone()
        };
        Self::new(&self.name, self.columns.iter().map(column))
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If the number of cells differs from the number of columns, or a kind differs: a bug of the caller.
    pub fn push<'c>(&mut self, cells: impl IntoIterator<Item = Cell<'c>>) {
        let mut columns = self.columns.iter_mut();
        for cell in cells {
            let column = columns
                .next()
                .expect("a row has no more cells than the table has columns");
            match (&mut column.values, cell) {
                (Values::Numbers(numbers), Cell::Number(x)) => {
                    Arc::make_mut(numbers).push(x.filter(|x| x.is_finite()).unwrap_or(f64::NAN));
                }
                (Values::Texts(texts), Cell::Text(text)) => Arc::make_mut(texts).push(&text),
                (Values::Numbers(_), Cell::Text(text)) => panic!("`{}` takes numbers, not `{text}`", column.name),
                (Values::Texts(_), Cell::Number(x)) => panic!("`{}` takes texts, not {x:?}", column.name),
            }
        }
        assert!(columns.next().is_none(), "a row has a cell for every column");
    }
}

/// Receives the rows of a large table in batches.
pub trait RowSink: Sync {
    /// Receives the next rows of the table with this name.
    ///
    /// # Errors
    /// [`Stopped::Unwritten`] if they cannot be written.
    fn take(&self, rows: &Table) -> Result<(), Stopped>;
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
