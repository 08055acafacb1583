//! The workbench: a local page to edit, see and solve gearboxes and studies.
//!
//! [`Session`] answers a [`Request`] of the page with JSON. It keeps no state of a page: a request carries the texts that the page holds, so
//! that pages do not affect each other and a text is never lost here. Files are those of a [`Store`]. On a computer, [`serve`] makes
//! the folder of the user and the page available to a browser on the same computer.

// What the page asks and gets.
pub mod answer;
pub mod drafts;
pub mod request;
mod session;
pub mod store;

// Gearboxes.
mod chosen;
mod controls;
mod convergence;
mod drawing;
pub mod form;
mod map;
mod point;

// Studies.
mod section;
mod study;

// A folder of a computer, and a browser on it.
#[cfg(not(target_family = "wasm"))]
pub mod disk;
#[cfg(not(target_family = "wasm"))]
mod lock;
#[cfg(not(target_family = "wasm"))]
mod server;

#[cfg(not(target_family = "wasm"))]
pub use server::{Served, serve};
pub use session::Session;
pub use study::Listener;
