//! Friction of rolling bearings.

pub mod contact;
pub mod harris;
pub mod iso14179_1;
pub mod iso14179_2;
mod palmgren;
mod rows;
pub mod schaeffler;
pub mod skf;
pub mod skf_seal;
#[cfg(test)]
mod testing;
pub mod timken;
