//! The best design: its values, its changes, limits; progress of the search, and the front of several cycles.

mod summary;

use gearloss_studies::analyses::optimise::{
    ChangeOfDesign, DesignOfSearch, Minimised, ObjectiveOfSearch, OptimiseOutcome,
};
use gearloss_studies::duty::Consumption;

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
    variables(outcome, page);
    losses(outcome, page);
    consumptions(outcome, page);
    changes(outcome, page);
    limits(outcome, page);
    front(outcome, page);
    let figures = [saved(outcome), compromises(outcome), progress(outcome)];
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
    let table = TextTable::of(&outcome.variables)
        .column("variable", |variable| &variable.variable)
        .column("path", |variable| &variable.path)
        .column("present", |variable| &variable.present)
        .column("best", |variable| match &variable.best {
            Some(best) if variable.at_end_of_range => format!("{best} (end of range)"),
            Some(best) => best.clone(),
            None => "-".to_owned(),
        });
    page.table(table.finish());
}

fn losses(outcome: &OptimiseOutcome, page: &mut Page) {
    let table = TextTable::of(&outcome.gains)
        .column("cycle", |gain| &gain.cycle)
        .column("present W", |gain| number(Some(gain.present_w), 2))
        .column("best W", |gain| number(gain.best_w, 2))
        .column("gain W", |gain| {
            number(gain.best_w.map(|best| gain.present_w - best), 2)
        })
        .column("least W of any design", |gain| number(gain.least_w, 2))
        .column("gain at 2.5 %", |gain| number(gain.band.map(|band| band.gain()[0]), 2))
        .column("at 97.5 %", |gain| number(gain.band.map(|band| band.gain()[2]), 2));
    page.table(table.finish());
}

/// Where the energy of the vehicle goes, present and best.
fn consumptions(outcome: &OptimiseOutcome, page: &mut Page) {
    let mut rows: Vec<(&str, &str, &Consumption, Option<[f64; 3]>)> = Vec::new();
    for gain in &outcome.gains {
        let Some(consumption) = &gain.consumption else { continue };
        let objective = outcome
            .objectives
            .iter()
            .find(|objective| objective.cycle == gain.cycle && objective.quantity == Minimised::Consumption);
        let band = objective.and_then(|objective| objective.band).map(|band| band.gain());
        rows.push((&gain.cycle, "present", &consumption.present, None));
        rows.extend(
            consumption
                .best
                .iter()
                .map(|best| (gain.cycle.as_str(), "best", best, band)),
        );
    }
    if !rows.is_empty() {
        let table = TextTable::of(rows)
            .column("cycle", |(cycle, ..)| *cycle)
            .column("design", |(_, design, ..)| *design)
            .column("consumption kWh/100 km", |(.., of, _)| {
                number(Some(of.consumption_kwh_per_100_km), 4)
            })
            .column("range km", |(.., of, _)| number(of.range_km, 1))
            .column("transmission", |(.., of, _)| {
                number(Some(of.transmission_kwh_per_100_km), 4)
            })
            .column("machine", |(.., of, _)| number(Some(of.machine_kwh_per_100_km), 4))
            .column("brakes", |(.., of, _)| number(Some(of.brakes_kwh_per_100_km), 4))
            .column("battery", |(.., of, _)| number(Some(of.battery_kwh_per_100_km), 4))
            .column("gain at 2.5 %", |(.., band)| number(band.map(|band| band[0]), 4))
            .column("at 97.5 %", |(.., band)| number(band.map(|band| band[2]), 4));
        page.table(table.finish().titled("Energy of the vehicle in kWh/100 km"));
    }
    for disagreement in &outcome.disagreements {
        page.line(format!("  {}", summary::disagreement(outcome, disagreement)));
    }
}

/// Decimals of an objective in tables.
fn digits(objective: &ObjectiveOfSearch) -> usize {
    match objective.quantity {
        Minimised::MeanLoss => 2,
        Minimised::Consumption => 4,
    }
}

fn changes(outcome: &OptimiseOutcome, page: &mut Page) {
    if outcome.changes.is_empty() {
        return;
    }
    let mut titles = vec!["change".to_owned(), "from".to_owned(), "to".to_owned()];
    for objective in &outcome.objectives {
        titles.push(format!("{} alone {}", objective.cycle, objective.unit));
        titles.push(format!("{} share {}", objective.cycle, objective.unit));
    }
    let mut table = TextTable::new(&titles);
    for change in &outcome.changes {
        let mut row = vec![change.variable.clone(), change.from.clone(), change.to.clone()];
        for (i, objective) in outcome.objectives.iter().enumerate() {
            let value = |list: &Option<Vec<f64>>| number(list.as_ref().map(|list| list[i]), digits(objective));
            row.extend([value(&change.alone), value(&change.share)]);
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
    let value = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), significant);
    let table = TextTable::of(&outcome.limits)
        .column("limit", |limit| &limit.entry.limit)
        .column("quantity", |limit| &limit.entry.quantity)
        .column("least", |limit| value(limit.entry.least))
        .column("most", |limit| value(limit.entry.most))
        .column("present", |limit| value(limit.entry.present))
        .column("best", |limit| value(limit.best) + if limit.binding { "*" } else { "" })
        .column("unit", |limit| &limit.entry.unit);
    page.table(table.finish());
    if outcome.limits.iter().any(|limit| limit.binding) {
        page.line("  * at the limit");
    }
}

