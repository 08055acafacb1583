//! The thermal network: nodes, links, flows of oil, heat exchangers, sources.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Ordered;
use crate::mechanism::ModelRef;
use crate::mechanism::heat_link::HeatLink;
use crate::motor::MotorEntry;

/// A thermal network: `auto`, or as written.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum NetworkChoice {
    /// Nodes and links derived from shafts, bearings, gears and housing; `check --resolved` shows them, and each has a path.
    Auto(AutoNetwork),
    /// Nodes and links as written.
    Written(Box<NetworkEntry>),
}

/// The word `auto`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AutoNetwork {
    /// Nodes and links from the description.
    Auto,
}

/// Nodes and links. A node `ambient` at ambient temperature always exists.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct NetworkEntry {
    /// Nodes.
    pub nodes: Ordered<NodeEntry>,
    /// Links between nodes, with heat flow in both directions.
    #[serde(default)]
    pub links: Ordered<LinkEntry>,
    /// Oil flows, which carry heat downstream only.
    #[serde(default)]
    pub flows: Ordered<FlowEntry>,
    /// Circulated oil flow, of which flows take shares. [l/min]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub oil_flow: Option<f64>,
    /// Heat exchangers.
    #[serde(default)]
    pub exchangers: Ordered<ExchangerEntry>,
    /// Heat from other sources.
    #[serde(default)]
    pub sources: Ordered<NodeSource>,
    /// Electric motors, whose losses heat rotor and stator.
    #[serde(default)]
    pub motors: Ordered<MotorEntry>,
}

/// One node.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct NodeEntry {
    /// Heat capacity; zero for a node of negligible capacity, which follows its neighbours immediately. [J/K]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub heat_capacity: f64,
    /// Temperature of a node with prescribed temperature. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub temperature: Option<f64>,
    /// Temperature at the start of a cycle; default: that of the analysis. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub start: Option<f64>,
    /// Parts whose loss heats the node and whose oil has its temperature, such as `bearings.B1` or `gears.*.drag`. A part named by
    /// several nodes heats each by an equal share and has the oil temperature of the first.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "component"))]
    pub parts: Vec<String>,
    /// Parts whose oil has the temperature of the node, wherever their heat goes.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "component"))]
    pub oil_of: Vec<String>,
    /// Gears whose bodies the node represents. The model of a mesh divides its heat between both gears, and a friction law uses the
    /// temperatures of both.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "gears"))]
    pub gears: Vec<String>,
    /// The node is the oil of the housing: parts that no node names have its temperature and heat it.
    #[serde(default)]
    pub oil: bool,
}

/// One link.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct LinkEntry {
    /// The nodes at both ends.
    #[schemars(length(min = 2, max = 2))]
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub between: Vec<String>,
    /// Conductance; not with `model`. [W/K]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub conductance: Option<f64>,
    /// Model of the conductance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<ModelRef<HeatLink>>,
    /// Shaft or idler gear whose speed the model uses; default: that of `gear`.
    #[schemars(extend("x-refers-to" = ["shafts", "gears"]))]
    pub shaft: Option<String>,
    /// Gear whose geometry the model uses, and whose speed if no shaft is named.
    #[schemars(extend("x-refers-to" = "gears"))]
    pub gear: Option<String>,
    /// Oil whose properties the model uses; default: that of the housing.
    #[schemars(extend("x-refers-to" = "lubricants"))]
    pub lubricant: Option<String>,
}

/// One flow of oil.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct FlowEntry {
    /// Upstream node.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub from: String,
    /// Downstream node.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub to: String,
    /// Mass flow times specific heat; not with `share`. [W/K]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub capacity: Option<f64>,
    /// Share of `oil_flow`, or of the flow of `element`; default: all of it. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub share: Option<f64>,
    /// Element of the oil network whose flow it is, such as `nozzles.J1`; not with `capacity`.
    pub element: Option<String>,
}

/// One heat exchanger, by its effectiveness.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct ExchangerEntry {
    /// Node of the incoming oil.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub from: String,
    /// Node of the oil after the exchanger.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub to: String,
    /// Mass flow times specific heat of the oil; default: `oil_flow`. [W/K]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub capacity: Option<f64>,
    /// Element of the oil network whose oil it cools, such as `pipes.cooler`; not with `capacity`.
    pub element: Option<String>,
    /// Conductance between oil and coolant. [W/K]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub ua: f64,
    /// Flow arrangement of oil and coolant.
    #[serde(default)]
    pub arrangement: crate::thermal::Arrangement,
    /// Flow of the coolant. [l/min]
    #[schemars(range(min = 0.0, max = 1e7))]
    pub coolant_flow: f64,
    /// Inlet temperature of the coolant. [degC]
    #[schemars(range(min = -60.0, max = 200.0))]
    pub coolant_temperature: f64,
    /// Density of the coolant. [kg/m3]
    #[serde(default = "glycol_density")]
    #[schemars(range(min = 0.5, max = 2000.0))]
    pub coolant_density: f64,
    /// Specific heat of the coolant. [J/(kg K)]
    #[serde(default = "glycol_heat")]
    #[schemars(range(min = 500.0, max = 5000.0))]
    pub coolant_heat_capacity: f64,
}

fn glycol_density() -> f64 {
    1040.0
}

fn glycol_heat() -> f64 {
    3600.0
}

/// Heat from other sources.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct NodeSource {
    /// Heat flow. [W]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub heat: f64,
    /// Node that it enters.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub into: String,
}
