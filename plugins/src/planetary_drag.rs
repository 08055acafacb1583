//! Oil drag of a planetary set: the carrier and its orbiting planets.

pub mod estimate;
pub mod power_law;
