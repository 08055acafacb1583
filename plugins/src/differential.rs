//! Friction of the gears in a differential.

pub mod bevel_gears;
pub mod bevel_meshes;
pub mod bias;
