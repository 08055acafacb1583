//! The least-squares problem of an identification: measured points and means over cycles, and the gearbox with given parameters.

use std::sync::Arc;

use crate::codes;
use crate::measured::{Measured, PortSpeeds, Rig, Seen};
use crate::points::{OnRig, PointResult, Rows, SolvedRows};
use crate::study::{Difference, IdentifiedEntry, Quantity};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::variants::Variants;
use gearloss_numerics::inference::Accuracy;
use gearloss_numerics::least_squares::Problem;

use super::{CalculatedMeans, Identified, Means, RigQuantity, Target};

/// One fitted measured value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Index of the row.
    pub row: usize,
    /// Measured values.
    pub quantity: Quantity,
    /// Standard deviation of the measurement, including its weight: efficiencies as fractions, temperatures in K. Without any accuracy the
    /// unit of residuals: one percentage point, 1 W, 1 Nm or 1 K.
    pub deviation: f64,
}

impl Observation {
    /// Whether another fitted quantity is used for points without a meaningful efficiency.
    pub(super) fn is_counted_by(&self, asked: Quantity, residuals: &[Quantity]) -> bool {
        let other = |q: &Quantity| matches!(q, Quantity::Loss | Quantity::LossTorque);
        self.quantity != asked && residuals.iter().any(other)
    }
}

/// A measured and calculated value; efficiencies as fractions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Measured, without the contribution of the rig.
    pub measured: f64,
    /// Calculated.
    pub model: f64,
}

/// State of a gearbox with given parameters at all rows.
pub struct Calculated {
    /// The solved rows.
    pub solved: SolvedRows,
    /// The rig with its parameters.
    pub rig: Rig,
}

impl Calculated {
    /// The point of a row.
    pub fn point(&self, row: usize) -> &PointResult {
        &self.solved.rows[row].2
    }
}

/// Measured points, means over cycles, a gearbox with one choice of models, and parameters.
pub struct Identification<'a> {
    pub(super) variants: Arc<Variants<'a>>,
    pub(super) rows: Rows<'a>,
    pub(super) parameters: Vec<Identified>,
    pub(super) speeds: Vec<PortSpeeds>,
    pub(super) observations: Vec<Observation>,
    pub(super) means: Means<'a>,
    pub(super) accuracy: Accuracy,
    pub(super) notes: Vec<String>,
}

