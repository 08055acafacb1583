//! Numerical methods of gearloss, independent of gears: least squares, inference, sampling, sensitivity.

pub mod design;
pub mod fit;
pub mod inference;
pub mod least_squares;
pub mod sampling;
pub mod selection;
pub mod sensitivity;
pub mod statistics;
