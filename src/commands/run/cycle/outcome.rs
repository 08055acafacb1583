//! One duty driven through one gearbox under one set, in numbers for a reader.

use gearloss_studies::analysis::{Driven, Stretch, notes};
use gearloss_studies::duty::Duty;
use gearloss_studies::study::{CycleAnalysisEntry, ReferenceLoss};
use serde_json::{Value, json};

use super::super::super::solve::RPM;
use super::super::Built;
use super::super::write::cell;
use super::bands::Band;
use gearloss_studies::analyses::duties::{Read, nodes};
use gearloss_studies::analyses::numbers::tidy;
use gearloss_studies::analyses::shares::Shares;

/// A driven duty.
pub struct Outcome<'a> {
    pub built: &'a Built<'a>,
    pub read: &'a Read,
    pub driven: Driven,
    /// Names of the shares of the loss, those of all sets.
    pub names: Vec<String>,
    shares: Shares,
    /// Names of the nodes whose temperatures are known.
    pub nodes: Vec<String>,
    /// Measured temperatures of each node: time and value.
    measured: Vec<Vec<(f64, f64)>>,
    pub reference: Option<&'a ReferenceLoss>,
    /// Bands of uncertain inputs.
    pub bands: Option<Band>,
}

/// Temperatures of one node over a duty. \[degC\]
pub struct Course {
    pub start: f64,
    pub end: f64,
    pub least: f64,
    pub greatest: f64,
    /// Mean over time.
    pub mean: f64,
    /// Root mean square of measurement less calculation, where the duty holds a measurement, and its rows.
    pub rms: Option<(f64, usize)>,
}

impl<'a> Outcome<'a> {
    pub fn new(
        built: &'a Built<'a>,
        read: &'a Read,
        driven: Driven,
        entry: &'a CycleAnalysisEntry,
        names: &[String],
    ) -> Self {
        let nodes = nodes(&built.transmission, &driven);
        Self {
            shares: Shares::of(&built.transmission, entry.by).under(names),
            names: names.to_vec(),
            measured: nodes.iter().map(|node| measured(read, node)).collect(),
            nodes,
            reference: entry.reference.get(&read.name),
            built,
            read,
            driven,
            bands: None,
        }
    }

    /// Time that was driven. \[s\]
    pub fn duration(&self) -> f64 {
        self.driven.total.duration
    }

    /// Mean over the whole duty of an energy. \[W\]
    pub fn mean(&self, energy: f64) -> f64 {
        if self.duration() > 0.0 {
            energy / self.duration()
        } else {
            0.0
        }
    }

    /// Loss of the transmission. \[J\]
    pub fn loss(&self) -> f64 {
        self.driven.total.parts.iter().sum()
    }

    /// Loss of all motors. \[J\]
    pub fn motors(&self) -> f64 {
        self.driven.total.motors.iter().flatten().sum()
    }

    /// True where the losses of motors are known: they need a thermal network.
    fn has_motors(&self) -> bool {
        !self.driven.total.motors.is_empty()
    }

    /// Losses by share. \[J\]
    pub fn by_share(&self) -> Vec<f64> {
        self.shares.sums(&self.driven.total.parts)
    }

    /// Mean powers by share over an interval. \[W\]
    pub fn stack(&self, stretch: &Stretch) -> Vec<f64> {
        let sums = self.shares.sums(&stretch.heats.parts);
        sums.into_iter().map(|joule| joule / stretch.heats.duration).collect()
    }

    /// True where losses and temperatures hang on each other.
    pub fn is_thermal(&self) -> bool {
        self.driven.start.len() > 1
    }

    /// What is left of input, output and losses over the greatest of them. \[-\]
    pub fn flow_residual(&self) -> f64 {
        let total = &self.driven.total;
        (total.input - total.output - self.loss()).abs() / total.input.abs().max(1e-300)
    }

    /// What is left of the heat over all heat that came. \[-\]
    pub fn heat_residual(&self) -> f64 {
        self.driven.total.residual().abs() / self.driven.total.came().abs().max(1e-300)
    }

