//! Mean coefficients of friction of a mesh.

pub mod fernandes;
pub mod iso_13989;
pub mod local;
pub mod michaelis;
pub mod schlenk;
pub mod vdi_2736;
