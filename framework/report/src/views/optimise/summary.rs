//! What the best design loses and which change saves most, in one sentence.

use gearloss_studies::analyses::optimise::{
    BandOfGain, ChangeOfDesign, Disagreement, Minimised, ObjectiveOfSearch, OptimiseOutcome,
};

use crate::names::{cycle, listed};
use crate::page::Page;
use crate::text::short;

/// Changes that the sentence names.
const NAMED: usize = 3;

pub fn add(outcome: &OptimiseOutcome, page: &mut Page) {
    careful(outcome, page);
    let gains: Vec<String> = outcome
        .objectives
        .iter()
        .filter_map(|objective| gain(objective, page))
        .collect();
    if gains.is_empty() {
        page.headline = Some(format!(
            "None of {} designs keeps all limits{}",
            outcome.designs,
            tightest(outcome)
        ));
        return;
    }
    let tried = if outcome.exhaustive {
        format!("The best of all {} combinations", outcome.designs)
    } else {
        format!("The best of {} designs", outcome.designs)
    };
    let unit = outcome.objectives.first().map_or("W", |objective| objective.unit);
    let changes = outcome
        .changes
        .iter()
        .take(NAMED)
        .filter_map(|of_design| change(of_design, unit));
    let changes: Vec<String> = changes.collect();
    let changes = if changes.is_empty() {
        "; it is the present design".to_owned()
    } else {
        format!(": {}", listed(&changes))
    };
    let verb = if outcome
        .objectives
        .iter()
        .all(|objective| objective.quantity == Minimised::MeanLoss)
    {
        "loses"
    } else {
        "uses"
    };
    page.headline = Some(format!("{tried} {verb} {}{changes}", listed(&gains)));
    for of_cycle in &outcome.disagreements {
        page.careful.push(disagreement(outcome, of_cycle));
    }
    for limit in outcome.limits.iter().filter(|limit| limit.binding) {
        let near = |bound: &f64| limit.best.map_or(0.0, |best| (best - bound).abs());
        let bounds = [limit.entry.least, limit.entry.most].into_iter().flatten();
        let bound = bounds.min_by(|a, b| near(a).total_cmp(&near(b)));
        let bound = bound.map_or_else(String::new, short);
        page.key_figure(
            &format!("limit `{}`", limit.entry.limit),
            limit.best.map_or_else(String::new, short),
            &limit.entry.unit,
            format!("{}, at its limit of {bound}", limit.entry.quantity),
        );
    }
}

/// A minimised quantity before and after.
fn gain(objective: &ObjectiveOfSearch, page: &mut Page) -> Option<String> {
    let best = objective.best?;
    let name = cycle(&objective.cycle);
    let (quantity, unit) = (objective.quantity.words(), objective.unit);
    let percent = 100.0 * (best / objective.present - 1.0);
    let band = objective.band.map_or_else(String::new, |band| {
        let [low, _, high] = band.gain().map(short);
        format!("; gain {low} to {high} {unit} under the uncertain inputs")
    });
    let label = format!("{quantity} over {name}");
    let detail = format!("{} {unit} at present{band}", short(objective.present));
    page.key_figure(&label, short(best), unit, detail);
    if objective.band.is_some_and(|band| band.contains_zero) {
        page.careful
            .push(format!("{name}: the gain is smaller than its uncertainty"));
    }
    let change = if objective.present > 0.0 {
        format!(" ({percent:+.1} %)")
    } else {
        String::new()
    };
    Some(format!(
        "{} {unit} over {name} instead of {} {unit}{change}",
        short(best),
        short(objective.present)
    ))
}

