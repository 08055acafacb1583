//! Identification of parameters of a gearbox and its rig from measured total losses and means over cycles.
//!
//! [`Identification`] combines measured points, means over cycles, a gearbox and parameters into a least-squares problem; [`Identification::fit`] solves it with inference; [`Identification::predict`] predicts rows that were not fitted; [`Identification::next`] ranks further measurements.

mod fit;
mod hold_out;
mod kinks;
mod means;
mod next;
mod parameter;
mod posterior;
mod predict;
mod problem;
mod shares;

pub use fit::{Fitted, Profiled, Settings};
pub use hold_out::{HoldOut, group_words};
pub use kinks::ModelKink;
pub use means::{CalculatedMeans, Mean, Means};
pub use next::{Candidate, NextPlan};
pub use parameter::{Identified, RigQuantity, Target};
pub use posterior::Posterior;
pub use predict::{CONFIDENCE, PredictedNumber, Predictions};
pub use problem::{Calculated, Faults, Identification, Observation, Pair};
pub use shares::ShareBands;
