//! Studies of gearloss: their documents, measured data, duties, identification and analyses.

pub mod analyses;
pub mod analysis;
pub mod checked;
pub mod duty;
pub mod fit;
pub mod identify;
pub mod measured;
pub mod needs;
pub mod results;
pub mod study;
pub mod table;
pub mod tasks;
pub mod varied;
