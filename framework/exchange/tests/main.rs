//! The tests of the exchange of files, as one program.
#![allow(clippy::unwrap_used)]

mod common;
mod formats;
mod fuzz;
mod hostile;
mod models;
mod renames;
mod shares;
mod written;
