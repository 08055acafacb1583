//! Tables as Parquet: the columns of the CSV, numbers as double precision with gaps, everything else as text.

use std::io::Write;
use std::sync::Arc;

use bytes::Bytes;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::column::writer::{ColumnCloseResult, ColumnWriter, get_column_writer};
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use parquet::schema::types::{ColumnDescPtr, ColumnPath, Type};
use rayon::prelude::*;

use super::write::Cell;

/// Columns that hold names, whatever their cells look like.
const NAMES: [&str; 9] = [
    "model_set",
    "base",
    "gear",
    "name",
    "share",
    "status",
    "balance",
    "model",
    "path",
];

/// Rows that make a row group, which may have more where they come at once.
const GROUP: usize = 32_768;

/// Number columns whose cells repeat so often that a dictionary pays.
const REPEATED: [&str; 3] = ["torque_nm", "speed_rpm", "oil_temperature_degc"];

/// A table that is written in groups of rows.
pub struct ParquetTable<W: Write + Send> {
    header: Vec<String>,
    columns: Vec<Column>,
    rows: usize,
    state: State<W>,
}

/// Whether the file was begun, which needs the kinds of all columns.
enum State<W: Write + Send> {
    Waiting(Option<W>),
    Begun(Box<SerializedFileWriter<W>>),
}

/// Cells of the present group in one column.
enum Column {
    /// Texts that may all be numbers; what they are is told by the first group.
    Open(Vec<Option<String>>),
    Numbers(Filled<f64>),
    Texts(Filled<ByteArray>),
}

/// Values, and for each cell one where it has a value.
struct Filled<T> {
    values: Vec<T>,
    levels: Vec<i16>,
}

impl<T> Filled<T> {
    /// So many gaps.
    fn gaps(count: usize) -> Self {
        Self {
            values: Vec::new(),
            levels: vec![0; count],
        }
    }

    fn push(&mut self, value: Option<T>) {
        self.levels.push(i16::from(value.is_some()));
        self.values.extend(value);
    }

    fn clear(&mut self) {
        self.values.clear();
        self.levels.clear();
    }
}

impl Column {
    /// Adds the cells of some rows.
    fn push_all<'c>(&mut self, cells: impl Iterator<Item = &'c Cell<'c>>) -> Result<(), String> {
        let mut cells = cells.peekable();
        while cells.peek().is_some() {
            if let Self::Numbers(numbers) = self {
                while let Some(cell) = cells.next_if(|cell| matches!(cell, Cell::Number(_) | Cell::Gap)) {
                    numbers.push(if let Cell::Number(x) = cell { Some(*x) } else { None });
                }
            }
            if let Some(cell) = cells.next() {
                self.push(cell)?;
            }
        }
        Ok(())
    }

    fn push(&mut self, cell: &Cell<'_>) -> Result<(), String> {
        match (&mut *self, cell) {
            // A number before any text tells that the column is one of numbers.
            (Self::Open(cells), Cell::Number(x)) if cells.iter().all(Option::is_none) => {
                let mut numbers = Filled::gaps(cells.len());
                numbers.push(Some(*x));
                *self = Self::Numbers(numbers);
            }
            (Self::Open(cells), cell) => cells.push(cell.text()),
            (Self::Numbers(numbers), Cell::Number(x)) => numbers.push(Some(*x)),
            (Self::Numbers(numbers), Cell::Text(text)) if !text.is_empty() => numbers.push(Some(number(text)?)),
            (Self::Numbers(numbers), _) => numbers.push(None),
            (Self::Texts(texts), Cell::Text(text)) if !text.is_empty() => {
                // Most names are those of the row before, whose bytes are shared.
                let same = texts.values.last().filter(|last| last.data() == text.as_bytes());
                let value = same.cloned().unwrap_or_else(|| ByteArray::from(*text));
                texts.push(Some(value));
            }
            (Self::Texts(texts), cell) => texts.push(cell.text().map(|text| ByteArray::from(text.as_str()))),
        }
        Ok(())
    }

    /// Settles whether the column holds texts: one of names, or with a cell that is no number.
    fn settle(&mut self, name: &str) -> Result<(), String> {
        let Self::Open(cells) = self else {
            return Ok(());
        };
        let cells = std::mem::take(cells);
        let is_text = NAMES.contains(&name) || cells.iter().flatten().any(|text| number(text).is_err());
        if is_text {
            let mut texts = Filled::gaps(0);
            for cell in cells {
                texts.push(cell.map(|text| ByteArray::from(text.as_str())));
            }
            *self = Self::Texts(texts);
        } else {
            let mut numbers = Filled::gaps(0);
            for cell in cells {
                numbers.push(cell.map(|text| number(&text)).transpose()?);
            }
            *self = Self::Numbers(numbers);
        }
        Ok(())
    }
}

fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("`{text}` is no number"))
}

impl<W: Write + Send> ParquetTable<W> {
    /// A table with its columns.
    pub fn new(header: &[String], to: W) -> Self {
        let column = |name: &String| {
            if NAMES.contains(&name.as_str()) {
                Column::Texts(Filled::gaps(0))
            } else {
                Column::Open(Vec::new())
            }
        };
        Self {
            header: header.to_vec(),
            columns: header.iter().map(column).collect(),
            rows: 0,
            state: State::Waiting(Some(to)),
        }
    }

    /// Adds rows, whose cells follow each other.
    ///
    /// # Errors
    /// A text in a column that held numbers before; rows of another length than the header.
    pub fn push(&mut self, rows: &[Cell<'_>]) -> Result<(), String> {
        let width = self.columns.len();
        if !rows.len().is_multiple_of(width.max(1)) {
            return Err("bug: rows of another length than the header".to_owned());
        }
        for (place, column) in self.columns.iter_mut().enumerate() {
            column.push_all(rows.iter().skip(place).step_by(width))?;
        }
        self.rows += rows.len() / width.max(1);
        Ok(())
    }

    /// Writes the rows so far, if they make a group. To be called after all rows that came at once: threads that pack columns are
    /// then not taken from those that make the rows.
    ///
    /// # Errors
    /// What the writer says.
    pub fn pause(&mut self) -> Result<(), String> {
        if self.rows < GROUP { Ok(()) } else { self.group() }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// As [`ParquetTable::pause`].
    pub fn finish(mut self) -> Result<(), String> {
        self.group()?;
        match self.state {
            State::Begun(writer) => (*writer).close().map(|_| ()).map_err(|e| e.to_string()),
            State::Waiting(_) => Ok(()),
        }
    }

    fn group(&mut self) -> Result<(), String> {
        self.rows = 0;
        if let State::Waiting(to) = &mut self.state {
            for (column, name) in self.columns.iter_mut().zip(&self.header) {
                column.settle(name)?;
            }
            let to = to.take().ok_or("the file was begun twice")?;
            let writer = begun(&self.header, &self.columns, to).map_err(|e| e.to_string())?;
            self.state = State::Begun(Box::new(writer));
        }
        match &mut self.state {
            State::Begun(writer) => written(writer, &mut self.columns).map_err(|e| e.to_string()),
            State::Waiting(_) => Ok(()),
        }
    }
}

fn begun<W: Write + Send>(
    header: &[String],
    columns: &[Column],
    to: W,
) -> Result<SerializedFileWriter<W>, ParquetError> {
    let fields = header.iter().zip(columns).map(|(name, column)| {
        let field = match column {
            Column::Numbers(_) => Type::primitive_type_builder(name, Physical::DOUBLE),
            Column::Open(_) | Column::Texts(_) => {
                Type::primitive_type_builder(name, Physical::BYTE_ARRAY).with_logical_type(Some(LogicalType::String))
            }
        };
        field.with_repetition(Repetition::OPTIONAL).build().map(Arc::new)
    });
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("results").with_fields(fields).build()?;
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(concat!("gearloss ", env!("CARGO_PKG_VERSION")).to_owned());
    for (name, column) in header.iter().zip(columns) {
        if matches!(column, Column::Numbers(_)) && !REPEATED.contains(&name.as_str()) {
            properties = properties.set_column_dictionary_enabled(ColumnPath::from(vec![name.clone()]), false);
        }
    }
    SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties.build()))
}

/// Writes the present group, whose columns are packed side by side.
fn written<W: Write + Send>(writer: &mut SerializedFileWriter<W>, columns: &mut [Column]) -> Result<(), ParquetError> {
    let (schema, properties) = (writer.schema_descr().columns(), writer.properties());
    let packed: Vec<(Bytes, ColumnCloseResult)> = columns
        .par_iter_mut()
        .zip(schema)
        .map(|(column, description)| packed(column, description, properties))
        .collect::<Result<_, _>>()?;
    let mut group = writer.next_row_group()?;
    for (bytes, end) in packed {
        group.append_column(&bytes, end)?;
    }
    group.close().map(|_| ())
}

