//! How the outcomes of the analyses are shown.

pub mod balance;
pub mod breakdown;
pub mod rms_surface;
pub mod sweep;
pub mod thermal_limit;
