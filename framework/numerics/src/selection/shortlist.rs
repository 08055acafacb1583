//! The combinations that are not distinguishable from the winner, with weights, and the spread of their predictions.
//!
//! Weights are Akaike weights on the misfit of the cross-validated predictions, averaged over resampled folds: pseudo-BMA with the Bayesian
//! bootstrap (Yao, Vehtari, Simpson, Gelman, Bayesian Analysis 13 (2018) 917-1007, section 3.4; Rubin, Ann. Statist. 9 (1981) 130-134). For
//! each of some draws of fold weights alpha, which are positive and sum to one, w_i ~ exp(-Q_i/2) with Q_i = K sum alpha_k Q_ik.
//! Cross-validation needs no penalty for parameters. Q_ik is the sum of squares of a fold over the variance of the errors and over 1 + (n -
//! 1) rho, which accounts for the correlation of the n points of a fold (Kish, Survey Sampling, Wiley 1965).
//!
//! Plain Akaike weights treat every point as independent evidence and give all the weight to one of many indistinguishable combinations; so
//! does stacking for nearly equal predictions. The spread would then ignore the others.

use super::{Combination, Losses, MeasuredLosses, Winner};
use crate::inference::Decision;
use crate::sampling::Sobol;

/// The combinations that are not significantly worse than the winner.
#[derive(Debug, Clone, PartialEq)]
pub struct Shortlist {
    /// Indices in the ranking.
    pub members: Vec<usize>,
    /// Weight of each member; their sum is one. \[-\]
    pub weights: Vec<f64>,
    /// Weighted mean of the predicted losses, by point. \[W\]
    pub means: Vec<f64>,
    /// Weighted standard deviation of them: the uncertainty from the choice of models. \[W\]
    pub deviations: Vec<f64>,
    /// Minimum and maximum of them. \[W\]
    pub ranges: Vec<[f64; 2]>,
}

/// Draws of fold weights.
const DRAWS: u32 = 256;

/// The combinations that the winner is not significantly better than.
pub fn shortlist(ranked: &[Combination], winner: &Winner, losses: &Losses<'_>, measured: &MeasuredLosses) -> Shortlist {
    let alike = |place: &usize| *place == winner.place || winner.standings[*place].decision != Decision::Better;
    let members: Vec<usize> = (0..ranked.len()).filter(alike).collect();
    // Folds without a valid point have no mean square in any combination.
    let counts = measured
        .folds
        .iter()
        .map(|fold| fold.iter().map(|i| measured.weights[*i].max(0.0)).sum::<f64>());
    let counts: Vec<f64> = counts.filter(|count| *count > 0.0).collect();
    let design = |count: f64| winner.errors.variance * (1.0 + (count - 1.0).max(0.0) * winner.errors.correlation);
    let misfit = |place: &usize| -> Vec<f64> {
        let squares = ranked[*place].mean_squares.iter().zip(&counts);
        squares.map(|(square, count)| square * count / design(*count)).collect()
    };
    let weights = weights(&members.iter().map(misfit).collect::<Vec<_>>());
    let count = measured.len();
    let (mut means, mut deviations) = (vec![0.0; count], vec![0.0; count]);
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; count];
    let loss = |place: usize, i: usize| losses.loss(&ranked[place].places, &ranked[place].factors, i);
    for i in 0..count {
        for (place, weight) in members.iter().zip(&weights) {
            let loss = loss(*place, i);
            means[i] += weight * loss;
            ranges[i] = [ranges[i][0].min(loss), ranges[i][1].max(loss)];
        }
        let square = |(place, weight): (&usize, &f64)| weight * (loss(*place, i) - means[i]).powi(2);
        deviations[i] = members.iter().zip(&weights).map(square).sum::<f64>().sqrt();
    }
    Shortlist {
        members,
        weights,
        means,
        deviations,
        ranges,
    }
}

/// Weights from the misfits of each combination by fold.
fn weights(misfits: &[Vec<f64>]) -> Vec<f64> {
    let folds = misfits.first().map_or(0, Vec::len);
    // At most twenty folds, fewer than the dimensions of Sobol points.
    let shares = |draw: u32, sobol: &Sobol| -> Vec<f64> {
        let raw: Vec<f64> = sobol.point(draw).iter().map(|u| -u.ln()).collect();
        let sum: f64 = raw.iter().sum();
        raw.iter().map(|x| folds as f64 * x / sum).collect()
    };
    let draws: Vec<Vec<f64>> = match Sobol::new(folds) {
        // Index zero is a corner.
        Ok(sobol) => (1..=DRAWS).map(|draw| shares(draw, &sobol)).collect(),
        Err(_) => vec![vec![1.0; folds]],
    };
    let mut weights = vec![0.0; misfits.len()];
    for draw in &draws {
        let whole = |squares: &Vec<f64>| squares.iter().zip(draw).map(|(q, share)| q * share).sum::<f64>();
        let all: Vec<f64> = misfits.iter().map(whole).collect();
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        let raw: Vec<f64> = all.iter().map(|q| (-0.5 * (q - least)).exp()).collect();
        let sum = draws.len() as f64 * raw.iter().sum::<f64>();
        for (weight, raw) in weights.iter_mut().zip(raw) {
            *weight += raw / sum;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::ranking::tests::{measured, shapes};
    use super::super::{rank, winner};
    use super::*;

    #[test]
    fn weights_follow_misfits() {
        let near = |found: &[f64], wanted: &[f64]| found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(near(&weights(&[vec![5.0; 4], vec![5.0; 4]]), &[0.5, 0.5]));
        // The same difference in every fold: plain Akaike weights.
        let [a, b]: [f64; 2] = weights(&[vec![1.0; 4], vec![1.5; 4]]).try_into().unwrap();
        assert!((a / b - 1.0_f64.exp()).abs() < 1e-9 && (a + b - 1.0).abs() < 1e-12);
        // Each better in one half of the folds by far: neither has all the weight, though the sums differ by much.
        let [a, b]: [f64; 2] = weights(&[vec![0.0, 60.0, 0.0, 60.0], vec![60.0, 0.0, 80.0, 0.0]])
            .try_into()
            .unwrap();
        assert!(a > b && b > 0.2, "{a} {b}");
    }

    #[test]
    fn indistinguishable_models_have_a_spread_of_predictions() {
        let [load, _, other] = shapes();
        let measured = measured(
            load.iter()
                .enumerate()
                .map(|(i, x)| x + [0.8, -0.9, 0.1][i % 3])
                .collect(),
            1.0,
        );
        let near: Vec<f64> = load.iter().map(|x| x + 0.2).collect();
        let rest = vec![0.0; load.len()];
        let losses = Losses {
            rest: &rest,
            mechanisms: vec![vec![load.as_slice(), near.as_slice(), other.as_slice()]],
        };
        let ranked = rank(&losses, &measured, None, &|| true);
        let chosen = winner(&ranked, &|_| false, &losses, &measured, None).unwrap();
        let found = shortlist(&ranked, &chosen, &losses, &measured);
        assert_eq!(found.members, [0, 1]);
        assert!((found.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for i in 0..load.len() {
            let [low, high] = found.ranges[i];
            assert!((high - low - 0.2).abs() < 1e-9);
            assert!(found.deviations[i] > 0.0 && found.deviations[i] <= 0.1 + 1e-9);
            assert!(low <= found.means[i] && found.means[i] <= high);
        }
    }
}
