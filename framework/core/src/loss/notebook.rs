//! Note cells of all model instances of a transmission in one iteration.

use std::cell::Cell;

use super::{MOST_KEPT, NoteBase, Notes, Seen, Trace};
use crate::real::{Points, Real};

/// Values that an instance keeps, once they have been computed.
pub type Kept<R> = Option<[R; MOST_KEPT]>;

/// Cells for the notes of all instances, space for the values that they keep, and the steps of an explanation. Made once per
/// iteration; the notes of each instance are derived from it.
#[derive(Debug, Clone, Copy)]
pub struct Notebook<'a, R: Real = f64> {
    /// Cells of limits and observed quantities; without them nothing is noted.
    pub(crate) cells: &'a [Cell<Seen>],
    /// The points that note, as bits.
    pub(crate) points: u32,
    /// The points that differ from the one before in what is evaluated, as bits.
    pub(crate) starts: u32,
    /// Space for the values that each instance computes [once](Notes::once); without it nothing is kept.
    pub(crate) kept: &'a [Cell<Kept<R>>],
    /// The same for points that are evaluated one by one, if they have their speeds and oils in common.
    pub(crate) kept_alone: &'a [Cell<Kept<f64>>],
    /// Target of recorded steps.
    pub(crate) trace: Option<&'a Trace>,
}

impl<R: Points> Notebook<'_, R> {
    /// Nothing is noted or kept.
    pub const CLOSED: Notebook<'static, R> = Notebook {
        cells: &[],
        points: (1 << R::COUNT) - 1,
        starts: !0,
        kept: &[],
        kept_alone: &[],
        trace: None,
    };
}

impl<'a, R: Real> Notebook<'a, R> {
    /// Notes of one instance, added to its previous notes.
    #[inline]
    pub fn notes(&self, base: NoteBase) -> Notes<'a, R> {
        Notes { base, book: *self }
    }

    /// Clears the notes of one instance and of those nested in it.
    #[inline]
    pub(crate) fn clear(&self, base: NoteBase) {
        for cell in self.cells.get(base.limits()..base.end()).unwrap_or_default() {
            cell.set(Seen::NOTHING);
        }
    }
}

impl<'a, R: Points> Notebook<'a, R> {
    /// True if a point does not differ from an earlier one.
    #[inline]
    pub(crate) fn are_alike(&self, earlier: usize, point: usize) -> bool {
        (earlier + 1..=point).all(|later| self.starts >> later & 1 == 0)
    }

    /// The notebook of one of the points and of those after it that do not differ from it.
    #[inline]
    pub(crate) fn at_point(&self, point: usize) -> Notebook<'a> {
        let alike = (self.starts >> point >> 1).trailing_zeros();
        let bits = (1_u64 << alike.saturating_add(1).min(32)) - 1;
        Notebook {
            cells: self.cells,
            points: self.points & (bits << point) as u32,
            starts: !0,
            kept: self.kept_alone,
            kept_alone: self.kept_alone,
            trace: self.trace,
        }
    }
}
