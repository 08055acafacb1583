//! Points side by side: numbers in lanes, so that one instruction serves several points.
//!
//! Points that share speeds and temperatures differ in torque alone. Their losses are computed in blocks of [`LANES`] points:
//! each quantity that hangs on torque is a [`Lane`], a number for each of them. A loop over the numbers of a lane without calls
//! or branches becomes a few wide instructions within [`wide`]. Every operation is the one of a single point, in the same order,
//! so that both ways have the same bits.

mod elementary;
mod losses;
mod notes;

use std::ops::{Deref, DerefMut};

pub use elementary::{cube_root, exp, ln, sine};
pub use losses::LossLanes;
pub use notes::LaneNotes;
pub(crate) use notes::same_notes;

/// Points of a block.
pub const LANES: usize = 64;

/// A number for each point of a block. It begins where wide loads and stores like it best.
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

/// Runs work with the widest instructions that the processor has: `wide(#[inline(always)] || ...)`. Only what is inlined into the
/// work gets them, which functions are that say `#[inline(always)]`.
#[inline(always)]
pub fn wide<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}

/// A lane from a function of the numbers of another. What [`array::map`] does, and sure to be inlined.
#[inline(always)]
pub fn over(lane: &Lane, mut number: impl FnMut(f64) -> f64) -> Lane {
    let mut result = Lane::ZERO;
    for (own, x) in result.0.iter_mut().zip(&lane.0) {
        *own = number(*x);
    }
    result
}

/// In how many lanes something holds.
#[inline(always)]
pub fn count(mut holds: impl FnMut(usize) -> bool) -> u64 {
    // As wide as the numbers that decide, so that they are counted several at once.
    let mut count = 0_u64;
    for i in 0..LANES {
        count += u64::from(holds(i));
    }
    count
}

/// A lane from a function of its place.
#[inline(always)]
pub fn each(mut number: impl FnMut(usize) -> f64) -> Lane {
    let mut lane = Lane::ZERO;
    for (i, own) in lane.0.iter_mut().enumerate() {
        *own = number(i);
    }
    lane
}
