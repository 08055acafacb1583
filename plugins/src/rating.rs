//! Ratings at solved points: bearings, flanks, seals.

pub mod bearing_speed;
pub mod equivalent_load;
pub mod iso_281;
pub mod iso_76;
pub mod minimum_load;
