//! Comparison of designs: domination under constraints, fronts, crowding.
//!
//! Source: Deb, Pratap, Agarwal, Meyarivan: A fast and elitist multiobjective genetic algorithm: NSGA-II, IEEE Trans. Evol. Comput. 6
//! (2002) 182-197: constrained domination, crowding distance.

use std::cmp::Ordering;

use super::{Design, Score};

impl Score {
    /// Whether this score is better: less violation, or, where both are feasible, no objective worse and one better.
    pub fn dominates(&self, other: &Self) -> bool {
        match self.violation.total_cmp(&other.violation) {
            Ordering::Less => true,
            Ordering::Greater => false,
            Ordering::Equal => {
                let pairs = || self.objectives.iter().zip(&other.objectives);
                pairs().all(|(mine, other)| mine <= other) && pairs().any(|(mine, other)| mine < other)
            }
        }
    }

    /// Whether all constraints hold.
    pub fn is_feasible(&self) -> bool {
        self.violation == 0.0
    }
}

/// Indices of the designs that no other one dominates, in their order.
pub fn front(designs: &[Design]) -> Vec<usize> {
    let is_best = |i: &usize| designs.iter().all(|other| !other.score.dominates(&designs[*i].score));
    (0..designs.len()).filter(is_best).collect()
}

/// The design with the least violation, and among those with the least value of an objective; the first of equal ones.
pub fn best(designs: &[Design], objective: usize) -> Option<&Design> {
    let order = |a: &&Design, b: &&Design| {
        let violation = a.score.violation.total_cmp(&b.score.violation);
        violation.then(a.score.objectives[objective].total_cmp(&b.score.objectives[objective]))
    };
    designs.iter().min_by(order)
}

/// Rank and crowding distance of each design: the number of its front, and how lonely it is there.
pub(super) fn ranks(designs: &[Design]) -> Vec<(usize, f64)> {
    let mut ranks = vec![(0, 0.0); designs.len()];
    let mut left: Vec<usize> = (0..designs.len()).collect();
    let mut rank = 0;
    while !left.is_empty() {
        let is_best = |i: &usize| left.iter().all(|k| !designs[*k].score.dominates(&designs[*i].score));
        let (front, rest): (Vec<usize>, Vec<usize>) = left.iter().partition(|i| is_best(i));
        for (i, distance) in front.iter().zip(crowding(designs, &front)) {
            ranks[*i] = (rank, distance);
        }
        left = rest;
        rank += 1;
    }
    ranks
}

/// Crowding distance of the designs of a front: the sum over the objectives of the distances between the neighbours, infinite at the ends.
fn crowding(designs: &[Design], front: &[usize]) -> Vec<f64> {
    let mut distances = vec![0.0; front.len()];
    for objective in 0..designs[front[0]].score.objectives.len() {
        let value = |place: usize| designs[front[place]].score.objectives[objective];
        let mut order: Vec<usize> = (0..front.len()).collect();
        order.sort_by(|a, b| value(*a).total_cmp(&value(*b)));
        let [first, last] = [order[0], order[order.len() - 1]];
        let width = value(last) - value(first);
        distances[first] = f64::INFINITY;
        distances[last] = f64::INFINITY;
        // Designs that cannot be evaluated have infinite objectives.
        if width > 0.0 && width.is_finite() {
            for three in order.windows(3) {
                distances[three[1]] += (value(three[2]) - value(three[0])) / width;
            }
        }
    }
    distances
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn design(objectives: Vec<f64>, violation: f64) -> Design {
        Design {
            genes: Vec::new(),
            score: Score { objectives, violation },
        }
    }

    #[test]
    fn feasible_designs_come_first_and_ends_of_a_front_are_lonely() {
        let all = [
            design(vec![1.0, 5.0], 0.0),
            design(vec![2.0, 3.0], 0.0),
            design(vec![2.5, 2.9], 0.0),
            design(vec![5.0, 1.0], 0.0),
            design(vec![3.0, 4.0], 0.0),
            design(vec![0.0, 0.0], 0.5),
            design(vec![f64::INFINITY, f64::INFINITY], f64::INFINITY),
        ];
        assert_eq!(front(&all), [0, 1, 2, 3]);
        let ranks = ranks(&all);
        assert_eq!(
            ranks.iter().map(|rank| rank.0).collect::<Vec<_>>(),
            [0, 0, 0, 0, 1, 2, 3]
        );
        assert!(ranks[0].1.is_infinite() && ranks[3].1.is_infinite());
        // (2.5 - 1) / 4 + (5 - 2.9) / 4, and (5 - 2) / 4 + (3 - 1) / 4.
        assert!((ranks[1].1 - 0.9).abs() < 1e-15 && (ranks[2].1 - 1.25).abs() < 1e-15);
        assert_eq!(best(&all, 1), Some(&all[3]));
    }

    proptest! {
        #[test]
        fn ranks_are_those_of_the_definition(all in prop::collection::vec((0..6_i32, 0..6_i32, 0..3_i32), 1..30)) {
            let all: Vec<Design> = all
                .into_iter()
                .map(|(a, b, violation)| design(vec![f64::from(a), f64::from(b)], f64::from(violation)))
                .collect();
            let ranks = ranks(&all);
            for (i, design) in all.iter().enumerate() {
                let better = (0..all.len()).filter(|k| all[*k].score.dominates(&design.score));
                let expected = better.map(|k| ranks[k].0 + 1).max().unwrap_or(0);
                prop_assert_eq!(ranks[i].0, expected);
            }
            let first: Vec<usize> = (0..all.len()).filter(|i| ranks[*i].0 == 0).collect();
            prop_assert_eq!(front(&all), first);
        }
    }
}