    /// Temperatures of each node.
    pub fn courses(&self) -> Vec<Course> {
        (0..self.nodes.len()).map(|node| self.course(node)).collect()
    }

    fn course(&self, node: usize) -> Course {
        let start = self.driven.start[node];
        let all = || self.driven.stretches.iter().map(|s| s.temperatures[node]);
        let weighted: f64 = self
            .driven
            .stretches
            .iter()
            .map(|s| s.temperatures[node] * s.heats.duration)
            .sum();
        let measured = self.measured(node);
        let squares: Vec<f64> = measured
            .iter()
            .filter_map(|(time, measured)| Some((measured - self.at(node, *time)?).powi(2)))
            .collect();
        Course {
            start,
            end: all().next_back().unwrap_or(start),
            least: all().fold(start, f64::min),
            greatest: all().fold(start, f64::max),
            mean: self.mean(weighted),
            rms: (!squares.is_empty()).then(|| {
                (
                    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt(),
                    squares.len(),
                )
            }),
        }
    }

    /// Temperature of a node at a time, straight between the ends of intervals; absent outside of the duty. \[degC\]
    fn at(&self, node: usize, time: f64) -> Option<f64> {
        let stretches = &self.driven.stretches;
        let i = stretches.partition_point(|s| s.start + s.heats.duration < time);
        let s = stretches.get(i)?;
        let before = if i == 0 {
            self.driven.start[node]
        } else {
            stretches[i - 1].temperatures[node]
        };
        let share = (time - s.start) / s.heats.duration;
        (-1e-9..=1.0 + 1e-9)
            .contains(&share)
            .then(|| before + share * (s.temperatures[node] - before))
    }

    /// Measured temperatures of a node: time and value. \[s and degC\]
    pub fn measured(&self, node: usize) -> &[(f64, f64)] {
        &self.measured[node]
    }

    /// The temperature that was measured at a time, to a millisecond; absent without one. \[degC\]
    fn measured_at(&self, node: usize, time: f64) -> Option<f64> {
        let measured = self.measured.get(node)?;
        let i = measured.partition_point(|(t, _)| *t < time - 1e-3);
        measured
            .get(i)
            .filter(|(t, _)| *t <= time + 1e-3)
            .map(|(_, value)| *value)
    }

    /// Rows of the table, one for each interval; nodes that this set does not have are empty.
    pub fn rows(&self, nodes: &[String]) -> Vec<Vec<String>> {
        let places: Vec<Option<usize>> = nodes
            .iter()
            .map(|name| self.nodes.iter().position(|n| n == name))
            .collect();
        let row = |s: &Stretch| {
            let heats = &s.heats;
            let power = |joule: f64| cell(Some(joule / heats.duration));
            let mut row = vec![self.built.name.clone(), self.read.name.clone()];
            row.extend([cell(Some(s.start)), cell(Some(heats.duration))]);
            row.extend([
                cell(Some(s.torque)),
                cell(Some(tidy(s.speed * RPM))),
                cell(s.vehicle_speed),
            ]);
            row.push(s.status.name().to_owned());
            row.extend([power(heats.input), power(heats.output), power(heats.parts.iter().sum())]);
            row.extend(self.stack(s).into_iter().map(|watts| cell(Some(watts))));
            let motors: f64 = heats.motors.iter().flatten().sum();
            row.push(if self.has_motors() {
                power(motors)
            } else {
                String::new()
            });
            row.push(power(s.brakes));
            row.extend(places.iter().map(|place| cell(place.map(|node| s.temperatures[node]))));
            let end = s.start + s.heats.duration;
            row.extend(
                places
                    .iter()
                    .map(|place| cell(place.and_then(|node| self.measured_at(node, end)))),
            );
            row
        };
        self.driven.stretches.iter().map(row).collect()
    }

