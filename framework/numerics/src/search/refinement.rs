//! Refinement of the numbers of one design: parabolas along the coordinates, with steps that shrink.

use super::{Design, Gene};

/// Steps below which a refinement ends.
const FINEST: f64 = 1e-3;

/// The best design so far, and the step to its neighbours. Each round evaluates the [neighbours](Refinement::neighbours) of the best design,
/// then [steps](Refinement::steps) towards the minima of the parabolas through them.
#[derive(Debug, Clone)]
pub struct Refinement {
    best: Design,
    /// The objective that is refined.
    objective: usize,
    /// Indices of the genes that are numbers.
    numbers: Vec<usize>,
    step: f64,
}

impl Refinement {
    /// Begins at a design.
    pub fn new(genes: &[Gene], start: Design, objective: usize, step: f64) -> Self {
        let numbers = genes.iter().enumerate().filter(|(_, gene)| **gene == Gene::Number);
        Self {
            best: start,
            objective,
            numbers: numbers.map(|(i, _)| i).collect(),
            step,
        }
    }

    /// The best design so far.
    pub fn best(&self) -> &Design {
        &self.best
    }

    /// Whether further rounds are of no use.
    pub fn is_done(&self) -> bool {
        self.numbers.is_empty() || self.step < FINEST
    }

    /// The designs below and above the best one along each number; an end of the range is its own neighbour and left out.
    pub fn neighbours(&self) -> Vec<Vec<f64>> {
        let mut all = Vec::new();
        for i in &self.numbers {
            for side in [-1.0, 1.0] {
                let moved = self.moved(&[(*i, side * self.step)]);
                if moved != self.best.genes {
                    all.push(moved);
                }
            }
        }
        all
    }

    /// Further designs from the evaluated neighbours: the steps to the minima of the parabolas along all coordinates together, and the same
    /// halved.
    pub fn steps(&self, neighbours: &[Design]) -> Vec<Vec<f64>> {
        let here = self.best.score.objectives[self.objective];
        let mut moves = Vec::new();
        for i in &self.numbers {
            let x = self.best.genes[*i];
            let along = neighbours
                .iter()
                .filter(|design| design.genes[*i] != x && design.score.is_feasible());
            let sides: Vec<(f64, f64)> = along
                .map(|design| (design.genes[*i] - x, design.score.objectives[self.objective] - here))
                .collect();
            match sides[..] {
                [(a, fa), (b, fb)] => {
                    let curvature = (fb / b - fa / a) / (b - a);
                    let slope = fa / a - curvature * a;
                    let step = if curvature > 0.0 {
                        -0.5 * slope / curvature
                    } else {
                        -slope.signum() * 2.0 * self.step
                    };
                    moves.push((*i, step.clamp(-2.0 * self.step, 2.0 * self.step)));
                }
                [(a, fa)] if fa < 0.0 => moves.push((*i, a)),
                _ => {}
            }
        }
        let halved: Vec<(usize, f64)> = moves.iter().map(|(i, step)| (*i, 0.5 * step)).collect();
        let mut all = vec![self.moved(&moves), self.moved(&halved)];
        all.dedup();
        all.retain(|genes| *genes != self.best.genes);
        all
    }

    /// Ends a round with all that it has evaluated: keeps the best design, and shortens the step if none is better.
    pub fn learn(&mut self, evaluated: &[Design]) {
        let key = |design: &Design| (design.score.violation, design.score.objectives[self.objective]);
        let mut best = &self.best;
        for design in evaluated {
            let ((violation, objective), (least, lowest)) = (key(design), key(best));
            if violation < least || (violation == least && objective < lowest) {
                best = design;
            }
        }
        if *best == self.best {
            self.step /= 3.0;
        } else {
            self.best = best.clone();
        }
    }

    /// The best design with steps along some genes.
    fn moved(&self, moves: &[(usize, f64)]) -> Vec<f64> {
        let mut genes = self.best.genes.clone();
        for (i, step) in moves {
            genes[*i] = (genes[*i] + step).clamp(0.0, 1.0);
        }
        genes
    }
}

#[cfg(test)]
mod tests {
    use super::super::Score;
    use super::*;

    fn refined(score: impl Fn(&[f64]) -> Score, start: &[f64]) -> (Design, usize) {
        let design = |genes: Vec<f64>| Design {
            score: score(&genes),
            genes,
        };
        let genes = vec![Gene::Number; start.len()];
        let mut refinement = Refinement::new(&genes, design(start.to_vec()), 0, 0.1);
        let mut count = 0;
        while !refinement.is_done() {
            let mut all: Vec<Design> = refinement.neighbours().into_iter().map(&design).collect();
            let steps: Vec<Design> = refinement.steps(&all).into_iter().map(&design).collect();
            all.extend(steps);
            count += all.len();
            refinement.learn(&all);
        }
        (refinement.best().clone(), count)
    }

    #[test]
    fn a_parabola_takes_one_step() {
        let score = |g: &[f64]| Score {
            objectives: vec![(g[0] - 0.37).powi(2) + 3.0 * (g[1] - 0.58).powi(2) + 5.0],
            violation: 0.0,
        };
        let (best, count) = refined(score, &[0.4, 0.6]);
        assert!(
            best.genes
                .iter()
                .zip([0.37, 0.58])
                .all(|(x, expected)| (x - expected).abs() < 1e-9),
            "{best:?}"
        );
        assert!(count <= 40, "{count}");
    }

    #[test]
    fn coupled_coordinates_and_limits_are_followed() {
        let score = |g: &[f64]| Score {
            objectives: vec![(g[0] + g[1] - 1.2).powi(2) + 0.2 * (g[0] - g[1]).powi(2)],
            violation: (g[0] - 0.45).max(0.0),
        };
        // At x = 0.45 the derivative over y vanishes: 2 (x + y - 1.2) = 0.4 (x - y).
        let y = (2.4 - 1.6 * 0.45) / 2.4;
        let (best, _) = refined(score, &[0.2, 0.2]);
        assert!(best.score.is_feasible());
        assert!(
            (best.genes[0] - 0.45).abs() < 5e-3 && (best.genes[1] - y).abs() < 5e-3,
            "{best:?} {y}"
        );
    }
}
