//! Pictures of cycles for the report: mean losses by share, and everything over time.

use gearloss_studies::analyses::cycle::{CycleOutcome, DutyOfSet, IntervalOfDuty};

use super::{MOST, line, mean_losses, temperatures};
use crate::names::cycle as words;
use crate::page::Page;
use crate::picture::{Pane, Panes, Screen};
use crate::plot::{Bar, Line, Stroke};
use crate::text::{extremes, short, words_of_set};
use crate::{Cloud, Figure};

/// Cells of speed and of torque: as many as squares of a readable size fill the picture.
const CELLS: [usize; 2] = [28, 20];
/// The least share of the energy that is shown: less is not visible beside the usual several percent. [%]
const LEAST: f64 = 0.02;

pub fn draw(outcome: &CycleOutcome, page: &mut Page) {
    match &outcome.cycles[..] {
        // A single column compares nothing.
        [only] if only.reference.is_none() => shares(only, page),
        _ => bars(outcome, page),
    }
    for duty in &outcome.cycles {
        if !duty.series.is_empty() {
            let cells = Cells::new(duty);
            page.report_figure(Figure::Cloud(cells.efficiency(duty)));
            page.report_figure(Figure::Cloud(cells.lost(duty)));
            page.screen(Screen::Panes(over_time(duty)));
        }
    }
}

/// Energies of a cycle by cells of speed and torque.
struct Cells {
    /// Minimum and width of the range of speed and of torque.
    ranges: [(f64, f64); 2],
    /// For each cell: input, output and loss. \[J\]
    energies: Vec<[f64; 3]>,
}

impl Cells {
    fn new(duty: &DutyOfSet) -> Self {
        let range = |read: fn(&IntervalOfDuty) -> f64| {
            let ends = extremes(duty.series.iter().map(|interval| (read(interval), ())));
            ends.map_or((0.0, 1.0), |[low, high]| (low.0, (high.0 - low.0).max(1e-9)))
        };
        let ranges = [range(|i| i.speed_rpm), range(|i| i.torque_nm)];
        let place = |value: f64, (low, width): (f64, f64), cells: usize| {
            (((value - low) / width * cells as f64) as usize).min(cells - 1)
        };
        let mut energies = vec![[0.0; 3]; CELLS[0] * CELLS[1]];
        for interval in &duty.series {
            let column = place(interval.speed_rpm, ranges[0], CELLS[0]);
            let row = place(interval.torque_nm, ranges[1], CELLS[1]);
            let powers = [interval.input_w, interval.output_w, interval.loss_w];
            for (energy, power) in energies[row * CELLS[0] + column].iter_mut().zip(powers) {
                *energy += power * interval.duration_s;
            }
        }
        Self { ranges, energies }
    }

    /// Speed and torque in the middle of a cell.
    fn middle(&self, cell: usize) -> (f64, f64) {
        let place = [cell % CELLS[0], cell / CELLS[0]];
        let at = |k: usize| self.ranges[k].0 + (place[k] as f64 + 0.5) * self.ranges[k].1 / CELLS[k] as f64;
        (at(0), at(1))
    }

    fn cloud(&self, title: String, value: impl Fn(&[f64; 3]) -> Option<f64>) -> Cloud {
        let cells = self.energies.iter().enumerate();
        let points = cells.filter_map(|(cell, energies)| {
            let (speed, torque) = self.middle(cell);
            Some((speed, torque, value(energies)?))
        });
        Cloud {
            title,
            axes: ("speed in rpm".to_owned(), "torque in Nm".to_owned()),
            points: points.collect(),
            unit: "%".to_owned(),
            ..Cloud::default()
        }
    }

    /// Where the energy of a cycle is lost: cells with their share.
    fn lost(&self, duty: &DutyOfSet) -> Cloud {
        let all: f64 = self.energies.iter().map(|[.., lost]| lost).sum();
        let share = |[.., lost]: &[f64; 3]| Some(100.0 * lost / all).filter(|share| *share >= LEAST);
        let title = format!("Where {} loses its energy, in %", of_duty(duty));
        self.cloud(title, share)
    }

