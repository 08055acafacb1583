//! Published records of a fit.

use gearloss_numerics::inference::{Accuracy, BandMean};

use super::entry::IdentifyEntry;
use super::folds::FoldsOfSet;
use super::found::{Beside, Found};
use super::means::MeanOfFit;
use super::outcome::{
    AccuracyOfPoints, BandOfResiduals, ChecksOfSet, IdentificationOfSet, LossOfPoint, MisfitOfQuantity, MisfitOfSet,
    NormalityOfResiduals, PointOfFit, RepeatedPoints, SuccessionOfResiduals, SumOfSquares,
};
use super::parameter::ParameterOfSet;
use super::search::SearchOfSet;
use crate::identify::Observation;
use crate::numbers::{RPM, tidy};
use crate::study::Difference;

/// Singular value of columns times sizes above which a combination is identifiable: a 95 % half-width below half the size.
const RESOLVED: f64 = 4.0;

impl IdentificationOfSet {
    pub(super) fn new(model_set: &str, entry: &IdentifyEntry, found: Found, beside: Beside) -> Self {
        let inference = &found.fitted.inference;
        let count = inference.parameters().len();
        let sized = inference.sized_singular_values();
        let row = |j: usize| (0..count).map(|k| inference.correlation(j, k)).collect();
        let (posterior, no_posterior) = match beside.posterior {
            None => (None, None),
            Some(Ok(posterior)) => (Some(posterior), None),
            Some(Err(reason)) => (None, Some(reason)),
        };
        let next = found.next.as_ref().and_then(|next| next.as_ref().ok());
        Self {
            model_set: model_set.to_owned(),
            accuracy: match inference.accuracy() {
                Accuracy::Given => AccuracyOfPoints::Given,
                Accuracy::Estimated => AccuracyOfPoints::Estimated,
            },
            notes: found.notes.clone(),
            search: SearchOfSet::new(&found),
            misfit: MisfitOfSet::new(&found),
            parameters: (0..count).map(|k| ParameterOfSet::new(&found, k)).collect(),
            correlations: (0..count).map(row).collect(),
            singular_values: inference.singular_values().to_vec(),
            condition: inference.condition(),
            singular_values_of_ranges: inference.ranged_singular_values(),
            posterior,
            resolved_combinations: sized.iter().filter(|value| **value > RESOLVED).count(),
            checks: ChecksOfSet::new(&found),
            folds: FoldsOfSet::new(&found, &entry.folds),
            hold_out: beside.held_out,
            correction: beside.correction,
            points: points(&found),
            means: MeanOfFit::all(&found),
            next: next.map(|next| next.record(&found)),
            outside: beside.outside,
            no_posterior,
            found,
        }
    }
}

impl MisfitOfSet {
    fn new(found: &Found) -> Self {
        let inference = &found.fitted.inference;
        let quantities = found.quantities().into_iter().map(|quantity| {
            let [rms_before, rms] = found.rms(quantity);
            MisfitOfQuantity {
                quantity: quantity.name(),
                unit: quantity.unit(Difference::Points),
                rms_before,
                rms,
                points: found.deviations(quantity, 1).len(),
            }
        });
        Self {
            quantities: quantities.collect(),
            objective: inference.objective(),
            sum_of_squares: inference.chi_square(),
            degrees_of_freedom: inference.freedom(),
            probability: found.checks.lack.map(|lack| lack.probability),
            widening: found.widening(),
            standard_deviation_of_residuals: inference.scatter(),
        }
    }
}

impl ChecksOfSet {
    fn new(found: &Found) -> Self {
        let c = &found.checks;
        let lines = |places: &[usize]| -> Vec<u64> {
            let line = |place: &usize| found.measured.rows[found.observations[*place].row].line;
            places.iter().map(line).collect()
        };
        let squares = |[squares, degrees_of_freedom]: [f64; 2]| SumOfSquares {
            squares,
            degrees_of_freedom,
        };
        Self {
            sentences: c.words(&found.measured, &found.observations),
            anderson_darling: c.normality.map(|t| NormalityOfResiduals {
                statistic: t.corrected,
                probability: t.probability,
            }),
            succession: c.succession.map(|s| SuccessionOfResiduals {
                durbin_watson: s.durbin_watson,
                correlation: s.correlation,
                runs: s.runs,
                expected_runs: s.expected,
                score: s.score,
                points: s.points,
            }),
            pure_error: c.pure.map(|p| RepeatedPoints {
                pure: squares(p.pure),
                lack: squares(p.lack),
                ratio: p.ratio,
                probability: p.probability,
            }),
            residuals_over_torque: c.over_torque.iter().map(BandOfResiduals::from).collect(),
            residuals_over_speed: c.over_speed.iter().map(BandOfResiduals::from).collect(),
            outlier_lines: lines(&c.outliers),
            weighty_lines: lines(&c.weighty),
        }
    }
}

impl From<&BandMean> for BandOfResiduals {
    fn from(band: &BandMean) -> Self {
        Self {
            from: band.band[0],
            to: band.band[1],
            points: band.count,
            mean: band.mean,
            limit: band.limit,
        }
    }
}

/// Measured and calculated values, and losses by mechanism with their bands.
fn points(found: &Found) -> Vec<PointOfFit> {
    let measured = &found.measured;
    let point = |(i, observation): (usize, &Observation)| {
        let row = &measured.rows[observation.row];
        let there = &found.rows[1][observation.row];
        let [before, after] = [0, 1].map(|k| found.pairs[k][i]);
        PointOfFit {
            line: row.line,
            name: row.name.clone(),
            gear: there.gear.clone(),
            torque_nm: measured.value(row, "torque"),
            speed_rpm: tidy(there.speed * RPM),
            oil_temperature_degc: there.oil,
            quantity: observation.quantity.name(),
            accuracy: observation.deviation,
            measured_before: before.measured,
            model_before: before.model,
            measured: after.measured,
            model: after.model,
            residual: (after.model - after.measured) / observation.deviation,
            standardised_residual: found.checks.standardised[i],
            leverage: found.fitted.inference.leverage()[i],
            losses: losses(found, observation.row),
            file: measured.file(row).map(str::to_owned),
        }
    };
    found.observations.iter().enumerate().map(point).collect()
}

/// Losses by mechanism at a row.
fn losses(found: &Found, row: usize) -> Option<Vec<LossOfPoint>> {
    let shares = found.shares.as_ref().ok()?;
    let loss = |(k, mechanism): (usize, &&'static str)| {
        let share = shares.share(row, k);
        LossOfPoint {
            mechanism,
            loss_w: shares.rows[row].parts[k].value,
            band_w: shares.bands[row][k],
            share: share.map(|(share, _)| share.value),
            share_band: share.and_then(|(_, band)| band),
        }
    };
    Some(shares.mechanisms.iter().enumerate().map(loss).collect())
}
