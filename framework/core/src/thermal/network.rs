//! Thermal networks: several temperatures, each with its own heat balance.

mod build;
pub mod circuit;
mod faults;
mod march;
mod parts;
mod state;
mod steady;
mod stepping;

pub(crate) use build::Around;
pub use circuit::Circuit;
pub use march::{Heats, March, Moment, Passed, Stage};
pub use parts::{Network, Surroundings};
pub use steady::Steady;
pub use stepping::{Scheme, StepSize};
