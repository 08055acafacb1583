//! Numbers and conditions of several points, so that one instruction serves several of them.
//!
//! A loop over the numbers of a lane without calls or branches becomes a few wide instructions within [`Points::wide`]; only code that
//! is inlined into it uses them, so everything here is `#[inline(always)]`.

use std::ops::{Add, AddAssign, BitAnd, BitOr, Deref, Div, Mul, Neg, Not, Sub, SubAssign};

use super::{Mask, Points, Real, elementary};

/// Points that are evaluated together. Sixteen numbers fill two of the widest registers, enough to hide the latency of an operation;
/// with more, intermediate results of a law no longer fit into registers, with fewer, the fixed cost of an evaluation weighs more.
pub const LANES: usize = 16;

/// A number for each of several points.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Lane([f64; LANES]);

/// A condition for each of several points: all bits set, or none, as wide as the numbers that it selects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(64))]
pub struct LaneMask([u64; LANES]);

impl Deref for Lane {
    type Target = [f64; LANES];
    #[inline(always)]
    fn deref(&self) -> &[f64; LANES] {
        &self.0
    }
}

impl Default for Lane {
    fn default() -> Self {
        Self([0.0; LANES])
    }
}

impl Lane {
    /// A function of each number.
    #[inline(always)]
    pub fn map(mut self, mut number: impl FnMut(f64) -> f64) -> Self {
        for x in &mut self.0 {
            *x = number(*x);
        }
        self
    }

    /// A number from two.
    #[inline(always)]
    fn with(mut self, other: Self, number: impl Fn(f64, f64) -> f64) -> Self {
        for (x, other) in self.0.iter_mut().zip(other.0) {
            *x = number(*x, other);
        }
        self
    }

    #[inline(always)]
    fn compare(self, other: Self, holds: impl Fn(f64, f64) -> bool) -> LaneMask {
        let mut mask = LaneMask([0; LANES]);
        for ((bits, a), b) in mask.0.iter_mut().zip(self.0).zip(other.0) {
            *bits = if holds(a, b) { !0 } else { 0 };
        }
        mask
    }
}

