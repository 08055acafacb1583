//! All items that a crate with its own analysis needs: `use gearloss::studies::prelude::*;`.

pub use gearloss_framework::transmission::Transmission;
pub use schemars::JsonSchema;
pub use serde::{Deserialize, Serialize};

pub use crate::analyses::common::axes::{axis, speeds, torques};
pub use crate::analyses::{
    Analysis, Built, Chosen, Engine, Head, Outcome, Plan, Planner, Run, Runs, Stopped, Work, gear_of,
};
pub use crate::numbers::{RPM, tidy};
pub use crate::points::{Given, GridResult, Note, PointResult, Points, notes};
pub use crate::register_analysis;
pub use crate::study::{
    By, NameOr, NamesOrParameters, ParameterKey, RangeEntry, SpeedAxis, TemperatureAxis, TorqueAxis, Uses, Write,
};
pub use crate::table::Table;
