//! Electric machines over a cycle: energies, and where a cycle leaves a map or an envelope.

use gearloss_framework::machine::{Machine, MachineEnergy};
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use crate::numbers::{RPM, tidy};
use crate::points::{Driven, Stretch};

/// A machine over a cycle.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MachineOfDuty {
    /// Path of the machine.
    pub machine: String,
    /// Energy into the transmission. [J]
    pub shaft_j: f64,
    /// Loss, with what the map contains. [J]
    pub loss_j: f64,
    /// Loss of an inverter that is described apart. [J]
    pub inverter_j: f64,
    /// Time outside a map, whose end value is then used. [s]
    pub outside_map_s: f64,
    /// Where the cycle is farthest outside the map of the machine; absent inside.
    pub farthest: Option<OutsideMap>,
    /// Time above the continuous torque. [s]
    pub above_continuous_s: f64,
    /// Longest time above the continuous torque without a break. [s]
    pub longest_above_continuous_s: f64,
    /// Number of such times that are longer than `peak_time` of the envelope. [-]
    pub beyond_peak_time: usize,
    /// Time above the envelope, as recorded torques may be. [s]
    pub beyond_envelope_s: f64,
}

/// A place outside a map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct OutsideMap {
    /// Time at the start of the interval. [s]
    pub time_s: f64,
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Torque beyond the largest of the map at this speed; zero inside. [Nm]
    pub torque_beyond_nm: f64,
    /// Speed beyond the largest of the map; zero inside. [rpm]
    pub speed_beyond_rpm: f64,
}

impl MachineOfDuty {
    /// The machines of a simulated cycle, in the order of the gearbox.
    pub fn all(t: &Transmission, driven: &Driven) -> Vec<Self> {
        let machines = t.active_machines(driven.start.len() > 1).enumerate();
        machines.map(|(i, machine)| Self::new((i, machine), driven)).collect()
    }

    fn new((i, machine): (usize, &Machine), driven: &Driven) -> Self {
        let of = |stretch: &Stretch| stretch.heats.machines.get(i).copied().unwrap_or_default();
        let sum = |value: fn(&MachineEnergy) -> f64| -> f64 { driven.stretches.iter().map(|s| value(&of(s))).sum() };
        let own = driven
            .stretches
            .iter()
            .filter_map(|s| Some((s.start, *s.machines.get(i)?)));
        let beyond = own.map(|(start, [torque, speed])| (start, [torque, speed], machine.excess(speed, torque)));
        let beyond = beyond.filter(|(.., excess)| *excess != [0.0; 2]);
        // By the power that the excess has.
        let size = |[torque, speed]: [f64; 2], excess: [f64; 2]| excess[0] * speed.abs() + excess[1] * torque.abs();
        let farthest = beyond.max_by(|a, b| size(a.1, a.2).total_cmp(&size(b.1, b.2)));
        let mut longest = 0.0_f64;
        let (mut run, mut count) = (0.0, 0);
        let peak_time = machine.envelope().and_then(|envelope| envelope.peak_time);
        for stretch in &driven.stretches {
            let above = of(stretch).above_continuous;
            if above > 0.0 {
                let before = run;
                run += above;
                count += usize::from(peak_time.is_some_and(|most| before <= most && run > most));
                longest = longest.max(run);
            } else {
                run = 0.0;
            }
        }
        Self {
            machine: machine.path.clone(),
            shaft_j: sum(|energy| energy.shaft),
            loss_j: sum(|energy| energy.machine),
            inverter_j: sum(|energy| energy.inverter),
            outside_map_s: sum(|energy| energy.outside),
            farthest: farthest.map(|(start, [torque, speed], excess)| OutsideMap {
                time_s: start,
                torque_nm: torque,
                speed_rpm: tidy(speed * RPM),
                torque_beyond_nm: excess[0],
                speed_beyond_rpm: tidy(excess[1] * RPM),
            }),
            above_continuous_s: sum(|energy| energy.above_continuous),
            longest_above_continuous_s: longest,
            beyond_peak_time: count,
            beyond_envelope_s: sum(|energy| energy.beyond),
        }
    }
}
