//! The models of a gearbox manufacturer: a bearing law from its rig, a baffle around an immersed gear, a new mechanism, the drag of
//! parking locks, and a new analysis. All values are invented.
//!
//! Linking this crate (`use in_house_plugin as _;`) adds its models, its section and its analysis to schema, `models`, `check`, `solve`, `explain`,
//! `run`, the report and the conformance suite.

// The built-in models, for other slots and for comparisons in tests.
use gearloss as _;

pub mod baffled;
pub mod drag_torque;
pub mod parking_lock;
pub mod pawl;
pub mod rig_line;
