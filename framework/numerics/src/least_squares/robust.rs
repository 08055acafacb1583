//! Robust losses.

use nalgebra::{DMatrix, DVector};

/// Loss as a function of s = (r/c)^2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loss {
    /// s: least squares.
    Linear,
    /// 2 (sqrt(1 + s) - 1).
    SoftL1,
    /// s up to 1, 2 sqrt(s) - 1 above.
    Huber,
    /// ln(1 + s).
    Cauchy,
    /// atan(s).
    Arctan,
}

/// Minimum share of the curvature of a row: without it steps with cauchy and arctan are erratic.
pub(crate) const FLOOR: f64 = 0.1;

impl Loss {
    /// Name in documents and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::SoftL1 => "soft_l1",
            Self::Huber => "huber",
            Self::Cauchy => "cauchy",
            Self::Arctan => "arctan",
        }
    }

    /// rho, its first and its second derivative at s >= 0. \[-\]
    pub fn rho(self, s: f64) -> [f64; 3] {
        match self {
            Self::SoftL1 => {
                let root = (1.0 + s).sqrt();
                // Not 2 (root - 1), which loses digits near zero.
                [2.0 * s / (root + 1.0), 1.0 / root, -0.5 / (root * (1.0 + s))]
            }
            Self::Huber if s > 1.0 => {
                let root = s.sqrt();
                [2.0 * root - 1.0, 1.0 / root, -0.5 / (root * s)]
            }
            Self::Linear | Self::Huber => [s, 1.0, 0.0],
            Self::Cauchy => {
                let first = 1.0 / (1.0 + s);
                [s.ln_1p(), first, -first * first]
            }
            Self::Arctan => {
                let first = 1.0 / (1.0 + s * s);
                [s.atan(), first, -2.0 * s * first * first]
            }
        }
    }
}

/// A loss with its scale, over rows of data and of priors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Robust {
    pub loss: Loss,
    /// Scale of the loss.
    pub scale: f64,
    /// Number of rows of data; the rows of priors after them have the linear loss.
    pub rows: usize,
}

/// Rows for Gauss-Newton: factors of the rows of the Jacobian, and residuals. The gradient is exact.
pub(super) struct Weighted {
    pub factors: Option<DVector<f64>>,
    pub residual: DVector<f64>,
}

impl Robust {
    /// The cost F.
    pub fn cost(&self, r: &DVector<f64>) -> f64 {
        let square = |i: usize, r: f64| match self.loss {
            Loss::Linear => r * r,
            _ if i >= self.rows => r * r,
            loss => self.scale * self.scale * loss.rho((r / self.scale).powi(2))[0],
        };
        0.5 * r.iter().enumerate().map(|(i, r)| square(i, *r)).sum::<f64>()
    }

    /// Decrease of the cost from one residual to another.
    pub fn fall(&self, from: &DVector<f64>, to: &DVector<f64>) -> f64 {
        match self.loss {
            // The product form of the difference of squares avoids cancellation.
            Loss::Linear => 0.5 * from.iter().zip(to).map(|(a, b)| (a - b) * (a + b)).sum::<f64>(),
            _ => self.cost(from) - self.cost(to),
        }
    }

    /// Derivative of the cost by each row.
    pub fn slope(&self, r: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(r.len(), |i, _| match self.loss {
            Loss::Linear => r[i],
            _ if i >= self.rows => r[i],
            loss => loss.rho((r[i] / self.scale).powi(2))[1] * r[i],
        })
    }

    /// Rows for Gauss-Newton, after Triggs et al., "Bundle Adjustment: A Modern Synthesis" (2000), section 4.3.
    pub fn weighted(&self, r: &DVector<f64>) -> Weighted {
        if self.loss == Loss::Linear {
            return Weighted {
                factors: None,
                residual: r.clone(),
            };
        }
        let (mut factors, mut residual) = (DVector::from_element(r.len(), 1.0), r.clone());
        for i in 0..self.rows {
            let s = (r[i] / self.scale).powi(2);
            let [_, first, second] = self.loss.rho(s);
            let root = (first + 2.0 * second * s).max(FLOOR * first).sqrt();
            factors[i] = root;
            // So far out that the weight of the row is zero.
            residual[i] = if root > 0.0 { first * r[i] / root } else { 0.0 };
        }
        Weighted {
            factors: Some(factors),
            residual,
        }
    }

    /// Standard deviation of rows of data, [`median_spread`].
    pub fn spread(&self, r: &DVector<f64>) -> f64 {
        median_spread(&r.as_slice()[..self.rows])
    }
}

/// Standard deviation of residuals from the median absolute deviation; 1 if most are equal.
pub(crate) fn median_spread(residuals: &[f64]) -> f64 {
    let middle = median(residuals.to_vec());
    let spread = 1.4826 * median(residuals.iter().map(|r| (r - middle).abs()).collect());
    if spread > 0.0 { spread } else { 1.0 }
}

impl Weighted {
    /// A Jacobian with scaled rows.
    pub fn rows(&self, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
        let mut scaled = jacobian.clone();
        if let Some(factors) = &self.factors {
            for mut column in scaled.column_iter_mut() {
                column.component_mul_assign(factors);
            }
        }
        scaled
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_1_losses_and_their_derivatives() {
        for loss in [Loss::Linear, Loss::SoftL1, Loss::Huber, Loss::Cauchy, Loss::Arctan] {
            assert_eq!(loss.rho(0.0)[0], 0.0);
            for s in [1e-3, 0.5, 0.99, 1.5, 40.0] {
                let h = 1e-5 * s;
                let [_, first, second] = loss.rho(s);
                let slope = (loss.rho(s + h)[0] - loss.rho(s - h)[0]) / (2.0 * h);
                let bend = (loss.rho(s + h)[1] - loss.rho(s - h)[1]) / (2.0 * h);
                assert!((first - slope).abs() < 1e-8, "{loss:?} at {s}: {first} {slope}");
                assert!((second - bend).abs() < 1e-8, "{loss:?} at {s}: {second} {bend}");
            }
        }
        assert!((Loss::SoftL1.rho(1e-20)[0] - 1e-20).abs() < 1e-35);
    }

    #[test]
    fn check_1_the_gradient_of_weighted_rows_is_exact() {
        let r = DVector::from_vec(vec![0.1, -3.0, 2e140, 5.0]);
        for loss in [Loss::SoftL1, Loss::Huber, Loss::Cauchy, Loss::Arctan] {
            let robust = Robust {
                loss,
                scale: 2.0,
                rows: 3,
            };
            let (weighted, slope) = (robust.weighted(&r), robust.slope(&r));
            let factors = weighted.factors.as_ref().map_or(&r, |f| f);
            for i in [0, 1, 3] {
                assert!((factors[i] * weighted.residual[i] - slope[i]).abs() < 1e-12);
            }
            assert!(weighted.residual.iter().all(|r| r.is_finite()));
            assert_eq!((factors[3], weighted.residual[3]), (1.0, 5.0));
        }
    }
}
