//! The framework of gearloss: description, registry, kinematics, loads, evaluation. It names no concrete loss model.

pub mod attach;
pub mod coefficients;
pub mod conformance;
pub mod contact;
pub mod description;
pub mod eval;
pub mod evaluate;
pub mod flow;
pub mod formula;
pub mod gearbox;
pub mod generic;
pub mod geometry;
pub mod immersion;
pub mod kinematics;
pub mod lanes;
pub mod language;
pub mod loads;
pub mod loss;
pub mod lubricant;
pub mod mechanism;
pub mod motor;
pub mod prelude;
mod registration;
pub mod registry;
pub mod resolve;
pub mod table;
pub mod testing;
pub mod thermal;
pub mod transmission;

pub use gearloss_document as document;
pub use gearloss_document::files;
pub use schemars;
