//! Experimental design: the most informative next measurements for the parameters of a fit.
//!
//! Sources: Fedorov: Theory of Optimal Experiments (Academic Press 1972); Atkinson, Donev, Tobias: Optimum Experimental Designs,
//! with SAS (Oxford 2007), chapters 10 to 12.

mod information;
mod plan;

pub use information::{Information, Precision, uniform_row};
pub use plan::{Choice, Design, Plan, Rule};
