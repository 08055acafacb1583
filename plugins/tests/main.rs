//! Integration tests of the models as one program: `cargo test -p gearloss-plugins --test all MODULE::` runs one module.
#![allow(clippy::unwrap_used)]

mod checks;
mod duty;
mod kinks;
