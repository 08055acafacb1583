//! The entry of a tournament.

use gearloss_framework::description::Ordered;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::super::common::model_error::ModelErrorEntry;
use super::super::{Planner, Stopped};
use crate::analyses::common::measurable::measured;
use crate::study::{Data, Difference, Quantity};

/// Maximum number of combinations.
pub const MOST: usize = 200_000;

/// Every combination of models, ranked by a measurement.
///
/// The loss of each model is evaluated once and added. With measured points,
/// combinations are ranked by their cross-validated error relative to the accuracy of the measured loss; without them, their spread is the
/// model-form uncertainty.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct TournamentEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Gear of the data; default: the first. A grid has its own.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Model set of all other components; default: the models of the gearbox.
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_set: Option<String>,
    /// The mechanisms whose models are varied.
    #[schemars(length(min = 1))]
    pub mechanisms: Vec<CandidatesEntry>,
    /// Grid with one gear; not with `data`.
    #[schemars(extend("x-refers-to" = "grids"))]
    pub grid: Option<String>,
    /// Measured points for the ranking.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub data: Option<Data>,
    /// Accuracy of the loss at points without an accuracy of loss, loss torque, efficiency or torque meters in the file. Default (assumed):
    /// 5 % of the loss and 1 % of the root mean square of all losses.
    pub errors: Option<LossErrorsEntry>,
    /// Correlation between the errors of any two points, the share of common errors in their variance: 0 for independent errors, 1 for
    /// common errors only, such as a gain or an offset of a torque meter; limited to 0.99. Default: estimated from the residuals of the
    /// best combination. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub correlation: Option<f64>,
    /// Printed unit of errors: percentage points of efficiency, watts, or newton metres. The ranking is the same for all.
    #[serde(default)]
    pub quantity: Quantity,
    /// Bounds of a factor on each mechanism's loss, fitted for each combination.
    pub factors: Option<FactorsEntry>,
    /// Error of the models for a band of the loss over all combinations: a factor on the loss of each model that measured sets judge. Only with
    /// `grid`: with `data` the measured points judge.
    pub model_error: Option<ModelErrorEntry>,
    /// Number of groups of neighbouring torques for cross-validation. [-]
    #[serde(default = "folds")]
    #[schemars(range(min = 2, max = 20))]
    pub folds: u32,
    /// Number of printed combinations. [-]
    #[serde(default = "shown")]
    #[schemars(range(min = 1, max = 1000))]
    pub shown: u32,
}

fn folds() -> u32 {
    5
}

fn shown() -> u32 {
    10
}

/// The candidate models of one mechanism.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CandidatesEntry {
    /// Mechanism, such as `bearing`.
    #[schemars(extend("x-refers-to" = "mechanism"))]
    pub mechanism: String,
    /// Slot, if a gear has several models of the mechanism: `churning` of `gear_drag`.
    pub slot: Option<String>,
    /// Models by name, each as in a gearbox: `{ type: skf }`; default: all models whose inputs this gearbox has, with their defaults. A
    /// model with a nested model, such as a mesh model with `tooth_friction`, is combined with each nested model. Models of drags must be
    /// listed, because laws for churning, injection and windage are one mechanism.
    #[serde(default)]
    pub models: Ordered<Value>,
}

/// Accuracy of measured losses: relative, constant, or both, which are added as squares.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct LossErrorsEntry {
    /// Standard deviation in percent of the loss, positive. [%]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent: Option<f64>,
    /// Standard deviation at every point, positive. [W]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub absolute: Option<f64>,
}

/// Bounds of the factors.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct FactorsEntry {
    /// Minimum factor. [-]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least: f64,
    /// Maximum factor. [-]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub greatest: f64,
}

impl TournamentEntry {
    /// Rejects invalid keys.
    pub(super) fn check(&self, cx: &Planner<'_>) -> Result<(), Stopped> {
        let path = cx.path();
        if self.model_error.is_some() && self.data.is_some() {
            let message = "with `data` the measured points judge the models";
            return Err(cx.wrong(
                &format!("{path}.model_error"),
                message,
                "delete it, or give a `grid` instead of `data`",
            ));
        }
        if self.quantity == Quantity::Temperature {
            let message = "combinations are ranked by losses, not by temperature";
            return Err(cx.wrong(&format!("{path}.quantity"), message, "write `quantity: loss`"));
        }
        measured(cx, &path, self.quantity)?;
        if let Some(errors) = self.errors {
            let both = [errors.percent, errors.absolute];
            if both.iter().all(Option::is_none) || both.iter().flatten().any(|x| *x <= 0.0) {
                let message = "accuracies of losses must be positive, and at least one must be stated";
                let help = "write `{ percent: 2, absolute: 5 W }`, or one of them";
                return Err(cx.wrong(&format!("{path}.errors"), message, help));
            }
        }
        if let Some(f) = self.factors.filter(|f| f.least >= f.greatest) {
            let message = format!("factors from {} to {} are not a range", f.least, f.greatest);
            let help = "write `{ least: 0.5, greatest: 2 }`";
            return Err(cx.wrong(&format!("{path}.factors"), message, help));
        }
        Ok(())
    }

    /// Unit of errors as text.
    pub(super) fn unit_in_words(&self) -> &'static str {
        self.quantity.words(Difference::Points).1
    }

    /// Unit of errors in results.
    pub(super) fn unit(&self) -> &'static str {
        self.quantity.unit(Difference::Points)
    }
}
