//! How the outcomes of the analyses are shown.

pub mod balance;
pub mod compare;
pub mod component_compare;
pub mod contact_path;
pub mod operating_points;
