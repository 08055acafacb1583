//! The best design: its values, its changes, limits; progress of the search, and the front of several cycles.

mod summary;

use gearloss_studies::analyses::optimise::{ChangeOfDesign, DesignOfSearch, GainOfCycle, OptimiseOutcome};

use crate::Figure;
use crate::names::cycle;
use crate::page::Page;
use crate::plot::{Interval, Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, number, significant};

register_view!(OptimiseOutcome, show);

/// Designs of the front that are printed.
const PRINTED: usize = 12;

fn show(outcome: &OptimiseOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let minimised: Vec<&GainOfCycle> = outcome.gains.iter().filter(|gain| gain.minimised).collect();
    variables(outcome, page);
    losses(outcome, page);
    changes(outcome, &minimised, page);
    limits(outcome, page);
    front(outcome, &minimised, page);
    let figures = [
        saved(outcome, &minimised),
        compromises(outcome, &minimised),
        progress(outcome, &minimised),
    ];
    for (name, figure) in figures.into_iter().flatten() {
        page.figure(format!("{}-{name}", outcome.head.analysis), figure);
    }
}

fn variables(outcome: &OptimiseOutcome, page: &mut Page) {
    let way = if outcome.exhaustive {
        "every combination"
    } else {
        "searched"
    };
    page.line(format!(
        "{}: {} designs, {way}; {} keep all limits, {} could not be driven; models {}",
        outcome.head.analysis, outcome.designs, outcome.feasible, outcome.failed, outcome.model_set
    ));
    let mut table = TextTable::new(&["variable", "path", "present", "best"]);
    for variable in &outcome.variables {
        let end = if variable.at_end_of_range {
            " (end of range)"
        } else {
            ""
        };
        let best = variable
            .best
            .as_ref()
            .map_or_else(|| "-".to_owned(), |best| format!("{best}{end}"));
        table.row(vec![
            variable.variable.clone(),
            variable.path.clone(),
            variable.present.clone(),
            best,
        ]);
    }
    page.table(table);
}

fn losses(outcome: &OptimiseOutcome, page: &mut Page) {
    let mut table = TextTable::new(&[
        "cycle",
        "present W",
        "best W",
        "gain W",
        "least W of any design",
        "gain at 2.5 %",
        "at 97.5 %",
    ]);
    for gain in &outcome.gains {
        let band = gain.band.map(|band| band.gain_w);
        table.row(vec![
            gain.cycle.clone(),
            number(Some(gain.present_w), 2),
            number(gain.best_w, 2),
            number(gain.best_w.map(|best| gain.present_w - best), 2),
            number(gain.least_w, 2),
            number(band.map(|band| band[0]), 2),
            number(band.map(|band| band[2]), 2),
        ]);
    }
    page.table(table);
}

fn changes(outcome: &OptimiseOutcome, minimised: &[&GainOfCycle], page: &mut Page) {
    if outcome.changes.is_empty() {
        return;
    }
    let mut titles = vec!["change".to_owned(), "from".to_owned(), "to".to_owned()];
    for gain in minimised {
        titles.push(format!("{} alone W", gain.cycle));
        titles.push(format!("{} share W", gain.cycle));
    }
    let mut table = TextTable::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
    for change in &outcome.changes {
        let mut row = vec![change.variable.clone(), change.from.clone(), change.to.clone()];
        for i in 0..minimised.len() {
            let value = |list: &Option<Vec<f64>>| number(list.as_ref().map(|list| list[i]), 2);
            row.extend([value(&change.alone_w), value(&change.share_w)]);
        }
        table.row(row);
    }
    page.table(table);
    page.line("  alone: the gain of this change only; share: its share of the gain of all changes (Shapley value)");
}

fn limits(outcome: &OptimiseOutcome, page: &mut Page) {
    if outcome.limits.is_empty() {
        return;
    }
    let mut table = TextTable::new(&["limit", "quantity", "least", "most", "present", "best", "unit"]);
    for limit in &outcome.limits {
        let value = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), significant);
        let best = if limit.binding { "*" } else { "" };
        table.row(vec![
            limit.entry.limit.clone(),
            limit.entry.quantity.clone(),
            value(limit.entry.least),
            value(limit.entry.most),
            value(limit.entry.present),
            value(limit.best) + best,
            limit.entry.unit.clone(),
        ]);
    }
    page.table(table);
    if outcome.limits.iter().any(|limit| limit.binding) {
        page.line("  * at the limit");
    }
}

