//! Ratings at solved points: bearings, flanks, seals.

pub mod bearing_speed;
pub mod bevel_flank;
pub mod equivalent_load;
mod flank;
pub mod flank_contact;
pub mod flash_temperature;
pub mod iso_16281;
pub mod iso_281;
pub mod iso_76;
pub mod lip_seal;
pub mod minimum_load;
pub mod plain_bearing;
pub mod plastic_temperature;

use gearloss_framework::rating::Bound;

/// A minimum, or no bound if it is zero.
fn at_least_unless_zero(least: f64) -> Bound {
    if least > 0.0 {
        Bound::at_least(least)
    } else {
        Bound::NONE
    }
}
