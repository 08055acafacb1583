//! Numbers with derivatives.
//!
//! A [`Dual`] carries the derivatives of a number along a few directions, and every operation carries them on by the rules of
//! calculus. Its value goes through the operations of `f64` in the same order, so that it has the same bits. A law that is written
//! over [`Real`] therefore has exact derivatives without a further line.
//!
//! A function that is not written over [`Real`] is differentiated by differences. Their error is estimated by a second computation:
//! the directions are pairs, and the second of a pair uses [twice the step](Dual::step_factor). A caller that gives both the same
//! derivatives at the start finds the error as their difference at the end, after everything that lies in between; where no
//! differences are involved, both have the same bits.

use std::convert::Infallible;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::{Points, Real, Stencil};

/// Number of directions of a [`Dual`]: as many as fill the widest register of most processors.
pub const DIRECTIONS: usize = 4;

/// A number with its derivatives along some directions.
///
/// Where the value of a product, quotient or function is not finite, and at the infinite slope of a root, power or logarithm at zero, derivatives are zero, so that a
/// value that does not depend on that number has no undefined derivative. The derivative of the magnitude at zero is the mean of both
/// sides, zero. Where a law selects, the derivative is that of the selected branch.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dual {
    /// The number.
    pub value: f64,
    /// Its derivatives.
    pub slopes: [f64; DIRECTIONS],
}

impl Dual {
    /// A number with the same derivative along both directions of a pair, and none along the others.
    pub fn variable(value: f64, pair: usize) -> Self {
        let slope = |direction: usize| if direction / 2 == pair { 1.0 } else { 0.0 };
        Self {
            value,
            slopes: std::array::from_fn(slope),
        }
    }

    /// True if it does not change along any direction.
    pub fn is_constant(&self) -> bool {
        self.slopes == [0.0; DIRECTIONS]
    }

    /// The factor on the step of differences along a direction.
    pub fn step_factor(direction: usize) -> f64 {
        if direction.is_multiple_of(2) { 1.0 } else { 2.0 }
    }

    /// The derivatives of a product.
    #[inline]
    fn product_rule(self, other: Self) -> [f64; DIRECTIONS] {
        std::array::from_fn(|i| self.slopes[i] * other.value + self.value * other.slopes[i])
    }

    /// A function of the number with its derivative.
    #[inline]
    fn follow(self, value: f64, derivative: f64) -> Self {
        // The derivative is infinite where a root or power starts, and undefined where the value is.
        let derivative = if derivative.is_finite() { derivative } else { 0.0 };
        Self {
            value,
            slopes: self.slopes.map(|slope| slope * derivative),
        }
    }
}

impl Neg for Dual {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            slopes: self.slopes.map(|slope| -slope),
        }
    }
}

impl Add for Dual {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slopes: std::array::from_fn(|i| self.slopes[i] + other.slopes[i]),
        }
    }
}

impl Sub for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slopes: std::array::from_fn(|i| self.slopes[i] - other.slopes[i]),
        }
    }
}

impl Mul for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        if !value.is_finite() {
            return Self::constant(value);
        }
        Self {
            value,
            slopes: self.product_rule(other),
        }
    }
}

impl Div for Dual {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        if !value.is_finite() {
            return Self::constant(value);
        }
        Self {
            value,
            slopes: std::array::from_fn(|i| (self.slopes[i] - value * other.slopes[i]) / other.value),
        }
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    #[inline]
    fn add(self, other: f64) -> Self {
        Self {
            value: self.value + other,
            ..self
        }
    }
}

impl Sub<f64> for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, other: f64) -> Self {
        Self {
            value: self.value - other,
            ..self
        }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        Self {
            value: self.value * other,
            slopes: self.slopes.map(|slope| slope * other),
        }
    }
}

impl Div<f64> for Dual {
    type Output = Self;
    #[inline]
    fn div(self, other: f64) -> Self {
        let value = self.value / other;
        if !value.is_finite() {
            return Self::constant(value);
        }
        Self {
            value,
            slopes: self.slopes.map(|slope| slope / other),
        }
    }
}

