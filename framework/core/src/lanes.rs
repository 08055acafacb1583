//! Batched points: numbers in lanes, so that one instruction serves several points.
//!
//! Points with equal speeds and temperatures differ only in torque. Their losses are computed in blocks of [`LANES`] points: each
//! quantity that depends on torque is a [`Lane`], with one number per point. A loop over the numbers of a lane without calls or
//! branches becomes a few wide instructions within [`wide`]. Every operation is that of a single point, in the same order, so that
//! both give the same bits unless [`Powers`] uses values of other points.

mod elementary;
mod losses;
mod notes;
mod powers;

use std::ops::{Deref, DerefMut};

pub use elementary::{cube_root, exp, ln, sine};
pub use losses::LossLanes;
pub use notes::LaneNotes;
pub(crate) use notes::same_notes;
pub use powers::Powers;
pub(crate) use powers::REMEMBERED;

/// Points of a block.
pub const LANES: usize = 64;

/// A number for each point of a block, aligned for wide loads and stores.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Lane([f64; LANES]);

impl Lane {
    /// Zero, in all lanes.
    pub const ZERO: Self = Self::all(0.0);

    /// One number, in all lanes.
    #[inline(always)]
    pub const fn all(number: f64) -> Self {
        Self([number; LANES])
    }
}

impl Deref for Lane {
    type Target = [f64; LANES];
    #[inline(always)]
    fn deref(&self) -> &[f64; LANES] {
        &self.0
    }
}

impl DerefMut for Lane {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; LANES] {
        &mut self.0
    }
}

/// Runs work with the widest instructions of the processor: `wide(#[inline(always)] || ...)`. Only code that is inlined into the
/// work uses them, that is, functions with `#[inline(always)]`.
#[inline(always)]
pub fn wide<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}

/// A lane from a function of the numbers of another; as [`array::map`], but always inlined.
#[inline(always)]
pub fn over(lane: &Lane, mut number: impl FnMut(f64) -> f64) -> Lane {
    let mut result = Lane::ZERO;
    for (own, x) in result.0.iter_mut().zip(&lane.0) {
        *own = number(*x);
    }
    result
}

/// Number of lanes for which a condition holds.
#[inline(always)]
pub fn count(mut holds: impl FnMut(usize) -> bool) -> u64 {
    // As wide as the compared numbers, so that several are counted at once.
    let mut count = 0_u64;
    for i in 0..LANES {
        count += u64::from(holds(i));
    }
    count
}

/// A lane from sums over some items: `step` adds an item to the `N` sums of a lane, given by its index, and `end` computes its
/// number from them, lane by lane. The sums of several lanes at a time stay in registers over all items; a loop over lanes for each
/// item would write and read them again.
#[inline(always)]
pub fn gather<const N: usize, T: Copy>(
    items: impl Iterator<Item = T> + Clone,
    start: [f64; N],
    step: impl Fn([f64; N], T, usize) -> [f64; N],
    mut end: impl FnMut([f64; N], usize) -> f64,
) -> Lane {
    /// Lanes at a time: a few of the widest registers per sum.
    const WIDE: usize = 16;
    let mut lane = Lane::ZERO;
    let mut first = 0;
    while first < LANES {
        let mut sums = [start; WIDE];
        for item in items.clone() {
            for i in 0..WIDE {
                sums[i] = step(sums[i], item, first + i);
            }
        }
        for i in 0..WIDE {
            lane.0[first + i] = end(sums[i], first + i);
        }
        first += WIDE;
    }
    lane
}

/// The maximum magnitude of some lanes, each times a factor; NaN is ignored.
#[inline(always)]
pub(crate) fn greatest<'a>(lanes: impl Iterator<Item = (f64, &'a Lane)> + Clone) -> Lane {
    let step = |[most]: [f64; 1], (factor, lane): (f64, &Lane), i: usize| {
        let own = (factor * lane[i]).abs();
        [if own > most { own } else { most }]
    };
    gather(lanes, [0.0], step, |[most], _| most)
}

/// The sum of some lanes, each times a factor.
#[inline(always)]
pub(crate) fn weighted<'a>(lanes: impl Iterator<Item = (f64, &'a Lane)> + Clone) -> Lane {
    let step = |[sum]: [f64; 1], (factor, lane): (f64, &Lane), i: usize| [sum + factor * lane[i]];
    gather(lanes, [0.0], step, |[sum], _| sum)
}

/// True if all lanes have the same number.
#[inline(always)]
pub(crate) fn is_even(lane: &Lane) -> bool {
    let first = lane[0];
    count(|i| lane[i] == first) == LANES as u64
}

/// A lane from a function of its index.
#[inline(always)]
pub fn each(mut number: impl FnMut(usize) -> f64) -> Lane {
    let mut lane = Lane::ZERO;
    for (i, own) in lane.0.iter_mut().enumerate() {
        *own = number(i);
    }
    lane
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_over_items_are_those_of_each_lane() {
        let lanes: Vec<Lane> = (0..7).map(|k| each(|i| (i as f64 - 20.0) * f64::from(k - 3))).collect();
        let weights = [0.5, -1.0, 2.0, 0.0, 3.0, 1.0, -0.25];
        for n in 0..=lanes.len() {
            let items = weights[..n].iter().copied().zip(&lanes);
            let (sums, most) = (weighted(items.clone()), greatest(items.clone()));
            for i in 0..LANES {
                let terms = items.clone().map(|(weight, lane)| weight * lane[i]);
                assert_eq!(sums[i], terms.clone().sum::<f64>());
                assert_eq!(most[i], terms.map(f64::abs).fold(0.0, f64::max));
            }
        }
        assert_eq!(greatest([(1.0, &Lane::all(f64::NAN))].into_iter()), Lane::ZERO);
    }

    #[test]
    fn lanes_are_even_where_all_numbers_are_the_same() {
        assert!(is_even(&Lane::all(-2.0)) && is_even(&Lane::ZERO));
        let mut lane = Lane::all(3.0);
        lane[LANES / 2] = 4.0;
        assert!(!is_even(&lane) && !is_even(&each(|i| i as f64)) && !is_even(&Lane::all(f64::NAN)));
    }
}
