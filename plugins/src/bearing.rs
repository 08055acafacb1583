//! Friction of bearings.

pub mod contact;
pub mod harris;
pub mod iso14179_1;
pub mod iso14179_2;
pub mod journal_film;
mod palmgren;
mod rows;
pub mod schaeffler;
pub mod skf;
pub mod skf_seal;
#[cfg(test)]
mod testing;
pub mod timken;
pub mod washer_gap;
