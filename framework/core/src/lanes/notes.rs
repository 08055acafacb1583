//! Notes of the models of a block of points: limits and observed quantities.

use std::cell::Cell;

use super::{LANES, Lane, count, wide};
use crate::loss::{Extent, Limit, NoteBase, Notes, Observed};

/// Note target of one model instance for the lanes of a block: values that are common to all of them, the results of a loop over
/// the lanes, or those of individual lanes. Each lane counts as a point.
#[derive(Clone, Copy)]
pub struct LaneNotes<'a> {
    pub(crate) common: Notes<'a>,
    /// Cells of each lane, one lane after the other.
    pub(crate) own: &'a [Cell<Extent>],
    pub(crate) totals: &'a [Cell<Extent>],
    /// Active lanes, and their number.
    pub(crate) counted: &'a [bool; LANES],
    pub(crate) points: u32,
    pub(crate) outside: &'a [Cell<bool>; LANES],
    /// Set if cells of lanes were handed out.
    pub(crate) handed: &'a Cell<bool>,
    pub(crate) base: NoteBase,
}

/// True if a model writes the same notes for single points and for a batch: `single` evaluates one lane, `together` all lanes.
pub(crate) fn same_notes(
    base: NoteBase,
    single: impl Fn(usize, Notes<'_>),
    together: impl FnOnce(LaneNotes<'_>),
) -> bool {
    let width = base.end();
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
        points: LANES as u32,
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
    /// Target for values that are common to all lanes: no lane is active.
    pub(crate) fn for_a_row(self) -> Self {
        Self {
            own: &[],
            totals: &[],
            counted: &[false; LANES],
            points: 0,
            ..self
        }
    }

    /// Notes of values that are common to all lanes.
    pub fn all(&self) -> Notes<'a> {
        self.common
    }

    /// False if the notes of a lane are not used.
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
    pub fn nested(self, base: NoteBase) -> Self {
        Self {
            base,
            common: self.common.nested(base),
            ..self
        }
    }

    /// Notes whether values, from minimum to maximum of each lane in the limit's unit, are in its stated range. Once per limit in a
    /// block.
    #[inline]
    pub fn check(&self, limit: &Limit, least: &Lane, greatest: &Lane) {
        self.see(self.base.limits() + limit.index, least, greatest, Some(limit));
    }

    /// The same for one value in each of some lanes.
    #[inline]
    pub fn check_where(&self, limit: &Limit, values: &Lane, lanes: &[bool; LANES]) {
        let Some(cell) = self.totals.get(self.base.limits() + limit.index) else {
            return;
        };
        for i in (0..LANES).filter(|i| lanes[*i] && self.counted[*i]) {
            let out = !(values[i] >= limit.least && values[i] <= limit.greatest);
            cell.set(cell.get().merge(Extent::point(values[i], values[i], out)));
            if out {
                self.outside[i].set(true);
            }
        }
    }

    /// Notes the minimum and maximum of an observed quantity in each lane, in its unit. Once per quantity in a block.
    #[inline]
    pub fn observe(&self, observed: &Observed, least: &Lane, greatest: &Lane) {
        self.see(self.base.observed() + observed.index, least, greatest, None);
    }

    /// Minimum and maximum of an observed quantity so far, over all blocks.
    pub fn seen(&self, observed: &Observed) -> (f64, f64) {
        let cell = self.totals.get(self.base.observed() + observed.index);
        let seen = cell.map_or(Extent::EMPTY, Cell::get);
        (seen.least, seen.greatest)
    }

    /// Minimum and maximum over the active lanes; `None` if one of them is NaN. A monotone function of the numbers has its own
    /// minimum and maximum there, for [`check_range`](Self::check_range) and [`observe_range`](Self::observe_range).
    pub fn range(&self, lane: &Lane) -> Option<(f64, f64)> {
        let ((least, greatest), unknown) = wide(
            #[inline(always)]
            || {
                let unknown = if self.points == LANES as u32 {
                    count(|i| lane[i].is_nan())
                } else {
                    count(|i| self.counted[i] & lane[i].is_nan())
                };
                (self.extremes(lane), unknown)
            },
        );
        (unknown == 0 && self.points > 0).then_some((least, greatest))
    }

    /// As [`check`](Self::check) for the range over all lanes of the minimum of a lane, and of its maximum; false, without a note,
    /// if it does not show that all lanes are inside, or all outside on one side.
    pub fn check_range(&self, limit: &Limit, least: (f64, f64), greatest: (f64, f64)) -> bool {
        let all_inside = least.0 >= limit.least && greatest.1 <= limit.greatest;
        let all_outside = least.1 < limit.least || greatest.0 > limit.greatest;
        if all_outside {
            for (outside, counted) in self.outside.iter().zip(self.counted) {
                outside.set(outside.get() | counted);
            }
        }
        if all_inside || all_outside {
            let outside = if all_outside { self.points } else { 0 };
            self.merge(self.base.limits() + limit.index, least.0, greatest.1, outside);
        }
        all_inside || all_outside
    }

    /// As [`observe`](Self::observe) for the minimum and maximum over all lanes.
    pub fn observe_range(&self, observed: &Observed, least: f64, greatest: f64) {
        self.merge(self.base.observed() + observed.index, least, greatest, 0);
    }

    /// Minimum and maximum over the active lanes; NaN is ignored.
    #[inline(always)]
    fn extremes(&self, lane: &Lane) -> (f64, f64) {
        if self.points == LANES as u32 {
            extremes(lane, |_| true)
        } else {
            extremes(lane, |i| self.counted[i])
        }
    }

    fn merge(&self, cell: usize, least: f64, greatest: f64, outside: u32) {
        if let Some(cell) = self.totals.get(cell) {
            cell.set(cell.get().merge(Extent {
                least,
                greatest,
                seen: self.points,
                outside,
            }));
        }
    }

    fn see(&self, cell: usize, least: &Lane, greatest: &Lane, limit: Option<&Limit>) {
        let Some(cell) = self.totals.get(cell) else { return };
        let (mut seen, unknown) = wide(
            #[inline(always)]
            || {
                let mut seen = self.extremes(least);
                let mut unknown = count(|i| least[i].is_nan());
                if !std::ptr::eq(least, greatest) {
                    let others = self.extremes(greatest);
                    seen = (seen.0.min(others.0), seen.1.max(others.1));
                    unknown += count(|i| greatest[i].is_nan());
                }
                let seen = Extent {
                    least: seen.0,
                    greatest: seen.1,
                    seen: self.points,
                    outside: 0,
                };
                (seen, unknown)
            },
        );
        if let Some(limit) = limit {
            let inside = |x: f64| x >= limit.least && x <= limit.greatest;
            // Usually all lanes are active; otherwise it matters which are not.
            if unknown > 0 || !(inside(seen.least) && inside(seen.greatest)) {
                seen.outside = wide(
                    #[inline(always)]
                    || {
                        let out = |i: usize| self.counted[i] & !(inside(least[i]) & inside(greatest[i]));
                        for (i, outside) in self.outside.iter().enumerate() {
                            outside.set(outside.get() | out(i));
                        }
                        count(out) as u32
                    },
                );
            }
        }
        cell.set(cell.get().merge(seen));
    }
}

/// Minimum and maximum of some lanes; NaN is ignored.
#[inline(always)]
fn extremes(lane: &Lane, counts: impl Fn(usize) -> bool) -> (f64, f64) {
    /// The width of the widest instructions.
    const WIDE: usize = 8;
    let (mut least, mut greatest) = ([f64::INFINITY; WIDE], [f64::NEG_INFINITY; WIDE]);
    for (chunk, own) in lane.as_chunks::<WIDE>().0.iter().enumerate() {
        for i in 0..WIDE {
            let own = if counts(chunk * WIDE + i) { own[i] } else { f64::NAN };
            least[i] = if own < least[i] { own } else { least[i] };
            greatest[i] = if own > greatest[i] { own } else { greatest[i] };
        }
    }
    // Halves, which are independent of each other.
    let mut half = WIDE / 2;
    while half > 0 {
        for i in 0..half {
            let other = (least[i + half], greatest[i + half]);
            least[i] = if other.0 < least[i] { other.0 } else { least[i] };
            greatest[i] = if other.1 > greatest[i] { other.1 } else { greatest[i] };
        }
        half /= 2;
    }
    (least[0], greatest[0])
}
