//! Electric machines as a gearbox describes them.

use gearloss_document::data::TableFile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::motor::{MotorEntry, RotorShare};

/// An electric machine at a port, with its inverter: losses by a map or a constant efficiency, limits, and what the map contains.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct MachineEntry {
    /// Port that the machine drives.
    #[serde(default = "input")]
    #[schemars(extend("x-refers-to" = "ports"))]
    pub port: String,
    /// Losses: CSV file, workbook or MDF file relative to this one, or an entry with `file`, `columns` and `units`: `speed [rpm]`, `torque [Nm]`, and
    /// `efficiency [-]` or `loss [W]`; optionally `temperature [degC]` of the winding and `voltage [V]` of the DC link, and `current [A]`,
    /// `power_factor [-]` and `modulation [-]` for `inverter.bridge`. Rows with negative torque are for generating, those of 0 Nm for both.
    #[schemars(extend("x-refers-to" = "file"))]
    pub map: Option<TableFile>,
    /// A constant efficiency between shaft and terminals, in both directions; not with `map`. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub efficiency: Option<f64>,
    /// What the map contains besides the machine itself. What it contains must not be described a second time.
    #[serde(default)]
    pub contains: Vec<Contained>,
    /// Temperature of the winding at which the map was measured, and its share of copper losses.
    pub winding: Option<WindingEntry>,
    /// What the machine loses without torque while it turns.
    #[serde(default)]
    pub idle: IdleEntry,
    /// Losses of the machine that turns with its inverter off, over speed: iron and friction, linear between the values, constant beyond; with
    /// `idle: "off"`. Without it such a machine loses nothing.
    #[serde(default)]
    pub freewheel: Vec<FreewheelAt>,
    /// Voltage of the DC link, for maps over the voltage, `envelope` and `inverter.bridge`. [V]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub voltage: Option<f64>,
    /// Largest torque over speed.
    pub envelope: Option<EnvelopeEntry>,
    /// The inverter, if the map does not contain it.
    pub inverter: Option<InverterEntry>,
    /// Share of the losses that occurs in the rotor.
    #[serde(default)]
    pub rotor_share: RotorShare,
    /// Node of the thermal network that is the rotor; with `stator`. Without nodes the losses heat nothing.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub rotor: Option<String>,
    /// Node of the thermal network that is the stator with its winding; with `rotor`.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub stator: Option<String>,
}

fn input() -> String {
    "input".to_owned()
}

/// A motor of a thermal network is a machine with nodes.
impl From<&MotorEntry> for MachineEntry {
    fn from(motor: &MotorEntry) -> Self {
        Self {
            port: motor.port.clone(),
            map: Some(motor.map.clone()),
            efficiency: None,
            contains: Vec::new(),
            winding: None,
            idle: IdleEntry::default(),
            freewheel: Vec::new(),
            voltage: None,
            envelope: None,
            inverter: None,
            rotor_share: motor.rotor_share.clone(),
            rotor: Some(motor.rotor.clone()),
            stator: Some(motor.stator.clone()),
        }
    }
}

/// What a loss map contains besides the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Contained {
    /// The inverter: the map is between shaft and DC link.
    Inverter,
    /// The bearings of the rotor.
    Bearings,
    /// The windage of the rotor.
    Windage,
}

/// The winding of a map of one temperature.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WindingEntry {
    /// Temperature of the winding when the map was measured. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub temperature: f64,
    /// Share of the losses of the map that is proportional to the resistance of the copper: without eddy currents in it. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub copper_share: f64,
}

/// The state of a machine that turns without torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum IdleEntry {
    /// The inverter switches: the losses are those of the map at 0 Nm.
    #[default]
    Energised,
    /// The inverter is off: the losses are those of `freewheel`.
    Off,
}

/// Loss of a freewheeling machine at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FreewheelAt {
    /// Speed of the machine; increases along the list. [rpm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub speed: f64,
    /// Loss. [W]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub loss: f64,
}

/// Largest torque of a machine over its speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EnvelopeEntry {
    /// For a limited time.
    pub peak: Option<ReachEntry>,
    /// Without limit of time.
    pub continuous: Option<ReachEntry>,
    /// Longest time above the continuous torque; longer ones are counted. [s]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub peak_time: Option<f64>,
    /// Voltage of the DC link at which torque and power apply; the power is proportional to the voltage. Default: `voltage`. [V]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub voltage: Option<f64>,
    /// What cycles of a vehicle do with a torque beyond the envelope.
    #[serde(default)]
    pub beyond: BeyondEntry,
}

