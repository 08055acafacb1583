//! Held-out rows: their predictions compared with those of fitted rows.

mod errors;

use gearloss_framework::loss::Extent;
use gearloss_numerics::inference::{ErrorSummary, Region, Widening, regions};
use schemars::JsonSchema;
use serde::Serialize;

pub use errors::ErrorsOfQuantity;

use crate::distinct::distinct;
use crate::identify::{
    CONFIDENCE, Calculated, Fitted, HoldOut, Identification, Pair, PredictedNumber, Predictions, Profiled,
};
use crate::numbers::{RPM, tidy};
use crate::study::{Difference, Quantity};

/// Held-out rows, predicted with the parameters of a set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HoldOutOfSet {
    /// Selection of the rows as text.
    pub chosen_by: String,
    /// Number of held-out rows.
    pub rows: usize,
    /// Number of fitted rows.
    pub rows_fitted: usize,
    /// Confidence of the bands. [-]
    pub confidence: f64,
    /// Widening of the bands relative to the fit.
    pub widening: WideningOfBands,
    /// Why there are no bands, if there are none.
    pub no_bands: Option<String>,
    /// Rows without a calculated value, with the reason.
    pub not_predicted: Vec<String>,
    /// Errors of each quantity.
    pub quantities: Vec<HoldOutQuantity>,
    /// One for each predicted value.
    pub points: Vec<HoldOutPoint>,
}

/// Factors by which standard deviations are increased because the model does not fit the points.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct WideningOfBands {
    /// Factor on standard deviations of parameters and of derived quantities. [-]
    pub parameters: f64,
    /// Factor on the scatter of one measurement about the model. [-]
    pub scatter: f64,
}

/// Errors of one quantity, of held-out and fitted rows.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HoldOutQuantity {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Unit of the errors: `points` (percentage points), `w`, `nm` or `k`.
    pub unit: &'static str,
    /// Errors of held-out rows.
    pub held_out: Option<SummaryOfErrors>,
    /// Errors of fitted rows.
    pub fitted: Option<SummaryOfErrors>,
    /// Coverage of the bands.
    pub coverage: Option<CoverageOfBands>,
    /// Notes.
    pub sentence: Option<String>,
    /// Errors over bands of torque, speed and temperature, and for both directions of power.
    pub regions: Vec<ErrorsOfRegion>,
    /// All errors and their summaries.
    #[serde(skip)]
    pub errors: ErrorsOfQuantity,
}

/// Summary of errors, calculated minus measured.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SummaryOfErrors {
    /// Number of errors.
    pub points: usize,
    /// Root mean square. [unit of the quantity]
    pub rms: f64,
    /// Mean: the bias of the calculation. [unit of the quantity]
    pub mean: f64,
    /// The error with the largest magnitude. [unit of the quantity]
    pub greatest: f64,
    /// Point of this error.
    pub greatest_at: PlaceOfError,
    /// The same in percent of the measured values; absent unless all measured values have the same sign and are not zero. [%]
    pub in_percent: Option<FiguresOfErrors>,
    /// The same in standard deviations of the measurements; absent unless all are stated. [-]
    pub in_accuracies: Option<FiguresOfErrors>,
}

/// Point of an error.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PlaceOfError {
    /// Line in the file.
    pub line: u64,
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
}

/// Statistics of errors in the unit of their key.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FiguresOfErrors {
    /// Root mean square. [as the key]
    pub rms: f64,
    /// Mean. [as the key]
    pub mean: f64,
    /// The value with the largest magnitude. [as the key]
    pub greatest: f64,
}

/// Coverage of the bands.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CoverageOfBands {
    /// Number of measurements inside their bands.
    pub inside: usize,
    /// Number of measurements with a band.
    pub points: usize,
    /// Share inside. [-]
    pub share: f64,
    /// 95 % interval of the share. [-]
    pub interval: Option<[f64; 2]>,
}

/// Errors in one region.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ErrorsOfRegion {
    /// The divided quantity: `torque`, `speed`, `oil_temperature` or `direction`.
    pub over: &'static str,
    /// The region as text.
    pub name: String,
    /// Lower end; absent for directions. [Nm, rpm or degC]
    pub from: Option<f64>,
    /// Upper end; absent for directions. [Nm, rpm or degC]
    pub to: Option<f64>,
    /// Errors of held-out rows.
    pub held_out: Option<SummaryOfErrors>,
    /// Errors of fitted rows.
    pub fitted: Option<SummaryOfErrors>,
}

/// A held-out value and its prediction; efficiencies as fractions.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HoldOutPoint {
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
    /// Standard deviation of the measurement; absent if unknown. [unit of the quantity]
    pub accuracy: Option<f64>,
    /// Measured, without the contribution of the identified rig. [unit of the quantity]
    pub measured: f64,
    /// Predicted. [unit of the quantity]
    pub predicted: f64,
    /// 95 % band of the measurement; absent if the fitted points do not determine it. [unit of the quantity]
    pub band: Option<[f64; 2]>,
    /// Whether the measurement is inside its band.
    pub inside: Option<bool>,
}

