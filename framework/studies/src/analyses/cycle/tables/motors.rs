//! Losses of the motors.

use gearloss_fmu::network as fmu;
use gearloss_fmu::table::{Axis, Table};
use gearloss_framework::thermal::network::Load;

use super::losses::{Tabulated, nearest};
use super::ranges::{Ranges, SINGLE, short, spaced, temperature_axis};

/// Speed below which a motor is off without torque. \[rad/s\]
const SLOWEST: f64 = 0.1;

impl Tabulated<'_> {
    /// Losses of the motors, at the reference port over the axes of their own maps.
    pub fn motors(&self) -> Result<Vec<fmu::Source>, String> {
        let mut sources = Vec::new();
        let reference = self.t.ports()[self.t.reference_port()].member;
        for motor in 0..self.network.motors().len() {
            let (member, nodes) = self.network.motor_nodes(motor);
            let own = self.network.motor_axes(motor).filter(|_| member == reference);
            let table = match own {
                Some(axes) => self.own_motor(motor, nodes[1], axes),
                None => self.other_motor(motor, nodes[1])?,
            };
            sources.push(fmu::Source {
                table,
                nodes: nodes.map(|node| node as u32).into(),
                over_speed: false,
            });
        }
        Ok(sources)
    }

    fn own_motor(&self, motor: usize, stator: usize, [mut speeds, torques]: [Vec<f64>; 2]) -> Table {
        speeds.retain(|speed| *speed > SLOWEST);
        speeds.splice(0..0, [0.0, SLOWEST]);
        let mut both: Vec<f64> = torques.iter().rev().map(|torque| -torque).collect();
        both.push(0.0);
        both.extend(torques);
        both.dedup();
        let [cold, hot] = self.ranges.temperatures;
        let same = |(speed, torque): (&f64, &f64)| {
            self.network.motor_loss(motor, *speed, *torque, cold)
                == self.network.motor_loss(motor, *speed, *torque, hot)
        };
        let is_same = speeds
            .iter()
            .all(|speed| both.iter().all(|torque| same((speed, torque))));
        let temperatures = spaced([cold, hot], if is_same { 1 } else { SINGLE });
        let mut values = Vec::new();
        for speed in &speeds {
            for torque in &both {
                for temperature in &temperatures {
                    values.extend(self.network.motor_loss(motor, *speed, *torque, *temperature).map(short));
                }
            }
        }
        let mut axes = vec![
            Axis {
                quantity: fmu::SPEED,
                points: speeds,
            },
            Axis {
                quantity: fmu::TORQUE,
                points: both,
            },
        ];
        if !is_same {
            axes.push(temperature_axis(stator, temperatures));
        }
        Table {
            axes,
            channels: 2,
            values,
        }
    }

    fn other_motor(&self, motor: usize, stator: usize) -> Result<Table, String> {
        let Ranges { torques, speeds, .. } = self.ranges;
        let mut scratch = self.t.batch_scratch(&self.case);
        let temperatures = spaced(self.ranges.temperatures, SINGLE);
        let mut values = vec![0.0; speeds.len() * torques.len() * temperatures.len() * 2];
        for (k, temperature) in temperatures.iter().enumerate() {
            let loads: Vec<Load> = torques
                .iter()
                .flat_map(|torque| speeds[1..].iter().map(move |speed| (*torque, *speed)))
                .map(|(torque, speed)| Load {
                    torque,
                    speed,
                    temperatures: vec![*temperature; self.network.names().len()],
                })
                .collect();
            let heats = self.heats(&loads, &mut scratch);
            for w in 1..speeds.len() {
                for t in 0..torques.len() {
                    let found = nearest(&heats, torques, (t, w - 1), speeds.len() - 1);
                    let (heats, _) = found.ok_or("the losses of a motor have no value")?;
                    let at = ((w * torques.len() + t) * temperatures.len() + k) * 2;
                    values[at..at + 2].copy_from_slice(&heats.motors[motor].map(short));
                }
            }
        }
        let mut axes = self.load_axes();
        axes.push(temperature_axis(stator, temperatures));
        Ok(Table {
            axes,
            channels: 2,
            values,
        })
    }
}