impl AddAssign for Dual {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Dual {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Dual {
    type Mask = bool;
    const ZERO: Self = Self {
        value: 0.0,
        slopes: [0.0; DIRECTIONS],
    };
    const HALF: Self = Self {
        value: 0.5,
        slopes: [0.0; DIRECTIONS],
    };
    #[inline]
    fn is_within(self, least: f64, greatest: f64) -> bool {
        self.value.is_within(least, greatest)
    }
    #[inline]
    fn extremes(self, points: u32) -> (f64, f64) {
        self.value.extremes(points)
    }
    #[inline]
    fn constant(x: f64) -> Self {
        Self {
            value: x,
            slopes: [0.0; DIRECTIONS],
        }
    }
    #[inline]
    fn is_below(self, other: Self) -> bool {
        self.value < other.value
    }
    #[inline]
    fn is_equal(self, other: Self) -> bool {
        self.value == other.value
    }
    #[inline]
    fn select(mask: bool, then: Self, other: Self) -> Self {
        if mask { then } else { other }
    }
    #[inline]
    fn abs(self) -> Self {
        let sign = if self.value > 0.0 {
            1.0
        } else if self.value < 0.0 {
            -1.0
        } else {
            0.0
        };
        self.follow(self.value.abs(), sign)
    }
    // Not inlined: derivatives are computed seldom, and the code of these is long.
    #[inline(never)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.follow(root, 0.5 / root)
    }
    #[inline(never)]
    fn cbrt(self) -> Self {
        let root = super::cbrt(self.value);
        self.follow(root, 1.0 / (3.0 * root * root))
    }
    #[inline(never)]
    fn exp(self) -> Self {
        let value = super::exp(self.value);
        self.follow(value, value)
    }
    #[inline(never)]
    fn ln(self) -> Self {
        self.follow(super::ln(self.value), 1.0 / self.value)
    }
    #[inline(never)]
    fn sine(self) -> Self {
        let sine = self.value.sine();
        // The angle is at most 45 degrees, where the cosine is far from zero.
        self.follow(sine, (1.0 - sine * sine).sqrt())
    }
    #[inline(never)]
    fn power(self, exponent: f64) -> Self {
        let value = self.value.power(exponent);
        let derivative = if exponent == 1.0 {
            1.0
        } else if self.value > 0.0 {
            exponent * value / self.value
        } else {
            0.0
        };
        self.follow(value, derivative)
    }
    fn lift(self, function: impl Fn(f64) -> f64) -> Self {
        /// Lengths and torques in SI are larger, or close to a zero that is a kink.
        const LEAST_STEP: f64 = 1e-6;
        let [lifted] = self.lift_all(LEAST_STEP, |x| [function(x)]);
        lifted
    }
    fn lift_all<const N: usize>(self, least_step: f64, function: impl Fn(f64) -> [f64; N]) -> [Self; N] {
        /// Of the number: the truncation error of five points and the rounding of their differences are both about 1e-12.
        const STEP: f64 = 1e-4;
        let mut all = function(self.value).map(Self::constant);
        if self.is_constant() {
            return all;
        }
        let step = self.value.abs() * STEP + least_step;
        for factor in [1.0, 2.0] {
            let Ok(stencil) = Stencil::new(step * factor, |distance| {
                Ok::<_, Infallible>(function(self.value + distance))
            });
            for (n, result) in all.iter_mut().enumerate() {
                let derivative = stencil.slope(|results| results[n]);
                for direction in (0..DIRECTIONS).filter(|i| Self::step_factor(*i) == factor) {
                    result.slopes[direction] = self.slopes[direction] * derivative;
                }
            }
        }
        all
    }
}

impl Points for Dual {
    const COUNT: usize = 1;
    #[inline]
    fn each(mut number: impl FnMut(usize) -> f64) -> Self {
        Self::constant(number(0))
    }
    #[inline]
    fn mask(mut holds: impl FnMut(usize) -> bool) -> bool {
        holds(0)
    }
    #[inline]
    fn at_point(&self, _point: usize) -> f64 {
        self.value
    }
    #[inline]
    fn set(&mut self, _point: usize, x: f64) {
        *self = Self::constant(x);
    }
    #[inline]
    fn test(self, mut holds: impl FnMut(f64) -> bool) -> bool {
        holds(self.value)
    }
    #[inline]
    fn wide<T>(work: impl FnOnce() -> T) -> T {
        work()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A variable whose derivative along the first pair is one.
    fn variable(x: f64) -> Dual {
        Dual::variable(x, 0)
    }

    /// The derivative of a function by differences of the same function over `f64`.
    fn by_differences(x: f64, function: impl Fn(f64) -> f64) -> f64 {
        let Ok(stencil) = Stencil::new(x.abs() * 1e-3, |d| Ok::<_, Infallible>(function(x + d)));
        stencil.slope(|y| *y)
    }

    /// Some functions of two numbers over any `Real`; the second is not varied.
    fn functions<R: Real>(x: R, y: R) -> [R; 14] {
        [
            x + y,
            x - y,
            x * y * 1.5,
            x / y / 3.0,
            y / x - 2.0,
            -x + 1.0,
            (x * 0.01).exp(),
            x.ln(),
            x.power(0.7),
            x.power(-1.3),
            x.sqrt() * x.cbrt(),
            (x / (x + y) * 0.7).sine(),
            (x - y).abs(),
            x.max(y).min(y * 2.0).at_least(0.3).at_most(40.0),
        ]
    }

    proptest! {
        #[test]
        fn values_have_the_bits_of_plain_numbers(x in 1e-6..100.0_f64, y in 1e-6..100.0_f64) {
            let plain = functions(x, y).map(f64::to_bits);
            let dual = functions(variable(x), Dual::variable(y, 1)).map(|f| f.value.to_bits());
            prop_assert_eq!(plain, dual);
        }

        #[test]
        fn derivatives_agree_with_differences(x in 0.1..100.0_f64, y in 0.1..100.0_f64) {
            // Away from the kinks of the last two functions.
            let kinks = [y, 2.0 * y, 0.3, 40.0];
            prop_assume!(kinks.iter().all(|kink| (x / kink - 1.0).abs() > 0.01));
            let dual = functions(variable(x), Dual::constant(y));
            for (k, derived) in dual.iter().enumerate() {
                let wanted = by_differences(x, |x| functions(x, y)[k]);
                let scale = wanted.abs() + derived.value.abs() / x;
                prop_assert!((derived.slopes[0] - wanted).abs() <= 1e-10 * scale, "{}: {} against {}", k, derived.slopes[0], wanted);
                prop_assert_eq!(derived.slopes, [derived.slopes[0], derived.slopes[0], 0.0, 0.0]);
            }
        }
    }

    #[test]
    fn derivatives_at_zero_are_one_sided_and_never_undefined() {
        let zero = variable(0.0);
        let starts = [
            zero.sqrt(),
            zero.cbrt(),
            zero.power(0.4),
            zero.power(2.5),
            zero.abs(),
            (zero.ln() * 0.4 + 1.0).exp(),
            (-(Dual::constant(1.0) / zero)).exp(),
        ];
        for start in starts {
            assert_eq!((start.value, start.slopes), (0.0, [0.0; DIRECTIONS]));
        }
        assert_eq!(zero.power(1.0).slopes[0], 1.0);
    }

    #[test]
    fn a_lifted_function_has_its_slope_and_an_error() {
        let x = variable(80.0);
        let lifted = x.lift(f64::ln);
        assert_eq!(lifted.value, 80.0_f64.ln());
        assert!((lifted.slopes[0] * 80.0 - 1.0).abs() < 1e-10);
        assert!((lifted.slopes[0] - lifted.slopes[1]).abs() < 1e-10 * lifted.slopes[0]);
        assert_eq!(Dual::constant(3.0).lift(f64::sqrt), Dual::constant(3.0_f64.sqrt()));
    }
}
