//! Operating points: a table of losses with measured values; losses as stacked bars.

mod summary;

use gearloss_studies::analyses::common::measurable::{is_measurable, note};
use gearloss_studies::analyses::operating_points::{OperatingPoint, OperatingPointsOutcome, PointsOfSet};
use gearloss_studies::numbers::RPM;

use crate::Figure;
use crate::page::Page;
use crate::plot::Bar;
use crate::register_view;
use crate::text::{TextTable, fixed, number, words_of_set};
use crate::unit;

register_view!(OperatingPointsOutcome, show);

fn show(outcome: &OperatingPointsOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for note in &outcome.file_notes {
        page.line(format!("{name}: {note}"));
    }
    let sets = &outcome.operating_points;
    let alike = |pair: &[PointsOfSet]| pair[0].shares == pair[1].shares;
    // Sets at one point are bars of one picture.
    let side_by_side = sets.len() > 1 && sets.iter().all(|set| set.points.len() == 1) && sets.windows(2).all(alike);
    for of_set in sets {
        let set = &of_set.model_set;
        page.line(format!("{name}: losses in W, models {set}"));
        page.table(losses(&outcome.bound, of_set));
        differences(&of_set.points, page);
        page.line("");
        let beside = if sets.len() > 1 {
            format!(" with {}", words_of_set(set))
        } else {
            String::new()
        };
        let figure = Figure::Bars {
            title: format!("{name}: losses{beside}; oil temperature beside each bar"),
            over: String::new(),
            height: "loss in W".to_owned(),
            names: of_set.shares.clone(),
            bars: of_set.points.iter().map(bar).collect(),
        };
        let file = format!("{name}-{set}");
        if side_by_side {
            page.file_figure(file, figure);
        } else {
            page.figure(file, figure);
        }
    }
    if side_by_side {
        let bars = sets.iter().map(|of_set| Bar {
            label: words_of_set(&of_set.model_set),
            ..bar(&of_set.points[0])
        });
        page.report_figure(Figure::Bars {
            title: format!("{name}: losses; oil temperature beside each bar"),
            over: String::new(),
            height: "loss in W".to_owned(),
            names: sets[0].shares.clone(),
            bars: bars.collect(),
        });
    }
}

/// Losses by share with measured values.
fn losses(bound: &[String], of_set: &PointsOfSet) -> TextTable {
    let (shares, points) = (&of_set.shares, &of_set.points);
    let has_unit = points.iter().any(|p| p.unit.is_some());
    let is_measured = points.iter().any(|p| !p.measured.is_empty());
    TextTable::of(points)
        .column("point", |p| &p.name)
        .each(bound, |table, column| {
            table.column(column, |p| p.bound.get(column).cloned().unwrap_or_default())
        })
        .column("torque Nm", |p| p.torque_nm.to_string())
        .column("speed rpm", |p| fixed(p.speed * RPM, 0))
        .column("oil degC", |p| match (p.oil_temperature_degc, p.balance) {
            (None, Some(outcome)) => outcome.name().to_owned(),
            (oil, _) => number(oil, 1),
        })
        .each(shares.iter().enumerate(), |table, (i, share)| {
            table.column(share, |p| number(p.losses_w.as_ref().map(|watts| watts[i]), 2))
        })
        .column("loss W", |p| number(p.loss_w, 2))
        .column("efficiency %", |p| number(p.efficiency.map(|e| 100.0 * e), 2))
        .each(unit::columns(has_unit), |table, (head, cell)| {
            table.column(head, |p| cell(p.unit.as_ref()))
        })
        .each(is_measured.then_some(()), |table, ()| {
            table
                .column("measured W", |p| number(p.measured.loss_w, 2))
                .column("measured oil degC", |p| number(p.measured.oil_temperature_degc, 1))
                .column("measured surface degC", |p| {
                    number(p.measured.surface_temperature_degc, 1)
                })
        })
        .finish()
}

/// Mean and maximum differences from measured values.
fn differences(points: &[OperatingPoint], page: &mut Page) {
    type Difference = (&'static str, fn(&OperatingPoint) -> Option<f64>);
    let all: [Difference; 3] = [
        ("loss minus measurement in %", |p| {
            let (loss, seen) = (p.loss_w?, p.measured.loss_w?);
            is_measurable(seen, loss).then(|| 100.0 * (loss / seen - 1.0))
        }),
        ("oil temperature minus measurement in K", |p| {
            Some(p.oil_temperature_degc? - p.measured.oil_temperature_degc?)
        }),
        ("surface temperature minus measurement in K", |p| {
            Some(p.surface_temperature_degc? - p.measured.surface_temperature_degc?)
        }),
    ];
    for (what, difference) in all {
        let gaps: Vec<f64> = points.iter().filter_map(difference).collect();
        if gaps.is_empty() {
            continue;
        }
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        let farther = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
        let worst = gaps.iter().fold(0.0, farther);
        page.line(format!("{what}: mean {mean:.2}, max {worst:.2}, {} points", gaps.len()));
    }
    let is_omitted = |p: &&OperatingPoint| {
        let both = p.loss_w.zip(p.measured.loss_w);
        both.is_some_and(|(loss, seen)| !is_measurable(seen, loss))
    };
    let omitted = points.iter().filter(is_omitted).count();
    if omitted > 0 {
        page.line(note(omitted, "the loss minus measurement"));
    }
}

fn bar(p: &OperatingPoint) -> Bar {
    let degrees = |t: Option<f64>| t.map_or_else(String::new, |t| format!("{t:.0} °C"));
    let mut label = format!("{}\n{} rpm\n{} Nm", p.name, fixed(p.speed * RPM, 0), p.torque_nm);
    for (_, value) in p.bound.iter() {
        label.push_str(&format!("\n{value}"));
    }
    let measured = &p.measured;
    let temperature = measured.oil_temperature_degc.or(measured.surface_temperature_degc);
    Bar {
        label,
        shares: p.losses_w.clone().unwrap_or_default(),
        above: degrees(p.oil_temperature_degc),
        measured: measured
            .loss_w
            .map(|loss| (loss, measured.loss_accuracy_w.unwrap_or(0.0))),
        above_measured: degrees(temperature),
    }
}
