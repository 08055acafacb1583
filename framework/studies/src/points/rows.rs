//! Points of a file, solved with one choice of models, with the transmissions for their bound columns.

use std::borrow::Borrow;

use serde_json::Value;

use super::{Field, Given, OilTemperature, PointResult, Points, merge, run_grid};
use crate::distinct::distinct;
use crate::measured::{Measured, PortSpeeds, Rig, Row, sense};
use gearloss_framework::description::ThermalMode;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{Point, PowerFlow, Solution};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::loss::{Extent, Step};
use gearloss_framework::resolve::Resolved;
use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;

/// Rows of a file and their prescription.
#[derive(Debug, Clone)]
pub struct Rows<'a> {
    /// The rows.
    pub measured: &'a Measured,
    /// Paths of the bound columns, in the order of their values.
    pub bind: Vec<&'a str>,
    /// Gear of rows without one; absent: the first.
    pub gear: Option<&'a str>,
    /// Port with given torque.
    pub torque_at: &'a str,
    /// Port with given speed.
    pub speed_at: &'a str,
    /// Oil temperature of rows without one; absent: from the gearbox. \[degC\]
    pub oil: Option<f64>,
    /// Real or ideal flow.
    pub flow: PowerFlow,
    /// Whether losses are stored by term.
    pub terms: bool,
}

/// Contribution of a rig, with the speeds of the ports in every row.
#[derive(Debug, Clone, Copy)]
pub struct OnRig<'a> {
    /// The rig.
    pub rig: Rig,
    /// Speeds of the rows, of [`Rows::speeds`].
    pub speeds: &'a [PortSpeeds],
}

/// Solved rows.
pub struct SolvedRows<T = Transmission> {
    /// One transmission for each combination of bound values, in order of first occurrence.
    pub transmissions: Vec<T>,
    /// For each row the index of its transmission, its gear and its point.
    pub rows: Vec<(usize, String, PointResult)>,
    /// Observed limits and quantities over all rows.
    pub seen: Vec<Extent>,
}

