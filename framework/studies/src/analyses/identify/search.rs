//! Record of a search for parameters.

use gearloss_numerics::least_squares::{Iteration, Kinship, Minimum, Status};
use schemars::JsonSchema;
use serde::Serialize;

use super::found::Found;
use crate::identify::ModelKink;

/// Record of the search for parameters.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SearchOfSet {
    /// Status: `converged`, `singular`, `failed` or `interrupted`.
    pub status: &'static str,
    /// Why the search ended.
    pub reason: &'static str,
    /// Half of the sum of the squared residuals. [-]
    pub cost: f64,
    /// Evaluations of all points, over all starts.
    pub evaluations: usize,
    /// Evaluations of the best start.
    pub evaluations_of_best: usize,
    /// Trial steps.
    pub steps: usize,
    /// Cone programs.
    pub cone_programs: usize,
    /// Failed cone programs.
    pub cone_fallbacks: usize,
    /// Evaluations without value.
    pub undefined: usize,
    /// Number of the returned attempt, starting at 1.
    pub attempt: usize,
    /// Evaluations for the completion without derivatives.
    pub evaluations_without_derivatives: usize,
    /// Models with kinks at the minimum.
    pub kinks: Vec<KinkOfModel>,
    /// Relation of minima with the same misfit; absent if the lowest is unique.
    pub kinship: Option<&'static str>,
    /// All minima, the lowest first.
    pub minima: Vec<MinimumOfSearch>,
    /// Notes.
    pub notes: Vec<String>,
    /// Estimated factors on the accuracies; empty if not requested.
    pub accuracy_factors: Vec<AccuracyFactor>,
    /// All steps of the best start.
    pub log: Vec<StepOfSearch>,
    /// Status.
    #[serde(skip)]
    pub worth: Status,
}

/// A model whose loss or slope is discontinuous at the minimum.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct KinkOfModel {
    /// Path of the component.
    pub path: String,
    /// Name of its model.
    pub model: String,
    /// Regimes on both sides as named by the model; absent if no change is known.
    pub regimes: Option<[String; 2]>,
    /// Whether the loss is discontinuous, not only its slope.
    pub jumps: bool,
    /// Maximum deviation of the component's loss from a straight line, relative to the loss. [-]
    pub change: f64,
    /// Lines of the measured points.
    pub lines: Vec<u64>,
    /// Parameters along which it occurs.
    pub parameters: Vec<String>,
    /// The same as text.
    pub sentence: String,
}

/// A minimum.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MinimumOfSearch {
    /// Half of the sum of the squared residuals. [-]
    pub cost: f64,
    /// Share of the starts that converge to it. [-]
    pub share_of_starts: f64,
    /// Indices of these starts; 0 is that of the parameters.
    pub starts: Vec<usize>,
    /// Values of the parameters. [unit of each parameter]
    pub parameters: Vec<f64>,
    /// Distance of each parameter from the lowest minimum, in its standard errors there; absent if it has none. [-]
    pub standard_errors_away: Vec<Option<f64>>,
}

/// Factor on the stated accuracy of a quantity.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct AccuracyFactor {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// The factor. [-]
    pub factor: f64,
}

/// One trial step.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StepOfSearch {
    /// Number of the attempt, starting at 1.
    pub attempt: usize,
    /// Cost before the step. [-]
    pub cost: f64,
    /// First-order measure before the step. [-]
    pub first_order: f64,
    /// Remaining shift in standard errors before the step, if there are more rows than free parameters. [-]
    pub relative_offset: Option<f64>,
    /// Whether the derivatives are central differences.
    pub central_differences: bool,
    /// Method of the step.
    pub step: &'static str,
    /// Whether it was corrected to second order.
    pub corrected: bool,
    /// Radius of the ball. [-]
    pub radius: f64,
    /// Length of the step in the metric of the ball. [-]
    pub length: f64,
    /// Expected decrease of the cost. [-]
    pub predicted: f64,
    /// Decrease of the cost; absent if the residuals have no value. [-]
    pub actual: Option<f64>,
    /// Whether the step was accepted.
    pub accepted: bool,
}

impl SearchOfSet {
    pub(super) fn new(found: &Found) -> Self {
        let (fit, minima) = (found.fitted.fit(), &found.fitted.minima);
        let factors = found.fitted.factors.iter();
        Self {
            status: fit.status.name(),
            reason: fit.reason.name(),
            cost: fit.cost,
            evaluations: minima.evaluations,
            evaluations_of_best: fit.counts.evaluations,
            steps: fit.counts.steps,
            cone_programs: fit.counts.cone_solves,
            cone_fallbacks: fit.counts.cone_failures,
            undefined: fit.counts.undefined,
            attempt: fit.attempt,
            evaluations_without_derivatives: fit.counts.polishing,
            kinks: found
                .fitted
                .kinks
                .iter()
                .map(|kink| KinkOfModel::new(found, kink))
                .collect(),
            kinship: minima.kinship.map(Kinship::name),
            minima: minima.minima.iter().map(|m| MinimumOfSearch::new(found, m)).collect(),
            notes: fit.notes.iter().chain(&minima.notes).cloned().collect(),
            accuracy_factors: factors
                .map(|(quantity, factor)| AccuracyFactor {
                    quantity: quantity.name(),
                    factor: *factor,
                })
                .collect(),
            log: fit.log.iter().map(StepOfSearch::from).collect(),
            worth: fit.status,
        }
    }
}

impl KinkOfModel {
    fn new(found: &Found, kink: &ModelKink) -> Self {
        let parameters = kink.parameters.iter();
        Self {
            path: kink.path.clone(),
            model: kink.model.clone(),
            regimes: kink.regimes.clone(),
            jumps: kink.jumps,
            change: kink.change,
            lines: kink.lines.clone(),
            parameters: parameters.map(|p| found.parameters[*p].name.clone()).collect(),
            sentence: kink.sentence(),
        }
    }
}

impl MinimumOfSearch {
    fn new(found: &Found, minimum: &Minimum) -> Self {
        let count = minimum.fit.theta.len();
        Self {
            cost: minimum.fit.cost,
            share_of_starts: minimum.share,
            starts: minimum.starts.clone(),
            parameters: minimum.fit.theta.clone(),
            standard_errors_away: (0..count).map(|k| found.fitted.distance(minimum, k)).collect(),
        }
    }
}

impl From<&Iteration> for StepOfSearch {
    fn from(step: &Iteration) -> Self {
        Self {
            attempt: step.attempt,
            cost: step.cost,
            first_order: step.first_order,
            relative_offset: step.relative_offset,
            central_differences: step.central,
            step: step.how.name(),
            corrected: step.corrected,
            radius: step.radius,
            length: step.length,
            predicted: step.predicted,
            actual: Some(step.actual).filter(|x| x.is_finite()),
            accepted: step.accepted,
        }
    }
}
