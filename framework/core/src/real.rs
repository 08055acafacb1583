//! Arithmetic of laws: one text for one point and for several points at once.
//!
//! A law that is written over [`Real`] serves `f64`, one point, [`Lane`], several points of a batch, and [`Dual`], one point with
//! derivatives, with the same operations in the same order, so that a point has the same bits wherever it is evaluated. Where points may take different branches, the law
//! selects by a [`Mask`]; where they seldom do, it asks whether they [agree](Mask::agreed), and the framework evaluates points that
//! do not one by one.

mod dual;
mod elementary;
mod lane;
mod registers;
mod stencil;

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

pub use dual::{DIRECTIONS, Dual};
pub use elementary::{cbrt, exp, ln, sine};
pub use lane::{LANES, Lane, LaneMask};
pub use registers::{LIMIT, WIDTHS, registers};
pub use stencil::Stencil;

use crate::loss::Undefined;

mod sealed {
    /// Only the framework has numbers of laws and their conditions.
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for super::Lane {}
    impl Sealed for super::Dual {}
    impl Sealed for bool {}
    impl Sealed for super::LaneMask {}
}

/// A number of a law: of one point, or of each of several points. Sealed.
///
/// Arithmetic with an `f64` is on the right: `x * 2.0`. Powers, exponentials and logarithms have the same bits for one point and for
/// several; they differ from those of the standard library in the last digits.
///
/// Functions have the names of those of `f64`, which on a plain `f64` win over these: write [`exp(x)`](exp), [`ln(x)`](ln),
/// [`cbrt(x)`](cbrt) or `Real::min(x, y)` where `x` is one, because `x.exp()` and the others there are those of the standard library,
/// with other last digits and another rule for NaN.
pub trait Real:
    sealed::Sealed
    + Copy
    + Debug
    + Default
    + Send
    + Sync
    + 'static
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// A condition at each point.
    type Mask: Mask;
    /// Zero.
    const ZERO: Self;
    /// One half.
    const HALF: Self;
    /// The same number at each point.
    fn constant(x: f64) -> Self;
    /// True where it is below another number; false for NaN, as all comparisons.
    fn is_below(self, other: Self) -> Self::Mask;
    /// True where it is above another number.
    #[inline(always)]
    fn is_above(self, other: Self) -> Self::Mask {
        other.is_below(self)
    }
    /// True where both are equal.
    fn is_equal(self, other: Self) -> Self::Mask;
    /// True where it is zero.
    #[inline(always)]
    fn is_zero(self) -> Self::Mask {
        self.is_equal(Self::ZERO)
    }
    /// True where it is in a range; false for NaN.
    fn is_within(self, least: f64, greatest: f64) -> Self::Mask;
    /// Minimum and maximum over the points of some bits; NaN is ignored.
    fn extremes(self, points: u32) -> (f64, f64);
    /// One number where a condition holds, the other elsewhere.
    fn select(mask: Self::Mask, then: Self, other: Self) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The cube root of a normal positive number or of zero.
    fn cbrt(self) -> Self;
    /// The exponential.
    fn exp(self) -> Self;
    /// The natural logarithm; minus infinity at zero.
    fn ln(self) -> Self;
    /// The sine for angles of at most 45 degrees to either side.
    fn sine(self) -> Self;
    /// A function of each number that is not written over [`Real`], such as one read from a table. It may be called once for several
    /// points with the same number. Its derivatives are found by differences.
    fn lift(self, function: impl Fn(f64) -> f64) -> Self;
    /// The same for several results of one function, such as the properties of an oil at a temperature.
    /// `least_step` is the step of the differences at zero.
    fn lift_all<const N: usize>(self, least_step: f64, function: impl Fn(f64) -> [f64; N]) -> [Self; N];
    /// A power of a number that is not negative; zero of zero for a positive exponent.
    #[inline(always)]
    fn power(self, exponent: f64) -> Self {
        (self.ln() * exponent).exp()
    }
    /// The smaller of two numbers; the first if the other is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.is_below(self), other, self)
    }
    /// The larger of two numbers; the first if the other is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.is_above(self), other, self)
    }
    /// Marks the end of each pass of a loop that computes one number per pass. Without it, the compiler may let one instruction compute
    /// the same point of several passes instead of several points of one pass; to gather the numbers of [`Lane`]s in that order takes
    /// longer than the passes.
    #[inline(always)]
    fn end_pass() {}
    /// The number, at least another one.
    #[inline(always)]
    fn at_least(self, least: f64) -> Self {
        self.max(Self::constant(least))
    }
    /// The number, at most another one.
    #[inline(always)]
    fn at_most(self, greatest: f64) -> Self {
        self.min(Self::constant(greatest))
    }
}

