//! Data of an analysis: a measurement of the study, or its own.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::measured::MeasuredEntry;

/// Data of an analysis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Data {
    /// Name under `measurements`.
    Named(String),
    /// A file with its settings.
    Own(Box<MeasuredEntry>),
}

impl Data {
    /// The name, if it is one.
    pub fn name(&self) -> Option<&String> {
        match self {
            Self::Named(name) => Some(name),
            Self::Own(_) => None,
        }
    }
}
