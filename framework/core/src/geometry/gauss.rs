//! Gauss-Legendre rules on the interval from -1 to 1.

/// Nodes and weights of a rule that is exact for polynomials up to degree 2 n - 1.
pub fn rule(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut p, mut before) = (1.0, 0.0);
                for k in 0..n {
                    let k = k as f64;
                    (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
                }
                slope = n as f64 * (x * p - before) / (x * x - 1.0);
                let step = p / slope;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .rev()
        .collect()
}

/// A rule whose nodes are denser towards both ends: that of `n` nodes in u under x = (5 u - u^3)/4. It is exact for polynomials up
/// to degree (2 n - 3)/3. At the ends, where friction may start like a fractional power of sliding or load, it is as accurate as a
/// plain rule with several times the nodes.
pub(crate) fn graded_rule(n: usize) -> Vec<(f64, f64)> {
    rule(n).into_iter().map(graded).collect()
}

/// A node of the graded rule with its weight, from those of the plain one in u.
pub fn graded((u, w): (f64, f64)) -> (f64, f64) {
    (0.25 * u * (5.0 - u * u), 0.25 * w * (5.0 - 3.0 * u * u))
}

/// Factors by which a polynomial interpolates values at the nodes of one plain rule to those of another: for each of the latter, one for
/// each of the former. With the same numbers of nodes it does so for graded rules, by a polynomial in u.
pub fn interpolation(from: &[(f64, f64)], to: &[(f64, f64)]) -> Vec<f64> {
    let polynomial = |u: f64, i: usize| -> f64 {
        let others = (0..from.len()).filter(|k| *k != i);
        others.map(|k| (u - from[k].0) / (from[i].0 - from[k].0)).product()
    };
    let rows = to.iter().flat_map(|(u, _)| (0..from.len()).map(move |i| (*u, i)));
    rows.map(|(u, i)| polynomial(u, i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(rule: &[(f64, f64)], of: impl Fn(f64) -> f64) -> f64 {
        rule.iter().map(|(x, w)| w * of(*x)).sum()
    }

    #[test]
    fn graded_rules_are_exact_for_few_powers_and_good_for_broken_ones() {
        for n in 2..12_i32 {
            for degree in 0..=(2 * n - 3) / 3 {
                let exact = if degree % 2 == 0 {
                    2.0 / f64::from(degree + 1)
                } else {
                    0.0
                };
                let sum = integral(&graded_rule(n as usize), |x| x.powi(degree));
                assert!((sum - exact).abs() < 1e-13, "{n} {degree} {sum}");
            }
        }
        // A power of 1.25, as caused by load that starts as a ramp.
        let error =
            |rule: &[(f64, f64)]| (integral(rule, |x| (1.0 + x).powf(1.25)) / (2.0_f64.powf(2.25) / 2.25) - 1.0).abs();
        assert!(error(&graded_rule(7)) < 1e-5 && error(&graded_rule(7)) < 0.2 * error(&rule(7)));
    }

    #[test]
    fn polynomials_are_interpolated_exactly() {
        let [from, to] = [7, 64].map(rule);
        for (row, (u, _)) in interpolation(&from, &to).chunks(from.len()).zip(&to) {
            for degree in 0..7 {
                let sum: f64 = row
                    .iter()
                    .zip(&from)
                    .map(|(factor, (u, _))| factor * u.powi(degree))
                    .sum();
                assert!((sum - u.powi(degree)).abs() < 1e-13, "{u} {degree} {sum}");
            }
        }
    }

    #[test]
    fn exact_up_to_its_degree() {
        for n in 1..8 {
            for degree in 0..2 * n {
                let sum: f64 = rule(n).iter().map(|(x, w)| w * x.powf(degree as f64)).sum();
                let exact = if degree % 2 == 0 {
                    2.0 / (degree as f64 + 1.0)
                } else {
                    0.0
                };
                assert!((sum - exact).abs() < 1e-13, "{n} {degree} {sum}");
            }
        }
    }
}
