//! Drag of open wet clutches and brakes.

pub mod disc_gap;
