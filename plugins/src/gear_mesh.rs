//! Load-dependent loss of gear meshes.

pub mod iso14179_2;
pub mod path_integral;