macro_rules! operators {
    ($($Operator:ident $operator:ident),+) => {$(
        impl $Operator for Lane {
            type Output = Self;
            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                self.with(other, |a, b| a.$operator(b))
            }
        }
        impl $Operator<f64> for Lane {
            type Output = Self;
            #[inline(always)]
            fn $operator(self, other: f64) -> Self {
                self.map(|a| a.$operator(other))
            }
        }
    )+};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Lane {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl AddAssign for Lane {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lane {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl BitAnd for LaneMask {
    type Output = Self;
    #[inline(always)]
    fn bitand(mut self, other: Self) -> Self {
        for (bits, other) in self.0.iter_mut().zip(other.0) {
            *bits &= other;
        }
        self
    }
}

impl BitOr for LaneMask {
    type Output = Self;
    #[inline(always)]
    fn bitor(mut self, other: Self) -> Self {
        for (bits, other) in self.0.iter_mut().zip(other.0) {
            *bits |= other;
        }
        self
    }
}

impl Not for LaneMask {
    type Output = Self;
    #[inline(always)]
    fn not(mut self) -> Self {
        for bits in &mut self.0 {
            *bits = !*bits;
        }
        self
    }
}

impl Mask for LaneMask {
    const NEVER: Self = Self([0; LANES]);
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().fold(0, |all, bits| all | bits) != 0
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0.iter().fold(!0, |all, bits| all & bits) != 0
    }
    #[inline(always)]
    fn at_point(self, point: usize) -> bool {
        self.0[point] != 0
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        let mut bits = 0;
        for (point, mask) in self.0.iter().enumerate() {
            bits |= (*mask as u32 & 1) << point;
        }
        bits
    }
}

impl Real for Lane {
    type Mask = LaneMask;
    const ZERO: Self = Self([0.0; LANES]);
    const HALF: Self = Self([0.5; LANES]);
    #[inline(always)]
    fn is_within(self, least: f64, greatest: f64) -> LaneMask {
        self.test(|x| x >= least && x <= greatest)
    }
    #[inline(always)]
    fn extremes(self, points: u32) -> (f64, f64) {
        let (mut least, mut greatest) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        for (point, x) in self.0.into_iter().enumerate() {
            // What is not a number is no extreme.
            let x = if points >> point & 1 == 1 { x } else { f64::NAN };
            least[point] = if x < f64::INFINITY { x } else { f64::INFINITY };
            greatest[point] = if x > f64::NEG_INFINITY { x } else { f64::NEG_INFINITY };
        }
        // Halves with each other: the comparisons of a half do not wait for each other.
        let mut half = LANES;
        while half > 1 {
            half /= 2;
            for point in 0..half {
                let [low, high] = [least[point + half], greatest[point + half]];
                least[point] = if low < least[point] { low } else { least[point] };
                greatest[point] = if high > greatest[point] { high } else { greatest[point] };
            }
        }
        (least[0], greatest[0])
    }
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self([x; LANES])
    }
    #[inline(always)]
    fn is_below(self, other: Self) -> LaneMask {
        self.compare(other, |a, b| a < b)
    }
    #[inline(always)]
    fn is_equal(self, other: Self) -> LaneMask {
        self.compare(other, |a, b| a == b)
    }
    #[inline(always)]
    fn select(mask: LaneMask, mut then: Self, other: Self) -> Self {
        for ((x, mask), other) in then.0.iter_mut().zip(mask.0).zip(other.0) {
            *x = f64::from_bits(x.to_bits() & mask | other.to_bits() & !mask);
        }
        then
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn cbrt(self) -> Self {
        self.map(elementary::cbrt)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.map(elementary::exp)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(elementary::ln)
    }
    #[inline(always)]
    fn sine(self) -> Self {
        self.map(elementary::sine)
    }
    #[inline(always)]
    fn end_pass() {
        // It has no instruction, but the compiler must assume that it reads and writes memory, so it does not merge passes.
        std::hint::black_box(());
    }
    #[inline(always)]
    fn lift(self, function: impl Fn(f64) -> f64) -> Self {
        let [lifted] = self.lift_all(0.0, |x| [function(x)]);
        lifted
    }
    #[inline(always)]
    fn lift_all<const N: usize>(self, _least_step: f64, function: impl Fn(f64) -> [f64; N]) -> [Self; N] {
        let mut all = [Self::ZERO; N];
        let mut results = function(self.0[0]);
        for point in 0..LANES {
            // Points often have it in common, and such functions are long.
            if point > 0 && self.0[point].to_bits() != self.0[point - 1].to_bits() {
                results = function(self.0[point]);
            }
            for (lane, result) in all.iter_mut().zip(results) {
                lane.0[point] = result;
            }
        }
        all
    }
}

impl Points for Lane {
    const COUNT: usize = LANES;
    #[inline(always)]
    fn each(mut number: impl FnMut(usize) -> f64) -> Self {
        let mut lane = Self([0.0; LANES]);
        for (point, x) in lane.0.iter_mut().enumerate() {
            *x = number(point);
        }
        lane
    }
    #[inline(always)]
    fn mask(mut holds: impl FnMut(usize) -> bool) -> LaneMask {
        let mut mask = LaneMask([0; LANES]);
        for (point, bits) in mask.0.iter_mut().enumerate() {
            *bits = if holds(point) { !0 } else { 0 };
        }
        mask
    }
    #[inline(always)]
    fn at_point(&self, point: usize) -> f64 {
        self.0[point]
    }
    #[inline(always)]
    fn set(&mut self, point: usize, x: f64) {
        self.0[point] = x;
    }
    #[inline(always)]
    fn test(self, mut holds: impl FnMut(f64) -> bool) -> LaneMask {
        let mut mask = LaneMask([0; LANES]);
        for (bits, x) in mask.0.iter_mut().zip(self.0) {
            *bits = if holds(x) { !0 } else { 0 };
        }
        mask
    }
    #[inline(always)]
    fn wide<T>(work: impl FnOnce() -> T) -> T {
        // Three copies of every law for three widths of registers are half of the compile time of the tests. They have the same bits, see
        // `elementary.rs`.
        if cfg!(debug_assertions) {
            work()
        } else {
            super::registers::arch().dispatch(work)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_neighbours_share_a_call_and_have_the_values_of_each() {
        let numbers = [1.0, 1.0, 2.0, f64::NAN, f64::NAN, 0.0, -0.0, 2.0];
        let lane = Lane::each(|point| numbers[point % numbers.len()]);
        let calls = std::cell::Cell::new(0);
        let roots = lane.lift(|x| {
            calls.set(calls.get() + 1);
            1.0 / x
        });
        for point in 0..LANES {
            assert_eq!(roots[point].to_bits(), (1.0 / lane[point]).to_bits());
        }
        assert_eq!(calls.get(), 6 * LANES / numbers.len());
    }
}
