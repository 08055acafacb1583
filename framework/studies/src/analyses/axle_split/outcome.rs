//! The outcome of cycles with two units.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::best::State;
use crate::analyses::{Head, Outcome};
use crate::points::Note;
use crate::table::Table;

/// Cycles with a front and a rear unit.
#[derive(Debug, Serialize, JsonSchema)]
pub struct AxleSplitOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each cycle.
    pub cycles: Vec<SplitOfCycle>,
}

/// One cycle; the time series is in the table.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SplitOfCycle {
    /// Name of the cycle.
    pub cycle: String,
    /// Model sets of the front and of the rear unit.
    pub model_sets: [String; 2],
    /// Time. [s]
    pub duration_s: f64,
    /// Distance. [km]
    pub distance_km: f64,
    /// Energy that both machines draw, minus what they recuperate. [J]
    pub drawn_j: f64,
    /// The same over the distance; absent without one. [kWh/100 km]
    pub drawn_kwh_per_100_km: Option<f64>,
    /// Energy that the front machine draws, minus what it recuperates. [J]
    pub front_j: f64,
    /// Energy that the rear machine draws, minus what it recuperates. [J]
    pub rear_j: f64,
    /// Time in each state.
    pub states: Vec<TimeInState>,
    /// The same cycle with fixed shares and both units connected.
    pub fixed: Vec<FixedSplit>,
    /// Number of intervals in which every share is beyond the map of a machine. [-]
    pub intervals_beyond_limits: usize,
    /// The intervals.
    #[serde(skip)]
    pub series: Vec<IntervalOfSplit>,
}

/// Time in which some units drive.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct TimeInState {
    /// Which units drive.
    pub state: State,
    /// Time. [s]
    pub time_s: f64,
    /// Share of the time. [-]
    pub time_share: f64,
    /// Energy that both machines draw in it, minus what they recuperate. [J]
    pub drawn_j: f64,
}

/// A fixed share.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct FixedSplit {
    /// Share of the torque of the wheels at the front axle. [-]
    pub front_share: f64,
    /// Energy that both machines draw, minus what they recuperate. [J]
    pub drawn_j: f64,
    /// What it draws more. [J]
    pub difference_j: f64,
}

/// One interval.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct IntervalOfSplit {
    /// Time at its start. [s]
    pub time_s: f64,
    /// Its length. [s]
    pub duration_s: f64,
    /// Speed of the vehicle. [m/s]
    pub vehicle_speed_m_s: Option<f64>,
    /// Torque of all driven wheels. [Nm]
    pub wheel_torque_nm: f64,
    /// Which units drive.
    pub state: State,
    /// Share of the front axle; absent at standstill. [-]
    pub front_share: Option<f64>,
    /// Power of the front machine. [W]
    pub front_w: f64,
    /// Power of the rear machine. [W]
    pub rear_w: f64,
    /// Power of both. [W]
    pub drawn_w: f64,
    /// True if every share is beyond the map of a machine.
    pub beyond: bool,
}

/// 1 kWh/100 km. \[J/m\]
const KWH_PER_100_KM: f64 = 36.0;

impl SplitOfCycle {
    /// Sums of the intervals of a cycle, and energies (J) of fixed shares.
    pub fn new(cycle: &str, model_sets: [String; 2], series: Vec<IntervalOfSplit>, fixed: &[(f64, f64)]) -> Self {
        let sum = |value: &dyn Fn(&IntervalOfSplit) -> f64| -> f64 { series.iter().map(value).sum() };
        let duration_s = sum(&|at| at.duration_s);
        let distance = sum(&|at| at.vehicle_speed_m_s.unwrap_or(0.0) * at.duration_s);
        let [front_j, rear_j] = [
            sum(&|at| at.front_w * at.duration_s),
            sum(&|at| at.rear_w * at.duration_s),
        ];
        let drawn_j = front_j + rear_j;
        let state = |state: State| {
            let own = || series.iter().filter(move |at| at.state == state);
            let time_s: f64 = own().map(|at| at.duration_s).sum();
            (time_s > 0.0).then(|| TimeInState {
                state,
                time_s,
                time_share: time_s / duration_s,
                drawn_j: own().map(|at| at.drawn_w * at.duration_s).sum(),
            })
        };
        Self {
            cycle: cycle.to_owned(),
            model_sets,
            duration_s,
            distance_km: 1e-3 * distance,
            drawn_j,
            drawn_kwh_per_100_km: (distance > 0.0).then(|| drawn_j / distance / KWH_PER_100_KM),
            front_j,
            rear_j,
            states: [State::Both, State::FrontAlone, State::RearAlone, State::Standstill]
                .into_iter()
                .filter_map(state)
                .collect(),
            fixed: fixed
                .iter()
                .map(|(front_share, energy)| FixedSplit {
                    front_share: *front_share,
                    drawn_j: *energy,
                    difference_j: energy - drawn_j,
                })
                .collect(),
            intervals_beyond_limits: series.iter().filter(|at| at.beyond).count(),
            series,
        }
    }
}

impl Outcome for AxleSplitOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let table = Table::of_each(&self.head.analysis, &self.cycles, |cycle| &cycle.series)
            .text("cycle", "Duty cycle", |(cycle, _)| &cycle.cycle)
            .number("time_s", "s", "Time at the start of the interval", |(_, at)| at.time_s)
            .number("duration_s", "s", "Length of the interval", |(_, at)| at.duration_s)
            .number("vehicle_speed_m_s", "m/s", "Speed of the vehicle", |(_, at)| {
                at.vehicle_speed_m_s
            })
            .number("wheel_torque_nm", "Nm", "Torque of all driven wheels", |(_, at)| {
                at.wheel_torque_nm
            })
            .text("state", "Which units drive", |(_, at)| at.state.name())
            .number(
                "front_share",
                "-",
                "Share of the torque at the front axle",
                |(_, at)| at.front_share,
            )
            .number("front_w", "W", "Power of the front machine", |(_, at)| at.front_w)
            .number("rear_w", "W", "Power of the rear machine", |(_, at)| at.rear_w)
            .number("drawn_w", "W", "Power of both machines", |(_, at)| at.drawn_w);
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }
}
