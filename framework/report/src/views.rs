//! The views of the analyses.

pub mod axle_split;
pub mod balance;
pub mod breakdown;
pub mod compare;
pub mod component_compare;
pub mod contact_path;
pub mod cycle;
pub mod fluid_sweep;
pub mod identify;
pub mod map;
pub mod oil_property;
pub mod operating_points;
pub mod optimise;
pub mod rms_surface;
pub mod sensitivity;
pub mod sweep;
pub mod thermal_limit;
pub mod tournament;
pub mod uncertainty;
pub mod validation;
