//! Ratings at solved points: bearings, flanks, seals.

pub mod bearing_speed;
pub mod equivalent_load;
mod flank;
pub mod flank_contact;
pub mod flash_temperature;
pub mod iso_281;
pub mod iso_76;
pub mod lip_seal;
pub mod minimum_load;
