//! Pictures of driven duties: losses stacked over time, temperatures, torque and speed.

use gearloss_report::Figure;
use gearloss_report::plot::{Line, Stroke};
use gearloss_studies::study::CycleAnalysisEntry;

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::write::picture;
use super::outcome::Outcome;
use crate::output::Failure;

/// The most points of one line: more cannot be told apart, and a page holds all of them.
const MOST: usize = 2400;

pub fn pictures(runner: &Runner<'_>, name: &str, entry: &CycleAnalysisEntry, o: &Outcome<'_>) -> Result<(), Failure> {
    let (set, cycle) = (&o.built.name, &o.read.name);
    let stretches = &o.driven.stretches;
    if stretches.is_empty() {
        return Ok(());
    }
    let every = stretches.len().div_ceil(MOST);
    let places: Vec<f64> = stretches.chunks(every).map(|c| c[0].start).collect();
    // The mean over what one point stands for keeps the energy.
    let stacks: Vec<Vec<f64>> = stretches
        .chunks(every)
        .map(|chunk| {
            let time: f64 = chunk.iter().map(|s| s.heats.duration).sum();
            let mut sum = vec![0.0; o.names.len()];
            for s in chunk {
                for (sum, watts) in sum.iter_mut().zip(o.stack(s)) {
                    *sum += watts * s.heats.duration / time;
                }
            }
            sum
        })
        .collect();
    let file = format!("{name}-{set}-{cycle}");
    let losses = Figure::Areas {
        title: format!("{name}: losses over {cycle}, models {set}"),
        x: "time in s".to_owned(),
        y: "loss in W".to_owned(),
        names: o.names.clone(),
        places,
        stacks,
    };
    picture(runner, &format!("{file}-loss"), losses, &entry.write)?;
    let line = |name: &str, of: &dyn Fn(usize) -> (f64, f64)| Line {
        name: name.to_owned(),
        points: (0..stretches.len()).step_by(every).map(|i| Some(of(i))).collect(),
        stroke: Stroke::Line,
    };
    for (what, unit, of) in [
        (
            "torque",
            "Nm",
            (|s| s.torque) as fn(&gearloss_studies::analysis::Stretch) -> f64,
        ),
        ("speed", "rpm", |s| s.speed * RPM),
    ] {
        let figure = Figure::Lines {
            title: format!("{name}: {what} of the reference port over {cycle}, models {set}"),
            x: "time in s".to_owned(),
            y: format!("{what} in {unit}"),
            lines: vec![line(what, &|i| (stretches[i].start, of(&stretches[i])))],
        };
        picture(runner, &format!("{file}-{what}"), figure, &entry.write)?;
    }
    if !o.is_thermal() {
        return Ok(());
    }
    let mut lines = Vec::new();
    for (node, own) in o.nodes.iter().enumerate() {
        lines.push(line(own, &|i| {
            let s = &stretches[i];
            (s.start + s.heats.duration, s.temperatures[node])
        }));
        let measured = o.measured(node);
        if !measured.is_empty() {
            let every = measured.len().div_ceil(MOST / 8);
            lines.push(Line {
                name: format!("{own}, measured"),
                points: measured.iter().step_by(every).copied().map(Some).collect(),
                stroke: Stroke::Dots,
            });
        }
    }
    let figure = Figure::Lines {
        title: format!("{name}: temperatures over {cycle}, models {set}"),
        x: "time in s".to_owned(),
        y: "temperature in degC".to_owned(),
        lines,
    };
    picture(runner, &format!("{file}-temperatures"), figure, &entry.write)
}
