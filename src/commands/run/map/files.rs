//! The files of a map.

use gearloss_studies::study::MapEntry;

use super::super::table::TableFile;
use super::super::write::{head, write_json};
use super::super::{Built, Runner};
use super::Map;
use super::results::Waited;
use super::rows::header;
use crate::output::Failure;

/// The files of a map that are written while its points are solved.
pub struct Files {
    pub parts: Vec<String>,
    pub table: TableFile,
    pub waited: Option<Waited>,
}

impl Files {
    pub fn new(
        runner: &Runner<'_>,
        name: &str,
        entry: &MapEntry,
        bound: &[String],
        all: &[&Built<'_>],
    ) -> Result<Self, Failure> {
        // Sets may differ in their parts; each part has one column, empty where a set has it not.
        let mut parts: Vec<String> = Vec::new();
        for part in all.iter().flat_map(|built| built.transmission.parts()) {
            if !parts.contains(&part.path) {
                parts.push(part.path.clone());
            }
        }
        Ok(Self {
            table: TableFile::new(runner.run, name, &entry.write, &header(bound, &parts))?,
            waited: Waited::where_asked(runner, name, &entry.write)?,
            parts,
        })
    }

    /// Ends the table, and writes the JSON with the points that have waited for it.
    pub fn finish(self, runner: &Runner<'_>, name: &str, entry: &MapEntry, maps: &[Map<'_>]) -> Result<(), Failure> {
        self.table.finish()?;
        let head = head(runner, &maps.iter().map(|m| &*m.built).collect::<Vec<_>>());
        match self.waited {
            Some(waited) => write_json(runner, name, &entry.write, &waited.results(head, maps)),
            None => Ok(()),
        }
    }
}
