//! Fits with robust losses: sandwich covariance.
//!
//! Source: Huber, Robust Statistics (Wiley 1981), sections 6.3 and 7.6; the factor for few points is that of least squares.

use nalgebra::DMatrix;

use super::factors::Factors;
use super::{Accuracy, Fit, Parameter, Standing};
use crate::least_squares::{FLOOR, Loss, median_spread};

/// Ratio of a pivot to the largest below which the matrix of the scatter has no inverse.
const REGULAR: f64 = 1e-12;

/// Derivatives of a loss for every row of data.
#[derive(Debug, Clone, PartialEq)]
pub struct RobustRows {
    /// Second derivative of the cost by the residual: rho' + 2 rho'' s. Negative for outliers with losses that flatten.
    curvature: Vec<f64>,
    /// The same with the floor of the search.
    kept: Vec<f64>,
    /// First derivative of the cost by the residual: rho' r.
    slope: Vec<f64>,
    /// Twice the cost.
    objective: f64,
}

impl RobustRows {
    /// From residuals and a loss with its scale.
    pub fn new(loss: Loss, scale: f64, residuals: &[f64]) -> Self {
        let mut rows = Self {
            curvature: Vec::new(),
            kept: Vec::new(),
            slope: Vec::new(),
            objective: 0.0,
        };
        for r in residuals {
            let s = (r / scale).powi(2);
            let [rho, first, second] = loss.rho(s);
            let curvature = first + 2.0 * second * s;
            rows.curvature.push(curvature);
            rows.kept.push(curvature.max(FLOOR * first));
            rows.slope.push(first * r);
            rows.objective += scale * scale * rho;
        }
        rows
    }
}

impl Fit {
    /// As [`Fit::new`], from a fit with a robust loss: the covariance is A^-1 B A^-1 m/(m - n), with A from the curvature of the rows and B
    /// from their slopes; rows of priors are not weighted. If B has no inverse, or outliers make A indefinite, the covariance is that of A
    /// alone, with the curvature of the search.
    ///
    /// The objective is twice the cost. It is not chi-square distributed, so there is neither a test of the whole fit nor a profile
    /// interval.
    ///
    /// # Errors
    /// As [`Fit::new`].
    pub fn robust(
        parameters: Vec<Parameter>,
        jacobian: &DMatrix<f64>,
        residuals: &[f64],
        priors: usize,
        (accuracy, rows): (Accuracy, &RobustRows),
    ) -> Result<Self, String> {
        let data = rows.slope.len();
        if data + priors != residuals.len() {
            return Err(format!(
                "{data} rows and {priors} priors for {} residuals",
                residuals.len()
            ));
        }
        let scaled = |factor: &dyn Fn(usize) -> f64| {
            let mut scaled = jacobian.clone();
            for (i, mut row) in scaled.row_iter_mut().enumerate().take(data) {
                row *= factor(i);
            }
            scaled
        };
        let curved = scaled(&|i| rows.kept[i].sqrt());
        let mut fit = Self::new(parameters, &curved, residuals, priors, accuracy)?;
        fit.robust = true;
        fit.variance = 1.0;
        if accuracy == Accuracy::Estimated {
            fit.scatter = median_spread(&residuals[..data]);
        }
        fit.objective = rows.objective + residuals[data..].iter().map(|r| r * r).sum::<f64>();
        for (k, gradient) in fit.gradient.iter_mut().enumerate() {
            let slope = |i: usize| rows.slope.get(i).copied().unwrap_or(residuals[i]);
            *gradient = (0..residuals.len()).map(|i| jacobian[(i, k)] * slope(i)).sum();
        }
        let free: Vec<usize> = (0..fit.parameters().len())
            .filter(|k| fit.parameters()[*k].standing == Standing::Free && fit.column(*k) > 0.0)
            .collect();
        let widening = data as f64 / (data as f64 - free.len() as f64);
        let upward = scaled(&|i| rows.curvature[i].max(0.0).sqrt());
        let mut downward = scaled(&|i| (-rows.curvature[i]).max(0.0).sqrt());
        // Rows of priors have positive curvature.
        downward.rows_mut(data, priors).fill(0.0);
        let sandwich = sandwich([&upward, &downward], &scaled(&|i| rows.slope[i]), &free);
        if let Some(root) = sandwich.filter(|_| widening > 0.0 && widening.is_finite()) {
            // A square Jacobian whose normal matrix is the inverse of the covariance.
            let mut whole = DMatrix::zeros(root.nrows(), jacobian.ncols());
            for (place, k) in free.iter().enumerate() {
                whole.set_column(*k, &(root.column(place) / widening.sqrt()));
                fit.norms[*k] = whole.column(*k).norm();
            }
            let factors = Factors::new(&whole, &free).ok_or("the covariance has no singular values")?;
            fit.take(factors);
        }
        Ok(fit)
    }
}

