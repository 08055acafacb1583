//! Random effects: groups with a common mean that differ from each other, each mean known with its own error.
//!
//! The mean of group j is normal about the common mean with the variance tau^2 + s_j^2: tau, the deviation between the groups, is unknown, and
//! the deviation s_j of the error of the group is known. The distribution of a further group integrates over both unknowns. Prior of the
//! common mean: constant. Prior of tau: that of Jeffreys, proportional to tau sqrt(sum 1/(tau^2 + s_j^2)^2), which has no scale to choose.
//! It is proportional to 1/tau where the errors are small: then a further group has Student's t over the means of the groups.
//!
//! Source: Bodnar, Link, Arendacka, Possolo, Elster, Bayesian estimation in random effects meta-analysis using a non-informative prior,
//! Statistics in Medicine 36 (2017) 378-399. The integral over tau is by the trapezoidal rule over its logarithm.

use std::f64::consts::PI;

use super::probability::normal_below;

/// Step of the logarithm of tau. The integrand is smooth, so that the rule converges exponentially.
const STEP: f64 = 0.1;

/// Ends of tau: below the least error and above the greatest deviation by this factor. The prior falls with tau^2 below, the posterior of
/// three groups with 1/tau^2 above.
const BEYOND: f64 = 1e3;

/// Least error of a group relative to the spread of the means, so that equal means have a distribution.
const LEAST: f64 = 1e-6;

/// The mean of one group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Group {
    /// Its mean.
    pub mean: f64,
    /// Standard deviation of its error.
    pub error: f64,
}

/// A normal distribution with the probability that it is the right one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Component {
    weight: f64,
    mean: f64,
    deviation: f64,
}

/// The distribution of a further group: a mixture of normal distributions, one for each tau.
#[derive(Debug, Clone, PartialEq)]
pub struct Further(Vec<Component>);

impl Further {
    /// From the means of at least two groups, for a value that deviates from its group with a known deviation.
    ///
    /// Absent with fewer groups, with numbers that are not finite, or if all groups are equal and known exactly.
    pub fn new(groups: &[Group], scatter: f64) -> Option<Self> {
        let valid = |group: &Group| group.mean.is_finite() && group.error.is_finite() && group.error >= 0.0;
        if groups.len() < 2 || !groups.iter().all(valid) || !(scatter.is_finite() && scatter >= 0.0) {
            return None;
        }
        let ends = groups
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], group| {
                [low.min(group.mean), high.max(group.mean)]
            });
        let greatest = groups.iter().map(|group| group.error).fold(ends[1] - ends[0], f64::max);
        let floor = LEAST * greatest;
        let errors = groups.iter().map(|group| group.error.max(floor));
        let least = errors.clone().fold(f64::INFINITY, f64::min);
        if greatest <= 0.0 || !greatest.is_finite() {
            return None;
        }
        let squares: Vec<f64> = errors.map(|error| error * error).collect();
        let [from, to] = [(least / BEYOND).ln(), (greatest * BEYOND).ln()];
        let count = ((to - from) / STEP).ceil() as usize;
        let nodes: Vec<(f64, Component)> = (0..=count)
            .map(|i| node(groups, &squares, (from + STEP * i as f64).exp(), scatter))
            .collect();
        let top = nodes.iter().map(|(log, _)| *log).fold(f64::NEG_INFINITY, f64::max);
        let mut all: Vec<Component> = nodes
            .into_iter()
            .map(|(log, component)| Component {
                weight: (log - top).exp(),
                ..component
            })
            .filter(|component| component.weight > 1e-12)
            .collect();
        let sum: f64 = all.iter().map(|component| component.weight).sum();
        for component in &mut all {
            component.weight /= sum;
        }
        Some(Self(all))
    }

    /// Probability that a value is below a number.
    pub fn below(&self, x: f64) -> f64 {
        let below = |c: &Component| c.weight * normal_below((x - c.mean) / c.deviation).unwrap_or(0.0);
        self.0.iter().map(below).sum()
    }

    /// The quantile of a probability; absent unless it is between zero and one, both excluded.
    pub fn quantile(&self, probability: f64) -> Option<f64> {
        if !(probability > 0.0 && probability < 1.0) {
            return None;
        }
        let narrowest = self.0.iter().map(|c| c.deviation).fold(f64::INFINITY, f64::min);
        let centre = self.0.iter().map(|c| c.weight * c.mean).sum::<f64>();
        let (mut low, mut high, mut reach) = (centre, centre, narrowest);
        while self.below(low) > probability && reach.is_finite() {
            low = centre - reach;
            reach *= 2.0;
        }
        while self.below(high) < probability && reach.is_finite() {
            high = centre + reach;
            reach *= 2.0;
        }
        // Newton's steps, halved where they would leave the bracket. Nine digits are more than any distribution of few groups has.
        let mut x = 0.5 * (low + high);
        for _ in 0..200 {
            let difference = self.below(x) - probability;
            if difference < 0.0 {
                low = x;
            } else {
                high = x;
            }
            let newton = x - difference / self.density(x);
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - x).abs() <= 1e-9 * (narrowest + x.abs()) {
                return Some(next);
            }
            x = next;
        }
        Some(x)
    }

    fn density(&self, x: f64) -> f64 {
        let density = |c: &Component| {
            let t = (x - c.mean) / c.deviation;
            c.weight * (-0.5 * t * t).exp() / (c.deviation * (2.0 * PI).sqrt())
        };
        self.0.iter().map(density).sum()
    }
}