    /// The result without its course in time, which the table holds.
    pub fn json(&self) -> Value {
        let t = &self.built.transmission;
        let total = &self.driven.total;
        let shares: Vec<f64> = self.by_share().into_iter().map(|joule| self.mean(joule)).collect();
        let node = |(name, c): (&String, Course)| {
            json!({
                "node": name, "start_degc": c.start, "end_degc": c.end, "least_degc": c.least, "greatest_degc": c.greatest,
                "mean_degc": c.mean, "rms_k": c.rms.map(|r| r.0), "measured_rows": c.rms.map(|r| r.1),
            })
        };
        let nodes: Vec<Value> = self.nodes.iter().zip(self.courses()).map(node).collect();
        let heat = self.is_thermal().then(|| {
            let network = t.network();
            let held: Vec<Value> = network
                .into_iter()
                .flat_map(|n| n.names().iter().enumerate().filter(|(i, _)| n.is_held(*i)))
                .map(|(i, name)| json!({ "node": name, "heat_j": total.held.get(i) }))
                .collect();
            let exchangers: Vec<Value> = network
                .into_iter()
                .flat_map(|n| n.exchangers().zip(&total.exchangers))
                .map(|(path, joule)| json!({ "exchanger": path, "heat_j": joule }))
                .collect();
            json!({
                "came_j": total.came(), "stored_j": total.stored, "held": held, "exchangers": exchangers,
                "carried_away_j": total.flows, "residual_share": self.heat_residual(),
            })
        });
        let motors: Vec<Value> = t
            .network()
            .into_iter()
            .flat_map(|n| n.motors().zip(&total.motors))
            .map(|(path, [rotor, stator])| json!({ "motor": path, "rotor_j": rotor, "stator_j": stator }))
            .collect();
        json!({
            "model_set": self.built.name, "cycle": self.read.name, "duration_s": self.duration(),
            "intervals": self.driven.stretches.len(), "mean_loss_w": self.mean(self.loss()), "shares": self.names,
            "mean_losses_w": shares,
            "energy": {
                "input_j": total.input, "output_j": total.output, "loss_j": self.loss(), "motors_j": self.has_motors().then(|| self.motors()),
                "brakes_j": self.driven.brakes, "residual_share": self.flow_residual(),
            },
            "heat": heat, "motors": motors, "motors_beyond_map": total.beyond_map, "nodes": nodes, "about": self.read.about,
            "reference": self.reference.map(|r| json!({ "mean_loss_w": r.loss, "source": r.source })),
            "bands": self.bands.as_ref().map(|b| b.json(self.reference)),
            "evaluations": self.driven.evaluations, "calls": self.driven.calls, "steps": self.driven.steps[0],
            "steps_in_vain": self.driven.steps[1],
            "broken": self.driven.broken.as_ref().map(|(time, why)| json!({ "time_s": time, "reason": gearloss_studies::analyses::balance::reason(t, why) })),
            "notes": notes(t, &self.driven.seen),
        })
    }
}

/// Temperatures of a node that a duty tells: time and value. \[s and degC\]
fn measured(read: &Read, node: &str) -> Vec<(f64, f64)> {
    let Duty::Trace(trace) = &read.duty else {
        return Vec::new();
    };
    let Some(column) = trace.nodes.iter().position(|n| n == node) else {
        return Vec::new();
    };
    trace.samples.iter().map(|s| (s.time, s.temperatures[column])).collect()
}

/// Nodes of all outcomes, in the order of the first.
pub fn all_nodes(outcomes: &[Outcome<'_>]) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for name in outcomes.iter().flat_map(|o| &o.nodes) {
        if !all.contains(name) {
            all.push(name.clone());
        }
    }
    all
}

/// Head of the table.
pub fn header(shares: &[String], nodes: &[String]) -> Vec<String> {
    let mut header: Vec<String> = [
        "model_set",
        "cycle",
        "time_s",
        "duration_s",
        "torque_nm",
        "speed_rpm",
        "vehicle_speed_m_s",
        "status",
        "input_w",
        "output_w",
        "loss_w",
    ]
    .map(str::to_owned)
    .to_vec();
    header.extend(shares.iter().map(|s| format!("{s}_w")));
    header.extend(["motors_w", "brakes_w"].map(str::to_owned));
    header.extend(nodes.iter().map(|n| format!("{n}_end_degc")));
    header.extend(nodes.iter().map(|n| format!("{n}_measured_degc")));
    header
}
