//! The regularised incomplete gamma and beta functions, the basis of the distributions.
//!
//! They are implemented here because the project needs only five short functions; a statistics library would add dependencies. Formulas:
//! NIST Digital Library of Mathematical Functions, sections 5.11, 8.7, 8.9 and 8.17.

/// Relative change at which a series or fraction has converged.
const DONE: f64 = 1e-16;
/// Smallest number, used instead of zero in a fraction.
const TINY: f64 = 1e-300;
/// Argument above which Stirling's series is accurate to all digits.
const FAR: f64 = 12.0;
/// Coefficients of Stirling's series, B_2k/(2k (2k - 1)) from k = 1.
const STIRLING: [f64; 7] = [
    1.0 / 12.0,
    -1.0 / 360.0,
    1.0 / 1260.0,
    -1.0 / 1680.0,
    1.0 / 1188.0,
    -691.0 / 360_360.0,
    1.0 / 156.0,
];

/// Logarithm of the gamma function for positive arguments.
pub(super) fn ln_gamma(x: f64) -> f64 {
    let (mut far, mut product) = (x, 1.0);
    while far < FAR {
        product *= far;
        far += 1.0;
    }
    let inverse = 1.0 / (far * far);
    let series = STIRLING.iter().rev().fold(0.0, |sum, c| sum * inverse + c) / far;
    (far - 0.5) * far.ln() - far + 0.5 * (2.0 * std::f64::consts::PI).ln() + series - product.ln()
}

/// Sufficient number of terms: series and fractions converge within a few times the root of their largest parameter.
fn sufficient_terms(parameter: f64) -> usize {
    1000 + (50.0 * parameter.sqrt()).min(1e6) as usize
}

/// Regularised incomplete gamma functions P and Q = 1 - P, both to full precision; a positive, x not negative.
pub(super) fn gamma(a: f64, x: f64) -> [f64; 2] {
    if x <= 0.0 {
        return [0.0, 1.0];
    }
    if x == f64::INFINITY {
        return [1.0, 0.0];
    }
    let front = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum) = (1.0 / a, 1.0 / a);
        for k in 1..sufficient_terms(a) {
            term *= x / (a + k as f64);
            sum += term;
            if term < DONE * sum {
                break;
            }
        }
        let p = (front * sum).clamp(0.0, 1.0);
        return [p, 1.0 - p];
    }
    let fraction = lentz(sufficient_terms(a), |k| {
        let k = k as f64;
        (if k == 0.0 { 1.0 } else { k * (a - k) }, x - a + 1.0 + 2.0 * k)
    });
    let q = (front * fraction).clamp(0.0, 1.0);
    [1.0 - q, q]
}

/// Regularised incomplete beta functions I_x(a, b) and I_y(b, a) = 1 - I_x(a, b), both to full precision; a and b positive, x and y from
/// zero to one and y = 1 - x. Both are returned, because a difference near one would lose digits.
pub(super) fn beta(a: f64, b: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    if x <= 0.0 {
        return [0.0, 1.0];
    }
    if y <= 0.0 {
        return [1.0, 0.0];
    }
    // The fraction converges quickly only below the mean.
    if x > (a + 1.0) / (a + b + 2.0) {
        let [upper, lower] = beta(b, a, [y, x]);
        return [lower, upper];
    }
    let ln_y = if x < 0.5 { (-x).ln_1p() } else { y.ln() };
    let front = (ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * ln_y).exp() / a;
    let fraction = lentz(sufficient_terms(a.max(b)), |k| {
        let m = (k / 2) as f64;
        let numerator = match k {
            0 => 1.0,
            k if k % 2 == 0 => m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)),
            _ => -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0)),
        };
        (numerator, 1.0)
    });
    let lower = (front * fraction).clamp(0.0, 1.0);
    [lower, 1.0 - lower]
}

/// A continued fraction given by its numerators and denominators, by the modified Lentz method of Thompson and Barnett (J. Comput. Phys. 64
/// (1986) 490-509).
fn lentz(most: usize, rule: impl Fn(usize) -> (f64, f64)) -> f64 {
    let away = |x: f64| if x.abs() < TINY { TINY } else { x };
    let (mut value, mut c, mut d) = (TINY, TINY, 0.0);
    for k in 0..most {
        let (numerator, denominator) = rule(k);
        d = 1.0 / away(denominator + numerator * d);
        c = away(denominator + numerator / c);
        value *= c * d;
        if (c * d - 1.0).abs() < DONE {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(x: f64, y: f64) {
        // Rounding of the logarithms in front, some tens of units.
        assert!((x - y).abs() <= 2e-14 * y.abs(), "{x} {y}");
    }

    #[test]
    fn logarithms_of_gamma() {
        // Factorials, and the square root of pi.
        near(ln_gamma(11.0), 3_628_800.0_f64.ln());
        near(ln_gamma(0.5), std::f64::consts::PI.sqrt().ln());
        near(ln_gamma(3.5), (1.875 * std::f64::consts::PI.sqrt()).ln());
        assert!(ln_gamma(1.0).abs() < 1e-14 && ln_gamma(2.0).abs() < 1e-14);
    }

    #[test]
    fn incomplete_gamma_of_whole_parameters() {
        // P(1, x) = 1 - exp(-x), Q(3, x) = exp(-x) (1 + x + x^2/2).
        for x in [1e-3, 0.5, 3.0, 20.0_f64] {
            near(gamma(1.0, x)[1], (-x).exp());
            near(gamma(1.0, x)[0], -(-x).exp_m1());
            near(gamma(3.0, x)[1], (-x).exp() * (1.0 + x + 0.5 * x * x));
        }
        assert_eq!(gamma(2.0, 0.0), [0.0, 1.0]);
        assert_eq!(gamma(2.0, f64::INFINITY), [1.0, 0.0]);
    }

    #[test]
    fn incomplete_beta_of_whole_parameters() {
        // I_x(1, b) = 1 - (1 - x)^b, I_x(2, 2) = x^2 (3 - 2 x).
        for x in [1e-3, 0.3, 0.9_f64] {
            let both = [x, 1.0 - x];
            near(beta(1.0, 5.0, both)[0], 1.0 - (1.0 - x).powi(5));
            near(beta(2.0, 2.0, both)[0], x * x * (3.0 - 2.0 * x));
        }
        // The logarithm of gamma of 80 is 270; its last digit is worth 6e-14.
        assert!((beta(40.0, 40.0, [0.5; 2])[0] - 0.5).abs() < 6e-14);
        assert_eq!(
            [beta(1.0, 2.0, [0.0, 1.0])[0], beta(1.0, 2.0, [1.0, 0.0])[0]],
            [0.0, 1.0]
        );
        // I_x(1, 1) = x: a complement far below the last digit of one keeps its digits.
        assert_eq!(beta(1.0, 1.0, [1.0, 1e-30])[0], 1.0);
        near(beta(1.0, 1.0, [1.0, 1e-30])[1], 1e-30);
    }
}
