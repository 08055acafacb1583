//! What comes out of a tournament, as records.

use gearloss_numerics::inference::Decision;
use gearloss_numerics::selection::{Losses, Standing};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::super::Head;

/// Every combination of the models of some mechanisms.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct TournamentOutcome {
    /// Where it comes from.
    #[serde(flatten)]
    pub head: Head,
    /// The ranking, or the spread.
    pub tournament: Tournament,
}

/// A ranking where points were measured, else the spread.
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
    /// Name of the set that gives everything else.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// Unit of errors: `points` of efficiency, `w` or `nm`.
    pub unit: &'static str,
    /// Number of combinations that were ranked. [-]
    pub combinations: usize,
    /// Root mean square of the accuracies of the points; absent where no point has one in this unit. [unit]
    pub accuracy: Option<f64>,
    /// What a reader should know of the accuracy of the points.
    pub notes: Vec<String>,
    /// Correlation between the errors of any two points. [-]
    pub correlation: f64,
    /// Whether it was estimated from the residuals of the best combination.
    pub correlation_estimated: bool,
    /// Variance of the errors over the stated one. [-]
    pub variance_over_stated: f64,
    /// Place of the winner in the ranking, from zero. [-]
    pub winner: usize,
    /// Place of the best combination without a mark, from zero; absent where all are marked. [-]
    pub best_unmarked: Option<usize>,
    /// The best of all against the best without a mark; absent where they are the same, or all are marked.
    pub best_against_unmarked: Option<Comparison>,
    /// The mechanisms with the models that take part.
    pub mechanisms: Vec<MechanismOfTournament>,
    /// The measured points.
    pub points: Vec<RankedPoint>,
    /// The combinations, the smallest predicted error first.
    pub ranking: Vec<RankedCombination>,
    /// Unit of errors in words.
    #[serde(skip)]
    pub unit_in_words: &'static str,
    /// How the file was understood.
    #[serde(skip)]
    pub notes_on_file: Vec<String>,
    /// Number of measured points of other gear states. [-]
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
    /// How many combinations the study wants to see. [-]
    #[serde(skip)]
    pub shown: usize,
    /// How far the added losses of the winner are at most from the losses that are solved as a whole. [% of the loss]
    #[serde(skip)]
    pub gap_of_sum: f64,
    /// Number of stated ranges that models left. [-]
    #[serde(skip)]
    pub unlisted: usize,
    /// Loss of all that does not change, by point. [W]
    #[serde(skip)]
    pub rest_w: Vec<f64>,
    /// Why models do not take part.
    #[serde(skip)]
    pub left_out: Vec<String>,
}

/// The spread of all combinations over a grid.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Spread {
    /// Name of the set that gives everything else.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// Unit of errors: `points` of efficiency, `w` or `nm`.
    pub unit: &'static str,
    /// Number of combinations. [-]
    pub combinations: usize,
    /// The mechanisms with the models that take part.
    pub mechanisms: Vec<MechanismOfTournament>,
    /// How much each mechanism contributes.
    pub shares_of_spread: Vec<ShareOfSpread>,
    /// The points of the grid.
    pub points: Vec<SpreadPoint>,
    /// Unit of errors in words.
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
    /// Number of stated ranges that models left. [-]
    #[serde(skip)]
    pub unlisted: usize,
    /// Why models do not take part.
    #[serde(skip)]
    pub left_out: Vec<String>,
}

/// A mechanism whose models change.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MechanismOfTournament {
    /// Mechanism, with the slot of a drag.
    pub mechanism: String,
    /// The models that take part.
    pub candidates: Vec<CandidateOfTournament>,
}

/// A model that takes part.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CandidateOfTournament {
    /// Its name in the tournament.
    pub name: String,
    /// The model as in a gearbox; null for what the set has.
    pub model: Value,
    /// Loss of the mechanism at each point. [W]
    pub losses_w: Vec<f64>,
    /// Stated ranges that it leaves at the points, in words.
    pub outside: Vec<String>,
    /// The quantities of these ranges.
    #[serde(skip)]
    pub quantities_outside: Vec<&'static str>,
    /// Time of all points over that of the set. [-]
    #[serde(skip)]
    pub time: f64,
}

/// A measured point, and what the shortlist predicts there.
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
    /// The same in the unit of errors; absent where the quantity does not exist. [unit]
    pub accuracy: Option<f64>,
    /// How much the point counts. [-]
    pub weight: f64,
    /// Weighted mean of the losses that the shortlist predicts. [W]
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
    /// An error of one watt in the unit of errors; absent where the quantity does not exist. [unit/W]
    #[serde(skip)]
    pub scale: Option<f64>,
}

/// A combination of models against the measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RankedCombination {
    /// Name of the model of each mechanism.
    pub models: Vec<String>,
    /// Root mean square of the predicted errors over the accuracy of the points. [-]
    pub predicted_over_accuracy: f64,
    /// Root mean square of the predicted errors. [unit]
    pub predicted_rms: Option<f64>,
    /// That of the worst group. [unit]
    pub worst_group_rms: Option<f64>,
    /// Root mean square of the errors with factors fitted to all points. [unit]
    pub fitted_rms: Option<f64>,
    /// Their mean. [unit]
    pub mean: Option<f64>,
    /// Factor on the loss of each mechanism; one where none are fitted. [-]
    pub factors: Vec<f64>,
    /// Mechanisms whose factor is on a bound.
    pub on_bound: Vec<String>,
    /// What speaks against it: stated ranges that a model left, factors on a bound.
    pub marks: Vec<String>,
    /// The winner against it; absent for the winner.
    pub winner_against_it: Option<Comparison>,
    /// Weight on the shortlist; absent where it is not on it. [-]
    pub weight: Option<f64>,
    /// Place of the candidate of each mechanism.
    #[serde(skip)]
    pub places: Vec<usize>,
    /// The winner against it, also where it is the winner.
    #[serde(skip)]
    pub against: Comparison,
}

/// One combination against another.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Comparison {
    /// Whether the first is better.
    pub decision: Decision,
    /// Errors of the groups of points; absent where too few groups count.
    pub folds: Option<ComparisonOfGroups>,
    /// How far apart the predictions are, in standard deviations of the set of points. [-]
    pub separation: f64,
    /// Misfit of the second less that of the first, allowing for common errors. [-]
    pub evidence: f64,
}

/// Errors of two combinations, group by group.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct ComparisonOfGroups {
    /// Geometric mean of the error of the first over that of the second. [-]
    pub ratio: f64,
    /// Its 95 % interval. [-]
    pub interval: [f64; 2],
    /// Number of groups that the first predicts better. [-]
    pub won: usize,
    /// Number of groups. [-]
    pub groups: usize,
}

/// How much a mechanism contributes to the spread.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ShareOfSpread {
    /// Mechanism.
    pub mechanism: String,
    /// Its share of the variance; absent where nothing spreads. [-]
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
    /// Losses that a combination predicts at the points. \[W\]
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
