//! Search for the best designs of a space of numbers and choices, with constraints and one or several objectives.
//!
//! The caller evaluates the designs that [`Evolution`] proposes, in any order and on any number of threads, and returns their scores;
//! [`Refinement`] then improves the numbers of one of them. Both are deterministic: the same scores give the same designs.

mod evolution;
mod ranking;
mod refinement;

pub use evolution::Evolution;
pub use ranking::{best, front};
pub use refinement::Refinement;

/// A coordinate of a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gene {
    /// A number from zero to one.
    Number,
    /// One of so many choices: a whole number from zero on.
    Choice(usize),
}

/// What a design is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Objectives, all of which are to be small.
    pub objectives: Vec<f64>,
    /// Sum of the relative violations of constraints; zero for a feasible design, infinite for one that cannot be evaluated.
    pub violation: f64,
}

/// An evaluated design.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// Its coordinates, in the order of the genes.
    pub genes: Vec<f64>,
    /// Its score.
    pub score: Score,
}
