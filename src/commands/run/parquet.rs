//! Tables as Parquet: the columns of the CSV, numbers as double precision with gaps, everything else as text.

use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

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

/// The bytes of a file.
///
/// # Errors
/// What the writer says.
pub fn parquet(header: &[String], rows: &[Vec<String>]) -> Result<Vec<u8>, String> {
    written(header, rows).map_err(|e| e.to_string())
}

fn written(header: &[String], rows: &[Vec<String>]) -> Result<Vec<u8>, ParquetError> {
    let texts: Vec<bool> = (0..header.len()).map(|i| is_text(&header[i], i, rows)).collect();
    let fields = header.iter().zip(&texts).map(|(name, text)| {
        let field = if *text {
            Type::primitive_type_builder(name, Physical::BYTE_ARRAY).with_logical_type(Some(LogicalType::String))
        } else {
            Type::primitive_type_builder(name, Physical::DOUBLE)
        };
        field.with_repetition(Repetition::OPTIONAL).build().map(Arc::new)
    });
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("results").with_fields(fields).build()?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(concat!("gearloss ", env!("CARGO_PKG_VERSION")).to_owned())
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (i, text) in texts.iter().enumerate() {
        let cells = || rows.iter().map(|row| row[i].as_str());
        // A gap is a cell without a value; level one stands for a value.
        let levels: Vec<i16> = cells().map(|cell| i16::from(!cell.is_empty())).collect();
        let Some(mut column) = group.next_column()? else { break };
        if *text {
            let values: Vec<ByteArray> = cells().filter(|c| !c.is_empty()).map(ByteArray::from).collect();
            column
                .typed::<ByteArrayType>()
                .write_batch(&values, Some(&levels), None)?;
        } else {
            let values: Vec<f64> = cells().filter_map(|c| c.parse().ok()).collect();
            column.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
        }
        column.close()?;
    }
    group.close()?;
    writer.into_inner()
}

/// True for a column of names, and for one with a cell that is no number.
fn is_text(name: &str, column: usize, rows: &[Vec<String>]) -> bool {
    NAMES.contains(&name)
        || rows
            .iter()
            .any(|row| !row[column].is_empty() && row[column].parse::<f64>().is_err())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    use super::*;

    #[test]
    fn every_cell_comes_back_with_all_its_digits() {
        let header = ["name", "torque_nm", "loss_w"].map(str::to_owned);
        let rows = [
            ["1", "3.6", "0.1"],
            ["2", "", "1e-300"],
            ["", "7", "0.30000000000000004"],
        ];
        let rows: Vec<Vec<String>> = rows.iter().map(|r| r.map(str::to_owned).to_vec()).collect();
        let bytes = bytes::Bytes::from(parquet(&header, &rows).unwrap());
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
    fn a_table_without_rows_is_a_file() {
        assert!(parquet(&["torque_nm".to_owned()], &[]).is_ok());
    }
}
