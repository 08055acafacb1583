//! Auxiliaries: pumps and whatever else takes moment from a shaft.

pub mod constant_power;
pub mod pump;
pub mod wilson;
