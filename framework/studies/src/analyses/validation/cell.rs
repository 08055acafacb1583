//! Ratios of calculated to measured losses in one number each: of a model at the points of a set or of a regime.

use gearloss_numerics::statistics::Statistics;
use schemars::JsonSchema;
use serde::Serialize;

use super::ValidatedPoint;

/// A model at several measured points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Cell {
    /// Number of points. [-]
    pub points: usize,
    /// Geometric mean of calculated over measured loss. [-]
    pub ratio: f64,
    /// Least ratio. [-]
    pub least: f64,
    /// Greatest ratio. [-]
    pub greatest: f64,
    /// Mean of calculated less measured loss, of the measured loss. [%]
    pub bias_percent: f64,
    /// Root mean square of the same. [%]
    pub rms_percent: f64,
    /// The one of greatest magnitude. [%]
    pub max_percent: f64,
    /// Share of points whose band contains the measurement; absent without bands. [-]
    pub in_band: Option<f64>,
    /// Share of points at which all models are inside their stated ranges. [-]
    pub in_range: f64,
    /// Standard deviation of the logarithm of `ratio` from the inputs and the accuracy of the measurement; absent without both. [-]
    pub error: Option<f64>,
    /// Standard deviation of the logarithms of the ratios of the points; absent for a single point. [-]
    pub scatter: Option<f64>,
}

/// A calculated over a measured value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// Calculated over measured. \[-\]
    pub ratio: f64,
    /// Lower and upper end of its 95 % band. \[-\]
    pub band: Option<[f64; 2]>,
    /// Whether all models are inside their stated ranges.
    pub in_range: bool,
}

impl From<&ValidatedPoint> for Ratio {
    fn from(point: &ValidatedPoint) -> Self {
        Self {
            ratio: point.ratio,
            band: point.band,
            in_range: point.in_range,
        }
    }
}

impl Cell {
    /// Of points with positive ratios, with the means of the logarithms of the ratios in samples of the inputs and of the measurement;
    /// absent without points.
    pub fn of(points: &[ValidatedPoint], sampled: &[f64]) -> Option<Self> {
        Self::of_ratios(&points.iter().map(Ratio::from).collect::<Vec<_>>(), sampled)
    }

    /// As [`Cell::of`], of ratios alone.
    pub fn of_ratios(points: &[Ratio], sampled: &[f64]) -> Option<Self> {
        let logs = Statistics::from_values(points.iter().map(|point| point.ratio.ln()))?;
        let differences: Vec<f64> = points.iter().map(|point| 100.0 * (point.ratio - 1.0)).collect();
        let of = Statistics::from_values(differences.iter().copied())?;
        let count = points.len() as f64;
        let share = |held: usize| held as f64 / count;
        let bands: Option<Vec<[f64; 2]>> = points.iter().map(|point| point.band).collect();
        let holds = |band: &&[f64; 2]| band[0] <= 1.0 && 1.0 <= band[1];
        Some(Self {
            points: points.len(),
            ratio: logs.mean.exp(),
            least: logs.least.exp(),
            greatest: logs.greatest.exp(),
            bias_percent: of.mean,
            rms_percent: of.rms,
            max_percent: if -of.least > of.greatest { of.least } else { of.greatest },
            in_band: bands.map(|bands| share(bands.iter().filter(holds).count())),
            in_range: share(points.iter().filter(|point| point.in_range).count()),
            error: deviation(sampled),
            scatter: deviation(&points.iter().map(|point| point.ratio.ln()).collect::<Vec<_>>()),
        })
    }
}

/// Standard deviation of values about their mean; absent below two.
fn deviation(values: &[f64]) -> Option<f64> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    (values.len() > 1).then(|| (squares / (count - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn point(ratio: f64, band: Option<[f64; 2]>, in_range: bool) -> ValidatedPoint {
        ValidatedPoint {
            line: String::new(),
            torque_nm: 0.0,
            speed_rpm: 0.0,
            oil_temperature_degc: None,
            measured_w: 1.0,
            loss_w: ratio,
            ratio,
            band,
            in_range,
        }
    }

    #[test]
    fn double_and_half_are_as_far_from_one() {
        let cell = Cell::of(
            &[point(2.0, Some([1.5, 3.0]), true), point(0.5, Some([0.2, 1.1]), false)],
            &[-0.1, 0.1],
        )
        .unwrap();
        assert!((cell.ratio - 1.0).abs() < 1e-12 && (cell.greatest - 2.0).abs() < 1e-12);
        assert!((cell.bias_percent - 25.0).abs() < 1e-9 && (cell.max_percent - 100.0).abs() < 1e-9);
        assert!((cell.rms_percent - 6250.0_f64.sqrt()).abs() < 1e-9);
        assert_eq!((cell.in_band, cell.in_range), (Some(0.5), 0.5));
        let near = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() < 1e-12;
        assert!(near(cell.error, 0.02_f64.sqrt()) && near(cell.scatter, 2.0_f64.sqrt() * 2.0_f64.ln()));
    }

    #[test]
    fn without_all_bands_nothing_is_inside() {
        assert_eq!(
            Cell::of(&[point(1.0, None, true), point(1.0, Some([0.5, 2.0]), true)], &[])
                .unwrap()
                .in_band,
            None
        );
        assert_eq!(Cell::of(&[], &[]), None);
        let alone = Cell::of(&[point(1.0, None, true)], &[]).unwrap();
        assert_eq!((alone.error, alone.scatter), (None, None));
    }
}
