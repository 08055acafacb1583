//! The loss models, catalogues and recipes shipped with gearloss: one file per model, one folder per mechanism.
//!
//! The crate uses the framework exactly as an in-house crate does. A program links it with `use gearloss_plugins as _;`.

mod air;
pub mod auxiliary;
pub mod bearing;
pub mod bevel_mesh;
pub mod boundary;
pub mod catalogues;
pub mod chain;
mod checks;
pub mod clutch;
pub mod convection;
pub mod crossed_helical_mesh;
pub mod cycles;
pub mod differential;
mod efficiency;
mod flank_heat;
pub mod gear_drag;
pub mod gear_mesh;
pub mod heat_dissipation;
pub mod heat_link;
pub mod joint;
pub mod mean_friction;
pub mod network;
pub mod planetary_drag;
mod powers;
#[cfg(test)]
mod printed;
pub mod rating;
pub mod rotating;
pub mod seal;
pub mod sets;
pub mod synchronizer;
pub mod tooth_friction;
pub mod validated;
pub mod worm_mesh;

/// Names this crate where `use gearloss_plugins as _;` is not enough: the linker of WebAssembly drops a crate of which nothing is called.
#[inline(never)]
pub fn link() {}
