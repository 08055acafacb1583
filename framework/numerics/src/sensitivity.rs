//! What a result depends on: screening, shares of the variance, local slopes.
//!
//! All functions take several outputs at once (a total and its parts, say), evaluate in parallel and add up in the order of
//! the points: the same bits on any number of threads.

mod indices;
mod local;
mod run;
mod screening;

pub use indices::{Estimate, VarianceShares, variance_shares};
pub use local::{Local, gradients, local};
pub use run::{Evaluate, PointOf};
pub use screening::{Effect, Influence, Screening, screening};
