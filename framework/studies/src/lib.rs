//! Studies of gearloss: documents, measured data, cycles, identification and analyses.

pub mod analyses;
pub mod analysis;
pub mod codes;
pub mod duty;
pub mod fit;
pub mod identify;
pub mod measured;
pub mod prelude;
pub mod results;
pub mod run;
pub mod study;
pub mod table;
pub mod tasks;
pub mod varied;
