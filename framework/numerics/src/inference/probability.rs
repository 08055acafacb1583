//! Probabilities and quantiles of the statistics of a fit.
//!
//! A function has no value if the degrees of freedom are not positive, a probability is not inside the open interval from zero to one, or
//! an argument is NaN.

use super::gamma::{beta, gamma};

/// Probability that a standard normal quantity is below a value.
pub fn normal_below(x: f64) -> Option<f64> {
    if x.is_nan() {
        return None;
    }
    let [p, q] = gamma(0.5, 0.5 * x * x);
    Some(if x < 0.0 { 0.5 * q } else { 0.5 + 0.5 * p })
}

/// Probability that chi-square is above a value.
pub fn chi_square_above(x: f64, freedom: f64) -> Option<f64> {
    (is_freedom(freedom) && !x.is_nan()).then(|| gamma(0.5 * freedom, 0.5 * x)[1])
}

/// Quantile of chi-square.
pub fn chi_square_quantile(probability: f64, freedom: f64) -> Option<f64> {
    let tails = |x: f64| gamma(0.5 * freedom, 0.5 * x);
    (is_freedom(freedom) && is_probability(probability)).then(|| solve(probability, tails))
}

/// Two-sided tail probability of Student's t.
pub fn student_outside(t: f64, freedom: f64) -> Option<f64> {
    (is_freedom(freedom) && !t.is_nan()).then(|| student_tails(t, freedom)[1])
}

/// Quantile of Student's t.
pub fn student_quantile(probability: f64, freedom: f64) -> Option<f64> {
    if !is_freedom(freedom) || !is_probability(probability) {
        return None;
    }
    let outside = 2.0 * probability.min(1.0 - probability);
    let size = if outside >= 1.0 {
        0.0
    } else {
        solve(1.0 - outside, |t| student_tails(t, freedom))
    };
    Some(size.copysign(probability - 0.5))
}

/// Probabilities that the magnitude of Student's t is below and above a value.
fn student_tails(t: f64, freedom: f64) -> [f64; 2] {
    let (square, sum) = (t * t, freedom + t * t);
    beta(0.5, 0.5 * freedom, [square / sum, freedom / sum])
}

/// Probability that F is above a value.
pub fn f_above(x: f64, [above, below]: [f64; 2]) -> Option<f64> {
    let valid = is_freedom(above) && is_freedom(below) && !x.is_nan();
    valid.then(|| f_tails(x.max(0.0), [above, below])[1])
}

/// Quantile of F.
pub fn f_quantile(probability: f64, [above, below]: [f64; 2]) -> Option<f64> {
    let tails = |x: f64| f_tails(x, [above, below]);
    (is_freedom(above) && is_freedom(below) && is_probability(probability)).then(|| solve(probability, tails))
}

/// Probabilities that F is below and above a non-negative value.
fn f_tails(x: f64, [above, below]: [f64; 2]) -> [f64; 2] {
    let sum = below + above * x;
    beta(0.5 * above, 0.5 * below, [above * x / sum, below / sum])
}

fn is_freedom(freedom: f64) -> bool {
    freedom > 0.0 && freedom.is_finite()
}

fn is_probability(probability: f64) -> bool {
    probability > 0.0 && probability < 1.0
}

