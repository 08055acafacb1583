//! What the page asks. `web/src/workbench/protocol.ts` states the same for the page.

use std::collections::BTreeMap;

use gearloss_editor::Request as EditRequest;
use serde::Deserialize;

use crate::drafts::Draft;

/// Unsaved texts by file.
pub type Texts = BTreeMap<String, String>;

/// A request. Files are paths relative to the folder, with `/`.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "request", rename_all = "snake_case")]
pub enum Request {
    /// Whether the program answers. It carries nothing of the page.
    Hello,
    /// Files of the folder, and the forms for new gearboxes.
    Folder,
    /// Text of a file.
    Read {
        /// File.
        file: String,
    },
    /// Writes a file, unless it differs from what the page has read.
    Save {
        /// File.
        file: String,
        /// New text.
        text: String,
        /// Hash of what the page has read; absent for a new file.
        hash: Option<String>,
    },
    /// Keeps a text that is not saved.
    Keep {
        /// Name of the tab.
        tab: String,
        /// What is kept.
        draft: Draft,
    },
    /// Forgets a text that was kept.
    Forget {
        /// Name among the drafts.
        id: String,
    },
    /// Texts that were kept.
    Drafts,
    /// A request of the editor.
    Edit {
        /// Unsaved texts.
        texts: Texts,
        /// Request.
        edit: EditRequest,
    },
    /// What a point of a gearbox is made of.
    Controls {
        /// Unsaved texts.
        texts: Texts,
        /// File.
        gearbox: String,
    },
    /// A solved point.
    Point {
        /// Unsaved texts.
        texts: Texts,
        /// Point.
        #[serde(flatten)]
        point: PointOf,
    },
    /// The drawing of a gearbox.
    Drawing {
        /// Unsaved texts.
        texts: Texts,
        /// File.
        gearbox: String,
    },
    /// Every step of the loss of a component.
    Explain {
        /// Unsaved texts.
        texts: Texts,
        /// Path of the component.
        part: String,
        /// Point.
        #[serde(flatten)]
        point: PointOf,
    },
    /// A map of a gearbox.
    Map {
        /// Unsaved texts.
        texts: Texts,
        /// Map.
        #[serde(flatten)]
        map: MapOf,
    },
    /// The analyses of a study.
    Analyses {
        /// Unsaved texts.
        texts: Texts,
        /// File.
        study: String,
    },
    /// Runs analyses of a study; answered by a stream of events.
    Run {
        /// Unsaved texts.
        texts: Texts,
        /// File.
        study: String,
        /// Names; all analyses and the report if none is named.
        analyses: Vec<String>,
    },
    /// The text of a new gearbox.
    New {
        /// Layout.
        layout: String,
        /// What was typed, by path.
        values: BTreeMap<String, String>,
    },
    /// The text of a new study of a gearbox.
    NewStudy {
        /// Unsaved texts.
        texts: Texts,
        /// File.
        gearbox: String,
    },
    /// Rows of a catalogue.
    Catalogue {
        /// Catalogue.
        of: CatalogueOf,
        /// Part of a designation.
        text: String,
    },
    /// Changes of files on the disk; answered by a stream of events.
    Watch {
        /// Hash that the page knows of each file.
        files: BTreeMap<String, String>,
    },
}

impl Request {
    /// The files that the request itself names, other than those of the store's own requests.
    pub(crate) fn files(&self) -> Vec<&str> {
        match self {
            Self::Edit { edit, .. } => edit.file().to_str().into_iter().collect(),
            Self::Controls { gearbox, .. } | Self::Drawing { gearbox, .. } | Self::NewStudy { gearbox, .. } => {
                vec![gearbox]
            }
            Self::Point { point, .. } | Self::Explain { point, .. } => vec![&point.gearbox],
            Self::Map { map, .. } => vec![&map.gearbox],
            Self::Analyses { study, .. } | Self::Run { study, .. } => vec![study],
            Self::Hello
            | Self::Folder
            | Self::Read { .. }
            | Self::Save { .. }
            | Self::Keep { .. }
            | Self::Forget { .. }
            | Self::Drafts
            | Self::New { .. }
            | Self::Catalogue { .. }
            | Self::Watch { .. } => Vec::new(),
        }
    }

    /// Whether the answer is computed: it may take long. The others read and write files.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn computes(&self) -> bool {
        !matches!(
            self,
            Self::Hello
                | Self::Folder
                | Self::Read { .. }
                | Self::Save { .. }
                | Self::Keep { .. }
                | Self::Forget { .. }
                | Self::Drafts
        )
    }
}

/// A catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CatalogueOf {
    /// Rolling bearings.
    Bearings,
    /// Oils.
    Oils,
    /// Materials of gears.
    Materials,
}

/// Quantity of an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Torque. [Nm]
    Torque,
    /// Speed. [rpm]
    Speed,
}

/// A given torque or speed.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct GivenInput {
    /// Quantity.
    pub quantity: Quantity,
    /// Port.
    pub port: String,
    /// Value. [Nm, rpm]
    pub value: f64,
}

/// A point of a gearbox.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct PointOf {
    /// File.
    pub gearbox: String,
    /// Gear state.
    pub gear: String,
    /// Torques and speeds.
    pub inputs: Vec<GivenInput>,
    /// Oil temperature; as the gearbox states if absent. [degC]
    pub oil_temperature: Option<f64>,
    /// Volume of the oil, from which the level follows; as the gearbox states if absent. [l]
    #[serde(default)]
    pub oil_volume: Option<f64>,
    /// Model set; empty for the models of the gearbox itself.
    pub model_set: String,
}

/// A map of a gearbox.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct MapOf {
    /// File.
    pub gearbox: String,
    /// Gear state.
    pub gear: String,
    /// Model set; empty for the models of the gearbox itself.
    pub model_set: String,
    /// Oil temperature; as the gearbox states if absent. [degC]
    pub oil_temperature: Option<f64>,
    /// Volume of the oil; as the gearbox states if absent. [l]
    #[serde(default)]
    pub oil_volume: Option<f64>,
    /// Torques. [Nm]
    pub torque: Span,
    /// Speeds. [rpm]
    pub speed: Span,
    /// Number of torques and of speeds.
    pub count: usize,
}

/// From one value to another.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct Span {
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
}
