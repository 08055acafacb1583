//! Load sharing as it is written.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::stiffness::StiffnessLaw;
use crate::geometry::LoadSharing;

/// Load sharing among pairs of teeth in contact: a word, the same under every load, or a record with a `type`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SharingEntry {
    /// The same under every load.
    Fixed(LoadSharing),
    /// One that depends on the load.
    Calculated(CalculatedSharing),
}

impl Default for SharingEntry {
    fn default() -> Self {
        Self::Fixed(LoadSharing::default())
    }
}

impl SharingEntry {
    /// The load sharing that is written in a mesh model, its own or that of its law of mean friction, with its place as a JSON pointer.
    pub fn of_model(model: &Value) -> Option<(&'static str, Self)> {
        ["/load_sharing", "/mean_friction/load_sharing"]
            .into_iter()
            .find_map(|place| {
                let written = serde_json::from_value(model.pointer(place)?.clone()).ok()?;
                Some((place, written))
            })
    }
}

/// Load sharing that depends on the load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum CalculatedSharing {
    /// Spur gears with equal linear reliefs of both tips over the whole double contact, and a constant stiffness: shares in closed form.
    Relief {
        /// Relief of each tip; the shares depend on the load. [um]
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 1000.0))]
        amount: Option<f64>,
        /// Relief over the deflection of one pair under the full load, instead of `amount`, the same under every load: 0 is `rigid`, 1/3
        /// `third`, 1 `ramp`. [-]
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 1e6))]
        kappa: Option<f64>,
        /// Stiffness of one pair per face width, 1 GPa is 1 N/(mm um); default: the single stiffness of ISO 6336-1. [GPa]
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.001, max = 1000.0))]
        stiffness: Option<f64>,
    },
    /// Shares or line loads over the plane of action from another program.
    File {
        /// CSV file or workbook with the columns `flank`, `drive` or `coast` (absent: both are alike), `torque [Nm]` (absent: valid for every
        /// torque), `path [-]` from 0 at the first to 1 at the last contact if the first gear drives, `face [-]` from 0 to 1 (absent: the mean
        /// over the face), and `share [-]` or `line load [N/mm]`.
        #[schemars(extend("x-refers-to" = "file"))]
        path: String,
    },
    /// Calculated in thin slices from the stiffness of the teeth, the `modification` of the gears and the `misalignment` of the mesh.
    Slices(SlicesSharing),
}

/// Options of the calculation in thin slices.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct SlicesSharing {
    /// Law of the stiffness of one pair of teeth.
    #[serde(default)]
    pub stiffness: StiffnessLaw,
    /// Stiffness of one pair per face width, instead of that of ISO 6336-1; 1 GPa is 1 N/(mm um). No effect with `weber` and `sainsot`. [GPa]
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub single_stiffness: Option<f64>,
    /// Number of slices over the face; a spur pair without modification along the face needs one. [-]
    #[serde(default = "slices")]
    #[schemars(range(min = 2, max = 400))]
    pub slices: u32,
    /// Number of phases of the mesh. [-]
    #[serde(default = "phases")]
    #[schemars(range(min = 10, max = 2000))]
    pub phases: u32,
}

impl Default for SlicesSharing {
    fn default() -> Self {
        Self {
            stiffness: StiffnessLaw::default(),
            single_stiffness: None,
            slices: slices(),
            phases: phases(),
        }
    }
}

fn slices() -> u32 {
    20
}

fn phases() -> u32 {
    200
}
