//! Models against a measurement: ratios of calculated to measured losses by model and regime, one small picture for each model.

mod summary;

use gearloss_studies::analyses::validation::{
    Cell, CellOfRegime, FittedFactor, ValidatedModel, Validation, ValidationOutcome,
};

use crate::Figure;
use crate::names::share;
use crate::page::Page;
use crate::picture::{Pane, Panes, Screen};
use crate::plot::{Interval, Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, number, short};

register_view!(ValidationOutcome, show);

fn show(outcome: &ValidationOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let (name, found) = (&outcome.head.analysis, &outcome.validation);
    for note in &found.notes_on_file {
        page.line(format!("{name}: {note}"));
    }
    page.line(format!(
        "{name}: calculated over measured loss of {} at {} points of {}",
        found.mechanism, found.points, found.file
    ));
    page.table(TextTable::filled(&CELLS, found.models.iter().map(cells).collect()));
    let far = found.models.iter().filter(|model| !is_near(model)).count();
    if far > 0 {
        let models = if far == 1 { "model is" } else { "models are" };
        page.line(format!(
            "{far} {models} wrong by more than a factor of {FARTHEST} and left out of the common pictures"
        ));
    }
    if let Some((head, rows)) = fitted(found) {
        page.table(TextTable::filled(&head, rows));
    }
    for line in &found.left_out {
        page.line(format!("not judged: {line}"));
    }
    page.line("");
    for (over, unit) in coordinates(found) {
        page.line(format!("{name}: ratio by {}", over.replace('_', " ")));
        let (head, rows) = by_regime(found, over, unit);
        page.table(TextTable::filled(&head, rows));
        page.line("");
    }
    page.figure(format!("{name}-ratios"), ratios(name, found));
    if let Some((x, values)) = &found.over {
        page.screen(Screen::Panes(small_multiples(name, found, (x, values))));
        page.file_figure(format!("{name}-regimes"), lines(name, found, (x, values)));
    }
}

/// A ratio with two decimals; one of more than ten or less than a hundredth with three digits.
pub fn ratio_text(ratio: f64) -> String {
    if (0.01..10.0).contains(&ratio) {
        number(Some(ratio), 2)
    } else {
        short(ratio)
    }
}

/// A percentage without decimals; a large one with three digits.
fn percent_text(percent: f64) -> String {
    if percent.abs() < 1000.0 {
        number(Some(percent), 0)
    } else {
        short(percent)
    }
}

/// Names of the columns of [`cells`].
pub const CELLS: [&str; 10] = [
    "model", "points", "ratio", "least", "greatest", "bias %", "rms %", "max %", "in band", "in range",
];

/// A model at all points, as a row.
pub fn cells(model: &ValidatedModel) -> Vec<String> {
    let Cell {
        points,
        ratio,
        least,
        greatest,
        bias_percent,
        rms_percent,
        max_percent,
        in_band,
        in_range,
        ..
    } = model.all;
    vec![
        model.name.clone(),
        points.to_string(),
        ratio_text(ratio),
        ratio_text(least),
        ratio_text(greatest),
        percent_text(bias_percent),
        percent_text(rms_percent),
        percent_text(max_percent),
        number(in_band, 2),
        number(Some(in_range), 2),
    ]
}

/// The models with one fitted factor, the best prediction first: names of the columns, and a row for each model. Absent if none is fitted.
pub fn fitted(found: &Validation) -> Option<(Vec<String>, Vec<Vec<String>>)> {
    let mut all: Vec<(&str, &FittedFactor)> = found
        .models
        .iter()
        .filter_map(|model| Some((model.name.as_str(), model.fitted.as_ref()?)))
        .collect();
    all.sort_by(|a, b| a.1.predicted.rms_percent.total_cmp(&b.1.predicted.rms_percent));
    let over = &all.first()?.1.left_out;
    let head = [
        format!("one factor, each {} left out", over.replace('_', " ")),
        "factor".to_owned(),
        "least".to_owned(),
        "greatest".to_owned(),
        "rms %".to_owned(),
    ];
    let row = |(name, fitted): &(&str, &FittedFactor)| {
        let Cell {
            least,
            greatest,
            rms_percent,
            ..
        } = fitted.predicted;
        vec![
            (*name).to_owned(),
            ratio_text(fitted.factor),
            ratio_text(least),
            ratio_text(greatest),
            percent_text(rms_percent),
        ]
    };
    Some((head.to_vec(), all.iter().map(row).collect()))
}

