//! What comes out of driven duties.

use gearloss_framework::flow::Status;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analyses::Head;
use crate::analysis::Note;

/// Duties driven through a gearbox under each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CycleOutcome {
    /// Where it comes from.
    #[serde(flatten)]
    pub head: Head,
    /// Every duty under the first model set, then under the next.
    pub cycles: Vec<DutyOfSet>,
    /// Stated ranges that samples of uncertain inputs left, set after set.
    #[serde(skip)]
    pub left: Vec<(String, String)>,
}

/// One duty under one model set, without its course in time, which the table holds.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DutyOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Name of the duty.
    pub cycle: String,
    /// Time that was driven. [s]
    pub duration_s: f64,
    /// Number of intervals that were driven. [-]
    pub intervals: usize,
    /// Mean loss of the transmission over the whole duty. [W]
    pub mean_loss_w: f64,
    /// Names of the shares of the loss, those of all sets.
    pub shares: Vec<String>,
    /// Mean losses by share, in the order of the names. [W]
    pub mean_losses_w: Vec<f64>,
    /// Where the energy goes.
    pub energy: EnergyOfDuty,
    /// Where the heat goes; absent without a thermal network.
    pub heat: Option<HeatOfDuty>,
    /// Losses of the motors of the thermal network.
    pub motors: Vec<HeatOfMotor>,
    /// True where a motor was beyond its map; the loss at its edge counts.
    pub motors_beyond_map: bool,
    /// Temperatures of the nodes, or of the oil alone.
    pub nodes: Vec<TemperatureOfNode>,
    /// What the study says of the duty.
    pub about: Option<String>,
    /// A mean loss from elsewhere.
    pub reference: Option<ReferenceOfDuty>,
    /// Bands of uncertain inputs; absent without any.
    pub bands: Option<BandOfDuty>,
    /// Number of evaluations of the losses. [-]
    pub evaluations: usize,
    /// Number of calls of loss models. [-]
    pub calls: usize,
    /// Number of steps in time. [-]
    pub steps: usize,
    /// Number of steps in time that were tried and rejected. [-]
    pub steps_in_vain: usize,
    /// Where it could not go on; absent where it was driven to its end.
    pub broken: Option<BrokenOff>,
    /// What models noted.
    pub notes: Vec<Note>,
    /// How the file of the duty was understood, in sentences.
    #[serde(skip)]
    pub file_notes: Vec<String>,
    /// Losses by share, in the order of the names. [J]
    #[serde(skip)]
    pub energies_j: Vec<f64>,
    /// The intervals, as far as they went.
    #[serde(skip)]
    pub series: Vec<IntervalOfDuty>,
}

/// Where the energy of a duty goes.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct EnergyOfDuty {
    /// Energy that ports put in. [J]
    pub input_j: f64,
    /// Energy that comes out. [J]
    pub output_j: f64,
    /// Loss of the transmission. [J]
    pub loss_j: f64,
    /// Loss of all motors; absent where it is not known. [J]
    pub motors_j: Option<f64>,
    /// Energy that brakes of the vehicle take. [J]
    pub brakes_j: f64,
    /// What is left of input, output and losses over the input. [-]
    pub residual_share: f64,
}

/// Where the heat of a duty goes.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HeatOfDuty {
    /// All heat that came into the nodes. [J]
    pub came_j: f64,
    /// Heat stored in the nodes. [J]
    pub stored_j: f64,
    /// Heat into the nodes whose temperature is held.
    pub held: Vec<HeatOfNode>,
    /// Heat through the heat exchangers.
    pub exchangers: Vec<HeatOfExchanger>,
    /// Heat that flows carry away. [J]
    pub carried_away_j: f64,
    /// What is left of the heat over all heat that came. [-]
    pub residual_share: f64,
    /// Heat from elsewhere. [J]
    #[serde(skip)]
    pub sources_j: f64,
    /// Heat into all nodes that take some, whether held all the time or not.
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

/// Temperatures of one node over a duty.
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
    /// Root mean square of measurement less calculation; absent without a measurement. [K]
    pub rms_k: Option<f64>,
    /// Number of rows of the measurement that count. [-]
    pub measured_rows: Option<usize>,
    /// Measured temperatures: time and value. [s and degC]
    #[serde(skip)]
    pub measured: Vec<(f64, f64)>,
}

/// A mean loss from elsewhere.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ReferenceOfDuty {
    /// The mean loss. [W]
    pub mean_loss_w: f64,
    /// Where it comes from.
    pub source: Option<String>,
}

/// Bands of mean losses from uncertain inputs.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BandOfDuty {
    /// Number of samples that were driven. [-]
    pub samples: usize,
    /// Number of samples that could not be driven. [-]
    pub failed: usize,
    /// Shares of the samples below the lower end, the middle and the upper end of each band. [-]
    pub quantiles: [f64; 3],
    /// Lower end, median and upper end of the mean loss. [W]
    pub mean_loss_w: [f64; 3],
    /// The same by share, in the order of the names. [W]
    pub mean_losses_w: Vec<[f64; 3]>,
    /// The inputs, those with the strongest correlation first.
    pub inputs: Vec<InputOfBand>,
    /// Whether the mean loss from elsewhere is inside the band; absent without one.
    pub reference_inside: Option<bool>,
    /// Why the first of the failed samples has no value.
    #[serde(skip)]
    pub first_failure: Option<String>,
}

/// An uncertain input of a band.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct InputOfBand {
    /// Its path and range, in words.
    pub input: String,
    /// Correlation with the mean loss; absent where one of both is the same in all samples. [-]
    pub correlation_with_mean_loss: Option<f64>,
}

/// Where a duty could not go on.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BrokenOff {
    /// Time. [s]
    pub time_s: f64,
    /// Why.
    pub reason: String,
}

/// One interval of a driven duty, with its mean powers.
#[derive(Debug, Clone)]
pub struct IntervalOfDuty {
    /// Time at its beginning. [s]
    pub time_s: f64,
    /// Its length. [s]
    pub duration_s: f64,
    /// Torque of the reference port at its end. [Nm]
    pub torque_nm: f64,
    /// Speed of the reference port, with the noise of its conversion. [rpm]
    pub speed_rpm: f64,
    /// Speed of the vehicle. [m/s]
    pub vehicle_speed_m_s: Option<f64>,
    /// What the transmission does.
    pub status: Status,
    /// Power that ports put in. [W]
    pub input_w: f64,
    /// Power that comes out. [W]
    pub output_w: f64,
    /// Loss of the transmission. [W]
    pub loss_w: f64,
    /// Loss by share. [W]
    pub losses_w: Vec<f64>,
    /// Loss of all motors; absent where it is not known. [W]
    pub motors_w: Option<f64>,
    /// Power that brakes of the vehicle take. [W]
    pub brakes_w: f64,
    /// Temperatures of the nodes at its end. [degC]
    pub temperatures_degc: Vec<f64>,
    /// Measured temperatures of the nodes at its end. [degC]
    pub measured_degc: Vec<Option<f64>>,
}
