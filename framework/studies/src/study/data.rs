//! Data that an analysis uses: measurements that the study names, or its own.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::measured::MeasuredEntry;

/// Data of an analysis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Data {
    /// Name under `measurements`.
    Named(String),
    /// A file, and how to read it.
    Own(Box<MeasuredEntry>),
}

impl Data {
    /// The name, where it is one.
    pub fn name(&self) -> Option<&String> {
        match self {
            Self::Named(name) => Some(name),
            Self::Own(_) => None,
        }
    }
}
