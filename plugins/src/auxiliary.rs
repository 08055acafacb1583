//! Auxiliaries: pumps and other components driven by a shaft.

pub mod constant_power;
pub mod pump;
pub mod rotating_channel;
pub mod wilson;
