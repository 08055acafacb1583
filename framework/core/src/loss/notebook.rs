//! Note cells of all model instances of a transmission in one iteration.

use std::cell::Cell;

use super::{Extent, MOST_KEPT, NoteBase, Notes, Trace};

/// Cells for the notes of all instances, space for the values that they keep, and the steps of an explanation. Made once per
/// iteration; the notes of each instance are derived from it.
#[derive(Debug, Clone, Copy)]
pub struct Notebook<'a> {
    /// Cells of limits and observed quantities; without them nothing is noted.
    pub(crate) cells: &'a [Cell<Extent>],
    /// Space for the values that each instance computes [once](Notes::once), initially NaN; without it nothing is kept.
    pub(crate) kept: &'a [Cell<[f64; MOST_KEPT]>],
    /// Target of recorded steps.
    pub(crate) trace: Option<&'a Trace>,
}

impl<'a> Notebook<'a> {
    /// Nothing is noted or kept.
    pub const CLOSED: Notebook<'static> = Notebook {
        cells: &[],
        kept: &[],
        trace: None,
    };

    /// Notes of one instance, added to its previous notes.
    #[inline]
    pub fn notes(&self, base: NoteBase) -> Notes<'a> {
        Notes { base, book: *self }
    }

    /// Clears the notes of one instance and of those nested in it.
    #[inline]
    pub(crate) fn clear(&self, base: NoteBase) {
        for cell in self.cells.get(base.limits()..base.end()).unwrap_or_default() {
            cell.set(Extent::EMPTY);
        }
    }
}
