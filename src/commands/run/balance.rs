//! How the temperature of one point is found: losses and heat over temperature, and every step.

use gearloss_framework::evaluate::Point;
use gearloss_framework::flow::Tolerance;
use gearloss_framework::thermal::Step;
use gearloss_report::Figure;
use gearloss_report::plot::{Line, Stroke};
use gearloss_studies::analysis::notes;
use gearloss_studies::study::{BalanceEntry, Write};
use serde_json::{Value, json};

use super::super::solve::{json_of_balance, of_balance};
use super::thermal_limit::needs_balance;
use super::write::{cell, head, picture, write};
use super::{Runner, gear_of};
use crate::output::{Failure, Out};

pub fn run(runner: &Runner<'_>, name: &str, entry: &BalanceEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let change = |(own, value): (&str, &Value)| (own.to_owned(), value.clone(), format!("{path}.set"));
    let set: Vec<(String, Value, String)> = entry.set.iter().map(change).collect();
    let built = runner.built_with(gearbox, &entry.model_sets, &set)?;
    let header = [
        "model_set",
        "step",
        "of",
        "oil_temperature_degc",
        "loss_w",
        "heat_w",
        "residual_w",
    ]
    .map(str::to_owned);
    let (mut rows, mut results) = (Vec::new(), Vec::new());
    for b in &built {
        needs_balance(runner, &path, b)?;
        let t = &b.transmission;
        let points = runner.points(t, gear_of(entry.gear.as_deref(), t), Vec::new(), Vec::new());
        let case = runner.case(b.gearbox, t, &points)?;
        if runner.only_checks {
            continue;
        }
        let torques = [entry.torque];
        let point = Point {
            speeds: &[entry.speed],
            torques: &torques[..case.torque_ports.len()],
            flow: points.flow,
            tolerance: Tolerance::default(),
        };
        let mut scratch = t.scratch(&case);
        let found = t.equilibrium(&case, &point, &mut scratch);
        if let Some(oil) = found.oil() {
            // What is noted belongs to the temperature that was found.
            t.evaluate(&case, &point, &[oil], &mut scratch);
        }
        runner.seen(t, &scratch.totals);
        let seen = notes(t, &scratch.totals);
        out.line(format!("{name}: models {}", b.name))?;
        out.text(&of_balance(t, &found, false))?;
        runner.outside(&seen, out);
        out.line("")?;
        for (i, step) in found.history.iter().enumerate() {
            let of = if i < found.scanned { "scan" } else { "solution" };
            let mut row = vec![b.name.clone(), (i + 1).to_string(), of.to_owned()];
            row.extend([step.temperature, step.loss, step.heat, step.residual()].map(|x| cell(Some(x))));
            rows.push(row);
        }
        results.push(
            json!({ "model_set": b.name, "gear": points.gear, "balance": json_of_balance(t, &found), "notes": seen }),
        );
        let write = &entry.write;
        pictures(
            runner,
            &format!("{name}-{}", b.name),
            &found.history,
            found.scanned,
            write,
        )?;
    }
    if runner.only_checks {
        return Ok(());
    }
    let mut value = head(runner, name, &built.iter().collect::<Vec<_>>());
    value["balances"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)
}

/// Losses and heat over temperature; temperature and residual over the steps behind the scan.
fn pictures(runner: &Runner<'_>, name: &str, history: &[Step], scanned: usize, write: &[Write]) -> Result<(), Failure> {
    let figure = |title: String, x: &str, y: &str, lines: Vec<Line>| Figure::Lines {
        title,
        x: x.to_owned(),
        y: y.to_owned(),
        lines,
    };
    let mut sorted: Vec<&Step> = history.iter().collect();
    sorted.sort_by(|a, b| a.temperature.total_cmp(&b.temperature));
    let line = |name: &str, y: fn(&Step) -> f64| Line {
        name: name.to_owned(),
        points: sorted.iter().map(|s| Some((s.temperature, y(s)))).collect(),
        stroke: Stroke::Marked,
    };
    let curves = [line("loss", |s| s.loss), line("heat", |s| s.heat)];
    let title = format!("{name}: losses and the heat that leaves");
    picture(
        runner,
        name,
        figure(title, "oil temperature in degC", "W", curves.to_vec()),
        write,
    )?;
    let steps = &history[scanned..];
    let line = |name: &str, y: &dyn Fn(&Step) -> Option<f64>| Line {
        name: name.to_owned(),
        points: steps
            .iter()
            .enumerate()
            .map(|(i, s)| Some((i as f64 + 1.0, y(s)?)))
            .collect(),
        stroke: Stroke::Marked,
    };
    let temperature = [line("oil temperature", &|s| Some(s.temperature))];
    let title = format!("{name}: temperature over the steps behind the scan");
    picture(
        runner,
        &format!("{name}-steps"),
        figure(title, "step", "degC", temperature.to_vec()),
        write,
    )?;
    // A residual of zero has no logarithm; it ends the line.
    let residual = [line("residual", &|s| {
        let share = (s.residual() / s.loss).abs();
        (share > 0.0 && share.is_finite()).then(|| share.log10())
    })];
    let title = format!("{name}: residual over the steps behind the scan");
    let figure = figure(title, "step", "log10 of the residual over the loss", residual.to_vec());
    picture(runner, &format!("{name}-residual"), figure, write)
}
