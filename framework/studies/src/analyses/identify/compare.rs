//! Comparison of model sets by prediction.

use gearloss_numerics::inference::{
    Accuracy, Comparison, FittedModel, PointSet, Succession, Validation, akaike, neighbours, ranking,
};
use schemars::JsonSchema;
use serde::Serialize;

use super::outcome::IdentificationOfSet;
use crate::identify::Observation;

/// Comparison of model sets.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ComparisonOfSets {
    /// Whether the points determine which set predicts best.
    pub sentence: String,
    /// The sets, the best first.
    pub sets: Vec<ComparedSet>,
}

/// Comparison of one set with the first.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ComparedSet {
    /// Name of the set.
    pub model_set: String,
    /// Number of its parameters.
    pub parameters: usize,
    /// Akaike's criterion, corrected for small samples, minus that of the first set. [-]
    pub criterion_difference: f64,
    /// Root mean square of the cross-validation errors, relative to the accuracy. [-]
    pub fold_rms: Option<Vec<f64>>,
    /// Probability of a misfit at least this large if model and accuracies are correct; absent without stated accuracies. [-]
    pub lack_of_fit_probability: Option<f64>,
    /// The first set compared with this one; absent for the first.
    pub first_against_it: Option<FirstAgainstSet>,
}

/// The first set compared with another one.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FirstAgainstSet {
    /// Whether the first is better.
    pub decision: &'static str,
    /// Why.
    pub reason: &'static str,
    /// Errors of the groups; absent unless both were validated on the same number of groups, at least two.
    pub folds: Option<PairedFolds>,
    /// Distance of the predictions in units of the errors of the set of points; absent without residuals of the same points. [-]
    pub separation: Option<f64>,
    /// Misfit of this set minus that of the first, allowing for common errors. [-]
    pub evidence: Option<f64>,
    /// Correlation of the errors used for the distance. [-]
    pub correlation: Option<f64>,
}

/// Errors of the same groups under two sets.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PairedFolds {
    /// Error of the first set over that of the other. [-]
    pub ratio: f64,
    /// 95 % interval of the ratio. [-]
    pub interval: [f64; 2],
    /// Number of groups that the first set predicts better.
    pub won: usize,
    /// Number of groups.
    pub groups: usize,
}

/// The common accuracy of each observation for the comparison: the root mean square over the sets, because accuracies in percent and of
/// instruments depend on the calculated loss. Absent if the sets were fitted to different observations.
fn common_deviations(outcomes: &[IdentificationOfSet]) -> Option<Vec<f64>> {
    let lists: Vec<&[Observation]> = outcomes.iter().map(|o| &o.found.observations[..]).collect();
    let key = |o: &Observation| (o.row, o.quantity);
    let same = |list: &&[Observation]| list.iter().map(key).eq(lists[0].iter().map(key));
    if !lists.iter().all(same) {
        return None;
    }
    let mean = |i: usize| lists.iter().map(|list| list[i].deviation.powi(2)).sum::<f64>() / lists.len() as f64;
    Some((0..lists[0].len()).map(|i| mean(i).sqrt()).collect())
}

/// A set with its residuals relative to the common accuracies.
fn model(o: &IdentificationOfSet, common: &[f64]) -> Option<FittedModel> {
    let inference = &o.found.fitted.inference;
    let in_common = |list: &[f64]| -> Vec<f64> {
        let deviations = o.found.observations.iter().zip(common);
        let factors = deviations.map(|(observation, common)| observation.deviation / common);
        // The accuracies of means are the same with all sets.
        let factors = factors.chain(std::iter::repeat(1.0));
        list.iter()
            .zip(factors)
            .map(|(residual, factor)| residual * factor)
            .collect()
    };
    let mut residuals = in_common(inference.residuals());
    let squares = residuals.iter().map(|r| r * r).sum();
    // Means are no points of the set: they have no neighbours and no common errors.
    residuals.truncate(o.found.observations.len());
    let folds = o.found.folds.as_ref().and_then(|folds| folds.as_ref().ok());
    let (points, parameters) = (inference.residuals().len(), inference.parameters().len());
    let lack = o.found.checks.lack.is_some_and(|lack| lack.widening().is_some());
    let together = o.found.checks.succession.as_ref().is_some_and(Succession::is_suspect);
    Some(FittedModel {
        name: o.model_set.clone(),
        parameters,
        criterion: akaike(squares, points, parameters, inference.accuracy())?,
        validation: folds.and_then(|(folds, found)| Validation::new(folds, &in_common(&found.errors))),
        residuals,
        scatter: match inference.accuracy() {
            Accuracy::Given => 1.0,
            Accuracy::Estimated => inference.scatter(),
        },
        is_suspect: lack || together,
    })
}

