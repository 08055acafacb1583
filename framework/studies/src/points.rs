//! Many points of one transmission, solved in parallel with the same bits on any number of threads.

mod cycle;
mod derivatives;
mod gear_rule;
mod grid;
mod locking;
mod notes;
mod pieces;
mod prepared;
mod rows;
mod solve;
mod sums;
mod temperature;
mod unit;

pub use cycle::{
    Choosing, ChosenBy, Driven, GearChoice, Optimum, Ride, Shift, Stretch, can_drive, drive, has_machine, offers_of,
    tow_torques,
};
pub use derivatives::{Derivative, Derivatives, Derived, Method, Variable};
pub use gear_rule::{Offer, Rule};
pub use gearloss_numerics::statistics::{Statistics, bands, correlation, histogram, levels, quantile};
pub use grid::{Field, Given, GridResult, PointResult, Points, merge, run_grid};
pub use locking::{SelfLocking, self_locking};
pub use notes::{
    Note, STATIC_SAFETY, Stated, TotalLoss, WeakPoint, evidence, merge_notes, notes, notes_over_time, notes_with_shares,
};
pub use pieces::{MOST_IN_FLIGHT, Make, Numbered, Piece, solve_pieces, take_points};
pub use prepared::{PreparedPoint, SolvedPoint, unit_of};
pub use rows::{OnRig, Rows, SolvedRows};
pub use sums::{SUMS, Sums, sum_of, sums};
pub use temperature::{Found, OilTemperature};
pub use unit::{UnitColumn, UnitPoint};
