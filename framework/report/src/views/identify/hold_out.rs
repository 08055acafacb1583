//! Held-out rows as text and figures: their errors compared with those of fitted rows.

use gearloss_numerics::inference::{ErrorSummary, PlacedError};
use gearloss_studies::analyses::identify::IdentificationOfSet;
use gearloss_studies::analyses::identify::hold_out::ErrorsOfQuantity;

use super::{slug, words};
use crate::Figure;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::text::{TextTable, figures, fixed};

fn short(x: f64) -> String {
    figures(x, 3)
}

pub(super) fn show(name: &str, o: &IdentificationOfSet, page: &mut Page) {
    let Some(held) = &o.hold_out else { return };
    for held in &held.quantities {
        let (what, unit) = words(held.errors.quantity);
        page.line(format!(
            "errors of the {what} in fitted and in held-out rows, in {unit}:"
        ));
        page.table(summaries(&held.errors));
        if held.regions.iter().any(|r| r.held_out.is_some()) {
            page.table(by_region(&held.errors));
        }
        if let Some(sentence) = &held.sentence {
            page.verdict(format!("{name}: {sentence}"));
        }
    }
    let widening = held.widening;
    let is_widened = o.found.intervals_widened().is_some();
    if is_widened && held.no_bands.is_none() {
        page.line(format!(
            "the bands are widened because the model does not fit the points: the uncertainty of the parameters is multiplied by {:.2}, the scatter of a measurement by {:.2}",
            widening.parameters, widening.scatter
        ));
    }
    if let Some(reason) = &held.no_bands {
        page.line(format!("no bands of the held-out rows: {reason}"));
    }
    if let Some(first) = held.not_predicted.first() {
        let count = held.not_predicted.len();
        page.line(format!("{count} held-out values are not predicted: {first}"));
    }
}

fn summaries(errors: &ErrorsOfQuantity) -> TextTable {
    let both = [("fitted", &errors.fitted), ("held out", &errors.held_out)];
    let all = |has: &dyn Fn(&ErrorSummary) -> bool| both.iter().all(|(_, summary)| summary.as_ref().is_none_or(has));
    let in_percent = errors.is_relative() && all(&|s| s.in_percent.is_some());
    let in_accuracies = all(&|s| s.in_accuracies.is_some());
    let mut head = vec!["rows".to_owned(), "points".to_owned()];
    head.extend(["rms", "bias", "max"].map(str::to_owned));
    head.extend(["line", "torque Nm", "speed rpm"].map(|what| format!("{what} of max")));
    let units = [(in_percent, "%"), (in_accuracies, "/ accuracy")];
    for (_, unit) in units.iter().filter(|(shown, _)| *shown) {
        head.extend(["rms", "bias", "max"].map(|figure| format!("{figure} {unit}")));
    }
    let mut table = TextTable::new(&head);
    for (kind, summary) in both {
        let Some(s) = summary else { continue };
        let at = s.greatest;
        let mut cells = vec![
            kind.to_owned(),
            s.count.to_string(),
            short(s.rms),
            short(s.mean),
            short(at.error),
        ];
        cells.extend([at.line.to_string(), short(at.torque), fixed(at.speed, 0)]);
        let further = [
            s.in_percent.filter(|_| in_percent),
            s.in_accuracies.filter(|_| in_accuracies),
        ];
        cells.extend(further.into_iter().flatten().flatten().map(short));
        table.row(cells);
    }
    table
}

fn by_region(errors: &ErrorsOfQuantity) -> TextTable {
    let mut table = TextTable::new(&["region", "held out", "rms", "bias", "fitted", "rms", "bias"]);
    for region in errors.regions.iter().filter(|r| r.held_out.is_some()) {
        let cells = |summary: &Option<ErrorSummary>| match summary {
            Some(s) => [s.count.to_string(), short(s.rms), short(s.mean)],
            None => ["0", "-", "-"].map(str::to_owned),
        };
        let mut row = vec![match region.over {
            "oil_temperature" => format!("oil {}", region.name),
            _ => region.name.clone(),
        }];
        row.extend(cells(&region.held_out));
        row.extend(cells(&region.fitted));
        table.row(row);
    }
    table
}

/// Errors of fitted and held-out rows over torque and over speed.
pub(super) fn pictures(name: &str, o: &IdentificationOfSet) -> Vec<(String, Figure)> {
    let Some(held) = &o.hold_out else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for record in &held.quantities {
        let errors = &record.errors;
        let (what, unit) = words(errors.quantity);
        let axes: [(&str, &str, fn(&PlacedError) -> f64); 2] =
            [("torque", "Nm", |e| e.torque), ("speed", "rpm", |e| e.speed)];
        for (axis, axis_unit, value) in axes {
            let dots = |held: bool| {
                let placed = errors.all.iter().filter(move |e| e.is_held_out == held);
                placed.map(|e| Some((value(e), e.error))).collect::<Vec<_>>()
            };
            let dotted = |name: &str, points: Vec<Option<(f64, f64)>>| Line {
                name: name.to_owned(),
                points,
                stroke: Stroke::Dots,
            };
            let figure = Figure::Lines {
                title: format!(
                    "{name}: errors of the {what} over {axis}, {}, fitted and held-out rows",
                    o.model_set
                ),
                x: format!("{axis} in {axis_unit}"),
                y: format!("calculated minus measured, {unit}"),
                lines: vec![dotted("fitted", dots(false)), dotted("held out", dots(true))],
            };
            all.push((format!("hold-out-{}-{axis}", slug(errors.quantity)), figure));
        }
    }
    all
}
