//! Rows of an identification that are not fitted, and groups of rows that are predicted from the others.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rows that are not fitted: they are predicted afterwards.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum HoldOutEntry {
    /// A condition on the rows that are held out, such as `torque > 1000 Nm`.
    Where(String),
    /// Rows that are held out, chosen in one of four ways.
    Rows(HoldOutRows),
}

impl HoldOutEntry {
    /// The ways in which rows are chosen; a bare condition is that under `where`.
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

/// Rows that are held out: one of `column`, `where`, `every` and `random`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
pub struct HoldOutRows {
    /// Column of the file, by its header, that says 1, true or yes in rows that are held out, and 0, false, no or nothing in the
    /// others.
    pub column: Option<String>,
    /// Condition on the rows that are held out: quantities and columns of the file compared by `==`, `!=`, `<`, `<=`, `>`, `>=`
    /// with values and their units, joined by `and`, `or`, `not` and parentheses. A row without the value is fitted.
    #[serde(rename = "where")]
    pub condition: Option<String>,
    /// Every n-th row in the order of the file: 5 holds out the fifth, the tenth and so on. [-]
    #[schemars(range(min = 2, max = 1_000_000))]
    pub every: Option<u32>,
    /// Share of the rows that is held out at random. Between neighbours that are fitted a row is easily predicted: a condition
    /// that holds out a whole torque, speed or temperature tests more. [-]
    #[schemars(range(min = 0.001, max = 0.999))]
    pub random: Option<f64>,
    /// Number from which the random choice follows, the same rows for the same number; absent, 1. [-]
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
    /// `torque`, `speed`, `oil_temperature` or another measured quantity: groups of neighbouring values. `sign`: rows in which power
    /// enters at the port of the torque, and those in which it leaves. `random`: rows drawn by lot; neighbouring rows of a rig err together, and a
    /// group whose neighbours are fitted is predicted too well to tell how the model does elsewhere. Else a column of the file by
    /// its header: a group for each text, or groups of neighbouring numbers.
    pub by: String,
    /// How many groups, where they are not given by texts or signs; absent, 5. [-]
    #[schemars(range(min = 2, max = 20))]
    pub count: Option<u32>,
    /// Number from which random groups follow, the same groups for the same number; absent, 1. [-]
    #[schemars(range(min = 0, max = 1_000_000_000))]
    pub seed: Option<u32>,
}
