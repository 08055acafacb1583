//! Held-out rows of an identification, and groups of rows for cross-validation.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Held-out rows, which are predicted after the fit.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum HoldOutEntry {
    /// A condition on the held-out rows, such as `torque > 1000 Nm`.
    Where(String),
    /// Held-out rows, by one of four selections.
    Rows(HoldOutRows),
}

impl HoldOutEntry {
    /// The selections of rows; a condition alone is equivalent to `where`.
    pub fn rows(&self) -> HoldOutRows {
        match self {
            Self::Where(condition) => HoldOutRows {
                condition: Some(condition.clone()),
                ..HoldOutRows::default()
            },
            Self::Rows(rows) => rows.clone(),
        }
    }
}

/// Held-out rows: one of `column`, `where`, `every` and `random`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
pub struct HoldOutRows {
    /// Column of the file, by its header, with 1, true or yes in held-out rows, and 0, false, no or nothing in the others.
    pub column: Option<String>,
    /// Condition on the held-out rows: quantities and columns of the file compared by `==`, `!=`, `<`, `<=`, `>`, `>=` with values and
    /// their units, combined by `and`, `or`, `not` and parentheses. Rows without the value are fitted.
    #[serde(rename = "where")]
    pub condition: Option<String>,
    /// Every n-th row of the file: 5 means the fifth, the tenth and so on. [-]
    #[schemars(range(min = 2, max = 1_000_000))]
    pub every: Option<u32>,
    /// Share of randomly held-out rows. A row between fitted neighbours is easily predicted: holding out a whole torque, speed or
    /// temperature by a condition is a stronger test. [-]
    #[schemars(range(min = 0.001, max = 0.999))]
    pub random: Option<f64>,
    /// Seed of the random choice; default: 1. [-]
    #[schemars(range(min = 0, max = 1_000_000_000))]
    pub seed: Option<u32>,
}

/// Groups of rows for cross-validation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum FoldsEntry {
    /// Groups of neighbouring torques; 0, none. [-]
    Torques(#[schemars(range(min = 0, max = 20))] u32),
    /// Groups by another quantity.
    By(FoldsBy),
}

/// Groups of rows by a quantity of the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FoldsBy {
    /// `torque`, `speed`, `oil_temperature` or another measured quantity: groups of neighbouring values. `sign`: rows with power entering
    /// and rows with power leaving at the port of the torque. `random`: random rows; errors of neighbouring rows are correlated, so
    /// predictions between fitted neighbours are too optimistic for extrapolation. Otherwise a column of the file by its header: a group
    /// for each text, or groups of neighbouring numbers.
    pub by: String,
    /// Number of groups, unless given by texts or signs; default: 5. [-]
    #[schemars(range(min = 2, max = 20))]
    pub count: Option<u32>,
    /// Seed of random groups; default: 1. [-]
    #[schemars(range(min = 0, max = 1_000_000_000))]
    pub seed: Option<u32>,
}
