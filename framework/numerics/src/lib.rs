//! Numerical methods of gearloss: least squares, what a fit says, sampling, sensitivity. It knows no gear.

pub mod design;
pub mod fit;
pub mod inference;
pub mod least_squares;
pub mod sampling;
pub mod selection;
pub mod sensitivity;
pub mod statistics;
