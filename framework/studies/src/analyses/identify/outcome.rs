//! What comes out of an identification, as it is published.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::compare::{self, ComparisonOfSets};
use super::folds::FoldsOfSet;
use super::found::Found;
use super::hold_out::{self, HoldOutOfSet};
use super::next::{self, NextOfSet};
use super::parameter::ParameterOfSet;
use super::posterior::{self, PosteriorOfSet};
use super::search::SearchOfSet;
use super::{tables, values};
use crate::analyses::{Head, Outcome, TextFile};
use crate::analysis::Note;
use crate::identify::Identified;
use crate::table::Table;

/// Uncertain parameters, found from measured points under each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct IdentifyOutcome {
    /// Where it comes from.
    #[serde(flatten)]
    pub head: Head,
    /// The measured points.
    pub data: DataOfFit,
    /// One for each model set.
    pub identifications: Vec<IdentificationOfSet>,
    /// The sets side by side; absent for one set, and where a comparison would not be just.
    pub comparison_of_sets: Option<ComparisonOfSets>,
    /// Why sets were not compared.
    #[serde(skip)]
    pub not_compared: Option<&'static str>,
    /// Rows that were held out, before anything was fitted.
    #[serde(skip)]
    pub held_out: Option<HeldOutRows>,
    /// Requested outputs beside the fit.
    #[serde(skip)]
    pub requested: Requested,
}

/// The measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DataOfFit {
    /// Name of the file, or of all files.
    pub file: String,
    /// Number of rows.
    pub points: usize,
    /// What a user should know of them.
    pub notes: Vec<String>,
}

/// Rows that are held out of the fits.
#[derive(Debug, Clone)]
pub struct HeldOutRows {
    /// Number of rows.
    pub rows: usize,
    /// How they were chosen, in words.
    pub words: String,
    /// Rows that are fitted because they lack what the condition asks for.
    pub undecided: usize,
}

/// Requested outputs beside the fit.
#[derive(Debug, Clone)]
pub struct Requested {
    /// Torque of the points whose losses are stacked; absent, half of the greatest. \[Nm\]
    pub stack_at: Option<f64>,
    /// By what rows are grouped, in words that follow `without its own`.
    pub groups: String,
    /// Whether the posterior is drawn.
    pub posterior: bool,
    /// Whether points to be measured are ranked.
    pub next: bool,
}

/// All that was found for one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct IdentificationOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Whether the accuracies of the points are given or estimated from their scatter.
    pub accuracy: AccuracyOfPoints,
    /// What a user should know of the points.
    pub notes: Vec<String>,
    /// How the search went.
    pub search: SearchOfSet,
    /// How far the models are from the points.
    pub misfit: MisfitOfSet,
    /// The parameters.
    pub parameters: Vec<ParameterOfSet>,
    /// Correlations of the parameters, row by row; absent for those that do not move. [-]
    pub correlations: Vec<Vec<Option<f64>>>,
    /// Singular values of the columns of the free parameters, each divided by its norm. [-]
    pub singular_values: Vec<f64>,
    /// Greatest over smallest singular value; absent where columns are parallel. [-]
    pub condition: Option<f64>,
    /// Singular values of the columns, each times the range of its parameter. [-]
    pub singular_values_of_ranges: Vec<f64>,
    /// Draws from the posterior; absent where they were not requested, or none could be drawn.
    pub posterior: Option<PosteriorOfSet>,
    /// Combinations of free parameters that the points resolve.
    pub resolved_combinations: usize,
    /// What the residuals say against the fit.
    pub checks: ChecksOfSet,
    /// Errors of groups of rows that are predicted from the others; absent where they were not requested, or there are none.
    pub folds: Option<FoldsOfSet>,
    /// Rows that were held out; absent where there are none.
    pub hold_out: Option<HoldOutOfSet>,
    /// The fitted numbers.
    pub points: Vec<PointOfFit>,
    /// What to measure next; absent where that was not requested, or nothing can be said.
    pub next: Option<NextOfSet>,
    /// What models noted at the end of the search.
    pub outside: Vec<Note>,
    /// Why there is no posterior, where it was requested.
    #[serde(skip)]
    pub no_posterior: Option<String>,
    /// All that was found, as tables and pictures need it.
    #[serde(skip)]
    pub found: Found,
}

/// Where the accuracies of points come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AccuracyOfPoints {
    /// The data state them.
    Given,
    /// The scatter of the points.
    Estimated,
}

/// How far the models are from the points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MisfitOfSet {
    /// Each fitted quantity.
    pub quantities: Vec<MisfitOfQuantity>,
    /// Sum of the squared residuals, those of priors with them. [-]
    pub objective: f64,
    /// Sum of the squared residuals of the points. [-]
    pub sum_of_squares: f64,
    /// Degrees of freedom. [-]
    pub degrees_of_freedom: f64,
    /// Probability of a sum as great or greater if model and accuracies are right; absent without stated accuracies. [-]
    pub probability: Option<f64>,
    /// Factor by which intervals of parameters are too small; absent where they are not. [-]
    pub widening: Option<f64>,
    /// Standard deviation of the residuals. [-]
    pub standard_deviation_of_residuals: f64,
}

/// The misfit of one quantity.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MisfitOfQuantity {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Unit of the misfit: points, w, nm or k.
    pub unit: &'static str,
    /// Root of the mean square of calculated less measured where the search began. [unit]
    pub rms_before: f64,
    /// The same at the end. [unit]
    pub rms: f64,
    /// Number of fitted numbers.
    pub points: usize,
}