impl<'a> Identification<'a> {
    /// Combines rows, a gearbox and parameters. Paths of findings of the study start with `parameters` or `data`.
    ///
    /// # Errors
    /// All errors of the parameters, of resolving and of building; points without a calculated value; quantities without measurements, or
    /// with accuracies for some points only.
    pub fn new<'e>(
        language: &'a Language,
        gearbox: &'a Gearbox,
        choice: Choice,
        rows: Rows<'a>,
        entries: impl IntoIterator<Item = (&'e str, &'e IdentifiedEntry)>,
        residuals: &[Quantity],
    ) -> Result<Self, Faults> {
        Self::with_means(language, gearbox, choice, rows, entries, residuals, Means::default())
    }

    /// The same with means over cycles, beside rows or without any.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_means<'e>(
        language: &'a Language,
        gearbox: &'a Gearbox,
        choice: Choice,
        rows: Rows<'a>,
        entries: impl IntoIterator<Item = (&'e str, &'e IdentifiedEntry)>,
        residuals: &[Quantity],
        means: Means<'a>,
    ) -> Result<Self, Faults> {
        let variants = Arc::new(Variants::new(language, gearbox, choice));
        let built = rows.build(&variants, &[])?;
        let resolved = rows.resolved(&variants)?;
        let mut found = Vec::new();
        let mut parameters = Vec::new();
        for (name, entry) in entries {
            match Identified::from_entry(name, entry, &rows.measured.rig, (language, &resolved[0])) {
                Ok(list) => parameters.extend(list),
                Err(error) => found.push(error),
            }
        }
        found.extend(Identified::find_duplicate(&parameters));
        if parameters.is_empty() && found.is_empty() {
            found.push(
                identification_error("parameters", "there are no parameters to identify").help("add a parameter"),
            );
        }
        for parameter in &parameters {
            if let Target::Over { port, .. } = &parameter.target
                && let Err(error) = built[0].port(port)
            {
                let path = format!("parameters.{}.over.port", parameter.base_name());
                found.push(Diagnostic { path, ..error });
                break;
            }
        }
        if !found.is_empty() {
            return Err(Faults::Study(found));
        }
        let mut identification = Self {
            variants,
            rows,
            parameters,
            speeds: Vec::new(),
            observations: Vec::new(),
            means,
            accuracy: Accuracy::Given,
            notes: Vec::new(),
        };
        let solved = identification.rows.solve(built, None, &|_| true);
        let solved = solved.map_err(|list| Faults::Gearbox(gearbox.findings(list)))?;
        // Without an interruption there is always a result.
        if let Some(solved) = solved {
            let at_out = identification.rows.measured.rig.at_out() || identification.parameters.iter().any(is_out);
            let speeds = identification.rows.speeds(&solved, at_out);
            identification.speeds = speeds.map_err(|error| {
                Faults::Study(vec![Diagnostic {
                    path: "data".to_owned(),
                    ..error
                }])
            })?;
        }
        identification.observe(residuals).map_err(Faults::Study)?;
        Ok(identification)
    }

    /// The same with other rows and given observations, for example simulated or proposed points.
    ///
    /// # Errors
    /// If the rows are invalid for the gearbox.
    pub fn with_rows<'b>(
        &'b self,
        measured: &'b Measured,
        observations: Vec<Observation>,
    ) -> Result<Identification<'b>, String> {
        let rows = Rows {
            measured,
            ..self.rows.clone()
        };
        let built = rows.build(&self.variants, &[]).map_err(|findings| findings.first())?;
        let solved = rows.solve(built, None, &|_| true);
        let solved = solved.map_err(|list| list.first().map_or_else(String::new, |d| d.message.clone()))?;
        let speeds = solved.map_or(Ok(Vec::new()), |solved| rows.speeds(&solved, false));
        Ok(Identification {
            variants: Arc::clone(&self.variants) as Arc<Variants<'b>>,
            parameters: self.parameters.clone(),
            speeds: speeds.map_err(|d| d.message)?,
            observations,
            means: Means::default(),
            accuracy: self.accuracy,
            notes: Vec::new(),
            rows,
        })
    }

    /// The parameters, in the order of the coordinates.
    pub fn parameters(&self) -> &[Identified] {
        &self.parameters
    }

    /// The fitted measured values, in the order of the residuals.
    pub fn observations(&self) -> &[Observation] {
        &self.observations
    }

    /// The fitted means, whose residuals follow those of the observations.
    pub fn means(&self) -> &Means<'a> {
        &self.means
    }

    /// The measured rows.
    pub fn measured(&self) -> &Measured {
        self.rows.measured
    }

    /// Whether the accuracies are given.
    pub fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    /// Notes on the points.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Start values, each in the unit of its path.
    pub fn start(&self) -> Vec<f64> {
        self.parameters
            .iter()
            .map(|p| p.start.clamp(p.bounds[0], p.bounds[1]))
            .collect()
    }

    /// State of the gearbox with given parameters, each in the unit of its path.
    ///
    /// # Errors
    /// If it cannot be built with them.
    pub fn calculate(&self, theta: &[f64]) -> Result<Calculated, String> {
        let overrides = Identified::overrides(&self.parameters, theta);
        let built = self
            .rows
            .build(&self.variants, &overrides)
            .map_err(|findings| findings.first())?;
        let rig = Identified::rig(&self.parameters, theta, &self.rows.measured.rig);
        let on = OnRig {
            rig,
            speeds: &self.speeds,
        };
        let on = Some(on).filter(|on| !on.rig.is_silent());
        let solved = self.rows.solve(built, on, &|_| true);
        let solved = solved.map_err(|list| list.first().map_or_else(String::new, |d| d.message.clone()))?;
        let solved = solved.ok_or_else(|| "interrupted".to_owned())?;
        Ok(Calculated { solved, rig })
    }

    /// An observation with its calculated value.
    ///
    /// # Errors
    /// The row without a value, and why.
    pub fn pair(&self, observation: &Observation, calculated: &Calculated) -> Result<Pair, String> {
        let row = &self.rows.measured.rows[observation.row];
        let point = calculated.point(observation.row);
        let seen = Seen::with_rig(&calculated.rig, self.rows.measured, row, point);
        let what = observation.quantity.words(crate::study::Difference::Points).0;
        let none = |which: &str| {
            let reason = match (&point.undefined, point.balance) {
                (Some((_, undefined)), _) => format!(": {undefined}"),
                (None, Some(_)) if point.oil.is_none() => ": no heat balance was found".to_owned(),
                _ => String::new(),
            };
            format!("{}: no {which} {what}{reason}", self.rows.measured.origin(row))
        };
        let measured = seen.quantity(observation.quantity).ok_or_else(|| none("measured"))?;
        let model = observation.quantity.value(point).filter(|x| x.is_finite());
        let model = model.ok_or_else(|| none("calculated"))?;
        Ok(Pair { measured, model })
    }

    /// All observations with their calculated values.
    ///
    /// # Errors
    /// The row without a value, and why.
    pub fn pairs(&self, calculated: &Calculated) -> Result<Vec<Pair>, String> {
        self.observations.iter().map(|o| self.pair(o, calculated)).collect()
    }

    /// The means with given parameters, each in the unit of its path.
    ///
    /// # Errors
    /// If the gearbox cannot be built with them, or a cycle cannot be driven.
    pub fn calculate_means(&self, theta: &[f64]) -> Result<CalculatedMeans, String> {
        self.means.calculate(&Identified::overrides(&self.parameters, theta))
    }

    /// Residuals: calculated minus measured over the standard deviation, of all observations and then of all means.
    ///
    /// # Errors
    /// If the gearbox cannot be built, a row has no value, or a cycle cannot be driven.
    pub fn residuals(&self, theta: &[f64]) -> Result<Vec<f64>, String> {
        let mut residuals = Vec::new();
        if !self.observations.is_empty() {
            let calculated = self.calculate(theta)?;
            for o in &self.observations {
                let pair = self.pair(o, &calculated)?;
                residuals.push((pair.model - pair.measured) / o.deviation);
            }
        }
        let values = self.calculate_means(theta)?.values;
        residuals.extend(
            self.means
                .list
                .iter()
                .zip(values)
                .map(|(mean, value)| mean.residual(value)),
        );
        Ok(residuals)
    }

    /// As a problem for [`gearloss_numerics::least_squares`].
    pub fn problem(&self) -> Problem<'_> {
        let parameters = self.parameters.iter().map(Identified::fitted).collect();
        Problem::new(|theta: &[f64]| self.residuals(theta), parameters)
    }

    /// Sets the reference size of offsets of torque meters from the loss torques.
    fn size_offsets(&mut self, start: &Calculated) {
        for port in [0, 1] {
            let torque = |(i, row): (usize, &crate::measured::Row)| {
                let seen = Seen::with_rig(&start.rig, self.rows.measured, row, start.point(i));
                let there = match (port, start.point(i).output_speed) {
                    (0, _) => 1.0,
                    (_, Some(speed)) => start.point(i).reference_speed / speed,
                    (_, None) => return None,
                };
                let torque = (seen.quantity(Quantity::LossTorque)? * there).abs();
                torque.is_finite().then_some(torque)
            };
            let mut torques: Vec<f64> = self.rows.measured.rows.iter().enumerate().filter_map(torque).collect();
            torques.sort_by(f64::total_cmp);
            let median = torques.get(torques.len() / 2).copied();
            for parameter in &mut self.parameters {
                let is_changed = match parameter.target {
                    Target::Rig(RigQuantity::OffsetIn) => port == 0,
                    Target::Rig(RigQuantity::OffsetOut) => port == 1,
                    _ => false,
                };
                if is_changed {
                    parameter.size = median;
                }
            }
        }
    }

    /// Rejects quantities that are computed from the same measured values.
    fn counted_once(&self, residuals: &[Quantity]) -> Result<(), Vec<Diagnostic>> {
        let wrong = |message: String, help: &str| Err(vec![identification_error("residuals", message).help(help)]);
        let powers: Vec<Quantity> = residuals
            .iter()
            .copied()
            .filter(|q| *q != Quantity::Temperature)
            .collect();
        for (i, quantity) in residuals.iter().enumerate() {
            let what = quantity.words(crate::study::Difference::Points).0;
            if residuals[..i].contains(quantity) {
                return wrong(format!("the {what} is listed twice"), "list every quantity once");
            }
            let column = match quantity {
                Quantity::Efficiency => "efficiency",
                Quantity::Loss => "loss",
                Quantity::LossTorque => "loss_torque",
                Quantity::Temperature => continue,
                Quantity::DcPower | Quantity::UnitLoss | Quantity::SystemEfficiency => {
                    let message = format!("the {what} has no measured values");
                    return wrong(message, "use efficiency, loss, loss torque or temperature");
                }
            };
            if powers.len() > 1 && !self.rows.measured.holds(column) {
                let message = format!("the {what} has no column and is computed from the same values as the others");
                return wrong(
                    message,
                    "use one of efficiency, loss and loss torque, or give each a column",
                );
            }
        }
        Ok(())
    }

    /// The observation of a quantity in a row with its stated accuracy; absent if there is none. An efficiency at very low torque is
    /// replaced by its loss torque.
    pub(super) fn observable(
        &self,
        row: usize,
        quantity: Quantity,
        calculated: &Calculated,
    ) -> Option<(Observation, Option<f64>)> {
        let measured = self.rows.measured;
        let measured_row = &measured.rows[row];
        let seen = Seen::with_rig(&calculated.rig, measured, measured_row, calculated.point(row));
        let weight = measured.value(measured_row, "weight").unwrap_or(1.0);
        let drowns = quantity == Quantity::Efficiency && seen.is_drowned();
        let quantity = if drowns { Quantity::LossTorque } else { quantity };
        if seen.quantity(quantity).is_none() || weight <= 0.0 {
            return None;
        }
        let unit = if quantity == Quantity::Efficiency { 0.01 } else { 1.0 };
        let accuracy = seen.accuracy(quantity);
        let observation = Observation {
            row,
            quantity,
            deviation: accuracy.unwrap_or(unit) / weight.sqrt(),
        };
        Some((observation, accuracy))
    }

    /// Selects the observations with their standard deviations at the start.
    fn observe(&mut self, residuals: &[Quantity]) -> Result<(), Vec<Diagnostic>> {
        if self.rows.measured.rows.is_empty() {
            return self.are_enough();
        }
        self.counted_once(residuals)?;
        let start = self.calculate(&self.start());
        let start = start.map_err(|reason| data_error(reason, "use other start values"))?;
        let mut found = Vec::new();
        for quantity in residuals {
            found.extend(self.observations_of(*quantity, residuals, &start)?);
        }
        // Points without a value at the start are reported by line, before the search and before their accuracy.
        if let Some(reason) = found.iter().find_map(|(o, _)| self.pair(o, &start).err()) {
            return Err(data_error(
                format!("{reason}, at the start of the search"),
                "use other start values, or give the line zero weight",
            ));
        }
        self.accuracy = self.accuracy_of(&found, residuals)?;
        self.size_offsets(&start);
        self.observations = found.into_iter().map(|(observation, _)| observation).collect();
        self.are_enough()
    }

    /// The observations of one quantity with their stated accuracies; notes on them.
    fn observations_of(
        &mut self,
        quantity: Quantity,
        residuals: &[Quantity],
        start: &Calculated,
    ) -> Result<Vec<StatedObservation>, Vec<Diagnostic>> {
        let measured = self.rows.measured;
        let mut found: Vec<StatedObservation> = Vec::new();
        let mut drowned = 0;
        for (i, row) in measured.rows.iter().enumerate() {
            let Some((observation, accuracy)) = self.observable(i, quantity, start) else {
                continue;
            };
            drowned += usize::from(observation.quantity != quantity);
            if observation.is_counted_by(quantity, residuals) {
                continue;
            }
            if accuracy == Some(0.0) {
                let message = format!("{}: an accuracy of zero", measured.origin(row));
                let help = "state the accuracy of the instruments, or omit all accuracies";
                return Err(data_error(message, help));
            }
            found.push((observation, accuracy));
        }
        let mut weights = measured.rows.iter().map(|row| measured.value(row, "weight"));
        if weights.all(|weight| weight == Some(0.0)) {
            return Err(data_error(
                "all points have zero weight",
                "give some of them a positive weight",
            ));
        }
        if found.is_empty() {
            let what = quantity.words(Difference::Points).0;
            let help = "add a column of it, or columns of torque and speed at both ports";
            return Err(data_error(format!("there is no measured {what}"), help));
        }
        if quantity == Quantity::Temperature && start.solved.rows.iter().all(|(_, _, p)| p.balance.is_none()) {
            return Err(vec![
                identification_error("residuals", "the oil temperature is given, not calculated").help(
                    "write `thermal: { mode: balance, ... }` in the gearbox, and no oil_temperature in the conditions",
                ),
            ]);
        }
        let is_below = |(o, _): &&StatedObservation| {
            let row = &measured.rows[o.row];
            let loss = Seen::with_rig(&start.rig, measured, row, start.point(o.row)).loss;
            loss.is_some_and(|loss| loss < 0.0)
        };
        let below = found.iter().filter(is_below).count();
        if below > 0 && quantity != Quantity::Temperature {
            self.notes.push(format!("{below} measured losses are negative"));
        }
        if drowned > 0 {
            self.notes.push(format!(
                "{drowned} points with less torque than three times its accuracy are fitted by their loss torque"
            ));
        }
        Ok(found)
    }

    /// Whether accuracies are given: for all observations or for none, and for all if there are several quantities.
    fn accuracy_of(&self, found: &[StatedObservation], residuals: &[Quantity]) -> Result<Accuracy, Vec<Diagnostic>> {
        let measured = self.rows.measured;
        let with = found.iter().filter(|(_, accuracy)| accuracy.is_some()).count();
        if with > 0 && with < found.len() {
            let bare = found.iter().find(|(_, accuracy)| accuracy.is_none());
            let line = bare.map_or_else(String::new, |(o, _)| measured.origin(&measured.rows[o.row]));
            let message = format!(
                "{line} has no accuracy, like {} of {} measured values; {with} have one",
                found.len() - with,
                found.len()
            );
            return Err(data_error(message, "state the accuracies of all, or of none"));
        }
        if with == 0 && !self.means.list.is_empty() {
            let message = "a fit of points beside means needs the accuracies of the points, and none is stated";
            let help = "state the instruments under `rig`, or columns such as `loss_accuracy`";
            return Err(data_error(message, help));
        }
        if with == 0 && residuals.len() > 1 {
            let message = "a fit of several quantities needs their accuracies, and none is stated";
            let help = "state the instruments under `rig`, or columns such as `loss_accuracy`";
            return Err(data_error(message, help));
        }
        Ok(if with > 0 { Accuracy::Given } else { Accuracy::Estimated })
    }

    /// Checks that observations and priors determine the free parameters.
    fn are_enough(&self) -> Result<(), Vec<Diagnostic>> {
        let means = self.means.list.len();
        let (count, estimated) = (self.observations.len() + means, self.accuracy == Accuracy::Estimated);
        let free: Vec<&Identified> = (self.parameters.iter()).filter(|p| p.bounds[0] < p.bounds[1]).collect();
        let with_prior: Vec<&&Identified> = free.iter().filter(|p| p.prior.is_some()).collect();
        let (free, priors) = (free.len(), with_prior.len());
        if let Some(parameter) = with_prior.first().filter(|_| estimated) {
            let place = format!("parameters.{}.prior", parameter.base_name());
            let message = "a prior needs accuracies of the points, and none is stated";
            let help = "state the instruments under `rig`, or columns such as `loss_accuracy`, or delete the prior";
            return Err(vec![identification_error(place, message).help(help)]);
        }
        if estimated && count <= free {
            return Err(data_error(
                format!("{count} measured values without accuracies for {free} parameters"),
                "identify fewer parameters, or state the accuracies",
            ));
        }
        if count + priors < free {
            let place = if self.observations.is_empty() { "means" } else { "data" };
            return Err(vec![
                identification_error(
                    place,
                    format!("{count} measured values and {priors} priors for {free} parameters"),
                )
                .help("identify fewer parameters, or give some of them a `prior`"),
            ]);
        }
        Ok(())
    }
}

/// An observation with its stated accuracy; absent if none is stated.
type StatedObservation = (Observation, Option<f64>);

/// An error of the data.
fn data_error(message: impl Into<String>, help: &str) -> Vec<Diagnostic> {
    vec![identification_error("data", message).help(help)]
}

fn is_out(parameter: &Identified) -> bool {
    matches!(&parameter.target, Target::Rig(quantity) if RigQuantity::is_out(*quantity))
}

/// Errors in the statement of an identification.
#[derive(thiserror::Error)]
pub enum Faults {
    /// Errors of the study, with paths below the analysis.
    #[error("{}", lines(.0))]
    Study(Vec<Diagnostic>),
    /// Errors of the gearbox.
    #[error(transparent)]
    Gearbox(#[from] Findings),
}

fn lines(list: &[Diagnostic]) -> String {
    list.iter()
        .fold(String::new(), |text, found| text + &found.to_string() + "\n")
}

/// As `Display`, because a `main` that returns an error prints `Debug`.
impl std::fmt::Debug for Faults {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// A finding about an identification.
fn identification_error(path: impl Into<String>, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(path, message).code(codes::IDENTIFICATION)
}