/// The positive value at which the lower tail equals a probability, by bisection to the last digit. The smaller tail is compared, because
/// it has more digits.
fn solve(probability: f64, tails: impl Fn(f64) -> [f64; 2]) -> f64 {
    let is_below = |x: f64| {
        let [lower, upper] = tails(x);
        if probability < 0.5 {
            lower < probability
        } else {
            upper > 1.0 - probability
        }
    };
    let (mut low, mut high) = (0.0, 1.0);
    while is_below(high) && high < 1e300 {
        low = high;
        high *= 2.0;
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use proptest::prelude::*;

    use super::*;
    use crate::sampling::inverse_normal;

    #[test]
    fn check_3_3_joint_limits() {
        // Printed with seven places.
        assert!((chi_square_quantile(0.95, 8.0).unwrap() - 15.5073131).abs() < 6e-8);
        assert!((chi_square_quantile(0.99, 8.0).unwrap() - 20.0902350).abs() < 6e-8);
        // One-sided 95 % of one parameter.
        assert!((chi_square_quantile(0.90, 1.0).unwrap() - 2.705543).abs() < 6e-7);
    }

    #[test]
    fn quantiles_of_tables() {
        let near = |x: Option<f64>, y: f64| assert!((x.unwrap() - y).abs() < 1e-11 * y.abs(), "{x:?} {y}");
        // As scipy 1.x gives them.
        near(chi_square_quantile(0.05, 3.0), 0.351_846_317_749_271_44);
        near(chi_square_quantile(0.5, 1000.0), 999.333_412_403_381);
        near(student_quantile(0.975, 432.0), 1.965_470_508_861_415_5);
        near(student_quantile(0.975, 1.0), 12.706_204_736_174_694);
        near(student_quantile(0.025, 5.0), -2.570_581_835_636_314_7);
        near(f_quantile(0.95, [3.0, 10.0]), 3.708_264_819_046_843_5);
        near(f_above(3.0, [4.0, 7.5]), 0.091_912_599_342_662_37);
        near(chi_square_above(468.403_446_2, 432.0), 0.109_756_043_826_186_28);
        near(student_outside(2.0, 10.0), 0.073_388_034_770_740_36);
        near(normal_below(-1.0), 0.158_655_253_931_457_07);
        near(normal_below(-30.0), 4.906_713_927_147_908e-198);
    }

    #[test]
    fn there_are_no_values_outside_of_the_domain() {
        assert_eq!(chi_square_above(1.0, 0.0), None);
        assert_eq!(chi_square_above(f64::NAN, 1.0), None);
        assert_eq!(chi_square_quantile(1.0, 1.0), None);
        assert_eq!(student_quantile(0.5, f64::NAN), None);
        assert_eq!(student_quantile(0.5, 3.0), Some(0.0));
        assert_eq!(f_quantile(0.5, [0.0, 1.0]), None);
        assert_eq!(f_above(-1.0, [2.0, 3.0]), Some(1.0));
        assert_eq!(chi_square_above(-1.0, 2.0), Some(1.0));
        assert_eq!(normal_below(f64::INFINITY), Some(1.0));
        assert_eq!(normal_below(f64::NAN), None);
    }

    #[test]
    fn a_value_near_zero_keeps_its_digits() {
        // The complement of t^2/(f + t^2) has lost seven of them here.
        let (p, freedom) = (0.499_788_791_054_486_9, 285.161_146_506_351_94);
        let t = student_quantile(p, freedom).unwrap();
        assert!((student_outside(t, freedom).unwrap() - 2.0 * p).abs() < 1e-14);
        assert_eq!(student_outside(f64::INFINITY, 3.0), Some(0.0));
        assert_eq!(f_above(f64::INFINITY, [2.0, 3.0]), Some(0.0));
    }

    proptest! {
        #[test]
        fn quantiles_give_their_probability_back(p in 1e-6..0.999_999_f64, a in 0.5..300.0_f64, b in 0.5..300.0_f64) {
            let back = 1.0 - chi_square_above(chi_square_quantile(p, a).unwrap(), a).unwrap();
            prop_assert!((back - p).abs() < 1e-11);
            let t = student_quantile(p, a).unwrap();
            prop_assert!((student_outside(t, a).unwrap() - 2.0 * p.min(1.0 - p)).abs() < 1e-11);
            let back = 1.0 - f_above(f_quantile(p, [a, b]).unwrap(), [a, b]).unwrap();
            prop_assert!((back - p).abs() < 1e-11);
            let back = normal_below(inverse_normal(p).unwrap()).unwrap();
            prop_assert!((back - p).abs() < 1e-14);
        }
    }
}
