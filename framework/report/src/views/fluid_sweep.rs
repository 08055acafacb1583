//! Mean losses over one property of an oil: a table; figures, absolute and relative to the minimum of each cycle.

mod summary;

use gearloss_studies::analyses::fluid_sweep::{FluidSweepOutcome, FluidsOfDuty, FluidsOfSet, LossOfFluid};
use gearloss_studies::limits::LimitRecord;

use crate::Figure;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, number, short, significant};

register_view!(FluidSweepOutcome, show);

fn show(outcome: &FluidSweepOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for set in &outcome.fluid_sweep {
        text(name, set, page);
    }
    for (file, y, relative) in [
        ("loss", "mean loss in W", false),
        ("relative", "mean loss in % of the minimum", true),
    ] {
        let figure = Figure::Lines {
            title: format!("{name}: {y}"),
            x: outcome
                .fluid_sweep
                .first()
                .map_or_else(String::new, |set| set.property.clone()),
            y: y.to_owned(),
            lines: lines(&outcome.fluid_sweep, relative),
        };
        page.figure(format!("{name}-{file}"), figure);
    }
    let consumptions = consumptions(&outcome.fluid_sweep);
    if !consumptions.is_empty() {
        let figure = Figure::Lines {
            title: format!("{name}: consumption of the vehicle in kWh/100 km"),
            x: outcome
                .fluid_sweep
                .first()
                .map_or_else(String::new, |set| set.property.clone()),
            y: "consumption in kWh/100 km".to_owned(),
            lines: consumptions,
        };
        page.figure(format!("{name}-consumption"), figure);
    }
    for set in &outcome.fluid_sweep {
        for (i, limit) in set.limits.iter().enumerate() {
            let figure = limited(name, set, i, limit);
            page.figure(
                format!("{name}-{}-{}", set.model_set.replace('/', "-"), limit.limit),
                figure,
            );
        }
    }
}

/// A limited quantity over the property, with its bounds.
fn limited(name: &str, set: &FluidsOfSet, i: usize, limit: &LimitRecord) -> Figure {
    let fluids = set.cycles.first().map_or(&[][..], |duty| &duty.fluids);
    let value = |fluid: &LossOfFluid| fluid.limited[i].map(|value| (fluid.value, value));
    let line = |name: &str, points, stroke| Line {
        name: name.to_owned(),
        points,
        stroke,
    };
    let mut lines = vec![line(
        &limit.quantity,
        fluids.iter().map(value).collect(),
        Stroke::Marked,
    )];
    for (side, bound) in [("least", limit.least), ("most", limit.most)] {
        if let Some(bound) = bound {
            let ends = fluids.iter().map(|fluid| Some((fluid.value, bound)));
            lines.push(line(
                &format!("{side}, `{}`", limit.limit),
                ends.collect(),
                Stroke::Line,
            ));
        }
    }
    Figure::Lines {
        title: format!("{name}: {} over the oils", limit.quantity),
        x: set.property.clone(),
        y: format!("{} in {}", limit.quantity, limit.unit),
        lines,
    }
}

