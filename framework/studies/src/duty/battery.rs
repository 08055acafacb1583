//! Energy from and into the battery of a vehicle: consumption, recuperation, range.

mod cells;

use gearloss_framework::machine::{Machine, MachineEnergy};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use self::cells::CellsEntry;
use self::cells::{Cells, Drawn};
use crate::points::{Driven, Stretch};

/// A battery and what it supplies besides the motor.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
pub struct BatteryEntry {
    /// Usable energy. [kWh]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub energy: f64,
    /// Energy at the motor's terminals over the energy drawn from the cells: battery, cables and, unless the motor map has it, the inverter; not with
    /// `cells`. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub efficiency: Option<f64>,
    /// The same for energy into the battery; default: `efficiency`. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub charge_efficiency: Option<f64>,
    /// Open-circuit voltage and resistance, instead of `efficiency`.
    pub cells: Option<CellsEntry>,
    /// Power of other consumers at the DC link, drawn all the time, also from recuperated energy. [W]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub auxiliaries: f64,
}

/// A battery with the losses of the motor that it supplies.
#[derive(Debug, Clone)]
pub struct Battery {
    /// The battery.
    pub entry: BatteryEntry,
    /// The machine of `motor_map` at the reference port, if the gearbox describes none.
    pub motor: Option<Machine>,
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
    /// Loss of inverters that are described apart. [kWh/100 km]
    pub inverter_kwh_per_100_km: f64,
    /// Energy dissipated in the brakes. [kWh/100 km]
    pub brakes_kwh_per_100_km: f64,
    /// Energy of the auxiliaries. [kWh/100 km]
    pub auxiliaries_kwh_per_100_km: f64,
    /// Energy that shifts dissipate, with that of the actuator; absent if gears are not chosen. [kWh/100 km]
    pub shifts_kwh_per_100_km: Option<f64>,
    /// Loss of the battery and of everything else that its efficiencies contain. [kWh/100 km]
    pub battery_kwh_per_100_km: f64,
    /// Energy that the battery could not supply; part of no consumption. [kWh/100 km]
    pub shortfall_kwh_per_100_km: f64,
    /// Energy by which the vehicle lacks drive at its wheels, because a machine is at its envelope. [kWh/100 km]
    pub lacking_kwh_per_100_km: f64,
    /// Number of intervals in which the battery is at its limit. [-]
    pub battery_limited: usize,
    /// Number of intervals in which a machine is limited by its envelope. [-]
    pub machine_limited: usize,
    /// What the consumption differs from the sum of its parts, relative to the energy that was drawn and recuperated. [-]
    pub residual_share: f64,
    /// The largest such difference of an interval, relative to the largest energy of the interval. [-]
    pub interval_residual_share: f64,
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
    pub const COLUMNS: [ConsumptionColumn; 14] = [
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
        column(
            "inverter_kwh_per_100_km",
            PER_DISTANCE,
            "Loss of inverters that are described apart",
            |c| Some(c.inverter_kwh_per_100_km),
        ),
        column(
            "lacking_kwh_per_100_km",
            PER_DISTANCE,
            "Energy that the vehicle lacks at its wheels because a machine or the battery is limited",
            |c| Some(c.lacking_kwh_per_100_km + c.shortfall_kwh_per_100_km),
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
struct Energies {
    source: Source,
    /// Drawn from the battery, positive. \[J\]
    drawn: f64,
    /// Stored in the battery, positive. \[J\]
    recuperated: f64,
}

/// The law of the battery: one of the two.
enum Source {
    /// Of energy at the terminals over energy of the cells, drawn and charged.
    Efficiency([f64; 2]),
    Cells(Cells),
}

impl Energies {
    fn new(battery: &BatteryEntry) -> Self {
        // One of the two is stated: this is checked where the battery is read.
        let source = if let Some(cells) = &battery.cells {
            Source::Cells(Cells::new(cells))
        } else {
            let efficiency = battery.efficiency.unwrap_or(1.0);
            Source::Efficiency([efficiency, battery.charge_efficiency.unwrap_or(efficiency)])
        };
        Self {
            source,
            drawn: 0.0,
            recuperated: 0.0,
        }
    }

    /// Adds the energy at the terminals of an interval; returns what the battery supplied or took of it. \[J\]
    fn add(&mut self, electric: f64, time: f64) -> Drawn {
        match &mut self.source {
            Source::Efficiency([drawn, charged]) => {
                if electric > 0.0 {
                    self.drawn += electric / *drawn;
                } else {
                    self.recuperated -= electric * *charged;
                }
                Drawn {
                    terminals: electric,
                    limited: false,
                }
            }
            Source::Cells(cells) => {
                let (cell_energy, drawn) = cells.pass(electric, time);
                if cell_energy > 0.0 {
                    self.drawn += cell_energy;
                } else {
                    self.recuperated -= cell_energy;
                }
                drawn
            }
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
    inverter: f64,
    loss: f64,
    /// What moves the vehicle: from the transmission, minus that of the brakes.
    wheels: f64,
    brakes: f64,
    auxiliaries: f64,
    /// Dissipated by a shift.
    shift: f64,
}

impl Moment {
    /// At the DC link.
    fn electric(&self) -> f64 {
        self.shaft + self.motor + self.inverter + self.auxiliaries
    }

    /// All that it becomes.
    fn sum(&self) -> f64 {
        self.wheels + self.brakes + self.loss + self.motor + self.inverter + self.auxiliaries + self.shift
    }

    /// Difference of both, relative to the largest of them.
    fn residual(&self) -> f64 {
        let parts = [
            self.shaft,
            self.wheels,
            self.brakes,
            self.motor,
            self.auxiliaries,
            self.loss,
        ];
        let largest = parts.iter().fold(f64::MIN_POSITIVE, |most, part| most.max(part.abs()));
        (self.electric() - self.sum()).abs() / largest
    }
}

/// Where the energy of the battery goes. \[J\]
#[derive(Default)]
struct Parts {
    motor: f64,
    inverter: f64,
    loss: f64,
    wheels: f64,
    brakes: f64,
    auxiliaries: f64,
    shifts: f64,
    /// At the terminals of the battery.
    electric: f64,
    /// That the battery did not supply.
    shortfall: f64,
    /// Of the machine while it drives, and then at the wheels.
    electric_drive: f64,
    wheels_drive: f64,
    /// At the wheels while they brake, positive.
    wheels_brake: f64,
    /// Largest relative residual of an interval.
    residual: f64,
}

impl Parts {
    fn add(&mut self, moment: &Moment) {
        self.motor += moment.motor;
        self.inverter += moment.inverter;
        self.loss += moment.loss;
        self.wheels += moment.wheels;
        self.brakes += moment.brakes;
        self.auxiliaries += moment.auxiliaries;
        self.shifts += moment.shift;
        self.electric += moment.shaft + (moment.motor + moment.inverter) + moment.auxiliaries;
        self.residual = self.residual.max(moment.residual());
        if moment.wheels > 0.0 {
            self.electric_drive += moment.shaft + (moment.motor + moment.inverter);
            self.wheels_drive += moment.wheels;
        } else {
            self.wheels_brake -= moment.wheels;
        }
    }

    /// What the battery supplied of the energy of an interval: what it did not take, the brakes did.
    fn supply(&mut self, electric: f64, drawn: Drawn) {
        let rest = electric - drawn.terminals;
        if rest > 0.0 {
            self.shortfall += rest;
        } else if rest < 0.0 {
            self.brakes -= rest;
            self.electric -= rest;
        }
    }

    /// All but what the battery loses itself.
    fn sum(&self) -> f64 {
        self.wheels + self.brakes + self.loss + (self.motor + self.inverter) + self.auxiliaries + self.shifts
    }
}

impl Battery {
    /// The consumption over a simulated cycle of a vehicle; absent without distance, and if the simulation broke off. `oil` is the number of the
    /// oil among the temperatures.
    ///
    /// A machine of `motor_map` takes the power of the reference port at the end of each interval. What the transmission costs is the consumption without
    /// its losses at the same wheels; where the brakes supply a part of the deceleration, the motor is at its limit and recuperates no more without them.
    pub fn consumption(&self, driven: &Driven, oil: usize) -> Option<Consumption> {
        let distance = distance(driven).filter(|_| driven.broken.is_none())?;
        let (mut real, mut ideal) = (Energies::new(&self.entry), Energies::new(&self.entry));
        let mut parts = Parts::default();
        let mut beyond = driven.total.beyond_map;
        let (mut battery_limited, mut machine_limited) = (0, 0);
        for stretch in &driven.stretches {
            let time = stretch.heats.duration;
            let machines = self.machines(stretch, oil);
            let sum = |of: fn(&MachineEnergy) -> f64| machines.iter().map(of).sum::<f64>();
            let of_transmission = if machines.is_empty() {
                stretch.torque * stretch.speed * time
            } else {
                sum(|machine| machine.shaft)
            };
            // What a shift dissipates, the machine supplies; what the rotating parts release, it saves.
            let [heat, released] = stretch.shift.map_or([0.0; 2], |shift| [shift.heat, shift.released]);
            let shaft = match stretch.shift {
                Some(_) => of_transmission + heat - released,
                None => of_transmission,
            };
            let (motor, inverter) = (sum(|machine| machine.machine), sum(|machine| machine.inverter));
            beyond |= machines.iter().any(|machine| machine.outside > 0.0);
            machine_limited += usize::from(stretch.lacking > 0.0);
            let auxiliaries = self.entry.auxiliaries * time;
            let other = (motor + inverter) + auxiliaries;
            let loss = stretch.heats.parts.iter().sum::<f64>();
            let avoidable = if stretch.brakes > 0.0 { 0.0 } else { loss };
            let drawn = real.add(shaft + other, time);
            battery_limited += usize::from(drawn.limited);
            ideal.add(shaft - avoidable + other, time);
            let (wheels, loss) = self.wheels(stretch, of_transmission, loss);
            // Torques that change within the interval: the brakes take what leaves the transmission beyond the demand.
            let brakes = match stretch
                .wheels
                .filter(|_| self.fixed_efficiency.is_none() && !machines.is_empty())
            {
                Some(at_end) if stretch.brakes > 0.0 => stretch.brakes + (wheels - at_end),
                _ => stretch.brakes,
            };
            parts.add(&Moment {
                shaft,
                motor,
                inverter,
                loss,
                wheels: wheels - brakes - released,
                brakes,
                auxiliaries,
                shift: heat,
            });
            parts.supply(shaft + other, drawn);
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
            inverter_kwh_per_100_km: per(parts.inverter),
            brakes_kwh_per_100_km: per(parts.brakes),
            auxiliaries_kwh_per_100_km: per(parts.auxiliaries),
            shifts_kwh_per_100_km: driven.is_chosen.then(|| per(parts.shifts)),
            battery_kwh_per_100_km: per(real.net() - (parts.electric - parts.shortfall)),
            shortfall_kwh_per_100_km: per(parts.shortfall),
            lacking_kwh_per_100_km: per(driven.stretches.iter().map(|stretch| stretch.lacking).sum()),
            battery_limited,
            machine_limited,
            residual_share: (parts.electric - parts.sum()).abs()
                / (real.drawn + real.recuperated).max(f64::MIN_POSITIVE),
            interval_residual_share: parts.residual,
            system_efficiency: (parts.electric_drive > 0.0).then(|| parts.wheels_drive / parts.electric_drive),
            recuperated_share: (parts.wheels_brake > 0.0).then(|| real.recuperated / parts.wheels_brake),
            includes_motor: self.motor.is_some() || !driven.total.machines.is_empty(),
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
            (None, Some(wheels)) if stretch.heats.machines.is_empty() => (wheels, loss),
            // With the energies of machines over the interval, also where the torque changes within it.
            (None, _) => (shaft - loss, loss),
        }
    }

    /// Energies of the machines in an interval: of those that the gearbox describes, or of that of `motor_map`.
    fn machines(&self, stretch: &Stretch, oil: usize) -> Vec<MachineEnergy> {
        let Some(motor) = &self.motor else {
            return stretch.heats.machines.clone();
        };
        let oil = stretch.temperatures.get(oil).or(stretch.temperatures.first());
        let oil = oil.copied().unwrap_or(f64::NAN);
        let time = stretch.heats.duration;
        let loss = motor.loss(stretch.speed, stretch.torque, oil);
        vec![MachineEnergy {
            shaft: stretch.torque * stretch.speed * time,
            machine: loss.machine * time,
            inverter: loss.inverter * time,
            outside: if loss.outside { time } else { 0.0 },
            ..MachineEnergy::default()
        }]
    }
}

/// Distance of the vehicle. \[m\]
pub fn distance(driven: &Driven) -> Option<f64> {
    let distances = driven.stretches.iter();
    let distances = distances.map(|s| Some(s.vehicle_speed? * s.heats.duration));
    distances.sum::<Option<f64>>().filter(|distance| *distance > 0.0)
}
