//! What readers get to see of results beside numbers: pictures.

mod contours;
pub mod figure;
pub mod plot;

pub use figure::{Cloud, Figure, Map};
