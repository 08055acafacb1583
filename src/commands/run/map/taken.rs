//! What a map takes from the points of a task as soon as they are solved, on all threads.

use gearloss_studies::analysis::{Bits, Field, Numbered};

use super::super::table::{Rows, Shape};
use super::kept::{Picked, Wanted};
use super::rows::RowsOf;
use crate::output::Failure;

/// How it is taken.
pub struct Taker<'a> {
    pub field: &'a Field,
    pub rows: RowsOf<'a>,
    pub shape: Shape,
    pub wanted: &'a Wanted,
    /// Whether the points wait for the JSON.
    pub waits: bool,
}

/// What was taken.
pub struct Taken {
    pub rows: Result<Rows, Failure>,
    pub picked: Picked,
    pub passes: usize,
    /// The points where they wait for the JSON; else nothing.
    pub waiting: Bits,
}

impl Taker<'_> {
    pub fn take(&self, points: &mut Numbered<'_>) -> Taken {
        Taken {
            rows: self.shape.rows(points, |some, to| self.rows.cells(some, to)),
            picked: self.wanted.pick(self.field, points),
            passes: points.iter().map(|(_, point)| point.passes).sum(),
            waiting: if self.waits { Bits::of(points) } else { Bits::default() },
        }
    }
}