/// The bytes of one column of a group, which is emptied.
fn packed(
    column: &mut Column,
    description: &ColumnDescPtr,
    properties: &WriterPropertiesPtr,
) -> Result<(Bytes, ColumnCloseResult), ParquetError> {
    let mut bytes = TrackedWrite::new(Vec::new());
    let pages = Box::new(SerializedPageWriter::new(&mut bytes));
    let mut writer = get_column_writer(description.clone(), properties.clone(), pages);
    match (&mut writer, column) {
        (ColumnWriter::DoubleColumnWriter(to), Column::Numbers(own)) => {
            to.write_batch(&own.values, Some(&own.levels), None)?;
            own.clear();
        }
        (ColumnWriter::ByteArrayColumnWriter(to), Column::Texts(own)) => {
            to.write_batch(&own.values, Some(&own.levels), None)?;
            own.clear();
        }
        _ => return Err(ParquetError::General("a column of another kind".to_owned())),
    }
    let end = writer.close()?;
    Ok((bytes.into_inner()?.into(), end))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    use super::*;

    fn texts(row: &[String]) -> Vec<Cell<'_>> {
        row.iter().map(|text| Cell::Text(text)).collect()
    }

    fn parquet(header: &[String], rows: &[Vec<String>]) -> Vec<u8> {
        let path = std::env::temp_dir().join(format!("gearloss-parquet-{}-{}", std::process::id(), rows.len()));
        let mut table = ParquetTable::new(header, std::fs::File::create(&path).unwrap());
        for row in rows {
            table.push(&texts(row)).unwrap();
            table.pause().unwrap();
        }
        table.finish().unwrap();
        std::fs::read(path).unwrap()
    }

    #[test]
    fn every_cell_comes_back_with_all_its_digits() {
        let header = ["name", "torque_nm", "loss_w"].map(str::to_owned);
        let rows = [
            ["1", "3.6", "0.1"],
            ["2", "", "1e-300"],
            ["", "7", "0.30000000000000004"],
        ];
        let rows: Vec<Vec<String>> = rows.iter().map(|r| r.map(str::to_owned).to_vec()).collect();
        let bytes = Bytes::from(parquet(&header, &rows));
        let read: Vec<_> = SerializedFileReader::new(bytes)
            .unwrap()
            .get_row_iter(None)
            .unwrap()
            .map(Result::unwrap)
            .collect();
        assert_eq!(read.len(), 3);
        assert_eq!(read[0].get_string(0).unwrap(), "1");
        assert_eq!(read[0].get_double(1).unwrap(), 3.6);
        assert!(read[1].get_double(1).is_err(), "a gap stays a gap");
        assert_eq!(read[2].get_double(2).unwrap(), 0.1 + 0.2);
        assert!(read[2].get_string(0).is_err());
    }

    #[test]
    fn numbers_and_texts_of_numbers_make_the_same_column() {
        let path = std::env::temp_dir().join(format!("gearloss-parquet-{}-cells", std::process::id()));
        let header = ["gear", "loss_w", "bound"].map(str::to_owned);
        let mut table = ParquetTable::new(&header, std::fs::File::create(&path).unwrap());
        for row in [
            [Cell::Text("1"), Cell::Gap, Cell::Text("5")],
            [Cell::Text("1"), Cell::Number(0.1 + 0.2), Cell::Text("5 mm2/s")],
            [Cell::Gap, Cell::Text("2.50"), Cell::Number(3.0)],
        ] {
            table.push(&row).unwrap();
        }
        table.finish().unwrap();
        let reader = SerializedFileReader::new(std::fs::File::open(path).unwrap()).unwrap();
        let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert!(rows[0].get_double(1).is_err() && rows[2].get_string(0).is_err());
        assert_eq!(rows[1].get_double(1).unwrap(), 0.1 + 0.2);
        assert_eq!(rows[2].get_double(1).unwrap(), 2.5);
        let bound: Vec<&String> = rows.iter().map(|row| row.get_string(2).unwrap()).collect();
        assert_eq!(bound, ["5", "5 mm2/s", "3"]);
    }

    #[test]
    fn a_table_without_rows_is_a_file() {
        assert!(!parquet(&["torque_nm".to_owned()], &[]).is_empty());
    }

    #[test]
    fn groups_of_rows_make_one_table_and_a_late_text_is_refused() {
        let rows: Vec<Vec<String>> = (0..GROUP + 3).map(|i| vec![i.to_string()]).collect();
        let bytes = Bytes::from(parquet(&["loss_w".to_owned()], &rows));
        let reader = SerializedFileReader::new(bytes).unwrap();
        assert_eq!(
            (reader.num_row_groups(), reader.metadata().file_metadata().num_rows()),
            (2, i64::try_from(GROUP + 3).unwrap())
        );
        let mut table = ParquetTable::new(&["loss_w".to_owned()], Vec::new());
        for row in &rows[..GROUP] {
            table.push(&texts(row)).unwrap();
        }
        table.pause().unwrap();
        let late = table.push(&[Cell::Text("none")]);
        assert!(late.unwrap_err().contains("`none` is no number"));
    }
}
