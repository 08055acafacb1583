//! Sensitivity analysis: screening, shares of the variance, local slopes.
//!
//! All functions support several outputs (for example a total and its parts), evaluate in parallel and sum in the order of the points: the
//! same bits on any number of threads.

mod indices;
mod local;
mod run;
mod screening;

pub use indices::{Estimate, VarianceShares, variance_shares};
pub use local::{Local, gradients, local};
pub use run::{Evaluate, PointOf};
pub use screening::{Effect, Influence, Screening, screening};
