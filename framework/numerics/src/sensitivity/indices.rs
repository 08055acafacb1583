//! First-order and total Sobol indices: shares of the variance of an output.
//!
//! Sources: Sobol, Math. Comput. Simul. 55 (2001) 271-280; estimators of Jansen, Comput. Phys. Commun. 117 (1999) 35-43, in the design of
//! Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270. With two samples A and B, the sample A_B,i (A with column i of B), and the
//! variance V of f(A) and f(B) together: S_i = 1 - mean((f(B) - f(A_B,i))^2)/(2V), S_Ti = mean((f(A) - f(A_B,i))^2)/(2V).

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::run::{Evaluate, outputs};
use crate::sampling::{Generator, Sobol};
use crate::statistics::quantile;

/// Sum of the first-order shares below which interactions are significant.
const ALONE: f64 = 0.9;
/// Spread over the largest magnitude below which an output varies by rounding only.
const ROUNDING: f64 = 1e-13;

/// A share with the ends of its 95 % interval by resampling the rows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Estimate {
    /// The share. Small shares may be slightly negative and are not corrected. [-]
    pub value: f64,
    /// Quantiles 2.5 and 97.5 % of the resamples. [-]
    pub interval: [f64; 2],
}

/// Variance shares of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct VarianceShares {
    /// Mean of the output.
    pub mean: f64,
    /// Variance of the output; if it is rounding only, it and all shares are zero.
    pub variance: f64,
    /// First-order share of each parameter.
    pub first: Vec<Estimate>,
    /// Total share of each parameter, including interactions.
    pub total: Vec<Estimate>,
}

impl VarianceShares {
    /// Whether parameters interact: the first-order shares sum to less than 90 %.
    pub fn interact(&self) -> bool {
        self.variance > 0.0 && self.first.iter().map(|s| s.value).sum::<f64>() < ALONE
    }
}

/// Shares of the variance of each output of a function of unit coordinates, each evenly distributed between zero and one.
///
/// The function is evaluated for each row once with A, once with B and once for each parameter. Intervals come from resampling the rows,
/// usually 200 times; without resampling they are the value.
///
/// # Errors
/// If the number of rows is not a power of two (otherwise Sobol points are not balanced), there are more than 32 parameters, or the
/// function fails or returns non-finite numbers.
pub fn variance_shares<F>(
    parameters: usize,
    rows: usize,
    resamples: usize,
    function: F,
) -> Result<Vec<VarianceShares>, String>
where
    F: Evaluate,
{
    if !(2..=1 << 31).contains(&rows) || !rows.is_power_of_two() {
        return Err(format!("the number of rows must be a power of two, not {rows}"));
    }
    let sobol = Sobol::new(2 * parameters)?;
    let each = parameters + 2;
    let point = |i: usize| {
        let mut a = sobol.point((i / each) as u32);
        let b = a.split_off(parameters);
        match i % each {
            0 => a,
            1 => b,
            k => {
                a[k - 2] = b[k - 2];
                a
            }
        }
    };
    let runs = outputs(rows * each, point, &function)?;
    let width = runs[0].len();
    (0..width)
        .map(|output| {
            let column = |k: usize| runs.iter().skip(k).step_by(each).map(|list| list[output]).collect();
            let sample = Sample {
                a: column(0),
                b: column(1),
                mixed: (2..each).map(column).collect(),
            };
            sample
                .shares(resamples)
                .ok_or_else(|| format!("output {} is too large to be squared", output + 1))
        })
        .collect()
}

/// Values of one output: for each row those of A, B and each A_B,i.
struct Sample {
    a: Vec<f64>,
    b: Vec<f64>,
    mixed: Vec<Vec<f64>>,
}

/// Mean, variance, first-order and total shares.
struct Raw {
    mean: f64,
    variance: f64,
    first: Vec<f64>,
    total: Vec<f64>,
}

