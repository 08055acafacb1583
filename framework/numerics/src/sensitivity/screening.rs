//! Screening of many parameters with few runs.
//!
//! Source: Morris, Technometrics 33 (1991) 161-174; the mean of magnitudes after Campolongo, Cariboni, Saltelli, Environ. Model. Softw. 22
//! (2007) 1509-1518. Each trajectory starts on a lattice of four levels from zero to one and moves one coordinate after the other by two
//! levels. Starts and orders come from Sobol points instead of a random source, so that a screening is reproducible.

use schemars::JsonSchema;
use serde::Serialize;

use super::run::{Evaluate, outputs};
use crate::sampling::Sobol;

/// Levels of a coordinate, from zero to one.
const LEVELS: usize = 4;
/// Levels of a step, half the number of levels: every level is then used equally often.
const STEP: usize = LEVELS / 2;
/// Share of the largest effect below which a parameter has no influence.
const NEGLIGIBLE: f64 = 0.05;

/// Elementary effects of one parameter on one output: change of the output over the change of the unit coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effect {
    /// Mean: mu.
    pub mean: f64,
    /// Mean of the magnitudes: mu*. Effects of both signs do not cancel.
    pub magnitude: f64,
    /// Standard deviation: sigma. It is zero if the effect is the same everywhere.
    pub deviation: f64,
}

/// Influence of one parameter by screening.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Influence {
    /// Its effect is below 5 % of the largest.
    None,
    /// Its effect varies by more than its size: nonlinear, or interacting with other parameters.
    NonlinearOrInteracting,
    /// Its effect is similar everywhere.
    Steady,
}

impl Influence {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::NonlinearOrInteracting => "nonlinear_or_interacting",
            Self::Steady => "steady",
        }
    }

    /// As text.
    pub fn words(self) -> &'static str {
        match self {
            Self::None => "not influential",
            Self::NonlinearOrInteracting => "nonlinear or interacting",
            Self::Steady => "influential",
        }
    }
}

/// Effects of all parameters on all outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Screening {
    /// Number of evaluations.
    pub runs: usize,
    /// Effects: by output, then by parameter.
    pub effects: Vec<Vec<Effect>>,
}

impl Screening {
    /// Influence of each parameter on one output.
    pub fn influences(&self, output: usize) -> Vec<Influence> {
        let effects = self.effects.get(output).map_or(&[][..], Vec::as_slice);
        let greatest = effects.iter().fold(0.0, |most: f64, e| most.max(e.magnitude));
        let influence = |e: &Effect| {
            if e.magnitude == 0.0 || e.magnitude < NEGLIGIBLE * greatest {
                Influence::None
            } else if e.deviation > e.magnitude {
                Influence::NonlinearOrInteracting
            } else {
                Influence::Steady
            }
        };
        effects.iter().map(influence).collect()
    }
}

/// Screens a function of unit coordinates from zero to one, both included.
///
/// A quantity without ends needs a range from the user. Twenty trajectories are customary; each needs one run more than there are
/// parameters.
///
/// # Errors
/// If there are fewer than two trajectories, more than 32 parameters, or the function fails or returns non-finite numbers.
pub fn screening<F>(parameters: usize, trajectories: usize, function: F) -> Result<Screening, String>
where
    F: Evaluate,
{
    if trajectories < 2 {
        return Err("a screening needs at least two trajectories".to_owned());
    }
    let sobol = Sobol::new(2 * parameters)?;
    let paths: Vec<Trajectory> = (1..=trajectories)
        .map(|t| Trajectory::new(&sobol.point(t as u32)))
        .collect();
    let each = parameters + 1;
    let runs = outputs(trajectories * each, |i| paths[i / each].point(i % each), &function)?;
    let width = runs[0].len();
    let mut found = vec![vec![Vec::with_capacity(trajectories); parameters]; width];
    for (path, runs) in paths.iter().zip(runs.chunks(each)) {
        for (place, k) in path.order.iter().enumerate() {
            for (output, found) in found.iter_mut().enumerate() {
                found[*k].push((runs[place + 1][output] - runs[place][output]) / path.step(*k));
            }
        }
    }
    let effects: Vec<Vec<Effect>> = found
        .iter()
        .map(|list| list.iter().map(|list| effect(list)).collect())
        .collect();
    let finite = |e: &Effect| e.mean.is_finite() && e.magnitude.is_finite() && e.deviation.is_finite();
    if !effects.iter().flatten().all(finite) {
        return Err("the outputs are too large to be compared".to_owned());
    }
    Ok(Screening {
        runs: runs.len(),
        effects,
    })
}