/// Predicts the held-out rows with the parameters of a fit, and returns the observed limits. `calculated` and `pairs` are those of the fit.
pub(super) fn predict(
    choice: &HoldOut,
    residuals: &[Quantity],
    (identification, fitted): (&Identification<'_>, &Fitted),
    (calculated, pairs): (&Calculated, &[Pair]),
    (widening, profiles): (Widening, &[Option<Profiled>]),
) -> Result<(HoldOutOfSet, Vec<Extent>), String> {
    let predictions = identification.predict(fitted, &choice.held_out, residuals, (widening, profiles))?;
    if predictions.numbers.is_empty() {
        return Err(match predictions.missing.first() {
            Some(reason) => reason.clone(),
            None => "no held-out row has a measured value of a fitted quantity".to_owned(),
        });
    }
    let quantities = distinct(predictions.numbers.iter().map(|number| number.observation.quantity));
    let accuracy = fitted.inference.accuracy();
    let summed = |quantity: Quantity| {
        let mut errors = identification.placed_errors(calculated, pairs, quantity);
        errors.extend(predictions.placed_errors(&choice.held_out, accuracy, quantity));
        let of_kind = |held: bool| ErrorSummary::summarise(errors.iter().filter(|e| e.is_held_out == held));
        let errors = ErrorsOfQuantity {
            quantity,
            fitted: of_kind(false),
            held_out: of_kind(true),
            coverage: predictions.coverage(Some(quantity)),
            regions: regions(&errors),
            all: errors,
        };
        HoldOutQuantity::new(errors, &choice.words)
    };
    let numbers = predictions.numbers.iter();
    let record = HoldOutOfSet {
        chosen_by: choice.words.clone(),
        rows: choice.held_out.rows.len(),
        rows_fitted: choice.fitted.rows.len(),
        confidence: CONFIDENCE,
        widening: WideningOfBands {
            parameters: predictions.widening.parameters,
            scatter: predictions.widening.scatter,
        },
        quantities: quantities.into_iter().map(summed).collect(),
        points: numbers
            .map(|number| HoldOutPoint::new(choice, &predictions, number))
            .collect(),
        no_bands: predictions.no_bands,
        not_predicted: predictions.missing,
    };
    Ok((record, predictions.calculated.solved.seen))
}

impl HoldOutPoint {
    fn new(choice: &HoldOut, predictions: &Predictions, number: &PredictedNumber) -> Self {
        let measured = &choice.held_out;
        let row = &measured.rows[number.observation.row];
        let (_, gear, point) = &predictions.calculated.solved.rows[number.observation.row];
        Self {
            line: row.line,
            name: row.name.clone(),
            gear: gear.clone(),
            torque_nm: measured.value(row, "torque"),
            speed_rpm: tidy(point.speed * RPM),
            oil_temperature_degc: point.oil,
            quantity: number.observation.quantity.name(),
            accuracy: Some(number.observation.deviation).filter(|d| d.is_finite()),
            measured: number.pair.measured,
            predicted: number.pair.model,
            band: number.band,
            inside: number.is_inside(),
        }
    }
}

impl From<&ErrorSummary> for SummaryOfErrors {
    fn from(summary: &ErrorSummary) -> Self {
        let three = |[rms, mean, greatest]: [f64; 3]| FiguresOfErrors { rms, mean, greatest };
        let at = summary.greatest;
        Self {
            points: summary.count,
            rms: summary.rms,
            mean: summary.mean,
            greatest: at.error,
            greatest_at: PlaceOfError {
                line: at.line,
                torque_nm: at.torque,
                speed_rpm: tidy(at.speed),
            },
            in_percent: summary.in_percent.map(three),
            in_accuracies: summary.in_accuracies.map(three),
        }
    }
}

impl HoldOutQuantity {
    fn new(errors: ErrorsOfQuantity, choice: &str) -> Self {
        let summary = |errors: &Option<ErrorSummary>| errors.as_ref().map(SummaryOfErrors::from);
        let region = |region: &Region| ErrorsOfRegion {
            over: region.over,
            name: region.name.clone(),
            from: region.band.map(|band| band[0]),
            to: region.band.map(|band| band[1]),
            held_out: summary(&region.held_out),
            fitted: summary(&region.fitted),
        };
        Self {
            quantity: errors.quantity.name(),
            unit: errors.quantity.unit(Difference::Points),
            held_out: summary(&errors.held_out),
            fitted: summary(&errors.fitted),
            coverage: errors.coverage.map(|c| CoverageOfBands {
                inside: c.inside,
                points: c.count,
                share: c.share(),
                interval: c.interval(CONFIDENCE),
            }),
            sentence: errors.sentence(choice),
            regions: errors.regions.iter().map(region).collect(),
            errors,
        }
    }
}
