//! Points of a simulated cycle, solved again one after the other.

use std::collections::BTreeMap;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{Point, PowerFlow, Scratch, Solution};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::transmission::{Case, Transmission};

use crate::points::Driven;

/// An operating point at the reference port.
#[derive(Debug, Clone)]
pub struct At<'a> {
    /// Name of the gear.
    pub gear: &'a str,
    /// \[Nm\]
    pub torque: f64,
    /// \[rad/s\]
    pub speed: f64,
    /// Of the nodes, or of the oil only. \[degC\]
    pub temperatures: Vec<f64>,
    /// \[s\]
    pub duration: f64,
    /// Inclination of the housing. \[rad\]
    pub inclination: f64,
}

/// A transmission with the cases of the gears that were needed so far.
pub struct Points<'a> {
    t: &'a Transmission,
    flow: PowerFlow,
    cases: BTreeMap<String, (Case, Scratch)>,
}

impl<'a> Points<'a> {
    pub fn new(t: &'a Transmission, flow: PowerFlow) -> Self {
        Self {
            t,
            flow,
            cases: BTreeMap::new(),
        }
    }

    /// The simulated intervals of a cycle, at the end of each.
    pub fn of<'t>(t: &'t Transmission, driven: &Driven) -> Vec<At<'t>> {
        let stretches = driven.stretches.iter();
        stretches
            .map(|stretch| At {
                gear: &t.states()[stretch.gear].name,
                torque: stretch.torque,
                speed: stretch.speed,
                temperatures: stretch.temperatures.clone(),
                duration: stretch.heats.duration,
                inclination: stretch.inclination,
            })
            .collect()
    }

    /// Reads the solution of a point.
    ///
    /// # Errors
    /// If the gear is unknown.
    pub fn solve<R>(&mut self, at: &At<'_>, read: impl FnOnce(&Solution<'_>) -> R) -> Result<R, Vec<Diagnostic>> {
        let t = self.t;
        if !self.cases.contains_key(at.gear) {
            let port = t.ports()[t.reference_port()].name.as_str();
            let state = t.state(at.gear).map_err(|error| vec![error])?;
            let torques = &[port][..t.torques_needed(state).min(1)];
            let case = t.case(at.gear, &[port], torques)?;
            let scratch = t.scratch(&case);
            self.cases.insert(at.gear.to_owned(), (case, scratch));
        }
        let (case, scratch) = self.cases.get_mut(at.gear).ok_or_else(Vec::new)?;
        let point = Point {
            speeds: &[at.speed],
            torques: &[at.torque][..case.torque_ports.len()],
            flow: self.flow,
            tolerance: Tolerance::default(),
            inclination: at.inclination,
        };
        Ok(read(&t.evaluate(case, &point, &at.temperatures, scratch)))
    }
}
