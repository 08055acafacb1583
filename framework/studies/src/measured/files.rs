//! The files of one set of measured points: one, or several read in sequence.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

use super::columns::ColumnEntry;
use gearloss_document::data::TableForm;
use gearloss_framework::description::Ordered;

/// One file of measured points, or several.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum MeasuredFiles {
    /// CSV file, workbook (.xlsx) or MDF file (.mf4), relative to the study.
    One(String),
    /// Several files with the same quantities, read in sequence.
    Several(#[schemars(length(min = 1))] Vec<FileEntry>),
}

/// One of several files.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum FileEntry {
    /// CSV file, workbook (.xlsx) or MDF file (.mf4), relative to the study.
    Name(String),
    /// A file with different columns, units or name.
    Own(Box<OwnFileEntry>),
}

/// A file with different columns, units or name.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OwnFileEntry {
    /// CSV file, workbook (.xlsx) or MDF file (.mf4), relative to the study.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: String,
    /// Name of the file in messages and tables; default: the file name.
    pub name: Option<String>,
    /// How the file is written; what is not stated here is as stated for the measurement.
    #[serde(flatten)]
    pub form: TableForm,
    /// Columns of this file; they replace those of the measurement, quantity by quantity.
    #[serde(default)]
    pub columns: Ordered<ColumnEntry>,
    /// Units of this file; they replace those of the measurement, quantity by quantity.
    #[serde(default)]
    pub units: Ordered<String>,
    /// Units of the study have precedence where this file states different ones; default: that of the measurement.
    pub units_override: Option<bool>,
}

/// A file of a measurement with its settings.
#[derive(Debug, Clone, Copy)]
pub struct MeasuredFile<'a> {
    /// File name, relative to the study.
    pub file: &'a str,
    /// Name in messages.
    pub name: &'a str,
    /// Settings for this file only.
    pub(super) entry: Option<&'a OwnFileEntry>,
}

impl MeasuredFiles {
    /// The files in reading order.
    pub fn list(&self) -> Vec<MeasuredFile<'_>> {
        match self {
            Self::One(file) => vec![MeasuredFile {
                file,
                name: file,
                entry: None,
            }],
            Self::Several(list) => list.iter().map(FileEntry::file).collect(),
        }
    }
}

impl FileEntry {
    fn file(&self) -> MeasuredFile<'_> {
        match self {
            Self::Name(file) => MeasuredFile {
                file,
                name: file,
                entry: None,
            },
            Self::Own(entry) => MeasuredFile {
                file: &entry.file,
                name: entry.name.as_ref().unwrap_or(&entry.file),
                entry: Some(entry),
            },
        }
    }
}

impl fmt::Display for MeasuredFiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.list().iter().map(|file| file.name).collect();
        f.write_str(&names.join(", "))
    }
}

impl Serialize for MeasuredFiles {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