/// Neighbouring observations of one quantity, gear and temperature, and the shapes of common errors: for each quantity proportional to the
/// accuracy, a gain and an offset.
fn points(o: &IdentificationOfSet, common: &[f64]) -> PointSet {
    let measured = &o.found.measured;
    let observations = &o.found.observations;
    let value = |i: usize, quantity: &str| {
        measured
            .value(&measured.rows[observations[i].row], quantity)
            .unwrap_or(0.0)
    };
    let mut points = PointSet::default();
    for quantity in o.found.quantities() {
        let over = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let of = |i: usize| {
                if observations[i].quantity == quantity {
                    value(i) / common[i]
                } else {
                    0.0
                }
            };
            (0..observations.len()).map(of).collect()
        };
        points.shapes.extend([
            over(&|i| common[i]),
            over(&|i| o.found.pairs[1][i].measured),
            over(&|_| 1.0),
        ]);
    }
    for sheet in &o.found.sheets {
        for quantity in o.found.quantities() {
            let is_within =
                |i: &usize| observations[*i].quantity == quantity && sheet.rows.contains(&observations[*i].row);
            let places: Vec<usize> = (0..observations.len()).filter(is_within).collect();
            let [torques, speeds] =
                ["torque", "speed"].map(|q| places.iter().map(|i| value(*i, q)).collect::<Vec<f64>>());
            let of_places = |cell: Vec<usize>| cell.into_iter().map(|k| places[k]).collect();
            points.cells.extend(
                neighbours(&torques, &speeds, &vec![0.0; places.len()])
                    .into_iter()
                    .map(of_places),
            );
        }
    }
    points
}

/// Why sets were not compared.
const NOT_COMPARED: &str =
    "the sets are not compared: they were fitted to different rows, by a robust loss or with factors of the accuracies";

/// Compares the sets. Absent if there is nothing to compare; the reason if a comparison is invalid.
pub(super) fn compare(outcomes: &[IdentificationOfSet]) -> Option<Result<ComparisonOfSets, &'static str>> {
    if outcomes.len() < 2 {
        return None;
    }
    // Sets are compared only over the same observations and by minimised sums of squares.
    let squares = |o: &IdentificationOfSet| o.found.fitted.factors.is_empty() && !o.found.fitted.inference.is_robust();
    let common = common_deviations(outcomes).filter(|_| outcomes.iter().all(squares));
    let Some(common) = common else {
        return Some(Err(NOT_COMPARED));
    };
    let models = outcomes.iter().map(|o| model(o, &common)).collect::<Option<Vec<_>>>()?;
    let set_of_points = points(&outcomes[0], &common);
    let order = ranking(&models, &set_of_points);
    let first = &models[order[0]];
    let (mut sets, mut clauses) = (Vec::new(), Vec::new());
    for place in &order {
        let model = &models[*place];
        let against = (*place != order[0]).then(|| Comparison::new(first, model, &set_of_points));
        clauses.extend(against.map(|c| c.words(&format!("`{}`", first.name), &format!("`{}`", model.name))));
        sets.push(ComparedSet {
            model_set: model.name.clone(),
            parameters: model.parameters,
            criterion_difference: model.criterion - first.criterion,
            fold_rms: model.validation.as_ref().map(Validation::fold_rms),
            lack_of_fit_probability: outcomes[*place].found.checks.lack.map(|lack| lack.probability),
            first_against_it: against.map(FirstAgainstSet::from),
        });
    }
    Some(Ok(ComparisonOfSets {
        sentence: clauses.join("; "),
        sets,
    }))
}

impl From<Comparison> for FirstAgainstSet {
    fn from(comparison: Comparison) -> Self {
        Self {
            decision: comparison.decision.name(),
            reason: comparison.reason.name(),
            folds: comparison.folds.map(|p| PairedFolds {
                ratio: p.ratio,
                interval: p.interval,
                won: p.won,
                groups: p.folds,
            }),
            separation: comparison.separation.map(|s| s.square.sqrt()),
            evidence: comparison.separation.map(|s| s.evidence),
            correlation: comparison.separation.map(|s| s.correlation),
        }
    }
}