    /// The efficiency at the operating points of a cycle, each as large as its input energy.
    fn efficiency(&self, duty: &DutyOfSet) -> Cloud {
        let all: f64 = self.energies.iter().map(|[input, ..]| input).sum();
        let efficiency = |[input, output, _]: &[f64; 3]| {
            let is_shown = 100.0 * input >= LEAST * all && *input > 0.0 && *output > 0.0;
            is_shown.then(|| 100.0 * output / input)
        };
        let shown = self.energies.iter().filter(|energies| efficiency(energies).is_some());
        let shares: Vec<f64> = shown.map(|[input, ..]| *input).collect();
        let largest = shares.iter().copied().fold(0.0, f64::max);
        let title = format!("Efficiency over {}, area by energy", of_duty(duty));
        Cloud {
            sizes: shares.iter().map(|joule| joule / largest).collect(),
            sized: format!("area: input energy, largest {} %", short(100.0 * largest / all)),
            ..self.cloud(title, efficiency)
        }
    }
}

/// A bar for each share of the loss of one cycle, the largest first.
fn shares(duty: &DutyOfSet, page: &mut Page) {
    let mut order: Vec<usize> = (0..duty.shares.len()).collect();
    order.retain(|share| duty.energies_j[*share] > 0.0);
    order.sort_by(|a, b| duty.energies_j[*b].total_cmp(&duty.energies_j[*a]));
    let bar = |share: &usize| {
        let part = 100.0 * duty.energies_j[*share] / duty.energy.loss_j;
        let alone = |i: usize| if i == *share { duty.mean_losses_w[i] } else { 0.0 };
        Bar {
            label: duty.shares[*share].clone(),
            shares: (0..duty.shares.len()).map(alone).collect(),
            above: format!("{} W, {} %", short(duty.mean_losses_w[*share]), short(part)),
            measured: None,
            above_measured: String::new(),
        }
    };
    page.report_figure(Figure::Bars {
        title: format!("Mean loss of {} W over {}", short(duty.mean_loss_w), of_duty(duty)),
        over: String::new(),
        height: "mean loss in W".to_owned(),
        names: duty.shares.clone(),
        bars: order.iter().map(bar).collect(),
    });
}

/// A bar of mean losses by share for each cycle and set, with the reference beside it.
fn bars(outcome: &CycleOutcome, page: &mut Page) {
    let Some(first) = outcome.cycles.first() else { return };
    let several = outcome.cycles.iter().any(|duty| duty.model_set != first.model_set);
    let bar = |duty: &DutyOfSet| {
        let band = duty.bands.as_ref().map(|band| band.mean_loss_w.map(short));
        let band = band.map_or_else(String::new, |[low, _, high]| format!(" ({low} to {high})"));
        Bar {
            label: if several {
                format!("{}\n{}", words(&duty.cycle), duty.model_set)
            } else {
                words(&duty.cycle)
            },
            shares: duty.mean_losses_w.clone(),
            above: format!("{} W{band}", short(duty.mean_loss_w)),
            measured: duty.reference.as_ref().map(|reference| (reference.mean_loss_w, 0.0)),
            above_measured: duty
                .reference
                .as_ref()
                .map_or_else(String::new, |reference| format!("{} W", short(reference.mean_loss_w))),
        }
    };
    page.report_figure(Figure::Bars {
        title: "Mean loss over the cycle".to_owned(),
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
        title: format!("{}, over time", of_duty(duty)),
        x: "time in s".to_owned(),
        panes,
    }
}

/// The cycle and the model set of a picture.
fn of_duty(duty: &DutyOfSet) -> String {
    format!("{} with {}", words(&duty.cycle), words_of_set(&duty.model_set))
}
