//! Studies of gearloss: documents, measured data, cycles, identification and analyses.

pub mod analyses;
pub mod analysis;
pub mod duty;
pub mod identify;
pub mod measured;
pub mod results;
pub mod study;
pub mod table;
pub mod tasks;
pub mod varied;
