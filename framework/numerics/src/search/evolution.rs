//! An evolutionary search (NSGA-II) over numbers and choices.
//!
//! Sources: Deb et al., IEEE Trans. Evol. Comput. 6 (2002) 182-197 (selection); Deb, Agrawal: Simulated binary crossover for continuous
//! search space, Complex Systems 9 (1995) 115-148; Deb, Goyal: A combined genetic adaptive search for engineering design, Computer Science
//! and Informatics 26 (1996) 30-45 (polynomial mutation).

use std::cmp::Ordering;

use super::ranking::ranks;
use super::{Design, Gene};
use crate::sampling::{Generator, Sobol};

/// Distribution index of the crossover: large values keep children close to their parents.
const CROSSOVER: f64 = 15.0;
/// Distribution index of the mutation.
const MUTATION: f64 = 20.0;
/// Attempts to find a child that differs from all designs so far.
const ATTEMPTS: usize = 20;

/// A population of designs.
#[derive(Debug, Clone)]
pub struct Evolution {
    genes: Vec<Gene>,
    size: usize,
    generator: Generator,
    /// The best designs so far, with rank and crowding distance.
    members: Vec<(Design, (usize, f64))>,
}

impl Evolution {
    /// A population of a size, whose random numbers depend on the seed only.
    pub fn new(genes: Vec<Gene>, size: usize, seed: u64) -> Self {
        Self {
            genes,
            size,
            generator: Generator::new(seed),
            members: Vec::new(),
        }
    }

