//! Draws from an unnormalised density by an ensemble of walkers.
//!
//! It needs no derivatives, which do not exist everywhere for laws with kinks and jumps, and correlations between coordinates do not slow
//! it down. The draws depend only on the seed, not on the number of threads.
//!
//! Sources: Goodman, Weare, Comm. Appl. Math. Comput. Sci. 5 (2010) 65-80 (stretch moves); ter Braak, Stat. Comput. 16 (2006) 239-249
//! (moves along differences); Sokal in: Functional Integration (Springer 1997) 131-192 (autocorrelation time); Vehtari et al., Bayesian
//! Analysis 16 (2021) 667-718 (required number of independent draws).

use std::ops::ControlFlow;

use hammer_and_sample::{DifferentialEvolution, Mixture, Model, Parallel, Schedule, Stretch, auto_corr_time, sample};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

use crate::statistics::quantile;

/// Share of the steps that are discarded as burn-in.
const THROWN_AWAY: f64 = 1.0 / 3.0;
/// Number of independent draws required for the ends of an interval.
const ENOUGH: f64 = 400.0;
/// Minimum number of autocorrelation times of a run (a convention), so that the burn-in is long enough.
const TIMES: f64 = 20.0;
/// Relative scatter of the length of moves along differences.
const SCATTER: f64 = 1e-3;
/// Shares of the draws below the median and the ends of the interval.
const SHARES: [f64; 3] = [0.5, 0.025, 0.975];

/// Settings of the sampler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ensemble {
    /// Number of walkers; increased to an even number of at least twice the number of coordinates.
    pub walkers: usize,
    /// Steps of each walker; the first third is discarded.
    pub steps: usize,
    /// Seed.
    pub seed: u64,
}

/// Draws from a density.
#[derive(Debug, Clone, PartialEq)]
pub struct Draws {
    /// Coordinates, step by step, with all walkers of a step.
    chain: Vec<Vec<f64>>,
    /// Number of walkers.
    pub walkers: usize,
    /// Number of retained steps of each walker.
    pub steps: usize,
    /// Share of the moves that were accepted.
    pub acceptance: f64,
}

/// Summary of the draws of one coordinate, or of an increasing function of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marginal {
    /// Median.
    pub median: f64,
    /// Ends of the 95 % interval.
    pub interval: [f64; 2],
    /// Standard deviation of the draws.
    pub deviation: f64,
    /// Integrated autocorrelation time in steps.
    pub autocorrelation: f64,
    /// Effective number of independent draws.
    pub effective: f64,
}

/// The logarithm of a density as a model of the sampler.
struct Density<F>(F);

impl<F: Fn(&[f64]) -> f64 + Sync + Send> Model for Density<F> {
    type Params = Vec<f64>;

    fn log_prob(&self, coordinates: &Vec<f64>) -> f64 {
        let density = (self.0)(coordinates);
        if density.is_nan() { f64::NEG_INFINITY } else { density }
    }
}

/// The given number of steps, unless stopped.
struct Steps<'a> {
    left: usize,
    interrupt: Option<&'a (dyn Fn() -> bool + Sync)>,
}

impl Schedule<Vec<f64>> for Steps<'_> {
    fn next_step(&mut self, _: &[Vec<f64>]) -> ControlFlow<()> {
        if self.left == 0 || self.interrupt.is_some_and(|stop| stop()) {
            return ControlFlow::Break(());
        }
        self.left -= 1;
        ControlFlow::Continue(())
    }
}

impl Ensemble {
    /// Draws from a density, given its logarithm (minus infinity for zero density). Walkers start between the ends of `begin`, one pair for
    /// each coordinate. Absent if stopped, or without coordinates.
    pub fn draws(
        &self,
        log_density: impl Fn(&[f64]) -> f64 + Sync + Send,
        begin: &[[f64; 2]],
        interrupt: Option<&(dyn Fn() -> bool + Sync)>,
    ) -> Option<Draws> {
        let dimension = begin.len();
        if dimension == 0 {
            return None;
        }
        // Moves along differences use two walkers of the other half.
        let walkers = 2 * self.walkers.div_ceil(2).max(dimension).max(2);
        let beginnings = (0..walkers).map(|i| {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(self.seed.wrapping_add(i as u64));
            let place = begin
                .iter()
                .map(|[low, high]| low + (high - low) * random.random::<f64>());
            (place.collect::<Vec<f64>>(), random)
        });
        let beginnings: Vec<_> = beginnings.collect();
        let length = 2.38 / (2.0 * dimension as f64).sqrt();
        let moves = Mixture::from((
            (Stretch::default(), 1_u32),
            (DifferentialEvolution::new(length, SCATTER * length), 1_u32),
        ));
        let steps = Steps {
            left: self.steps,
            interrupt,
        };
        let (mut chain, accepted) = sample(&Density(log_density), &moves, beginnings.into_iter(), steps, Parallel);
        if chain.len() < walkers * self.steps {
            return None;
        }
        let acceptance = accepted as f64 / chain.len().max(1) as f64;
        let thrown_away = (THROWN_AWAY * self.steps as f64) as usize;
        chain.drain(..thrown_away * walkers);
        Some(Draws {
            chain,
            walkers,
            steps: self.steps - thrown_away,
            acceptance,
        })
    }
}

