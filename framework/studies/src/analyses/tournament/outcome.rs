//! The outcome of a tournament as records.

use gearloss_numerics::inference::Decision;
use gearloss_numerics::selection::{Losses, Standing};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::super::Head;

/// Every combination of the models of some mechanisms.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct TournamentOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// The ranking, or the spread.
    pub tournament: Tournament,
}

/// A ranking if there are measured points, otherwise the spread.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Tournament {
    /// Ranked by measured points.
    Ranking(Box<Ranking>),
    /// Spread over a grid.
    Spread(Box<Spread>),
}

/// Combinations ranked by measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Ranking {
    /// Name of the model set of all other components.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// Unit of errors: `points` (percentage points of efficiency), `w` or `nm`.
    pub unit: &'static str,
    /// Number of ranked combinations. [-]
    pub combinations: usize,
    /// Root mean square of the accuracies of the points; absent if no point has one in this unit. [unit]
    pub accuracy: Option<f64>,
    /// Notes on the accuracy of the points.
    pub notes: Vec<String>,
    /// Correlation between the errors of any two points. [-]
    pub correlation: f64,
    /// Whether it was estimated from the residuals of the best combination.
    pub correlation_estimated: bool,
    /// Variance of the errors over the stated one. [-]
    pub variance_over_stated: f64,
    /// Index of the winner in the ranking. [-]
    pub winner: usize,
    /// Index of the best combination without a mark; absent if all are marked. [-]
    pub best_unmarked: Option<usize>,
    /// The best of all compared with the best without a mark; absent if they are the same, or all are marked.
    pub best_against_unmarked: Option<Comparison>,
    /// The mechanisms with their candidates.
    pub mechanisms: Vec<MechanismOfTournament>,
    /// The measured points.
    pub points: Vec<RankedPoint>,
    /// The combinations, sorted by predicted error.
    pub ranking: Vec<RankedCombination>,
    /// Unit of errors as text.
    #[serde(skip)]
    pub unit_in_words: &'static str,
    /// Notes on the detected format of the file.
    #[serde(skip)]
    pub notes_on_file: Vec<String>,
    /// Number of measured points in other gears. [-]
    #[serde(skip)]
    pub points_of_other_gears: usize,
    /// Number of combinations that could not be ranked. [-]
    #[serde(skip)]
    pub unranked: usize,
    /// Number of groups of neighbouring torques. [-]
    #[serde(skip)]
    pub groups: usize,
    /// Whether factors on the losses were fitted.
    #[serde(skip)]
    pub fits_factors: bool,
    /// Requested number of printed combinations. [-]
    #[serde(skip)]
    pub shown: usize,
    /// Maximum difference between the added losses of the winner and its losses solved together. [% of the loss]
    #[serde(skip)]
    pub gap_of_sum: f64,
    /// Number of quantities outside their stated ranges. [-]
    #[serde(skip)]
    pub unlisted: usize,
    /// Loss of all other components, by point. [W]
    #[serde(skip)]
    pub rest_w: Vec<f64>,
    /// Why models are omitted.
    #[serde(skip)]
    pub left_out: Vec<String>,
}

/// The spread of all combinations over a grid.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Spread {
    /// Name of the model set of all other components.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// Unit of errors: `points` (percentage points of efficiency), `w` or `nm`.
    pub unit: &'static str,
    /// Number of combinations. [-]
    pub combinations: usize,
    /// The mechanisms with their candidates.
    pub mechanisms: Vec<MechanismOfTournament>,
    /// Contribution of each mechanism.
    pub shares_of_spread: Vec<ShareOfSpread>,
    /// The points of the grid.
    pub points: Vec<SpreadPoint>,
    /// Unit of errors as text.
    #[serde(skip)]
    pub unit_in_words: &'static str,
    /// Standard deviation over the combinations, root mean square over the points. [unit]
    #[serde(skip)]
    pub deviation_rms: f64,
    /// Torques of the grid. [Nm]
    #[serde(skip)]
    pub torques: Vec<f64>,
    /// Speeds of the grid. [rad/s]
    #[serde(skip)]
    pub speeds: Vec<f64>,
    /// Number of quantities outside their stated ranges. [-]
    #[serde(skip)]
    pub unlisted: usize,
    /// Why models are omitted.
    #[serde(skip)]
    pub left_out: Vec<String>,
}

/// A mechanism with varied models.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MechanismOfTournament {
    /// Mechanism, with the slot of a drag.
    pub mechanism: String,
    /// The candidates.
    pub candidates: Vec<CandidateOfTournament>,
}

/// A candidate.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CandidateOfTournament {
    /// Its name in the tournament.
    pub name: String,
    /// The model as in a gearbox; null for the model of the set.
    pub model: Value,
    /// Loss of the mechanism at each point. [W]
    pub losses_w: Vec<f64>,
    /// Quantities outside their stated ranges at the points, as text.
    pub outside: Vec<String>,
    /// The quantities of these ranges.
    #[serde(skip)]
    pub quantities_outside: Vec<&'static str>,
    /// Time of all points relative to that of the set. [-]
    #[serde(skip)]
    pub time: f64,
}

