//! What readers get to see of results beside numbers: pictures.

mod contours;
pub mod figure;
pub mod plot;
mod schematic;

pub use figure::{Cloud, Figure, Map};
pub use schematic::schematic;
