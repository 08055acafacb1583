//! Where all model instances of a transmission write in one pass.

use std::cell::Cell;

use super::{Extent, MOST_KEPT, NoteBase, Notes, Trace};

/// Cells of what all instances note, places for what they keep, and the steps of an explanation. Made once for a pass; the notes
/// of each instance are made of it where its context is.
#[derive(Debug, Clone, Copy)]
pub struct Notebook<'a> {
    /// Cells of limits and observed quantities; without them nothing is noted.
    pub(crate) cells: &'a [Cell<Extent>],
    /// Places for what each instance computes [once](Notes::once), not a number where nothing was yet; without them nothing is kept.
    pub(crate) kept: &'a [Cell<[f64; MOST_KEPT]>],
    /// Where steps are written down.
    pub(crate) trace: Option<&'a Trace>,
}

impl<'a> Notebook<'a> {
    /// Nothing is noted or kept.
    pub const CLOSED: Notebook<'static> = Notebook {
        cells: &[],
        kept: &[],
        trace: None,
    };

    /// Notes of one instance, which add to what it has noted.
    #[inline]
    pub fn notes(&self, base: NoteBase) -> Notes<'a> {
        Notes { base, book: *self }
    }

    /// Forgets what one instance and those nested in it have noted.
    #[inline]
    pub(crate) fn clear(&self, base: NoteBase) {
        for cell in self.cells.get(base.limits()..base.end()).unwrap_or_default() {
            cell.set(Extent::EMPTY);
        }
    }
}
