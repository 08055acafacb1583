//! Cells of a battery by open-circuit voltage and resistance over the state of charge.
//!
//! U = U0 - R I and P = U I give I = 2 P/(U0 + sqrt(U0^2 - 4 R P)), positive in discharge. The state of charge changes by
//! -eta I/(3600 Q), with the coulombic efficiency eta while charging.

use schemars::JsonSchema;
use serde::Deserialize;

use gearloss_framework::table::clamped;

/// Cells of a battery: U = U0 - R I.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
pub struct CellsEntry {
    /// Open-circuit voltage and resistance over the state of charge: linear between the values, constant beyond.
    #[schemars(length(min = 1))]
    pub over_charge: Vec<CellAt>,
    /// Capacity, from which the state of charge follows; without it the state remains that of the start. [Ah]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub capacity: Option<f64>,
    /// State of charge at the start of a cycle. The default is assumed. [-]
    #[serde(default = "start")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub start: f64,
    /// Least voltage at the terminals, which limits the power of discharge. [V]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub least_voltage: Option<f64>,
    /// Greatest voltage at the terminals, which limits the power of charging. [V]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub greatest_voltage: Option<f64>,
    /// Charge that is stored over charge that flows in; the default neglects the difference. [-]
    #[serde(default = "one")]
    #[schemars(range(min = 0.5, max = 1.0))]
    pub coulombic_efficiency: f64,
}

/// A battery at a state of charge.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct CellAt {
    /// State of charge; increases along the list. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub charge: f64,
    /// Open-circuit voltage of the whole battery. [V]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub voltage: f64,
    /// Resistance of the whole battery. [ohm]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub resistance: f64,
    /// Resistance while charging; default: `resistance`. [ohm]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub charge_resistance: Option<f64>,
}

fn start() -> f64 {
    0.8
}

fn one() -> f64 {
    1.0
}

/// What a battery supplied in an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drawn {
    /// Energy at its terminals. \[J\]
    pub terminals: f64,
    /// True if it is at a limit.
    pub limited: bool,
}

/// Cells during a cycle.
pub(super) struct Cells {
    entry: CellsEntry,
    /// \[-\]
    charge: f64,
}

impl CellsEntry {
    /// What is wrong with it, with its key.
    pub fn fault(&self) -> Option<(&'static str, String)> {
        let charges = self.over_charge.windows(2);
        if charges.clone().any(|pair| pair[1].charge <= pair[0].charge) {
            return Some(("over_charge", "the states of charge do not increase".to_owned()));
        }
        let voltages = || self.over_charge.iter().map(|at| at.voltage);
        let least = voltages().fold(f64::INFINITY, f64::min);
        if self.least_voltage.is_some_and(|limit| limit >= least) {
            let message = format!("it is not below the lowest open-circuit voltage, {least} V");
            return Some(("least_voltage", message));
        }
        let greatest = voltages().fold(0.0, f64::max);
        if self.greatest_voltage.is_some_and(|limit| limit <= greatest) {
            let message = format!("it is not above the highest open-circuit voltage, {greatest} V");
            return Some(("greatest_voltage", message));
        }
        None
    }
}

impl Cells {
    pub fn new(entry: &CellsEntry) -> Self {
        Self {
            charge: entry.start,
            entry: entry.clone(),
        }
    }

    /// Voltage and resistance at the state of charge, for discharge and charging. \[V, ohm\]
    fn at(&self) -> (f64, [f64; 2]) {
        let list = &self.entry.over_charge;
        let charges: Vec<f64> = list.iter().map(|at| at.charge).collect();
        let of =
            |value: fn(&CellAt) -> f64| clamped(&charges, &list.iter().map(value).collect::<Vec<_>>(), self.charge);
        let charging = of(|at| at.charge_resistance.unwrap_or(at.resistance));
        (of(|at| at.voltage), [of(|at| at.resistance), charging])
    }

