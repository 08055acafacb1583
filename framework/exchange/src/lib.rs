//! Files of other programs.
//!
//! [`rexs::import`] converts a REXS model, the exchange format of gearbox programs, to the texts of a gearbox and a study. It reads bytes
//! and returns texts; files are read and written by its caller. [`bearing_table::import`] makes a catalogue from a maker's table of
//! bearings.

pub mod bearing_table;
pub mod codes;
pub mod rexs;
