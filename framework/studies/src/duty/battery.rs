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
    /// The fixed efficiency of the vehicle, if it replaces the losses of the transmission. \[-\]
    pub fixed_efficiency: Option<f64>,
}

/// Energy of a vehicle over a cycle: of the unit of gearbox, machine and battery. Every analysis of cycles has these quantities from here.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Consumption {
    /// Energy drawn from the battery. [kWh/100 km]
    pub drawn_kwh_per_100_km: f64,
    /// Energy recuperated into the battery. [kWh/100 km]
    pub recuperated_kwh_per_100_km: f64,
    /// The difference: consumption. [kWh/100 km]
    pub consumption_kwh_per_100_km: f64,
    /// Part of the consumption that moves the vehicle: energy at the wheels while driving, minus that while braking. [kWh/100 km]
    pub wheels_kwh_per_100_km: f64,
    /// Loss of the transmission. [kWh/100 km]
    pub transmission_kwh_per_100_km: f64,
    /// Loss of the machine, with the inverter if its map contains it. [kWh/100 km]
    pub machine_kwh_per_100_km: f64,
    /// Energy dissipated in the brakes. [kWh/100 km]
    pub brakes_kwh_per_100_km: f64,
    /// Energy of the auxiliaries. [kWh/100 km]
    pub auxiliaries_kwh_per_100_km: f64,
    /// Energy that shifts dissipate, with that of the actuator; absent if gears are not chosen. [kWh/100 km]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shifts_kwh_per_100_km: Option<f64>,
    /// Loss of the battery and of everything else that its efficiencies contain. [kWh/100 km]
    pub battery_kwh_per_100_km: f64,
    /// What the consumption differs from the sum of its parts, relative to the energy that was drawn and recuperated. [-]
    pub residual_share: f64,
    /// Energy at the wheels over electric energy of the machine, while it drives; absent if it never does. [-]
    pub system_efficiency: Option<f64>,
    /// Energy recuperated into the battery over the energy at the wheels while they brake; absent if they never do. [-]
    pub recuperated_share: Option<f64>,
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

/// A quantity of the vehicle as a column of tables.
pub struct ConsumptionColumn {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Meaning.
    pub meaning: &'static str,
    /// Its value.
    pub read: fn(&Consumption) -> Option<f64>,
}

const PER_DISTANCE: &str = "kWh/100 km";

const fn column(
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    read: fn(&Consumption) -> Option<f64>,
) -> ConsumptionColumn {
    ConsumptionColumn {
        name,
        unit,
        meaning,
        read,
    }
}

impl Consumption {
    /// The quantities as columns of tables of every analysis.
    pub const COLUMNS: [ConsumptionColumn; 12] = [
        column(
            "consumption_kwh_per_100_km",
            PER_DISTANCE,
            "Energy from the battery, drawn minus recuperated",
            |c| Some(c.consumption_kwh_per_100_km),
        ),
        column("range_km", "km", "Range with the usable energy", |c| c.range_km),
        column(
            "drawn_kwh_per_100_km",
            PER_DISTANCE,
            "Energy drawn from the battery",
            |c| Some(c.drawn_kwh_per_100_km),
        ),
        column(
            "recuperated_kwh_per_100_km",
            PER_DISTANCE,
            "Energy recuperated into the battery",
            |c| Some(c.recuperated_kwh_per_100_km),
        ),
        column(
            "wheels_kwh_per_100_km",
            PER_DISTANCE,
            "Energy that moves the vehicle",
            |c| Some(c.wheels_kwh_per_100_km),
        ),
        column(
            "transmission_kwh_per_100_km",
            PER_DISTANCE,
            "Loss of the transmission",
            |c| Some(c.transmission_kwh_per_100_km),
        ),
        column("machine_kwh_per_100_km", PER_DISTANCE, "Loss of the machine", |c| {
            Some(c.machine_kwh_per_100_km)
        }),
        column(
            "brakes_kwh_per_100_km",
            PER_DISTANCE,
            "Energy dissipated in the brakes",
            |c| Some(c.brakes_kwh_per_100_km),
        ),
        column(
            "auxiliaries_kwh_per_100_km",
            PER_DISTANCE,
            "Energy of the auxiliaries",
            |c| Some(c.auxiliaries_kwh_per_100_km),
        ),
        column("battery_kwh_per_100_km", PER_DISTANCE, "Loss of the battery", |c| {
            Some(c.battery_kwh_per_100_km)
        }),
        column(
            "system_efficiency",
            "-",
            "Energy at the wheels over electric energy of the machine, while it drives",
            |c| c.system_efficiency,
        ),
        column(
            "recuperated_share",
            "-",
            "Energy into the battery over the braking energy at the wheels",
            |c| c.recuperated_share,
        ),
    ];
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

/// Energies of an interval. \[J\]
struct Moment {
    /// Of the machine into the transmission.
    shaft: f64,
    motor: f64,
    loss: f64,
    /// What moves the vehicle: from the transmission, minus that of the brakes.
    wheels: f64,
    brakes: f64,
    auxiliaries: f64,
    /// Dissipated by a shift.
    shift: f64,
}

/// Where the energy of the battery goes. \[J\]
#[derive(Default)]
struct Parts {
    motor: f64,
    loss: f64,
    wheels: f64,
    brakes: f64,
    auxiliaries: f64,
    shifts: f64,
    /// At the terminals of the battery.
    electric: f64,
    /// Of the machine while it drives, and then at the wheels.
    electric_drive: f64,
    wheels_drive: f64,
    /// At the wheels while they brake, positive.
    wheels_brake: f64,
}

impl Parts {
    fn add(&mut self, moment: &Moment) {
        self.motor += moment.motor;
        self.loss += moment.loss;
        self.wheels += moment.wheels;
        self.brakes += moment.brakes;
        self.auxiliaries += moment.auxiliaries;
        self.shifts += moment.shift;
        self.electric += moment.shaft + moment.motor + moment.auxiliaries;
        if moment.wheels > 0.0 {
            self.electric_drive += moment.shaft + moment.motor;
            self.wheels_drive += moment.wheels;
        } else {
            self.wheels_brake -= moment.wheels;
        }
    }