    /// Passes an energy at the terminals in a time; returns that of the cells, negative if stored. \[J\]
    pub fn pass(&mut self, energy: f64, time: f64) -> (f64, Drawn) {
        if time <= 0.0 {
            let none = Drawn {
                terminals: 0.0,
                limited: false,
            };
            return (0.0, none);
        }
        let wanted = energy / time;
        let (voltage, [discharging, charging]) = self.at();
        let resistance = if wanted > 0.0 { discharging } else { charging };
        let power = wanted.clamp(
            self.least_power(voltage, charging),
            self.greatest_power(voltage, discharging),
        );
        // Where the power is the greatest possible, rounding may leave a negative number.
        let root = (voltage * voltage - 4.0 * resistance * power).max(0.0).sqrt();
        let current = 2.0 * power / (voltage + root);
        let stored = if current < 0.0 {
            self.entry.coulombic_efficiency
        } else {
            1.0
        };
        if let Some(capacity) = self.entry.capacity {
            self.charge = (self.charge - stored * current * time / capacity).clamp(0.0, 1.0);
        }
        let limited = power != wanted;
        let drawn = Drawn {
            terminals: if limited { power * time } else { energy },
            limited,
        };
        (stored * voltage * current * time, drawn)
    }

    fn greatest_power(&self, voltage: f64, resistance: f64) -> f64 {
        if resistance == 0.0 {
            return f64::INFINITY;
        }
        let possible = voltage * voltage / (4.0 * resistance);
        // Below half of the open-circuit voltage the power decreases again.
        let of_least = self.entry.least_voltage.filter(|least| *least > 0.5 * voltage);
        of_least.map_or(possible, |least| least * (voltage - least) / resistance)
    }

    fn least_power(&self, voltage: f64, resistance: f64) -> f64 {
        let greatest = self.entry.greatest_voltage.filter(|_| resistance > 0.0);
        greatest.map_or(f64::NEG_INFINITY, |greatest| {
            -greatest * (greatest - voltage).max(0.0) / resistance
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells() -> Cells {
        Cells::new(&CellsEntry {
            over_charge: vec![CellAt {
                charge: 0.5,
                voltage: 360.0,
                resistance: 0.1,
                charge_resistance: None,
            }],
            capacity: Some(200.0 * 3600.0),
            start: 0.5,
            least_voltage: Some(300.0),
            greatest_voltage: Some(400.0),
            coulombic_efficiency: 1.0,
        })
    }

    fn close(value: f64, expected: f64) {
        assert!(
            (value - expected).abs() <= 1e-8 * expected.abs(),
            "{value} is not {expected}"
        );
    }

    /// The quadratic equation of the terminal power, solved independently.
    #[test]
    fn the_current_is_the_smaller_root() {
        for (power, current) in [(10e3, 27.995_485_3), (100e3, 303.337_045), (-50e3, -133.907_961)] {
            let (of_cells, drawn) = cells().pass(power, 1.0);
            close(of_cells, 360.0 * current);
            close(of_cells - power, 0.1 * current * current);
            assert!(!drawn.limited && drawn.terminals == power);
        }
        let mut discharged = cells();
        discharged.pass(10e3 * 60.0, 60.0);
        close(discharged.charge - 0.5, -0.002_332_957_11);
        let mut charged = cells();
        charged.entry.coulombic_efficiency = 0.99;
        charged.pass(-50e3 * 60.0, 60.0);
        close(charged.charge - 0.5, 0.011_047_406_8);
    }

    #[test]
    fn voltages_limit_the_power() {
        for (power, limit) in [(200e3, 180e3), (-200e3, -160e3)] {
            let (_, drawn) = cells().pass(2.0 * power, 2.0);
            close(drawn.terminals, 2.0 * limit);
            assert!(drawn.limited);
        }
        let mut unlimited = cells();
        (unlimited.entry.least_voltage, unlimited.entry.greatest_voltage) = (None, None);
        let (of_cells, drawn) = unlimited.pass(400e3, 1.0);
        close(drawn.terminals, 324e3);
        close(of_cells, 2.0 * 324e3);
        // Without resistance nothing is lost or limited.
        unlimited.entry.over_charge[0].resistance = 0.0;
        close(unlimited.pass(400e3, 1.0).0, 400e3);
    }
}
