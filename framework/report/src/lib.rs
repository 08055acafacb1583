//! Text, figures, pages and files of results.

pub mod card;
pub mod check;
mod contours;
pub mod csv;
pub mod deviations;
pub mod eval;
pub mod exports;
pub mod figure;
pub mod html;
pub mod models;
pub mod page;
pub mod parquet;
pub mod plot;
pub mod point;
mod schematic;
pub mod text;
pub mod views;

pub use figure::{Cloud, Figure, Map};
pub use schematic::schematic;
