//! How the outcomes of the analyses are shown.

pub mod balance;
pub mod cycle;
pub mod fluid_sweep;
pub mod uncertainty;
