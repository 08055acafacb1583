//! The record of the source of a set.

use gearloss_framework::description::Ordered;
use gearloss_framework::registry::DocumentKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Name under which its schema is registered.
pub(super) const NAME: &str = "source";

/// Source of a set of data: the record at the beginning of `source.md`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(title = "source")]
pub struct SourceEntry {
    /// Kind and format version of the document.
    pub gearloss: SourceFormat,
    /// Title.
    #[schemars(length(min = 1))]
    pub title: String,
    /// Where the numbers come from.
    pub kind: Basis,
    /// What they describe.
    pub product: Product,
    /// Who measured, stated or calculated them.
    #[schemars(length(min = 1))]
    pub who: String,
    /// Where they are published: paper with doi, catalogue, repository with commit.
    #[schemars(length(min = 1))]
    pub published: String,
    /// How they were obtained from there: printed, read from a figure, averaged from records.
    #[schemars(length(min = 1))]
    pub obtained: String,
    /// Accuracy as stated, or what is assumed.
    #[schemars(length(min = 1))]
    pub accuracy: String,
    /// Licence, or why numbers may be passed on.
    #[schemars(length(min = 1))]
    pub licence: String,
    /// How far the numbers can be trusted.
    pub trust: Trust,
    /// What the program lacks to describe the product, such as `worm mesh`. The set is listed and judges no model.
    #[schemars(length(min = 1))]
    pub needs: Option<String>,
    /// Models whose constants were derived from these data, such as `bearing/skf`: they are judged apart.
    #[serde(default)]
    pub seen: Vec<String>,
    /// Columns of `data.csv` in their order, as the source states them; default: the data are not passed on.
    #[serde(default)]
    pub columns: Ordered<StatedColumn>,
}

gearloss_framework::registry::submit! { DocumentKind { name: NAME, schema: SourceEntry::json_schema } }

/// Kind and format version of a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum SourceFormat {
    /// The first format.
    #[serde(rename = "source/1")]
    One,
}

/// Where the numbers of a set come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    /// Measured.
    Measured,
    /// Stated by the maker.
    MakersData,
    /// Calculated by another program, or a regression.
    Calculated,
}

impl Basis {
    /// As text.
    pub fn words(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::MakersData => "maker's data",
            Self::Calculated => "calculated by another program",
        }
    }
}

/// What a set describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Product {
    /// A component alone: a bearing, a mesh, a seal.
    Component,
    /// A whole gearbox or reducer.
    Gearbox,
    /// Temperatures over time.
    Thermal,
    /// Properties of an oil.
    Lubricant,
}

/// How far numbers can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Trust {
    /// Primary record or printed table with known conditions.
    High,
    /// One thing is missing, or second-hand but consistent.
    Medium,
    /// For trends and plausibility only.
    Low,
}

impl Trust {
    /// As text.
    pub fn words(self) -> &'static str {
        match self {
            Self::High => "high",
            Self::Medium => "medium",
            Self::Low => "low",
        }
    }
}

/// A column as the source states it. A column of text has neither unit nor numbers.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct StatedColumn {
    /// What it is.
    #[schemars(length(min = 1))]
    pub what: String,
    /// Its unit, as in line 2 of the data; `-` for a number without one.
    pub unit: Option<String>,
    /// Least number in the column, in its unit. [-]
    #[schemars(range(min = -1e15, max = 1e15), extend("x-bare" = true))]
    pub from: Option<f64>,
    /// Greatest number in the column, in its unit. [-]
    #[schemars(range(min = -1e15, max = 1e15), extend("x-bare" = true))]
    pub to: Option<f64>,
}