/// Why the design with the least loss is not that with the least consumption.
pub fn disagreement(outcome: &OptimiseOutcome, of_cycle: &Disagreement) -> String {
    let (lossy, frugal) = (&of_cycle.least_loss, &of_cycle.least_consumption);
    let words = |values: &[String]| {
        let pairs = outcome.variables.iter().zip(values);
        listed(
            &pairs
                .map(|(variable, value)| format!("{} {value}", variable.variable))
                .collect::<Vec<_>>(),
        )
    };
    let [loss, consumption] = [lossy, frugal].map(|design| &design.consumption);
    let machine = loss.machine_kwh_per_100_km - consumption.machine_kwh_per_100_km;
    let gearbox = consumption.transmission_kwh_per_100_km - loss.transmission_kwh_per_100_km;
    let why = if machine > 0.0 {
        format!(
            "its machine loses {} kWh/100 km more, its gearbox {} kWh/100 km less",
            short(machine),
            short(gearbox)
        )
    } else {
        "what the brakes and the battery take differs more than the loss of the gearbox".to_owned()
    };
    format!(
        "{}: the least loss is not the least consumption: with {} the gearbox loses {} W and the vehicle uses {} kWh/100 km, with {} {} W and \
         {} kWh/100 km; {why}",
        cycle(&of_cycle.cycle),
        words(&lossy.values),
        short(lossy.mean_loss_w),
        short(loss.consumption_kwh_per_100_km),
        words(&frugal.values),
        short(frugal.mean_loss_w),
        short(consumption.consumption_kwh_per_100_km),
    )
}

/// A change with what it saves in the first objective.
fn change(change: &ChangeOfDesign, unit: &str) -> Option<String> {
    let saved = change.share.as_ref().or(change.alone.as_ref())?.first()?;
    let words = format!("{} {} instead of {}", change.variable, change.to, change.from);
    Some(if *saved >= 0.0 {
        format!("{words} saves {} {unit}", short(*saved))
    } else {
        format!("{words} costs {} {unit}", short(-saved))
    })
}

/// The limit that most designs break, where none keeps all.
fn tightest(outcome: &OptimiseOutcome) -> String {
    let broken = |i: usize| {
        let limit = &outcome.limits[i].entry;
        let beyond = |value: &f64| {
            limit.least.is_some_and(|least| *value < least) || limit.most.is_some_and(|most| *value > most)
        };
        outcome
            .all
            .iter()
            .filter(|design| design.limited.get(i).is_some_and(beyond))
            .count()
    };
    let worst = (0..outcome.limits.len()).max_by_key(|i| broken(*i));
    worst.map_or_else(String::new, |i| {
        format!("; {} break `{}`", broken(i), outcome.limits[i].entry.limit)
    })
}

fn careful(outcome: &OptimiseOutcome, page: &mut Page) {
    for variable in outcome.variables.iter().filter(|variable| variable.at_end_of_range) {
        page.careful.push(format!(
            "{} {} is at the end of its range",
            variable.variable,
            variable.best.as_deref().unwrap_or_default()
        ));
    }
    for limit in outcome
        .limits
        .iter()
        .map(|limit| &limit.entry)
        .filter(|limit| !limit.present_keeps_it)
    {
        page.careful.push(format!(
            "the present design breaks `{}`: {} {}",
            limit.limit,
            limit.present.map_or_else(|| "no value".to_owned(), short),
            limit.unit
        ));
    }
    for change in &outcome.changes {
        if change.bands.first().is_some_and(|band: &BandOfGain| band.contains_zero) {
            page.careful.push(format!(
                "{}: its gain alone is smaller than its uncertainty",
                change.variable
            ));
        }
    }
    if let [only] = &outcome.failures[..] {
        page.careful.push(format!(
            "{} designs could not be driven, the first: {}",
            outcome.failed, only.reason
        ));
    }
    if outcome.failures.len() > 1 {
        let reasons = outcome.failures.iter().take(NAMED);
        let reasons = reasons.map(|failure| format!("{} times {}", failure.designs, failure.reason));
        let more = match outcome.failures.len() {
            count if count > NAMED => format!("; {} other reasons", count - NAMED),
            _ => String::new(),
        };
        page.careful.push(format!(
            "{} designs could not be driven: {}{more}",
            outcome.failed,
            reasons.collect::<Vec<_>>().join("; ")
        ));
    }
}