/// Largest torque and power.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReachEntry {
    /// Torque. [Nm]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub torque: f64,
    /// Mechanical power. [kW]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub power: f64,
    /// Largest speed; default: any. [rpm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub speed: Option<f64>,
}

/// What happens beyond the envelope.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BeyondEntry {
    /// The torque is limited: the brakes supply the rest of a deceleration, a shortfall remains of an acceleration; both are counted.
    #[default]
    Limit,
    /// The cycle is refused.
    Refuse,
}

/// Losses of the inverter: one of `efficiency`, `map` and `bridge`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct InverterEntry {
    /// A constant efficiency between the DC link and the terminals of the machine, in both directions. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub efficiency: Option<f64>,
    /// Losses over the same columns as those of the map of a machine.
    #[schemars(extend("x-refers-to" = "file"))]
    pub map: Option<TableFile>,
    /// Values of the data sheet of the power semiconductors. They need the phase current: columns of the map of the machine, or `current`.
    pub bridge: Option<BridgeEntry>,
    /// Node of the thermal network that its losses heat, such as that of its coolant. Without one they heat nothing.
    #[schemars(extend("x-refers-to" = ["thermal.network.nodes", "ambient"]))]
    pub node: Option<String>,
}

/// A bridge of two levels and three phases with sine modulation.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct BridgeEntry {
    /// Threshold voltage of the transistor: of the line through its curve at the temperature of the junction; with the three below. [V]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub transistor_voltage: Option<f64>,
    /// Resistance of that line. [mohm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub transistor_resistance: Option<f64>,
    /// Threshold voltage of the diode. [V]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub diode_voltage: Option<f64>,
    /// Resistance of the diode. [mohm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub diode_resistance: Option<f64>,
    /// Resistance of the channel of a MOSFET with synchronous rectification, instead of the four above; dead times are neglected. [mohm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub channel_resistance: Option<f64>,
    /// Switching frequency: switchings of a transistor in a second. [Hz]
    #[schemars(range(min = 0.0, max = 1e7))]
    pub frequency: f64,
    /// Energy of switching on. [J]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub energy_on: f64,
    /// Energy of switching off. [J]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub energy_off: f64,
    /// Energy of the reverse recovery of the diode. [J]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub energy_recovery: f64,
    /// Current of these energies. [A]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub at_current: f64,
    /// DC voltage of these energies. [V]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub at_voltage: f64,
    /// Exponent of the voltage in the switching of the transistor; the default is recalled: 1.3 to 1.4. [-]
    #[serde(default = "transistor_exponent")]
    #[schemars(range(min = 0.0, max = 3.0))]
    pub voltage_exponent: f64,
    /// Exponent of the current in the recovery of the diode; the default is recalled. [-]
    #[serde(default = "recovery_exponent")]
    #[schemars(range(min = 0.0, max = 3.0))]
    pub recovery_current_exponent: f64,
    /// Exponent of the voltage in the recovery of the diode; the default is recalled. [-]
    #[serde(default = "recovery_exponent")]
    #[schemars(range(min = 0.0, max = 3.0))]
    pub recovery_voltage_exponent: f64,
    /// Power of gate drives, control and DC capacitor, whenever the inverter is energised. [W]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub auxiliary: f64,
    /// The phase current, if the map of the machine does not state it.
    pub current: Option<CurrentEntry>,
}

fn transistor_exponent() -> f64 {
    1.35
}

fn recovery_exponent() -> f64 {
    0.6
}

/// The phase current from the torque: proportional to it, with the current of field weakening in quadrature.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CurrentEntry {
    /// A torque below the base speed. [Nm]
    #[schemars(range(min = 1e-6, max = 1e9))]
    pub torque: f64,
    /// Root mean square of the phase current at that torque. [A]
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub current: f64,
    /// Magnitude of the power factor. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub power_factor: f64,
    /// Speed up to which the phase voltage is proportional to the speed. [rpm]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub base_speed: f64,
    /// Modulation from there on: 1 for sine modulation, up to 1.155 with a third harmonic. [-]
    #[serde(default = "full_modulation")]
    #[schemars(range(min = 0.1, max = 1.155))]
    pub modulation: f64,
    /// Root mean square of the current that weakens the field, over speed; without it, speeds above the base speed are outside.
    #[serde(default)]
    pub field_weakening: Vec<FieldWeakeningAt>,
}

fn full_modulation() -> f64 {
    1.0
}

/// Current of field weakening at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FieldWeakeningAt {
    /// Speed of the machine; increases along the list. [rpm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub speed: f64,
    /// Current. [A]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub current: f64,
}
