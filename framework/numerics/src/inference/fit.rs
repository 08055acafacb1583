//! A fit at its optimum, linearised: covariance, correlations, singular values.
//!
//! Sources: Björck: Numerical Methods for Least Squares Problems (SIAM 1996), sections 2.8 and 1.4; Seber, Wild: Nonlinear
//! Regression (Wiley 1989), chapters 2 and 5.

use nalgebra::DMatrix;

use super::factors::Factors;
use super::{Parameter, Standing};

/// Part of a gradient in unresolved directions above which a quantity is not identifiable.
const UNRESOLVED: f64 = 0.1;

/// Origin of the standard uncertainties of the points. It is chosen before the fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accuracy {
    /// Given by the instruments: residuals are in units of their standard uncertainty.
    Given,
    /// Unknown: residuals are in any common unit, and their scatter is used.
    Estimated,
}

/// A fit, linearised at its optimum. Parameters are represented by their coordinate u.
///
/// Functions of one parameter take its index and panic if it is out of bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    parameters: Vec<Parameter>,
    accuracy: Accuracy,
    pub(super) factors: Factors,
    /// One row for each parameter, zero if it has no variance; its product with its transpose and the variance is the covariance.
    root: DMatrix<f64>,
    /// Lengths of all columns, and gradient of half the sum of squares.
    pub(super) norms: Vec<f64>,
    pub(super) gradient: Vec<f64>,
    residuals: Vec<f64>,
    leverage: Vec<f64>,
    priors: usize,
    pub(super) objective: f64,
    pub(super) variance: f64,
    /// Standard deviation of a residual.
    pub(super) scatter: f64,
    /// Whether the loss is robust: the objective is then not chi-square distributed.
    pub(super) robust: bool,
}

impl Fit {
    /// From a central Jacobian dr/du, one column for each parameter, and the residuals (calculated minus measured, over the standard
    /// uncertainty). The last rows of both may belong to priors.
    ///
    /// # Errors
    /// If the dimensions do not match, numbers are not finite, or the accuracy is to be estimated without more rows than parameters.
    pub fn new(
        parameters: Vec<Parameter>,
        jacobian: &DMatrix<f64>,
        residuals: &[f64],
        priors: usize,
        accuracy: Accuracy,
    ) -> Result<Self, String> {
        let rows = residuals.len();
        if jacobian.shape() != (rows, parameters.len()) || priors > rows {
            return Err(format!(
                "a Jacobian of {} rows and {} columns for {rows} residuals, {priors} of them priors, and {} parameters",
                jacobian.nrows(),
                jacobian.ncols(),
                parameters.len()
            ));
        }
        let norms: Vec<f64> = jacobian.column_iter().map(|c| c.norm()).collect();
        for (parameter, norm) in parameters.iter().zip(&norms) {
            // Columns whose squares overflow are rejected like columns with NaN.
            if !norm.is_finite() || !parameter.u.is_finite() || parameter.bounds.iter().any(|b| b.is_nan()) {
                return Err(format!(
                    "the derivative or coordinate of {} is not finite",
                    parameter.name
                ));
            }
        }
        let objective: f64 = residuals.iter().map(|r| r * r).sum();
        let gradient: Vec<f64> = jacobian
            .column_iter()
            .map(|c| c.iter().zip(residuals).map(|(j, r)| j * r).sum())
            .collect();
        if !objective.is_finite() || gradient.iter().any(|g| !g.is_finite()) {
            return Err("the residuals are not finite".to_owned());
        }
        let free: Vec<usize> = (0..parameters.len())
            .filter(|j| parameters[*j].standing == Standing::Free)
            .collect();
        let factors = Factors::new(jacobian, &free).ok_or("the Jacobian has no singular values")?;
        let freedom = rows as f64 - factors.resolved as f64;
        let variance = match accuracy {
            Accuracy::Given => 1.0,
            Accuracy::Estimated if freedom > 0.0 => objective / freedom,
            Accuracy::Estimated => {
                return Err(format!(
                    "{rows} points for {} parameters do not allow an estimate of the accuracy",
                    free.len()
                ));
            }
        };
        let mut leverage = factors.leverage(jacobian);
        leverage.truncate(rows - priors);
        let mut fit = Self {
            accuracy,
            root: DMatrix::zeros(0, 0),
            robust: false,
            scatter: variance.sqrt(),
            norms,
            gradient,
            residuals: residuals[..rows - priors].to_vec(),
            leverage,
            priors,
            objective,
            variance,
            factors: factors.clone(),
            parameters,
        };
        fit.take(factors);
        Ok(fit)
    }

