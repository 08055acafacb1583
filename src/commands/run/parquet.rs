//! Tables as Parquet: the columns of the CSV, numbers as double precision with gaps, everything else as text.

use std::io::Write;
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

/// Rows of one row group.
const GROUP: usize = 65_536;

/// A table that is written in groups of rows.
pub struct ParquetTable<W: Write + Send> {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    state: State<W>,
}

/// Which columns are texts is told by the first group.
enum State<W: Write + Send> {
    Waiting(Option<W>),
    Begun(Box<SerializedFileWriter<W>>, Vec<bool>),
}

impl<W: Write + Send> ParquetTable<W> {
    /// A table with its columns.
    pub fn new(header: &[String], to: W) -> Self {
        Self {
            header: header.to_vec(),
            rows: Vec::new(),
            state: State::Waiting(Some(to)),
        }
    }

    /// Adds a row.
    ///
    /// # Errors
    /// What the writer says; a text in a column that held numbers before.
    pub fn push(&mut self, row: &[String]) -> Result<(), String> {
        self.rows.push(row.to_vec());
        if self.rows.len() < GROUP {
            return Ok(());
        }
        self.group()
    }

    /// Ends the file.
    ///
    /// # Errors
    /// As [`ParquetTable::push`].
    pub fn finish(mut self) -> Result<(), String> {
        self.group()?;
        match self.state {
            State::Begun(writer, _) => (*writer).close().map(|_| ()).map_err(|e| e.to_string()),
            State::Waiting(_) => Ok(()),
        }
    }

    fn group(&mut self) -> Result<(), String> {
        let rows = std::mem::take(&mut self.rows);
        if let State::Waiting(to) = &mut self.state {
            let texts: Vec<bool> = (0..self.header.len())
                .map(|i| is_text(&self.header[i], i, &rows))
                .collect();
            let to = to.take().ok_or("the file was begun twice")?;
            let writer = begun(&self.header, &texts, to).map_err(|e| e.to_string())?;
            self.state = State::Begun(Box::new(writer), texts);
        }
        match &mut self.state {
            State::Begun(writer, texts) => written(writer, texts, &rows).map_err(|e| e.to_string()),
            State::Waiting(_) => Ok(()),
        }
    }
}

fn begun<W: Write + Send>(header: &[String], texts: &[bool], to: W) -> Result<SerializedFileWriter<W>, ParquetError> {
    let fields = header.iter().zip(texts).map(|(name, text)| {
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
    SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties))
}

fn written<W: Write + Send>(
    writer: &mut SerializedFileWriter<W>,
    texts: &[bool],
    rows: &[Vec<String>],
) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    for (i, text) in texts.iter().enumerate() {
        let cells = || rows.iter().map(|row| row[i].as_str()).filter(|c| !c.is_empty());
        // A gap is a cell without a value; level one stands for a value.
        let levels: Vec<i16> = rows.iter().map(|row| i16::from(!row[i].is_empty())).collect();
        let Some(mut column) = group.next_column()? else { break };
        if *text {
            let values: Vec<ByteArray> = cells().map(ByteArray::from).collect();
            column
                .typed::<ByteArrayType>()
                .write_batch(&values, Some(&levels), None)?;
        } else {
            let number = |c: &str| {
                c.parse()
                    .map_err(|_| ParquetError::General(format!("`{c}` is no number")))
            };
            let values = cells().map(number).collect::<Result<Vec<f64>, _>>()?;
            column.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
        }
        column.close()?;
    }
    group.close().map(|_| ())
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

    fn parquet(header: &[String], rows: &[Vec<String>]) -> Vec<u8> {
        let path = std::env::temp_dir().join(format!("gearloss-parquet-{}-{}", std::process::id(), rows.len()));
        let mut table = ParquetTable::new(header, std::fs::File::create(&path).unwrap());
        for row in rows {
            table.push(row).unwrap();
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
        let bytes = bytes::Bytes::from(parquet(&header, &rows));
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
        assert!(!parquet(&["torque_nm".to_owned()], &[]).is_empty());
    }

    #[test]
    fn groups_of_rows_make_one_table_and_a_late_text_is_refused() {
        let rows: Vec<Vec<String>> = (0..GROUP + 3).map(|i| vec![i.to_string()]).collect();
        let bytes = bytes::Bytes::from(parquet(&["loss_w".to_owned()], &rows));
        let reader = SerializedFileReader::new(bytes).unwrap();
        assert_eq!(
            (reader.num_row_groups(), reader.metadata().file_metadata().num_rows()),
            (2, i64::try_from(GROUP + 3).unwrap())
        );
        let mut table = ParquetTable::new(&["loss_w".to_owned()], Vec::new());
        for row in &rows[..GROUP] {
            table.push(row).unwrap();
        }
        table.push(&["none".to_owned()]).unwrap();
        assert!(table.finish().unwrap_err().contains("`none` is no number"));
    }
}
