//! The error of a law in a further product, from the measured sets that judge it.
//!
//! The factor is measured over calculated loss. Sets are groups with random effects ([`Further`]): they differ by an unknown deviation, and the mean
//! of each is known with the error that its unstated inputs and its accuracy give. The points of a set scatter about its mean, because a
//! law is better at one speed than at another; this scatter is added, the same in all sets. No set has several units of one product, so
//! that the difference of units is part of that between sets.

use gearloss_framework::registry::JudgedCell;
use gearloss_numerics::inference::{Further, Group};
use schemars::JsonSchema;
use serde::Serialize;

use super::FEWEST_SETS;
use crate::distinct::distinct;

/// Probabilities of the ends and the middle of a distribution.
const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// A set that judges a law.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct JudgingSet {
    /// Its name.
    pub set: String,
    /// Geometric mean of calculated over measured loss over its points. [-]
    pub ratio: f64,
    /// Least and greatest ratio of a point. [-]
    #[serde(skip)]
    pub ends: [f64; 2],
    /// Standard deviation of the logarithm of the ratio from what the set does not state. \[-\]
    #[serde(skip)]
    pub error: f64,
    /// Standard deviation of the logarithms of the ratios of the points. \[-\]
    #[serde(skip)]
    pub scatter: Option<f64>,
}

/// How many sets are inside the band that the others give.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LeftOut {
    /// Sets whose mean is inside its 95 % band. [-]
    pub means_inside: usize,
    /// Sets all of whose points are inside their 95 % band. [-]
    pub points_inside: usize,
    /// Sets that were left out in turn. [-]
    pub sets: usize,
}

/// The error of a law.
#[derive(Debug, Clone, Default)]
pub struct ErrorOfLaw {
    /// The measured sets that count, in the order of their names.
    pub sets: Vec<JudgingSet>,
    /// Measured sets from which constants of the law were derived: they do not count.
    pub seen: Vec<JudgingSet>,
    /// Distribution of the logarithm of the factor on the loss at a point of a further set; absent below three sets.
    pub factor: Option<Further>,
    /// Each set against the others; absent unless at least three remain.
    pub left_out: Option<LeftOut>,
}

impl ErrorOfLaw {
    /// From the cells of a law in components of one kind. Several cells of a set count as one.
    pub fn of<'c>(cells: impl Iterator<Item = &'c JudgedCell<'c>>) -> Self {
        let mut law = Self::default();
        // Outside all stated ranges a set says nothing about the law inside them.
        let cells: Vec<&JudgedCell<'_>> = cells.filter(|cell| cell.measured && cell.in_range > 0.0).collect();
        for (list, is_seen) in [(&mut law.sets, false), (&mut law.seen, true)] {
            let own: Vec<&&JudgedCell<'_>> = cells.iter().filter(|cell| cell.seen == is_seen).collect();
            let mut names: Vec<&str> = own.iter().map(|cell| cell.set).collect();
            names.sort_unstable();
            names.dedup();
            let of_set = |set: &&str| together(own.iter().filter(|cell| cell.set == *set).map(|cell| **cell));
            list.extend(names.iter().filter_map(of_set));
        }
        law.factor = law.further(None, 0.0);
        law.left_out = law.left_out();
        law
    }

    /// Lower end, median and upper end of the 95 % band of the factor on the loss at a point of a further set.
    pub fn band(&self) -> Option<[f64; 3]> {
        quantiles(self.factor.as_ref()?)
    }

    /// Root mean square over the sets of the scatter of their points; zero if each has one point.
    fn scatter(&self) -> f64 {
        let squares: Vec<f64> = self.sets.iter().filter_map(|set| set.scatter).map(|x| x * x).collect();
        if squares.is_empty() {
            return 0.0;
        }
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    }

    /// The distribution from all sets, or without one of them, with a further deviation; absent below three sets.
    fn further(&self, without: Option<usize>, more: f64) -> Option<Further> {
        let groups = self.groups(without)?;
        let scatter = self.scatter();
        Further::new(&groups, (scatter * scatter + more * more).sqrt())
    }

    fn groups(&self, without: Option<usize>) -> Option<Vec<Group>> {
        let kept = self.sets.iter().enumerate().filter(|(i, _)| Some(*i) != without);
        let group = |(_, set): (usize, &JudgingSet)| Group {
            mean: -set.ratio.ln(),
            error: set.error,
        };
        let groups: Vec<Group> = kept.map(group).collect();
        (groups.len() >= FEWEST_SETS).then_some(groups)
    }

    fn left_out(&self) -> Option<LeftOut> {
        let mut all = LeftOut::default();
        for (i, set) in self.sets.iter().enumerate() {
            // What the set measured has its own error.
            let mean = quantiles(&Further::new(&self.groups(Some(i))?, set.error)?)?;
            let point = quantiles(&self.further(Some(i), set.error)?)?;
            let inside = |band: [f64; 3], ratio: f64| (band[0]..=band[2]).contains(&(1.0 / ratio));
            all.sets += 1;
            all.means_inside += usize::from(inside(mean, set.ratio));
            all.points_inside += usize::from(set.ends.iter().all(|ratio| inside(point, *ratio)));
        }
        (all.sets > 0).then_some(all)
    }
}

