//! A breakdown of losses: a table and a figure of stacked bars for each row.

mod summary;

use gearloss_studies::analyses::breakdown::{Along, As, BreakdownOfSet, BreakdownOutcome, Common, PointOfBreakdown};

use crate::Figure;
use crate::page::Page;
use crate::plot::Bar;
use crate::register_view;
use crate::text::{TextTable, fixed, number, spread};
use crate::unit;

register_view!(BreakdownOutcome, show);

fn show(outcome: &BreakdownOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for note in &outcome.measured_notes {
        page.line(format!("{name}: measured: {note}"));
    }
    for of_set in &outcome.breakdowns {
        let mut points = &of_set.points[..];
        for row in &of_set.rows {
            let (first, others) = points.split_at(row.values.len());
            points = others;
            let shown = Row {
                name,
                of_set,
                unit: outcome.unit,
                title: title(&row.common),
                labels: row.values.iter().map(|value| label(row.along, *value)).collect(),
                along: row.along,
                points: first,
            };
            shown.figure(page);
            shown.table(page);
        }
        page.line("");
    }
}

/// A row of bars with its texts.
struct Row<'a> {
    name: &'a str,
    of_set: &'a BreakdownOfSet,
    unit: As,
    title: String,
    labels: Vec<String>,
    along: Along,
    points: &'a [PointOfBreakdown],
}

impl Row<'_> {
    fn figure(&self, page: &mut Page) {
        let (name, of_set) = (self.name, self.of_set);
        // Shares that are zero in all bars are omitted.
        let is_lost = |k: &usize| {
            self.points
                .iter()
                .filter_map(|p| p.losses.shares())
                .any(|s| s[*k] != 0.0)
        };
        let shown: Vec<usize> = (0..of_set.shares.len()).filter(is_lost).collect();
        let bars = self.labels.iter().zip(self.points);
        let figure = Figure::Bars {
            title: format!(
                "{name}: loss, gear {}, {}, models {}",
                of_set.gear, self.title, of_set.model_set
            ),
            over: axis_title(self.along).to_owned(),
            height: format!("loss in {}", self.unit.symbol()),
            names: shown.iter().map(|k| of_set.shares[*k].clone()).collect(),
            bars: bars
                .map(|(label, point)| Bar {
                    label: label.clone(),
                    shares: point
                        .losses
                        .shares()
                        .iter()
                        .flat_map(|s| shown.iter().map(|k| s[*k]))
                        .collect(),
                    measured: point.losses.measured().zip(point.accuracy),
                    ..Bar::default()
                })
                .collect(),
        };
        let title = self.title.replace([' ', ',', '`'], "");
        page.figure(format!("{name}-{}-{}-{title}", of_set.model_set, of_set.gear), figure);
    }

    fn table(&self, page: &mut Page) {
        let of_set = self.of_set;
        page.line(format!(
            "{}: loss in {}, gear {}, {}, models {}",
            self.name,
            self.unit.symbol(),
            of_set.gear,
            self.title,
            of_set.model_set
        ));
        let shown = spread(self.points.len());
        let mut titles = vec![axis_title(self.along)];
        titles.extend(shown.iter().map(|i| self.labels[*i].as_str()));
        let mut table = TextTable::new(&titles);
        let mut line = |title: &str, value: &dyn Fn(&PointOfBreakdown) -> Option<f64>| {
            let mut cells = vec![title.to_owned()];
            cells.extend(shown.iter().map(|i| number(value(&self.points[*i]), 2)));
            table.row(cells);
        };
        for (k, share) in of_set.shares.iter().enumerate() {
            line(share, &|point| Some(point.losses.shares()?[k]));
        }
        line("sum", &|point| Some(point.losses.shares()?.iter().sum()));
        if self.points.iter().any(|point| point.losses.measured().is_some()) {
            line("measured", &|point| point.losses.measured());
        }
        let has_unit = self.points.iter().any(|point| point.unit.is_some());
        for (title, cell) in unit::columns(has_unit) {
            let cells = shown.iter().map(|i| cell(self.points[*i].unit.as_ref()));
            table.row(std::iter::once((*title).to_owned()).chain(cells).collect());
        }
        page.table(table);
        page.line("");
    }
}

/// The common conditions of all bars of a row as text.
fn title(common: &Common) -> String {
    match common {
        Common::Torque(torque) => format!("{torque} Nm"),
        Common::Power(power) => format!("{power} W"),
        Common::Speed(speed) => format!("{} rpm", fixed(*speed, 0)),
        Common::Point(torque, speed) => format!("{torque} Nm, {} rpm", fixed(*speed, 0)),
        Common::NoLoad { turned, stationary } if stationary.is_empty() => format!("no load, `{turned}` driven"),
        Common::NoLoad { turned, stationary } => {
            format!("no load, `{turned}` driven, {} stationary", stationary.join(", "))
        }
    }
}

/// Name and unit of the quantity along the bars.
fn axis_title(along: Along) -> &'static str {
    match along {
        Along::Speed => "speed in rpm",
        Along::Torque => "torque in Nm",
        Along::Power => "power in W",
        Along::OilTemperature => "oil temperature in degC",
    }
}

/// Label below a bar.
fn label(along: Along, value: f64) -> String {
    match along {
        Along::Speed => fixed(value, 0),
        Along::Torque | Along::Power | Along::OilTemperature => format!("{value}"),
    }
}
