//! Tables as Parquet: the columns of the CSV, numbers as double precision with gaps, everything else as text.

use std::io::Write;
use std::ops::Range;
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

use super::columns::{Column, Columns, number, word};

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
    /// Rows of the present group.
    rows: Vec<Ordered>,
    count: usize,
    state: State<W>,
}

/// Rows that were made together by several, and their order: number of who made them, and which of them follow.
struct Ordered {
    made: Vec<Columns>,
    order: Vec<(usize, Range<usize>)>,
}

/// Whether the file was begun, which needs the kinds of all columns.
enum State<W: Write + Send> {
    Waiting(Option<W>),
    Begun {
        writer: Box<SerializedFileWriter<W>>,
        /// Columns of a group that was packed and is to be written.
        packed: Vec<Packed>,
    },
}

/// Bytes of a column of a group.
type Packed = (Bytes, ColumnCloseResult);

impl<W: Write + Send> ParquetTable<W> {
    /// A table with its columns.
    pub fn new(header: &[String], to: W) -> Self {
        Self {
            header: header.to_vec(),
            rows: Vec::new(),
            count: 0,
            state: State::Waiting(Some(to)),
        }
    }

    /// Adds rows that were made together, in an order.
    ///
    /// # Errors
    /// A text in a column that held numbers before; what the writer says.
    pub fn push(&mut self, made: Vec<Columns>, order: Vec<(usize, Range<usize>)>) -> Result<(), String> {
        self.count += order.iter().map(|(_, own)| own.len()).sum::<usize>();
        self.rows.push(Ordered { made, order });
        if self.count < GROUP { Ok(()) } else { self.group() }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// As [`ParquetTable::push`].
    pub fn finish(mut self) -> Result<(), String> {
        self.group()?;
        match self.state {
            State::Begun { mut writer, packed } => {
                let written = write(&mut writer, packed);
                written
                    .and_then(|()| (*writer).close().map(|_| ()))
                    .map_err(|e| e.to_string())
            }
            State::Waiting(_) => Ok(()),
        }
    }

    /// Packs the rows so far as a group, on all threads, while this one writes the group before.
    fn group(&mut self) -> Result<(), String> {
        self.count = 0;
        let rows = std::mem::take(&mut self.rows);
        if let State::Waiting(to) = &mut self.state {
            let to = to.take().ok_or("the file was begun twice")?;
            let writer = begun(&self.header, &rows, to).map_err(|e| e.to_string())?;
            self.state = State::Begun {
                writer: Box::new(writer),
                packed: Vec::new(),
            };
        }
        if let State::Begun { writer, packed } = &mut self.state {
            let schema = writer.schema_descr().columns().to_vec();
            let properties = writer.properties().clone();
            let before = std::mem::take(packed);
            let columns = schema.par_iter().enumerate().with_max_len(1);
            let pack = || {
                if rows.is_empty() {
                    return Ok(Vec::new());
                }
                let own = |(place, description)| column(&rows, place, description, &properties);
                columns.map(own).collect::<Result<_, _>>()
            };
            let (mut written, mut done) = (Ok(()), Ok(Vec::new()));
            rayon::in_place_scope(|scope| {
                scope.spawn(|_| done = pack());
                written = write(writer, before);
            });
            written.map_err(|e| e.to_string())?;
            *packed = done?;
        }
        Ok(())
    }
}

/// Writes a group that was packed, if one was.
fn write<W: Write + Send>(writer: &mut SerializedFileWriter<W>, packed: Vec<Packed>) -> Result<(), ParquetError> {
    if packed.is_empty() {
        return Ok(());
    }
    let mut group = writer.next_row_group()?;
    for (bytes, end) in packed {
        group.append_column(&bytes, end)?;
    }
    group.close().map(|_| ())
}

/// Whether a column holds texts: one of names, or with a cell that is no number.
fn is_text(name: &str, rows: &[Ordered], place: usize) -> bool {
    let mut columns = rows
        .iter()
        .flat_map(|rows| &rows.made)
        .map(|columns| &columns.all()[place]);
    let texts = |column: &Column| match column {
        Column::Texts(texts) => texts.kinds().any(|text| parsed(text).is_err()),
        Column::Numbers(_) => false,
    };
    NAMES.contains(&name) || columns.any(texts)
}

fn parsed(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("`{text}` is no number"))
}

