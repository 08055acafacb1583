//! Preload of two opposed bearings, as written at one of them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Preload or end play of two opposed tapered roller or angular contact ball bearings, adjusted without a spring. One of `force`, `closing` and
/// `torque` at mounting temperature; temperatures of shaft and housing change it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PreloadEntry {
    /// Force with which the bearings press against each other without other loads. [N]
    #[schemars(range(min = 0.0, max = 1e7))]
    pub force: Option<f64>,
    /// Distance by which both bearings together are closed, from where they have no clearance; negative for end play. [um]
    #[schemars(range(min = -5000.0, max = 5000.0))]
    pub closing: Option<f64>,
    /// Torque that turns both bearings together without other loads and without an oil bath, by their friction models with the oil at mounting
    /// temperature; needs `torque_speed`. [Nm]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub torque: Option<f64>,
    /// Speed at which `torque` was measured. [rpm]
    #[schemars(range(min = 0.001, max = 1e5))]
    pub torque_speed: Option<f64>,
    /// Temperature of all parts when the bearings are adjusted. [degC]
    #[serde(default = "twenty")]
    #[schemars(range(min = -60.0, max = 150.0))]
    pub mounting_temperature: f64,
    /// Distance of the contacts with the outer rings along the shaft; default: from the positions `at`, taken as pressure centres. [mm]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub distance: Option<f64>,
    /// Share of the difference between the expansions of housing and steel that outer rings of steel follow across the axis: zero if they are loose,
    /// one if the housing forces them. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub ring_follows: f64,
    /// Shaft with inner rings and rolling elements.
    #[serde(default)]
    pub shaft: PreloadBody,
    /// Housing, or other member around the bearings, with outer rings.
    #[serde(default)]
    pub housing: PreloadBody,
}

fn twenty() -> f64 {
    20.0
}

/// Temperature and expansion of a body next to preloaded bearings.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PreloadBody {
    /// Temperature, if it does not change. [degC]
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub temperature: Option<f64>,
    /// Node of the thermal network with its temperature; default: the node with the name of the shaft or gear, `casing` of the housing, if there is
    /// one, as in `network: auto`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub node: Option<String>,
    /// Temperature above that of the oil of the bearings; negative below. Default, unless there is a temperature or a node: zero. [K]
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -100.0, max = 100.0))]
    pub above_oil: Option<f64>,
    /// Material, which has an expansion; default: steel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<BodyMaterial>,
    /// Thermal expansion; default: that of `material`. [1/K]
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e-4))]
    pub expansion: Option<f64>,
}

/// Material of a shaft or housing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BodyMaterial {
    /// Steel: 11.5e-6 1/K.
    Steel,
    /// Grey cast iron: 10.5e-6 1/K.
    CastIron,
    /// Aluminium: 23e-6 1/K.
    Aluminium,
    /// Magnesium: 26e-6 1/K.
    Magnesium,
}

impl BodyMaterial {
    /// Thermal expansion; that of steel and aluminium as in calculations of bearing makers, the others recalled. \[1/K\]
    pub fn expansion(self) -> f64 {
        match self {
            Self::Steel => 11.5e-6,
            Self::CastIron => 10.5e-6,
            Self::Aluminium => 23e-6,
            Self::Magnesium => 26e-6,
        }
    }
}

impl PreloadBody {
    /// Its thermal expansion. \[1/K\]
    pub fn expansion(&self) -> f64 {
        let material = self.material.unwrap_or(BodyMaterial::Steel);
        self.expansion.unwrap_or_else(|| material.expansion())
    }

    /// True if neither material nor expansion are stated.
    pub fn is_material_assumed(&self) -> bool {
        self.material.is_none() && self.expansion.is_none()
    }
}