fn text(name: &str, set: &FluidsOfSet, page: &mut Page) {
    page.line(format!(
        "{name}: mean loss in W over {}, models {}",
        set.property, set.model_set
    ));
    let all: Vec<&LossOfFluid> = set.cycles.first().into_iter().flat_map(listed).collect();
    let mut titles = vec!["cycle".to_owned()];
    titles.extend(all.iter().map(|fluid| {
        let mark = if fluid.beyond_definition { "*" } else { "" };
        format!("{}{mark}", significant(fluid.value))
    }));
    let mut table = TextTable::new(&titles);
    for duty in &set.cycles {
        let mut row = vec![duty.cycle.clone()];
        row.extend(listed(duty).map(|fluid| format!("{:.2}", fluid.mean_loss_w)));
        table.row(row);
    }
    for duty in set.cycles.iter().filter(|duty| duty.least_consumption.is_some()) {
        let mut row = vec![format!("{}, consumption [kWh/100 km]", duty.cycle)];
        let used = |fluid: &LossOfFluid| fluid.consumption.map(|used| used.consumption_kwh_per_100_km);
        row.extend(listed(duty).map(|fluid| number(used(fluid), 3)));
        table.row(row);
    }
    for (i, limit) in set.limits.iter().enumerate() {
        let mut row = vec![format!("{} [{}]", limit.quantity, limit.unit)];
        row.extend(
            all.iter()
                .map(|fluid| fluid.limited[i].map_or_else(|| "-".to_owned(), significant)),
        );
        table.row(row);
    }
    page.table(table);
    if all.iter().any(|fluid| fluid.beyond_definition) {
        page.line(
            "  * below 2 mm2/s the viscosity index is not defined; its law for 2 mm2/s and above is extrapolated",
        );
    }
    for FluidsOfDuty {
        cycle,
        least,
        least_consumption,
        present,
        ..
    } in &set.cycles
    {
        let end = if least.at_end_of_range {
            ", at the end of the range"
        } else {
            ""
        };
        let now = present.value.map_or_else(|| "the present oil".to_owned(), significant);
        page.line(format!(
            "  {cycle}: minimum {:.2} W at {}{end}; within 1 % from {} to {}; {:.2} W at present with {now}",
            least.mean_loss_w,
            significant(least.value),
            significant(least.flat_range[0]),
            significant(least.flat_range[1]),
            present.mean_loss_w
        ));
        if let (Some(used), Some(now)) = (least_consumption, present.consumption) {
            let range = used.range_km.map(|km| format!(" and a range of {} km", short(km)));
            page.line(format!(
                "  {cycle}: least consumption of these oils {:.3} kWh/100 km{} at {}; {:.3} kWh/100 km at present",
                used.consumption_kwh_per_100_km,
                range.unwrap_or_default(),
                significant(used.value),
                now.consumption_kwh_per_100_km
            ));
        }
    }
    page.line("");
}

/// Consumption of every cycle over the property, where the vehicle has a battery.
fn consumptions(sets: &[FluidsOfSet]) -> Vec<Line> {
    let duties = sets
        .iter()
        .flat_map(|set| set.cycles.iter().map(move |duty| (set, duty)));
    let known = duties.filter(|(_, duty)| duty.least_consumption.is_some());
    let line = |(set, duty): (&FluidsOfSet, &FluidsOfDuty)| Line {
        name: format!("{} {}", set.model_set, duty.cycle),
        points: (duty.fluids.iter())
            .map(|fluid| Some((fluid.value, fluid.consumption?.consumption_kwh_per_100_km)))
            .collect(),
        stroke: Stroke::Marked,
    };
    known.map(line).collect()
}

/// The listed oils of the study.
fn listed(duty: &FluidsOfDuty) -> impl Iterator<Item = &LossOfFluid> {
    duty.fluids.iter().filter(|fluid| !fluid.refined)
}

/// Mean loss of every cycle over the property, in W or in % of the minimum.
fn lines(sets: &[FluidsOfSet], relative: bool) -> Vec<Line> {
    let duties = sets
        .iter()
        .flat_map(|set| set.cycles.iter().map(move |duty| (set, duty)));
    let line = |(set, duty): (&FluidsOfSet, &FluidsOfDuty)| {
        let scale = if relative { 100.0 / duty.least.mean_loss_w } else { 1.0 };
        let points = duty.fluids.iter().map(|fluid| (fluid.value, scale * fluid.mean_loss_w));
        Line {
            name: format!("{} {}", set.model_set, duty.cycle),
            points: points.filter(|(_, y)| y.is_finite()).map(Some).collect(),
            stroke: Stroke::Marked,
        }
    };
    let mut lines: Vec<Line> = duties.clone().map(line).collect();
    let present = |(_, duty): (&FluidsOfSet, &FluidsOfDuty)| {
        let scale = if relative { 100.0 / duty.least.mean_loss_w } else { 1.0 };
        Some(Some((duty.present.value?, scale * duty.present.mean_loss_w)))
    };
    lines.push(Line {
        name: "oil as described".to_owned(),
        points: duties.filter_map(present).collect(),
        stroke: Stroke::Dots,
    });
    lines
}
