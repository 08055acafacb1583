//! The entry of a file with a table.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::TableForm;
use super::sheet::Assigned;
use crate::Ordered;

/// A file with a table.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TableFile {
    /// Its name: the header has the names of the quantities and their units.
    Name(String),
    /// Its name, its columns and how it is written.
    Stated(Box<StatedTable>),
}

/// A file with a table, its columns and how it is written.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct StatedTable {
    /// CSV file, workbook (.xlsx) or MDF file (.mf4).
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: String,
    /// Column of each quantity, unless it has the name of the quantity.
    #[serde(default)]
    pub columns: Ordered<String>,
    /// Unit of each quantity, unless the header or a row of units states it.
    #[serde(default)]
    pub units: Ordered<String>,
    /// `units` have precedence where the file states different ones; otherwise that is an error.
    #[serde(default)]
    pub units_override: bool,
    /// How the file is written.
    #[serde(flatten)]
    pub form: TableForm,
}

impl StatedTable {
    /// The stated columns and units.
    pub fn assigned(&self) -> Assigned<'_> {
        Assigned {
            columns: Some(&self.columns),
            units: Some(&self.units),
            units_override: self.units_override,
        }
    }
}

impl TableFile {
    /// Name of the file.
    pub fn name(&self) -> &str {
        match self {
            Self::Name(file) => file,
            Self::Stated(table) => &table.file,
        }
    }

    /// The keys with the name of the file; none is stated beside a mere name.
    pub fn stated(&self) -> StatedTable {
        match self {
            Self::Name(file) => StatedTable {
                file: file.clone(),
                ..StatedTable::default()
            },
            Self::Stated(table) => (**table).clone(),
        }
    }
}