    /// All but what the battery loses itself.
    fn sum(&self) -> f64 {
        self.wheels + self.brakes + self.loss + self.motor + self.auxiliaries + self.shifts
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
        let mut parts = Parts::default();
        let mut beyond = driven.total.beyond_map;
        for stretch in &driven.stretches {
            let time = stretch.heats.duration;
            let of_transmission = stretch.torque * stretch.speed * time;
            let (motor, outside) = self.motor_loss(stretch, oil);
            beyond |= outside;
            let other = motor + self.entry.auxiliaries * time;
            // What a shift dissipates, the machine supplies; what the rotating parts release, it saves.
            let [heat, released] = stretch.shift.map_or([0.0; 2], |shift| [shift.heat, shift.released]);
            let shaft = match stretch.shift {
                Some(_) => of_transmission + heat - released,
                None => of_transmission,
            };
            let loss = stretch.heats.parts.iter().sum::<f64>();
            let avoidable = if stretch.brakes > 0.0 { 0.0 } else { loss };
            real.add(&self.entry, shaft + other);
            ideal.add(&self.entry, shaft - avoidable + other);
            let (wheels, loss) = self.wheels(stretch, of_transmission, loss);
            let wheels = if stretch.shift.is_some() {
                wheels - released
            } else {
                wheels
            };
            parts.add(&Moment {
                shaft,
                motor,
                loss,
                wheels: wheels - stretch.brakes,
                brakes: stretch.brakes,
                auxiliaries: self.entry.auxiliaries * time,
                shift: heat,
            });
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
            wheels_kwh_per_100_km: per(parts.wheels),
            transmission_kwh_per_100_km: per(parts.loss),
            machine_kwh_per_100_km: per(parts.motor),
            brakes_kwh_per_100_km: per(parts.brakes),
            auxiliaries_kwh_per_100_km: per(parts.auxiliaries),
            shifts_kwh_per_100_km: driven.is_chosen.then(|| per(parts.shifts)),
            battery_kwh_per_100_km: per(real.net() - parts.electric),
            residual_share: (parts.electric - parts.sum()).abs()
                / (real.drawn + real.recuperated).max(f64::MIN_POSITIVE),
            system_efficiency: (parts.electric_drive > 0.0).then(|| parts.wheels_drive / parts.electric_drive),
            recuperated_share: (parts.wheels_brake > 0.0).then(|| real.recuperated / parts.wheels_brake),
            includes_motor: self.motor.is_some() || !driven.total.motors.is_empty(),
            motor_beyond_map: beyond,
            range_km,
            range_lost_in_transmission_km: range_km
                .zip(range(&ideal))
                .filter(|_| self.fixed_efficiency.is_none())
                .map(|(real, ideal)| ideal - real),
            range_difference_km: None,
        })
    }

    /// Energy into the wheels from the transmission in an interval, and the loss on the way. \[J\]
    fn wheels(&self, stretch: &Stretch, shaft: f64, loss: f64) -> (f64, f64) {
        match (self.fixed_efficiency, stretch.wheels) {
            (Some(efficiency), _) => {
                let wheels = if shaft > 0.0 {
                    shaft * efficiency
                } else {
                    shaft / efficiency
                };
                (wheels, shaft - wheels)
            }
            (None, Some(wheels)) => (wheels, loss),
            (None, None) => (shaft - loss, loss),
        }
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
