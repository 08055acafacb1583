//! What readers get to see of results beside numbers: pictures.

pub mod figure;
pub mod plot;

pub use figure::Figure;
