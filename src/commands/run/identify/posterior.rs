//! Intervals of the posterior, beside those of the fit and by profile.

use gearloss_numerics::inference::{Ensemble, Marginal, Reach};
use gearloss_studies::identify::Identification;
use gearloss_studies::study::{IdentifyEntry, PosteriorEntry, RobustLoss};
use serde_json::{Value, json};

use super::super::Runner;
use super::super::table::TableFile;
use super::super::write::cell;
use super::outcome::Outcome;
use super::show::{short, span};
use crate::output::{Failure, Out, Table, fixed};

/// The most draws that are held: with ten parameters some 200 MB.
const MOST_DRAWS: usize = 2_000_000;

/// Refuses what no posterior can be drawn from.
pub fn check(
    runner: &Runner<'_>,
    path: &str,
    entry: &IdentifyEntry,
    identification: &Identification<'_>,
) -> Result<(), Failure> {
    let Some(posterior) = entry.posterior else {
        return Ok(());
    };
    let place = format!("{path}.posterior");
    if entry.robust.is_some_and(|robust| robust.loss != RobustLoss::Linear) {
        let message = "a robust loss is no density, so nothing can be drawn from it";
        return Err(runner.wrong(&place, message, "leave `robust` or `posterior` out"));
    }
    let ensemble = ensemble(posterior, identification);
    let draws = ensemble.steps * ensemble.walkers;
    if draws > MOST_DRAWS {
        let message = format!("{draws} draws are more than the {MOST_DRAWS} that can be held");
        return Err(runner.wrong(&place, message, "take fewer steps or walkers"));
    }
    Ok(())
}

/// What an entry asks for.
pub fn ensemble(entry: PosteriorEntry, identification: &Identification<'_>) -> Ensemble {
    Ensemble {
        walkers: entry.walkers.map_or_else(|| identification.walkers(), |n| n as usize),
        steps: entry.steps as usize,
        seed: u64::from(entry.seed),
    }
}

/// Both intervals that the posterior is compared with: linearised, not widened, and by profile.
fn others(o: &Outcome<'_>, k: usize) -> [Option<[f64; 2]>; 2] {
    let interval = o.fitted.inference.interval(k, 0.95, 1.0).map(|i| i.ends);
    let profile = o.profiles[k].as_ref().and_then(|profile| profile.as_ref().ok());
    let profile = profile.filter(|p| p.ends.iter().all(|end| end.reach != Reach::Unresolved));
    [interval, profile.map(|p| p.theta)]
}

/// The parameters that were drawn.
fn drawn<'o>(o: &'o Outcome<'_>) -> impl Iterator<Item = (usize, Marginal)> + 'o {
    let posterior = o.posterior.as_ref().and_then(|posterior| posterior.as_ref().ok());
    let marginals = posterior
        .into_iter()
        .flat_map(|posterior| posterior.marginals.iter().enumerate());
    marginals.filter_map(|(k, marginal)| Some((k, (*marginal)?)))
}

pub fn show(runner: &Runner<'_>, name: &str, o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    let posterior = match &o.posterior {
        None => return Ok(()),
        Some(Err(reason)) => return Ok(out.line(format!("{name}: no posterior: {reason}"))?),
        Some(Ok(posterior)) => posterior,
    };
    let mut table = Table::new(&[
        "parameter",
        "unit",
        "median",
        "95 % of the posterior",
        "95 % linearised",
        "95 % by profile",
        "independent draws",
    ]);
    for (k, marginal) in drawn(o) {
        let parameter = &o.identification.parameters()[k];
        let mut row = vec![
            parameter.name.clone(),
            parameter.unit.symbol.to_owned(),
            short(marginal.median),
            span(marginal.interval),
        ];
        row.extend(others(o, k).map(|ends| ends.map_or_else(|| "-".to_owned(), span)));
        row.push(fixed(marginal.effective, 0));
        table.row(row);
    }
    out.line(format!(
        "{name}: posterior of {} walkers, {} steps each, {:.0} % of the moves accepted",
        posterior.draws.walkers,
        posterior.draws.steps,
        100.0 * posterior.draws.acceptance
    ))?;
    out.text(&table.render())?;
    if !posterior.is_settled {
        let least = drawn(o)
            .map(|(_, marginal)| marginal.effective)
            .fold(f64::INFINITY, f64::min);
        let slowest = drawn(o)
            .map(|(_, marginal)| marginal.autocorrelation)
            .fold(1.0, f64::max);
        let sentence = format!(
            "{name}: the posterior is not settled: {least:.0} independent draws, and a walker remembers {slowest:.0} of its {} steps; \
             400 draws and twenty times as many steps are due: write more `steps`",
            posterior.draws.steps
        );
        runner.verdict(sentence, out)?;
    }
    Ok(())
}

pub fn write(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, all: &[Outcome<'_>]) -> Result<(), Failure> {
    let header = [
        "model_set",
        "parameter",
        "unit",
        "median",
        "low",
        "high",
        "standard_deviation",
        "linearised_low",
        "linearised_high",
        "profile_low",
        "profile_high",
        "autocorrelation_steps",
        "independent_draws",
    ]
    .map(str::to_owned);
    let mut table = TableFile::new(runner.run, &format!("{name}-posterior"), &entry.write, &header)?;
    let mut rows: Vec<Vec<String>> = Vec::new();
    for o in all {
        for (k, marginal) in drawn(o) {
            let parameter = &o.identification.parameters()[k];
            let mut row = vec![o.name.clone(), parameter.name.clone(), parameter.unit.symbol.to_owned()];
            let [low, high] = marginal.interval;
            row.extend([marginal.median, low, high, marginal.deviation].map(|x| cell(Some(x))));
            row.extend(
                others(o, k)
                    .iter()
                    .flat_map(|ends| [0, 1].map(|e| cell(ends.map(|ends| ends[e])))),
            );
            row.extend([marginal.autocorrelation, marginal.effective].map(|x| cell(Some(x))));
            rows.push(row);
        }
    }
    table.push_all(&rows)?;
    table.finish()
}

/// The posterior as JSON; null where none was asked for, or none could be drawn.
pub fn value(o: &Outcome<'_>) -> Value {
    let Some(Ok(posterior)) = &o.posterior else {
        return Value::Null;
    };
    let parameters = drawn(o).map(|(k, marginal)| {
        json!({
            "name": o.identification.parameters()[k].name, "median": marginal.median, "interval": marginal.interval,
            "standard_deviation": marginal.deviation, "autocorrelation_steps": marginal.autocorrelation,
            "independent_draws": marginal.effective,
        })
    });
    json!({
        "walkers": posterior.draws.walkers, "steps": posterior.draws.steps, "acceptance": posterior.draws.acceptance,
        "is_settled": posterior.is_settled, "parameters": parameters.collect::<Vec<_>>(),
    })
}
