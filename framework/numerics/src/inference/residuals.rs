//! Diagnostics of residuals: outliers, points with high leverage, correlated neighbours.
//!
//! Sources: Belsley, Kuh, Welsch: Regression Diagnostics (Wiley 1980), chapter 2; Durbin, Watson, Biometrika 37 (1950) 409-428;
//! Wald, Wolfowitz, Ann. Math. Statist. 11 (1940) 147-162.

use super::Fit;
use crate::statistics::bands;

/// Standardised residual above which a point is listed.
const OUTLIER: f64 = 3.5;
/// Leverage above which a point is listed.
const WEIGHTY: f64 = 0.5;
/// Standard deviations of the number of runs above which neighbours are considered correlated or anticorrelated.
const RUNS: f64 = 2.58;
/// 1 - leverage below which a point is fitted exactly independent of its value.
const MET: f64 = 1e-12;

impl Fit {
    /// Residuals over their own standard deviation, which is smaller for points with high leverage; zero for points that are always fitted
    /// exactly.
    pub fn standardised(&self) -> Vec<f64> {
        let of = |(r, h): (&f64, &f64)| {
            let variance = self.scatter().powi(2) * (1.0 - h);
            if variance > MET * self.scatter().powi(2) {
                r / variance.sqrt()
            } else {
                0.0
            }
        };
        self.residuals().iter().zip(self.leverage()).map(of).collect()
    }

    /// Indices of points whose standardised residual is above 3.5.
    pub fn outliers(&self) -> Vec<usize> {
        let list = self.standardised();
        (0..list.len()).filter(|i| list[*i].abs() > OUTLIER).collect()
    }

    /// Indices of points whose leverage is above one half.
    pub fn weighty(&self) -> Vec<usize> {
        let list = self.leverage();
        (0..list.len()).filter(|i| list[*i] > WEIGHTY).collect()
    }
}

/// Correlation of residuals along lines of neighbouring points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Succession {
    /// Sum of the squared differences of neighbours over the sum of squares: about 2 - 2 rho.
    pub durbin_watson: f64,
    /// Correlation of neighbours, rho.
    pub correlation: f64,
    /// Runs of one sign.
    pub runs: usize,
    /// Expected number for independent signs.
    pub expected: f64,
    /// Difference of the two over its standard deviation; absent if all signs of each line are equal.
    pub score: Option<f64>,
    /// Number of points in the lines.
    pub points: usize,
}

impl Succession {
    /// Whether the number of runs differs significantly from its expected value.
    pub fn is_suspect(&self) -> bool {
        self.score.is_some_and(|z| z.abs() > RUNS)
    }

    /// Effective number of independent points.
    pub fn effective_points(&self) -> f64 {
        self.points as f64 * (1.0 - self.correlation) / (1.0 + self.correlation)
    }

    /// Factor on standard deviations of parameters for correlated neighbours.
    pub fn widening(&self) -> f64 {
        ((1.0 + self.correlation) / (1.0 - self.correlation)).sqrt()
    }

    /// A note; absent if the signs are random.
    pub fn words(&self) -> Option<String> {
        let score = self.score.filter(|_| self.is_suspect())?;
        Some(if score < 0.0 {
            format!(
                "errors of neighbouring points are correlated: the model has a wrong shape; effective points {:.0}",
                self.effective_points()
            )
        } else {
            "errors of neighbouring points alternate along the lines".to_owned()
        })
    }
}