impl Draws {
    /// Summary of the draws of a coordinate; `value` is an increasing function that converts it.
    pub fn marginal(&self, place: usize, value: impl Fn(f64) -> f64) -> Marginal {
        let mut draws: Vec<f64> = self.chain.iter().map(|u| value(u[place])).collect();
        let count = draws.len() as f64;
        let mean = draws.iter().sum::<f64>() / count;
        let deviation = (draws.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count).sqrt();
        draws.sort_by(f64::total_cmp);
        let [median, low, high] = SHARES.map(|share| quantile(&draws, share));
        // A walker that never moved has no autocorrelation time: use all of its steps.
        let time = |walker: usize| {
            let walked = (0..self.steps).map(|step| self.chain[step * self.walkers + walker][place]);
            let time = auto_corr_time(walked, None, Some(0)).filter(|time| time.is_finite());
            time.map_or(self.steps as f64, |time| time.max(1.0))
        };
        let autocorrelation = (0..self.walkers).map(time).sum::<f64>() / self.walkers as f64;
        Marginal {
            median,
            interval: [low, high],
            deviation,
            autocorrelation,
            effective: count / autocorrelation,
        }
    }

    /// Whether the run was long enough: at least 400 independent draws, and at least 20 autocorrelation times.
    pub fn is_settled(&self, marginals: impl IntoIterator<Item = Marginal>) -> bool {
        let long = |m: Marginal| m.effective >= ENOUGH && self.steps as f64 >= TIMES * m.autocorrelation;
        marginals.into_iter().all(long)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const LONG: Ensemble = Ensemble {
        walkers: 16,
        steps: 6000,
        seed: 1,
    };

    /// Deviations from a quantile that chance allows: four standard errors of the effective draws.
    fn near(found: f64, due: f64, marginal: &Marginal) -> bool {
        (found - due).abs() < 4.0 * 2.0 * marginal.deviation / marginal.effective.sqrt()
    }

    #[test]
    fn correlated_normal_coordinates_have_their_known_quantiles() {
        // Deviations 1 and 100, correlation 0.95.
        let rho = 0.95_f64;
        let density = |u: &[f64]| {
            let [x, y] = [u[0], u[1] / 100.0];
            -0.5 * (x * x - 2.0 * rho * x * y + y * y) / (1.0 - rho * rho)
        };
        let draws = LONG.draws(density, &[[-0.1, 0.1], [-10.0, 10.0]], None).unwrap();
        for (place, scale) in [(0, 1.0), (1, 100.0)] {
            let marginal = draws.marginal(place, |u| u);
            assert!(marginal.effective > 1000.0, "{marginal:?}");
            assert!(near(marginal.median, 0.0, &marginal), "{marginal:?}");
            for (end, due) in marginal.interval.into_iter().zip([-1.96, 1.96]) {
                assert!(near(end, scale * due, &marginal), "{marginal:?}");
            }
            assert!((marginal.deviation / scale - 1.0).abs() < 0.1, "{marginal:?}");
        }
        assert!(draws.is_settled([0, 1].map(|place| draws.marginal(place, |u| u))));
    }

    #[test]
    fn a_density_with_edges_stays_inside_and_fills_them() {
        // Even between zero and one: quantiles are known.
        let density = |u: &[f64]| {
            if (0.0..=1.0).contains(&u[0]) {
                0.0
            } else {
                f64::NEG_INFINITY
            }
        };
        let draws = LONG.draws(density, &[[0.4, 0.6]], None).unwrap();
        let marginal = draws.marginal(0, |u| u);
        assert!(near(marginal.interval[0], 0.025, &marginal) && near(marginal.interval[1], 0.975, &marginal));
        assert!(draws.chain.iter().all(|u| (0.0..=1.0).contains(&u[0])));
    }

    #[test]
    fn draws_follow_from_the_seed_alone() {
        let few = Ensemble { steps: 50, ..LONG };
        let density = |u: &[f64]| -0.5 * u[0] * u[0];
        let again = || few.draws(density, &[[-1.0, 1.0]], None).unwrap();
        let one = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .build()
            .unwrap()
            .install(again);
        assert_eq!(one, again());
        let other = Ensemble { seed: 2, ..few };
        assert_ne!(one, other.draws(density, &[[-1.0, 1.0]], None).unwrap());
    }

    #[test]
    fn too_few_steps_are_not_settled_and_a_stop_leaves_nothing() {
        let few = Ensemble { steps: 30, ..LONG };
        let density = |u: &[f64]| -0.5 * u[0] * u[0];
        let draws = few.draws(density, &[[-1.0, 1.0]], None).unwrap();
        assert!(!draws.is_settled([draws.marginal(0, |u| u)]));
        assert_eq!(few.draws(density, &[[-1.0, 1.0]], Some(&|| true)), None);
        assert_eq!(few.draws(density, &[], None), None);
    }
}