impl Rows<'_> {
    /// The transmissions of a gearbox with overrides: one for each combination of bound values.
    ///
    /// # Errors
    /// All errors of resolving and building.
    pub fn build(&self, variants: &Variants<'_>, overrides: &[(String, Value)]) -> Result<Vec<Transmission>, Findings> {
        let of = |bound: &&Vec<String>| {
            let transmission = variants.build(&self.with_bound(overrides, bound))?;
            self.ports_fit(&transmission)
                .map_err(|error| Findings::from(vec![error]))?;
            Ok(transmission)
        };
        self.combinations().iter().map(of).collect()
    }

    /// The resolved descriptions of the transmissions without further overrides.
    ///
    /// # Errors
    /// All errors of resolving.
    pub fn resolved(&self, variants: &Variants<'_>) -> Result<Vec<Resolved>, Findings> {
        let of = |bound: &&Vec<String>| variants.resolve(&self.with_bound(&[], bound));
        self.combinations().iter().map(of).collect()
    }

    /// Overrides, followed by bound values.
    fn with_bound(&self, overrides: &[(String, Value)], bound: &[String]) -> Vec<(String, Value)> {
        let values = self.bind.iter().zip(bound);
        let values = values.map(|(path, text)| ((*path).to_owned(), bound_value(text)));
        overrides.iter().cloned().chain(values).collect()
    }

    /// All combinations of bound values. Without rows nothing is bound.
    fn combinations(&self) -> Vec<&Vec<String>> {
        static UNBOUND: Vec<String> = Vec::new();
        match &self.measured.rows[..] {
            [] => vec![&UNBOUND],
            rows => distinct(rows.iter().map(|row| &row.bound)),
        }
    }

    /// The points of each gear of each transmission, with the index of the latter; without torques and speeds.
    pub fn kinds<T: Borrow<Transmission>>(&self, transmissions: &[T]) -> Vec<(usize, Points)> {
        let mut kinds: Vec<(usize, Points)> = Vec::new();
        for (place, gear) in self.keys(transmissions) {
            if !kinds
                .iter()
                .any(|(known, points)| (*known, points.gear.as_str()) == (place, gear))
            {
                kinds.push((place, self.points(gear, transmissions[place].borrow(), Vec::new())));
            }
        }
        kinds
    }

    /// Index of the transmission and gear of each row.
    fn keys<'s, T: Borrow<Transmission>>(&'s self, transmissions: &'s [T]) -> Vec<(usize, &'s str)> {
        let combinations = self.combinations();
        let key = |row: &'s Row| {
            let place = combinations.iter().position(|c| **c == row.bound).unwrap_or(0);
            (place, self.state(row, transmissions[place].borrow()))
        };
        self.measured.rows.iter().map(key).collect()
    }

    /// Whether the transmission has exactly one port other than that of the conditions, if rows give torque or speed there.
    ///
    /// # Errors
    /// If that port is ambiguous.
    pub fn ports_fit(&self, transmission: &Transmission) -> Result<(), Diagnostic> {
        let out = match (self.measured.torque_at_other_port, self.measured.speed_at_other_port) {
            (true, _) => "torque_out",
            (_, true) => "speed_out",
            _ => return Ok(()),
        };
        let wrong = |message: String, help: &str| Err(Diagnostic::error("", message).help(help));
        if self.torque_at != self.speed_at {
            let message = format!(
                "the port of `{out}` is ambiguous: the conditions give the torque at `{}` and the speed at `{}`",
                self.torque_at, self.speed_at
            );
            return wrong(
                message,
                "give the same port in `torque_at` and `speed_at`, or the columns `torque` and `speed`",
            );
        }
        match transmission.ports().len() {
            2 => Ok(()),
            count => wrong(
                format!("`{out}` alone needs a gearbox with two ports; this one has {count}"),
                "combine ports as `wheels`, or give the columns `torque` and `speed` and their ports in the conditions",
            ),
        }
    }

    /// Signs from measured torque and speed to those of the transmission: may be negative only at the other port, which may turn in the
    /// opposite direction.
    fn signs(&self, gear: &str, transmission: &Transmission) -> [f64; 2] {
        let [torque, speed] = [self.measured.torque_at_other_port, self.measured.speed_at_other_port];
        if !torque && !speed {
            return [1.0, 1.0];
        }
        let state = transmission.states().iter().position(|state| state.name == gear);
        let ratio = state.and_then(|state| transmission.ratios(state).first()?.1);
        let other = sense(ratio.unwrap_or(1.0));
        [if torque { -other } else { 1.0 }, if speed { other } else { 1.0 }]
    }

    /// Points of a gear, as rows prescribe them.
    pub fn points(&self, gear: &str, transmission: &Transmission, list: Vec<Given>) -> Points {
        let [torque_at, speed_at] = [
            (self.torque_at, self.measured.torque_at_other_port),
            (self.speed_at, self.measured.speed_at_other_port),
        ]
        .map(|(port, other)| port_of(transmission, port, other).to_owned());
        Points {
            gear: gear.to_owned(),
            torque_at: vec![torque_at],
            speed_at: vec![speed_at],
            field: Field::List(list),
            oil: OilTemperature::from_conditions(transmission, self.oil),
            flow: self.flow,
            terms: self.terms,
        }
    }

    /// Solves every row with the torque corrected for the rig. A measured oil temperature is used unless the model computes one. `progress`
    /// is called with the number of newly solved points; if it returns false, there is no result.
    ///
    /// # Errors
    /// If the gear of a row or the ports are invalid.
    pub fn solve<T: Borrow<Transmission>>(
        &self,
        transmissions: Vec<T>,
        rig: Option<OnRig<'_>>,
        progress: &(dyn Fn(usize) -> bool + Sync),
    ) -> Result<Option<SolvedRows<T>>, Vec<Diagnostic>> {
        let keys = self.keys(&transmissions);
        let mut found: Vec<Option<PointResult>> = vec![None; keys.len()];
        let mut seen: Vec<Extent> = Vec::new();
        // Rows of one transmission and gear are solved together.
        for (i, key) in keys.iter().enumerate() {
            if found[i].is_some() {
                continue;
            }
            let places: Vec<usize> = (i..keys.len()).filter(|k| keys[*k] == *key).collect();
            let transmission = transmissions[key.0].borrow();
            let signs = self.signs(key.1, transmission);
            let list = places
                .iter()
                .map(|k| self.given(*k, transmission, signs, rig))
                .collect();
            let points = self.points(key.1, transmission, list);
            let Some(solved) = run_grid(transmission, &points, progress)? else {
                return Ok(None);
            };
            // The transmissions of one choice differ only in bound values, so their limits have the same order.
            merge(&mut seen, &solved.seen);
            for (k, point) in places.into_iter().zip(solved.points) {
                found[k] = Some(point);
            }
        }
        let rows = keys.into_iter().zip(found.into_iter().flatten());
        let rows = rows
            .map(|((place, gear), point)| (place, gear.to_owned(), point))
            .collect();
        Ok(Some(SolvedRows {
            transmissions,
            rows,
            seen,
        }))
    }

    /// Branches of the models of a component at a solved point of [`Self::solve`], each with the path of its model; empty if the point
    /// cannot be prescribed.
    pub fn branches(
        &self,
        transmission: &Transmission,
        gear: &str,
        point: &PointResult,
        part: usize,
    ) -> Vec<(String, &'static str)> {
        let branch = |step: Step| match step {
            Step::Branch { instance, taken } => Some((transmission.instances()[instance].path.clone(), taken)),
            Step::Value { .. } => None,
        };
        let steps = self.with_solution(transmission, gear, point, |solution| {
            let (_, trace) = solution.explain(part);
            trace.into_steps().into_iter().filter_map(branch).collect()
        });
        steps.unwrap_or_default()
    }

    /// What a function takes of a solved point of [`Self::solve`] that is evaluated again; absent if the point cannot be prescribed.
    pub fn with_solution<T>(
        &self,
        transmission: &Transmission,
        gear: &str,
        point: &PointResult,
        take: impl FnOnce(&Solution<'_>) -> T,
    ) -> Option<T> {
        let points = self.points(gear, transmission, Vec::new());
        let case = points.case(transmission).ok()?;
        let torques = vec![
            point.torque;
            transmission
                .state(gear)
                .map_or(0, |s| transmission.torques_needed(s))
                .min(1)
        ];
        let mut scratch = transmission.scratch(&case);
        let prescribed = Point {
            speeds: &[point.speed],
            torques: &torques,
            flow: self.flow,
            ..Point::default()
        };
        let wanted = match (transmission.thermal_mode, point.oil) {
            (ThermalMode::Fixed, Some(oil)) => OilTemperature::Fixed(oil),
            _ => points.oil,
        };
        let warm = wanted.find(transmission, &case, &prescribed, &mut scratch);
        let solution = transmission.evaluate(&case, &prescribed, warm.temperatures(), &mut scratch);
        Some(take(&solution))
    }

    /// The gear of a row.
    fn state<'s>(&'s self, row: &'s Row, transmission: &'s Transmission) -> &'s str {
        let first = transmission.states().first().map_or("", |s| s.name.as_str());
        row.gear.as_deref().or(self.gear).unwrap_or(first)
    }

    fn given(
        &self,
        i: usize,
        transmission: &Transmission,
        [torque_sign, speed_sign]: [f64; 2],
        rig: Option<OnRig<'_>>,
    ) -> Given {
        let row = &self.measured.rows[i];
        let value = |quantity: &str| self.measured.value(row, quantity);
        let fixed = transmission.thermal_mode == ThermalMode::Fixed;
        let torque_at = port_of(transmission, self.torque_at, self.measured.torque_at_other_port);
        let at_in = transmission.port(torque_at).ok() == Some(transmission.reference_port());
        let added = rig.map_or(0.0, |on| on.rig.added(on.speeds[i])[usize::from(!at_in)]);
        Given {
            torque: torque_sign * value("torque").unwrap_or(0.0) - added,
            speed: speed_sign * value("speed").unwrap_or(0.0),
            oil: value("oil_temperature").filter(|_| fixed),
        }
    }

    /// Speeds of the reference port and of the other port in solved rows; they depend only on the gears.
    ///
    /// # Errors
    /// If a rig contributes at a second port, but the transmission does not have two ports.
    pub fn speeds<T>(&self, solved: &SolvedRows<T>, at_out: bool) -> Result<Vec<PortSpeeds>, Diagnostic> {
        let of = |(_, _, point): &(usize, String, PointResult)| match point.output_speed {
            None if at_out => Err(Diagnostic::error(
                "",
                "the rig has data at `out`, but this gearbox does not have two ports",
            )
            .help("delete the keys of `out` under `rig`")),
            speed => Ok([point.reference_speed, speed.unwrap_or(0.0)]),
        };
        solved.rows.iter().map(of).collect()
    }
}

/// The port of the rows, or the other one.
fn port_of<'s>(transmission: &'s Transmission, port_of_rows: &'s str, other: bool) -> &'s str {
    let mut ports = transmission.ports().iter().map(|port| port.name.as_str());
    ports
        .find(|port| other && *port != port_of_rows)
        .unwrap_or(port_of_rows)
}

/// A bound value for the document: a text with its unit, or a number.
fn bound_value(text: &str) -> Value {
    text.parse::<f64>().map_or_else(|_| Value::from(text), Value::from)
}
