//! The library that runs inside of an FMU. `build.rs` compiles this folder, with `library.rs` as its root, without the standard
//! library; the writer of FMUs shares its modules, except those of the border.

pub mod content;
pub mod map;
pub mod math;
pub mod model;
pub mod network;
pub mod table;
#[cfg(any(test, clippy))]
pub mod uri;
pub mod variables;
