//! Friction of shaft seals.

pub mod iso14179_2;
