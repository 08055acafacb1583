//! Rows that were held out of a fit: their predictions beside those of fitted rows.

mod errors;

use gearloss_framework::loss::Extent;
use gearloss_numerics::inference::{ErrorSummary, Region, Widening, regions};
use schemars::JsonSchema;
use serde::Serialize;

pub use errors::ErrorsOfQuantity;

use super::outcome::IdentificationOfSet;
use crate::analyses::numbers::{RPM, tidy};
use crate::cells;
use crate::identify::{
    CONFIDENCE, Calculated, Fitted, HoldOut, Identification, Pair, PredictedNumber, Predictions, Profiled,
};
use crate::study::{Difference, Quantity};
use crate::table::{Column, Table};

/// Rows that were held out, predicted with the parameters of a set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HoldOutOfSet {
    /// How the rows were chosen, in words.
    pub chosen_by: String,
    /// Number of rows that were held out.
    pub rows: usize,
    /// Number of rows that were fitted.
    pub rows_fitted: usize,
    /// Confidence of the bands. [-]
    pub confidence: f64,
    /// By how much bands are wider than the fit itself says.
    pub widening: WideningOfBands,
    /// Why there are no bands, where there are none.
    pub no_bands: Option<String>,
    /// Rows that have no calculated value, and why.
    pub not_predicted: Vec<String>,
    /// Errors of each quantity.
    pub quantities: Vec<HoldOutQuantity>,
    /// One for each number that was predicted.
    pub points: Vec<HoldOutPoint>,
}

/// Factors by which standard deviations are greater than the fit itself says, because its model misses its own points.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct WideningOfBands {
    /// Factor on standard deviations of parameters and of what follows from them. [-]
    pub parameters: f64,
    /// Factor on the scatter of one measurement about the model. [-]
    pub scatter: f64,
}

/// Errors of one quantity, of rows that were held out and of fitted rows.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HoldOutQuantity {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Unit of the errors: points, w, nm or k.
    pub unit: &'static str,
    /// Errors of rows that were held out.
    pub held_out: Option<SummaryOfErrors>,
    /// Errors of fitted rows.
    pub fitted: Option<SummaryOfErrors>,
    /// How many measurements lie inside of their bands.
    pub coverage: Option<CoverageOfBands>,
    /// What there is to say.
    pub sentence: Option<String>,
    /// Errors over bands of torque, speed and temperature, and in both directions of power.
    pub regions: Vec<ErrorsOfRegion>,
    /// The errors one by one, and what they were summed up to.
    #[serde(skip)]
    pub errors: ErrorsOfQuantity,
}

/// Errors summed up, calculated less measured.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SummaryOfErrors {
    /// Number of errors.
    pub points: usize,
    /// Root of the mean square. [unit of the quantity]
    pub rms: f64,
    /// Mean: the bias of the calculation. [unit of the quantity]
    pub mean: f64,
    /// The error of the greatest magnitude. [unit of the quantity]
    pub greatest: f64,
    /// Where that is.
    pub greatest_at: PlaceOfError,
    /// The same in percent of the measured values; absent unless all of these have one sign and are not zero. [%]
    pub in_percent: Option<FiguresOfErrors>,
    /// The same in standard deviations of the measurements; absent unless all state them. [-]
    pub in_accuracies: Option<FiguresOfErrors>,
}

/// Where an error is.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PlaceOfError {
    /// Line in the file.
    pub line: u64,
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
}

/// Figures of errors, in the unit of their key.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FiguresOfErrors {
    /// Root of the mean square. [as the key]
    pub rms: f64,
    /// Mean. [as the key]
    pub mean: f64,
    /// The value of the greatest magnitude. [as the key]
    pub greatest: f64,
}

/// How many measurements lie inside of their bands.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CoverageOfBands {
    /// Measurements inside.
    pub inside: usize,
    /// All measurements that have a band.
    pub points: usize,
    /// Share of those inside. [-]
    pub share: f64,
    /// 95 % interval of the share. [-]
    pub interval: Option<[f64; 2]>,
}

/// Errors in one region.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ErrorsOfRegion {
    /// What is divided: `torque`, `speed`, `oil_temperature` or `direction`.
    pub over: &'static str,
    /// The region in words.
    pub name: String,
    /// Lower end; absent for directions. [Nm, rpm or degC]
    pub from: Option<f64>,
    /// Upper end; absent for directions. [Nm, rpm or degC]
    pub to: Option<f64>,
    /// Errors of rows that were held out.
    pub held_out: Option<SummaryOfErrors>,
    /// Errors of fitted rows.
    pub fitted: Option<SummaryOfErrors>,
}

/// A number that was held out, beside its prediction; efficiencies as shares.
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
    /// Temperature of the oil. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Standard deviation of the measurement; absent where none is known. [unit of the quantity]
    pub accuracy: Option<f64>,
    /// Measured, without what the identified rig adds. [unit of the quantity]
    pub measured: f64,
    /// Predicted. [unit of the quantity]
    pub predicted: f64,
    /// 95 % band of the measurement; absent where the fitted points do not determine it. [unit of the quantity]
    pub band: Option<[f64; 2]>,
    /// Whether the measurement lies inside of its band.
    pub inside: Option<bool>,
}

/// Predicts what was held out with the parameters of a fit, and says what was seen of limits there. `calculated` and `pairs` are those
/// of the fit.
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
            None => "no row that is held out has a measured number of what is fitted".to_owned(),
        });
    }
    let mut quantities: Vec<Quantity> = Vec::new();
    for number in &predictions.numbers {
        if !quantities.contains(&number.observation.quantity) {
            quantities.push(number.observation.quantity);
        }
    }
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

/// One row for each number that was held out.
pub(super) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    const UNIT: &str = "mixed";
    let mut table = Table::new(
        format!("{name}-hold-out"),
        [
            Column::text("model_set", "Model set"),
            Column::number("line", "-", "Line in the file"),
            Column::text("name", "Name of the row"),
            Column::text("gear", "Gear state"),
            Column::number("torque_nm", "Nm", "Torque"),
            Column::number("speed_rpm", "rpm", "Speed"),
            Column::number("oil_temperature_degc", "degC", "Temperature of the oil"),
            Column::text(
                "quantity",
                "Quantity of this row, with its unit; efficiencies are shares",
            ),
            Column::number("measured", UNIT, "Measured, without what the identified rig adds"),
            Column::number("predicted", UNIT, "Predicted"),
            Column::number("band_low", UNIT, "Lower end of the 95 % band of the measurement"),
            Column::number("band_high", UNIT, "Upper end of the 95 % band of the measurement"),
            Column::text("inside", "Whether the measurement lies inside of its band"),
        ],
    );
    for o in all {
        for point in o.hold_out.iter().flat_map(|held| &held.points) {
            table.push(cells![
                &o.model_set,
                point.line as usize,
                point.name.as_deref().unwrap_or_default(),
                &point.gear,
                point.torque_nm,
                point.speed_rpm,
                point.oil_temperature_degc,
                point.quantity,
                point.measured,
                point.predicted,
                point.band.map(|band| band[0]),
                point.band.map(|band| band[1]),
                point.inside.map_or("", |inside| if inside { "true" } else { "false" }),
            ]);
        }
    }
    table
}
