//! Losses of the transmission as heat into the nodes.

use gearloss_fmu::network as fmu;
use gearloss_fmu::table::{Axis, Table};
use gearloss_framework::evaluate::{BatchScratch, PowerFlow};
use gearloss_framework::thermal::network::{Load, Network, NodeHeats};
use gearloss_framework::transmission::{Case, Transmission};

use super::ranges::{Ranges, short, temperature_axis};
use super::sweep::{Group, Sweep, TEMPERATURES};
use crate::analyses::{Engine, Stopped};
use crate::numbers::RPM;

/// A loss depends on the temperature of a node if that changes it by more than this share over [`PROBE`].
const MATTERS: f64 = 2e-3;
/// Change of temperature by which dependence is found. \[K\]
const PROBE: f64 = 20.0;

/// Why there are no tables.
pub enum Failed {
    /// A loss or a conductance has no value.
    Undefined(String),
    /// The analysis ends.
    Stopped(Stopped),
}

impl From<Stopped> for Failed {
    fn from(stopped: Stopped) -> Self {
        Self::Stopped(stopped)
    }
}

impl From<String> for Failed {
    fn from(what: String) -> Self {
        Self::Undefined(what)
    }
}

/// Tabulation of one gear.
pub struct Tabulated<'a> {
    pub t: &'a Transmission,
    pub network: &'a Network,
    pub ranges: &'a Ranges,
    pub case: Case,
    pub flow: PowerFlow,
}

