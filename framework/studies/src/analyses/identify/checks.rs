//! Checks of residuals: whether the model reproduces the points within their accuracy, and whether neighbouring errors are correlated.

use gearloss_numerics::inference::{
    AndersonDarling, BandMean, LackOfFit, PureError, Succession, Widening, anderson_darling, band_means, pure_error,
    succession,
};

use super::lines::{Sheet, of_residuals};
use crate::identify::{Fitted, Identification, Observation};
use crate::measured::Measured;
use crate::numbers::RPM;

/// Probability of a test below which it is reported.
const SUSPECT: f64 = 0.01;

/// Ratio of mean squares above which repeated points are considered copies.
const MOST: f64 = 1e6;

/// Diagnostics of the residuals of a fit.
#[derive(Debug, Clone)]
pub struct Checks {
    /// Consistency of the scatter with the stated accuracy.
    pub lack: Option<LackOfFit>,
    /// The scatter of repeated points compared with the remaining residuals.
    pub pure: Option<PureError>,
    /// Whether the residuals of the points are normally distributed.
    pub normality: Option<AndersonDarling>,
    /// Correlation of residuals along lines of neighbouring points.
    pub succession: Option<Succession>,
    /// Mean standardised residuals over torque in Nm.
    pub over_torque: Vec<BandMean>,
    /// The same over speed in rpm.
    pub over_speed: Vec<BandMean>,
    /// Standardised residuals of the points.
    pub standardised: Vec<f64>,
    /// Indices of outliers.
    pub outliers: Vec<usize>,
    /// Indices of points with a leverage above one half.
    pub weighty: Vec<usize>,
}

impl Checks {
    pub(super) fn new(identification: &Identification<'_>, fitted: &Fitted, sheets: &[Sheet]) -> Self {
        let inference = &fitted.inference;
        let measured = identification.measured();
        let observations = identification.observations();
        // Those of the means follow, in which zeros of ranges are no sample of a normal distribution.
        let standardised = inference.standardised()[..observations.len()].to_vec();
        let of_points = |list: Vec<usize>| list.into_iter().filter(|i| *i < observations.len()).collect();
        let over = |quantity: &str, factor: f64| -> Vec<BandMean> {
            let value = |o: &Observation| factor * measured.value(&measured.rows[o.row], quantity).unwrap_or(0.0);
            let at: Vec<f64> = observations.iter().map(value).collect();
            band_means(&standardised, &at).unwrap_or_default()
        };
        Self {
            // Factors of the accuracies are chosen to match the sum.
            lack: inference.lack_of_fit().filter(|_| fitted.factors.is_empty()),
            pure: pure_error(inference, &repeated(identification)).filter(|_| !inference.is_robust()),
            normality: anderson_darling(&standardised),
            succession: succession(&standardised, &of_residuals(identification, sheets)),
            over_torque: over("torque", 1.0),
            over_speed: over("speed", RPM),
            outliers: of_points(inference.outliers()),
            weighty: of_points(inference.weighty()),
            standardised,
        }
    }

    /// Factors by which intervals and bands are too small if the model does not reproduce the points or neighbouring errors are correlated.
    pub fn widening(&self) -> Widening {
        Widening::from_checks(self.lack.as_ref(), self.succession.as_ref())
    }

    /// The notes as sentences.
    pub fn words(&self, measured: &Measured, observations: &[Observation]) -> Vec<String> {
        let line = |place: &usize| measured.line(&measured.rows[observations[*place].row]);
        let list = |places: &[usize]| {
            let shown: Vec<String> = places.iter().take(8).map(line).collect();
            let more = if places.len() > 8 { ", ..." } else { "" };
            let noun = if places.len() == 1 { "line" } else { "lines" };
            format!("{noun} {}{more}", shown.join(", "))
        };
        let mut words: Vec<String> = self.lack.and_then(|lack| lack.words()).into_iter().collect();
        let pure = self.pure.filter(|pure| pure.probability < SUSPECT && pure.ratio < MOST);
        if let Some(pure) = pure {
            words.push(format!(
                "the scatter of repeated points is {:.2} times smaller than the remaining residuals: the model is wrong, not the rig",
                pure.ratio.sqrt()
            ));
        }
        words.extend(self.succession.and_then(|s| {
            let words = s.words()?;
            let widening = s.widening();
            Some(if widening > 1.0 {
                format!("{words}; intervals are too small by about {widening:.2}")
            } else {
                words
            })
        }));
        if let Some(test) = self.normality.filter(|test| test.probability < SUSPECT) {
            words.push(format!(
                "the residuals are not normally distributed (Anderson-Darling, p = {:.1e})",
                test.probability
            ));
        }
        for (means, unit) in [(&self.over_torque, "Nm"), (&self.over_speed, "rpm")] {
            let far = means.iter().filter(|band| band.mean.abs() > 1.5 * band.limit);
            if let Some(worst) = far.max_by(|a, b| (a.mean / a.limit).abs().total_cmp(&(b.mean / b.limit).abs())) {
                let side = if worst.mean > 0.0 { "over" } else { "under" };
                let [from, to] = worst.band;
                let place = if to - from < 0.005 * to.abs() {
                    format!("at {to:.0}")
                } else {
                    format!("from {from:.0} to {to:.0}")
                };
                words.push(format!(
                    "{place} {unit} the model {side}predicts: {:.2} standard deviations on average, expected scatter +-{:.2}",
                    worst.mean.abs(),
                    worst.limit
                ));
            }
        }
        if !self.outliers.is_empty() {
            words.push(format!(
                "{} more than 3.5 standard deviations away: {}",
                if self.outliers.len() == 1 {
                    "one point is".to_owned()
                } else {
                    format!("{} points are", self.outliers.len())
                },
                list(&self.outliers)
            ));
        }
        if !self.weighty.is_empty() {
            words.push(format!(
                "points with a leverage above one half: {}",
                list(&self.weighty)
            ));
        }
        words
    }
}

/// Indices of residuals at the same settings.
fn repeated(identification: &Identification<'_>) -> Vec<Vec<usize>> {
    let measured = identification.measured();
    let observations = identification.observations();
    let mut groups: std::collections::BTreeMap<String, Vec<usize>> = std::collections::BTreeMap::new();
    for (place, o) in observations.iter().enumerate() {
        let row = &measured.rows[o.row];
        let value = |name: &str| {
            measured
                .value(row, name)
                .map_or_else(String::new, |x| format!("{x:.4e}"))
        };
        // The accuracy is part of the settings: points with different accuracies are not repetitions.
        let key = format!(
            "{:?} {:?} {:?} {} {} {} {:.4e}",
            o.quantity,
            row.gear,
            row.bound,
            value("torque"),
            value("speed"),
            value("oil_temperature"),
            o.deviation
        );
        groups.entry(key).or_default().push(place);
    }
    groups.into_values().filter(|group| group.len() > 1).collect()
}
