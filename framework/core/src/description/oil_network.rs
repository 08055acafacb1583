//! The network of oil flows: pumps, pipes, nozzles, rotating channels, junctions, chambers, and the pockets of bearings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Ordered;
use super::every_mesh::OilOfComponent;
use crate::hydraulics::{Orifice, Rib};

/// A network of oil flows. Elements lead from `sump` or a junction to a junction, a chamber, `sump` or `housing`, the air of the housing.
/// Pressures are those over the air of the housing. Only a circuit with neither `sump` nor chambers may have another oil than the housing.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct OilNetworkEntry {
    /// Its oil.
    #[serde(flatten)]
    pub oil: OilOfComponent,
    /// Volume share of free air in the oil: lowers the density, raises the viscosity, and pumps deliver less oil; 0 to 0.2. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.5))]
    pub air: f64,
    /// Junctions, which have one pressure.
    #[serde(default)]
    pub junctions: Ordered<JunctionEntry>,
    /// Displacement pumps.
    #[serde(default)]
    pub pumps: Ordered<PumpEntry>,
    /// Pipes, bores and ducts.
    #[serde(default)]
    pub pipes: Ordered<PipeEntry>,
    /// Nozzles and orifices.
    #[serde(default)]
    pub nozzles: Ordered<NozzleEntry>,
    /// Channels in rotating parts.
    #[serde(default)]
    pub rotating_channels: Ordered<RotatingChannelEntry>,
    /// Spaces that oil leaves through holes, such as a motor room.
    #[serde(default)]
    pub chambers: Ordered<ChamberEntry>,
}

/// A junction.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct JunctionEntry {
    /// Height above the datum of the oil level; default: that of the oil surface, which adds no pressure. [mm]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub height: Option<f64>,
    /// x in the housing, with which the height follows its inclination; default: with `y`, the middle of the oil space. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub x: Option<f64>,
    /// y in the housing; default: with `x`, the middle of the oil space. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub y: Option<f64>,
}

/// A displacement pump. An auxiliary whose model names it computes its torque on the shaft.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct PumpEntry {
    /// Inlet: `sump` or a junction.
    #[schemars(extend("x-refers-to" = ["oil_network.junctions", "sump"]))]
    pub from: String,
    /// Delivery: a junction.
    #[schemars(extend("x-refers-to" = "oil_network.junctions"))]
    pub to: String,
    /// Shaft or idler gear that drives it; not with `speed`. It delivers in both senses of rotation.
    #[schemars(extend("x-refers-to" = ["shafts", "gears"]))]
    pub shaft: Option<String>,
    /// Speed of a separate motor, whose power is no loss of the transmission; not with `shaft`. [rpm]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub speed: Option<f64>,
    /// Displacement per turn of the shaft or motor. [cm3]
    #[schemars(range(min = 1e-4, max = 1e5))]
    pub displacement: f64,
    /// Coefficient of leakage according to Wilson, 1e-9 to 1e-8: flow = leakage x displacement x pressure/(2 pi eta). [-]
    #[serde(default = "usual_leakage")]
    #[schemars(range(min = 0.0, max = 1e-5))]
    pub leakage: f64,
    /// Flow above which a regulator leads the surplus back to the inlet; default: none. [l/min]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub regulated_flow: Option<f64>,
    /// Relief valve at the delivery, which returns oil to the sump.
    pub relief: Option<ReliefEntry>,
}

/// A relief valve: linear from its opening pressure.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct ReliefEntry {
    /// Pressure at which it opens. [bar]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub opens: f64,
    /// Pressure at which it passes `flow`. [bar]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub full: f64,
    /// Flow at the pressure `full`. [l/min]
    #[schemars(range(min = 1e-6, max = 1e5))]
    pub flow: f64,
}

