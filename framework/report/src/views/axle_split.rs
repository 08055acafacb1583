//! Two units: energy, time in each state, fixed shares for comparison, and the share over time.

use gearloss_studies::analyses::axle_split::{AxleSplitOutcome, SplitOfCycle};

use crate::Figure;
use crate::names::cycle;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, short, significant};

register_view!(AxleSplitOutcome, show);

/// Maximum number of points of one line.
const MOST: usize = 2400;

fn show(outcome: &AxleSplitOutcome, page: &mut Page) {
    let name = &outcome.head.analysis;
    let mut words = Vec::new();
    for split in &outcome.cycles {
        let of = cycle(&split.cycle);
        let energy = energy(split);
        words.push(format!("{energy} over {of}"));
        page.key_figure(&format!("drawn, {of}"), significant(1e-3 * split.drawn_j), "kJ", energy);
        text(name, split, page);
        figure(name, split, page);
        if split.intervals_beyond_limits > 0 {
            page.careful.push(format!(
                "{of}: every share is beyond the map of a machine in {} intervals; that with the smallest excess is used",
                split.intervals_beyond_limits
            ));
        }
    }
    page.headline = Some(format!("Both machines draw {}", words.join("; ")));
}

fn energy(split: &SplitOfCycle) -> String {
    match split.drawn_kwh_per_100_km {
        Some(energy) => format!("{} kWh/100 km", significant(energy)),
        None => format!("{} kJ", significant(1e-3 * split.drawn_j)),
    }
}

fn text(name: &str, split: &SplitOfCycle, page: &mut Page) {
    let [front, rear] = &split.model_sets;
    page.line(format!(
        "{name}: {}, {} s, front {front}, rear {rear}: {}, front {} kJ, rear {} kJ",
        split.cycle,
        significant(split.duration_s),
        energy(split),
        significant(1e-3 * split.front_j),
        significant(1e-3 * split.rear_j)
    ));
    let mut table = TextTable::new(&["state", "time s", "time %", "drawn kJ"]);
    for state in &split.states {
        table.row(vec![
            state.state.name().to_owned(),
            significant(state.time_s),
            format!("{:.1}", 100.0 * state.time_share),
            format!("{:.2}", 1e-3 * state.drawn_j),
        ]);
    }
    page.table(table);
    let mut table = TextTable::new(&["fixed share of the front axle", "drawn kJ", "more kJ", "more %"]);
    for fixed in &split.fixed {
        let percent = 100.0 * fixed.difference_j / split.drawn_j;
        table.row(vec![
            short(fixed.front_share),
            format!("{:.2}", 1e-3 * fixed.drawn_j),
            format!("{:.2}", 1e-3 * fixed.difference_j),
            format!("{percent:.2}"),
        ]);
    }
    page.table(table);
    page.line("");
}

fn figure(name: &str, split: &SplitOfCycle, page: &mut Page) {
    let every = split.series.len().div_ceil(MOST).max(1);
    let points = split.series.iter().step_by(every);
    let figure = Figure::Lines {
        title: format!("{name}: share of the front axle over {}", split.cycle),
        x: "time in s".to_owned(),
        y: "share of the torque".to_owned(),
        lines: vec![Line {
            name: "front axle".to_owned(),
            points: points
                .map(|at| at.front_share.map(|share| (at.time_s, share)))
                .collect(),
            stroke: Stroke::Line,
        }],
    };
    page.figure(format!("{name}-{}-share", split.cycle), figure);
}
