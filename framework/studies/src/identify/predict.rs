//! Predictions of rows that were not fitted, with bands from the fit.

use super::fit::JUMPS;
use super::{Calculated, Fitted, Identification, Observation, Pair};
use crate::measured::Measured;
use crate::study::{Difference, Quantity};
use gearloss_numerics::inference::{Accuracy, Coverage, PlacedError, ProfileInterval, Widening, hull};
use gearloss_numerics::sensitivity::gradients;

/// Confidence of the bands.
pub const CONFIDENCE: f64 = 0.95;
/// Radians per second in one revolution per minute.
const RPM: f64 = std::f64::consts::PI / 30.0;

/// A measured value that was not fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PredictedNumber {
    /// Row of the held-out measurement, quantity, and standard deviation of one measurement: the stated accuracy, or the scatter of the
    /// fitted points. Not finite if both are unknown.
    pub observation: Observation,
    /// Measured, without the contribution of the identified rig, and predicted.
    pub pair: Pair,
    /// 95 % band of the measurement about the predicted value; absent if the fitted points do not determine it.
    pub band: Option<[f64; 2]>,
}

impl PredictedNumber {
    /// Whether the measurement is inside its band.
    pub fn is_inside(&self) -> Option<bool> {
        self.band
            .map(|[low, high]| low <= self.pair.measured && self.pair.measured <= high)
    }
}

/// Rows that were not fitted, predicted.
pub struct Predictions {
    /// The values, by quantity in the order of the rows.
    pub numbers: Vec<PredictedNumber>,
    /// State of the gearbox at the rows.
    pub calculated: Calculated,
    /// Rows without a calculated value, with the reason.
    pub missing: Vec<String>,
    /// Widening of the bands relative to the fit.
    pub widening: Widening,
    /// Why there are no bands, if there are none.
    pub no_bands: Option<String>,
}

impl Predictions {
    /// Coverage of the bands of a quantity, or of all quantities.
    pub fn coverage(&self, quantity: Option<Quantity>) -> Option<Coverage> {
        let numbers = self
            .numbers
            .iter()
            .filter(|n| quantity.is_none_or(|q| n.observation.quantity == q));
        Coverage::count(numbers.filter_map(PredictedNumber::is_inside))
    }
}

