//! What a study writes of an identification.

use gearloss_framework::description::Ordered;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analyses::Entry;
use crate::study::{Data, FoldsEntry, HoldOutEntry, IdentifiedEntry, NamesOrParameters, Quantity, Then, Uses, Write};

/// Uncertain parameters of the gearbox and the rig, found by bounded least squares from measured points, with what the points say
/// about each of them.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct IdentifyEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Sets of models, each fitted by itself; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Measured points.
    pub data: Data,
    /// Columns of the data that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    pub bind: Ordered<String>,
    /// Gear state where no column says it; absent, the first.
    pub gear: Option<String>,
    /// What is fitted; several quantities count together.
    #[serde(default = "residuals")]
    #[schemars(length(min = 1))]
    pub residuals: Vec<Quantity>,
    /// The parameters by name, or names of those that the study states under `parameters`.
    #[schemars(with = "NamesOrParameters")]
    pub parameters: Ordered<IdentifiedEntry>,
    /// A loss by which outliers pull less.
    pub robust: Option<RobustEntry>,
    /// Whether the stated accuracy of each fitted quantity may be wrong by a factor, which is then found from the scatter.
    #[serde(default)]
    pub accuracy_factors: bool,
    /// Starts of the search: the first is that of the parameters, the others fill the bounds evenly. [-]
    #[serde(default = "starts")]
    #[schemars(range(min = 1, max = 1000))]
    pub starts: u32,
    /// Whether intervals are also found by profile: fits with one parameter held, until the misfit has grown too much.
    #[serde(default = "yes")]
    pub profiles: bool,
    /// Draws from the posterior: intervals that keep every shape, beside those of the fit and of the profiles.
    pub posterior: Option<PosteriorEntry>,
    /// Rows that are not fitted and are predicted afterwards, with bands: a condition such as `torque > 1000 Nm`, or one of
    /// `column`, `where`, `every` and `random`.
    pub hold_out: Option<HoldOutEntry>,
    /// Groups of rows of which each is predicted from the others: a number of groups of neighbouring torques, 0 for none, or
    /// `{ by: speed, count: 5 }`.
    #[serde(default = "folds")]
    pub folds: FoldsEntry,
    /// Torque of the points whose losses are stacked beside the measured total; absent, those nearest to half of the
    /// greatest. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub stack_at: Option<f64>,
    /// What to measure next.
    pub next: Option<NextEntry>,
    /// Name of a set of models for the analyses after this one: the fitted set with the values that were found.
    pub then: Option<String>,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::every_format")]
    pub write: Vec<Write>,
}

impl Entry for IdentifyEntry {
    const TYPE: &'static str = "identify";
    const MEANING: &'static str = "Uncertain parameters, found from measured points.";

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.next.as_ref().map(|next| &next.grid),
            grid_key: "next.grid",
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
                .at(&self.gear)
                .bind(&self.bind)
                .with("data", Some(&self.data))
        }
    }

    fn then(&self) -> Option<Then<'_>> {
        let set = self.then.as_deref()?;
        Some(Then {
            set,
            model_sets: &self.model_sets,
        })
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

/// A loss by which outliers pull less.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct RobustEntry {
    /// The loss.
    pub loss: RobustLoss,
    /// Residual, in standard deviations of the measurement, from which on a point counts as far. [-]
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
    /// Squares near zero, straight far out.
    SoftL1,
    /// Squares up to the scale, straight beyond.
    Huber,
    /// Logarithm: far points hardly pull.
    Cauchy,
    /// Bounded: far points do not pull at all.
    Arctan,
}

/// How the posterior of the parameters is drawn: every value of a range counts alike before, of a logarithmic parameter every
/// ratio, and a `prior` beside.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct PosteriorEntry {
    /// Steps of each walker; the first third is thrown away. [-]
    #[serde(default = "steps")]
    #[schemars(range(min = 30, max = 100000))]
    pub steps: u32,
    /// Walkers, at least two for each parameter; absent, four for each and at least 16. [-]
    #[schemars(range(min = 4, max = 1000))]
    pub walkers: Option<u32>,
    /// Number that the draws follow from. [-]
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

/// What to measure next: points of a grid, ranked by what they tell about the parameters.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct NextEntry {
    /// Grid of the points that the rig can run, of one gear state.
    pub grid: String,
    /// Temperatures of the oil at which the rig can run them; absent, that of the study. [degC]
    #[serde(default)]
    #[schemars(inner(range(min = -60.0, max = 250.0)), length(max = 50))]
    pub oil_temperatures: Vec<f64>,
    /// How many points. [-]
    #[serde(default = "eight")]
    #[schemars(range(min = 1, max = 1000))]
    pub points: u32,
    /// What the points are to make small.
    #[serde(default)]
    pub rule: RuleEntry,
    /// What another torque costs more than one point. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub cost_of_torque: f64,
    /// What another temperature of the oil costs more than one point. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub cost_of_temperature: f64,
}

fn eight() -> u32 {
    8
}

/// What points to be measured are to make small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RuleEntry {
    /// The widest interval over its range.
    #[default]
    Worst,
    /// The sum of the variances, each over the square of its range (A-optimal).
    Trace,
    /// The volume of the joint region (D-optimal).
    Determinant,
}
