//! Where the models of a block of points note limits and observed quantities.

use std::cell::Cell;

use super::{LANES, Lane};
use crate::loss::{Extent, Limit, NoteBase, Notes, Observed};

/// Where one model instance notes what it sees in the lanes of a block: what is the same in all of them, what a loop over the
/// lanes finds, or what one lane after the other finds. Each lane counts as a point.
#[derive(Clone, Copy)]
pub struct LaneNotes<'a> {
    pub(crate) common: Notes<'a>,
    /// Cells of each lane, one lane after the other.
    pub(crate) own: &'a [Cell<Extent>],
    pub(crate) totals: &'a [Cell<Extent>],
    /// Lanes that count.
    pub(crate) counted: &'a [bool; LANES],
    pub(crate) outside: &'a [Cell<bool>; LANES],
    /// Set where cells of lanes were handed out.
    pub(crate) handed: &'a Cell<bool>,
    pub(crate) base: NoteBase,
}

impl<'a> LaneNotes<'a> {
    /// Notes of what is the same in all lanes.
    pub fn all(&self) -> Notes<'a> {
        self.common
    }

    /// Notes of one lane.
    pub fn lane(&self, lane: usize) -> Notes<'a> {
        self.handed.set(true);
        let width = self.own.len() / LANES;
        self.common.into(&self.own[lane * width..(lane + 1) * width])
    }

    /// The same for the model of a nested slot.
    pub fn of(self, base: NoteBase) -> Self {
        Self {
            base,
            common: self.common.of(base),
            ..self
        }
    }

    /// Notes whether values, from the least to the greatest of each lane in the limit's unit, lie in its stated range. Once for a
    /// limit in a block.
    #[inline]
    pub fn check(&self, limit: &Limit, least: &Lane, greatest: &Lane) {
        self.see(self.base.limits + limit.index, least, greatest, &[true; LANES], |x| {
            x >= limit.least && x <= limit.greatest
        });
    }

    /// The same for one value in each of some lanes.
    #[inline]
    pub fn check_where(&self, limit: &Limit, values: &Lane, lanes: &[bool; LANES]) {
        self.see(self.base.limits + limit.index, values, values, lanes, |x| {
            x >= limit.least && x <= limit.greatest
        });
    }

    /// Notes the least and the greatest value of an observed quantity in each lane, in its unit. Once for a quantity in a block.
    #[inline]
    pub fn observe(&self, observed: &Observed, least: &Lane, greatest: &Lane) {
        self.see(
            self.base.observed + observed.index,
            least,
            greatest,
            &[true; LANES],
            |_| true,
        );
    }

    /// True where values from the least to the greatest of any lane that counts go beyond what was seen of an observed quantity.
    pub fn widens(&self, observed: &Observed, least: &Lane, greatest: &Lane) -> bool {
        let Some(cell) = self.totals.get(self.base.observed + observed.index) else {
            return false;
        };
        let seen = cell.get();
        (0..LANES).any(|i| self.counted[i] && !(least[i] >= seen.least && greatest[i] <= seen.greatest))
    }

    #[inline(always)]
    fn see(&self, cell: usize, least: &Lane, greatest: &Lane, lanes: &[bool; LANES], inside: impl Fn(f64) -> bool) {
        let Some(cell) = self.totals.get(cell) else { return };
        let mut total = cell.get();
        for i in 0..LANES {
            if self.counted[i] && lanes[i] {
                let out = !(inside(least[i]) && inside(greatest[i]));
                total = total.merge(Extent::point(least[i], greatest[i], out));
                if out {
                    self.outside[i].set(true);
                }
            }
        }
        cell.set(total);
    }
}
