//! Energy from and into the battery of a vehicle: consumption, recuperation, range.

use gearloss_framework::motor::MotorMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::points::{Driven, Stretch};

/// A battery and what it supplies besides the motor.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct BatteryEntry {
    /// Usable energy. [kWh]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub energy: f64,
    /// Energy at the motor's terminals over the energy drawn from the cells: battery, cables and, unless the motor map has it, the inverter. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub efficiency: f64,
    /// The same for energy into the battery; default: `efficiency`. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub charge_efficiency: Option<f64>,
    /// Power of other consumers, drawn all the time, also from recuperated energy. [W]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub auxiliaries: f64,
}

/// A battery with the losses of the motor that it supplies.
#[derive(Debug, Clone)]
pub struct Battery {
    /// The battery.
    pub entry: BatteryEntry,
    /// Losses of the motor at the reference port, if the thermal network has no motor.
    pub motor: Option<MotorMap>,
    /// True if a fixed efficiency of the vehicle replaces the losses of the transmission.
    pub fixed_efficiency: bool,
}

/// Energy of a vehicle over a cycle.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Consumption {
    /// Energy drawn from the battery. [kWh/100 km]
    pub drawn_kwh_per_100_km: f64,
    /// Energy recuperated into the battery. [kWh/100 km]
    pub recuperated_kwh_per_100_km: f64,
    /// The difference: consumption. [kWh/100 km]
    pub consumption_kwh_per_100_km: f64,
    /// True if losses of a motor are part of it.
    pub includes_motor: bool,
    /// True if a motor was outside its map.
    pub motor_beyond_map: bool,
    /// Range with the usable energy; absent if more is recuperated than drawn. [km]
    pub range_km: Option<f64>,
    /// Range that the losses of the transmission cost; absent without a range, or if a fixed efficiency replaces them. [km]
    pub range_lost_in_transmission_km: Option<f64>,
    /// Range minus that of the first model set in the same cycle; absent for the first. [km]
    pub range_difference_km: Option<f64>,
}

/// 1 kWh/100 km. \[J/m\]
const KWH_PER_100_KM: f64 = 36.0;

/// Sums over a cycle.
#[derive(Default)]
struct Energies {
    /// Drawn from the battery, positive. \[J\]
    drawn: f64,
    /// Stored in the battery, positive. \[J\]
    recuperated: f64,
}

impl Energies {
    fn add(&mut self, battery: &BatteryEntry, electric: f64) {
        if electric > 0.0 {
            self.drawn += electric / battery.efficiency;
        } else {
            self.recuperated -= electric * battery.charge_efficiency.unwrap_or(battery.efficiency);
        }
    }

    fn net(&self) -> f64 {
        self.drawn - self.recuperated
    }
}

impl Battery {
    /// The consumption over a simulated cycle of a vehicle; absent without distance, and if the simulation broke off. `oil` is the number of the
    /// oil among the temperatures.
    ///
    /// The motor takes the power of the reference port at the end of each interval. What the transmission costs is the consumption without its losses at
    /// the same wheels; where the brakes supply a part of the deceleration, the motor is at its limit and recuperates no more without them.
    pub fn consumption(&self, driven: &Driven, oil: usize) -> Option<Consumption> {
        let distance = distance(driven).filter(|_| driven.broken.is_none())?;
        let (mut real, mut ideal) = (Energies::default(), Energies::default());
        let mut beyond = driven.total.beyond_map;
        for stretch in &driven.stretches {
            let time = stretch.heats.duration;
            let shaft = stretch.torque * stretch.speed * time;
            let (motor, outside) = self.motor_loss(stretch, oil);
            beyond |= outside;
            let other = motor + self.entry.auxiliaries * time;
            let loss = stretch.heats.parts.iter().sum::<f64>();
            let avoidable = if stretch.brakes > 0.0 { 0.0 } else { loss };
            real.add(&self.entry, shaft + other);
            ideal.add(&self.entry, shaft - avoidable + other);
        }
        let per = |energy: f64| energy / distance / KWH_PER_100_KM;
        let range = |energies: &Energies| {
            let net = per(energies.net());
            (net > 0.0).then(|| 100.0 * self.entry.energy / 3.6e6 / net)
        };
        let range_km = range(&real);
        Some(Consumption {
            drawn_kwh_per_100_km: per(real.drawn),
            recuperated_kwh_per_100_km: per(real.recuperated),
            consumption_kwh_per_100_km: per(real.net()),
            includes_motor: self.motor.is_some() || !driven.total.motors.is_empty(),
            motor_beyond_map: beyond,
            range_km,
            range_lost_in_transmission_km: range_km
                .zip(range(&ideal))
                .filter(|_| !self.fixed_efficiency)
                .map(|(real, ideal)| ideal - real),
            range_difference_km: None,
        })
    }

    /// Loss of the motor in an interval, and whether it is outside its map. \[J\]
    fn motor_loss(&self, stretch: &Stretch, oil: usize) -> (f64, bool) {
        match &self.motor {
            Some(map) => {
                let oil = stretch.temperatures.get(oil).or(stretch.temperatures.first());
                let oil = oil.copied().unwrap_or(f64::NAN);
                let read = map.loss(stretch.speed, stretch.torque, oil);
                (read.loss * stretch.heats.duration, read.outside)
            }
            None => (stretch.heats.motors.iter().flatten().sum(), false),
        }
    }
}

/// Distance of the vehicle. \[m\]
pub fn distance(driven: &Driven) -> Option<f64> {
    let distances = driven.stretches.iter();
    let distances = distances.map(|s| Some(s.vehicle_speed? * s.heats.duration));
    distances.sum::<Option<f64>>().filter(|distance| *distance > 0.0)
}
