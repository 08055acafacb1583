//! How the outcomes of the analyses are shown.

pub mod balance;
pub mod identify;
