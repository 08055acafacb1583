//! Analyses: many points of one transmission, in parallel, with the same bits on any number of threads.

mod bits;
mod cycle;
mod grid;
mod notes;
mod rows;
mod statistics;
mod sums;
mod temperature;

pub use cycle::{Driven, Ride, Stretch, drive};
pub use grid::{
    Field, Given, GridResult, MOST_HELD, Piece, PointResult, Points, merge, pieces, run_grid, solve_pieces,
};
pub use notes::{Note, Stated, WeakPoint, evidence, notes};
pub use rows::{BuiltFrom, OnRig, Rows, SolvedRows};
pub use statistics::{Statistics, bands, correlation, histogram, levels, quantile};
pub use sums::{SUMS, sum_of};
pub use temperature::{Found, OilTemperature};
