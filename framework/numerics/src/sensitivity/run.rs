//! Many evaluations of a function.

use rayon::prelude::*;

/// Makes the point of a number.
pub type PointOf<'a> = dyn Fn(usize) -> Vec<f64> + Sync + 'a;

/// Outputs over points: a function of one point, which is evaluated on all threads, or another evaluator of many points.
pub trait Evaluate {
    /// The outputs at so many points, in the order of their numbers.
    fn outputs(&self, count: usize, point: &PointOf<'_>) -> Vec<Result<Vec<f64>, String>>;
}

impl<F: Fn(&[f64]) -> Result<Vec<f64>, String> + Sync> Evaluate for F {
    fn outputs(&self, count: usize, point: &PointOf<'_>) -> Vec<Result<Vec<f64>, String>> {
        let numbers = (0..count).into_par_iter().with_max_len(1);
        numbers.map(|i| self(&point(i))).collect()
    }
}

/// Outputs at points that are made from their number, in the order of the numbers.
///
/// # Errors
/// The first fault in that order: of the function, of outputs that are not finite, or of a count of outputs that changes.
pub(super) fn outputs(
    count: usize,
    point: impl Fn(usize) -> Vec<f64> + Sync,
    function: &impl Evaluate,
) -> Result<Vec<Vec<f64>>, String> {
    let run = |(i, found): (usize, Result<Vec<f64>, String>)| {
        let place = || point(i).iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
        let list = found.map_err(|fault| format!("at ({}): {fault}", place()))?;
        match list.iter().position(|y| !y.is_finite()) {
            Some(k) => Err(format!("at ({}): output {} is {}", place(), k + 1, list[k])),
            None => Ok(list),
        }
    };
    // All runs end before a fault is looked for, so that it is the same one on any number of threads.
    let all = function.outputs(count, &point).into_iter().enumerate().map(run);
    let all = all.collect::<Result<Vec<_>, _>>()?;
    let width = all.first().map_or(0, Vec::len);
    match all.iter().position(|list| list.len() != width) {
        Some(i) => Err(format!(
            "{width} outputs at the first point and {} at point {}",
            all[i].len(),
            i + 1
        )),
        None => Ok(all),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_first_fault_is_reported() {
        let point = |i: usize| vec![i as f64];
        let fails = |x: &[f64]| {
            if x[0] >= 3.0 {
                Err("too hot".to_owned())
            } else {
                Ok(vec![x[0]])
            }
        };
        assert_eq!(outputs(9, point, &fails).unwrap_err(), "at (3): too hot");
        let infinite = |x: &[f64]| Ok(vec![1.0, 1.0 / (x[0] - 2.0)]);
        assert_eq!(outputs(9, point, &infinite).unwrap_err(), "at (2): output 2 is inf");
        let ragged = |x: &[f64]| Ok(vec![0.0; 1 + usize::from(x[0] > 4.0)]);
        assert!(outputs(9, point, &ragged).unwrap_err().contains("2 at point 6"));
        assert_eq!(outputs(2, point, &fails).unwrap(), [[0.0], [1.0]]);
    }
}
