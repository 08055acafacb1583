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
        let band = gain.band.map(|band| band.gain());
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

/// Where the energy of the vehicle goes, present and best.
fn consumptions(outcome: &OptimiseOutcome, page: &mut Page) {
    let mut table = TextTable::new(&[
        "cycle",
        "design",
        "consumption kWh/100 km",
        "range km",
        "transmission",
        "machine",
        "brakes",
        "battery",
        "gain at 2.5 %",
        "at 97.5 %",
    ]);
    let mut any = false;
    for gain in &outcome.gains {
        let Some(consumption) = &gain.consumption else { continue };
        any = true;
        let objective = outcome
            .objectives
            .iter()
            .find(|objective| objective.cycle == gain.cycle && objective.quantity == Minimised::Consumption);
        let band = objective.and_then(|objective| objective.band).map(|band| band.gain());
        let mut row = |design: &str, of: &Consumption, band: Option<[f64; 3]>| {
            table.row(vec![
                gain.cycle.clone(),
                design.to_owned(),
                number(Some(of.consumption_kwh_per_100_km), 4),
                number(of.range_km, 1),
                number(Some(of.transmission_kwh_per_100_km), 4),
                number(Some(of.machine_kwh_per_100_km), 4),
                number(Some(of.brakes_kwh_per_100_km), 4),
                number(Some(of.battery_kwh_per_100_km), 4),
                number(band.map(|band| band[0]), 4),
                number(band.map(|band| band[2]), 4),
            ]);
        };
        row("present", &consumption.present, None);
        if let Some(best) = &consumption.best {
            row("best", best, band);
        }
    }
    if any {
        page.table(table.titled("Energy of the vehicle in kWh/100 km"));
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
    let mut table = TextTable::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
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
    let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
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
