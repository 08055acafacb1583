//! Evaluations of a user function.

use rayon::prelude::*;

/// Outputs at points generated from their index, in order.
///
/// # Errors
/// The first error in that order: from the function, from non-finite outputs, or from a changed number of outputs.
pub(super) fn outputs<F>(
    count: usize,
    point: impl Fn(usize) -> Vec<f64> + Sync,
    function: &F,
) -> Result<Vec<Vec<f64>>, String>
where
    F: Fn(&[f64]) -> Result<Vec<f64>, String> + Sync,
{
    let run = |i: usize| {
        let at = point(i);
        let place = || at.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
        let list = function(&at).map_err(|fault| format!("at ({}): {fault}", place()))?;
        match list.iter().position(|y| !y.is_finite()) {
            Some(k) => Err(format!("at ({}): output {} is {}", place(), k + 1, list[k])),
            None => Ok(list),
        }
    };
    // All evaluations finish before errors are checked, so that the reported error does not depend on the number of threads.
    let all: Vec<Result<Vec<f64>, String>> = (0..count).into_par_iter().with_max_len(1).map(run).collect();
    let all = all.into_iter().collect::<Result<Vec<_>, _>>()?;
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
    fn the_first_fault_is_told() {
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
