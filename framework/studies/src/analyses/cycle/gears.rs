//! Time and energy in each gear over a cycle, and its shifts.

use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use crate::points::{ChosenBy, Driven, Optimum, Ride, Stretch, has_machine};

/// Gears of a cycle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct GearsOfDuty {
    /// How the gears are chosen, in words.
    pub choice: String,
    /// What is compared where the gears draw something: `machine_power` or `gearbox_loss`; absent if gears are stated.
    pub criterion: Option<Criterion>,
    /// Number of shifts; absent for loads without an order in time. [-]
    pub shifts: Option<usize>,
    /// Number of shifts that a limit of speed or torque requires. [-]
    pub forced_shifts: usize,
    /// Number of intervals in which every gear is beyond a limit: that with the smallest excess is used. [-]
    pub intervals_beyond_limits: usize,
    /// Energy that shifts dissipate, with that of the actuator. It is part of the consumption, not of the loss and the heat of the gearbox. [J]
    pub shift_energy_j: f64,
    /// Each gear with its time and energy, in the order of the gearbox.
    pub gears: Vec<TimeInGear>,
    /// The least energy over the whole cycle; absent unless gears are chosen by it.
    pub optimum: Option<OptimumOfDuty>,
}

/// What is compared to choose a gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// The power that the machines draw, at the rotating mass of each gear.
    MachinePower,
    /// The loss of the gearbox, because no machine is described.
    GearboxLoss,
}

/// Time and energy in a gear.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct TimeInGear {
    /// The gear.
    pub gear: String,
    /// Time. [s]
    pub time_s: f64,
    /// Share of the time. [-]
    pub time_share: f64,
    /// Input energy of the gearbox. [J]
    pub input_j: f64,
    /// Share of the input energy. [-]
    pub input_share: f64,
    /// Loss of the gearbox. [J]
    pub loss_j: f64,
    /// Share of the loss. [-]
    pub loss_share: f64,
}

/// The least energy over a cycle against that of the rule, both at the temperatures that the rule gives.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct OptimumOfDuty {
    /// Least energy, with that of shifts: drawn by the machines, or lost in the gearbox. [J]
    pub energy_j: f64,
    /// The same with the rule. [J]
    pub rule_energy_j: f64,
    /// What the rule needs more. [J]
    pub gap_j: f64,
    /// The same relative to the least energy; absent if that is not positive. [-]
    pub gap_share: Option<f64>,
    /// Number of shifts of the rule. [-]
    pub rule_shifts: usize,
}

impl From<&Optimum> for OptimumOfDuty {
    fn from(optimum: &Optimum) -> Self {
        let gap = optimum.rule_energy - optimum.energy;
        Self {
            energy_j: optimum.energy,
            rule_energy_j: optimum.rule_energy,
            gap_j: gap,
            gap_share: (optimum.energy > 0.0).then(|| gap / optimum.energy),
            rule_shifts: optimum.rule_shifts,
        }
    }
}

/// The gears of a simulated cycle; absent if one is stated and used throughout.
pub fn gears(t: &Transmission, ride: &Ride<'_>, driven: &Driven) -> Option<GearsOfDuty> {
    let first = driven.stretches.first()?.gear;
    if ride.choice.is_none() && driven.stretches.iter().all(|stretch| stretch.gear == first) {
        return None;
    }
    let shifts: Vec<_> = driven.stretches.iter().filter_map(|stretch| stretch.shift).collect();
    let count = if ride.choice.is_some() {
        shifts.len()
    } else {
        let pairs = driven.stretches.windows(2);
        pairs.filter(|pair| pair[0].gear != pair[1].gear).count()
    };
    let total = sums(driven.stretches.iter());
    let of_gear = |(number, state): (usize, &gearloss_framework::transmission::GearState)| {
        let own = sums(driven.stretches.iter().filter(|stretch| stretch.gear == number));
        let share = |i: usize| if total[i] > 0.0 { own[i] / total[i] } else { 0.0 };
        (own[0] > 0.0).then(|| TimeInGear {
            gear: state.name.clone(),
            time_s: own[0],
            time_share: share(0),
            input_j: own[1],
            input_share: share(1),
            loss_j: own[2],
            loss_share: share(2),
        })
    };
    Some(GearsOfDuty {
        choice: words(ride),
        criterion: ride
            .choice
            .filter(|c| !matches!(c.choice.by, ChosenBy::Map(_)))
            .map(|_| {
                if has_machine(t, ride) {
                    Criterion::MachinePower
                } else {
                    Criterion::GearboxLoss
                }
            }),
        shifts: (!ride.spectrum).then_some(count),
        forced_shifts: shifts.iter().filter(|shift| shift.forced).count(),
        intervals_beyond_limits: driven.stretches.iter().filter(|stretch| stretch.beyond_limits).count(),
        shift_energy_j: shifts.iter().map(|shift| shift.heat).sum(),
        gears: t.states().iter().enumerate().filter_map(of_gear).collect(),
        optimum: driven.optimum.as_ref().map(OptimumOfDuty::from),
    })
}

/// Time (s), input energy and loss (J) of intervals.
fn sums<'s>(stretches: impl Iterator<Item = &'s Stretch>) -> [f64; 3] {
    stretches.fold([0.0; 3], |[time, input, loss], stretch| {
        let heats = &stretch.heats;
        [
            time + heats.duration,
            input + heats.input,
            loss + heats.parts.iter().sum::<f64>(),
        ]
    })
}

/// How the gears are chosen.
fn words(ride: &Ride<'_>) -> String {
    let Some(choosing) = ride.choice else {
        return "as the cycle states".to_owned();
    };
    let choice = choosing.choice;
    let mut words = match &choice.by {
        ChosenBy::Rule(_) | ChosenBy::Optimum(_) if ride.spectrum => "the best gear of each load".to_owned(),
        ChosenBy::Rule(rule) => {
            let mut words = "the best gear of the moment".to_owned();
            if rule.saving > 0.0 {
                words.push_str(&format!(", if a shift saves more than {} W", rule.saving));
            }
            if rule.dwell > 0.0 {
                words.push_str(&format!(", at least {} s after the last shift", rule.dwell));
            }
            words
        }
        ChosenBy::Optimum(_) => "the sequence of gears with the least energy over the cycle".to_owned(),
        ChosenBy::Map(_) => "by a map over speed and torque of the wheels".to_owned(),
    };
    let has_inertia = ride.vehicle.is_some_and(|vehicle| vehicle.inertia.is_some());
    if ride.spectrum {
        return words;
    }
    words.push_str(&match choice.shift_energy {
        Some(energy) => format!("; a shift dissipates {energy} J"),
        None if has_inertia => "; a shift dissipates the friction of synchronising the moments of inertia".to_owned(),
        None => "; shifts cost nothing, because no moment of inertia is stated".to_owned(),
    });
    if choice.actuation > 0.0 {
        words.push_str(&format!(", and {} J in the actuator", choice.actuation));
    }
    words
}
