//! What the same points at the speeds before say of the torques at the next speed.

use super::work::Drive;
use crate::lanes::{LANES, Lane, count, weighted};

/// Steps that count: a polynomial through four of them.
const DEPTH: usize = 4;
/// Most that the errors of the torques before may add up to in a guess; a cubic over even steps has 15.
const SPREAD: f64 = 16.0;
/// Most guessed steps after which a block is solved without a guess once, which measures anew how fast it converges.
const LONGEST: usize = 256;
/// The distance from the last such measurement after which there is another one: twice its speed, or half of it.
const FARTHEST: f64 = std::f64::consts::LN_2 * (1.0 + 1e-9);
/// A rate that could not be measured, with which a pass is never the last.
pub(super) const UNKNOWN: f64 = f64::INFINITY;

/// Torques of the points of a block over the speeds before. The place of a step is the logarithm of its speed, because losses go
/// nearly with powers of speed: polynomials over it err less where speeds are low and far apart.
#[derive(Debug, Clone, Default)]
pub struct Trail {
    /// Given torques.
    torques: Vec<Lane>,
    pub(super) drives: Vec<Drive>,
    /// How fast the losses converge: the share of an error that one pass leaves.
    pub(super) rate: Option<Lane>,
    /// The newest last.
    steps: Vec<Step>,
    /// Numbers and weights of the steps in a guess.
    weights: Vec<(usize, f64)>,
    guesses: usize,
    /// Where the rate was measured.
    measured: f64,
}

#[derive(Debug, Clone)]
struct Step {
    place: f64,
    /// What the equilibrium was solved for.
    unknowns: Vec<Lane>,
}

impl Trail {
    /// Forgets all steps.
    pub fn clear(&mut self) {
        self.steps.clear();
        self.guesses = 0;
    }

    /// Weighs the steps for a guess at a place, for the points with these given torques; false where there is none.
    #[inline(always)]
    pub(super) fn weigh(&mut self, torques: &[Lane], place: f64) -> bool {
        if !same_points(&self.torques, torques) {
            self.clear();
        }
        let far = (place - self.measured).abs() > FARTHEST;
        if far || self.guesses == LONGEST || self.rate.is_none() {
            return false;
        }
        let weights = &mut self.weights;
        (0..self.steps.len()).any(|first| {
            weights.clear();
            weights.extend(lagrange(&self.steps, first, place));
            weights.iter().map(|(_, weight)| weight.abs()).sum::<f64>() <= SPREAD
        })
    }

    /// The guess of one unknown at the place that was weighed last.
    #[inline(always)]
    pub(super) fn guess(&self, unknown: usize) -> Lane {
        weighted(
            self.weights
                .iter()
                .map(|(step, weight)| (*weight, &self.steps[*step].unknowns[unknown])),
        )
    }

    /// Adds a step, for whose unknowns it gives older ones back; `guessed` says whether it began with a guess.
    pub(super) fn push(
        &mut self,
        given: &[Lane],
        place: f64,
        drives: &[Drive],
        unknowns: &mut Vec<Lane>,
        guessed: bool,
    ) {
        if guessed {
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

/// Whether given torques are the same in all lanes.
#[inline(always)]
fn same_points(a: &[Lane], b: &[Lane]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| count(|i| a[i] == b[i]) == LANES as u64)
}

/// Numbers and weights of the polynomial at a place through the steps from one on, after Lagrange.
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

    fn follow(trail: &mut Trail, speeds: &[f64], law: impl Fn(f64) -> f64) {
        for (i, speed) in speeds.iter().enumerate() {
            let mut torques = vec![Lane::all(law(*speed))];
            trail.push(&[Lane::all(3.0)], *speed, &[Drive::First], &mut torques, i > 0);
        }
        trail.rate = Some(Lane::all(0.1));
        trail.measured = speeds[speeds.len() - 1];
    }

    /// How many steps count for a guess at a place, not far from where the rate was measured.
    fn steps_at(trail: &mut Trail, given: f64, place: f64) -> usize {
        trail.measured = place;
        if trail.weigh(&[Lane::all(given)], place) {
            trail.weights.len()
        } else {
            0
        }
    }

    #[test]
    fn a_guess_continues_a_cubic() {
        let law = |x: f64| 2.0 - x + 0.3 * x * x - 0.01 * x * x * x;
        let mut trail = Trail::default();
        follow(&mut trail, &[1.0, 2.0, 2.9, 4.0, 5.1], law);
        assert_eq!(steps_at(&mut trail, 3.0, 6.0), 4);
        assert!((trail.guess(0)[7] - law(6.0)).abs() < 1e-13);
        // Far from the steps before a polynomial of lower degree errs less.
        assert!((1..3).contains(&steps_at(&mut trail, 3.0, 20.0)));
    }

    #[test]
    fn without_common_steps_nothing_is_guessed() {
        let mut trail = Trail::default();
        assert_eq!(steps_at(&mut trail, 3.0, 6.0), 0);
        follow(&mut trail, &[1.0, 2.0], |x| x);
        assert_eq!(steps_at(&mut trail, 3.0, 3.0), 2);
        assert_eq!(steps_at(&mut trail.clone(), 3.1, 3.0), 0);
        // The same speed once more leaves one step.
        follow(&mut trail, &[1.0, 2.0, 2.0], |x| x);
        assert_eq!(steps_at(&mut trail, 3.0, 3.0), 1);
        let many: Vec<f64> = (0..=LONGEST as u32).map(f64::from).collect();
        follow(&mut trail, &many, |x| x);
        assert_eq!(steps_at(&mut trail, 3.0, 40.0), 0);
    }

    #[test]
    fn measurements_grow_rarer() {
        let mut trail = Trail::default();
        let given = [Lane::all(3.0)];
        let mut measured = Vec::new();
        for step in 1..=1000 {
            let place = f64::from(step).ln();
            let guessed = trail.weigh(&given, place);
            trail.rate = Some(Lane::all(0.1));
            trail.push(&given, place, &[Drive::First], &mut vec![Lane::ZERO], guessed);
            if !guessed {
                measured.push(step);
            }
        }
        assert_eq!(measured, [1, 3, 7, 15, 31, 63, 127, 255, 511, 768]);
    }

    #[test]
    fn steps_outlive_a_solution_without_a_guess_but_not_other_drivers() {
        let mut trail = Trail::default();
        let many: Vec<f64> = (0..=LONGEST as u32).map(f64::from).collect();
        follow(&mut trail, &many, |x| x);
        let (given, next) = ([Lane::all(3.0)], LONGEST as f64 + 1.0);
        assert_eq!(steps_at(&mut trail, 3.0, next), 0);
        trail.push(&given, next, &[Drive::First], &mut vec![Lane::all(next)], false);
        assert_eq!(steps_at(&mut trail, 3.0, next + 1.0), DEPTH);
        trail.push(&given, next + 1.0, &[Drive::Second], &mut vec![Lane::all(next)], false);
        assert_eq!(steps_at(&mut trail, 3.0, next + 2.0), 1);
    }
}
