//! Root of the library inside of an FMU: FMI 2.0 and FMI 3.0 over one model.
//!
//! It needs few symbols of the C library, all old ones, so that it loads on any Linux with it: no standard library, own mathematical
//! functions. On other systems (`hosted`) it uses the standard library. It does not panic on any input; a panic would end the process.

#![cfg_attr(not(hosted), no_std)]
#![warn(clippy::pedantic)]
#![allow(
    dead_code,                        // The writer of contents is in the same modules.
    clippy::float_cmp,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::similar_names,
    clippy::many_single_char_names
)]

extern crate alloc;

mod content;
mod fmi2;
mod fmi3;
mod host;
mod instance;
mod map;
mod math;
mod model;
mod network;
mod table;
mod uri;
mod variables;
