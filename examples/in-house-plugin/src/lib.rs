//! The models of a maker of gearboxes: a bearing law from its rig, a baffle around a dipping gear, and a mechanism of its own,
//! the drag of parking locks; and an analysis of its own. All figures are invented.
//!
//! Nothing else names this crate: linking it (`use in_house_plugin as _;`) puts its models, its section and its analysis into
//! schema, `models`, `check`, `solve`, `explain`, `run`, the report and the conformance suite.

// The built-in models, for other slots and for comparisons in tests.
use gearloss as _;

pub mod baffled;
pub mod drag_torque;
pub mod parking_lock;
pub mod pawl;
pub mod rig_line;