    /// Sets the covariance from singular values.
    pub(super) fn take(&mut self, factors: Factors) {
        let mut root = DMatrix::zeros(self.parameters.len(), factors.resolved);
        for (j, row) in factors.columns.iter().zip(factors.root().row_iter()) {
            root.row_mut(*j).copy_from(&row);
        }
        (self.root, self.factors) = (root, factors);
    }

    /// The parameters.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Origin of the uncertainties of the points.
    pub fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    /// Whether the loss is robust.
    pub fn is_robust(&self) -> bool {
        self.robust
    }

    /// Residuals of the points, without those of priors.
    pub fn residuals(&self) -> &[f64] {
        &self.residuals
    }

    /// Leverage of each point, from zero to one.
    pub fn leverage(&self) -> &[f64] {
        &self.leverage
    }

    /// Sum of the squared residuals of the points, without those of priors.
    pub fn chi_square(&self) -> f64 {
        self.residuals.iter().map(|r| r * r).sum()
    }

    /// Sum of the squared residuals of points and priors.
    pub fn objective(&self) -> f64 {
        self.objective
    }

    /// Degrees of freedom of the objective: points and priors minus resolved directions. It may be negative.
    pub fn freedom(&self) -> f64 {
        (self.residuals.len() + self.priors) as f64 - self.factors.resolved as f64
    }

    /// Standard deviation of a residual: one if the accuracies are given, otherwise estimated; with a robust loss by the median.
    pub fn scatter(&self) -> f64 {
        self.scatter
    }

    /// Variance by which the covariance is scaled: one if the accuracies are given, otherwise estimated.
    pub fn variance(&self) -> f64 {
        self.variance
    }

    /// Derivative of half the objective by the coordinate of a parameter.
    pub fn gradient(&self, parameter: usize) -> f64 {
        self.gradient[parameter]
    }

    /// Length of the column of a parameter: 1/length is its conditional standard deviation for unit variance.
    pub fn column(&self, parameter: usize) -> f64 {
        self.norms[parameter]
    }

    /// Entry of the root of the covariance for unit variance.
    pub(super) fn root_entry(&self, parameter: usize, direction: usize) -> f64 {
        self.root[(parameter, direction)]
    }

    /// Covariance of two coordinates; zero if one is not free. For parameters that are not identifiable it includes the resolved directions
    /// only.
    pub fn covariance(&self, j: usize, k: usize) -> f64 {
        self.variance * self.root.row(j).dot(&self.root.row(k))
    }

    /// Standard deviation of a coordinate; absent for parameters that are fixed, at an active bound, or not identifiable.
    pub fn deviation(&self, parameter: usize) -> Option<f64> {
        if self.parameters[parameter].standing != Standing::Free {
            return None;
        }
        let mut gradient = vec![0.0; self.parameters.len()];
        gradient[parameter] = 1.0;
        self.deviation_along(&gradient)
    }

    /// Correlation of two coordinates; absent if one of them has no standard deviation.
    pub fn correlation(&self, j: usize, k: usize) -> Option<f64> {
        let product = self.deviation(j)? * self.deviation(k)?;
        (product > 0.0).then(|| {
            if j == k {
                1.0
            } else {
                (self.covariance(j, k) / product).clamp(-1.0, 1.0)
            }
        })
    }

