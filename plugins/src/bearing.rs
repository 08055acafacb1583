//! Friction of rolling bearings.

pub mod iso14179_2;
pub mod skf;
pub mod skf_seal;
