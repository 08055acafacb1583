//! The published outcome of an identification.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::compare::ComparisonOfSets;
use super::folds::FoldsOfSet;
use super::found::Found;
use super::hold_out::HoldOutOfSet;
use super::means::MeanOfFit;
use super::next::NextOfSet;
use super::parameter::ParameterOfSet;
use super::posterior::PosteriorOfSet;
use super::search::SearchOfSet;
use crate::analyses::Head;
use crate::correction::Correction;
use crate::points::Note;

/// Identification of uncertain parameters from measured points and means over cycles, with each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct IdentifyOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// The measured points; absent if only means are fitted.
    pub data: Option<DataOfFit>,
    /// One for each model set.
    pub identifications: Vec<IdentificationOfSet>,
    /// Comparison of the sets; absent for one set, or if a comparison is invalid.
    pub comparison_of_sets: Option<ComparisonOfSets>,
    /// Why sets were not compared.
    #[serde(skip)]
    pub not_compared: Option<&'static str>,
    /// Held-out rows, before the fit.
    #[serde(skip)]
    pub held_out: Option<HeldOutRows>,
    /// Further requested outputs.
    #[serde(skip)]
    pub requested: Requested,
}

impl IdentifyOutcome {
    /// What later analyses need of its corrections, in the form of the result; absent without corrections.
    pub(crate) fn corrections(&self) -> Option<Map<String, Value>> {
        let with = self.identifications.iter().filter(|of| !of.correction.is_empty());
        let record = |of: &IdentificationOfSet| json!({ "model_set": of.model_set, "correction": of.correction });
        let all: Vec<Value> = with.map(record).collect();
        (!all.is_empty()).then(|| Map::from_iter([("identifications".to_owned(), Value::Array(all))]))
    }
}

/// The measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DataOfFit {
    /// Name of the file, or of all files.
    pub file: String,
    /// Number of rows.
    pub points: usize,
    /// Notes on them.
    pub notes: Vec<String>,
}

/// Held-out rows.
#[derive(Debug, Clone)]
pub struct HeldOutRows {
    /// Number of rows.
    pub rows: usize,
    /// Their selection as text.
    pub words: String,
    /// Rows that are fitted because they lack a value that the condition uses.
    pub undecided: usize,
}

/// Further requested outputs.
#[derive(Debug, Clone)]
pub struct Requested {
    /// Torque of the points whose losses are stacked; absent: half the maximum. \[Nm\]
    pub stack_at: Option<f64>,
    /// Grouping of rows as text.
    pub groups: String,
    /// Whether the posterior is requested.
    pub posterior: bool,
    /// Whether proposed measurements are requested.
    pub next: bool,
}

/// Results for one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct IdentificationOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Whether the accuracies of points and means are given, or those of points estimated from their scatter.
    pub accuracy: AccuracyOfPoints,
    /// Notes on the points.
    pub notes: Vec<String>,
    /// The course of the search.
    pub search: SearchOfSet,
    /// Misfit of the models.
    pub misfit: MisfitOfSet,
    /// The parameters.
    pub parameters: Vec<ParameterOfSet>,
    /// Correlations of the parameters, row by row; absent for parameters that are not free. [-]
    pub correlations: Vec<Vec<Option<f64>>>,
    /// Singular values of the columns of the free parameters, each divided by its norm. [-]
    pub singular_values: Vec<f64>,
    /// Condition number: largest over smallest singular value; absent if columns are parallel. [-]
    pub condition: Option<f64>,
    /// Singular values of the columns, each times the range of its parameter. [-]
    pub singular_values_of_ranges: Vec<f64>,
    /// Draws from the posterior; absent if not requested or not possible.
    pub posterior: Option<PosteriorOfSet>,
    /// Number of identifiable combinations of free parameters.
    pub resolved_combinations: usize,
    /// Diagnostics of the residuals.
    pub checks: ChecksOfSet,
    /// Cross-validation errors; absent if not requested or if there are no groups.
    pub folds: Option<FoldsOfSet>,
    /// Held-out rows; absent if there are none.
    pub hold_out: Option<HoldOutOfSet>,
    /// Smooth corrections of the loss torque, one for each gear; absent if not requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub correction: Vec<Correction>,
    /// The fitted values.
    pub points: Vec<PointOfFit>,
    /// The fitted means over cycles; absent if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub means: Vec<MeanOfFit>,
    /// Proposed measurements; absent if not requested or not possible.
    pub next: Option<NextOfSet>,
    /// Notes of models at the end of the search.
    pub outside: Vec<Note>,
    /// Why there is no posterior, if requested.
    #[serde(skip)]
    pub no_posterior: Option<String>,
    /// All results, for tables and figures.
    #[serde(skip)]
    pub found: Found,
}

/// Origin of the accuracies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AccuracyOfPoints {
    /// Stated, in the data or with the means.
    Given,
    /// The scatter of the points.
    Estimated,
}

