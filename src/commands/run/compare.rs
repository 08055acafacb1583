//! Difference between sets of models over a grid: the other set minus the base.

use gearloss_framework::analysis::{GridResult, PointResult};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::study::{CompareEntry, Difference, Quantity};
use serde_json::{Value, json};

use super::super::solve::RPM;
use super::map::{spread, tidy};
use super::write::{cell, head, write};
use super::{Runner, axis};
use crate::output::{Failure, Out, Table, number};

pub fn run(runner: &Runner<'_>, name: &str, entry: &CompareEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let grid = runner.study.grid(&path, &entry.grid)?;
    if !grid.bind.is_empty() {
        let path = format!("grids.{}.bind", entry.grid);
        let error = Diagnostic::error(path, "a comparison takes a grid without bound values")
            .mend("give it a grid of its own, and the value under `conditions: { set: ... }`");
        return Err(runner.study.findings(vec![error]).into());
    }
    if (entry.quantity, entry.difference) == (Quantity::Temperature, Difference::Percent) {
        let error = Diagnostic::error(format!("{path}.difference"), "a temperature has no percentage")
            .mend("write `difference: points`, which counts kelvins");
        return Err(runner.study.findings(vec![error]).into());
    }
    let torques = axis(runner, &format!("grids.{}.torque", entry.grid), grid.torque.values())?;
    let speeds = axis(runner, &format!("grids.{}.speed", entry.grid), grid.speed.values())?;
    let sets: Vec<String> = std::iter::once(&entry.base).chain(&entry.against).cloned().collect();
    let built = runner.built(gearbox, &sets)?;
    let mut solved: Vec<GridResult> = Vec::new();
    for b in &built {
        let points = runner.points(&b.transmission, &grid.gear, torques.clone(), speeds.clone());
        solved.push(runner.solve(b, &points)?);
    }
    let quantity = |p: &PointResult| match entry.quantity {
        Quantity::Efficiency => p.efficiency,
        Quantity::Loss => p.loss,
        Quantity::Temperature => p.oil,
    };
    let unit = match (entry.difference, entry.quantity) {
        (Difference::Percent, _) => "percent",
        (Difference::Points, Quantity::Efficiency) => "points",
        (Difference::Points, Quantity::Loss) => "w",
        (Difference::Points, Quantity::Temperature) => "k",
    };
    let difference = |base: Option<f64>, other: Option<f64>| -> Option<f64> {
        let (base, other) = (base?, other?);
        match (entry.difference, entry.quantity) {
            (Difference::Percent, _) => (base != 0.0).then(|| 100.0 * (other - base) / base),
            (Difference::Points, Quantity::Efficiency) => Some(100.0 * (other - base)),
            (Difference::Points, Quantity::Loss | Quantity::Temperature) => Some(other - base),
        }
    };
    let what = match entry.quantity {
        Quantity::Efficiency => "efficiency",
        Quantity::Loss => "loss_w",
        Quantity::Temperature => "oil_temperature_degc",
    };
    let header: Vec<String> = [
        "model_set",
        "base",
        "gear",
        "torque_nm",
        "speed_rpm",
        what,
        &format!("base_{what}"),
        &format!("difference_{unit}"),
    ]
    .map(str::to_owned)
    .to_vec();
    let mut rows = Vec::new();
    let mut results = Vec::new();
    for (b, other) in built.iter().zip(&solved).skip(1) {
        let differences: Vec<Option<f64>> = solved[0]
            .points
            .iter()
            .zip(&other.points)
            .map(|(base, other)| difference(quantity(base), quantity(other)))
            .collect();
        for ((base, point), gap) in solved[0].points.iter().zip(&other.points).zip(&differences) {
            rows.push(vec![
                b.name.clone(),
                entry.base.clone(),
                grid.gear.clone(),
                cell(Some(point.torque)),
                cell(Some(tidy(point.speed * RPM))),
                cell(quantity(point)),
                cell(quantity(base)),
                cell(*gap),
            ]);
        }
        out.line(format!(
            "{name}: {what} of {} minus {} in {unit}, gear {}",
            b.name, entry.base, grid.gear
        ))?;
        let shown = spread(speeds.len());
        let mut titles = vec!["torque Nm".to_owned()];
        titles.extend(shown.iter().map(|i| format!("{:.0} rpm", speeds[*i] * RPM)));
        let mut table = Table::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
        for t in spread(torques.len()) {
            let mut row = vec![format!("{}", torques[t])];
            row.extend(shown.iter().map(|i| number(differences[t * speeds.len() + i], 2)));
            table.row(row);
        }
        out.text(&table.render())?;
        let extreme = |pick: fn(f64, f64) -> bool| {
            let mut best: Option<(usize, f64)> = None;
            for (i, gap) in differences.iter().enumerate() {
                if let Some(gap) = gap
                    && best.is_none_or(|(_, so_far)| pick(*gap, so_far))
                {
                    best = Some((i, *gap));
                }
            }
            best
        };
        let (least, greatest) = (extreme(|a, b| a < b), extreme(|a, b| a > b));
        let known: Vec<f64> = differences.iter().flatten().copied().collect();
        let mean = (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64);
        let place = |found: Option<(usize, f64)>| {
            found.map_or_else(
                || "-".to_owned(),
                |(i, gap)| {
                    format!(
                        "{gap:.3} at {} Nm, {:.0} rpm",
                        other.points[i].torque,
                        other.points[i].speed * RPM
                    )
                },
            )
        };
        out.line(format!(
            "least {}; greatest {}; mean {}",
            place(least),
            place(greatest),
            number(mean, 3)
        ))?;
        out.line("")?;
        let at = |found: Option<(usize, f64)>| {
            found.map(|(i, gap)| {
                json!({ "difference": gap, "torque_nm": other.points[i].torque, "speed_rpm": tidy(other.points[i].speed * RPM) })
            })
        };
        results.push(json!({
            "model_set": b.name,
            "base": entry.base,
            "quantity": entry.quantity,
            "unit": unit,
            "least": at(least),
            "greatest": at(greatest),
            "mean": mean,
            "points": differences.iter().zip(&other.points).map(|(gap, p)| json!({
                "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM), "difference": gap,
            })).collect::<Vec<_>>(),
        }));
    }
    let mut value = head(runner, name, &built.iter().collect::<Vec<_>>());
    value["comparisons"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    Ok(())
}
