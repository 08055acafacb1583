//! The outcome of simulated cycles.

use gearloss_fmu::Library;
use gearloss_framework::flow::Status;
use gearloss_framework::gearbox::Findings;
use schemars::JsonSchema;
use serde::Serialize;

use super::CycleExport;
use super::bearings::BearingLoads;
use super::gears::GearsOfDuty;
use super::machines::MachineOfDuty;
use super::ratings::RatedOverTime;
use super::tables::NetworkTables;
use crate::analyses::Head;
use crate::duty::Consumption;
use crate::points::Note;

/// Cycles simulated with each model set.
#[derive(Debug, Serialize, JsonSchema)]
pub struct CycleOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// All cycles with the first model set, then with the next.
    pub cycles: Vec<DutyOfSet>,
    /// Quantities outside their stated ranges in samples, by set.
    #[serde(skip)]
    pub left: Vec<(String, String)>,
    /// Why a cycle could not be simulated to its end.
    #[serde(skip)]
    pub failures: Vec<Findings>,
    /// The thermal network of each model set, if it is exported.
    #[serde(skip)]
    pub networks: Vec<NetworkTables>,
    /// Loads of the bearings by model set and cycle, if they are exported.
    #[serde(skip)]
    pub loads: Vec<BearingLoads>,
    /// Formats of the exports.
    #[serde(skip)]
    pub exports: Vec<CycleExport>,
    /// Libraries for the FMUs; empty unless one is exported.
    #[serde(skip)]
    pub libraries: Vec<Library>,
}

/// One cycle with one model set; the time series is in the table.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DutyOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Name of the cycle.
    pub cycle: String,
    /// Simulated time. [s]
    pub duration_s: f64,
    /// Number of simulated intervals. [-]
    pub intervals: usize,
    /// Mean loss of the transmission over the whole cycle. [W]
    pub mean_loss_w: f64,
    /// Names of the shares of the loss of all sets.
    pub shares: Vec<String>,
    /// Mean losses by share, in the order of the names. [W]
    pub mean_losses_w: Vec<f64>,
    /// Energy balance.
    pub energy: EnergyOfDuty,
    /// Energy over the distance; absent without a vehicle.
    pub per_distance: Option<EnergyPerDistance>,
    /// Energy of the vehicle; absent without a battery or without distance.
    pub consumption: Option<Consumption>,
    /// Time and energy in each gear, and shifts; absent if one gear is stated and used throughout.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gears_used: Option<GearsOfDuty>,
    /// Heat balance; absent without a thermal network.
    pub heat: Option<HeatOfDuty>,
    /// Losses of the motors of the thermal network.
    pub motors: Vec<HeatOfMotor>,
    /// True if a motor was outside its map; the loss at the edge of the map is used.
    pub motors_beyond_map: bool,
    /// Least and greatest inclination of the oil by grade and acceleration; absent unless the housing states its direction of travel. [deg]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inclination_deg: Option<[f64; 2]>,
    /// The machines that the gearbox describes; absent without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machines: Vec<MachineOfDuty>,
    /// Temperatures of the nodes, or of the oil only.
    pub nodes: Vec<TemperatureOfNode>,
    /// Note of the study on the cycle.
    pub about: Option<String>,
    /// A reference mean loss.
    pub reference: Option<ReferenceOfDuty>,
    /// Bands of uncertain inputs; absent without any.
    pub bands: Option<BandOfDuty>,
    /// Ratings of the components over the cycle; absent unless requested.
    pub ratings: Option<Vec<RatedOverTime>>,
    /// Number of evaluations of the losses. [-]
    pub evaluations: usize,
    /// Number of calls of loss models. [-]
    pub calls: usize,
    /// Number of steps in time. [-]
    pub steps: usize,
    /// Number of steps in time that were tried and rejected. [-]
    pub steps_in_vain: usize,
    /// Time at which the simulation stopped; absent if it reached the end.
    pub broken: Option<BrokenOff>,
    /// Notes of models.
    pub notes: Vec<Note>,
    /// Notes on the detected format of the file.
    #[serde(skip)]
    pub file_notes: Vec<String>,
    /// Losses by share, in the order of the names. [J]
    #[serde(skip)]
    pub energies_j: Vec<f64>,
    /// The simulated intervals.
    #[serde(skip)]
    pub series: Vec<IntervalOfDuty>,
}

/// Energy balance of a cycle.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct EnergyOfDuty {
    /// Input energy. [J]
    pub input_j: f64,
    /// Output energy. [J]
    pub output_j: f64,
    /// Loss of the transmission. [J]
    pub loss_j: f64,
    /// Loss of all motors; absent if unknown. [J]
    pub motors_j: Option<f64>,
    /// Energy dissipated in the brakes of the vehicle. [J]
    pub brakes_j: f64,
    /// Energy balance error relative to the input. [-]
    pub residual_share: f64,
    /// Output over input energy while power enters at the reference port; absent if it never does. [-]
    pub drive_efficiency: Option<f64>,
    /// Output over input energy while power leaves at the reference port; absent if it never does. [-]
    pub recuperation_efficiency: Option<f64>,
}

/// Energy of a cycle over the distance of the vehicle.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct EnergyPerDistance {
    /// Distance. [km]
    pub distance_km: f64,
    /// Loss of the transmission. [Wh/km]
    pub loss_wh_per_km: f64,
    /// The same in the unit of consumption. [kWh/100 km]
    pub loss_kwh_per_100_km: f64,
}