/// The errors of all laws of a table in each kind of component: mechanism, model, kind, error.
pub fn errors_of_laws<'c>(cells: &'c [JudgedCell<'c>]) -> Vec<([&'c str; 3], ErrorOfLaw)> {
    let key = |cell: &JudgedCell<'c>| [cell.mechanism, cell.model, cell.part];
    let own = |law: [&'c str; 3]| (law, ErrorOfLaw::of(cells.iter().filter(|cell| key(cell) == law)));
    distinct(cells.iter().filter(|cell| cell.measured).map(key))
        .into_iter()
        .map(own)
        .collect()
}

/// Lower end, median and upper end of a factor whose logarithm has a distribution.
fn quantiles(log: &Further) -> Option<[f64; 3]> {
    let mut ends = [0.0; 3];
    for (end, share) in ends.iter_mut().zip(SHARES) {
        *end = log.quantile(share)?.exp();
    }
    Some(ends)
}

/// Several cells of one set as one: the geometric mean of their ratios, the greatest error, the mean scatter.
fn together<'c>(cells: impl Iterator<Item = &'c JudgedCell<'c>> + Clone) -> Option<JudgingSet> {
    let count = cells.clone().count() as f64;
    let first = cells.clone().next()?;
    let squares: Vec<f64> = cells.clone().filter_map(|cell| cell.scatter).map(|x| x * x).collect();
    Some(JudgingSet {
        set: first.set.to_owned(),
        ratio: (cells.clone().map(|cell| cell.ratio.ln()).sum::<f64>() / count).exp(),
        ends: cells.clone().fold(first.ends, |[low, high], cell| {
            [low.min(cell.ends[0]), high.max(cell.ends[1])]
        }),
        error: cells.map(|cell| cell.error).fold(0.0, f64::max),
        scatter: (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_numerics::sampling::{Generator, inverse_normal};

    use super::*;

    /// So many that a share is known to within a percentage point.
    const SIMULATIONS: u32 = 1000;

    const HEAD: &str = "mechanism,model,nested,part,set,kind,seen,ratio,least,greatest,in_range,error,scatter\n";

    fn law(lines: &str) -> ErrorOfLaw {
        let csv = format!("{HEAD}{lines}");
        ErrorOfLaw::of(JudgedCell::read(&csv).unwrap().iter())
    }

    #[test]
    fn below_three_sets_there_are_ratios_and_no_band() {
        let two =
            law("bearing,law,,,a,measured,no,1.2,1,1.5,1,0.1,0.1\nbearing,law,,,b,measured,no,0.8,0.7,0.9,1,0.1,0.1\n");
        assert!(two.sets.len() == 2 && two.band().is_none() && two.left_out.is_none());
        // A set that gave the constants, another program, a second cell of a set, and one outside all ranges are no further sets.
        let still = law(
            "bearing,law,,,a,measured,no,1.2,1,1.5,1,0.1,0.1\nbearing,law,,,a,measured,no,1.3,1,1.5,1,0.1,0.1\n\
             bearing,law,,,b,measured,no,0.8,0.7,0.9,1,0.1,0.1\nbearing,law,,,c,measured,yes,1,1,1,1,0.1,0.1\n\
             bearing,law,,,d,calculated,no,1,1,1,1,0.1,0.1\n\
             bearing,law,,,e,measured,no,1,1,1,0,0.1,0.1\n",
        );
        assert!(still.sets.len() == 2 && still.seen.len() == 1 && still.band().is_none());
    }

    #[test]
    fn the_factor_contains_the_bias() {
        // A law that gives twice the measured loss in every set.
        let line = |i| format!("bearing,law,,,s{i},measured,no,2,1.95,2.05,1,0.01,0.02\n");
        let lines = (0..6).map(line).collect::<Vec<String>>().concat();
        let [low, middle, high] = law(&lines).band().unwrap();
        assert!(
            (middle - 0.5).abs() < 0.01 && low > 0.45 && high < 0.55,
            "{low} {middle} {high}"
        );
        assert_eq!(
            law(&lines).left_out,
            Some(LeftOut {
                means_inside: 6,
                points_inside: 6,
                sets: 6
            })
        );
    }

    /// Corpora with a known error of the law: bias, deviation between sets, scatter of the points; each set has a known error of its own.
    #[test]
    fn the_distribution_covers_the_error_of_simulated_corpora() {
        let mut random = Generator::new(60);
        let mut normal = || inverse_normal(random.unit().max(1e-12)).unwrap();
        for (sets, between, within) in [(3, 0.3, 0.2), (5, 0.4, 0.3), (8, 0.2, 0.3)] {
            let bias = 0.25;
            let mut covered = 0.0;
            for _ in 0..SIMULATIONS {
                let mut lines = String::new();
                for set in 0..sets {
                    let error = 0.05 + 0.05 * f64::from(set % 3);
                    let mean = bias + between * normal() + error * normal();
                    let logs: Vec<f64> = (0..6).map(|_| mean + within * normal()).collect();
                    let of = logs.iter().sum::<f64>() / 6.0;
                    let scatter = (logs.iter().map(|x| (x - of) * (x - of)).sum::<f64>() / 5.0).sqrt();
                    let ends = logs.iter().fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], log| {
                        [low.min(log.exp()), high.max(log.exp())]
                    });
                    lines += &format!(
                        "bearing,law,,,s{set},measured,no,{},{},{},1,{error},{scatter}\n",
                        of.exp(),
                        ends[0],
                        ends[1]
                    );
                }
                // The loss of a further product at a point, calculated over measured.
                let ratio = (bias + between * normal() + within * normal()).exp();
                let [low, _, high] = law(&lines).band().unwrap();
                covered += f64::from((low..=high).contains(&(1.0 / ratio)));
            }
            let share = covered / f64::from(SIMULATIONS);
            assert!(
                (0.90..=0.98).contains(&share),
                "{sets} sets, {between}, {within}: {share}"
            );
        }
    }
}