    /// The first designs: given ones, then points that fill the space evenly.
    ///
    /// # Errors
    /// If there are more genes than dimensions of Sobol points.
    pub fn first(&mut self, given: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, String> {
        let sobol = Sobol::new(self.genes.len())?;
        let mut all = given;
        for point in 1.. {
            if all.len() >= self.size || point > 16 * self.size {
                break;
            }
            let place = sobol.point(point as u32).into_iter().zip(&self.genes);
            let design: Vec<f64> = place.map(|(share, gene)| at_share(*gene, share)).collect();
            if !all.contains(&design) {
                all.push(design);
            }
        }
        Ok(all)
    }

    /// The next designs: children of the members. None that a `known` one equals, and fewer than the size where few new ones are found.
    pub fn children(&mut self, known: &dyn Fn(&[f64]) -> bool) -> Vec<Vec<f64>> {
        let mut all: Vec<Vec<f64>> = Vec::new();
        for _ in 0..self.size {
            for _ in 0..ATTEMPTS {
                let child = self.child();
                if !known(&child) && !all.contains(&child) {
                    all.push(child);
                    break;
                }
            }
        }
        all
    }

    /// Keeps the best of the members and of evaluated designs.
    pub fn select(&mut self, evaluated: impl IntoIterator<Item = Design>) {
        let old = std::mem::take(&mut self.members);
        let all: Vec<Design> = old.into_iter().map(|member| member.0).chain(evaluated).collect();
        let ranks = ranks(&all);
        let mut all: Vec<(Design, (usize, f64))> = all.into_iter().zip(ranks).collect();
        // A stable sort: equal designs keep their order.
        all.sort_by(|a, b| order(a.1, b.1));
        all.truncate(self.size);
        self.members = all;
    }

    fn child(&mut self) -> Vec<f64> {
        let [one, other] = [self.parent(), self.parent()];
        let count = self.genes.len();
        let mut child = Vec::with_capacity(count);
        for (i, gene) in self.genes.clone().into_iter().enumerate() {
            let (a, b) = (self.members[one].0.genes[i], self.members[other].0.genes[i]);
            let mut inherited = match gene {
                Gene::Number => self.between(a, b),
                Gene::Choice(_) if self.generator.unit() < 0.5 => a,
                Gene::Choice(_) => b,
            };
            if self.generator.below(count) == 0 {
                inherited = match gene {
                    Gene::Number => self.mutated(inherited),
                    Gene::Choice(choices) => self.generator.below(choices) as f64,
                };
            }
            child.push(inherited);
        }
        child
    }

    /// The better of two random members.
    fn parent(&mut self) -> usize {
        let [one, other] = [(); 2].map(|()| self.generator.below(self.members.len()));
        match order(self.members[one].1, self.members[other].1) {
            Ordering::Greater => other,
            _ => one,
        }
    }

    /// A child of two numbers by simulated binary crossover.
    fn between(&mut self, a: f64, b: f64) -> f64 {
        let share = self.generator.unit();
        let spread = if share <= 0.5 {
            (2.0 * share).powf(1.0 / (CROSSOVER + 1.0))
        } else {
            (0.5 / (1.0 - share)).powf(1.0 / (CROSSOVER + 1.0))
        };
        let side = if self.generator.unit() < 0.5 { 1.0 } else { -1.0 };
        (0.5 * (a + b) + 0.5 * side * spread * (b - a)).clamp(0.0, 1.0)
    }

    /// A number changed by polynomial mutation.
    fn mutated(&mut self, x: f64) -> f64 {
        let share = self.generator.unit();
        let change = if share < 0.5 {
            (2.0 * share).powf(1.0 / (MUTATION + 1.0)) - 1.0
        } else {
            1.0 - (2.0 * (1.0 - share)).powf(1.0 / (MUTATION + 1.0))
        };
        (x + change).clamp(0.0, 1.0)
    }
}

/// A coordinate at a share of its range.
fn at_share(gene: Gene, share: f64) -> f64 {
    match gene {
        Gene::Number => share,
        Gene::Choice(count) => (share * count as f64).floor().min(count.saturating_sub(1) as f64),
    }
}

/// Lower ranks first, lonely designs first.
fn order(a: (usize, f64), b: (usize, f64)) -> Ordering {
    a.0.cmp(&b.0).then(b.1.total_cmp(&a.1))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::{Score, best, front};
    use super::*;

    /// Runs generations; returns all designs.
    fn run(genes: &[Gene], size: usize, generations: usize, score: impl Fn(&[f64]) -> Score) -> Vec<Design> {
        let mut evolution = Evolution::new(genes.to_vec(), size, 1);
        let evaluate = |genes: Vec<f64>| Design {
            score: score(&genes),
            genes,
        };
        let mut all: Vec<Design> = evolution.first(Vec::new()).unwrap().into_iter().map(evaluate).collect();
        evolution.select(all.clone());
        for _ in 1..generations {
            let known = |genes: &[f64]| all.iter().any(|design| design.genes == genes);
            let next: Vec<Design> = evolution.children(&known).into_iter().map(evaluate).collect();
            evolution.select(next.clone());
            all.extend(next);
        }
        all
    }

    fn feasible(objectives: Vec<f64>) -> Score {
        Score {
            objectives,
            violation: 0.0,
        }
    }

    #[test]
    fn choices_are_those_of_an_exhaustive_search() {
        // A product of three choices with interaction, which no choice optimises alone.
        let loss = |g: &[f64]| (g[0] - 3.0).powi(2) + (g[1] - g[0]).abs() + if g[2] == g[1] % 4.0 { 0.0 } else { 2.0 };
        let genes = [Gene::Choice(8), Gene::Choice(8), Gene::Choice(4)];
        let all = run(&genes, 16, 8, |g| feasible(vec![loss(g)]));
        assert!(all.len() <= 16 * 8);
        assert_eq!(best(&all, 0).unwrap().genes, [3.0, 3.0, 3.0]);
        // None is evaluated twice, and all are whole numbers in their ranges.
        for (i, design) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|other| other.genes != design.genes));
            let inside =
                |(x, gene): (&f64, &Gene)| matches!(gene, Gene::Choice(n) if *x < *n as f64 && x.fract() == 0.0);
            assert!(design.genes.iter().zip(&genes).all(inside), "{:?}", design.genes);
        }
    }

    #[test]
    fn a_constraint_is_respected_at_its_limit() {
        // The least x + y with x y >= 0.25 is at x = y = 0.5.
        let score = |g: &[f64]| Score {
            objectives: vec![g[0] + g[1]],
            violation: (0.25 - g[0] * g[1]).max(0.0),
        };
        let all = run(&[Gene::Number, Gene::Number], 40, 40, score);
        let best = best(&all, 0).unwrap();
        assert!(
            best.score.is_feasible() && (best.score.objectives[0] - 1.0).abs() < 0.01,
            "{best:?}"
        );
    }

    #[test]
    fn a_front_of_two_objectives_is_covered() {
        // ZDT1 of two numbers: the front is 1 - sqrt(f1) at a second coordinate of zero.
        let score = |g: &[f64]| {
            let rest = 1.0 + 9.0 * g[1];
            feasible(vec![g[0], rest * (1.0 - (g[0] / rest).sqrt())])
        };
        let all = run(&[Gene::Number, Gene::Number], 40, 50, score);
        let front: Vec<&Design> = front(&all).into_iter().map(|i| &all[i]).collect();
        for tenth in 0..10 {
            let from = 0.1 * f64::from(tenth);
            let near = front
                .iter()
                .filter(|design| (from..=from + 0.1).contains(&design.score.objectives[0]));
            let gap = near.map(|design| design.score.objectives[1] - 1.0 + design.score.objectives[0].sqrt());
            assert!(gap.fold(f64::INFINITY, f64::min) < 0.01, "no design near f1 = {from}");
        }
    }

    #[test]
    fn the_seed_alone_decides() {
        let score = |g: &[f64]| feasible(vec![(g[0] - 0.3).abs() + g[1]]);
        let genes = [Gene::Number, Gene::Choice(3)];
        assert_eq!(run(&genes, 8, 5, score), run(&genes, 8, 5, score));
    }
}