/// The logarithm of the posterior of the logarithm of tau, up to a constant, and the distribution of a further value with it.
fn node(groups: &[Group], squares: &[f64], tau: f64, scatter: f64) -> (f64, Component) {
    let weights = squares.iter().map(|square| 1.0 / (tau * tau + square));
    let sum: f64 = weights.clone().sum();
    let mean = groups.iter().zip(weights.clone()).map(|(g, w)| w * g.mean).sum::<f64>() / sum;
    let misfit: f64 = groups
        .iter()
        .zip(weights.clone())
        .map(|(g, w)| w * (g.mean - mean) * (g.mean - mean))
        .sum();
    let logs: f64 = weights.clone().map(f64::ln).sum();
    // One tau of the prior, one of the step in the logarithm.
    let prior = 2.0 * tau.ln() + 0.5 * weights.map(|w| w * w).sum::<f64>().ln();
    let log = 0.5 * (logs - sum.ln() - misfit) + prior;
    let variance = tau * tau + 1.0 / sum + scatter * scatter;
    (
        log,
        Component {
            weight: 0.0,
            mean,
            deviation: variance.sqrt(),
        },
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::inference::probability::student_quantile;
    use crate::sampling::{Generator, inverse_normal};

    fn groups(list: &[(f64, f64)]) -> Vec<Group> {
        list.iter()
            .map(|(mean, error)| Group {
                mean: *mean,
                error: *error,
            })
            .collect()
    }

    #[test]
    fn without_errors_a_further_group_has_students_t() {
        for means in [vec![-0.1, 0.0, 0.1], vec![0.3, -0.2, 0.05, 0.7, 0.1]] {
            let count = means.len() as f64;
            let mean = means.iter().sum::<f64>() / count;
            let variance = means.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count - 1.0);
            let scale = (variance * (1.0 + 1.0 / count)).sqrt();
            let further = Further::new(&groups(&means.iter().map(|x| (*x, 0.0)).collect::<Vec<_>>()), 0.0).unwrap();
            for probability in [0.025, 0.2, 0.5, 0.975] {
                let expected = mean + scale * student_quantile(probability, count - 1.0).unwrap();
                let found = further.quantile(probability).unwrap();
                assert!((found - expected).abs() < 1e-4 * scale, "{found} {expected}");
            }
        }
    }

    #[test]
    fn what_differs_less_than_its_errors_does_not_differ_much() {
        // Errors of 0.5 explain means within 0.02: the further group is far nearer than its own error.
        let alike = Further::new(
            &groups(&[
                (0.0, 0.5),
                (0.01, 0.5),
                (0.02, 0.5),
                (0.0, 0.5),
                (0.01, 0.5),
                (0.02, 0.5),
            ]),
            0.0,
        )
        .unwrap();
        let apart = Further::new(
            &groups(&[
                (-1.0, 0.5),
                (1.0, 0.5),
                (0.9, 0.5),
                (-0.9, 0.5),
                (1.1, 0.5),
                (-1.1, 0.5),
            ]),
            0.0,
        )
        .unwrap();
        let width = |of: &Further| of.quantile(0.975).unwrap() - of.quantile(0.025).unwrap();
        assert!(
            width(&alike) < 2.0 && width(&apart) > 4.0,
            "{} {}",
            width(&alike),
            width(&apart)
        );
    }

    #[test]
    fn scatter_widens_and_few_groups_have_none() {
        let list = groups(&[(0.1, 0.1), (0.3, 0.1), (-0.2, 0.1)]);
        let [without, with] = [0.0, 0.5].map(|scatter| Further::new(&list, scatter).unwrap().quantile(0.9).unwrap());
        assert!(with > without + 0.1);
        assert_eq!(Further::new(&list[..1], 0.0), None);
        assert_eq!(Further::new(&groups(&[(1.0, 0.0), (1.0, 0.0)]), 0.0), None);
        assert_eq!(Further::new(&groups(&[(1.0, f64::NAN), (1.0, 0.0)]), 0.0), None);
        let further = Further::new(&list, 0.1).unwrap();
        assert_eq!([0.0, 1.0, f64::NAN].map(|p| further.quantile(p)), [None; 3]);
        let x = further.quantile(0.3).unwrap();
        assert!((further.below(x) - 0.3).abs() < 1e-6);
    }

    /// Mean probability that a further group is inside its 95 % interval, over 200 simulations.
    fn coverage(count: usize, tau: f64, scatter: f64) -> f64 {
        let mut random = Generator::new(7);
        let mut normal = || inverse_normal(random.unit().max(1e-12)).unwrap();
        let mean = 0.2;
        let mut sum = 0.0;
        for _ in 0..200 {
            let list: Vec<Group> = (0..count)
                .map(|j| {
                    let error = 0.05 + 0.05 * (j % 3) as f64;
                    Group {
                        mean: mean + tau * normal() + error * normal(),
                        error,
                    }
                })
                .collect();
            let further = Further::new(&list, scatter).unwrap();
            let deviation = (tau * tau + scatter * scatter).sqrt();
            let below = |p: f64| normal_below((further.quantile(p).unwrap() - mean) / deviation).unwrap();
            sum += below(0.975) - below(0.025);
        }
        sum / 200.0
    }

    #[test]
    fn the_interval_of_a_further_group_covers_it() {
        for (count, tau, scatter) in [
            (3, 0.3, 0.0),
            (3, 0.3, 0.3),
            (5, 0.3, 0.2),
            (5, 0.6, 0.0),
            (8, 0.15, 0.1),
        ] {
            let share = coverage(count, tau, scatter);
            assert!(
                (0.90..=0.98).contains(&share),
                "{count} groups, tau {tau}, scatter {scatter}: {share}"
            );
        }
    }
}