impl Identification<'_> {
    /// Predicts rows that were not fitted. The difference between measurement and prediction depends on the parameters of gearbox and rig,
    /// and its band on their full covariance and the scatter of one measurement.
    ///
    /// A parameter at its bound is not part of the covariance; the band is the hull with the band at the other end of its profile interval,
    /// as for losses by mechanism.
    ///
    /// # Errors
    /// If the rows are invalid for the gearbox.
    pub fn predict(
        &self,
        fitted: &Fitted,
        held_out: &Measured,
        residuals: &[Quantity],
        (widening, profiles): (Widening, &[Option<Result<ProfileInterval, String>>]),
    ) -> Result<Predictions, String> {
        let there = self.with_rows(held_out, Vec::new())?;
        let calculated = there.calculate(fitted.theta())?;
        let (mut observations, mut pairs, mut missing) = (Vec::new(), Vec::new(), Vec::new());
        for quantity in residuals {
            for row in 0..held_out.rows.len() {
                let Some((mut observation, accuracy)) = there.observable(row, *quantity, &calculated) else {
                    continue;
                };
                if observation.is_counted_by(*quantity, residuals) {
                    continue;
                }
                let factor = fitted.factors.iter().find(|(q, _)| *q == observation.quantity);
                observation.deviation *= match self.accuracy {
                    Accuracy::Given if accuracy.is_none_or(|a| a <= 0.0) => f64::NAN,
                    Accuracy::Given => factor.map_or(1.0, |(_, factor)| *factor),
                    Accuracy::Estimated => fitted.inference.scatter(),
                };
                match there.pair(&observation, &calculated) {
                    Ok(pair) => {
                        observations.push(observation);
                        pairs.push(pair);
                    }
                    Err(reason) => missing.push(reason),
                }
            }
        }
        let bands = there.bands(self, fitted, (&observations, &pairs), (widening, profiles));
        let (bands, no_bands) = match bands {
            Ok(bands) => (bands, None),
            Err(reason) => (vec![None; pairs.len()], Some(reason)),
        };
        let numbers = observations.into_iter().zip(pairs).zip(bands);
        Ok(Predictions {
            numbers: numbers
                .map(|((observation, pair), band)| PredictedNumber {
                    observation,
                    pair,
                    band,
                })
                .collect(),
            calculated,
            missing,
            widening,
            no_bands,
        })
    }

    /// Bands of observations of this identification from the fit of another one.
    fn bands(
        &self,
        of_fit: &Identification<'_>,
        fitted: &Fitted,
        (observations, pairs): (&[Observation], &[Pair]),
        (widening, profiles): (Widening, &[Option<Result<ProfileInterval, String>>]),
    ) -> Result<Vec<Option<[f64; 2]>>, String> {
        // The contribution of the rig is subtracted from the measurement, so the difference also depends on its parameters.
        let errors = |theta: &[f64]| -> Result<Vec<f64>, String> {
            let calculated = self.calculate(theta)?;
            let error = |o: &Observation| self.pair(o, &calculated).map(|pair| pair.model - pair.measured);
            observations.iter().map(error).collect()
        };
        let slopes = gradients(fitted.inference.parameters(), JUMPS, errors)?;
        let around = |((o, pair), slopes): ((&Observation, &Pair), &Vec<f64>)| {
            fitted
                .inference
                .predict(pair.model, slopes, o.deviation, widening, CONFIDENCE)
                .band
        };
        let mut bands: Vec<Option<[f64; 2]>> = observations.iter().zip(pairs).zip(&slopes).map(around).collect();
        for theta in of_fit.far_ends(fitted, profiles)? {
            for ((band, pair), error) in bands.iter_mut().zip(pairs).zip(errors(&theta)?) {
                let moved = error - (pair.model - pair.measured);
                *band = band.map(|[low, high]| hull([low, high], [low + moved, high + moved]));
            }
        }
        Ok(bands)
    }

    /// Errors of a fitted quantity with their points; in percentage points, W, Nm or K.
    pub fn placed_errors(&self, calculated: &Calculated, pairs: &[Pair], quantity: Quantity) -> Vec<PlacedError> {
        let is_stated = self.accuracy == Accuracy::Given;
        let predicted = self
            .observations
            .iter()
            .zip(pairs)
            .filter(|(o, _)| o.quantity == quantity);
        predicted
            .filter_map(|(o, pair)| {
                let oil = calculated.point(o.row).oil;
                placed(self.measured(), (o, pair), oil, (is_stated, false))
            })
            .collect()
    }
}

impl Predictions {
    /// Errors of a quantity with their points; in percentage points, W, Nm or K. `accuracy` is that of the fit.
    pub fn placed_errors(&self, held_out: &Measured, accuracy: Accuracy, quantity: Quantity) -> Vec<PlacedError> {
        let numbers = self.numbers.iter().filter(|n| n.observation.quantity == quantity);
        numbers
            .filter_map(|n| {
                let oil = self.calculated.point(n.observation.row).oil;
                let is_stated = accuracy == Accuracy::Given && n.observation.deviation.is_finite();
                placed(held_out, (&n.observation, &n.pair), oil, (is_stated, true))
            })
            .collect()
    }
}

fn placed(
    measured: &Measured,
    (o, pair): (&Observation, &Pair),
    oil: Option<f64>,
    (is_stated, is_held_out): (bool, bool),
) -> Option<PlacedError> {
    let row = &measured.rows[o.row];
    let unit = o.quantity.difference(Difference::Points, 0.0, 1.0)?;
    Some(PlacedError {
        line: row.line,
        torque: measured.value(row, "torque").unwrap_or(0.0),
        speed: measured.value(row, "speed").unwrap_or(0.0) / RPM,
        oil: measured.value(row, "oil_temperature").or(oil),
        error: unit * (pair.model - pair.measured),
        measured: unit * pair.measured,
        accuracy: is_stated.then_some(unit * o.deviation),
        is_held_out,
    })
}
