//! The root of a continuous function between two points where its signs differ.

/// A root of `f` between `low` and `high`, to the precision of the numbers; the end itself where `f` is zero. `None` if the signs at both
/// ends are equal or a value is not a number. Inverse quadratic steps where they are safe, else bisection (Chandrupatla 1997).
pub(super) fn root(f: impl Fn(f64) -> f64, low: f64, high: f64) -> Option<f64> {
    let (mut a, mut b) = (low, high);
    let (mut f_a, mut f_b) = (f(a), f(b));
    if f_a == 0.0 {
        return Some(a);
    }
    if f_b == 0.0 {
        return Some(b);
    }
    if f_a.is_nan() || f_b.is_nan() || (f_a > 0.0) == (f_b > 0.0) {
        return None;
    }
    let (mut c, mut f_c);
    let mut share = 0.5;
    loop {
        let x = a + share * (b - a);
        let value = f(x);
        if value.is_nan() {
            return None;
        }
        // `a` is the newest point, `b` has the other sign, `c` is the one before.
        if (value > 0.0) == (f_a > 0.0) {
            (c, f_c) = (a, f_a);
        } else {
            (c, f_c, b, f_b) = (b, f_b, a, f_a);
        }
        (a, f_a) = (x, value);
        let (best, at_best) = if f_a.abs() < f_b.abs() { (a, f_a) } else { (b, f_b) };
        let tolerance = 2.0 * f64::EPSILON * best.abs() + f64::MIN_POSITIVE;
        let least_share = tolerance / (b - a).abs();
        if at_best == 0.0 || least_share >= 0.5 {
            return Some(best);
        }
        let (xi, phi) = ((a - b) / (c - b), (f_a - f_b) / (f_c - f_b));
        let is_safe = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        share = if is_safe {
            f_a / (f_b - f_a) * f_c / (f_b - f_c) + (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b)
        } else {
            0.5
        };
        share = share.clamp(least_share, 1.0 - least_share);
    }
}

/// The root of a function that grows, from a bracket that is widened until it contains the root; `None` if that needs more than
/// `doublings` of its width.
pub(crate) fn root_of_growing(f: impl Fn(f64) -> f64, start: f64, width: f64, doublings: u32) -> Option<f64> {
    let (mut low, mut high) = (start, start);
    let mut step = width;
    if f(start) < 0.0 {
        for _ in 0..doublings {
            high = start + step;
            if f(high) >= 0.0 {
                return root(f, low, high);
            }
            (low, step) = (high, 2.0 * step);
        }
    } else {
        for _ in 0..doublings {
            low = start - step;
            if f(low) <= 0.0 {
                return root(f, low, high);
            }
            (high, step) = (low, 2.0 * step);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::testing::assert_close;
    use std::cell::Cell;

    #[test]
    fn roots_of_a_cubic_and_of_a_step() {
        let calls = Cell::new(0);
        let cubic = |x: f64| {
            calls.set(calls.get() + 1);
            x.powi(3) - 2.0
        };
        assert_close(root(cubic, 0.0, 4.0).unwrap(), 2.0_f64.cbrt(), 1e-15);
        assert!(calls.get() < 20, "{}", calls.get());
        let step = |x: f64| if x < 0.3 { -1.0 } else { 1e9 };
        assert_close(root(step, 0.0, 1.0).unwrap(), 0.3, 1e-14);
    }

    #[test]
    fn without_a_change_of_sign_there_is_no_root() {
        assert_eq!(root(|x| x * x + 1.0, -1.0, 1.0), None);
        assert_eq!(root(|_| f64::NAN, -1.0, 1.0), None);
        assert_eq!(root(|x| x, 0.0, 1.0), Some(0.0));
    }

    #[test]
    fn a_bracket_is_widened_in_both_directions() {
        for wanted in [-37.0, 0.0, 5.5] {
            assert_eq!(root_of_growing(|x| x - wanted, 0.0, 0.1, 20), Some(wanted));
        }
        assert_eq!(root_of_growing(|x| -1.0 / (1.0 + x * x), 0.0, 1.0, 30), None);
    }
}
