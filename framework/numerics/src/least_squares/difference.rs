//! Derivatives by differences within the bounds.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::evaluate::{Evaluator, Miss};

/// Why there is no Jacobian.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum NoDerivative {
    /// A parameter near which the residuals have no value, and why.
    NotFinite(String),
    /// Interrupted by the user.
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
    /// The Jacobian at a point with its residual; columns are computed in parallel.
    pub fn jacobian(&self, u: &[f64], r: &DVector<f64>) -> Result<DMatrix<f64>, NoDerivative> {
        let columns: Vec<Result<DVector<f64>, NoDerivative>> = (0..u.len())
            .into_par_iter()
            .with_max_len(1)
            .map(|j| self.column(u, r, j))
            .collect();
        let mut jacobian = DMatrix::zeros(r.len(), u.len());
        for (j, column) in columns.into_iter().enumerate() {
            jacobian.set_column(j, &column?);
        }
        Ok(jacobian)
    }

    /// One column; steps are reduced if neighbours have no value.
    fn column(&self, u: &[f64], r: &DVector<f64>, j: usize) -> Result<DVector<f64>, NoDerivative> {
        let space = self.evaluator.space;
        let share = if self.central {
            self.noise.cbrt()
        } else {
            self.noise.sqrt()
        };
        let step = share * space.reach(j, u[j], self.noise);
        let mut why = String::new();
        for h in [step, 0.1 * step, 0.01 * step] {
            let column = if self.central {
                self.central_column(u, r, j, h)
            } else {
                self.forward_column(u, r, j, h)
            };
            match column {
                // The difference of two finite residuals may overflow.
                Ok(column) if column.iter().all(|x| x.is_finite()) => return Ok(column),
                Ok(_) => "the derivative is not finite".clone_into(&mut why),
                Err(Gap::Undefined(message)) => why = message,
                Err(Gap::Interrupted) => return Err(NoDerivative::Interrupted),
            }
        }
        let theta = space.theta(u)[space.free[j]];
        Err(NoDerivative::NotFinite(format!(
            "near `{}` = {theta}: {why}",
            space.name(j)
        )))
    }

    /// The exact step to a neighbour, and the residual there.
    fn neighbour(&self, u: &[f64], j: usize, h: f64) -> Result<(f64, DVector<f64>), Gap> {
        let mut beside = u.to_vec();
        beside[j] += h;
        let taken = beside[j] - u[j];
        Ok((taken, self.evaluator.residual(&beside)?))
    }

    fn forward_column(&self, u: &[f64], r: &DVector<f64>, j: usize, h: f64) -> Result<DVector<f64>, Gap> {
        let [down, up] = self.room(u, j);
        // In a box narrower than the step, the side with more space.
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
            // No value on one side: two points on the other if there is space.
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

    /// Distance to the bounds below and above a coordinate.
    fn room(&self, u: &[f64], j: usize) -> [f64; 2] {
        let space = self.evaluator.space;
        [u[j] - space.lower[j], space.upper[j] - u[j]]
    }
}

#[cfg(test)]
mod tests {
    use super::super::problem::{Parameter, Problem};
    use super::super::space::Space;
    use super::*;

    /// Derivative of x^2 + 3 x and of exp(x) at a place, with bounds and an edge below which there are no values.
    fn slopes(x: f64, bounds: [f64; 2], edge: f64, central: bool) -> Result<Vec<f64>, NoDerivative> {
        let law = |p: &[f64]| {
            let inside = (p[0] >= edge).then(|| vec![p[0] * p[0] + 3.0 * p[0], p[0].exp()]);
            inside.ok_or_else(|| "beyond the edge".to_owned())
        };
        let problem = Problem::new(law, vec![Parameter::new("x", x).within(bounds[0], bounds[1])]);
        let space = Space::from_parameters(problem.parameters()).unwrap_or_else(|fault| panic!("{fault}"));
        let (evaluator, r) = Evaluator::start(&problem, &space, None).unwrap_or_else(|fault| panic!("{fault}"));
        let differences = Differences {
            evaluator: &evaluator,
            noise: f64::EPSILON,
            central,
        };
        let jacobian = differences.jacobian(&space.start, &r)?;
        Ok(jacobian.iter().copied().collect())
    }

    #[test]
    fn check_2_5_differences_at_bounds_and_edges() {
        let free = [f64::NEG_INFINITY, f64::INFINITY];
        for (bounds, edge) in [
            (free, -9.0),
            ([1.0, 3.0], -9.0),
            ([-3.0, 1.0], -9.0),
            ([1.0 - 1e-9, 1.0 + 1e-4], -9.0),
            (free, 1.0),
            ([-3.0, 5.0], 1.0 - 1e-7),
        ] {
            for (central, error) in [(false, 1e-7), (true, 1e-9)] {
                let found = slopes(1.0, bounds, edge, central);
                assert!(
                    found
                        .as_ref()
                        .is_ok_and(|d| (d[0] - 5.0).abs() < 5.0 * error && (d[1] - 1.0_f64.exp()).abs() < 3.0 * error),
                    "{bounds:?} {edge} {central}: {found:?}"
                );
            }
        }
    }

    #[test]
    fn check_2_5_no_value_on_any_side_is_named() {
        // At its upper bound, with an edge just below.
        for central in [false, true] {
            let found = slopes(1.0, [0.0, 1.0], 1.0, central);
            let named = |why: &String| why.contains("near `x` = 1: beyond the edge");
            assert!(
                matches!(&found, Err(NoDerivative::NotFinite(why)) if named(why)),
                "{found:?}"
            );
        }
    }
}
