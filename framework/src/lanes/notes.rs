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

/// Whether a model notes the same for points alone and side by side: `single` asks for one lane, `together` for all.
pub(crate) fn same_notes(
    base: NoteBase,
    single: impl Fn(usize, Notes<'_>),
    together: impl FnOnce(LaneNotes<'_>),
) -> bool {
    let width = base.end;
    let mut spaces: [Vec<Extent>; 4] = std::array::from_fn(|_| vec![Extent::EMPTY; width]);
    let [alone, sums, common, totals] = spaces
        .each_mut()
        .map(|space| Cell::from_mut(space.as_mut_slice()).as_slice_of_cells());
    let add = |sums: &[Cell<Extent>], cells: &[Cell<Extent>], points: u32| {
        for (sum, cell) in sums.iter().zip(cells).filter(|(_, cell)| cell.get().seen > 0) {
            sum.set(sum.get().merge(cell.get().times(points)));
        }
    };
    for lane in 0..LANES {
        single(lane, Notes::fresh(alone, base));
        add(sums, alone, 1);
    }
    let mut own = vec![Extent::EMPTY; LANES * width];
    let own = Cell::from_mut(own.as_mut_slice()).as_slice_of_cells();
    together(LaneNotes {
        common: Notes::new(common, base),
        own,
        totals,
        counted: &[true; LANES],
        outside: &std::array::from_fn(|_| Cell::new(false)),
        handed: &Cell::new(false),
        base,
    });
    add(totals, common, LANES as u32);
    for cells in own.chunks(width.max(1)) {
        add(totals, cells, 1);
    }
    sums.iter().map(Cell::get).eq(totals.iter().map(Cell::get))
}

impl<'a> LaneNotes<'a> {
    /// Notes of what is the same in all lanes.
    pub fn all(&self) -> Notes<'a> {
        self.common
    }

    /// False where nobody reads what a lane notes.
    pub fn wanted(&self, lane: usize) -> bool {
        self.counted[lane]
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
