//! Pictures of cycles for the report: mean losses by share, and everything over time.

use gearloss_studies::analyses::cycle::{CycleOutcome, DutyOfSet, IntervalOfDuty};

use super::{MOST, line, mean_losses, temperatures};
use crate::page::Page;
use crate::picture::{Pane, Panes, Screen};
use crate::plot::{Bar, Line, Stroke};
use crate::text::{extremes, short};
use crate::{Cloud, Figure};

/// Cells of speed and of torque: as many as squares of a readable size fill the picture.
const CELLS: [usize; 2] = [28, 20];
/// The least share of the energy that is shown: less is not visible beside the usual several percent. [%]
const LEAST: f64 = 0.02;

pub fn draw(outcome: &CycleOutcome, page: &mut Page) {
    bars(outcome, page);
    for duty in &outcome.cycles {
        if !duty.series.is_empty() {
            page.report_figure(Figure::Cloud(by_place(duty)));
            page.screen(Screen::Panes(over_time(duty)));
        }
    }
}

/// Where the energy of a cycle is lost: cells of torque and speed with their share.
fn by_place(duty: &DutyOfSet) -> Cloud {
    let ends = |read: fn(&IntervalOfDuty) -> f64| {
        let ends = extremes(duty.series.iter().map(|interval| (read(interval), ())));
        ends.map_or((0.0, 1.0), |[low, high]| (low.0, (high.0 - low.0).max(1e-9)))
    };
    let (speed, torque) = (ends(|i| i.speed_rpm), ends(|i| i.torque_nm));
    let place = |value: f64, (low, width): (f64, f64), cells: usize| {
        (((value - low) / width * cells as f64) as usize).min(cells - 1)
    };
    let mut joules = vec![0.0; CELLS[0] * CELLS[1]];
    for interval in &duty.series {
        let column = place(interval.speed_rpm, speed, CELLS[0]);
        let row = place(interval.torque_nm, torque, CELLS[1]);
        joules[row * CELLS[0] + column] += interval.loss_w * interval.duration_s;
    }
    let all: f64 = joules.iter().sum();
    let middle = |cell: usize, (low, width): (f64, f64), cells: usize| low + (cell as f64 + 0.5) * width / cells as f64;
    let point = |(i, joule): (usize, &f64)| {
        let (column, row) = (i % CELLS[0], i / CELLS[0]);
        let share = 100.0 * joule / all;
        (share >= LEAST).then(|| (middle(column, speed, CELLS[0]), middle(row, torque, CELLS[1]), share))
    };
    Cloud {
        title: format!("Where {} loses its energy with {}, in %", duty.cycle, duty.model_set),
        axes: ("speed in rpm".to_owned(), "torque in Nm".to_owned()),
        points: joules.iter().enumerate().filter_map(point).collect(),
        unit: "%".to_owned(),
        diverging: false,
    }
}

/// A bar of mean losses by share for each cycle and set, with the reference beside it.
fn bars(outcome: &CycleOutcome, page: &mut Page) {
    let Some(first) = outcome.cycles.first() else { return };
    let bar = |duty: &DutyOfSet| {
        let band = duty.bands.as_ref().map(|band| band.mean_loss_w.map(short));
        let band = band.map_or_else(String::new, |[low, _, high]| format!(" ({low} to {high})"));
        Bar {
            label: format!("{}\n{}", duty.cycle, duty.model_set),
            shares: duty.mean_losses_w.clone(),
            above: format!("{} W{band}", short(duty.mean_loss_w)),
            measured: duty.reference.as_ref().map(|reference| (reference.mean_loss_w, 0.0)),
            above_measured: String::new(),
        }
    };
    page.report_figure(Figure::Bars {
        title: "Mean loss over the cycle by share".to_owned(),
        over: String::new(),
        height: "mean loss in W".to_owned(),
        names: first.shares.clone(),
        bars: outcome.cycles.iter().map(bar).collect(),
    });
}

/// Loss, cumulated energy, torque, speed and temperatures over time.
fn over_time(duty: &DutyOfSet) -> Panes {
    let series = &duty.series;
    // There are several pictures over time in one, each of a quarter of the height or less.
    let every = series.len().div_ceil(MOST / 4);
    let chunks = || series.chunks(every);
    let means: Vec<(f64, Vec<f64>)> = chunks()
        .map(|chunk| (chunk[0].time_s, mean_losses(chunk, duty.shares.len())))
        .collect();
    let stack = |share: usize| Line {
        name: duty.shares[share].clone(),
        points: means
            .iter()
            .map(|(time, losses)| Some((*time, losses[share])))
            .collect(),
        stroke: Stroke::Line,
    };
    let cumulated = |share: usize| {
        let mut joule = 0.0;
        let points = chunks().map(|chunk| {
            joule += chunk.iter().map(|i| i.losses_w[share] * i.duration_s).sum::<f64>();
            let last = &chunk[chunk.len() - 1];
            Some((last.time_s + last.duration_s, 1e-3 * joule))
        });
        Line {
            name: duty.shares[share].clone(),
            points: points.collect(),
            stroke: Stroke::Line,
        }
    };
    let shares = 0..duty.shares.len();
    let one = |name: &str, read: fn(&IntervalOfDuty) -> f64| vec![line(series, every, name, &|i| (i.time_s, read(i)))];
    let mut panes = vec![
        Pane {
            y: "loss in W".to_owned(),
            lines: shares.clone().map(stack).collect(),
        },
        Pane {
            y: "lost energy in kJ".to_owned(),
            lines: shares.map(cumulated).collect(),
        },
        Pane {
            y: "torque in Nm".to_owned(),
            lines: one("torque", |i| i.torque_nm),
        },
        Pane {
            y: "speed in rpm".to_owned(),
            lines: one("speed", |i| i.speed_rpm),
        },
    ];
    if duty.heat.is_some() {
        panes.push(Pane {
            y: "temperature in °C".to_owned(),
            lines: temperatures(duty, every),
        });
    }
    Panes {
        title: format!("{} with {}, over time", duty.cycle, duty.model_set),
        x: "time in s".to_owned(),
        panes,
    }
}
