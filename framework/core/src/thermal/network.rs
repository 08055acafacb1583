//! Thermal networks: several temperatures, each with its own heat balance.

mod build;
pub mod circuit;
mod faults;
mod march;
mod parts;
mod state;
mod steady;
mod stepping;
mod tabulated;

pub(crate) use build::Around;
pub use march::{Heats, March, Moment, Passed, Stage};
pub use parts::{Network, Rate, Surroundings};
pub use steady::Steady;
pub use stepping::{Scheme, StepSize};
pub use tabulated::{ExchangerNumbers, LinkState, Load, NodeHeats};
