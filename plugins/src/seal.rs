//! Friction of shaft seals.

pub mod iso14179_1;
pub mod iso14179_2;
pub mod linke;
pub mod lip_load;
pub mod niemann_winter;
pub mod simrit;
pub mod skf;
