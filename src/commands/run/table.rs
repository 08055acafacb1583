//! Tables of results as files.

use std::fs;
use std::io::{self, BufWriter};
use std::sync::{Mutex, PoisonError};

use gearloss_report::csv::CsvTable;
use gearloss_report::parquet::ParquetTable;
use gearloss_report::xlsx::MOST_ROWS;
use gearloss_studies::analyses::Stopped;
use gearloss_studies::study::Write;
use gearloss_studies::table::{RowSink, Table};
use gearloss_studies::tasks::StorageError;

use super::result_files::{Files, Place};

/// A table that is written in batches of rows.
pub struct TableFiles {
    csv: Option<(Place, CsvTable<BufWriter<fs::File>>)>,
    parquet: Option<(Place, ParquetTable<BufWriter<fs::File>>)>,
    /// All rows for a workbook.
    whole: Option<Table>,
}

impl TableFiles {
    /// The files of a table in the requested formats.
    pub fn new(files: &Files, formats: &[Write], header: &Table) -> Result<Self, StorageError> {
        let mut table = Self {
            csv: None,
            parquet: None,
            whole: formats.contains(&Write::Xlsx).then(|| header.header()),
        };
        if formats.contains(&Write::Csv) {
            let (place, file) = Place::new(files, &format!("{}.csv", header.name))?;
            let csv = CsvTable::new(file, header).map_err(|e| place.cannot_write(e))?;
            table.csv = Some((place, csv));
        }
        if formats.contains(&Write::Parquet) {
            let (place, file) = Place::new(files, &format!("{}.parquet", header.name))?;
            let parquet = ParquetTable::new(file, header).map_err(|e| place.cannot_write(e))?;
            table.parquet = Some((place, parquet));
        }
        Ok(table)
    }

    /// Adds rows.
    pub fn rows(&mut self, rows: &Table) -> Result<(), StorageError> {
        if let Some((place, csv)) = &mut self.csv {
            csv.rows(rows).map_err(|e| place.cannot_write(e))?;
        }
        if let Some((place, parquet)) = &mut self.parquet {
            parquet.rows(rows).map_err(|e| place.cannot_write(e))?;
        }
        // A table that is too long for a workbook is refused in the end, and needs no further memory.
        if let Some(whole) = self.whole.as_mut().filter(|whole| whole.len() <= MOST_ROWS) {
            whole.extend(std::slice::from_ref(rows), &[(0, 0..rows.len())]);
        }
        Ok(())
    }

    /// Completes the files; the whole table if a workbook is requested.
    pub fn finish(self) -> Result<Option<Table>, StorageError> {
        if let Some((place, csv)) = self.csv {
            place.done(csv.finish())?;
        }
        if let Some((place, parquet)) = self.parquet {
            place.done(parquet.finish().map_err(io::Error::from))?;
        }
        Ok(self.whole)
    }
}

/// Writes the rows of large tables as they are computed.
pub struct Tables<'r> {
    files: &'r Files,
    formats: &'r [Write],
    begun: Mutex<Vec<(String, TableFiles)>>,
}

impl<'r> Tables<'r> {
    pub fn new(files: &'r Files, formats: &'r [Write]) -> Self {
        Self {
            files,
            formats,
            begun: Mutex::default(),
        }
    }

    /// Writes the tables of an outcome and completes those written in batches. Returns the whole tables for a workbook, if one is
    /// requested.
    pub fn finish(self, tables: &[Table]) -> Result<Vec<Table>, StorageError> {
        let mut whole = Vec::new();
        let mut begun = self.begun.into_inner().unwrap_or_else(PoisonError::into_inner);
        for table in tables {
            let file = if let Some(place) = begun.iter().position(|(name, _)| *name == table.name) {
                begun.swap_remove(place).1
            } else {
                let mut file = TableFiles::new(self.files, self.formats, table)?;
                file.rows(table)?;
                file
            };
            whole.extend(file.finish()?);
        }
        Ok(whole)
    }
}

impl RowSink for Tables<'_> {
    fn take(&self, rows: &Table) -> Result<(), Stopped> {
        let mut begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        let known = begun.iter().position(|(name, _)| *name == rows.name);
        let place = if let Some(place) = known {
            place
        } else {
            let file = TableFiles::new(self.files, self.formats, rows)?;
            begun.push((rows.name.clone(), file));
            begun.len() - 1
        };
        Ok(begun[place].1.rows(rows)?)
    }
}
