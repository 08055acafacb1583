//! Functional Mock-up Units of tables of losses and of thermal networks, for FMI 2.0 and FMI 3.0.
//!
//! An FMU is a zip archive with `modelDescription.xml`, a library for each platform, and the resources that the library reads. The
//! library is the same in all FMUs; it is compiled with this crate and embedded in it. A [`Content`](content::Content) becomes the
//! resources; the variables follow from it.

extern crate alloc;

mod archive;
mod description;
mod library;
mod reference;
mod runtime;

#[cfg(any(test, clippy))]
#[path = "runtime/border.rs"]
mod border;

pub use archive::{Experiment, Fmu, Version};
pub use library::{Library, Platform, UnknownLibrary};
pub use runtime::{content, map, model, network, table, variables};
