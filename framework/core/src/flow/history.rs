//! Extrapolation of the torques at the next speed from the same points at previous speeds.

use super::linear::larger;
use super::work::Drive;
use crate::lanes::{LANES, Lane, count, weighted};

/// Number of steps used: a polynomial through four of them.
const DEPTH: usize = 4;
/// Maximum amplification of the errors of previous torques in a guess; a cubic over even steps has 15.
const SPREAD: f64 = 16.0;
/// Ratio of speeds, up or down, within which a measured rate is used unchanged; even steps may reach it except for rounding.
const NEAR: f64 = 2.0 * (1.0 + 1e-9);
/// Number of guesses within which it is used unchanged.
const MANY: f64 = 256.0;
/// Growth at which a rate is measured again, independent of the quality of the guesses, which is judged by this rate.
const MOST: f64 = 4.0;
/// A rate that could not be measured; with it an iteration is never the last.
pub(super) const UNKNOWN: f64 = f64::INFINITY;

/// Torques of the points of a block over previous speeds. The abscissa of a step is the logarithm of its speed, because losses are
/// nearly power laws of speed: polynomials over it are more accurate where speeds are low and far apart.
#[derive(Debug, Clone, Default)]
pub struct TorqueHistory {
    /// Given torques.
    torques: Vec<Lane>,
    pub(super) drives: Vec<Drive>,
    /// Convergence rate of the losses: the share of an error that remains after one iteration.
    pub(super) rate: Option<Lane>,
    /// The newest last.
    steps: Vec<Step>,
    /// Indices and weights of the steps in a guess.
    weights: Vec<(usize, f64)>,
    /// Number of guesses since the rate was measured.
    guesses: usize,
    /// True if the last block started with a good guess, so that its first iteration was the last.
    good: bool,
    /// Abscissa at which the rate was measured.
    measured: f64,
}

#[derive(Debug, Clone)]
struct Step {
    place: f64,
    /// The given torques of the solved equilibrium.
    unknowns: Vec<Lane>,
}

impl TorqueHistory {
    /// Forgets all steps.
    pub fn clear(&mut self) {
        self.steps.clear();
        self.guesses = 0;
    }

    /// Weights of the steps for a guess at an abscissa, for points with these given torques; false if there is none.
    #[inline(always)]
    pub(super) fn weigh(&mut self, torques: &[Lane], place: f64) -> bool {
        if !same_points(&self.torques, torques) {
            self.clear();
        }
        // Far from the rate measurement, guesses continue while they are good; at zero speed nothing is near or far.
        let farthest = if self.good { MOST } else { 1.0 };
        if !place.is_finite() || self.rate.is_none() || self.growth(place) > farthest {
            return false;
        }
        let weights = &mut self.weights;
        (0..self.steps.len()).any(|first| {
            weights.clear();
            weights.extend(lagrange(&self.steps, first, place));
            weights.iter().map(|(_, weight)| weight.abs()).sum::<f64>() <= SPREAD
        })
    }

    /// Growth of the rate at an abscissa. The rate hardly changes with speed; to be safe, far from its measurement it is assumed to
    /// grow with the ratio of speeds, up or down, and with the number of guesses.
    #[inline(always)]
    pub(super) fn growth(&self, place: f64) -> f64 {
        let ratio = (place - self.measured).abs().exp();
        larger(1.0, ratio / NEAR) * larger(1.0, self.guesses as f64 / MANY)
    }

    /// The guess of one unknown at the abscissa of the last weights.
    #[inline(always)]
    pub(super) fn guess(&self, unknown: usize) -> Lane {
        weighted(
            self.weights
                .iter()
                .map(|(step, weight)| (*weight, &self.steps[*step].unknowns[unknown])),
        )
    }

    /// Adds a step; returns the storage of an old one for its unknowns. `guess` states whether its initial guess was good; `None`
    /// if it had none.
    pub(super) fn push(
        &mut self,
        given: &[Lane],
        place: f64,
        drives: &[Drive],
        unknowns: &mut Vec<Lane>,
        guess: Option<bool>,
    ) {
        self.good = guess == Some(true);
        if guess.is_some() {
            self.guesses += 1;
        } else {
            self.guesses = 0;
            self.measured = place;
            if !same_points(&self.torques, given) || self.drives != drives {
                self.steps.clear();
                self.torques.clear();
                self.torques.extend_from_slice(given);
                self.drives.clear();
                self.drives.extend_from_slice(drives);
            }
        }
        let mut step = if self.steps.len() == DEPTH {
            self.steps.remove(0)
        } else {
            Step {
                place,
                unknowns: vec![Lane::ZERO; unknowns.len()],
            }
        };
        step.place = place;
        std::mem::swap(&mut step.unknowns, unknowns);
        self.steps.push(step);
    }
}

/// True if given torques are the same in all lanes.
#[inline(always)]
fn same_points(a: &[Lane], b: &[Lane]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| count(|i| a[i] == b[i]) == LANES as u64)
}

