//! Results as columns with name, unit and meaning.
//!
//! Columns are plain vectors: numbers as in NumPy and Arrow, with NaN for missing values; texts as codes into a dictionary as in Arrow,
//! because most columns repeat few texts.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;
use schemars::{JsonSchema, SchemaGenerator};
use serde::Serialize;
use serde_json::{Value, json};

use crate::engine::stopped::Stopped;

/// A table of results.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Name; the first table of an analysis has the name of the analysis.
    pub name: String,
    /// Columns of one length.
    pub columns: Vec<Column>,
}

/// A table during construction: its rows, and the columns that are complete.
#[must_use]
pub struct TableOf<R> {
    rows: Vec<R>,
    table: Table,
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
    kinds: Vec<Arc<str>>,
    /// Code of each kind.
    known: HashMap<Arc<str>, u32>,
    codes: Vec<Option<u32>>,
}

impl Column {
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
        self.codes[row].map(|code| &*self.kinds[code as usize])
    }

    /// The texts of all rows; absent ones are gaps.
    pub fn iter(&self) -> impl Iterator<Item = Option<&str>> {
        (0..self.codes.len()).map(|row| self.get(row))
    }

    /// The distinct texts, in the order of the codes.
    pub fn kinds(&self) -> impl Iterator<Item = &str> {
        self.kinds.iter().map(|kind| &**kind)
    }

    /// The code of each cell; absent for a gap.
    pub fn codes(&self) -> &[Option<u32>] {
        &self.codes
    }

    /// Codes of other texts in this dictionary.
    fn codes_of(&mut self, other: &Self) -> Vec<u32> {
        other.kinds.iter().map(|kind| self.code(kind)).collect()
    }

    /// The code of a text, which is added if it is new.
    fn code(&mut self, text: &str) -> u32 {
        if let Some(known) = self.known.get(text) {
            return *known;
        }
        let (kind, code) = (Arc::<str>::from(text), self.kinds.len() as u32);
        self.kinds.push(Arc::clone(&kind));
        self.known.insert(kind, code);
        code
    }

    /// Appends a text; an empty one is a gap.
    pub fn push(&mut self, text: &str) {
        if text.is_empty() {
            return self.codes.push(None);
        }
        // Usually the text of the previous row.
        let last = self.codes.last().copied().flatten();
        let last = last.filter(|code| *self.kinds[*code as usize] == *text);
        let code = last.unwrap_or_else(|| self.code(text));
        self.codes.push(Some(code));
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

    /// Appends cells of others in order: index of one of them, and range of its cells.
    ///
    /// # Panics
    /// If numbers and texts are mixed: a bug of the caller.
    fn extend(&mut self, others: &[&Self], order: &[(usize, Range<usize>)]) {
        match self {
            Self::Numbers(values) => {
                let values = Arc::make_mut(values);
                for (number, cells) in order {
                    let Self::Numbers(other) = others[*number] else {
                        panic!("a column of numbers takes numbers");
                    };
                    values.extend_from_slice(&other[cells.clone()]);
                }
            }
            Self::Texts(held) => {
                let held = Arc::make_mut(held);
                let texts = |values: &&Self| match values {
                    Self::Texts(texts) => Arc::clone(texts),
                    Self::Numbers(_) => panic!("a column of texts takes texts"),
                };
                let others: Vec<Arc<Texts>> = others.iter().map(texts).collect();
                let codes: Vec<Vec<u32>> = others.iter().map(|other| held.codes_of(other)).collect();
                for (number, cells) in order {
                    let cells = others[*number].codes[cells.clone()].iter();
                    held.codes
                        .extend(cells.map(|code| code.map(|code| codes[*number][code as usize])));
                }
            }
        }
    }
}

impl Table {
    /// A table with these rows, whose columns follow: `Table::of(name, rows).number("loss_w", "W", "Loss", |row| row.loss_w).finish()`.
    pub fn of<R>(name: impl Into<String>, rows: impl IntoIterator<Item = R>) -> TableOf<R> {
        TableOf {
            rows: rows.into_iter().collect(),
            table: Self {
                name: name.into(),
                columns: Vec::new(),
            },
        }
    }

