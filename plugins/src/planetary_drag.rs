//! Drag of a planetary set in oil: the carrier and the planets that orbit with it.

pub mod estimate;
pub mod power_law;
