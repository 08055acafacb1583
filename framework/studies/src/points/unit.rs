//! The drive unit at a point: gearbox, machines and inverters from the DC link to the other ports.

use gearloss_framework::machine::{MachineState, Reached};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::table::TableOf;

/// Quantities of the drive unit at a point. Every analysis that solves points has them from here.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UnitPoint {
    /// Power out of the DC link into all machines, negative while they generate. [W]
    pub dc_power_w: f64,
    /// Losses of the machines, with what their maps contain. [W]
    pub machine_loss_w: f64,
    /// Losses of inverters that are described apart. [W]
    pub inverter_loss_w: f64,
    /// Losses of gearbox, machines and inverters. [W]
    pub unit_loss_w: f64,
    /// Power at the other ports over the power of the DC link; while the machines generate, the reciprocal. Absent if no power passes. [-]
    pub system_efficiency: Option<f64>,
    /// The most that a machine reaches of its envelope.
    #[serde(skip)]
    pub reached: Reached,
    /// True if a machine is outside its map.
    #[serde(skip)]
    pub outside: bool,
}

/// A quantity of the drive unit.
pub struct UnitColumn {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Meaning.
    pub meaning: &'static str,
    /// Its value.
    pub read: fn(&UnitPoint) -> Option<f64>,
}

impl UnitPoint {
    /// The quantities as columns of tables of every analysis.
    pub const COLUMNS: [UnitColumn; 5] = [
        UnitColumn {
            name: "dc_power_w",
            unit: "W",
            meaning: "Power out of the DC link into the machines",
            read: |unit| Some(unit.dc_power_w),
        },
        UnitColumn {
            name: "machine_loss_w",
            unit: "W",
            meaning: "Losses of the machines",
            read: |unit| Some(unit.machine_loss_w),
        },
        UnitColumn {
            name: "inverter_loss_w",
            unit: "W",
            meaning: "Losses of inverters that are described apart",
            read: |unit| Some(unit.inverter_loss_w),
        },
        UnitColumn {
            name: "unit_loss_w",
            unit: "W",
            meaning: "Losses of gearbox, machines and inverters",
            read: |unit| Some(unit.unit_loss_w),
        },
        UnitColumn {
            name: "system_efficiency",
            unit: "-",
            meaning: "Power at the other ports over the power of the DC link, while generating the reciprocal",
            read: |unit| unit.system_efficiency,
        },
    ];

    /// From the values of the columns; `None` without a power of the DC link.
    pub fn of_columns(values: [Option<f64>; 5]) -> Option<Self> {
        let [
            dc_power_w,
            machine_loss_w,
            inverter_loss_w,
            unit_loss_w,
            system_efficiency,
        ] = values;
        Some(Self {
            dc_power_w: dc_power_w?,
            machine_loss_w: machine_loss_w?,
            inverter_loss_w: inverter_loss_w?,
            unit_loss_w: unit_loss_w?,
            system_efficiency,
            reached: Reached::Continuous,
            outside: false,
        })
    }

    /// The columns, none without machines.
    pub fn columns(has_machines: bool) -> &'static [UnitColumn] {
        if has_machines { &Self::COLUMNS } else { &[] }
    }

    /// Power at the shafts of the machines over the power of the DC link; while they generate, the reciprocal. Absent if no power passes. \[-\]
    pub fn machine_efficiency(&self) -> Option<f64> {
        let shafts = self.dc_power_w - self.machine_loss_w - self.inverter_loss_w;
        if self.dc_power_w > 0.0 && shafts > 0.0 {
            Some(shafts / self.dc_power_w)
        } else if self.dc_power_w < 0.0 && shafts < 0.0 {
            Some(self.dc_power_w / shafts)
        } else {
            None
        }
    }

    /// Adds the columns of the unit of each row to a table; none if no row has a unit.
    pub fn add_to<R>(table: TableOf<R>, unit: impl Fn(&R) -> Option<&Self>) -> TableOf<R> {
        let has_unit = table.rows().iter().any(|row| unit(row).is_some());
        table.each(Self::columns(has_unit), |table, column| {
            table.number(column.name, column.unit, column.meaning, |row| {
                unit(row).and_then(column.read)
            })
        })
    }

    /// The unit of machines and a gearbox with a loss \[W\]; `None` without machines.
    pub fn new(machines: &[MachineState], loss: f64) -> Option<Self> {
        let sum = |of: fn(&MachineState) -> f64| machines.iter().map(of).sum::<f64>();
        if machines.is_empty() {
            return None;
        }
        let dc_power_w = sum(MachineState::electric);
        let [machine_loss_w, inverter_loss_w] = [sum(|state| state.machine), sum(|state| state.inverter)];
        // What the gearbox does not lose leaves through the other ports.
        let others = sum(MachineState::shaft) - loss;
        let system_efficiency = if dc_power_w > 0.0 && others > 0.0 {
            Some(others / dc_power_w)
        } else if dc_power_w < 0.0 && others < 0.0 {
            Some(dc_power_w / others)
        } else {
            None
        };
        Some(Self {
            dc_power_w,
            machine_loss_w,
            inverter_loss_w,
            unit_loss_w: loss + machine_loss_w + inverter_loss_w,
            system_efficiency,
            reached: machines.iter().map(|state| state.reached).max().unwrap_or_default(),
            outside: machines.iter().any(|state| state.outside),
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn state(torque: f64, machine: f64, inverter: f64) -> MachineState {
        MachineState {
            speed: 100.0,
            torque,
            machine,
            inverter,
            outside: false,
            reached: Reached::Continuous,
        }
    }

    #[test]
    fn powers_balance_from_the_link_to_the_wheels_in_both_directions() {
        assert!(UnitPoint::new(&[], 5.0).is_none());
        let drives = UnitPoint::new(&[state(10.0, 60.0, 40.0)], 100.0).unwrap();
        assert_eq!(drives.dc_power_w, 1100.0);
        assert_eq!(drives.unit_loss_w, 200.0);
        assert_eq!(drives.system_efficiency, Some(900.0 / 1100.0));
        let brakes = UnitPoint::new(&[state(-10.0, 60.0, 40.0)], 100.0).unwrap();
        assert_eq!(brakes.dc_power_w, -900.0);
        assert_eq!(brakes.system_efficiency, Some(900.0 / 1100.0));
        // Losses eat what comes back: no power passes.
        assert_eq!(
            UnitPoint::new(&[state(-1.0, 160.0, 40.0)], 100.0)
                .unwrap()
                .system_efficiency,
            None
        );
    }
}
