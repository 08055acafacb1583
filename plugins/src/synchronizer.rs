//! Drag of open couplings.

pub mod cone_gap;
pub mod ring_gap;
