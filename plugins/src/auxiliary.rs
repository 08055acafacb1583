//! Auxiliaries: pumps and other components driven by a shaft.

pub mod constant_power;
pub mod pump;
pub mod rotating_channel;
pub mod rotor;
pub mod shaft_windage;
pub mod wilson;
