//! Tables as Parquet: numbers as nullable doubles, texts as strings. Not in WebAssembly.

use std::io::Write;
use std::sync::Arc;

use arrow_array::types::UInt32Type;
use arrow_array::{ArrayRef, DictionaryArray, Float64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use gearloss_studies::table::{Column, Table, Values};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_writer::ArrowWriterOptions;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::schema::types::ColumnPath;

/// A table that is written in batches of rows.
pub struct ParquetTable<W: Write + Send> {
    writer: ArrowWriter<W>,
    schema: SchemaRef,
}

/// Number of rows of a row group; those of the incomplete one are in memory in packed form.
const GROUP: usize = 32_768;

/// Number columns with so many repeated values that a dictionary saves space.
const REPEATED: [&str; 3] = ["torque_nm", "speed_rpm", "oil_temperature_degc"];

impl<W: Write + Send> ParquetTable<W> {
    /// Writes the schema of the columns.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn new(to: W, header: &Table) -> Result<Self, ParquetError> {
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_max_row_group_row_count(Some(GROUP))
            .set_created_by(concat!("gearloss ", env!("CARGO_PKG_VERSION")).to_owned());
        let mut fields = Vec::new();
        for Column { name, values, .. } in &header.columns {
            let kind = match values {
                Values::Texts(_) => DataType::Dictionary(Box::new(DataType::UInt32), Box::new(DataType::Utf8)),
                Values::Numbers(_) => DataType::Float64,
            };
            if kind == DataType::Float64 && !REPEATED.contains(&name.as_str()) {
                properties = properties.set_column_dictionary_enabled(ColumnPath::from(vec![name.clone()]), false);
            }
            fields.push(Field::new(name, kind, true));
        }
        let schema = Arc::new(Schema::new(fields));
        // Without the schema of Arrow, in which texts are codes of a dictionary: for every reader they are strings.
        let options = ArrowWriterOptions::new()
            .with_properties(properties.build())
            .with_skip_arrow_metadata(true)
            .with_schema_root("results".to_owned());
        let writer = ArrowWriter::try_new_with_options(to, Arc::clone(&schema), options)?;
        Ok(Self { writer, schema })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn rows(&mut self, rows: &Table) -> Result<(), ParquetError> {
        let columns = rows.columns.iter().map(|column| array(&column.values)).collect();
        self.writer
            .write(&RecordBatch::try_new(Arc::clone(&self.schema), columns)?)
    }

    /// Completes the table.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn finish(self) -> Result<(), ParquetError> {
        self.writer.close().map(|_| ())
    }
}

/// The values of a column; gaps are nulls.
fn array(values: &Values) -> ArrayRef {
    match values {
        Values::Numbers(numbers) => {
            let known = numbers.iter().map(|x| Some(*x).filter(|x| !x.is_nan()));
            Arc::new(known.collect::<Float64Array>())
        }
        Values::Texts(texts) => {
            let kinds = StringArray::from_iter_values(texts.kinds());
            let codes = texts.codes().iter().copied().collect();
            Arc::new(DictionaryArray::<UInt32Type>::new(codes, Arc::new(kinds)))
        }
    }
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
        file.writer.flush().unwrap();
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