/// The designs of a front of several objectives.
fn front(outcome: &OptimiseOutcome, page: &mut Page) {
    if outcome.objectives.len() < 2 {
        return;
    }
    let mut titles: Vec<String> = outcome
        .objectives
        .iter()
        .map(|objective| title(outcome, objective))
        .collect();
    titles.extend(outcome.variables.iter().map(|variable| variable.variable.clone()));
    let heading = if of_losses(outcome) {
        "Front: mean losses in W, and values"
    } else {
        "Front: objectives, and values"
    };
    let mut table = TextTable::new(&titles).titled(heading);
    let step = outcome.front.len().div_ceil(PRINTED).max(1);
    for design in outcome.front.iter().step_by(step) {
        let values = design.objectives.iter().flatten().zip(&outcome.objectives);
        let values = values.map(|(value, objective)| number(Some(*value), digits(objective)));
        table.row(values.chain(design.values.iter().cloned()).collect());
    }
    page.table(table);
}

/// Whether all objectives are losses.
fn of_losses(outcome: &OptimiseOutcome) -> bool {
    let mut objectives = outcome.objectives.iter();
    objectives.all(|objective| objective.quantity == Minimised::MeanLoss)
}

/// An objective as the title of a column.
fn title(outcome: &OptimiseOutcome, objective: &ObjectiveOfSearch) -> String {
    if of_losses(outcome) {
        objective.cycle.clone()
    } else {
        format!("{} {} {}", objective.cycle, objective.quantity.words(), objective.unit)
    }
}

/// An objective as the title of an axis.
fn axis(objective: &ObjectiveOfSearch) -> String {
    format!(
        "{} over {} in {}",
        objective.quantity.words(),
        cycle(&objective.cycle),
        objective.unit
    )
}

/// The gain of each change in the first objective: its band, or its value.
fn saved(outcome: &OptimiseOutcome) -> Option<(&'static str, Figure)> {
    let objective = outcome.objectives.first()?;
    let of = cycle(&objective.cycle);
    let interval = |change: &ChangeOfDesign| {
        Some(Interval {
            name: format!("{} {}", change.variable, change.to),
            at: change.alone.as_ref()?[0],
            ends: change.bands.first().map(|band| [band.gain()[0], band.gain()[2]]),
            before: change.share.as_ref().map(|share| share[0]),
        })
    };
    let list: Vec<Interval> = outcome.changes.iter().filter_map(interval).collect();
    let figure = Figure::Intervals {
        title: format!("{}: gain of each change alone over {of}", outcome.head.analysis),
        x: format!("gain in {}", objective.unit),
        marks: vec![0.0],
        key: ["gain of the change alone", "its share of the gain of all", "no gain"].map(str::to_owned),
        list: list.clone(),
    };
    (!list.is_empty()).then_some(("changes", figure))
}

/// Two objectives: all designs that keep the limits, and the front.
fn compromises(outcome: &OptimiseOutcome) -> Option<(&'static str, Figure)> {
    let [first, second, ..] = &outcome.objectives[..] else {
        return None;
    };
    let point = |design: &DesignOfSearch| design.objectives.as_ref().map(|all| (all[0], all[1]));
    let kept = outcome.all.iter().filter(|design| design.violation == Some(0.0));
    let line = |name: &str, points: Vec<Option<(f64, f64)>>, stroke| Line {
        name: name.to_owned(),
        points,
        stroke,
    };
    let is_of_cycles = of_losses(outcome);
    let figure = Figure::Lines {
        title: format!(
            "{}: front of both {}",
            outcome.head.analysis,
            if is_of_cycles { "cycles" } else { "objectives" }
        ),
        x: axis(first),
        y: axis(second),
        lines: vec![
            line("designs that keep the limits", kept.map(point).collect(), Stroke::Dots),
            line("front", outcome.front.iter().map(point).collect(), Stroke::Marked),
            line("present", vec![Some((first.present, second.present))], Stroke::Dots),
        ],
    };
    Some(("front", figure))
}

/// The least value of the first objective among the designs so far.
fn progress(outcome: &OptimiseOutcome) -> Option<(&'static str, Figure)> {
    let objective = outcome.objectives.first()?;
    let of = cycle(&objective.cycle);
    let quantity = objective.quantity.words();
    let mut least = f64::INFINITY;
    let best = |design: &DesignOfSearch| {
        let value = design.objectives.as_ref()?[0];
        if design.violation == Some(0.0) {
            least = least.min(value);
        }
        least.is_finite().then_some((design.design as f64, least))
    };
    let points: Vec<Option<(f64, f64)>> = outcome.all.iter().map(best).collect();
    let figure = Figure::Lines {
        title: format!(
            "{}: least {quantity} over {of} among the designs so far",
            outcome.head.analysis
        ),
        x: "designs".to_owned(),
        y: format!("{quantity} in {}", objective.unit),
        lines: vec![Line {
            name: match objective.quantity {
                Minimised::MeanLoss => "least loss".to_owned(),
                Minimised::Consumption => "least consumption".to_owned(),
            },
            points: points.clone(),
            stroke: Stroke::Line,
        }],
    };
    points.iter().any(Option::is_some).then_some(("progress", figure))
}
