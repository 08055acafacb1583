//! Multistart search for several minima.

use nalgebra::DVector;
use rayon::prelude::*;

use super::evaluate::Evaluator;
use super::fault::{Fault, Finding};
use super::fit::Fit;
use super::options::Options;
use super::points;
use super::problem::Problem;
use super::robust::Robust;
use super::solve::search;
use super::space::Space;
use super::unite::unite;

/// Relative difference of equal costs, and the same relative to the cost at the start.
const SAME: [f64; 2] = [1e-6, 1e-12];
/// Distance of equal points in standard errors of each direction.
const NEAR: f64 = 0.1;
/// Relative distance of equal coordinates if standard errors are infinite.
const APART: f64 = 1e-3;
/// Width of the start region in typical sizes if a bound is missing.
const AWAY: f64 = 10.0;
/// Number of evaluated points between two minima.
pub(super) const BETWEEN: usize = 7;
/// Maximum number of evaluated starts for each valid one.
const PATIENCE: usize = 20;

/// A minimum with the starts that converge to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum {
    /// The best fit of those that end in it.
    pub fit: Fit,
    /// Indices of the starts; 0 is the user's.
    pub starts: Vec<usize>,
    /// Their share of all. \[-\]
    pub share: f64,
}

/// Relation of minima with equal cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kinship {
    /// The cost is constant between them: a combination of parameters is not identifiable.
    Valley,
    /// The cost increases between them, for example if two parameters are exchangeable.
    Equivalent,
}

impl Kinship {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Valley => "valley",
            Self::Equivalent => "equivalent minima",
        }
    }
}

