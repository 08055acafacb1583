//! The tests of the numerical methods from outside, as one program: `cargo test -p gearloss-numerics --test all MODULE::` runs one module.
#![allow(clippy::unwrap_used)]

mod classics;
mod least_squares;
mod least_squares_bounded;
mod least_squares_faults;
mod least_squares_minima;
mod least_squares_nist;
mod loss_map;
mod nist;
mod statistics;