/// A pipe, bore or duct.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct PipeEntry {
    /// Beginning: `sump` or a junction.
    #[schemars(extend("x-refers-to" = ["oil_network.junctions", "sump"]))]
    pub from: String,
    /// End: a junction, a chamber, `sump` or `housing`.
    #[serde(default = "housing")]
    #[schemars(extend("x-refers-to" = ["oil_network.junctions", "oil_network.chambers", "sump", "housing"]))]
    pub to: String,
    /// Diameter; of a duct or gap the hydraulic one, 4 times area over perimeter. [mm]
    #[schemars(range(min = 0.01, max = 1e4))]
    pub diameter: f64,
    /// Area of the cross-section; default: that of the circle. [mm2]
    #[schemars(range(min = 1e-4, max = 1e8))]
    pub area: Option<f64>,
    /// Length. [mm]
    #[schemars(range(min = 0.01, max = 1e6))]
    pub length: f64,
    /// Height of the roughness; 1.5 for drawn tubes, 10 to 50 for drilled or cast channels. [um]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub roughness: f64,
    /// Sum of loss coefficients: sharp inlet 0.5, outlet 1.0, drilled corner 1.1 to 1.3, tee to a branch 1.3 to 1.8. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub losses: f64,
    /// Height of its mouth in the sump above the datum of the oil level, for the finding that it draws air. [mm]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub inlet_height: Option<f64>,
    /// x of that mouth in the housing, with which its height follows the inclination; default: with `inlet_y`, the middle of the oil space.
    /// [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub inlet_x: Option<f64>,
    /// y of that mouth in the housing; default: with `inlet_x`, the middle of the oil space. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub inlet_y: Option<f64>,
    /// Components that its flow reaches, in equal shares, such as `bearings.B1`.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "component"))]
    pub feeds: Vec<String>,
}

/// A hole with an edge or a short length.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct HoleEntry {
    /// Diameter. [mm]
    #[schemars(range(min = 0.01, max = 1e3))]
    pub diameter: f64,
    /// Length; zero for a sharp edge. [mm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub length: f64,
    /// Discharge coefficient; default: 0.61 if it is shorter than its diameter, else 0.8; 0.95 if its inlet is rounded. [-]
    #[schemars(range(min = 0.05, max = 1.0))]
    pub discharge: Option<f64>,
    /// Number of equal holes. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 1, max = 10000))]
    pub count: u32,
}

impl HoleEntry {
    /// Its law.
    pub fn orifice(&self) -> Orifice {
        let usual = if self.length < self.diameter { 0.61 } else { 0.8 };
        Orifice {
            diameter: self.diameter,
            length: self.length,
            discharge: self.discharge.unwrap_or(usual),
            count: f64::from(self.count),
        }
    }
}

/// A nozzle or orifice.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct NozzleEntry {
    /// Beginning: `sump` or a junction.
    #[schemars(extend("x-refers-to" = ["oil_network.junctions", "sump"]))]
    pub from: String,
    /// End: a junction, a chamber, `sump` or `housing`.
    #[serde(default = "housing")]
    #[schemars(extend("x-refers-to" = ["oil_network.junctions", "oil_network.chambers", "sump", "housing"]))]
    pub to: String,
    /// Its hole.
    #[serde(flatten)]
    pub hole: HoleEntry,
    /// Components that its oil reaches, in equal shares, such as `meshes.M1`.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "component"))]
    pub feeds: Vec<String>,
}

/// Channels in a rotating part. An auxiliary whose model names them computes the torque that the oil takes from the shaft.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct RotatingChannelEntry {
    /// Inlet: a junction.
    #[schemars(extend("x-refers-to" = "oil_network.junctions"))]
    pub from: String,
    /// Outlet: a junction, a chamber or `housing`.
    #[serde(default = "housing")]
    #[schemars(extend("x-refers-to" = ["oil_network.junctions", "oil_network.chambers", "housing"]))]
    pub to: String,
    /// Shaft or idler gear that they are in.
    #[schemars(extend("x-refers-to" = ["shafts", "gears"]))]
    pub shaft: String,
    /// Radius of the inlet. [mm]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub inner_radius: f64,
    /// Radius of the outlet. [mm]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub outer_radius: f64,
    /// Share of the shaft's swirl that the oil has at the inlet: 0 from a stationary part, 1 from a bore of the same shaft. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub swirl: f64,
    /// Diameter of each. [mm]
    #[schemars(range(min = 0.01, max = 1e3))]
    pub diameter: f64,
    /// Length of each. [mm]
    #[schemars(range(min = 0.01, max = 1e5))]
    pub length: f64,
    /// Height of the roughness. [um]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub roughness: f64,
    /// Sum of loss coefficients of each. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub losses: f64,
    /// Number of equal channels. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 1, max = 10000))]
    pub count: u32,
    /// Components that their oil reaches, in equal shares.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "component"))]
    pub feeds: Vec<String>,
}

