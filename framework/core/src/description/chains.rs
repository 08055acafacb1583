//! Chains and belts, and joints between shafts.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Ordered;
use super::defaults::default_one;
use super::every_mesh::OilOfComponent;
use crate::mechanism::ModelRef;
use crate::mechanism::chain::{Chain, ChainKind, ChainPart};
use crate::mechanism::joint::{Joint, JointKind};

/// A chain or belt between two wheels on parallel shafts that turn in the same direction. Its strands load the bearings of the shafts.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ChainEntry {
    /// What runs over the wheels.
    #[serde(default)]
    pub kind: ChainKind,
    /// First and second wheel.
    pub wheels: [ChainWheelEntry; 2],
    /// Pitch of the chain or belt; required unless it is a `variable_belt`. [mm]
    #[schemars(range(min = 1.0, max = 200.0))]
    pub pitch: Option<f64>,
    /// Number of links, or of teeth of a belt: compared with the centre distance. [-]
    #[schemars(range(min = 10, max = 5000))]
    pub links: Option<u32>,
    /// Centre distance, compared with the axes. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub centre_distance: Option<f64>,
    /// Speed of the first wheel over that of the second, of a `variable_belt`. [-]
    #[schemars(range(min = 0.05, max = 20.0))]
    pub ratio: Option<f64>,
    /// The same in single gears, by name: `ratio` holds in the others.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "gear_states", "x-digits-first" = true))]
    pub ratios: Ordered<RatioOfGear>,
    /// Diameter of the pins on which the links turn. [mm]
    #[schemars(range(min = 0.5, max = 100.0))]
    pub pin_diameter: Option<f64>,
    /// Tension of the slack strand, without centrifugal force: from its weight and sag, or from a tensioner. [N]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub slack_tension: f64,
    /// Mass of the whole chain or belt, for its centrifugal force; requires `links`. [kg]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub mass: Option<f64>,
    /// Its oil.
    #[serde(flatten)]
    pub oil: OilOfComponent,
    /// Factor on the loss, for effects that the model does not include. An identification may fit it. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub loss_factor: f64,
    /// Loss model; default: that of `models`.
    pub model: Option<ModelRef<Chain>>,
}

impl ChainEntry {
    /// What its models know of it.
    pub fn part(&self) -> ChainPart {
        let [first, second] = &self.wheels;
        ChainPart {
            kind: self.kind,
            z: first.z.zip(second.z).map(|(first, second)| [first, second]),
            pitch: self.pitch,
            pin_diameter: self.pin_diameter,
            slack_tension: self.slack_tension,
            links: self.links,
            mass: self.mass,
        }
    }
}

/// A wheel of a chain or belt.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ChainWheelEntry {
    /// Shaft that carries the wheel.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub shaft: String,
    /// Position of the chain along the shaft. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub at: f64,
    /// Number of teeth; required unless it is a `variable_belt`. [-]
    #[schemars(range(min = 5, max = 500))]
    pub z: Option<u32>,
}

/// Speed of the first wheel over that of the second. [-]
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct RatioOfGear(#[schemars(range(min = 0.05, max = 20.0))] pub f64);

/// A joint between two shafts at an angle, which turn at the same mean speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct JointEntry {
    /// First and second shaft.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub between: [String; 2],
    /// Kind of the joint.
    pub kind: JointKind,
    /// Angle between the axes of both shafts. [deg]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub angle: f64,
    /// Factor on the loss, for effects that the model does not include. An identification may fit it. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub loss_factor: f64,
    /// Loss model; default: that of `models`.
    pub model: Option<ModelRef<Joint>>,
}
