//! Churning, squeezing and windage of gears.

pub mod changenet_2011;
pub mod iso14179_2;
mod wetted;
