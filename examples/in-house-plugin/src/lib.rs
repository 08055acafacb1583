//! The models of a gearbox manufacturer: a bearing law from its rig, a baffle around an immersed gear, and a new mechanism, the drag of
//! parking locks. All values are invented.
//!
//! Linking this crate (`use in_house_plugin as _;`) adds its models and its section to schema, `models`, `check`, `solve`, `explain`,
//! `run`, the report and the conformance suite.

// The built-in models, for other slots and for comparisons in tests.
use gearloss as _;

pub mod baffled;
pub mod parking_lock;
pub mod pawl;
pub mod rig_line;
