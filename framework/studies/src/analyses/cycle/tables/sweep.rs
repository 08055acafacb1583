//! Losses that depend on the same temperatures, and those that can be tabulated together.

use super::ranges::spaced;

/// Numbers of points over the temperatures of the nodes on which a loss depends, the one that matters most first.
pub const TEMPERATURES: [&[usize]; 4] = [&[], &[17], &[11, 5], &[9, 4, 4]];

/// Parts that depend on the same nodes.
pub struct Group {
    pub nodes: Vec<usize>,
    pub parts: Vec<usize>,
    /// Nodes that they heat.
    pub heated: Vec<usize>,
}

/// Groups that are tabulated together: the same combinations of temperatures, by rank of the nodes in each group.
pub struct Sweep {
    pub groups: Vec<usize>,
    /// Rank of each node in the groups that depend on it; absent if none does.
    ranks: Vec<Option<usize>>,
    /// Temperatures by rank. \[degC\]
    pub axes: Vec<Vec<f64>>,
}

impl Sweep {
    /// As few as possible for all groups.
    pub fn all(groups: &[Group], nodes: usize, temperatures: [f64; 2]) -> Vec<Self> {
        let mut sweeps: Vec<Self> = Vec::new();
        for (place, group) in groups.iter().enumerate() {
            if sweeps.iter_mut().any(|sweep| sweep.join(place, group)) {
                continue;
            }
            let counts = TEMPERATURES[group.nodes.len()];
            let mut begun = Self {
                groups: Vec::new(),
                ranks: vec![None; nodes],
                axes: counts.iter().map(|count| spaced(temperatures, *count)).collect(),
            };
            begun.join(place, group);
            sweeps.push(begun);
        }
        sweeps
    }

    /// Adds a group whose nodes have no other rank in the groups before; true if it is one.
    fn join(&mut self, place: usize, group: &Group) -> bool {
        let ranked = || group.nodes.iter().zip(0..);
        let fits = ranked().all(|(node, rank)| self.ranks[*node].is_none_or(|known| known == rank));
        if !fits || group.nodes.len() != self.axes.len() {
            return false;
        }
        for (node, rank) in ranked() {
            self.ranks[*node] = Some(rank);
        }
        self.groups.push(place);
        true
    }

    /// Number of combinations.
    pub fn len(&self) -> usize {
        self.axes.iter().map(Vec::len).product()
    }

    /// Temperatures of all nodes in a combination; the last rank varies fastest. Nodes that hardly matter have the mean of the others, or
    /// `middle`. \[degC\]
    pub fn temperatures(&self, combination: usize, middle: f64) -> Vec<f64> {
        let (mut rest, mut given) = (combination, vec![0.0; self.axes.len()]);
        for (temperature, axis) in given.iter_mut().zip(&self.axes).rev() {
            *temperature = axis[rest % axis.len()];
            rest /= axis.len();
        }
        let mean = given.iter().sum::<f64>() / given.len().max(1) as f64;
        let mean = if given.is_empty() { middle } else { mean };
        let of = |rank: &Option<usize>| rank.map_or(mean, |rank| given[rank]);
        self.ranks.iter().map(of).collect()
    }
}
