//! Derivatives by differences that never leave the bounds.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::evaluate::{Evaluator, Miss};

/// Distance of the values that tell the noise, in usual sizes.
const SPACING: f64 = 1e-6;

/// Why there is no Jacobian.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum NoDerivative {
    /// A parameter beside which the residuals have no value, and why.
    NotFinite(String),
    /// The user has had enough.
    Interrupted,
}

/// Differences of a residual function with a relative noise.
#[derive(Clone, Copy)]
pub(super) struct Differences<'a> {
    pub evaluator: &'a Evaluator<'a>,
    pub noise: f64,
    pub central: bool,
}

/// Why one difference has no value.
enum Gap {
    Undefined(String),
    Interrupted,
}

impl From<Miss> for Gap {
    fn from(miss: Miss) -> Self {
        match miss {
            Miss::Undefined(message) => Self::Undefined(message),
            Miss::Interrupted => Self::Interrupted,
        }
    }
}

impl Differences<'_> {
    /// The Jacobian at a point with its residual, all columns at the same time.
    pub fn jacobian(&self, u: &[f64], r: &DVector<f64>) -> Result<DMatrix<f64>, NoDerivative> {
        let columns: Vec<Result<DVector<f64>, NoDerivative>> =
            (0..u.len()).into_par_iter().map(|j| self.column(u, r, j)).collect();
        let mut jacobian = DMatrix::zeros(r.len(), u.len());
        for (j, column) in columns.into_iter().enumerate() {
            jacobian.set_column(j, &column?);
        }
        Ok(jacobian)
    }

    /// One column; steps shrink where neighbours have no value.
    fn column(&self, u: &[f64], r: &DVector<f64>, j: usize) -> Result<DVector<f64>, NoDerivative> {
        let space = self.evaluator.space;
        let share = if self.central {
            self.noise.cbrt()
        } else {
            self.noise.sqrt()
        };
        let step = share * space.size(j, u[j]);
        let mut why = String::new();
        for h in [step, 0.1 * step, 0.01 * step] {
            let column = if self.central {
                self.central_column(u, r, j, h)
            } else {
                self.forward_column(u, r, j, h)
            };
            match column {
                // Two finite residuals may still differ by more than a number can hold.
                Ok(column) if column.iter().all(|x| x.is_finite()) => return Ok(column),
                Ok(_) => "the derivative is not finite".clone_into(&mut why),
                Err(Gap::Undefined(message)) => why = message,
                Err(Gap::Interrupted) => return Err(NoDerivative::Interrupted),
            }
        }
        let theta = space.theta(u)[space.free[j]];
        Err(NoDerivative::NotFinite(format!(
            "beside `{}` = {theta}: {why}",
            space.name(j)
        )))
    }

    /// The step really taken to a neighbour, and the residual there.
    fn neighbour(&self, u: &[f64], j: usize, h: f64) -> Result<(f64, DVector<f64>), Gap> {
        let mut beside = u.to_vec();
        beside[j] += h;
        let taken = beside[j] - u[j];
        Ok((taken, self.evaluator.residual(&beside)?))
    }

    fn forward_column(&self, u: &[f64], r: &DVector<f64>, j: usize, h: f64) -> Result<DVector<f64>, Gap> {
        let [down, up] = self.room(u, j);
        // In a box narrower than the step, the roomier side.
        let first = if up >= h || up >= down { h.min(up) } else { -h.min(down) };
        let there = match self.neighbour(u, j, first) {
            Err(Gap::Undefined(message)) => {
                let other = if first > 0.0 { -h.min(down) } else { h.min(up) };
                if other == 0.0 {
                    return Err(Gap::Undefined(message));
                }
                self.neighbour(u, j, other)
            }
            there => there,
        };
        let (taken, there) = there?;
        Ok((there - r) / taken)
    }

    fn central_column(&self, u: &[f64], r: &DVector<f64>, j: usize, h: f64) -> Result<DVector<f64>, Gap> {
        let [down, up] = self.room(u, j);
        if up < h || down < h {
            return self.sided_column(
                u,
                r,
                j,
                if up >= down {
                    h.min(0.5 * up)
                } else {
                    -h.min(0.5 * down)
                },
            );
        }
        match (self.neighbour(u, j, h), self.neighbour(u, j, -h)) {
            (Ok((above, upper)), Ok((below, lower))) => Ok((upper - lower) / (above - below)),
            (Err(Gap::Interrupted), _) | (_, Err(Gap::Interrupted)) => Err(Gap::Interrupted),
            // No value on one side: two points on the other, if there is room.
            (Ok(_), Err(_)) if up >= 2.0 * h => self.sided_column(u, r, j, h),
            (Err(_), Ok(_)) if down >= 2.0 * h => self.sided_column(u, r, j, -h),
            (Err(gap), _) | (_, Err(gap)) => Err(gap),
        }
    }

    /// To second order from one side, the second neighbour twice as far as the first.
    fn sided_column(&self, u: &[f64], r: &DVector<f64>, j: usize, h: f64) -> Result<DVector<f64>, Gap> {
        let (h1, near) = self.neighbour(u, j, h)?;
        let (h2, far) = self.neighbour(u, j, 2.0 * h)?;
        Ok(((near - r) * (h2 / h1) - (far - r) * (h1 / h2)) / (h2 - h1))
    }

    /// Room below and above a coordinate.
    fn room(&self, u: &[f64], j: usize) -> [f64; 2] {
        let space = self.evaluator.space;
        [u[j] - space.lower[j], space.upper[j] - u[j]]
    }
}

/// Relative noise of one call, from third differences of seven of them along one direction, as in Hamming's table of
/// differences; no less than rounding.
pub(super) fn noise(evaluator: &Evaluator<'_>, u: &[f64], r: &DVector<f64>) -> Result<f64, Miss> {
    let space = evaluator.space;
    let away: Vec<f64> = (0..u.len())
        .map(|j| {
            let (down, up, step) = (u[j] - space.lower[j], space.upper[j] - u[j], SPACING * space.typical[j]);
            if up >= down {
                step.min(up / 6.0)
            } else {
                -step.min(down / 6.0)
            }
        })
        .collect();
    let mut values = vec![r.clone()];
    for k in 1..7 {
        let there: Vec<f64> = u.iter().zip(&away).map(|(u, step)| u + f64::from(k) * step).collect();
        values.push(evaluator.residual(&there)?);
    }
    let third = |w: &[DVector<f64>]| (&w[3] - &w[0] + (&w[1] - &w[2]) * 3.0).norm_squared();
    let squares: f64 = values.windows(4).map(third).sum();
    // Binomial weights 1, 3, 3, 1: the square of a third difference is 20 times that of the noise.
    let deviation = (squares / (4.0 * 20.0)).sqrt();
    let noise = deviation / r.norm();
    Ok(if noise.is_finite() {
        noise.max(f64::EPSILON)
    } else {
        f64::EPSILON
    })
}
