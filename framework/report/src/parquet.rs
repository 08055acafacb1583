//! Tables as Parquet: numbers as nullable doubles, texts as nullable strings. Not in WebAssembly.

use std::io::Write;
use std::ops::Range;
use std::sync::Arc;

use gearloss_studies::table::{Column, Table, Values};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnPath, Type};

/// A table that is written in batches of rows.
pub struct ParquetTable<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    /// Rows of the incomplete row group, by column.
    waiting: Vec<Cells>,
    count: usize,
}

/// Number of rows of a row group.
const GROUP: usize = 32_768;

/// Number columns with so many repeated values that a dictionary saves space.
const REPEATED: [&str; 3] = ["torque_nm", "speed_rpm", "oil_temperature_degc"];

/// Cells of a column; gaps are not among the values, and have the level 0.
enum Cells {
    Numbers(Vec<f64>, Vec<i16>),
    Texts(Vec<ByteArray>, Vec<i16>),
}

impl<W: Write + Send> ParquetTable<W> {
    /// Writes the schema of the columns.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn new(to: W, header: &Table) -> Result<Self, ParquetError> {
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(concat!("gearloss ", env!("CARGO_PKG_VERSION")).to_owned());
        let mut fields = Vec::new();
        let mut waiting = Vec::new();
        for Column { name, values, .. } in &header.columns {
            let (kind, logical, cells) = match values {
                Values::Texts(_) => (
                    Physical::BYTE_ARRAY,
                    Some(LogicalType::String),
                    Cells::Texts(Vec::new(), Vec::new()),
                ),
                Values::Numbers(_) => (Physical::DOUBLE, None, Cells::Numbers(Vec::new(), Vec::new())),
            };
            if kind == Physical::DOUBLE && !REPEATED.contains(&name.as_str()) {
                properties = properties.set_column_dictionary_enabled(ColumnPath::from(vec![name.clone()]), false);
            }
            let field = Type::primitive_type_builder(name, kind)
                .with_repetition(Repetition::OPTIONAL)
                .with_logical_type(logical);
            fields.push(Arc::new(field.build()?));
            waiting.push(cells);
        }
        let schema = Type::group_type_builder("results").with_fields(fields).build()?;
        Ok(Self {
            writer: SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties.build()))?,
            waiting,
            count: 0,
        })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn rows(&mut self, rows: &Table) -> Result<(), ParquetError> {
        let mut at = 0;
        while at < rows.len() {
            let some = at..rows.len().min(at + GROUP - self.count);
            for (cells, column) in self.waiting.iter_mut().zip(&rows.columns) {
                cells.add(&column.values, some.clone())?;
            }
            self.count += some.len();
            at = some.end;
            if self.count == GROUP {
                self.end_group()?;
            }
        }
        Ok(())
    }

    /// Writes the rows that wait.
    fn end_group(&mut self) -> Result<(), ParquetError> {
        self.count = 0;
        let mut group = self.writer.next_row_group()?;
        for cells in &mut self.waiting {
            match cells {
                Cells::Numbers(values, levels) => column::<DoubleType, _>(&mut group, values, levels)?,
                Cells::Texts(values, levels) => column::<ByteArrayType, _>(&mut group, values, levels)?,
            }
        }
        group.close().map(|_| ())
    }

    /// Completes the table.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn finish(mut self) -> Result<(), ParquetError> {
        if self.count > 0 {
            self.end_group()?;
        }
        self.writer.close().map(|_| ())
    }
}

impl Cells {
    fn add(&mut self, column: &Values, rows: Range<usize>) -> Result<(), ParquetError> {
        match (self, column) {
            (Self::Numbers(values, levels), Values::Numbers(numbers)) => {
                let numbers = &numbers[rows];
                values.extend(numbers.iter().filter(|x| !x.is_nan()));
                levels.extend(numbers.iter().map(|x| i16::from(!x.is_nan())));
            }
            (Self::Texts(values, levels), Values::Texts(texts)) => {
                // The cells of one text share its bytes.
                let kinds: Vec<ByteArray> = texts.kinds().map(ByteArray::from).collect();
                let codes = &texts.codes()[rows];
                values.extend(codes.iter().flatten().map(|code| kinds[*code as usize].clone()));
                levels.extend(codes.iter().map(|code| i16::from(code.is_some())));
            }
            _ => {
                return Err(ParquetError::General(
                    "a column of another kind than in the header".to_owned(),
                ));
            }
        }
        Ok(())
    }
}

/// Writes the next column of a row group, and empties its cells.
fn column<T: DataType, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &mut Vec<T::T>,
    levels: &mut Vec<i16>,
) -> Result<(), ParquetError> {
    let mut writer = group
        .next_column()?
        .ok_or_else(|| ParquetError::General("a column more than the schema has".to_owned()))?;
    writer.typed::<T>().write_batch(values, Some(levels), None)?;
    values.clear();
    levels.clear();
    writer.close()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use bytes::Bytes;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    use super::*;

    #[test]
    fn every_cell_comes_back_with_all_its_digits() {
        let rows = [("1", Some(3.6), 0.1), ("2", None, 1e-300), ("", Some(7.0), 0.1 + 0.2)];
        let table = Table::of("t", rows)
            .text("name", "Name", |row| row.0)
            .number("torque_nm", "Nm", "Torque", |row| row.1)
            .number("loss_w", "W", "Loss", |row| row.2)
            .finish();
        let mut bytes = Vec::new();
        let mut file = ParquetTable::new(&mut bytes, &table).unwrap();
        file.rows(&table).unwrap();
        file.end_group().unwrap();
        file.rows(&table.header()).unwrap();
        file.rows(&table).unwrap();
        file.finish().unwrap();
        let reader = SerializedFileReader::new(Bytes::from(bytes)).unwrap();
        assert_eq!(reader.num_row_groups(), 2);
        let read: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(read.len(), 6);
        assert_eq!(read[0].get_string(0).unwrap(), "1");
        assert_eq!(read[3].get_double(1).unwrap(), 3.6);
        assert!(read[1].get_double(1).is_err(), "a gap stays a gap");
        assert_eq!(read[4].get_double(2).unwrap(), 1e-300);
        assert_eq!(read[5].get_double(2).unwrap(), 0.1 + 0.2);
        assert!(read[2].get_string(0).is_err());
    }

    #[test]
    fn a_table_without_rows_is_a_file() {
        let table = Table::of("t", [])
            .number("torque_nm", "Nm", "Torque", |x: &f64| *x)
            .finish();
        let mut bytes = Vec::new();
        ParquetTable::new(&mut bytes, &table).unwrap().finish().unwrap();
        let reader = SerializedFileReader::new(Bytes::from(bytes)).unwrap();
        assert_eq!(reader.metadata().file_metadata().num_rows(), 0);
    }
}
