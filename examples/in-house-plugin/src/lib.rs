//! The models of a gearbox manufacturer: two bearing models from its rig, a baffle around an immersed gear, a separate mechanism (the
//! drag of parking locks) with a rating, and an analysis. All figures are invented.
//!
//! No other code refers to this crate: linking it (`use in_house_plugin as _;`) adds its models, its section and its analysis to
//! schema, `models`, `check`, `solve`, `explain`, `run`, the report and the conformance suite.

// The built-in models, for other slots and for comparisons in tests.
use gearloss as _;

pub mod baffled;
pub mod drag_torque;
pub mod lock_speed;
pub mod parking_lock;
pub mod pawl;
pub mod rig_line;
pub mod rig_power;
