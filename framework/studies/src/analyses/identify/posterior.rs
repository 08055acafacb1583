//! The posterior: its marginals beside the intervals of the fit and by profile.

use gearloss_numerics::inference::{Ensemble, Marginal, Reach};
use schemars::JsonSchema;
use serde::Serialize;

use super::entry::{IdentifyEntry, PosteriorEntry, RobustLoss};
use super::outcome::IdentificationOfSet;
use crate::analyses::{Context, Stopped};
use crate::cells;
use crate::identify::{Fitted, Identification, Profiled};
use crate::table::{Column, Table};

/// The most draws that are held: with ten parameters some 200 MB.
const MOST_DRAWS: usize = 2_000_000;

/// Refuses what no posterior can be drawn from.
pub(super) fn check(
    cx: &Context<'_>,
    entry: &IdentifyEntry,
    identification: &Identification<'_>,
) -> Result<(), Stopped> {
    let Some(posterior) = entry.posterior else {
        return Ok(());
    };
    let place = format!("{}.posterior", cx.path());
    if entry.robust.is_some_and(|robust| robust.loss != RobustLoss::Linear) {
        let message = "a robust loss is no density, so nothing can be drawn from it";
        return Err(cx.wrong(&place, message, "leave `robust` or `posterior` out"));
    }
    let ensemble = ensemble(posterior, identification);
    let draws = ensemble.steps * ensemble.walkers;
    if draws > MOST_DRAWS {
        let message = format!("{draws} draws are more than the {MOST_DRAWS} that can be held");
        return Err(cx.wrong(&place, message, "take fewer steps or walkers"));
    }
    Ok(())
}

/// What an entry asks for.
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
    /// Steps of each that count.
    pub steps: usize,
    /// Share of the moves that were accepted. [-]
    pub acceptance: f64,
    /// Whether every walker ran long enough for its draws to be trusted.
    pub is_settled: bool,
    /// The free parameters.
    pub parameters: Vec<ParameterOfPosterior>,
}

/// What the draws say of one parameter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ParameterOfPosterior {
    /// Name.
    pub name: String,
    /// Half of the draws lie below. [unit of the parameter]
    pub median: f64,
    /// 95 % of the draws lie between. [unit of the parameter]
    pub interval: [f64; 2],
    /// Standard deviation of the draws. [unit of the parameter]
    pub standard_deviation: f64,
    /// Steps after which a walker has forgotten where it was. [-]
    pub autocorrelation_steps: f64,
    /// Independent draws that tell as much as all of these. [-]
    pub independent_draws: f64,
    /// Unit.
    #[serde(skip)]
    pub unit: &'static str,
    /// 95 % interval of the linearised fit, not widened.
    #[serde(skip)]
    pub linearised: Option<[f64; 2]>,
    /// 95 % interval by profile, where both ends were found.
    #[serde(skip)]
    pub profile: Option<[f64; 2]>,
}

/// Draws from the posterior, and sums up what they say; the draws themselves are not kept.
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

/// The marginals of all sets, beside the other intervals.
pub(super) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    const UNIT: &str = "mixed";
    let mut table = Table::new(
        format!("{name}-posterior"),
        [
            Column::text("model_set", "Model set"),
            Column::text("parameter", "Name of the parameter"),
            Column::text("unit", "Unit of the values of this row"),
            Column::number("median", UNIT, "Half of the draws lie below"),
            Column::number("low", UNIT, "Lower end of the 95 % interval of the draws"),
            Column::number("high", UNIT, "Upper end of the 95 % interval of the draws"),
            Column::number("standard_deviation", UNIT, "Standard deviation of the draws"),
            Column::number(
                "linearised_low",
                UNIT,
                "Lower end of the 95 % interval of the linearised fit",
            ),
            Column::number(
                "linearised_high",
                UNIT,
                "Upper end of the 95 % interval of the linearised fit",
            ),
            Column::number("profile_low", UNIT, "Lower end of the 95 % interval by profile"),
            Column::number("profile_high", UNIT, "Upper end of the 95 % interval by profile"),
            Column::number(
                "autocorrelation_steps",
                "-",
                "Steps after which a walker has forgotten where it was",
            ),
            Column::number(
                "independent_draws",
                "-",
                "Independent draws that tell as much as all of these",
            ),
        ],
    );
    for o in all {
        for p in o.posterior.iter().flat_map(|posterior| &posterior.parameters) {
            table.push(cells![
                &o.model_set,
                &p.name,
                p.unit,
                p.median,
                p.interval[0],
                p.interval[1],
                p.standard_deviation,
                p.linearised.map(|ends| ends[0]),
                p.linearised.map(|ends| ends[1]),
                p.profile.map(|ends| ends[0]),
                p.profile.map(|ends| ends[1]),
                p.autocorrelation_steps,
                p.independent_draws,
            ]);
        }
    }
    table
}
