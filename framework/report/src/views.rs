//! How the outcomes of the analyses are shown.

pub mod balance;
pub mod map;
pub mod sensitivity;
pub mod tournament;
pub mod cycle;
pub mod fluid_sweep;
pub mod uncertainty;
pub mod breakdown;
pub mod rms_surface;
pub mod sweep;
pub mod thermal_limit;
pub mod compare;
pub mod component_compare;
pub mod contact_path;
pub mod operating_points;
