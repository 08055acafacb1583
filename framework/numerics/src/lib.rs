//! Numerical methods of gearloss, independent of gears: least squares, inference, sampling, sensitivity, search.

// Fits and what they say.
pub mod fit;
pub mod inference;
pub mod least_squares;
pub mod selection;
pub mod smooth;

// Which points to take or to vary.
pub mod design;
pub mod sampling;
pub mod search;
pub mod sensitivity;

// What all of them use.
pub mod statistics;