impl Sample {
    fn shares(&self, resamples: usize) -> Option<VarianceShares> {
        let count = self.a.len();
        let all: Vec<usize> = (0..count).collect();
        let raw = self.raw(&all)?;
        let resample = |number: usize| {
            let mut generator = Generator::new(number as u64);
            let rows: Vec<usize> = (0..count).map(|_| generator.below(count)).collect();
            self.raw(&rows)
        };
        let again: Option<Vec<Raw>> = (0..resamples).into_par_iter().with_max_len(1).map(resample).collect();
        let again = again?;
        let estimate = |value: f64, list: &dyn Fn(&Raw) -> f64| {
            let mut list: Vec<f64> = again.iter().map(list).collect();
            list.sort_by(f64::total_cmp);
            let end = |share: f64| if list.is_empty() { value } else { quantile(&list, share) };
            let interval = [end(0.025), end(0.975)];
            Estimate { value, interval }
        };
        Some(VarianceShares {
            mean: raw.mean,
            variance: raw.variance,
            first: (raw.first.iter().enumerate())
                .map(|(i, s)| estimate(*s, &|r| r.first[i]))
                .collect(),
            total: (raw.total.iter().enumerate())
                .map(|(i, s)| estimate(*s, &|r| r.total[i]))
                .collect(),
        })
    }

    /// Estimators over some rows; absent if squares overflow.
    fn raw(&self, rows: &[usize]) -> Option<Raw> {
        let count = rows.len() as f64;
        let both = || rows.iter().flat_map(|i| [self.a[*i], self.b[*i]]);
        let mean = both().map(|y| y / (2.0 * count)).sum::<f64>();
        let mut variance = both().map(|y| (y - mean) * (y - mean)).sum::<f64>() / (2.0 * count);
        let greatest = both().fold(0.0, |most: f64, y| most.max(y.abs()));
        if variance.sqrt() <= ROUNDING * greatest {
            variance = 0.0;
        }
        let share = |from: &[f64], mixed: &[f64]| {
            let squares: f64 = rows
                .iter()
                .map(|i| (from[*i] - mixed[*i]) * (from[*i] - mixed[*i]))
                .sum();
            squares / count / (2.0 * variance)
        };
        let shares = |from: &[f64]| -> Vec<f64> {
            if variance == 0.0 {
                return vec![0.0; self.mixed.len()];
            }
            self.mixed.iter().map(|mixed| share(from, mixed)).collect()
        };
        let left = shares(&self.b);
        let first = left
            .iter()
            .map(|s| if variance == 0.0 { 0.0 } else { 1.0 - s })
            .collect();
        let total = shares(&self.a);
        let finite = mean.is_finite() && variance.is_finite() && left.iter().chain(&total).all(|s| s.is_finite());
        finite.then_some(Raw {
            mean,
            variance,
            first,
            total,
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_sum_shares_its_variance_by_squares() {
        // Slopes 3 and 4: shares 9/25 and 16/25, without interaction. Quadrature by 4096 points errs by some 1e-3.
        let function = |x: &[f64]| Ok(vec![3.0 * x[0] + 4.0 * x[1], 7.0, (x[0] - 0.5) * (x[1] - 0.5)]);
        let found = variance_shares(3, 4096, 50, function).unwrap();
        for (estimates, expected) in [
            (&found[0].first, [0.36, 0.64, 0.0]),
            (&found[0].total, [0.36, 0.64, 0.0]),
        ] {
            for (estimate, share) in estimates.iter().zip(expected) {
                assert!((estimate.value - share).abs() < 3e-3, "{estimate:?}");
                assert!(estimate.interval[0] <= estimate.interval[1]);
            }
        }
        assert!((found[0].variance - 25.0 / 12.0).abs() < 2e-3 && !found[0].interact());
        assert_eq!(found[1].variance, 0.0);
        assert!(found[1].first.iter().chain(&found[1].total).all(|e| e.value == 0.0) && !found[1].interact());
        // A pure interaction: neither explains anything alone.
        assert!(found[2].interact() && found[2].first[0].value.abs() < 0.03 && found[2].total[0].value > 0.9);
    }

    #[test]
    fn the_same_bits_on_any_number_of_threads() {
        let function = |x: &[f64]| Ok(vec![(x[0] * 9.0).sin() * x[1].exp(), x[2]]);
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| variance_shares(3, 256, 40, function).unwrap())
        };
        assert_eq!(on(1), on(3));
    }

    #[test]
    fn what_cannot_be_shared_is_refused() {
        let one = |_: &[f64]| Ok(vec![1.0]);
        assert!(variance_shares(2, 1000, 0, one).unwrap_err().contains("power of two"));
        assert!(variance_shares(2, 0, 0, one).is_err());
        assert!(variance_shares(33, 8, 0, one).is_err());
        assert!(variance_shares(1, 8, 0, |x: &[f64]| Ok(vec![1e300 * x[0]])).is_err());
        let none = variance_shares(1, 8, 0, |x: &[f64]| Ok(vec![x[0]])).unwrap();
        assert_eq!(none[0].first[0].interval, [none[0].first[0].value; 2]);
    }
}