/// Misfit of the models.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MisfitOfSet {
    /// Each fitted quantity.
    pub quantities: Vec<MisfitOfQuantity>,
    /// Sum of the squared residuals of points, means and priors. [-]
    pub objective: f64,
    /// Sum of the squared residuals of points and means. [-]
    pub sum_of_squares: f64,
    /// Degrees of freedom, one for each point, mean and prior less one for each determined combination of parameters. [-]
    pub degrees_of_freedom: f64,
    /// Probability of a sum at least this large if model and accuracies are correct; absent without stated accuracies. [-]
    pub probability: Option<f64>,
    /// Factor by which intervals of parameters are too small; absent if they are not. [-]
    pub widening: Option<f64>,
    /// Standard deviation of the residuals. [-]
    pub standard_deviation_of_residuals: f64,
}

/// The misfit of one quantity.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MisfitOfQuantity {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Unit of the misfit: `points` (percentage points), `w`, `nm` or `k`.
    pub unit: &'static str,
    /// Root mean square of calculated minus measured at the start. [unit]
    pub rms_before: f64,
    /// The same at the end. [unit]
    pub rms: f64,
    /// Number of fitted values.
    pub points: usize,
}

/// Diagnostics of the residuals of a fit.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ChecksOfSet {
    /// Notes.
    pub sentences: Vec<String>,
    /// Whether the residuals of the points are normally distributed; absent for fewer than eight.
    pub anderson_darling: Option<NormalityOfResiduals>,
    /// Correlation of residuals along lines of neighbouring points.
    pub succession: Option<SuccessionOfResiduals>,
    /// The scatter of repeated points compared with the remaining residuals; absent without repetitions.
    pub pure_error: Option<RepeatedPoints>,
    /// Mean standardised residuals over torque. [Nm]
    pub residuals_over_torque: Vec<BandOfResiduals>,
    /// Mean standardised residuals over speed. [rpm]
    pub residuals_over_speed: Vec<BandOfResiduals>,
    /// Lines of outliers.
    pub outlier_lines: Vec<u64>,
    /// Lines of points with a leverage above one half.
    pub weighty_lines: Vec<u64>,
}

/// The Anderson-Darling test.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct NormalityOfResiduals {
    /// The statistic, corrected for the number of residuals. [-]
    pub statistic: f64,
    /// Probability of a statistic at least this large if residuals are normally distributed. [-]
    pub probability: f64,
}

/// Correlation of successive residuals.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SuccessionOfResiduals {
    /// Sum of the squared differences of neighbours over the sum of squares. [-]
    pub durbin_watson: f64,
    /// Correlation of neighbours. [-]
    pub correlation: f64,
    /// Runs of one sign.
    pub runs: usize,
    /// Expected number for independent signs. [-]
    pub expected_runs: f64,
    /// Difference of the two over its standard deviation; absent if all signs of each line are equal. [-]
    pub score: Option<f64>,
    /// Number of points in the lines.
    pub points: usize,
}

/// The scatter of repeated points compared with the remaining residuals.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RepeatedPoints {
    /// About the means of repeated points.
    pub pure: SumOfSquares,
    /// Remaining residuals.
    pub lack: SumOfSquares,
    /// Ratio of the mean squares, lack over pure. [-]
    pub ratio: f64,
    /// Probability of a ratio at least this large if the model is correct. [-]
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
    /// Number of points in it.
    pub points: usize,
    /// Mean of their standardised residuals. [-]
    pub mean: f64,
    /// Twice the standard deviation of such a mean if the model is correct. [-]
    pub limit: f64,
}

/// A fitted value; efficiencies as fractions.
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
    /// Oil temperature. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Standard deviation of the measurement, including its weight. [unit of the quantity]
    pub accuracy: f64,
    /// Measured, without the contribution of the rig at the start. [unit of the quantity]
    pub measured_before: f64,
    /// Calculated at the start. [unit of the quantity]
    pub model_before: f64,
    /// Measured, without the contribution of the identified rig. [unit of the quantity]
    pub measured: f64,
    /// Calculated. [unit of the quantity]
    pub model: f64,
    /// Calculated minus measured, relative to the accuracy. [-]
    pub residual: f64,
    /// Residual over its own standard deviation. [-]
    pub standardised_residual: f64,
    /// Leverage of the point, zero to one. [-]
    pub leverage: f64,
    /// Losses by mechanism at the row; absent without bands.
    pub losses: Option<Vec<LossOfPoint>>,
    /// Name of the file, if there are several.
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
    /// 95 % band of the loss; absent if the points do not determine it. [W]
    pub band_w: Option<[f64; 2]>,
    /// Share of the total loss; absent if that is zero. [-]
    pub share: Option<f64>,
    /// 95 % band of the share. [-]
    pub share_band: Option<[f64; 2]>,
}