impl Tabulated<'_> {
    fn middle(&self) -> f64 {
        0.5 * (self.ranges.temperatures[0] + self.ranges.temperatures[1])
    }

    pub fn heats(&self, loads: &[Load], scratch: &mut BatchScratch) -> Vec<Option<NodeHeats>> {
        let found = self.t.node_heats(self.network, &self.case, self.flow, loads, scratch);
        found.into_iter().map(Result::ok).collect()
    }

    /// Groups of parts by the nodes whose temperatures change their losses.
    fn groups(&self, scratch: &mut BatchScratch) -> Result<Vec<Group>, String> {
        let count = self.network.names().len();
        let Ranges { torques, speeds, .. } = self.ranges;
        let even = vec![self.middle(); count];
        let mut strength = vec![vec![0.0_f64; count]; self.t.parts().len()];
        let mut heated = vec![Vec::new(); self.t.parts().len()];
        let [fast, slow] = [speeds.len() / 2, speeds.len() / 6 + 1].map(|i| speeds[i]);
        let mut is_known = false;
        for torque in [0.6 * torques[0], 0.0, 0.6 * torques[torques.len() - 1]] {
            for speed in [slow, fast] {
                let load = |temperatures: Vec<f64>| Load {
                    torque,
                    speed,
                    temperatures,
                };
                let mut loads = vec![load(even.clone())];
                for node in 0..count {
                    let mut probed = even.clone();
                    probed[node] -= PROBE;
                    loads.push(load(probed));
                }
                let Some(all) = self.heats(&loads, scratch).into_iter().collect::<Option<Vec<_>>>() else {
                    continue;
                };
                is_known = true;
                let watts =
                    |heats: &NodeHeats, part: usize| heats.parts[part].iter().map(|(_, watts)| watts).sum::<f64>();
                for part in 0..self.t.parts().len() {
                    let base = watts(&all[0], part);
                    if heated[part].is_empty() {
                        heated[part] = all[0].parts[part].iter().map(|(node, _)| *node).collect();
                    }
                    for node in 0..count {
                        let change = (watts(&all[node + 1], part) / base - 1.0).abs();
                        if change.is_finite() {
                            strength[part][node] = strength[part][node].max(change);
                        }
                    }
                }
            }
        }
        if !is_known {
            return Err("no loss has a value in the middle of the tables".to_owned());
        }
        let mut groups: Vec<Group> = Vec::new();
        for (part, (strength, heated)) in strength.iter().zip(heated).enumerate() {
            let mut nodes: Vec<usize> = (0..count).filter(|node| strength[*node] > MATTERS).collect();
            nodes.sort_by(|a, b| strength[*b].total_cmp(&strength[*a]));
            nodes.truncate(TEMPERATURES.len() - 1);
            match groups.iter_mut().find(|group| group.nodes == nodes) {
                Some(group) => {
                    group.parts.push(part);
                    let more: Vec<usize> = heated.into_iter().filter(|node| !group.heated.contains(node)).collect();
                    group.heated.extend(more);
                }
                None => groups.push(Group {
                    nodes,
                    parts: vec![part],
                    heated,
                }),
            }
        }
        Ok(groups)
    }

    /// Losses as heat into nodes over the speed of the reference port, and the number of loads without losses.
    pub fn losses(&self, engine: &Engine<'_>, gear: &str) -> Result<(Vec<fmu::Source>, usize), Failed> {
        let mut scratch = self.t.batch_scratch(&self.case);
        let Ranges { torques, speeds, .. } = self.ranges;
        let groups = self.groups(&mut scratch)?;
        let mut filled = 0;
        let mut sources: Vec<Option<fmu::Source>> = groups.iter().map(|_| None).collect();
        for sweep in Sweep::all(&groups, self.network.names().len(), self.ranges.temperatures) {
            let combinations = sweep.len();
            let label = format!("tables, gear {gear}");
            let solve = |combination| Ok(self.solve(&groups, &sweep, combination));
            let solved = engine.jobs(&label, combinations, solve)?;
            for place in &sweep.groups {
                let group = &groups[*place];
                let mut axes = self.load_axes();
                let temperatures = group.nodes.iter().zip(&sweep.axes);
                axes.extend(temperatures.map(|(node, axis)| temperature_axis(*node, axis.clone())));
                let channels = group.heated.len();
                sources[*place] = Some(fmu::Source {
                    table: Table {
                        axes,
                        channels,
                        values: vec![0.0; speeds.len() * torques.len() * combinations * channels],
                    },
                    nodes: group.heated.iter().map(|node| *node as u32).collect(),
                    over_speed: true,
                });
            }
            for (combination, solved) in solved.into_iter().enumerate() {
                let (losses, missing) = solved.map_err(Failed::Undefined)?;
                filled += missing;
                for (place, losses) in sweep.groups.iter().zip(losses) {
                    let Some(source) = &mut sources[*place] else { continue };
                    let channels = source.table.channels;
                    for (load, values) in losses.chunks(channels.max(1)).enumerate() {
                        let at = (load * combinations + combination) * channels;
                        source.table.values[at..at + channels].copy_from_slice(values);
                    }
                }
            }
        }
        Ok((sources.into_iter().flatten().collect(), filled))
    }

    /// Heat over speed of each group of a sweep at all loads and one combination of temperatures: by speed, torque and heated node; and the
    /// number of loads without losses.
    fn solve(&self, groups: &[Group], sweep: &Sweep, combination: usize) -> Result<(Vec<Vec<f64>>, usize), String> {
        let Ranges { torques, speeds, .. } = self.ranges;
        let temperatures = sweep.temperatures(combination, self.middle());
        let loads: Vec<Load> = torques
            .iter()
            .flat_map(|torque| speeds[1..].iter().map(move |speed| (*torque, *speed)))
            .map(|(torque, speed)| Load {
                torque,
                speed,
                temperatures: temperatures.clone(),
            })
            .collect();
        let heats = self.heats(&loads, &mut self.t.batch_scratch(&self.case));
        let mut losses: Vec<Vec<f64>> = sweep
            .groups
            .iter()
            .map(|place| vec![0.0; speeds.len() * torques.len() * groups[*place].heated.len()])
            .collect();
        let mut filled = 0;
        for w in 0..speeds.len() {
            // At standstill as at the lowest speed: over the speed, the heat of friction has a limit.
            let column = w.max(1) - 1;
            for t in 0..torques.len() {
                let Some((heats, is_own)) = nearest(&heats, torques, (t, column), speeds.len() - 1) else {
                    let rpm = speeds[column + 1] * RPM;
                    return Err(format!("at {rpm:.0} rpm no torque has losses with a value"));
                };
                filled += usize::from(!is_own && w > 0);
                for (place, values) in sweep.groups.iter().zip(&mut losses) {
                    let group = &groups[*place];
                    let at = (w * torques.len() + t) * group.heated.len();
                    for (node, watts) in group.parts.iter().flat_map(|part| &heats.parts[*part]) {
                        let channel = group.heated.iter().position(|heated| heated == node).unwrap_or(0);
                        values[at + channel] += watts / speeds[column + 1];
                    }
                }
            }
        }
        for value in losses.iter_mut().flatten() {
            *value = short(*value);
        }
        Ok((losses, filled))
    }

    pub fn load_axes(&self) -> Vec<Axis> {
        [(fmu::SPEED, &self.ranges.speeds), (fmu::TORQUE, &self.ranges.torques)]
            .map(|(quantity, points)| Axis {
                quantity,
                points: points.clone(),
            })
            .into()
    }
}

/// The heat at a torque and a speed, or at the next torque towards zero that has one; whether it is that of the torque itself.
pub fn nearest<'h>(
    heats: &'h [Option<NodeHeats>],
    torques: &[f64],
    (torque, column): (usize, usize),
    moving: usize,
) -> Option<(&'h NodeHeats, bool)> {
    let mut order: Vec<usize> = (0..torques.len()).collect();
    order.sort_by(|a, b| {
        (torques[*a] - torques[torque])
            .abs()
            .total_cmp(&(torques[*b] - torques[torque]).abs())
    });
    let smaller = order.into_iter().filter(|i| torques[*i].abs() <= torques[torque].abs());
    let mut found = smaller.filter_map(|i| Some((heats[i * moving + column].as_ref()?, i == torque)));
    found.next()
}