/// The coordinates of regimes with their units.
pub fn coordinates(found: &Validation) -> Vec<(&str, &str)> {
    let mut all: Vec<(&str, &str)> = Vec::new();
    for regime in found.models.iter().flat_map(|model| &model.regimes) {
        let coordinate = (regime.over.as_str(), regime.unit.as_str());
        if !all.contains(&coordinate) {
            all.push(coordinate);
        }
    }
    all
}

/// The ratio of each model in each regime of a coordinate: names of the columns, and a row for each model.
pub fn by_regime(found: &Validation, over: &str, unit: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let of = |model: &ValidatedModel| -> Vec<CellOfRegime> {
        let regimes = model.regimes.iter().filter(|regime| regime.over == over);
        regimes.cloned().collect()
    };
    let ends = |regime: &CellOfRegime| {
        let [from, to] = [regime.from, regime.to].map(short);
        // Measured speeds scatter about their setpoints.
        let ends = if from == to { from } else { format!("{from} to {to}") };
        if unit.is_empty() {
            ends
        } else {
            format!("{ends} {unit}")
        }
    };
    let first = found.models.first().map(of).unwrap_or_default();
    let head = std::iter::once("model".to_owned()).chain(first.iter().map(ends));
    let row = |model: &ValidatedModel| {
        let ratios = of(model).into_iter().map(|regime| ratio_text(regime.cell.ratio));
        std::iter::once(model.name.clone()).chain(ratios).collect()
    };
    (head.collect(), found.models.iter().map(row).collect())
}

/// Factor beyond which a model is not drawn, because it would hide the others.
const FARTHEST: f64 = 10.0;

/// Whether the ratio of a model can be drawn beside those of others.
fn is_near(model: &ValidatedModel) -> bool {
    model.all.ratio < FARTHEST && model.all.ratio > 1.0 / FARTHEST
}

/// The ratio of each model with the least and the greatest.
fn ratios(name: &str, found: &Validation) -> Figure {
    let interval = |model: &ValidatedModel| Interval {
        name: model.name.clone(),
        at: model.all.ratio,
        ends: Some([model.all.least, model.all.greatest]),
        before: None,
    };
    Figure::Intervals {
        title: format!("{name}: calculated over measured loss of {}", share(&found.mechanism)),
        x: "ratio".to_owned(),
        marks: vec![1.0],
        key: [
            "geometric mean, least and greatest".to_owned(),
            String::new(),
            "measurement".to_owned(),
        ],
        list: found
            .models
            .iter()
            .filter(|model| is_near(model))
            .map(interval)
            .collect(),
    }
}

/// Points in ascending order of the coordinate.
fn ordered(values: &[f64], y: impl Fn(usize) -> Option<f64>) -> Vec<Option<(f64, f64)>> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    order.into_iter().map(|i| Some((values[i], y(i)?))).collect()
}

/// The line of the measurement.
fn measured(values: &[f64]) -> Line {
    Line {
        name: "measurement".to_owned(),
        points: ordered(values, |_| Some(1.0)),
        stroke: Stroke::Line,
    }
}

/// One pane for each model: its ratios, their bands, and the measurement.
fn small_multiples(name: &str, found: &Validation, (x, values): (&str, &[f64])) -> Panes {
    let pane = |model: &ValidatedModel| {
        let end = |name: &str, k: usize| Line {
            name: name.to_owned(),
            points: ordered(values, |i| Some(model.at[i].band?[k])),
            stroke: Stroke::Dots,
        };
        let mut lines = vec![Line {
            name: model.name.clone(),
            points: ordered(values, |i| Some(model.at[i].ratio)),
            stroke: Stroke::Dots,
        }];
        if model.at.iter().any(|point| point.band.is_some()) {
            lines.push(end("lower end of its band", 0));
            lines.push(end("upper end of its band", 1));
        }
        lines.push(measured(values));
        Pane {
            y: model.name.clone(),
            lines,
        }
    };
    Panes {
        title: format!("{name}: calculated over measured loss, model by model"),
        x: x.to_owned(),
        panes: found.models.iter().map(pane).collect(),
    }
}

/// All models in one figure for the files.
fn lines(name: &str, found: &Validation, (x, values): (&str, &[f64])) -> Figure {
    let line = |model: &ValidatedModel| Line {
        name: model.name.clone(),
        points: ordered(values, |i| Some(model.at[i].ratio)),
        stroke: Stroke::Dots,
    };
    let models = found.models.iter().filter(|model| is_near(model)).map(line);
    Figure::Lines {
        title: format!("{name}: calculated over measured loss"),
        x: x.to_owned(),
        y: "ratio".to_owned(),
        lines: models.chain([measured(values)]).collect(),
    }
}
