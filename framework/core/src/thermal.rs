//! Operating temperature: balance of losses and heat dissipation. It is separate from the evaluation of a point.

mod balance;
mod equilibrium;
mod exchanger;
mod housing;
mod limit;
pub mod network;

pub use balance::{Balance, Outcome, Root, Step, balance};
pub use equilibrium::{Equilibrium, Unbalanced};
pub use exchanger::Arrangement;
pub use housing::{HeatFlow, Housing, Way};
pub use limit::Limit;
