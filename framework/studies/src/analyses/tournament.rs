//! Every combination of the models of some mechanisms: ranked by a measurement, or the spread that they leave.

mod candidates;
mod field;
mod marks;
mod measurements;
mod outcome;
mod ranking;
mod slot;
mod spread;
mod tables;

use gearloss_framework::description::Ordered;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

pub use outcome::{
    CandidateOfTournament, Comparison, ComparisonOfGroups, MechanismOfTournament, RankedCombination, RankedPoint,
    Ranking, ShareOfSpread, Spread, SpreadPoint, Tournament, TournamentOutcome,
};

use super::{Analysis, Context, Entry, Stopped};
use crate::register_analysis;
use crate::study::{Data, Difference, Quantity, Uses, Write};

/// The most combinations.
const MOST: usize = 200_000;

/// Every combination of the models of some mechanisms. The loss of each is evaluated once and added; against measured points
/// combinations are ranked by their cross-validated error over the accuracy of the measured loss, without them their spread is the
/// uncertainty of the models.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct TournamentEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state of the data; absent, the first. A grid has its own.
    pub gear: Option<String>,
    /// Set of models for everything else; absent, the models of the gearbox.
    pub model_set: Option<String>,
    /// The mechanisms whose models change.
    #[schemars(length(min = 1))]
    pub mechanisms: Vec<CandidatesEntry>,
    /// Grid, of one gear state; not with `data`.
    pub grid: Option<String>,
    /// Measured points that the combinations are ranked by.
    pub data: Option<Data>,
    /// Accuracy of the loss at points for which the file states none: of the loss, the loss torque or the efficiency, or of the
    /// torque meters. Absent too, 5 % of the loss and 1 % of the root mean square of all losses are assumed.
    pub errors: Option<LossErrorsEntry>,
    /// Correlation between the errors of any two points, which is the share of common errors in their variance: 0 where each point errs on its
    /// own, 1 where all err together, as by a gain or an offset of a torque meter; more than 0.99 counts as 0.99. Absent, it is estimated
    /// from the residuals of the best combination. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub correlation: Option<f64>,
    /// The unit in which errors are printed: efficiency points, watts, or newton metres. The ranking is the same for all.
    #[serde(default)]
    pub quantity: Quantity,
    /// Each mechanism's loss may be scaled by a factor, fitted within these bounds for each combination.
    pub factors: Option<FactorsEntry>,
    /// Groups of neighbouring torques of which each is predicted from the others. [-]
    #[serde(default = "folds")]
    #[schemars(range(min = 2, max = 20))]
    pub folds: u32,
    /// How many combinations are printed. [-]
    #[serde(default = "shown")]
    #[schemars(range(min = 1, max = 1000))]
    pub shown: u32,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::every_format")]
    pub write: Vec<Write>,
}

fn folds() -> u32 {
    5
}

fn shown() -> u32 {
    10
}

/// The models of one mechanism that take part.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CandidatesEntry {
    /// Mechanism, such as `bearing`.
    pub mechanism: String,
    /// Slot of a mechanism of which a gear has several models: `churning` of `gear_drag`.
    pub slot: Option<String>,
    /// Models by name, each as in a gearbox: `{ type: skf }`; absent, all that this gearbox has the inputs
    /// for, with their defaults. A model that takes another one, such as a mesh model that takes a `tooth_friction`, takes part with each of them.
    /// Those of drags are named always, because laws for churning, injection and windage are one mechanism.
    #[serde(default)]
    pub models: Ordered<Value>,
}

/// Accuracy of measured losses: a share of the loss, a constant, or both, which add as squares.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct LossErrorsEntry {
    /// Standard deviation in percent of the loss, above zero. [-]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent: Option<f64>,
    /// Standard deviation at every point, above zero. [W]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub absolute: Option<f64>,
}

/// Bounds of the factors.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct FactorsEntry {
    /// Least factor. [-]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least: f64,
    /// Greatest factor. [-]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub greatest: f64,
}

impl Entry for TournamentEntry {
    const TYPE: &'static str = "tournament";
    const MEANING: &'static str = "Every combination of models, ranked by a measurement.";

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.grid.as_ref(),
            ..Uses::new(self.gearbox.as_ref(), &self.model_set)
                .at(&self.gear)
                .with("data", self.data.as_ref())
        }
    }
}

register_analysis!(TournamentEntry);

impl Analysis for TournamentEntry {
    type Outcome = TournamentOutcome;

    fn run(&self, cx: &Context<'_>) -> Result<TournamentOutcome, Stopped> {
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        self.check(cx)?;
        let built = cx.built(gearbox, self.model_set.as_slice())?;
        let base = &built[0];
        cx.undivided()?;
        let tournament = match (&self.grid, &self.data) {
            (Some(grid), None) => Tournament::Spread(Box::new(self.spread(cx, grid, base)?)),
            (None, Some(data)) => Tournament::Ranking(Box::new(self.ranking(cx, data, base)?)),
            _ => {
                return Err(cx.wrong(
                    &cx.path(),
                    "a tournament needs either `data` or `grid`",
                    "give measured points under `data`, or a `grid` for the spread of the models",
                ));
            }
        };
        let head = cx.head(&[base]);
        Ok(TournamentOutcome { head, tournament })
    }

    fn formats(&self) -> &[Write] {
        &self.write
    }
}

impl TournamentEntry {
    /// Refuses what fits no tournament, whatever it takes.
    fn check(&self, cx: &Context<'_>) -> Result<(), Stopped> {
        let path = cx.path();
        if self.quantity == Quantity::Temperature {
            let message = "combinations are ranked by losses, not by temperature";
            return Err(cx.wrong(&format!("{path}.quantity"), message, "write `quantity: loss`"));
        }
        if let Some(errors) = self.errors {
            let both = [errors.percent, errors.absolute];
            if both.iter().all(Option::is_none) || both.iter().flatten().any(|x| *x <= 0.0) {
                let message = "accuracies of losses are above zero, and one at least is stated";
                let help = "write `{ percent: 2, absolute: 5 W }`, or one of the two";
                return Err(cx.wrong(&format!("{path}.errors"), message, help));
            }
        }
        if let Some(f) = self.factors.filter(|f| f.least >= f.greatest) {
            let message = format!("factors from {} to {} leave no room", f.least, f.greatest);
            let help = "write `{ least: 0.5, greatest: 2 }`";
            return Err(cx.wrong(&format!("{path}.factors"), message, help));
        }
        Ok(())
    }

    /// Unit of errors in words.
    fn unit_in_words(&self) -> &'static str {
        self.quantity.words(Difference::Points).1
    }

    /// Unit of errors in results.
    fn unit(&self) -> &'static str {
        self.quantity.unit(Difference::Points)
    }
}