/// A measured point and the predictions of the shortlist.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct RankedPoint {
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Measured loss. [W]
    pub measured_loss_w: f64,
    /// Its standard deviation. [W]
    pub loss_accuracy_w: f64,
    /// The same in the unit of errors; absent if the quantity does not exist. [unit]
    pub accuracy: Option<f64>,
    /// Weight of the point. [-]
    pub weight: f64,
    /// Weighted mean of the losses predicted by the shortlist. [W]
    pub mean_loss_w: f64,
    /// Their weighted standard deviation. [W]
    pub deviation_w: f64,
    /// The smallest of them. [W]
    pub least_loss_w: f64,
    /// The largest of them. [W]
    pub greatest_loss_w: f64,
    /// Speed. [rad/s]
    #[serde(skip)]
    pub speed: f64,
    /// An error of one watt in the unit of errors; absent if the quantity does not exist. [unit/W]
    #[serde(skip)]
    pub scale: Option<f64>,
}

/// A combination of models compared with the measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RankedCombination {
    /// Name of the model of each mechanism.
    pub models: Vec<String>,
    /// Root mean square of the predicted errors relative to the accuracy of the points. [-]
    pub predicted_over_accuracy: f64,
    /// Root mean square of the predicted errors. [unit]
    pub predicted_rms: Option<f64>,
    /// The same of the worst group. [unit]
    pub worst_group_rms: Option<f64>,
    /// Root mean square of the errors with factors fitted to all points. [unit]
    pub fitted_rms: Option<f64>,
    /// Their mean. [unit]
    pub mean: Option<f64>,
    /// Factor on the loss of each mechanism; one without a fit. [-]
    pub factors: Vec<f64>,
    /// Mechanisms whose factor is at a bound.
    pub on_bound: Vec<String>,
    /// Marks: quantities outside stated ranges, factors at a bound.
    pub marks: Vec<String>,
    /// The winner compared with it; absent for the winner.
    pub winner_against_it: Option<Comparison>,
    /// Weight on the shortlist; absent if it is not on it. [-]
    pub weight: Option<f64>,
    /// Index of the candidate of each mechanism.
    #[serde(skip)]
    pub places: Vec<usize>,
    /// The winner compared with it, including the winner itself.
    #[serde(skip)]
    pub against: Comparison,
}

/// Comparison of one combination with another.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Comparison {
    /// Whether the first is better.
    pub decision: Decision,
    /// Errors of the groups of points; absent with too few valid groups.
    pub folds: Option<ComparisonOfGroups>,
    /// Separation of the predictions in standard deviations of the set of points. [-]
    pub separation: f64,
    /// Misfit of the second minus that of the first, allowing for common errors. [-]
    pub evidence: f64,
}

/// Errors of two combinations, group by group.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct ComparisonOfGroups {
    /// Geometric mean of the ratio of errors, first over second. [-]
    pub ratio: f64,
    /// Its 95 % interval. [-]
    pub interval: [f64; 2],
    /// Number of groups in which the first predicts better. [-]
    pub won: usize,
    /// Number of groups. [-]
    pub groups: usize,
}

/// Contribution of a mechanism to the spread.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ShareOfSpread {
    /// Mechanism.
    pub mechanism: String,
    /// Its share of the variance; absent without a spread. [-]
    pub share: Option<f64>,
}

/// All combinations at a point of the grid.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct SpreadPoint {
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// The smallest loss. [W]
    pub least_loss_w: f64,
    /// Mean of the losses. [W]
    pub mean_loss_w: f64,
    /// The largest loss. [W]
    pub greatest_loss_w: f64,
    /// Standard deviation of the losses. [W]
    pub deviation_w: f64,
    /// Lower end, median and upper end of the 95 % band over the combinations, with the error of the models that measured sets judge; absent
    /// unless it is asked for. [W]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub band_w: Option<[f64; 3]>,
    /// An error of one watt in the unit of errors. [unit/W]
    #[serde(skip)]
    pub scale: f64,
}

impl Comparison {
    pub(super) fn new(standing: &Standing) -> Self {
        Self {
            decision: standing.decision,
            folds: standing.folds.map(|paired| ComparisonOfGroups {
                ratio: paired.ratio,
                interval: paired.interval,
                won: paired.won,
                groups: paired.folds,
            }),
            separation: standing.separation.square.sqrt(),
            evidence: standing.separation.evidence,
        }
    }
}

impl Ranking {
    /// Losses predicted by a combination at the points. \[W\]
    pub fn losses(&self, combination: &RankedCombination) -> Vec<f64> {
        let mechanisms = self.mechanisms.iter().map(|mechanism| {
            let candidates = mechanism.candidates.iter();
            candidates.map(|candidate| candidate.losses_w.as_slice()).collect()
        });
        let losses = Losses {
            rest: &self.rest_w,
            mechanisms: mechanisms.collect(),
        };
        losses.of_combination(&combination.places, &combination.factors)
    }

    /// Whether a combination is the winner, or is not distinguishable from it.
    pub fn is_alike(&self, place: usize) -> bool {
        place == self.winner || self.ranking[place].against.decision != Decision::Better
    }
}