/// Indices and weights of the Lagrange polynomial at an abscissa through the steps from a first one on.
fn lagrange(steps: &[Step], first: usize, place: f64) -> impl Iterator<Item = (usize, f64)> {
    let factor = move |own: &Step, other: &Step| (place - other.place) / (own.place - other.place);
    let weight = move |i: usize| -> f64 {
        let others = steps.iter().enumerate().skip(first).filter(|(j, _)| *j != i);
        others.map(|(_, other)| factor(&steps[i], other)).product()
    };
    (first..steps.len()).map(move |i| (i, weight(i)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn follow(history: &mut TorqueHistory, speeds: &[f64], law: impl Fn(f64) -> f64) {
        for (i, speed) in speeds.iter().enumerate() {
            let mut torques = vec![Lane::all(law(*speed))];
            history.push(
                &[Lane::all(3.0)],
                *speed,
                &[Drive::First],
                &mut torques,
                (i > 0).then_some(true),
            );
        }
        history.rate = Some(Lane::all(0.1));
    }

    /// Number of steps used for a guess at an abscissa, given where the rate was measured.
    fn steps_at(history: &mut TorqueHistory, given: f64, place: f64) -> usize {
        history.measured = place;
        if history.weigh(&[Lane::all(given)], place) {
            history.weights.len()
        } else {
            0
        }
    }

    #[test]
    fn a_guess_continues_a_cubic() {
        let law = |x: f64| 2.0 - x + 0.3 * x * x - 0.01 * x * x * x;
        let mut history = TorqueHistory::default();
        follow(&mut history, &[1.0, 2.0, 2.9, 4.0, 5.1], law);
        assert_eq!(steps_at(&mut history, 3.0, 6.0), 4);
        assert!((history.guess(0)[7] - law(6.0)).abs() < 1e-13);
        // Far from previous steps a polynomial of lower degree is more accurate.
        assert!((1..3).contains(&steps_at(&mut history, 3.0, 20.0)));
    }

    #[test]
    fn without_common_steps_nothing_is_guessed() {
        let mut history = TorqueHistory::default();
        assert_eq!(steps_at(&mut history, 3.0, 6.0), 0);
        follow(&mut history, &[1.0, 2.0], |x| x);
        assert_eq!(steps_at(&mut history, 3.0, 3.0), 2);
        assert_eq!(steps_at(&mut history.clone(), 3.1, 3.0), 0);
        // A repeated speed leaves one step.
        follow(&mut history, &[1.0, 2.0, 2.0], |x| x);
        assert_eq!(steps_at(&mut history, 3.0, 3.0), 1);
    }

    #[test]
    fn a_rate_counts_as_grown_far_away_and_after_many_guesses() {
        let mut history = TorqueHistory::default();
        let given = [Lane::all(3.0)];
        let push = |history: &mut TorqueHistory, speed: f64, guess: Option<bool>| {
            history.push(&given, speed.ln(), &[Drive::First], &mut vec![Lane::ZERO], guess);
        };
        let growth = |history: &TorqueHistory, speed: f64| history.growth(speed.ln());
        push(&mut history, 100.0, None);
        history.rate = Some(Lane::all(0.1));
        for (speed, grown) in [
            (100.0, 1.0),
            (200.0, 1.0),
            (50.0, 1.0),
            (600.0, 3.0),
            (12.5, 4.0),
            (1000.0, 5.0),
        ] {
            assert!((growth(&history, speed) / grown - 1.0).abs() < 1e-8, "{speed}");
            // Far away only good guesses continue, and very far none.
            for (good, most) in [(Some(true), MOST), (Some(false), 1.0)] {
                let mut history = history.clone();
                push(&mut history, 100.0, good);
                assert_eq!(history.weigh(&given, speed.ln()), grown <= most, "{speed} {good:?}");
            }
        }
        for _ in 0..512 {
            push(&mut history, 100.0, Some(true));
        }
        assert_eq!(growth(&history, 100.0), 2.0);
        push(&mut history, 100.0, None);
        assert_eq!(growth(&history, 100.0), 1.0);
        // Standstill is far from all speeds, and not near itself.
        assert!(!history.weigh(&given, f64::NEG_INFINITY));
        push(&mut history, 0.0, None);
        assert!(!history.weigh(&given, f64::NEG_INFINITY) && !history.weigh(&given, f64::ln(100.0)));
    }

    #[test]
    fn steps_outlive_a_solution_without_a_guess_but_not_other_drivers() {
        let mut history = TorqueHistory::default();
        follow(&mut history, &[1.0, 1.1, 1.2, 1.3, 1.4], |x| x);
        let (given, next) = ([Lane::all(3.0)], 1.5);
        history.push(&given, next, &[Drive::First], &mut vec![Lane::all(next)], None);
        assert_eq!(steps_at(&mut history, 3.0, next + 0.1), DEPTH);
        history.push(&given, next + 0.1, &[Drive::Second], &mut vec![Lane::all(next)], None);
        assert_eq!(steps_at(&mut history, 3.0, next + 0.2), 1);
    }
}
