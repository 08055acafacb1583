//! What the best design loses and which change saves most, in one sentence.

use gearloss_studies::analyses::optimise::{BandOfGain, ChangeOfDesign, GainOfCycle, OptimiseOutcome};

use crate::names::{cycle, listed};
use crate::page::Page;
use crate::text::short;

/// Changes that the sentence names.
const NAMED: usize = 3;

pub fn add(outcome: &OptimiseOutcome, page: &mut Page) {
    careful(outcome, page);
    let minimised: Vec<&GainOfCycle> = outcome.gains.iter().filter(|gain| gain.minimised).collect();
    let gains: Vec<String> = minimised.iter().filter_map(|of_cycle| gain(of_cycle, page)).collect();
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
    let changes = outcome.changes.iter().take(NAMED).filter_map(change);
    let changes: Vec<String> = changes.collect();
    let changes = if changes.is_empty() {
        "; it is the present design".to_owned()
    } else {
        format!(": {}", listed(&changes))
    };
    page.headline = Some(format!("{tried} loses {}{changes}", listed(&gains)));
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

/// Losses of a cycle before and after.
fn gain(cycle_gain: &GainOfCycle, page: &mut Page) -> Option<String> {
    let best = cycle_gain.best_w?;
    let name = cycle(&cycle_gain.cycle);
    let percent = 100.0 * (best / cycle_gain.present_w - 1.0);
    let band = cycle_gain.band.map_or_else(String::new, |band| {
        let [low, _, high] = band.gain_w.map(short);
        format!("; gain {low} to {high} W under the uncertain inputs")
    });
    let label = format!("mean loss over {name}");
    let detail = format!("{} W at present{band}", short(cycle_gain.present_w));
    page.key_figure(&label, short(best), "W", detail);
    if cycle_gain.band.is_some_and(|band| band.contains_zero) {
        page.careful
            .push(format!("{name}: the gain is smaller than its uncertainty"));
    }
    Some(format!(
        "{} W over {name} instead of {} W ({percent:+.1} %)",
        short(best),
        short(cycle_gain.present_w)
    ))
}

/// A change with what it saves in the first cycle.
fn change(change: &ChangeOfDesign) -> Option<String> {
    let saved = change.share_w.as_ref().or(change.alone_w.as_ref())?.first()?;
    let words = format!("{} {} instead of {}", change.variable, change.to, change.from);
    Some(if *saved >= 0.0 {
        format!("{words} saves {} W", short(*saved))
    } else {
        format!("{words} costs {} W", short(-saved))
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
    if let Some(reason) = &outcome.first_failure {
        page.careful.push(format!(
            "{} designs could not be driven, the first: {reason}",
            outcome.failed
        ));
    }
}
