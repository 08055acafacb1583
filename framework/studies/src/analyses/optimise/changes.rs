//! What each change of the best design saves: alone, and as its share of the gain of all.

use super::drives::{Drive, Drives};
use super::objectives::Objective;
use crate::analyses::Stopped;

/// Maximum number of changes whose shares are computed: every combination of them is driven.
const MOST_SHARED: usize = 8;

/// A change of the best design. Gains are by objective, in its unit.
#[derive(Debug, Clone)]
pub struct Change {
    /// Index of the variable.
    pub variable: usize,
    /// Gain of this change alone; absent if it cannot be driven.
    pub alone: Option<Vec<f64>>,
    /// Share of the gain of all changes: the Shapley value, the mean of what the change adds over all orders of the changes. Absent with
    /// more than eight changes, or if a combination cannot be driven.
    pub share: Option<Vec<f64>>,
}

/// The changes of a design.
pub fn of_design(
    drives: &Drives<'_>,
    genes: &[f64],
    present: &Drive,
    objectives: &[Objective],
) -> Result<Vec<Change>, Stopped> {
    let variables = drives.variables.iter().zip(genes).enumerate();
    let changed: Vec<usize> = variables
        .filter(|(_, (variable, gene))| !variable.is_present(**gene))
        .map(|(i, _)| i)
        .collect();
    let count = changed.len();
    let sets: Vec<u64> = if count <= MOST_SHARED {
        (1..1 << count).collect()
    } else {
        (0..count).map(|place| 1 << place).collect()
    };
    let holds = |set: u64, variable: usize| {
        let place = changed.iter().position(|known| *known == variable);
        place.is_some_and(|place| set & (1 << place) != 0)
    };
    let driven = drives.engine.jobs("combinations of changes", sets.len(), |i| {
        Ok(drives.drive(drives.overrides(genes, |variable| holds(sets[i], variable))))
    })?;
    let gain = |drive: &Drive| -> Vec<f64> {
        objectives
            .iter()
            .map(|objective| objective.value(present) - objective.value(drive))
            .collect()
    };
    let mut gains: Vec<Option<Vec<f64>>> = vec![Some(vec![0.0; objectives.len()])];
    gains.extend(driven.iter().map(|drive| drive.as_ref().ok().map(gain)));
    let change = |(place, variable): (usize, &usize)| Change {
        variable: *variable,
        alone: match count {
            0..=MOST_SHARED => gains[1 << place].clone(),
            _ => gains.get(place + 1).cloned().flatten(),
        },
        share: if count <= MOST_SHARED {
            share(&gains, place, count)
        } else {
            None
        },
    };
    Ok(changed.iter().enumerate().map(change).collect())
}

/// The Shapley value of a change, from the gains of all sets of changes as bits.
fn share(gains: &[Option<Vec<f64>>], place: usize, count: usize) -> Option<Vec<f64>> {
    let objectives = gains[0].as_ref()?.len();
    let mut sum = vec![0.0; objectives];
    for set in (0..gains.len()).filter(|set| set & (1 << place) == 0) {
        let [without, with] = [gains[set].as_ref()?, gains[set | 1 << place].as_ref()?];
        // |S|! (n - |S| - 1)! / n! = 1 / (n (n - 1 over |S|)).
        let size = set.count_ones() as usize;
        let weight = 1.0 / (count as f64 * binomial(count - 1, size));
        for ((sum, with), without) in sum.iter_mut().zip(with).zip(without) {
            *sum += weight * (with - without);
        }
    }
    Some(sum)
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_and_split_an_interaction_equally() {
        // v = 3 a + 5 b + 2 a b, and c does nothing.
        let gain = |set: usize| {
            let [a, b] = [0, 1].map(|place| (set >> place & 1) as f64);
            Some(vec![3.0 * a + 5.0 * b + 2.0 * a * b])
        };
        let gains: Vec<_> = (0..8).map(gain).collect();
        let shares: Vec<f64> = (0..3).filter_map(|place| Some(share(&gains, place, 3)?[0])).collect();
        for (share, expected) in shares.iter().zip([4.0, 6.0, 0.0]) {
            assert!((share - expected).abs() < 1e-14, "{shares:?}");
        }
        let mut broken = gains.clone();
        broken[3] = None;
        assert_eq!(share(&broken, 0, 3), None);
    }
}