    /// A table with one row for each part of each whole, such as the points of each model set; a row is the pair of both.
    pub fn of_each<'t, W, P: IntoIterator>(
        name: impl Into<String>,
        wholes: &'t [W],
        parts: impl Fn(&'t W) -> P,
    ) -> TableOf<(&'t W, P::Item)> {
        let pairs = |whole| parts(whole).into_iter().map(move |part| (whole, part));
        Self::of(name, wholes.iter().flat_map(pairs))
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

    /// Appends rows of parts in order: index of a part, and range of its rows.
    ///
    /// # Panics
    /// If a part has other columns: a bug of the caller.
    pub fn extend(&mut self, parts: &[Self], order: &[(usize, Range<usize>)]) {
        self.columns.par_iter_mut().enumerate().for_each(|(place, column)| {
            let others: Vec<&Values> = parts.iter().map(|part| &part.columns[place].values).collect();
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
        Self {
            name: self.name.clone(),
            columns: self.columns.iter().map(column).collect(),
        }
    }
}

impl<R> TableOf<R> {
    /// The rows.
    pub fn rows(&self) -> &[R] {
        &self.rows
    }

    /// Adds a column of texts; empty ones are gaps.
    pub fn text<'t, T: Into<Cow<'t, str>>>(
        self,
        name: impl Into<String>,
        meaning: impl Into<Cow<'static, str>>,
        cell: impl Fn(&R) -> T,
    ) -> Self {
        let mut texts = Texts::default();
        for row in &self.rows {
            texts.push(&cell(row).into());
        }
        let values = Values::Texts(Arc::new(texts));
        self.column(name.into(), "".into(), meaning.into(), values)
    }

    /// Adds a column of numbers; absent ones and those that are not finite are gaps.
    pub fn number<N: Into<Option<f64>>>(
        self,
        name: impl Into<String>,
        unit: impl Into<Cow<'static, str>>,
        meaning: impl Into<Cow<'static, str>>,
        cell: impl Fn(&R) -> N,
    ) -> Self {
        let number = |row: &R| cell(row).into().filter(|x| x.is_finite()).unwrap_or(f64::NAN);
        let values = Values::Numbers(Arc::new(self.rows.iter().map(number).collect()));
        self.column(name.into(), unit.into(), meaning.into(), values)
    }

    /// Adds columns of fields of a record, in the order of their names: each has the name, unit and meaning of its field, and the values
    /// of the JSON.
    ///
    /// # Panics
    /// If the record has no such field of numbers or texts: a bug of the caller.
    pub fn fields<F: Serialize + JsonSchema>(self, names: &str, record: impl for<'r> Fn(&'r R) -> &'r F) -> Self {
        self.fields_of(None, names, record)
    }

    /// The same of fields whose unit depends on the rows.
    ///
    /// # Panics
    /// As [`TableOf::fields`].
    pub fn fields_in<F: Serialize + JsonSchema>(
        self,
        unit: &'static str,
        names: &str,
        record: impl for<'r> Fn(&'r R) -> &'r F,
    ) -> Self {
        self.fields_of(Some(unit), names, record)
    }

    fn fields_of<F: Serialize + JsonSchema>(
        mut self,
        unit: Option<&'static str>,
        names: &str,
        record: impl for<'r> Fn(&'r R) -> &'r F,
    ) -> Self {
        let known = fields_of::<F>();
        let column = |name: &str| {
            let field = known.iter().find(|field| field.name == name);
            let field = field.unwrap_or_else(|| panic!("`{}` has no field `{name}` for a column", F::schema_name()));
            Column {
                name: name.to_owned(),
                unit: unit.map_or_else(|| field.unit.clone().into(), Cow::Borrowed),
                meaning: field.meaning.clone().into(),
                values: if field.is_number {
                    Values::Numbers(Arc::default())
                } else {
                    Values::Texts(Arc::default())
                },
            }
        };
        let mut columns: Vec<Column> = names.split_whitespace().map(column).collect();
        for row in &self.rows {
            let record = json!(record(row));
            for column in &mut columns {
                match (&mut column.values, &record[column.name.as_str()]) {
                    (Values::Numbers(numbers), cell) => {
                        Arc::make_mut(numbers).push(cell.as_f64().unwrap_or(f64::NAN));
                    }
                    (Values::Texts(texts), cell) => Arc::make_mut(texts).push(&text_of(cell)),
                }
            }
        }
        self.table.columns.extend(columns);
        self
    }

