//! The border to C, so that its lints are checked with those of the crate, and its tests run.

#![allow(unsafe_code, dead_code)]

#[path = "fmi2.rs"]
mod fmi2;
#[path = "fmi3.rs"]
mod fmi3;
#[path = "host.rs"]
mod host;
#[path = "instance.rs"]
mod instance;

use super::runtime::{content, model, uri, variables};

#[cfg(test)]
#[path = "border_tests.rs"]
mod tests;