/// All minima that were found.
#[derive(Debug, Clone, PartialEq)]
pub struct Minima {
    /// Each of them, the lowest first.
    pub minima: Vec<Minimum>,
    /// Relation of minima with the same cost as the lowest; absent if it is unique.
    pub kinship: Option<Kinship>,
    /// Calls of the residual function, all starts together.
    pub evaluations: usize,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// Solves a problem from its own start and from others distributed within its bounds, `starts` in total.
///
/// # Errors
/// If the problem is invalid, or if hardly any point has residuals.
pub fn multistart(problem: &Problem<'_>, options: &Options<'_>, starts: usize) -> Result<Minima, Fault> {
    let space = Space::from_parameters(problem.parameters())?;
    let others = even_starts(problem, options, &space, starts.saturating_sub(1));
    let others_or_none = others.as_ref().map_or(&[][..], |(others, _)| others);
    let search_from = |i: usize| match i.checked_sub(1) {
        None => search(problem, options, &space),
        Some(other) => search(problem, options, &space.starting(&others_or_none[other])),
    };
    let count = 1 + others_or_none.len();
    let fits: Vec<Result<Fit, Fault>> = match options.searches {
        Some(run) => run(count, &search_from),
        None => (0..count).into_par_iter().with_max_len(1).map(search_from).collect(),
    };
    let mut fits = fits.into_iter().enumerate();
    // Faults of the user's start come before all others.
    let (_, first) = fits.next().unwrap_or_else(|| (0, search_from(0)));
    let first = first?;
    let (_, looked) = others?;
    let others = fits.map(|(i, fit)| Ok((i, fit?)));
    // The cost at the user's start.
    let begun = first.log.first().map_or(first.cost, |step| step.cost);
    let mut fits: Vec<(usize, Fit)> = std::iter::once(Ok((0, first)))
        .chain(others)
        .collect::<Result<_, Fault>>()?;
    fits.sort_by(|(i, a), (j, b)| a.cost.total_cmp(&b.cost).then(i.cmp(j)));
    let mut evaluations = looked + fits.iter().map(|(_, fit)| fit.counts.evaluations).sum::<usize>();
    let minima = if options.polish {
        let (minima, more) = unite(problem, options, &space, fits, begun)?;
        evaluations += more;
        minima
    } else {
        gather(&space, fits, begun)
    };
    let mut notes = Vec::new();
    if !minima[0].starts.contains(&0) {
        notes.push("the given start does not lead to the lowest minimum".to_owned());
    }
    let lowest: Vec<&Fit> = minima
        .iter()
        .map(|minimum| &minimum.fit)
        .filter(|fit| level(&minima[0].fit, fit, begun))
        .collect();
    let kinship = kinship(problem, options, &space, &lowest, &mut evaluations)?;
    Ok(Minima {
        minima,
        kinship,
        evaluations,
        notes,
    })
}

/// Groups fits at the same point with the same cost into minima, the lowest first.
fn gather(space: &Space<'_>, fits: Vec<(usize, Fit)>, begun: f64) -> Vec<Minimum> {
    let share = 1.0 / fits.len() as f64;
    let mut minima: Vec<Minimum> = Vec::new();
    for (i, fit) in fits {
        let old = minima
            .iter_mut()
            .find(|old| level(&old.fit, &fit, begun) && near(space, &old.fit, &fit));
        if let Some(old) = old {
            old.starts.push(i);
            old.share += share;
        } else {
            let starts = vec![i];
            minima.push(Minimum { fit, starts, share });
        }
    }
    minima
}

/// Starts within the bounds that have residuals, and the number of calls to find them.
fn even_starts(
    problem: &Problem<'_>,
    options: &Options<'_>,
    space: &Space<'_>,
    count: usize,
) -> Result<(Vec<Vec<f64>>, usize), Fault> {
    let end = |j: usize, bound: f64, side: f64| {
        if bound.is_finite() {
            bound
        } else {
            space.start[j] + side * AWAY * space.typical[j]
        }
    };
    let (mut starts, mut looked) = (Vec::with_capacity(count), 0);
    while starts.len() < count && !options.interrupt.is_some_and(|stop| stop()) {
        if looked == PATIENCE * count {
            let message = format!(
                "only {} of {looked} points within the bounds have residuals",
                starts.len()
            );
            return Err(Finding::new("starts", message, "narrow the bounds, or request fewer starts").into());
        }
        looked += 1;
        let point = points::spread(looked, space.len());
        let u: Vec<f64> = (0..space.len())
            .map(|j| {
                let (lower, upper) = (end(j, space.lower[j], -1.0), end(j, space.upper[j], 1.0));
                lower + point[j] * (upper - lower)
            })
            .collect();
        if Evaluator::start(problem, &space.starting(&u), None).is_ok() {
            starts.push(u);
        }
    }
    Ok((starts, looked))
}

/// Whether two costs are equal.
pub(super) fn level(a: &Fit, b: &Fit, begun: f64) -> bool {
    (a.cost - b.cost).abs() <= SAME[0] * a.cost.min(b.cost) + SAME[1] * begun
}

/// Whether a fit is at the same point as a better one: by standard errors, or by coordinates if those are infinite.
pub(super) fn near(space: &Space<'_>, better: &Fit, fit: &Fit) -> bool {
    let free = |j: &usize| better.active[*j].is_none();
    let apart = |i: usize| fit.u[i] - better.u[i];
    match &better.derivative {
        Some(derivative) if better.converged() => {
            let columns: Vec<usize> = space.free.iter().copied().filter(free).collect();
            let away = DVector::from_iterator(columns.len(), columns.iter().map(|i| apart(*i)));
            let distance = (derivative.jacobian.select_columns(&columns) * away).norm();
            distance <= NEAR * (columns.len() as f64).sqrt()
        }
        _ => (0..space.len()).all(|j| {
            let i = space.free[j];
            apart(i).abs() <= APART * space.size(j, better.u[i])
        }),
    }
}

/// Connects each of several fits to the nearest connected one, and checks whether the cost increases between them.
fn kinship(
    problem: &Problem<'_>,
    options: &Options<'_>,
    space: &Space<'_>,
    fits: &[&Fit],
    evaluations: &mut usize,
) -> Result<Option<Kinship>, Fault> {
    let coordinates: Vec<Vec<f64>> = fits
        .iter()
        .map(|fit| space.free.iter().map(|i| fit.u[*i]).collect())
        .collect();
    let distance = |a: usize, b: usize| -> f64 {
        let part = |j: usize| (coordinates[a][j] - coordinates[b][j]) / space.typical[j];
        (0..space.len()).map(|j| part(j).powi(2)).sum()
    };
    let start = space.starting(&coordinates[0]);
    let (evaluator, _) = Evaluator::start(problem, &start, None)?;
    let robust = Robust {
        loss: options.loss,
        scale: fits[0].loss_scale,
        rows: evaluator.rows,
    };
    let (mut reached, mut left) = (vec![0], (1..fits.len()).collect::<Vec<usize>>());
    let mut kinship = None;
    while !left.is_empty() {
        let pairs = reached.iter().flat_map(|a| left.iter().map(|b| (*a, *b)));
        let Some((a, b)) = pairs.min_by(|x, y| distance(x.0, x.1).total_cmp(&distance(y.0, y.1))) else {
            break;
        };
        kinship = kinship.or(Some(Kinship::Valley));
        for k in 1..=BETWEEN {
            let share = k as f64 / (BETWEEN + 1) as f64;
            let mix = |j: usize| coordinates[a][j] + share * (coordinates[b][j] - coordinates[a][j]);
            let u: Vec<f64> = (0..space.len()).map(mix).collect();
            // Twice the cost is the sum of squares; one standard error corresponds to 1.
            let rises = |r: &DVector<f64>| 2.0 * (robust.cost(r) - fits[0].cost) > 1.0;
            if evaluator.residual(&u).map_or(true, |r| rises(&r)) {
                kinship = Some(Kinship::Equivalent);
                break;
            }
        }
        reached.push(b);
        left.retain(|other| *other != b);
    }
    *evaluations += evaluator.evaluations();
    Ok(kinship)
}