/// The designs of a front of several cycles.
fn front(outcome: &OptimiseOutcome, minimised: &[&GainOfCycle], page: &mut Page) {
    if minimised.len() < 2 {
        return;
    }
    let mut titles: Vec<&str> = minimised.iter().map(|gain| gain.cycle.as_str()).collect();
    titles.extend(outcome.variables.iter().map(|variable| variable.variable.as_str()));
    let mut table = TextTable::new(&titles).titled("Front: mean losses in W, and values");
    let step = outcome.front.len().div_ceil(PRINTED).max(1);
    for design in outcome.front.iter().step_by(step) {
        let losses = design.mean_losses_w.iter().flatten().map(|loss| number(Some(*loss), 2));
        table.row(losses.chain(design.values.iter().cloned()).collect());
    }
    page.table(table);
}

/// The gain of each change in the first cycle: its band, or its value.
fn saved(outcome: &OptimiseOutcome, minimised: &[&GainOfCycle]) -> Option<(&'static str, Figure)> {
    let of = cycle(&minimised.first()?.cycle);
    let interval = |change: &ChangeOfDesign| {
        Some(Interval {
            name: format!("{} {}", change.variable, change.to),
            at: change.alone_w.as_ref()?[0],
            ends: change.bands.first().map(|band| [band.gain_w[0], band.gain_w[2]]),
            before: change.share_w.as_ref().map(|share| share[0]),
        })
    };
    let list: Vec<Interval> = outcome.changes.iter().filter_map(interval).collect();
    let figure = Figure::Intervals {
        title: format!("{}: gain of each change alone over {of}", outcome.head.analysis),
        x: "gain in W".to_owned(),
        marks: vec![0.0],
        key: ["gain of the change alone", "its share of the gain of all", "no gain"].map(str::to_owned),
        list: list.clone(),
    };
    (!list.is_empty()).then_some(("changes", figure))
}

/// Losses of two cycles: all designs that keep the limits, and the front.
fn compromises(outcome: &OptimiseOutcome, minimised: &[&GainOfCycle]) -> Option<(&'static str, Figure)> {
    let [first, second, ..] = minimised else { return None };
    let point = |design: &DesignOfSearch| design.mean_losses_w.as_ref().map(|all| (all[0], all[1]));
    let kept = outcome.all.iter().filter(|design| design.violation == Some(0.0));
    let line = |name: &str, points: Vec<Option<(f64, f64)>>, stroke| Line {
        name: name.to_owned(),
        points,
        stroke,
    };
    let figure = Figure::Lines {
        title: format!("{}: front of both cycles", outcome.head.analysis),
        x: format!("mean loss over {} in W", cycle(&first.cycle)),
        y: format!("mean loss over {} in W", cycle(&second.cycle)),
        lines: vec![
            line("designs that keep the limits", kept.map(point).collect(), Stroke::Dots),
            line("front", outcome.front.iter().map(point).collect(), Stroke::Marked),
            line("present", vec![Some((first.present_w, second.present_w))], Stroke::Dots),
        ],
    };
    Some(("front", figure))
}

/// The least loss of the first cycle among the designs so far.
fn progress(outcome: &OptimiseOutcome, minimised: &[&GainOfCycle]) -> Option<(&'static str, Figure)> {
    let of = cycle(&minimised.first()?.cycle);
    let mut least = f64::INFINITY;
    let best = |design: &DesignOfSearch| {
        let loss = design.mean_losses_w.as_ref()?[0];
        if design.violation == Some(0.0) {
            least = least.min(loss);
        }
        least.is_finite().then_some((design.design as f64, least))
    };
    let points: Vec<Option<(f64, f64)>> = outcome.all.iter().map(best).collect();
    let figure = Figure::Lines {
        title: format!(
            "{}: least mean loss over {of} among the designs so far",
            outcome.head.analysis
        ),
        x: "designs".to_owned(),
        y: "mean loss in W".to_owned(),
        lines: vec![Line {
            name: "least loss".to_owned(),
            points: points.clone(),
            stroke: Stroke::Line,
        }],
    };
    points.iter().any(Option::is_some).then_some(("progress", figure))
}