/// A condition at each point. Sealed.
pub trait Mask:
    sealed::Sealed + Copy + Debug + Send + Sync + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// It holds at no point.
    const NEVER: Self;
    /// True if it holds at any point.
    fn any(self) -> bool;
    /// True if it holds at every point.
    fn all(self) -> bool;
    /// The condition at one point.
    fn at_point(self, point: usize) -> bool;
    /// The condition at all points; the error if it holds at some points only, which are then evaluated one by one.
    ///
    /// # Errors
    /// If the points disagree.
    #[inline(always)]
    fn agreed(self) -> Result<bool, Undefined> {
        if self.all() {
            Ok(true)
        } else if self.any() {
            Err(Undefined::DISAGREED)
        } else {
            Ok(false)
        }
    }
    /// One bit for each point; a condition that one point is asked for, alone or among others, has all bits.
    fn bits(self) -> u32;
}

/// Numbers of points that are evaluated together: access to each point, for the parts of the framework that are not laws.
pub trait Points: Real {
    /// How many.
    const COUNT: usize;
    /// The numbers of all points from those of each; they have no derivatives.
    fn each(number: impl FnMut(usize) -> f64) -> Self;
    /// Several numbers of all points from those of each.
    #[inline(always)]
    fn each_of<const N: usize>(mut numbers: impl FnMut(usize) -> [f64; N]) -> [Self; N] {
        let mut all = [[0.0; N]; LANES];
        for (point, of_point) in all.iter_mut().enumerate().take(Self::COUNT) {
            *of_point = numbers(point);
        }
        std::array::from_fn(|i| Self::each(|point| all[point][i]))
    }
    /// The conditions of all points from those of each.
    fn mask(holds: impl FnMut(usize) -> bool) -> Self::Mask;
    /// The number of one point.
    fn at_point(&self, point: usize) -> f64;
    /// Changes the number of one point, to one without derivatives.
    fn set(&mut self, point: usize, x: f64);
    /// True where a condition on each number holds.
    fn test(self, holds: impl FnMut(f64) -> bool) -> Self::Mask;
    /// One bit for each point where a condition holds.
    #[inline(always)]
    fn bits(mask: Self::Mask) -> u32 {
        mask.bits() & ((1 << Self::COUNT) - 1)
    }
    /// Runs work that is inlined into it with the widest instructions of the processor, if that serves several points at once.
    fn wide<T>(work: impl FnOnce() -> T) -> T;
}

impl Mask for bool {
    const NEVER: Self = false;
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
    #[inline(always)]
    fn at_point(self, _point: usize) -> bool {
        self
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        if self { !0 } else { 0 }
    }
}

impl Real for f64 {
    type Mask = bool;
    const ZERO: Self = 0.0;
    const HALF: Self = 0.5;
    #[inline(always)]
    fn is_within(self, least: f64, greatest: f64) -> bool {
        self >= least && self <= greatest
    }
    #[inline(always)]
    fn extremes(self, points: u32) -> (f64, f64) {
        // NaN is neither.
        if points == 0 || self.is_nan() {
            (f64::INFINITY, f64::NEG_INFINITY)
        } else {
            (self, self)
        }
    }
    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn is_below(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn is_equal(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn select(mask: bool, then: Self, other: Self) -> Self {
        if mask { then } else { other }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn cbrt(self) -> Self {
        cbrt(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        ln(self)
    }
    #[inline(always)]
    fn sine(self) -> Self {
        sine(self)
    }
    #[inline(always)]
    fn lift(self, function: impl Fn(f64) -> f64) -> Self {
        function(self)
    }
    #[inline(always)]
    fn lift_all<const N: usize>(self, _least_step: f64, function: impl Fn(f64) -> [f64; N]) -> [Self; N] {
        function(self)
    }
}

impl Points for f64 {
    const COUNT: usize = 1;
    #[inline(always)]
    fn each(mut number: impl FnMut(usize) -> f64) -> Self {
        number(0)
    }
    #[inline(always)]
    fn mask(mut holds: impl FnMut(usize) -> bool) -> bool {
        holds(0)
    }
    #[inline(always)]
    fn at_point(&self, _point: usize) -> f64 {
        *self
    }
    #[inline(always)]
    fn set(&mut self, _point: usize, x: f64) {
        *self = x;
    }
    #[inline(always)]
    fn test(self, mut holds: impl FnMut(f64) -> bool) -> bool {
        holds(self)
    }
    #[inline(always)]
    fn wide<T>(work: impl FnOnce() -> T) -> T {
        work()
    }
}
