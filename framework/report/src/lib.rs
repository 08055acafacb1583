//! Text, figures, pages and files of results.
//!
//! A view turns an outcome into a [`Page`](page::Page): text, verdicts and figures. It registers itself with
//! [`register_view!`](crate::register_view); an outcome without one is shown as its tables.

// Outcomes, points and models as text and pages.
pub mod card;
pub mod check;
pub mod codes;
pub mod eval;
pub mod html;
pub mod limits;
mod machines;
mod model_error;
pub mod models;
mod names;
pub mod page;
pub mod point;
pub mod stated_ranges;
pub mod tested;
pub mod text;
mod unit;
pub mod validation;
mod views;

// Figures as data and as SVG.
mod contours;
mod deviations;
pub mod figure;
pub mod picture;
pub mod plot;
pub mod schematic;

// Tables as files, also for other programs.
pub mod csv;
pub mod exports;
#[cfg(not(target_family = "wasm"))]
pub mod parquet;
#[cfg(not(target_family = "wasm"))]
pub mod xlsx;

pub use figure::{Cloud, Figure, Map};
pub use schematic::schematic;