/// Heat balance of a cycle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HeatOfDuty {
    /// Total heat into the nodes. [J]
    pub came_j: f64,
    /// Heat stored in the nodes. [J]
    pub stored_j: f64,
    /// Heat into the nodes with given temperature.
    pub held: Vec<HeatOfNode>,
    /// Heat through the heat exchangers.
    pub exchangers: Vec<HeatOfExchanger>,
    /// Heat transferred by flows. [J]
    pub carried_away_j: f64,
    /// Heat balance error relative to the total heat. [-]
    pub residual_share: f64,
    /// Heat from other sources. [J]
    #[serde(skip)]
    pub sources_j: f64,
    /// Heat of the inverters that heat a node. [J]
    #[serde(skip)]
    pub inverters_j: f64,
    /// Heat into all nodes with given temperature, also if given only part of the time.
    #[serde(skip)]
    pub taken: Vec<HeatOfNode>,
}

/// Heat into a node.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HeatOfNode {
    /// Name of the node.
    pub node: String,
    /// Heat. [J]
    pub heat_j: Option<f64>,
}

/// Heat through a heat exchanger.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HeatOfExchanger {
    /// Path of the heat exchanger.
    pub exchanger: String,
    /// Heat. [J]
    pub heat_j: f64,
}

/// Losses of a motor.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HeatOfMotor {
    /// Path of the motor.
    pub motor: String,
    /// Loss in the rotor. [J]
    pub rotor_j: f64,
    /// Loss in the stator. [J]
    pub stator_j: f64,
}

/// Temperatures of one node over a cycle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct TemperatureOfNode {
    /// Name of the node.
    pub node: String,
    /// At the start. [degC]
    pub start_degc: f64,
    /// At the end. [degC]
    pub end_degc: f64,
    /// Minimum. [degC]
    pub least_degc: f64,
    /// Maximum. [degC]
    pub greatest_degc: f64,
    /// Mean over time. [degC]
    pub mean_degc: f64,
    /// Root mean square of measurement minus calculation; absent without a measurement. [K]
    pub rms_k: Option<f64>,
    /// Number of measured rows used. [-]
    pub measured_rows: Option<usize>,
    /// Measured temperatures: time and value. [s and degC]
    #[serde(skip)]
    pub measured: Vec<(f64, f64)>,
}

/// A reference mean loss.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ReferenceOfDuty {
    /// The mean loss. [W]
    pub mean_loss_w: f64,
    /// Provenance.
    pub source: Option<String>,
}

/// Bands of mean losses from uncertain inputs.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BandOfDuty {
    /// Number of simulated samples. [-]
    pub samples: usize,
    /// Number of failed samples. [-]
    pub failed: usize,
    /// Probabilities of the lower end, the middle and the upper end of each band. [-]
    pub quantiles: [f64; 3],
    /// Lower end, median and upper end of the mean loss. [W]
    pub mean_loss_w: [f64; 3],
    /// The same by share, in the order of the names. [W]
    pub mean_losses_w: Vec<[f64; 3]>,
    /// Lower end, median and upper end of the consumption; absent without a battery or without distance. [kWh/100 km]
    pub consumption_kwh_per_100_km: Option<[f64; 3]>,
    /// The inputs, those with the strongest correlation first.
    pub inputs: Vec<InputOfBand>,
    /// Whether the reference mean loss is inside the band; absent without one.
    pub reference_inside: Option<bool>,
    /// Why the first of the failed samples has no value.
    #[serde(skip)]
    pub first_failure: Option<String>,
}

/// An uncertain input of a band.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct InputOfBand {
    /// Its path and range as text.
    pub input: String,
    /// Correlation with the mean loss; absent if one of them is constant. [-]
    pub correlation_with_mean_loss: Option<f64>,
}

/// Where the simulation of a cycle stopped.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BrokenOff {
    /// Time. [s]
    pub time_s: f64,
    /// Why.
    pub reason: String,
}

/// One interval of a simulated cycle with its mean powers.
#[derive(Debug, Clone)]
pub struct IntervalOfDuty {
    /// Time at its start. [s]
    pub time_s: f64,
    /// Its length. [s]
    pub duration_s: f64,
    /// Torque of the reference port at its end. [Nm]
    pub torque_nm: f64,
    /// Speed of the reference port, not rounded. [rpm]
    pub speed_rpm: f64,
    /// Speed of the vehicle. [m/s]
    pub vehicle_speed_m_s: Option<f64>,
    /// Inclination of the oil by grade and acceleration; absent if the cycle does not incline it. [deg]
    pub inclination_deg: Option<f64>,
    /// Name of the gear.
    pub gear: String,
    /// Energy that the shift at its start dissipates. [J]
    pub shift_j: Option<f64>,
    /// State of the transmission.
    pub status: Status,
    /// Input power. [W]
    pub input_w: f64,
    /// Output power. [W]
    pub output_w: f64,
    /// Loss of the transmission. [W]
    pub loss_w: f64,
    /// Loss by share. [W]
    pub losses_w: Vec<f64>,
    /// Loss of all motors; absent if unknown. [W]
    pub motors_w: Option<f64>,
    /// Power dissipated in the brakes of the vehicle. [W]
    pub brakes_w: f64,
    /// Temperatures of the nodes at its end. [degC]
    pub temperatures_degc: Vec<f64>,
    /// Measured temperatures of the nodes at its end. [degC]
    pub measured_degc: Vec<Option<f64>>,
}