fn begun<W: Write + Send>(header: &[String], rows: &[Ordered], to: W) -> Result<SerializedFileWriter<W>, ParquetError> {
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(concat!("gearloss ", env!("CARGO_PKG_VERSION")).to_owned());
    let mut fields = Vec::new();
    for (place, name) in header.iter().enumerate() {
        let field = if is_text(name, rows, place) {
            Type::primitive_type_builder(name, Physical::BYTE_ARRAY).with_logical_type(Some(LogicalType::String))
        } else {
            if !REPEATED.contains(&name.as_str()) {
                properties = properties.set_column_dictionary_enabled(ColumnPath::from(vec![name.clone()]), false);
            }
            Type::primitive_type_builder(name, Physical::DOUBLE)
        };
        fields.push(Arc::new(field.with_repetition(Repetition::OPTIONAL).build()?));
    }
    let schema = Type::group_type_builder("results").with_fields(fields).build()?;
    SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties.build()))
}

/// The bytes of one column of a group.
fn column(
    rows: &[Ordered],
    place: usize,
    description: &ColumnDescPtr,
    properties: &WriterPropertiesPtr,
) -> Result<Packed, String> {
    let orders = rows.iter().flat_map(|rows| &rows.order);
    let count: usize = orders.map(|(_, own)| own.len()).sum();
    let mut bytes = TrackedWrite::new(Vec::with_capacity(count * size_of::<f64>()));
    let pages = Box::new(SerializedPageWriter::new(&mut bytes));
    let mut writer = get_column_writer(description.clone(), properties.clone(), pages);
    let runs = rows.iter().flat_map(|rows| {
        let own = |(made, own): &(usize, Range<usize>)| (&rows.made[*made].all()[place], own.clone());
        rows.order.iter().map(own)
    });
    let written = match &mut writer {
        ColumnWriter::DoubleColumnWriter(to) => {
            let cells: Filled<f64> = numbers(count, runs)?;
            to.write_batch(&cells.values, Some(&cells.levels), None)
        }
        ColumnWriter::ByteArrayColumnWriter(to) => {
            let cells: Filled<ByteArray> = texts(count, runs);
            to.write_batch(&cells.values, Some(&cells.levels), None)
        }
        _ => Err(ParquetError::General("a column of another kind".to_owned())),
    };
    let end = written.and_then(|_| writer.close()).map_err(|e| e.to_string())?;
    let bytes = bytes.into_inner().map_err(|e| e.to_string())?;
    Ok((bytes.into(), end))
}

/// Values, and for each cell one where it has a value.
struct Filled<T> {
    values: Vec<T>,
    levels: Vec<i16>,
}

impl<T> Filled<T> {
    /// None yet of so many cells.
    fn new(count: usize) -> Self {
        Self {
            values: Vec::with_capacity(count),
            levels: Vec::with_capacity(count),
        }
    }

    fn push(&mut self, value: Option<T>) {
        self.levels.push(i16::from(value.is_some()));
        self.values.extend(value);
    }
}

/// Cells of a column as numbers.
fn numbers<'r>(count: usize, runs: impl Iterator<Item = (&'r Column, Range<usize>)>) -> Result<Filled<f64>, String> {
    let mut cells = Filled::new(count);
    for (column, own) in runs {
        match column {
            Column::Numbers(numbers) => {
                let own = &numbers[own];
                if own.iter().filter(|x| x.is_nan()).count() == 0 {
                    cells.values.extend_from_slice(own);
                    cells.levels.resize(cells.levels.len() + own.len(), 1);
                } else {
                    for x in own {
                        cells.push(number(*x));
                    }
                }
            }
            Column::Texts(texts) => {
                for text in texts.cells(own) {
                    cells.push(text.map(|text| parsed(word(text))).transpose()?);
                }
            }
        }
    }
    Ok(cells)
}

