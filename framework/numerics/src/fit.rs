//! Fits of laws with few parameters: power laws by least squares of logarithms, other laws by least squares with their accuracy.

mod squares;

pub use squares::{Estimate, Squares};

use nalgebra::{DMatrix, DVector};

/// A power law `factor * product of (x / reference)^exponent` with its residuals.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerFit {
    /// Value at the reference.
    pub factor: f64,
    /// Geometric mean of the points, for each quantity.
    pub reference: Vec<f64>,
    /// Exponent of each quantity.
    pub exponents: Vec<f64>,
    /// Relative residual of each point: value of the law over the point, minus one.
    pub residuals: Vec<f64>,
}

impl PowerFit {
    /// Root mean square of the residuals.
    pub fn rms(&self) -> f64 {
        let squares: f64 = self.residuals.iter().map(|r| r * r).sum();
        (squares / self.residuals.len() as f64).sqrt()
    }

    /// The residual with the largest magnitude.
    pub fn worst(&self) -> f64 {
        let farther = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
        self.residuals.iter().fold(0.0, farther)
    }

    /// Value at a point.
    pub fn value(&self, x: &[f64]) -> f64 {
        let powers = x.iter().zip(&self.reference).zip(&self.exponents);
        powers.fold(self.factor, |value, ((x, reference), exponent)| {
            value * (x / reference).powf(*exponent)
        })
    }
}

/// Fits a power law to points with positive coordinates and values.
///
/// # Errors
/// If a number is not positive, or the points do not identify the exponents.
pub fn power_law(points: &[(Vec<f64>, f64)]) -> Result<PowerFit, String> {
    let width = points.first().map_or(0, |(x, _)| x.len());
    if points.len() <= width {
        return Err(format!("{} points for {} coefficients", points.len(), width + 1));
    }
    for (i, (x, y)) in points.iter().enumerate() {
        if let Some(bad) = x.iter().chain([y]).find(|v| !(v.is_finite() && **v > 0.0)) {
            return Err(format!("point {}: {bad} has no logarithm", i + 1));
        }
    }
    let count = points.len() as f64;
    let mean = |f: &dyn Fn(&(Vec<f64>, f64)) -> f64| points.iter().map(f).sum::<f64>() / count;
    let centre: Vec<f64> = (0..width).map(|k| mean(&|p| p.0[k].ln())).collect();
    let level = mean(&|p| p.1.ln());
    let logs = DMatrix::from_fn(points.len(), width, |i, k| points[i].0[k].ln() - centre[k]);
    let answers = DVector::from_fn(points.len(), |i, _| points[i].1.ln() - level);
    let svd = logs.svd(true, true);
    let largest = svd.singular_values.iter().copied().fold(0.0, f64::max);
    if width > 0 && svd.singular_values.iter().any(|s| *s <= 1e-9 * largest.max(1e-300)) {
        return Err(
            "the points do not identify the exponents: a quantity is constant, or changes only with another".to_owned(),
        );
    }
    let exponents = svd.solve(&answers, 0.0).map_err(str::to_owned)?;
    let mut fit = PowerFit {
        factor: level.exp(),
        reference: centre.iter().map(|c| c.exp()).collect(),
        exponents: exponents.iter().copied().collect(),
        residuals: Vec::new(),
    };
    fit.residuals = points.iter().map(|(x, y)| fit.value(x) / y - 1.0).collect();
    Ok(fit)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn what_no_law_can_tell_is_refused() {
        let point = |x: f64, y: f64| (vec![x, y], 1.0 + x);
        assert!(
            power_law(&[point(1.0, 2.0), point(2.0, 4.0), point(4.0, 8.0)])
                .unwrap_err()
                .contains("do not identify")
        );
        assert!(
            power_law(&[point(1.0, 2.0), point(2.0, 2.0), point(4.0, 2.0)])
                .unwrap_err()
                .contains("do not identify")
        );
        assert!(
            power_law(&[point(1.0, 2.0), point(2.0, 3.0)])
                .unwrap_err()
                .contains("2 points for 3")
        );
        assert!(
            power_law(&[(vec![0.0], 1.0), (vec![1.0], 1.0)])
                .unwrap_err()
                .contains("no logarithm")
        );
    }

    proptest! {
        #[test]
        fn a_power_law_is_found_again(c in 0.01..10.0_f64, a in -3.0..3.0_f64, b in -3.0..3.0_f64) {
            let points: Vec<(Vec<f64>, f64)> = [100.0, 300.0, 3000.0]
                .iter()
                .flat_map(|n| [5.0, 50.0, 400.0].map(|nu| (vec![*n, nu], c * (n / 500.0_f64).powf(a) * nu.powf(b))))
                .collect();
            let fit = power_law(&points).unwrap();
            prop_assert!((fit.exponents[0] - a).abs() < 1e-10 && (fit.exponents[1] - b).abs() < 1e-10);
            prop_assert!(fit.worst().abs() < 1e-9 && fit.rms() <= fit.worst().abs() + 1e-300);
        }
    }
}
