//! Friction of the gears in a differential.

pub mod bevel_gears;
pub mod bias;