/// What the residuals say against a fit.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ChecksOfSet {
    /// What there is to say.
    pub sentences: Vec<String>,
    /// Whether the residuals are normally distributed; absent for fewer than eight.
    pub anderson_darling: Option<NormalityOfResiduals>,
    /// How residuals follow each other along lines of neighbouring points.
    pub succession: Option<SuccessionOfResiduals>,
    /// The scatter of repeated points beside the rest; absent where nothing is repeated.
    pub pure_error: Option<RepeatedPoints>,
    /// Mean standardised residuals over torque. [Nm]
    pub residuals_over_torque: Vec<BandOfResiduals>,
    /// Mean standardised residuals over speed. [rpm]
    pub residuals_over_speed: Vec<BandOfResiduals>,
    /// Lines of points that are far out.
    pub outlier_lines: Vec<u64>,
    /// Lines of points that decide more than half of their own calculated value.
    pub weighty_lines: Vec<u64>,
}

/// The test of Anderson and Darling.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct NormalityOfResiduals {
    /// The statistic, corrected for the number of residuals. [-]
    pub statistic: f64,
    /// Probability of a statistic as great or greater if residuals are normally distributed. [-]
    pub probability: f64,
}

/// How residuals follow each other.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SuccessionOfResiduals {
    /// Sum of the squared differences of neighbours over the sum of squares. [-]
    pub durbin_watson: f64,
    /// Correlation of neighbours. [-]
    pub correlation: f64,
    /// Runs of one sign.
    pub runs: usize,
    /// How many are expected if signs do not depend on each other. [-]
    pub expected_runs: f64,
    /// Difference of the two over its standard deviation; absent where all signs of each line are the same. [-]
    pub score: Option<f64>,
    /// Points in the lines.
    pub points: usize,
}

/// The scatter of repeated points set against what is left over.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RepeatedPoints {
    /// About the means of repeated points.
    pub pure: SumOfSquares,
    /// What is left.
    pub lack: SumOfSquares,
    /// Ratio of the mean squares, lack over pure. [-]
    pub ratio: f64,
    /// Probability of a ratio as great or greater if the model is right. [-]
    pub probability: f64,
}

/// A sum of squares.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SumOfSquares {
    /// The sum. [-]
    pub squares: f64,
    /// Its degrees of freedom. [-]
    pub degrees_of_freedom: f64,
}

/// Mean residual in a band.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BandOfResiduals {
    /// Lower end. [Nm or rpm]
    pub from: f64,
    /// Upper end. [Nm or rpm]
    pub to: f64,
    /// Points in it.
    pub points: usize,
    /// Mean of their standardised residuals. [-]
    pub mean: f64,
    /// Twice the standard deviation of such a mean if the model is right. [-]
    pub limit: f64,
}

/// A fitted number; efficiencies as shares.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PointOfFit {
    /// Line in the file.
    pub line: u64,
    /// Name of the row.
    pub name: Option<String>,
    /// Gear state.
    pub gear: String,
    /// Torque. [Nm]
    pub torque_nm: Option<f64>,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Temperature of the oil. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Standard deviation of the measurement, its weight counted in. [unit of the quantity]
    pub accuracy: f64,
    /// Measured, without what the rig adds where the search begins. [unit of the quantity]
    pub measured_before: f64,
    /// Calculated where the search begins. [unit of the quantity]
    pub model_before: f64,
    /// Measured, without what the identified rig adds. [unit of the quantity]
    pub measured: f64,
    /// Calculated. [unit of the quantity]
    pub model: f64,
    /// Calculated less measured over the accuracy. [-]
    pub residual: f64,
    /// Residual over its own standard deviation. [-]
    pub standardised_residual: f64,
    /// How far the point decides its own calculated value, zero to one. [-]
    pub leverage: f64,
    /// Losses by mechanism at the row; absent where they have no bands.
    pub losses: Option<Vec<LossOfPoint>>,
    /// Name of the file, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

/// Loss of a mechanism at a point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LossOfPoint {
    /// The mechanism.
    pub mechanism: &'static str,
    /// Loss. [W]
    pub loss_w: f64,
    /// 95 % band of the loss; absent where the points do not determine it. [W]
    pub band_w: Option<[f64; 2]>,
    /// Share of the loss of all; absent where that is zero. [-]
    pub share: Option<f64>,
    /// 95 % band of the share. [-]
    pub share_band: Option<[f64; 2]>,
}

impl Outcome for IdentifyOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let (name, all) = (self.head.analysis.as_str(), &self.identifications[..]);
        let mut list = vec![
            tables::points(name, all),
            tables::shares(name, all),
            tables::parameters(name, all),
        ];
        list.extend(self.requested.posterior.then(|| posterior::table(name, all)));
        list.extend(self.held_out.as_ref().map(|_| hold_out::table(name, all)));
        list.extend(self.requested.next.then(|| next::table(name, all)));
        list.extend(self.comparison_of_sets.as_ref().map(|sets| compare::table(name, sets)));
        list
    }

    fn notes(&self) -> Vec<&Note> {
        self.identifications.iter().flat_map(|o| &o.outside).collect()
    }

    fn found(&self) -> Vec<(String, Value)> {
        // A study names the values of one set only.
        match &self.identifications[..] {
            [o] => Identified::overrides(&o.found.parameters, o.found.fitted.theta()),
            _ => Vec::new(),
        }
    }

    fn files(&self) -> Vec<TextFile> {
        let name = &self.head.analysis;
        let file = |o: &IdentificationOfSet| TextFile {
            name: format!("{name}-{}.yaml", o.model_set.replace('/', "-")),
            text: values::as_yaml(name, o),
        };
        self.identifications.iter().map(file).collect()
    }
}