    /// Standard deviation of a quantity from its gradient over the coordinates; absent if it is not identifiable. It is conditional on
    /// parameters that are fixed or at an active bound.
    ///
    /// A quantity is not identifiable if more than a tenth of its gradient, in units of columns of unit length, is in unresolved
    /// directions, or if it depends on a parameter without effect on the residuals.
    pub fn deviation_along(&self, gradient: &[f64]) -> Option<f64> {
        let unseen = |j: usize| self.norms[j] == 0.0 && self.parameters[j].standing == Standing::Free;
        if gradient.len() != self.parameters.len() || (0..gradient.len()).any(|j| unseen(j) && gradient[j] != 0.0) {
            return None;
        }
        let factors = &self.factors;
        let scaled: Vec<f64> = factors
            .columns
            .iter()
            .zip(&factors.norms)
            .map(|(j, d)| gradient[*j] / d)
            .collect();
        let length: f64 = scaled.iter().map(|g| g * g).sum();
        let along = |k: usize| -> f64 {
            scaled
                .iter()
                .enumerate()
                .map(|(i, g)| factors.directions[(i, k)] * g)
                .sum()
        };
        let lost: f64 = (factors.resolved..factors.singular.len())
            .map(|k| along(k).powi(2))
            .sum();
        if lost > UNRESOLVED * UNRESOLVED * length {
            return None;
        }
        let variance: f64 = (0..factors.resolved)
            .map(|k| (along(k) / factors.singular[k]).powi(2))
            .sum();
        Some((self.variance * variance).sqrt()).filter(|d| d.is_finite())
    }

    /// Singular values of the columns scaled to unit length, in descending order: a measure of collinearity. Those below 1e-9 of the
    /// largest are not resolved.
    pub fn singular_values(&self) -> &[f64] {
        &self.factors.singular
    }

    /// Directions of the singular values over the parameters, zero for those that are not free; entries refer to columns of unit length.
    pub fn direction(&self, place: usize) -> Vec<f64> {
        let mut direction = vec![0.0; self.parameters.len()];
        for (i, j) in self.factors.columns.iter().enumerate() {
            direction[*j] = self.factors.directions[(i, place)];
        }
        direction
    }

    /// Condition number: largest over smallest singular value of unit columns. Above 30 collinearity should be checked, above 1000 it is
    /// reported. Absent if the smallest is zero.
    pub fn condition(&self) -> Option<f64> {
        let values = self.singular_values();
        let condition = values.first()? / values.last()?;
        condition.is_finite().then_some(condition)
    }

    /// Whether there are directions that the data do not resolve: such a fit is not successful.
    pub fn is_singular(&self) -> bool {
        let free = self.parameters.iter().filter(|p| p.standing == Standing::Free).count();
        self.factors.resolved < free
    }

    /// Singular values of the columns times the ranges of the parameters, over the standard deviation of a residual, in descending order.
    /// Along a direction of value s the half-width of the 95 % interval is 1.96/s of the range.
    pub fn ranged_singular_values(&self) -> Vec<f64> {
        self.scaled_singular_values(Parameter::range)
    }

    /// The same with the sizes of the parameters, [`Parameter::own_size`], instead of their ranges: the number of values above four is the
    /// number of identifiable combinations, independent of the bounds.
    pub fn sized_singular_values(&self) -> Vec<f64> {
        self.scaled_singular_values(Parameter::own_size)
    }

    fn scaled_singular_values(&self, size: impl Fn(&Parameter) -> f64) -> Vec<f64> {
        let factors = &self.factors;
        let noise = self.variance.sqrt().max(f64::MIN_POSITIVE);
        let length = |(j, norm): (&usize, &f64)| norm * size(&self.parameters[*j]) / noise;
        let lengths: Vec<f64> = factors.columns.iter().zip(&factors.norms).map(length).collect();
        factors.scaled(&lengths).unwrap_or_default()
    }
}
