//! Formats of results.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A format to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Write {
    /// Comma-separated values.
    Csv,
    /// JSON.
    Json,
    /// Parquet, with the columns of the CSV.
    Parquet,
    /// Figures, one file each.
    Svg,
    /// A workbook with the result and all tables, for spreadsheets.
    Xlsx,
}

impl Write {
    /// CSV and JSON.
    pub const DATA: &'static [Self] = &[Self::Csv, Self::Json];

    /// CSV, JSON and figures.
    pub const WITH_FIGURES: &'static [Self] = &[Self::Csv, Self::Json, Self::Svg];
}
