//! The entry of an identification.

use gearloss_framework::description::Ordered;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::correction::CorrectionEntry;
use crate::study::{Data, FoldsEntry, HoldOutEntry, IdentifiedEntry, MeanEntry, NamesOrParameters, Quantity};

/// Identification of uncertain parameters from measured points and means over cycles.
///
/// Parameters of gearbox and rig by bounded least squares, with intervals and verdicts.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct IdentifyEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Model sets, each fitted separately; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
    /// Measured points; without them only `means` are fitted.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub data: Option<Data>,
    /// Means over cycles by name, such as published losses of a drive unit: each is fitted as one measured value.
    #[serde(default)]
    pub means: Ordered<MeanEntry>,
    /// Columns of the data that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub bind: Ordered<String>,
    /// Gear of rows without a column `gear` and of cycles without a gear; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Fitted quantities of the points; several are fitted simultaneously.
    #[serde(default = "residuals")]
    #[schemars(length(min = 1))]
    pub residuals: Vec<Quantity>,
    /// The parameters by name, or names from `parameters` of the study.
    #[schemars(with = "NamesOrParameters")]
    pub parameters: Ordered<IdentifiedEntry>,
    /// A robust loss function against outliers.
    pub robust: Option<RobustEntry>,
    /// Whether the stated accuracy of each fitted quantity is multiplied by a factor that is estimated from the scatter.
    #[serde(default)]
    pub accuracy_factors: bool,
    /// Number of starts of the search: the first is that of the parameters, the others are distributed within the bounds. [-]
    #[serde(default = "starts")]
    #[schemars(range(min = 1, max = 1000))]
    pub starts: u32,
    /// Whether profile likelihood intervals are also computed, by fits with one parameter fixed.
    #[serde(default = "yes")]
    pub profiles: bool,
    /// Draws from the posterior, for intervals of any shape in addition to those of fit and profiles.
    pub posterior: Option<PosteriorEntry>,
    /// Held-out rows, which are not fitted but predicted with bands: a condition such as `torque > 1000 Nm`, or one of `column`, `where`,
    /// `every` and `random`.
    pub hold_out: Option<HoldOutEntry>,
    /// Groups of rows for cross-validation: a number of groups of neighbouring torques, 0 for none, or `{ by: speed, count: 5 }`.
    #[serde(default = "folds")]
    pub folds: FoldsEntry,
    /// Torque of the points in the figure of stacked losses and measured total; default: nearest to half the maximum. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub stack_at: Option<f64>,
    /// A smooth correction of the loss torque that remains after the fit, apart from the physics and with its uncertainty: `{}`. Maps and comparisons
    /// read it from the JSON result.
    pub correction: Option<CorrectionEntry>,
    /// Proposed measurements.
    pub next: Option<NextEntry>,
    /// Name of a model set for later analyses: the fitted set with the identified values.
    #[schemars(extend("x-defines" = "model_sets"))]
    pub then: Option<String>,
}

impl IdentifyEntry {
    /// A stated key that needs points; absent if there is none. What is stated as the default is not told from what is not stated.
    pub(super) fn key_of_points(&self) -> Option<&'static str> {
        let keys = [
            ("bind", !self.bind.is_empty()),
            ("residuals", self.residuals != residuals()),
            ("hold_out", self.hold_out.is_some()),
            ("folds", ![folds(), FoldsEntry::Torques(0)].contains(&self.folds)),
            ("correction", self.correction.is_some()),
            ("next", self.next.is_some()),
            ("stack_at", self.stack_at.is_some()),
            ("accuracy_factors", self.accuracy_factors),
        ];
        keys.into_iter().find(|(_, stated)| *stated).map(|(key, _)| key)
    }
}

fn residuals() -> Vec<Quantity> {
    vec![Quantity::Efficiency]
}

fn starts() -> u32 {
    4
}

fn yes() -> bool {
    true
}

fn folds() -> FoldsEntry {
    FoldsEntry::Torques(5)
}

/// A robust loss function against outliers.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct RobustEntry {
    /// The loss.
    pub loss: RobustLoss,
    /// Scale of the loss: residual in standard deviations of the measurement above which a point is treated as distant. [-]
    #[serde(default = "far")]
    #[schemars(range(min = 0.1, max = 100.0))]
    pub scale: f64,
}

fn far() -> f64 {
    2.0
}

/// A loss by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RobustLoss {
    /// Squares: least squares.
    Linear,
    /// Quadratic near zero, linear for large residuals.
    SoftL1,
    /// Quadratic up to the scale, linear above.
    Huber,
    /// Logarithmic: distant points have little influence.
    Cauchy,
    /// Bounded: distant points have no influence.
    Arctan,
}

/// Settings of the posterior. The prior is uniform over the range, for a logarithmic parameter uniform in the logarithm, in addition to
/// `prior`.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct PosteriorEntry {
    /// Steps of each walker; the first third is discarded. [-]
    #[serde(default = "steps")]
    #[schemars(range(min = 30, max = 100000))]
    pub steps: u32,
    /// Number of walkers, at least two for each parameter; default: four for each, and at least 16. [-]
    #[schemars(range(min = 4, max = 1000))]
    pub walkers: Option<u32>,
    /// Seed of the draws. [-]
    #[serde(default = "seed")]
    #[schemars(range(min = 0, max = 4294967295_u32))]
    pub seed: u32,
}

fn steps() -> u32 {
    1500
}

fn seed() -> u32 {
    1
}

/// Proposed measurements: points of a grid, ranked by their information on the parameters.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct NextEntry {
    /// Grid of the points that the rig can run, with one gear.
    #[schemars(extend("x-refers-to" = "grids"))]
    pub grid: String,
    /// Oil temperatures at which the rig can run them; default: from the study. [degC]
    #[serde(default)]
    #[schemars(inner(range(min = -60.0, max = 250.0)), length(max = 50))]
    pub oil_temperatures: Vec<f64>,
    /// Number of points. [-]
    #[serde(default = "eight")]
    #[schemars(range(min = 1, max = 1000))]
    pub points: u32,
    /// Design criterion.
    #[serde(default)]
    pub rule: RuleEntry,
    /// Additional cost of a change of torque, in points. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub cost_of_torque: f64,
    /// Additional cost of a change of oil temperature, in points. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub cost_of_temperature: f64,
}

fn eight() -> u32 {
    8
}

/// Design criterion of proposed measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RuleEntry {
    /// The widest interval relative to its range.
    #[default]
    Worst,
    /// The sum of the variances, each relative to the square of its range (A-optimal).
    Trace,
    /// The volume of the joint region (D-optimal).
    Determinant,
}
