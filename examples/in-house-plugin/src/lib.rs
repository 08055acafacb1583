//! A mechanism of a maker's own, with its section, and two models: a parking lock whose pawl drags, and a seal.
//!
//! Nothing else names this crate: linking it (`use in_house_plugin as _;`) puts its mechanism and models into schema,
//! `models`, `check`, `solve`, `explain` and the conformance suite.

pub mod measured_seal;
pub mod parking_lock;
pub mod pawl;
