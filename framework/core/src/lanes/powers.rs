//! Powers of numbers that hardly change from one call to the next, as loads from one speed to the next.

use super::{LANES, Lane, each, over};

/// Terms of the binomial series after the first.
const TERMS: usize = 6;
/// Maximum relative change of a number for which the series is used: its truncation error is below 2e-17 for exponents from -1 to
/// 2.
const CLOSE: f64 = 1.0 / 256.0;

/// Remembered powers of some lanes for the next call at similar numbers: a few multiplications then replace a logarithm and an
/// exponential. Without memory every power is exact, with memory it is accurate to 1e-15 for exponents from -1 to 2 and to 1e-14
/// for those from -5 to 10.
#[derive(Debug, Clone, Default)]
pub struct Powers {
    remembers: bool,
    places: Vec<Option<Box<Anchor>>>,
}

/// Tolerance of losses with remembered powers, as checked by the conformance suite.
pub(crate) const REMEMBERED: f64 = 1e-12;

/// Exactly computed powers.
#[derive(Debug, Clone)]
struct Anchor {
    exponent: f64,
    /// Coefficients of the binomial series.
    terms: [f64; TERMS],
    /// One over the numbers.
    inverse: Lane,
    powers: Lane,
}

impl Powers {
    /// Without memory.
    pub const EXACT: Self = Self {
        remembers: false,
        places: Vec::new(),
    };

    /// Clears all powers, and keeps their storage.
    pub(crate) fn forget(&mut self) {
        for anchor in self.places.iter_mut().flatten() {
            // Different from all exponents.
            anchor.exponent = f64::NAN;
        }
    }

    /// With an empty memory.
    pub(crate) const fn remembering() -> Self {
        Self {
            remembers: true,
            places: Vec::new(),
        }
    }

    /// Powers of numbers, which are given by their indices. `exact` raises to the exponent, times a constant factor that is the
    /// same at every speed and in every oil; nothing may be added or cut off in it. The result is remembered at `place`, so a model
    /// gives each of its powers its own place, counted from zero.
    #[inline(always)]
    pub fn raise(&mut self, place: usize, x: impl Fn(usize) -> f64, exponent: f64, exact: impl Fn(f64) -> f64) -> Lane {
        if let Some(Some(anchor)) = self.places.get(place)
            && anchor.exponent == exponent
        {
            let [c1, c2, c3, c4, c5, c6] = anchor.terms;
            let (inverse, powers) = (&anchor.inverse, &anchor.powers);
            let mut close = 0;
            let found = each(|i| {
                let d = x(i) * inverse[i] - 1.0;
                // NaN is not close.
                close += u64::from(d.abs() <= CLOSE);
                powers[i] + powers[i] * (d * (c1 + d * (c2 + d * (c3 + d * (c4 + d * (c5 + d * c6))))))
            });
            if close == LANES as u64 {
                return found;
            }
        }
        let x = each(x);
        let powers = over(&x, exact);
        if self.remembers {
            self.remember(place, exponent, &x, &powers);
        }
        powers
    }

    #[inline(never)]
    fn remember(&mut self, place: usize, exponent: f64, x: &Lane, powers: &Lane) {
        if self.places.len() <= place {
            self.places.resize(place + 1, None);
        }
        let anchor = Anchor {
            exponent,
            terms: binomial(exponent),
            inverse: over(x, |x| 1.0 / x),
            powers: *powers,
        };
        match &mut self.places[place] {
            Some(own) => **own = anchor,
            empty => *empty = Some(Box::new(anchor)),
        }
    }
}

/// Coefficients of the powers of d from the first on in (1 + d)^exponent.
fn binomial(exponent: f64) -> [f64; TERMS] {
    let mut coefficient = 1.0;
    std::array::from_fn(|k| {
        coefficient *= (exponent - k as f64) / (k as f64 + 1.0);
        coefficient
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{cube_root, wide};

    #[test]
    fn what_is_remembered_agrees_with_exact_powers() {
        for exponent in [-1.0, -0.5, 0.24, 1.0 / 3.0, 0.54, 1.0, 5.0 / 3.0, 2.0] {
            let exact = |x: f64| x.powf(exponent);
            let mut powers = Powers::remembering();
            let first = each(|i| 10.0_f64.powf(0.4 * i as f64 - 6.0));
            assert_eq!(powers.raise(0, |i| first[i], exponent, exact), over(&first, exact));
            for step in -20..=20 {
                let x = each(|i| first[i] * (1.0 + 0.99 * CLOSE * f64::from(step) / 20.0));
                let found = wide(
                    #[inline(always)]
                    || powers.raise(0, |i| x[i], exponent, |_| f64::NAN),
                );
                for i in 0..LANES {
                    let own = exact(x[i]);
                    assert!(
                        (found[i] - own).abs() <= 1e-15 * own,
                        "{exponent} {}: {} {own}",
                        x[i],
                        found[i]
                    );
                }
            }
        }
    }

    #[test]
    fn what_moved_is_exact_again_and_remembered() {
        let mut powers = Powers::remembering();
        let calls = std::cell::Cell::new(0);
        let exact = |x: f64| {
            calls.set(calls.get() + 1);
            cube_root(x)
        };
        let mut is_exact = |place: usize, x: f64, others: f64| {
            calls.set(0);
            let found = powers.raise(place, |i| if i == 7 { x } else { others }, 1.0 / 3.0, exact);
            assert!((found[7] - cube_root(x)).abs() <= 1e-15 && (found[8] - cube_root(others)).abs() <= 1e-15);
            calls.get() > 0
        };
        assert!(is_exact(0, 3.0, 3.0));
        assert!(!is_exact(0, 3.001, 3.0));
        // One lane is enough.
        assert!(is_exact(0, 3.1, 3.0));
        assert!(!is_exact(0, 3.1, 3.0));
        // Zero load is never close to anything, and its power is zero.
        assert!(is_exact(0, 0.0, 3.0));
        assert!(is_exact(0, 0.0, 3.0));
        // Each place has its own memory.
        assert!(is_exact(2, 3.0, 3.0));
        assert!(!is_exact(2, 3.0, 3.0));
        powers.forget();
        calls.set(0);
        powers.raise(2, |_| 3.0, 1.0 / 3.0, exact);
        assert!(calls.get() > 0);
    }

    #[test]
    fn without_a_memory_every_power_is_exact() {
        let mut powers = Powers::EXACT;
        for x in [2.0, 2.0] {
            let evaluated = std::cell::Cell::new(false);
            let root = |x: f64| {
                evaluated.set(true);
                cube_root(x)
            };
            assert_eq!(powers.raise(0, |_| x, 1.0 / 3.0, root)[0], cube_root(2.0));
            assert!(evaluated.get());
        }
    }
}