/// Cells of a column as texts.
fn texts<'r>(count: usize, runs: impl Iterator<Item = (&'r Column, Range<usize>)>) -> Filled<ByteArray> {
    let mut cells = Filled::new(count);
    for (column, own) in runs {
        match column {
            Column::Numbers(numbers) => {
                let text = |x: f64| ByteArray::from(x.to_string().as_str());
                numbers[own].iter().for_each(|x| cells.push(number(*x).map(text)));
            }
            Column::Texts(texts) => texts.cells(own).for_each(|text| cells.push(text.cloned())),
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    use super::*;

    #[derive(Clone, Copy)]
    enum Cell<'a> {
        Gap,
        Number(f64),
        Text(&'a str),
    }

    fn add(columns: &mut Columns, row: &[Cell<'_>]) {
        for cell in row {
            match cell {
                Cell::Gap => columns.numbers([None].into_iter()),
                Cell::Number(x) => columns.numbers([Some(*x)].into_iter()),
                Cell::Text(text) => columns.texts([*text].into_iter()),
            }
        }
        columns.end(row.len()).unwrap();
    }

    fn push<W: Write + Send>(table: &mut ParquetTable<W>, rows: &[Vec<Cell<'_>>]) -> Result<(), String> {
        let mut columns = Columns::new(rows.len());
        for row in rows {
            add(&mut columns, row);
        }
        table.push(vec![columns], vec![(0, 0..rows.len())])
    }

    fn texts(row: &[String]) -> Vec<Cell<'_>> {
        row.iter().map(|text| Cell::Text(text)).collect()
    }

    fn parquet(header: &[String], rows: &[Vec<String>]) -> Vec<u8> {
        let path = std::env::temp_dir().join(format!("gearloss-parquet-{}-{}", std::process::id(), rows.len()));
        let mut table = ParquetTable::new(header, std::fs::File::create(&path).unwrap());
        for row in rows {
            push(&mut table, &[texts(row)]).unwrap();
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
            push(&mut table, &[row.to_vec()]).unwrap();
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
        let bytes = Bytes::from(parquet(&["torque_nm".to_owned()], &[]));
        let reader = SerializedFileReader::new(bytes).unwrap();
        assert_eq!(reader.metadata().file_metadata().num_rows(), 0);
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
        let group: Vec<Vec<Cell<'_>>> = rows[..GROUP].iter().map(|row| texts(row)).collect();
        push(&mut table, &group).unwrap();
        push(&mut table, &[vec![Cell::Text("none")]]).unwrap();
        let late = table.finish();
        assert!(late.unwrap_err().contains("`none` is no number"));
    }

    #[test]
    fn rows_of_several_makers_stand_in_their_order_in_every_group() {
        let header = ["gear", "loss_w", "bound"].map(str::to_owned);
        let path = std::env::temp_dir().join(format!("gearloss-parquet-{}-order", std::process::id()));
        let mut table = ParquetTable::new(&header, std::fs::File::create(&path).unwrap());
        let names: Vec<String> = (0..2 * GROUP).map(|i| format!("gear {}", i % 3)).collect();
        for half in 0..2 {
            // Two makers have every other pair of rows; one in five has no loss.
            let mut made = vec![Columns::new(GROUP), Columns::new(GROUP)];
            let mut order = Vec::new();
            let mut done = [0; 2];
            for i in (0..GROUP).step_by(2) {
                let maker = (i / 2) % 2;
                for row in [half * GROUP + i, half * GROUP + i + 1] {
                    let loss = if row % 5 == 0 {
                        Cell::Gap
                    } else {
                        Cell::Number(row as f64)
                    };
                    add(&mut made[maker], &[Cell::Text(&names[row]), loss, Cell::Gap]);
                }
                order.push((maker, done[maker]..done[maker] + 2));
                done[maker] += 2;
            }
            table.push(made, order).unwrap();
        }
        table.finish().unwrap();
        let reader = SerializedFileReader::new(std::fs::File::open(path).unwrap()).unwrap();
        assert_eq!(reader.num_row_groups(), 2);
        let mut count = 0;
        for (i, row) in reader.get_row_iter(None).unwrap().map(Result::unwrap).enumerate() {
            assert_eq!(row.get_string(0).unwrap(), &names[i]);
            assert_eq!(row.get_double(1).ok(), (i % 5 != 0).then_some(i as f64));
            assert!(row.get_double(2).is_err());
            count += 1;
        }
        assert_eq!(count, 2 * GROUP);
    }
}