/// Checks lines of points: for each line the indices of its points in order, for example of one torque and temperature by speed. Absent if
/// no line has two points, or all residuals are zero.
pub fn succession(residuals: &[f64], lines: &[Vec<usize>]) -> Option<Succession> {
    let [mut squares, mut steps, mut products] = [0.0; 3];
    let [mut expected, mut variance] = [0.0; 2];
    let (mut runs, mut points, mut pairs) = (0, 0, 0);
    for line in lines {
        let r = line
            .iter()
            .map(|i| residuals.get(*i).copied())
            .collect::<Option<Vec<f64>>>()?;
        if r.is_empty() {
            continue;
        }
        squares += r.iter().map(|r| r * r).sum::<f64>();
        steps += r.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum::<f64>();
        products += r.windows(2).map(|w| w[0] * w[1]).sum::<f64>();
        runs += 1 + r.windows(2).filter(|w| (w[0] < 0.0) != (w[1] < 0.0)).count();
        points += r.len();
        pairs += r.len() - 1;
        let count = r.len() as f64;
        let below = r.iter().filter(|r| **r < 0.0).count() as f64;
        let both = 2.0 * below * (count - below);
        expected += 1.0 + both / count;
        variance += both * (both - count) / (count * count * (count - 1.0).max(1.0));
    }
    let correlation = products / squares;
    (pairs > 0 && correlation.is_finite()).then(|| Succession {
        durbin_watson: steps / squares,
        correlation,
        runs,
        expected,
        score: (variance > 0.0).then(|| (runs as f64 - expected) / variance.sqrt()),
        points,
    })
}

/// Mean residual in a band of a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandMean {
    /// Lower and upper end of the band.
    pub band: [f64; 2],
    /// Number of points in it.
    pub count: usize,
    /// Mean of their residuals.
    pub mean: f64,
    /// Twice the standard deviation of such a mean if the model is correct, for residuals in units of their uncertainty.
    pub limit: f64,
}

/// Mean residuals over bands of torque, speed or another coordinate; absent if the numbers of residuals and coordinates differ.
pub fn band_means(residuals: &[f64], coordinates: &[f64]) -> Option<Vec<BandMean>> {
    (residuals.len() == coordinates.len()).then_some(())?;
    let of = |(band, group): ([f64; 2], Vec<usize>)| {
        let count = group.len() as f64;
        BandMean {
            band,
            count: group.len(),
            mean: group.iter().map(|i| residuals[*i]).sum::<f64>() / count,
            limit: 2.0 / count.sqrt(),
        }
    };
    Some(bands(coordinates).into_iter().map(of).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn waves_and_zigzags_are_distinguished_from_chance() {
        let line = vec![(0..40).collect::<Vec<usize>>()];
        let wave: Vec<f64> = (0..40).map(|i| (f64::from(i) * 0.3).sin()).collect();
        let found = succession(&wave, &line).unwrap();
        assert!(found.is_suspect() && found.durbin_watson < 0.2 && found.widening() > 3.0);
        assert!(found.words().unwrap().contains("are correlated") && found.effective_points() < 4.0);
        let saw: Vec<f64> = (0..40).map(|i| f64::from(i % 2) - 0.5).collect();
        let found = succession(&saw, &line).unwrap();
        assert!(found.durbin_watson > 3.8 && found.words().unwrap().contains("alternate"));
        assert_eq!((found.runs, found.expected), (40, 21.0));
    }

    #[test]
    fn lines_are_not_joined() {
        let lines = vec![vec![0, 1], vec![2, 3], vec![]];
        let found = succession(&[1.0, 1.0, -1.0, -1.0], &lines).unwrap();
        assert_eq!((found.durbin_watson, found.runs, found.score), (0.0, 2, None));
        assert!(found.words().is_none());
    }

    #[test]
    fn residuals_without_neighbours_have_no_succession() {
        assert_eq!(succession(&[1.0, 2.0], &[vec![0], vec![1]]), None);
        assert_eq!(succession(&[0.0, 0.0], &[vec![0, 1]]), None);
        assert_eq!(succession(&[1.0], &[vec![0, 1]]), None);
        assert_eq!(band_means(&[1.0], &[]), None);
        let means = band_means(&[1.0, 3.0, 5.0, 5.0], &[10.0, 10.0, 20.0, 20.0]).unwrap();
        assert_eq!(means.iter().map(|b| b.mean).collect::<Vec<_>>(), [2.0, 5.0]);
        assert!((means[0].limit - 2.0_f64.sqrt()).abs() < 1e-15);
    }
}