    /// Adds two columns of numbers: the lower and the upper end of an interval, such as `the 95 % band of the loss`.
    pub fn ends<N: Into<Option<[f64; 2]>>>(
        self,
        names: [&str; 2],
        unit: &'static str,
        interval: &str,
        cell: impl Fn(&R) -> N,
    ) -> Self {
        let end = |row: &R, i: usize| cell(row).into().map(|ends| ends[i]);
        self.number(names[0], unit, format!("Lower end of {interval}"), |row| end(row, 0))
            .number(names[1], unit, format!("Upper end of {interval}"), |row| end(row, 1))
    }

    fn column(mut self, name: String, unit: Cow<'static, str>, meaning: Cow<'static, str>, values: Values) -> Self {
        self.table.columns.push(Column {
            name,
            unit,
            meaning,
            values,
        });
        self
    }

    /// Adds the columns of each of several items, such as one column per share of the loss.
    pub fn each<I>(self, items: impl IntoIterator<Item = I>, columns: impl FnMut(Self, I) -> Self) -> Self {
        items.into_iter().fold(self, columns)
    }

    /// The table of all columns.
    pub fn finish(self) -> Table {
        self.table
    }
}

/// A field of a record that can be a column.
struct Field {
    name: String,
    is_number: bool,
    /// Unit at the end of its description.
    unit: String,
    /// The description before a semicolon.
    meaning: String,
}

/// The fields of a record that can be columns, from its schema.
fn fields_of<F: JsonSchema>() -> Vec<Field> {
    let schema = SchemaGenerator::default().into_root_schema_for::<F>();
    let properties = schema.get("properties").and_then(Value::as_object);
    let field = |(name, schema): (&String, &Value)| {
        // The kind, or a list with null; none of an enumeration, which refers to its own schema.
        let kind = &schema["type"];
        let is = |name: &str| kind == name || kind.as_array().is_some_and(|list| list.iter().any(|kind| kind == name));
        if is("array") || is("object") {
            return None;
        }
        let is_number = is("number") || is("integer");
        let description = schema["description"].as_str().unwrap_or_default();
        let (text, unit) = match description.strip_suffix(']').and_then(|text| text.rsplit_once('[')) {
            Some((text, unit)) => (text, unit),
            None => (description, if is_number { "-" } else { "" }),
        };
        let meaning = text.split(';').next().unwrap_or(text).trim().trim_end_matches('.');
        Some(Field {
            name: name.clone(),
            is_number,
            unit: unit.to_owned(),
            meaning: meaning.to_owned(),
        })
    };
    properties.into_iter().flatten().filter_map(field).collect()
}

/// A cell of a text.
fn text_of(cell: &Value) -> Cow<'_, str> {
    match cell {
        Value::Null => Cow::Borrowed(""),
        Value::String(text) => Cow::Borrowed(text),
        Value::Array(_) | Value::Object(_) => panic!("neither a number nor a text: {cell}"),
        other => Cow::Owned(other.to_string()),
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

/// For runs that write no tables: rows are dropped.
pub struct DiscardedRows;

impl RowSink for DiscardedRows {
    fn take(&self, _: &Table) -> Result<(), Stopped> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_have_one_code_each_in_the_order_of_their_rows() {
        let names: Vec<String> = (0..200_000).map(|row| format!("row {}", row % 100_000)).collect();
        let mut table = Table::of("t", &names)
            .text("name", "Name", |name| name.as_str())
            .finish();
        let Values::Texts(texts) = &table.columns[0].values else {
            panic!("texts")
        };
        assert_eq!(texts.kinds().count(), 100_000);
        assert_eq!((texts.codes()[7], texts.codes()[100_007]), (Some(7), Some(7)));
        let part = table.clone();
        table.extend(&[part], &[(0, 5..6)]);
        assert_eq!(table.columns[0].cell(200_000), "row 5");
    }

    #[test]
    fn rows_become_columns_with_gaps() {
        let rows = [("first", Some(2.5)), ("", None), ("first", Some(f64::INFINITY))];
        let table = Table::of("points", rows)
            .text("gear", "Gear", |row| row.0)
            .number("loss_w", "W", "Loss", |row| row.1)
            .finish();
        let column = |name: &str| -> Vec<String> {
            let column = table.column(name).expect("it is there");
            (0..table.len()).map(|row| column.cell(row).into_owned()).collect()
        };
        assert_eq!(column("gear"), ["first", "", "first"]);
        assert_eq!(column("loss_w"), ["2.5", "", ""]);
    }
}