/// A start on the lattice and the order of coordinate steps.
struct Trajectory {
    start: Vec<usize>,
    order: Vec<usize>,
}

impl Trajectory {
    /// From a point with two coordinates for each parameter.
    fn new(point: &[f64]) -> Self {
        let (starts, keys) = point.split_at(point.len() / 2);
        let mut order: Vec<usize> = (0..keys.len()).collect();
        order.sort_by(|a, b| keys[*a].total_cmp(&keys[*b]));
        let start = starts.iter().map(|x| (LEVELS as f64 * x) as usize).collect();
        Self { start, order }
    }

    /// A step up from the lower half, down from the upper half.
    fn rises(&self, parameter: usize) -> bool {
        self.start[parameter] + STEP < LEVELS
    }

    /// Signed change of a unit coordinate.
    fn step(&self, parameter: usize) -> f64 {
        let size = STEP as f64 / (LEVELS - 1) as f64;
        if self.rises(parameter) { size } else { -size }
    }

    /// The point after some moves.
    fn point(&self, moves: usize) -> Vec<f64> {
        let mut levels = self.start.clone();
        for k in self.order.iter().take(moves) {
            levels[*k] = if self.rises(*k) {
                levels[*k] + STEP
            } else {
                levels[*k] - STEP
            };
        }
        levels.iter().map(|l| *l as f64 / (LEVELS - 1) as f64).collect()
    }
}

fn effect(list: &[f64]) -> Effect {
    let count = list.len() as f64;
    let mean = list.iter().sum::<f64>() / count;
    let squares: f64 = list.iter().map(|e| (e - mean) * (e - mean)).sum();
    Effect {
        mean,
        magnitude: list.iter().map(|e| e.abs()).sum::<f64>() / count,
        deviation: (squares / (count - 1.0)).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn effects_of_a_plane_are_its_slopes() {
        let plane = |x: &[f64]| Ok(vec![3.0 * x[0] - 2.0 * x[1] + 1.0, x[0] * x[1] * 1e-3, 0.0]);
        let found = screening(3, 8, plane).unwrap();
        assert_eq!(found.runs, 32);
        for (effect, slope) in found.effects[0].iter().zip([3.0, -2.0, 0.0_f64]) {
            assert!((effect.mean - slope).abs() < 1e-12 && (effect.magnitude - slope.abs()).abs() < 1e-12);
            assert!(effect.deviation < 1e-12);
        }
        assert_eq!(
            found.influences(0),
            [Influence::Steady, Influence::Steady, Influence::None]
        );
        assert_eq!(found.influences(2), [Influence::None; 3]);
        assert!(found.influences(7).is_empty());
    }

    #[test]
    fn what_cannot_be_screened_is_refused() {
        assert!(screening(3, 1, |_: &[f64]| Ok(vec![1.0])).is_err());
        assert!(
            screening(33, 2, |_: &[f64]| Ok(vec![1.0]))
                .unwrap_err()
                .contains("66 dimensions")
        );
        assert!(screening(1, 2, |_: &[f64]| Err("no".to_owned())).is_err());
        assert!(screening(1, 4, |x: &[f64]| Ok(vec![f64::MAX * (2.0 * x[0] - 1.0)])).is_err());
        assert_eq!(screening(0, 2, |_: &[f64]| Ok(vec![1.0])).unwrap().effects, [vec![]]);
    }

    #[test]
    fn trajectories_stay_on_the_lattice_and_move_each_coordinate_once() {
        let sobol = Sobol::new(10).unwrap();
        for t in 1..40 {
            let path = Trajectory::new(&sobol.point(t));
            let mut seen = path.order.clone();
            seen.sort_unstable();
            assert_eq!(seen, [0, 1, 2, 3, 4]);
            for moves in 0..5 {
                let (a, b) = (path.point(moves), path.point(moves + 1));
                let changed: Vec<usize> = (0..5).filter(|k| a[*k] != b[*k]).collect();
                assert_eq!(changed, [path.order[moves]]);
                assert!(b.iter().all(|x| (0.0..=1.0).contains(x)));
            }
        }
    }
}
