//! Sensitivity, inference and design of measurements against check values of one made-up identification problem and of
//! published test functions.
//!
//! The check values were computed by an independent program. A test says how near they must be met and why.

mod check_problem;
mod design;
mod folds;
mod inference;
mod models;
mod paired;
mod profile;
mod residuals;
mod sensitivity;
mod variants;
