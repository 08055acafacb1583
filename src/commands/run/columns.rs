//! Rows of a table column by column, as threads make them.

use std::ops::Range;

use parquet::data_type::ByteArray;

/// Some rows. They are added some at a time, those of one column after those of the column before.
pub struct Columns {
    all: Vec<Column>,
    /// How many rows are expected.
    rows: usize,
    /// Columns that have got the rows which are being added.
    filled: usize,
    /// Whether a column got numbers and texts.
    mixed: bool,
}

/// The cells of some rows in one column.
pub enum Column {
    /// Numbers and, as those that are none, gaps.
    Numbers(Vec<f64>),
    Texts(Texts),
}

/// Texts, of which neighbours are often the same.
#[derive(Default)]
pub struct Texts {
    /// Those that differ from the one before.
    kinds: Vec<ByteArray>,
    /// For each cell the number of its text; absent for a gap.
    of: Vec<Option<u32>>,
}

impl Columns {
    /// No rows yet of so many that are expected.
    pub fn new(rows: usize) -> Self {
        Self {
            all: Vec::new(),
            rows,
            filled: 0,
            mixed: false,
        }
    }

    /// Numbers and gaps of the next column.
    #[inline]
    pub fn numbers(&mut self, cells: impl Iterator<Item = Option<f64>>) {
        let own = match self.all.get_mut(self.filled) {
            Some(own) => own,
            None => self.all.push_mut(Column::Numbers(Vec::with_capacity(self.rows))),
        };
        match own {
            Column::Numbers(numbers) => numbers.extend(cells.map(|x| x.unwrap_or(f64::NAN))),
            Column::Texts(_) => self.mixed = true,
        }
        self.filled += 1;
    }

    /// Texts of the next column; empty ones are gaps.
    pub fn texts<'t>(&mut self, cells: impl Iterator<Item = &'t str>) {
        let own = match self.all.get_mut(self.filled) {
            Some(own) => own,
            None => self.all.push_mut(Column::Texts(Texts::default())),
        };
        match own {
            Column::Texts(texts) => cells.for_each(|text| texts.push(text)),
            Column::Numbers(_) => self.mixed = true,
        }
        self.filled += 1;
    }

    /// Ends the rows that were being added.
    ///
    /// # Errors
    /// Columns of another number than there are in the table, of different lengths, or of numbers and texts.
    pub fn end(&mut self, width: usize) -> Result<(), &'static str> {
        let rows = self.all.first().map_or(0, Column::len);
        let equal = self.all.iter().all(|column| column.len() == rows);
        if std::mem::take(&mut self.filled) == width && self.all.len() == width && equal && !self.mixed {
            Ok(())
        } else {
            Err("rows that do not fit the header")
        }
    }

    /// The columns.
    pub fn all(&self) -> &[Column] {
        &self.all
    }
}

impl Column {
    /// How many cells there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Texts(texts) => texts.of.len(),
        }
    }
}

impl Texts {
    fn push(&mut self, text: &str) {
        if text.is_empty() {
            return self.of.push(None);
        }
        if self.kinds.last().is_none_or(|last| last.data() != text.as_bytes()) {
            self.kinds.push(ByteArray::from(text));
        }
        self.of.push(Some(self.kinds.len() as u32 - 1));
    }

    /// Texts of some cells, whose bytes are shared; absent for a gap.
    pub fn cells(&self, own: Range<usize>) -> impl Iterator<Item = Option<&ByteArray>> {
        self.of[own].iter().map(|kind| kind.map(|k| &self.kinds[k as usize]))
    }

    /// All texts that there are.
    pub fn kinds(&self) -> impl Iterator<Item = &str> {
        self.kinds.iter().map(word)
    }
}

/// The number of a cell; absent for a gap.
pub fn number(x: f64) -> Option<f64> {
    (!x.is_nan()).then_some(x)
}

/// A text as words.
pub fn word(text: &ByteArray) -> &str {
    text.as_utf8().unwrap_or_default()
}
