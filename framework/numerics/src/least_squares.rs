//! Bounded nonlinear least squares: parameters that fit calculated values to measured ones, weighted by their uncertainties.
//!
//! The solver minimises F = 1/2 sum c^2 rho((r/c)^2) + 1/2 sum of the squares of the rows of priors, within bounds. A row r is calculated
//! minus measured over the standard uncertainty, a pure number; parameters have their own units, and internally a coordinate u is the
//! parameter or its logarithm.
//!
//! The method is Gauss-Newton in a trust region: a ball in the metric of the column norms, together with the bounds. The minimum inside
//! both is a second-order cone program, solved with Clarabel (Goulart and Chen, "Clarabel: An interior-point solver for conic programs with
//! quadratic objectives", 2024) and refined on its active set. Radius and acceptance follow Moré, "The Levenberg-Marquardt algorithm"
//! (1978) and Conn, Gould and Toint, "Trust-Region Methods" (2000); the second-order correction is that of Transtrum and Sethna,
//! arXiv:1201.5885; the test by relative offset that of Bates and Watts, "Nonlinear Regression Analysis" (1988).
//!
//! If laws with kinks and jumps stop a search, [`Options::polish`] completes it without derivatives, by implicit filtering in steps of
//! standard errors, and the fit lists the kinks at its minimum, [`Fit::kinks`].
//!
//! Decisions do not depend on time or random numbers, and sums follow the order of their indices: the same problem gives the same bits on
//! any number of threads.
//!
//! ```
//! use gearloss_numerics::least_squares::{Options, Parameter, Problem, solve};
//!
//! let (x, y) = ([0.0, 1.0, 2.0, 3.0], [2.0, 1.21, 0.735, 0.446]);
//! let residual = |p: &[f64]| Ok(x.iter().zip(y).map(|(x, y)| (p[0] * (-p[1] * x).exp() - y) / 0.01).collect());
//! let parameters = vec![Parameter::new("height", 1.0).within(0.0, 10.0), Parameter::new("decay", 1.0).log()];
//! let fit = solve(&Problem::new(residual, parameters), &Options::fit())?;
//! assert!(fit.converged() && (fit.theta[1] - 0.5).abs() < 0.01);
//! # Ok::<(), gearloss_numerics::least_squares::Fault>(())
//! ```

mod bounded_linear;
mod cone;
mod context;
mod difference;
mod dogleg;
mod evaluate;
mod fault;
mod finish;
mod fit;
mod iterate;
mod kink;
mod linear;
mod linearised;
mod model;
mod multistart;
mod noise;
mod optimality;
mod options;
mod points;
mod polish;
mod problem;
mod robust;
mod second_order;
mod solve;
mod space;
mod subproblem;
mod trial;
mod unite;

pub use bounded_linear::bounded_linear;
pub use fault::{Fault, Finding};
pub use fit::{Counts, Derivative, Fit, How, Iteration, Kink, Reason, Side, Status};
pub use multistart::{Kinship, Minima, Minimum, multistart};
pub use options::{Differences, Known, Noise, OneSearch, Options, Searches, Steps, Subproblem, Tolerances};
pub use points::{halton, spread};
pub use problem::{Parameter, Prior, Problem, Scale};
pub use robust::Loss;
pub(crate) use robust::{FLOOR, median_spread};
pub use solve::{SINGULAR, solve};
pub use unite::UNTOLD;
