//! The description of a gearbox: the typed sections that the framework itself reads.
//!
//! Sections of mechanisms (`bearings`, `couplings`, `seals`, ... and those of other crates) are merged in by the registry.
//! All structs are read from the resolved document, in which every quantity is SI and every default is filled.

pub mod gears;
pub mod housing;
pub mod lubricant;
pub mod network;
pub mod shafts;
pub mod states;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use gearloss_document::Ordered;
pub use gears::{DifferentialEntry, GearEntry, GearKind, MeshEntry, Mounting, PlanetarySetEntry, Surface};
pub use housing::{HeatInto, HousingEntry, LevelOver, OilEntry, OutsideEntry, Running, Thermal, ThermalMode};
pub use lubricant::LubricantEntry;
pub use network::{NetworkChoice, NetworkEntry, NodeEntry};
pub use shafts::{LoadEntry, SectionEntry, ShaftEntry, Unsupported};
pub use states::{AssumedEntry, GearStateEntry, ImportedLoads, RatingEntry, TorqueShare};

/// A gearbox.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(title = "gearbox")]
pub struct GearboxEntry {
    /// Kind and format version of the document.
    pub gearloss: GearboxFormat,
    /// Title for reports.
    pub title: Option<String>,
    /// Where the description comes from.
    pub source: Option<String>,
    /// A gearbox file whose description this one takes over; `set` changes it.
    pub extends: Option<String>,
    /// Changes to the file named in `extends`: resolved path to value.
    #[serde(default)]
    pub set: Ordered<Value>,
    /// Shafts at which torque and speed are given or measured: name to shaft.
    pub ports: Ordered<String>,
    /// Ports that turn at one speed and count as one port, `wheels`: both wheels of a driven axle on a straight road. Its torque is the
    /// sum of theirs, which the transmission shares; where nothing decides the shares, they are equal.
    #[schemars(length(min = 2))]
    pub wheels: Option<Vec<String>>,
    /// Shafts, planet bodies and carriers: everything that turns, apart from loose gears.
    pub shafts: Ordered<ShaftEntry>,
    /// Gears.
    #[serde(default)]
    pub gears: Ordered<GearEntry>,
    /// Pairs of gears in mesh.
    #[serde(default)]
    pub meshes: Ordered<MeshEntry>,
    /// Planetary sets: a carrier and the shafts that turn as planets on it.
    #[serde(default)]
    pub planetary_sets: Ordered<PlanetarySetEntry>,
    /// Differentials.
    #[serde(default)]
    pub differentials: Ordered<DifferentialEntry>,
    /// Relative speed over that at which bodies turn together, below which their friction falls in proportion to it, to nothing where
    /// they turn as one: gears and bearings on a carrier whose planets hardly roll, as in a differential on a straight road. Unevenness
    /// of real drives turns the sense of such friction all the time. Zero: all of the friction at any relative speed. [-]
    #[serde(default = "uneven_running")]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub locked_below: f64,
    /// Which couplings are engaged in which gear.
    #[serde(default)]
    #[schemars(extend("x-digits-first" = true))]
    pub gear_states: Ordered<GearStateEntry>,
    /// How parallel meshes on one shaft share its torque.
    #[serde(default)]
    pub torque_shares: Vec<TorqueShare>,
    /// Flanks of every gear that does not state its own.
    pub surface: Option<Surface>,
    /// Oils.
    pub lubricants: Ordered<LubricantEntry>,
    /// Housing and its oil.
    #[serde(default)]
    pub housing: HousingEntry,
    /// Operating temperature.
    #[serde(default)]
    pub thermal: Thermal,
    /// Loads of components from a file in place of those from statics.
    pub imported_loads: Option<ImportedLoads>,
    /// Catalogues of this gearbox, as files: catalogue to file.
    #[serde(default)]
    pub catalogues: Ordered<String>,
    /// Largest torque and speed that the gearbox is made for; axes of grids may count in shares of them.
    pub rating: Option<RatingEntry>,
    /// What is assumed and why; shown in reports.
    #[serde(default)]
    pub assumed: Vec<AssumedEntry>,
    /// Where values come from.
    #[serde(default)]
    pub sources: Vec<AssumedEntry>,
}

/// Single-pitch deviations of micrometres on pitches of millimetres; assumed.
fn uneven_running() -> f64 {
    1e-3
}

/// Kind and format version of a gearbox document.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum GearboxFormat {
    /// The first format.
    #[serde(rename = "gearbox/1")]
    One,
}
