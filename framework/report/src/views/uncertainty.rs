//! Uncertainty bands: correlations with the inputs, width of the bands over the grid, and the bands over speed.

mod summary;

use gearloss_studies::analyses::uncertainty::{BandsOfSet, PointOfBand, QuantityBand, UncertaintyOutcome};
use gearloss_studies::numbers::tidy;

use crate::figure::jumps;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, number, spread};
use crate::{Figure, Map};

register_view!(UncertaintyOutcome, show);

/// A quantity: name in files, name, unit, reader.
type Quantity = (
    &'static str,
    &'static str,
    &'static str,
    fn(&PointOfBand) -> QuantityBand,
);

const QUANTITIES: [Quantity; 7] = [
    ("efficiency", "efficiency", "%", |p| p.efficiency_percent),
    ("loss_w", "loss", "W", |p| p.loss_w),
    ("loss_torque_nm", "loss torque", "Nm", |p| p.loss_torque_nm),
    ("oil_temperature_degc", "oil temperature", "degC", |p| {
        p.oil_temperature_degc
    }),
    ("dc_power_w", "power of the DC link", "W", |p| {
        p.dc_power_w.unwrap_or_default()
    }),
    ("unit_loss_w", "loss of the drive unit", "W", |p| {
        p.unit_loss_w.unwrap_or_default()
    }),
    ("system_efficiency", "efficiency of the drive unit", "%", |p| {
        p.system_percent
    }),
];

fn show(outcome: &UncertaintyOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for set in &outcome.bands {
        inputs(name, set, page);
        widths(set, page);
        page.published(&set.published);
        for quantity in &QUANTITIES {
            figures(name, set, quantity, page);
        }
    }
}

fn inputs(name: &str, set: &BandsOfSet, page: &mut Page) {
    page.line(format!("{name}: {} samples, models {}", set.samples, set.model_set));
    if let Some(reason) = &set.first_failure {
        page.line(format!("{} further samples have no value: {reason}", set.failed));
    }
    let table = TextTable::of(&set.inputs)
        .column("input", |input| &input.path)
        .column("from", |input| &input.words[0])
        .column("to", |input| &input.words[1])
        .column("correlation with the mean loss", |input| {
            number(input.correlation_with_mean_loss, 3)
        });
    page.table(table.finish());
    page.line("");
}

/// Half the width of the band of the efficiency over the grid.
fn widths(set: &BandsOfSet, page: &mut Page) {
    page.line("half the width of the 95 % band of the efficiency in percentage points");
    let columns = set.speeds_rpm.len();
    let width = |t: usize, s: usize| number(set.points[t * columns + s].efficiency_percent.half_width(), 3);
    page.table(TextTable::over_grid(&set.torques_nm, &set.speeds_rpm, width));
    page.line("");
}

/// A map of the width of the bands of a quantity, and the bands themselves over speed at a few torques.
fn figures(name: &str, set: &BandsOfSet, (short, quantity, unit, read): &Quantity, page: &mut Page) {
    let columns = set.speeds_rpm.len();
    let models = &set.model_set;
    let long = format!("{quantity} in {unit}");
    let widths: Vec<Option<f64>> = set.points.iter().map(|p| read(p).half_width()).collect();
    // A given temperature has no band.
    if widths.iter().all(|width| width.is_none_or(|w| w == 0.0)) {
        return;
    }
    if columns > 1 && set.torques_nm.len() > 1 {
        let words = |values: &[f64]| values.iter().map(|x| format!("{}", tidy(*x))).collect();
        let figure = Figure::Map(Map {
            title: format!("{name}: half width of the 95 % band of the {long}, models {models}"),
            x: ("speed rpm".to_owned(), words(&set.speeds_rpm)),
            y: ("torque Nm".to_owned(), words(&set.torques_nm)),
            values: widths,
            unit: (*unit).to_owned(),
            jumps: jumps(quantity),
            ..Map::default()
        });
        page.figure(format!("{name}-{models}-{short}-width"), figure);
    }
    for t in spread(set.torques_nm.len()).into_iter().step_by(3) {
        let line = |words: &str, stroke: Stroke, y: &dyn Fn(&QuantityBand) -> Option<f64>| Line {
            name: words.to_owned(),
            points: (0..columns)
                .map(|i| Some((set.speeds_rpm[i], y(&read(&set.points[t * columns + i]))?)))
                .collect(),
            stroke,
        };
        let torque = tidy(set.torques_nm[t]);
        let figure = Figure::Lines {
            title: format!("{name}: {long} with its 95 % band, {torque} Nm, models {models}"),
            x: "speed in rpm".to_owned(),
            y: long.clone(),
            lines: vec![
                line("nominal", Stroke::Marked, &|q| q.nominal),
                line("median", Stroke::Line, &|q| q.band.map(|b| b[1])),
                line("2.5 %", Stroke::Line, &|q| q.band.map(|b| b[0])),
                line("97.5 %", Stroke::Line, &|q| q.band.map(|b| b[2])),
            ],
        };
        page.figure(format!("{name}-{models}-{short}-{torque}Nm"), figure);
    }
}
