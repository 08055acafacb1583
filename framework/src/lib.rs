//! The frame of gearloss: description, registry, kinematics, loads, evaluation. It names no concrete loss model.

pub mod analysis;
pub mod attach;
pub mod conformance;
pub mod description;
pub mod design;
pub mod document;
pub mod eval;
pub mod evaluate;
pub mod fit;
pub mod flow;
pub mod formula;
pub mod gearbox;
pub mod generic;
pub mod geometry;
pub mod immersion;
pub mod inference;
pub mod kinematics;
pub mod language;
pub mod least_squares;
pub mod loads;
pub mod loss;
pub mod lubricant;
pub mod measured;
pub mod mechanism;
pub mod registry;
pub mod report;
pub mod resolve;
pub mod sampling;
pub mod sensitivity;
pub mod study;
pub mod table;
pub mod thermal;
pub mod transmission;
pub mod varied;

pub use schemars;
