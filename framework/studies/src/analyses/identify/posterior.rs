//! The posterior: its marginals compared with the intervals of fit and profiles.

use gearloss_numerics::inference::{Ensemble, Marginal, Reach};
use schemars::JsonSchema;
use serde::Serialize;

use super::entry::{IdentifyEntry, PosteriorEntry, RobustLoss};
use crate::analyses::{Planner, Stopped};
use crate::identify::{Fitted, Identification, Profiled};

/// Maximum number of stored draws: with ten parameters about 200 MB.
const MOST_DRAWS: usize = 2_000_000;

/// Rejects entries without a posterior.
pub(super) fn check(
    cx: &Planner<'_>,
    entry: &IdentifyEntry,
    identification: &Identification<'_>,
) -> Result<(), Stopped> {
    let Some(posterior) = entry.posterior else {
        return Ok(());
    };
    let place = format!("{}.posterior", cx.path());
    if entry.robust.is_some_and(|robust| robust.loss != RobustLoss::Linear) {
        let message = "a robust loss does not define a posterior density";
        return Err(cx.wrong(&place, message, "delete `robust` or `posterior`"));
    }
    let ensemble = ensemble(posterior, identification);
    let draws = ensemble.steps * ensemble.walkers;
    if draws > MOST_DRAWS {
        let message = format!("{draws} draws exceed the maximum of {MOST_DRAWS}");
        return Err(cx.wrong(&place, message, "use fewer steps or walkers"));
    }
    Ok(())
}

/// Settings from an entry.
fn ensemble(entry: PosteriorEntry, identification: &Identification<'_>) -> Ensemble {
    Ensemble {
        walkers: entry.walkers.map_or_else(|| identification.walkers(), |n| n as usize),
        steps: entry.steps as usize,
        seed: u64::from(entry.seed),
    }
}

/// The posterior of the parameters of a set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PosteriorOfSet {
    /// Walkers.
    pub walkers: usize,
    /// Retained steps of each walker.
    pub steps: usize,
    /// Share of accepted moves. [-]
    pub acceptance: f64,
    /// Whether the sampling has converged.
    pub is_settled: bool,
    /// The free parameters.
    pub parameters: Vec<ParameterOfPosterior>,
}

/// Summary of the draws of one parameter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ParameterOfPosterior {
    /// Name.
    pub name: String,
    /// Median. [unit of the parameter]
    pub median: f64,
    /// 95 % interval. [unit of the parameter]
    pub interval: [f64; 2],
    /// Standard deviation of the draws. [unit of the parameter]
    pub standard_deviation: f64,
    /// Integrated autocorrelation time in steps. [-]
    pub autocorrelation_steps: f64,
    /// Effective number of independent draws. [-]
    pub independent_draws: f64,
    /// Unit.
    #[serde(skip)]
    pub unit: &'static str,
    /// 95 % interval of the linearised fit, not widened.
    #[serde(skip)]
    pub linearised: Option<[f64; 2]>,
    /// 95 % profile interval, if both ends were found.
    #[serde(skip)]
    pub profile: Option<[f64; 2]>,
}

/// Draws from the posterior and summarises; the draws are not stored.
pub(super) fn draw(
    entry: PosteriorEntry,
    (identification, fitted, profiles): (&Identification<'_>, &Fitted, &[Option<Profiled>]),
    interrupt: Option<&(dyn Fn() -> bool + Sync)>,
) -> Result<PosteriorOfSet, String> {
    let posterior = identification.posterior(fitted, &ensemble(entry, identification), interrupt)?;
    let parameter = |(k, marginal): (usize, &Option<Marginal>)| {
        let (marginal, parameter) = ((*marginal)?, &identification.parameters()[k]);
        let profile = profiles[k].as_ref().and_then(|profile| profile.as_ref().ok());
        let profile = profile.filter(|p| p.ends.iter().all(|end| end.reach != Reach::Unresolved));
        Some(ParameterOfPosterior {
            name: parameter.name.clone(),
            median: marginal.median,
            interval: marginal.interval,
            standard_deviation: marginal.deviation,
            autocorrelation_steps: marginal.autocorrelation,
            independent_draws: marginal.effective,
            unit: parameter.unit.symbol,
            linearised: fitted.inference.interval(k, 0.95, 1.0).map(|i| i.ends),
            profile: profile.map(|p| p.theta),
        })
    };
    Ok(PosteriorOfSet {
        walkers: posterior.draws.walkers,
        steps: posterior.draws.steps,
        acceptance: posterior.draws.acceptance,
        is_settled: posterior.is_settled,
        parameters: posterior.marginals.iter().enumerate().filter_map(parameter).collect(),
    })
}