/// A space with vertical walls that oil leaves through holes in its floor.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct ChamberEntry {
    /// Area of its floor. [cm2]
    #[schemars(range(min = 0.01, max = 1e6))]
    pub floor: f64,
    /// Height over the floor that the oil must not exceed, such as that of an air gap. [mm]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub height: Option<f64>,
    /// Its holes.
    pub drain: HoleEntry,
    /// Place of the holes along x from the middle of the floor, for an inclined housing. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub drain_x: f64,
    /// Place of the holes along y from the middle of the floor, for an inclined housing. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub drain_y: f64,
    /// Where it drains: a chamber or `sump`.
    #[serde(default = "sump")]
    #[schemars(extend("x-refers-to" = ["oil_network.chambers", "sump"]))]
    pub into: String,
}

/// The pocket of a bearing, between it and its cover or seal: oil stands in it up to the lowest edge over which it escapes.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct PocketEntry {
    /// Height of the lowest edge over which oil escapes, above the lowest point of the outer raceway. [mm]
    #[schemars(range(min = 0.0, max = 2000.0))]
    pub edge: f64,
    /// Radius of a circular edge, such as the bore of the cage or of a shoulder; not with `edge_width`. [mm]
    #[schemars(range(min = 0.1, max = 2500.0))]
    pub edge_radius: Option<f64>,
    /// Width of a straight edge, such as a return slot; not with `edge_radius`. [mm]
    #[schemars(range(min = 0.1, max = 5000.0))]
    pub edge_width: Option<f64>,
    /// Length of a straight edge in the direction of the flow, on which the oil has friction. [mm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub edge_length: f64,
    /// True for a straight edge of thin sheet.
    #[serde(default)]
    pub edge_sharp: bool,
    /// Hole at the lowest point of the raceway.
    pub drain: Option<HoleEntry>,
    /// Rib that leads oil from the wall into the pocket.
    #[serde(rename = "catch")]
    pub rib: Option<CatchEntry>,
    /// Window or open front through which a gear throws oil into the pocket.
    pub window: Option<WindowEntry>,
    /// Length of the pocket along the shaft, with the free part of the bearing: the oil in it is missing from an estimated level while
    /// rotating. Default: none is subtracted. [mm]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub length: Option<f64>,
}

/// A window in a wall beside a gear, with its places in the housing. What it takes of the oil that the gear lifts follows from the flight.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct WindowEntry {
    /// Gear that throws the oil, with a churning law and an axis along x.
    #[schemars(extend("x-refers-to" = "gears"))]
    pub gear: String,
    /// y of the wall. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub y: f64,
    /// z of the lower edge. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub bottom: f64,
    /// z of the upper edge. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub top: f64,
    /// Beginning along the shafts. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub from: f64,
    /// End along the shafts. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub to: f64,
}

/// A rib on a wetted wall: it catches the film that runs down above it. Its flow is uncertain by a factor of three.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct CatchEntry {
    /// Oil that gears fling on all walls; default: what they lift as estimated from their churning losses. [l/min]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub wetting: Option<f64>,
    /// Length of the rib along the wall. [mm]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub width: f64,
    /// Horizontal length of all wetted walls; default with estimated wetting: that of the oil space. [mm]
    #[schemars(range(min = 1.0, max = 1e6))]
    pub walls: Option<f64>,
    /// Height of wetted wall above the rib over that of all wetted wall. [-]
    #[serde(default = "half")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub above: f64,
}

impl CatchEntry {
    /// The rib, of which a part of the evenly wetted wall is above.
    pub fn rib(&self) -> Rib {
        Rib {
            width: self.width,
            walls: self.walls,
            above: self.above,
        }
    }
}

/// Between the bounds of published values of gear pumps; it takes less than 1 % of the flow of a warm lubrication pump.
fn usual_leakage() -> f64 {
    5e-9
}

fn housing() -> String {
    "housing".to_owned()
}

fn sump() -> String {
    "sump".to_owned()
}

fn default_one() -> u32 {
    1
}

fn half() -> f64 {
    0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 20 l/min, 50 of 400 mm, half the height: 1.25 l/min, as published with the formula.
    #[test]
    fn a_rib_catches_its_part_of_the_wall() {
        let rib = CatchEntry {
            wetting: Some(20.0),
            width: 50e-3,
            walls: Some(400e-3),
            above: 0.5,
        };
        assert_eq!(20.0 * rib.rib().share(1.0), 1.25);
        let of_space = CatchEntry { walls: None, ..rib };
        assert_eq!(20.0 * of_space.rib().share(800e-3), 0.625);
    }
}
