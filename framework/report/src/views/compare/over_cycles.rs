//! Differences of mean losses over cycles: a table of shares and phases, and bars of both.

use gearloss_studies::analyses::compare::CycleComparison;
use gearloss_studies::distinct::distinct;
use gearloss_studies::duty::Consumption;

use super::on_grid::with_error;
use crate::Figure;
use crate::page::Page;
use crate::plot::Bar;
use crate::text::{TextTable, number, signed};

pub fn show(name: &str, all: &[CycleComparison], page: &mut Page) {
    for cycle in distinct(all.iter().map(|c| c.cycle.as_str())) {
        let compared: Vec<&CycleComparison> = all.iter().filter(|c| c.cycle == cycle).collect();
        page.table(shares(&compared));
        if compared.iter().any(|c| !c.phases.is_empty()) {
            page.table(phases(&compared));
        }
        for c in &compared {
            if let Some(band) = c.difference_band_w {
                page.verdict(format!("over {cycle}: {}", with_error((&c.model_set, &c.base), band)));
            }
        }
        consumption(&compared, page);
        page.line("");
        page.figure(format!("{name}-{cycle}"), bars(name, cycle, &compared));
    }
}

/// Differences of the consumption, if the vehicle has a battery.
fn consumption(compared: &[&CycleComparison], page: &mut Page) {
    for c in compared {
        if let Some(difference) = c.consumption_difference_kwh_per_100_km {
            let part = |read: fn(&Consumption) -> f64| {
                let both = c.consumption.as_ref().zip(c.base_consumption.as_ref());
                both.map_or(0.0, |(now, before)| read(now) - read(before))
            };
            page.line(format!(
                "consumption with {} minus {}: {difference:+.4} kWh/100 km",
                c.model_set, c.base
            ));
            page.line(format!(
                "  of it: transmission {:+.4}, machine {:+.4}, brakes {:+.4}, battery {:+.4} kWh/100 km",
                part(|of| of.transmission_kwh_per_100_km),
                part(|of| of.machine_kwh_per_100_km),
                part(|of| of.brakes_kwh_per_100_km),
                part(|of| of.battery_kwh_per_100_km)
            ));
        }
    }
}

/// Mean losses of base and cases by share, with their differences.
fn shares(compared: &[&CycleComparison]) -> TextTable {
    let first = compared[0];
    let mut head = vec!["share".to_owned(), format!("{} W", first.base)];
    head.extend(compared.iter().map(|c| format!("{} W", c.model_set)));
    head.extend(compared.iter().map(|c| format!("{} minus {} W", c.model_set, c.base)));
    let mut table = TextTable::new(&head).titled(format!("mean loss over {} by share", first.cycle));
    for (i, share) in first.shares.iter().enumerate() {
        let mut row = vec![share.share.clone(), number(Some(share.base_mean_loss_w), 3)];
        row.extend(compared.iter().map(|c| number(Some(c.shares[i].mean_loss_w), 3)));
        row.extend(compared.iter().map(|c| difference(c.shares[i].difference_w)));
        table.row(row);
    }
    let mut row = vec!["sum".to_owned(), number(Some(first.base_mean_loss_w), 3)];
    row.extend(compared.iter().map(|c| number(Some(c.mean_loss_w), 3)));
    row.extend(compared.iter().map(|c| difference(c.difference_w)));
    table.row(row);
    table
}

/// Mean losses by phase of the cycle.
fn phases(compared: &[&CycleComparison]) -> TextTable {
    let first = compared[0];
    TextTable::of(first.phases.iter().enumerate())
        .column("phase", |(_, phase)| &phase.phase)
        .column("from s", |(_, phase)| number(Some(phase.from_s), 0))
        .column("to s", |(_, phase)| number(Some(phase.to_s), 0))
        .column(format!("{} W", first.base), |(_, phase)| {
            number(Some(phase.base_mean_loss_w), 3)
        })
        .each(compared, |table, c| {
            table.column(format!("{} minus {} W", c.model_set, c.base), |(i, _)| {
                difference(c.phases[*i].difference_w)
            })
        })
        .finish()
        .titled(format!("mean loss by phase of {}", first.cycle))
}

/// A difference with its sign and as many decimals as the values beside it.
fn difference(x: f64) -> String {
    format!("{x:+.3}")
}

/// The base and every case as bars of their shares.
fn bars(name: &str, cycle: &str, compared: &[&CycleComparison]) -> Figure {
    let first = compared[0];
    let base = Bar {
        label: first.base.clone(),
        shares: first.shares.iter().map(|share| share.base_mean_loss_w).collect(),
        above: format!("{:.1} W", first.base_mean_loss_w),
        ..Bar::default()
    };
    let case = |c: &&CycleComparison| Bar {
        label: c.model_set.clone(),
        shares: c.shares.iter().map(|share| share.mean_loss_w).collect(),
        above: format!("{:.1} W ({})", c.mean_loss_w, signed(c.difference_w)),
        ..Bar::default()
    };
    Figure::Bars {
        title: format!("{name}: mean loss over {cycle} by share"),
        over: String::new(),
        height: "mean loss in W".to_owned(),
        names: first.shares.iter().map(|share| share.share.clone()).collect(),
        bars: std::iter::once(base).chain(compared.iter().map(case)).collect(),
    }
}
