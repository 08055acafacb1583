//! What analyses share: keys of their entries, inputs read and checked, records and numbers of their outcomes.

pub mod axes;
pub mod chosen;
mod corrected;
pub mod duties;
pub(crate) mod gears;
pub mod inputs;
pub mod limits_over_cycles;
pub(crate) mod machine_demand;
pub mod measurable;
pub mod model_error;
pub mod outside_maps;
pub mod ranges;
pub mod rows;
pub mod shares;
pub mod trial;
pub(crate) mod units;
