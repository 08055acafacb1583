//! Whether residuals are normally distributed.
//!
//! Sources: Anderson, Darling, J. Amer. Statist. Assoc. 49 (1954) 765-769; Stephens, the same 69 (1974) 730-737, for mean and
//! variance estimated; probabilities after D'Agostino, Stephens: Goodness-of-Fit Techniques (Dekker 1986), table 4.9.

use super::probability::normal_below;

/// The Anderson-Darling test, which is sensitive to the tails, with mean and variance from the sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AndersonDarling {
    /// The statistic A^2.
    pub statistic: f64,
    /// The statistic corrected for the size of the sample.
    pub corrected: f64,
    /// Probability of a statistic at least this large if the sample is normal.
    pub probability: f64,
}

/// Tests a sample; absent if there are fewer than eight values, for which the correction does not apply, or all are equal.
pub fn anderson_darling(values: &[f64]) -> Option<AndersonDarling> {
    let count = values.len() as f64;
    if values.len() < 8 {
        return None;
    }
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count - 1.0);
    let mut standard: Vec<f64> = values.iter().map(|x| (x - mean) / variance.sqrt()).collect();
    standard.sort_by(f64::total_cmp);
    // Beyond 38 deviations the probability underflows.
    let ln_below = |z: f64| Some(normal_below(z)?.max(f64::MIN_POSITIVE).ln());
    let mut sum = 0.0;
    for (i, z) in standard.iter().enumerate() {
        let mirrored = -standard[standard.len() - 1 - i];
        sum += (2.0 * i as f64 + 1.0) * (ln_below(*z)? + ln_below(mirrored)?);
    }
    let statistic = -count - sum / count;
    let corrected = statistic * (1.0 + 0.75 / count + 2.25 / (count * count));
    Some(AndersonDarling {
        statistic,
        corrected,
        probability: probability(corrected),
    })
}

/// Approximation by exponentials of parabolas, piece by piece.
fn probability(a: f64) -> f64 {
    let parabola = |[c, b, q]: [f64; 3], a: f64| (c + b * a + q * a * a).exp();
    let p = if a >= 0.6 {
        // The parabola increases above 153, where the probability is negligible.
        parabola([1.2937, -5.709, 0.0186], a.min(150.0))
    } else if a > 0.34 {
        parabola([0.9177, -4.279, -1.38], a)
    } else if a > 0.2 {
        1.0 - parabola([-8.318, 42.796, -59.938], a)
    } else {
        1.0 - parabola([-13.436, 101.14, -223.73], a)
    };
    p.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::sampling::inverse_normal;

    #[test]
    fn probabilities_of_the_published_points() {
        // Upper points for mean and variance estimated, Stephens (1974): 10 % 0.631, 5 % 0.752, 2.5 % 0.873, 1 % 1.035 (1986).
        for (a, p) in [(0.631, 0.10), (0.752, 0.05), (0.873, 0.025), (1.035, 0.01)] {
            assert!((probability(a) / p - 1.0).abs() < 0.03, "{a}: {}", probability(a));
        }
        // The pieces meet within the digits of their coefficients.
        for joint in [0.2, 0.34, 0.6] {
            assert!(
                (probability(joint - 1e-9) - probability(joint + 1e-9)).abs() < 0.01,
                "{joint}"
            );
        }
        assert_eq!(probability(1e9), probability(150.0));
    }

    #[test]
    fn normal_scores_pass_and_steps_do_not() {
        let scores: Vec<f64> = (0..100)
            .map(|i| inverse_normal((f64::from(i) + 0.5) / 100.0).unwrap())
            .collect();
        assert!(anderson_darling(&scores).unwrap().probability > 0.99);
        let steps: Vec<f64> = (0..100).map(|i| f64::from(i % 2)).collect();
        assert!(anderson_darling(&steps).unwrap().probability < 1e-6);
        let mut outlier = scores.clone();
        outlier.push(1e6);
        assert!(anderson_darling(&outlier).unwrap().probability < 1e-6);
    }

    #[test]
    fn what_cannot_be_tested_is_reported() {
        assert_eq!(anderson_darling(&[1.0; 7]), None);
        assert_eq!(anderson_darling(&[1.0; 20]), None);
        assert_eq!(anderson_darling(&[f64::NAN; 20]), None);
    }
}
