//! Losses by mechanism, component or sum over speed.

use gearloss_framework::analysis::{PointResult, SUMS, notes};
use gearloss_framework::report::Figure;
use gearloss_framework::report::plot::Bar;
use gearloss_framework::study::{As, BreakdownEntry, By};
use gearloss_framework::transmission::PartInfo;
use serde_json::{Value, json};

use super::super::solve::{RPM, outside};
use super::map::{spread, tidy};
use super::write::{cell, head, picture, write};
use super::{Built, Runner, axis};
use crate::output::{Failure, Out, Table, number};

pub fn run(runner: &Runner<'_>, name: &str, entry: &BreakdownEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let torques = axis(runner, &format!("{path}.torque"), entry.torque.values())?;
    let speeds = axis(runner, &format!("{path}.speed"), entry.speed.values())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let (unit, label) = if entry.unit == As::Watts {
        ("w", "W")
    } else {
        ("percent", "%")
    };
    let header: Vec<String> = [
        "model_set",
        "gear",
        "torque_nm",
        "speed_rpm",
        "share",
        &format!("loss_{unit}"),
    ]
    .map(str::to_owned)
    .to_vec();
    let mut rows = Vec::new();
    let mut results = Vec::new();
    for b in &built {
        let first = b.transmission.states().first().map_or("", |s| s.name.as_str());
        let gear = entry.gear.as_deref().unwrap_or(first);
        let points = runner.points(&b.transmission, gear, torques.clone(), speeds.clone());
        let solved = runner.solve(b, &points)?;
        let names = names(b, entry.by);
        let stacks: Vec<Option<Vec<f64>>> = solved.points.iter().map(|p| shares(b, p, entry, &names)).collect();
        for (point, stack) in solved.points.iter().zip(&stacks) {
            for (i, share) in names.iter().enumerate() {
                rows.push(vec![
                    b.name.clone(),
                    gear.to_owned(),
                    cell(Some(point.torque)),
                    cell(Some(tidy(point.speed * RPM))),
                    share.clone(),
                    cell(stack.as_ref().map(|s| s[i])),
                ]);
            }
        }
        let shown = spread(speeds.len());
        for (t, torque) in torques.iter().enumerate() {
            let bars = speeds.iter().enumerate().map(|(i, speed)| Bar {
                label: format!("{:.0}", speed * RPM),
                shares: stacks[t * speeds.len() + i].clone().unwrap_or_default(),
                ..Bar::default()
            });
            let figure = Figure::Bars {
                title: format!(
                    "{name}: loss in {label} over speed in rpm, gear {gear}, {torque} Nm, models {}",
                    b.name
                ),
                height: format!("loss in {label}"),
                names: names.clone(),
                bars: bars.collect(),
            };
            let file = format!("{name}-{}-{torque}Nm", b.name);
            picture(runner, &file, figure, &entry.write)?;
            out.line(format!(
                "{name}: loss in {label}, gear {gear}, {torque} Nm, models {}",
                b.name
            ))?;
            let mut titles = vec!["share".to_owned()];
            titles.extend(shown.iter().map(|i| format!("{:.0} rpm", speeds[*i] * RPM)));
            let mut table = Table::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
            let at = |i: usize| stacks[t * speeds.len() + i].as_ref();
            for (k, share) in names.iter().enumerate() {
                let mut row = vec![share.clone()];
                row.extend(shown.iter().map(|i| number(at(*i).map(|s| s[k]), 2)));
                table.row(row);
            }
            let mut sum = vec!["sum".to_owned()];
            sum.extend(shown.iter().map(|i| number(at(*i).map(|s| s.iter().sum()), 2)));
            table.row(sum);
            out.text(&table.render())?;
            out.line("")?;
        }
        let seen = notes(&b.transmission, &solved.seen);
        out.line(outside(&seen))?;
        results.push(json!({
            "model_set": b.name,
            "gear": gear,
            "unit": unit,
            "shares": names,
            "notes": seen,
            "points": solved.points.iter().zip(&stacks).map(|(p, s)| json!({
                "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM), "loss": s,
            })).collect::<Vec<_>>(),
        }));
    }
    let mut value = head(runner, name, &built.iter().collect::<Vec<_>>());
    value["breakdowns"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    Ok(())
}

/// A part's component: its path without the slot of a drag.
fn component(path: &str) -> &str {
    path.split(".drag.").next().unwrap_or(path)
}

/// Name of the share that a part belongs to, by mechanism or by component.
pub fn name_of(part: &PartInfo, by: By) -> &str {
    if by == By::Mechanism {
        part.mechanism
    } else {
        component(&part.path)
    }
}

/// Names of the shares.
pub fn names(built: &Built<'_>, by: By) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    match by {
        By::Sum => names.extend(SUMS.iter().map(|(name, _)| (*name).to_owned())),
        By::Mechanism | By::Component => {
            for part in built.transmission.parts() {
                let name = name_of(part, by);
                if !names.iter().any(|n| n == name) {
                    names.push(name.to_owned());
                }
            }
        }
    }
    names
}

/// The stack of one point in W; absent where its loss is.
pub fn stack(built: &Built<'_>, point: &PointResult, by: By, names: &[String]) -> Option<Vec<f64>> {
    point.loss?;
    let mut stack = vec![0.0; names.len()];
    match by {
        By::Sum => stack.copy_from_slice(&point.sums),
        By::Mechanism | By::Component => {
            for (part, watts) in built.transmission.parts().iter().zip(&point.parts) {
                let name = name_of(part, by);
                if let Some(i) = names.iter().position(|n| n == name) {
                    stack[i] += watts;
                }
            }
        }
    }
    Some(stack)
}

/// The stack in the unit of the analysis.
fn shares(built: &Built<'_>, point: &PointResult, entry: &BreakdownEntry, names: &[String]) -> Option<Vec<f64>> {
    let mut stack = stack(built, point, entry.by, names)?;
    if entry.unit == As::Percent {
        let loss = point.loss.filter(|loss| *loss != 0.0)?;
        for watts in &mut stack {
            *watts *= 100.0 / loss;
        }
    }
    Some(stack)
}