/// The inverse transpose of the factor of B, times A: its normal matrix is A B^-1 A. A has rows with positive and negative curvature.
/// Absent if B has no inverse or A is not positive definite.
fn sandwich([upward, downward]: [&DMatrix<f64>; 2], sloped: &DMatrix<f64>, free: &[usize]) -> Option<DMatrix<f64>> {
    if free.is_empty() || upward.nrows() < free.len() {
        return None;
    }
    let lengths: Vec<f64> = free.iter().map(|k| upward.column(*k).norm()).collect();
    let unit =
        |matrix: &DMatrix<f64>| DMatrix::from_fn(matrix.nrows(), free.len(), |i, j| matrix[(i, free[j])] / lengths[j]);
    let (up, b) = (unit(upward).qr().r(), unit(sloped).qr().r());
    let regular = |r: &DMatrix<f64>| {
        let greatest = r.diagonal().amax();
        r.diagonal().iter().all(|pivot| pivot.abs() > REGULAR * greatest)
    };
    if !regular(&up) || !regular(&b) {
        return None;
    }
    // A = up' (I - W' W) up: only the small product W' W is formed, never that of the rows.
    let w = up.transpose().solve_lower_triangular(&unit(downward).transpose())?;
    let left = DMatrix::identity(free.len(), free.len()) - &w * w.transpose();
    let a = left.cholesky()?.l().transpose() * up;
    let mut root = b.transpose().solve_lower_triangular(&a.transpose())? * a;
    for (mut column, length) in root.column_iter_mut().zip(&lengths) {
        column *= *length;
    }
    root.iter().all(|x| x.is_finite()).then_some(root)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::inference::Scale;

    fn line(residuals: &[f64], loss: Loss) -> Fit {
        let count = residuals.len();
        let jacobian = DMatrix::from_fn(count, 2, |i, k| if k == 0 { 1.0 } else { i as f64 - 3.0 });
        let parameters = ["a", "b"]
            .map(|name| Parameter::new(name, Scale::Linear, 0.0, [-100.0, 100.0]).unwrap())
            .to_vec();
        let rows = RobustRows::new(loss, 2.0, residuals);
        Fit::robust(parameters, &jacobian, residuals, 0, (Accuracy::Given, &rows)).unwrap()
    }

    #[test]
    fn the_sandwich_is_that_of_its_matrices() {
        for loss in [Loss::SoftL1, Loss::Huber, Loss::Cauchy, Loss::Arctan] {
            the_sandwich_of(loss);
        }
    }

    /// Under the last two losses the fourth row bends downward.
    fn the_sandwich_of(loss: Loss) {
        let residuals = [0.5, -1.0, 0.3, 4.0, -0.7, 1.2, -0.1];
        let fit = line(&residuals, loss);
        // The same by explicit products, two by two.
        let rows = RobustRows::new(loss, 2.0, &residuals);
        let x = |i: usize| [1.0, i as f64 - 3.0];
        let product = |weight: &dyn Fn(usize) -> f64| {
            let entry = |j: usize, k: usize| (0..7).map(|i| weight(i) * x(i)[j] * x(i)[k]).sum::<f64>();
            nalgebra::Matrix2::new(entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1))
        };
        let a = product(&|i| rows.curvature[i]).try_inverse().unwrap();
        let b = product(&|i| rows.slope[i] * rows.slope[i]);
        let covariance = a * b * a * (7.0 / 5.0);
        for (j, k) in [(0, 0), (0, 1), (1, 1)] {
            let found = fit.covariance(j, k);
            assert!(
                (found - covariance[(j, k)]).abs() < 1e-12,
                "{found} {}",
                covariance[(j, k)]
            );
        }
        assert!((fit.deviation(0).unwrap() - covariance[(0, 0)].sqrt()).abs() < 1e-12);
        assert!(fit.lack_of_fit().is_none() && fit.to_profile(0, 0.95).is_none());
        assert!((fit.objective() - rows.objective).abs() < 1e-12);
    }

    #[test]
    fn residuals_that_scatter_as_stated_give_nearly_the_usual_covariance() {
        // For the linear loss with residuals of one unit, A and B are the same but for the factor for few points.
        let residuals: Vec<f64> = (0..7).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let fit = line(&residuals, Loss::Linear);
        assert!((fit.deviation(1).unwrap().powi(2) - 7.0 / 5.0 / 28.0).abs() < 1e-12);
    }

    #[test]
    fn a_perfect_fit_falls_back_to_its_curvature() {
        let fit = line(&[0.0; 7], Loss::Cauchy);
        assert!((fit.deviation(1).unwrap().powi(2) - 1.0 / 28.0).abs() < 1e-12);
    }
}
