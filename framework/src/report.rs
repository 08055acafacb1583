//! What readers get to see of results beside numbers: pictures.

pub mod plot;
