//! Tables as Parquet: numbers as nullable doubles, texts as strings.

use std::io::Write;
use std::sync::Arc;

use bytes::Bytes;
use gearloss_studies::table::{Column, Table, Values};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::column::writer::{ColumnCloseResult, ColumnWriter, get_column_writer};
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use parquet::schema::types::{ColumnDescPtr, ColumnPath, Type, TypePtr};
use rayon::prelude::*;

/// A table that is written in batches of rows.
pub struct ParquetTable<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    /// Rows of the incomplete row group.
    rows: Table,
}

/// Minimum number of rows of a row group except the last.
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
            .set_created_by(concat!("gearloss ", env!("CARGO_PKG_VERSION")).to_owned());
        let mut fields: Vec<TypePtr> = Vec::new();
        for Column { name, values, .. } in &header.columns {
            let field = match values {
                Values::Texts(_) => Type::primitive_type_builder(name, Physical::BYTE_ARRAY)
                    .with_logical_type(Some(LogicalType::String)),
                Values::Numbers(_) => Type::primitive_type_builder(name, Physical::DOUBLE),
            };
            if matches!(values, Values::Numbers(_)) && !REPEATED.contains(&name.as_str()) {
                properties = properties.set_column_dictionary_enabled(ColumnPath::from(vec![name.clone()]), false);
            }
            fields.push(Arc::new(field.with_repetition(Repetition::OPTIONAL).build()?));
        }
        let schema = Type::group_type_builder("results").with_fields(fields).build()?;
        let writer = SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties.build()))?;
        Ok(Self {
            writer,
            rows: header.header(),
        })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn rows(&mut self, rows: &Table) -> Result<(), ParquetError> {
        self.rows.extend(std::slice::from_ref(rows), &[(0, 0..rows.len())]);
        if self.rows.len() < GROUP {
            return Ok(());
        }
        self.group()
    }

    /// Writes the collected rows as a row group; columns are compressed in parallel.
    fn group(&mut self) -> Result<(), ParquetError> {
        let header = self.rows.header();
        let rows = std::mem::replace(&mut self.rows, header);
        if rows.is_empty() {
            return Ok(());
        }
        let descriptions = self.writer.schema_descr().columns().to_vec();
        let properties = self.writer.properties().clone();
        let pack = |(column, description)| packed(column, description, &properties);
        let columns = rows.columns.par_iter().zip(&descriptions).with_max_len(1);
        let all: Vec<(Bytes, ColumnCloseResult)> = columns.map(pack).collect::<Result<_, _>>()?;
        let mut group = self.writer.next_row_group()?;
        for (bytes, end) in all {
            group.append_column(&bytes, end)?;
        }
        group.close().map(|_| ())
    }

    /// Completes the table.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn finish(mut self) -> Result<(), ParquetError> {
        self.group()?;
        self.writer.close().map(|_| ())
    }
}

/// The bytes of a column of a row group.
fn packed(
    column: &Column,
    description: &ColumnDescPtr,
    properties: &WriterPropertiesPtr,
) -> Result<(Bytes, ColumnCloseResult), ParquetError> {
    let mut bytes = TrackedWrite::new(Vec::with_capacity(column.len() * size_of::<f64>()));
    let pages = Box::new(SerializedPageWriter::new(&mut bytes));
    let mut writer = get_column_writer(description.clone(), properties.clone(), pages);
    match (&mut writer, &column.values) {
        (ColumnWriter::DoubleColumnWriter(to), Values::Numbers(numbers)) => {
            let levels: Vec<i16> = numbers.iter().map(|x| i16::from(!x.is_nan())).collect();
            if levels.contains(&0) {
                let known: Vec<f64> = numbers.iter().copied().filter(|x| !x.is_nan()).collect();
                to.write_batch(&known, Some(&levels), None)?;
            } else {
                to.write_batch(numbers, Some(&levels), None)?;
            }
        }
        (ColumnWriter::ByteArrayColumnWriter(to), Values::Texts(texts)) => {
            let kinds: Vec<ByteArray> = texts
                .kinds()
                .iter()
                .map(|kind| ByteArray::from(kind.as_str()))
                .collect();
            let levels: Vec<i16> = texts.codes().iter().map(|code| i16::from(code.is_some())).collect();
            let known: Vec<ByteArray> = texts
                .codes()
                .iter()
                .flatten()
                .map(|code| kinds[*code as usize].clone())
                .collect();
            to.write_batch(&known, Some(&levels), None)?;
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
        file.group().unwrap();
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
