//! Difference between sets of models over a grid: the other set minus the base.

use gearloss_framework::document::Diagnostic;
use gearloss_report::{Figure, Map};
use gearloss_studies::analysis::{GridResult, PointResult, Statistics, notes};
use gearloss_studies::study::CompareEntry;
use serde_json::{Value, json};

use super::super::super::solve::RPM;
use super::super::write::{cell, head, picture, write};
use super::super::{Runner, grid_axes};
use crate::output::{Failure, Out, Table, fixed, number};
use gearloss_report::text::spread;
use gearloss_studies::analyses::numbers::tidy;

pub fn run(
    runner: &Runner<'_>,
    name: &str,
    entry: &CompareEntry,
    (grid_name, base): (&str, &str),
    out: &mut Out,
) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let grid = runner.study.grid(&path, grid_name)?;
    if !grid.bind.is_empty() {
        let path = format!("grids.{grid_name}.bind");
        let error = Diagnostic::error(path, "a comparison takes a grid without bound values")
            .mend("give it a grid of its own, and the value under `conditions: { set: ... }`");
        return Err(runner.study.findings(vec![error]).into());
    }
    let wrong = |key: &str, message: &str, mend: &str| runner.wrong(&format!("grids.{grid_name}.{key}"), message, mend);
    if grid.envelope.is_some() {
        return Err(wrong(
            "envelope",
            "a comparison takes a grid without envelope",
            "give it a grid of its own",
        ));
    }
    let sets: Vec<String> = std::iter::once(base.to_owned())
        .chain(entry.against.iter().cloned())
        .collect();
    let built = runner.built(gearbox, &sets)?;
    let gear = &runner.one_gear(&path, grid, &built[0].transmission)?;
    let mut solved: Vec<GridResult> = Vec::new();
    // Axes that count in shares of a rating have other values for each product; tables and pictures show those of the base.
    let (mut torques, mut speeds) = (Vec::new(), Vec::new());
    for b in built.iter().rev() {
        (torques, speeds) = grid_axes(runner, grid_name, grid, &b.transmission)?;
        let points = runner.points(&b.transmission, gear, torques.clone(), speeds.clone());
        if runner.checked(b, &points)? {
            continue;
        }
        solved.insert(0, runner.solve(b, &points)?);
    }
    if runner.only_checks {
        return Ok(());
    }
    let quantity = |p: &PointResult| entry.quantity.of(p);
    let unit = entry.quantity.unit(entry.difference);
    let what = entry.quantity.name();
    let (words, label) = entry.quantity.words(entry.difference);
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
    let mut gaps: Vec<Vec<Option<f64>>> = Vec::new();
    for (b, other) in built.iter().zip(&solved).skip(1) {
        let differences: Vec<Option<f64>> = solved[0]
            .points
            .iter()
            .zip(&other.points)
            .map(|(base, other)| {
                entry
                    .quantity
                    .difference(entry.difference, quantity(base)?, quantity(other)?)
            })
            .collect();
        for ((first, point), gap) in solved[0].points.iter().zip(&other.points).zip(&differences) {
            rows.push(vec![
                b.name.clone(),
                base.to_owned(),
                gear.clone(),
                cell(Some(point.torque)),
                cell(Some(tidy(point.speed * RPM))),
                cell(quantity(point)),
                cell(quantity(first)),
                cell(*gap),
            ]);
        }
        out.line(format!(
            "{name}: {words} of {} minus {} in {label}, gear {}",
            b.name, base, gear
        ))?;
        let shown = spread(speeds.len());
        let mut titles = vec!["torque Nm".to_owned()];
        titles.extend(shown.iter().map(|i| format!("{} rpm", fixed(speeds[*i] * RPM, 0))));
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
        let of_all = Statistics::of(known.iter().copied());
        let losses = solved[0].points.iter().zip(&other.points);
        let of_loss = Statistics::of(losses.filter_map(|(base, other)| {
            let base = base.loss.filter(|loss| *loss != 0.0)?;
            Some(100.0 * (other.loss? - base) / base)
        }));
        let figures = format!(
            "least {}; greatest {}; mean {}, rms {}; in the loss {} % in the mean, {} % rms",
            place(least),
            place(greatest),
            number(mean, 3),
            number(of_all.map(|s| s.rms), 3),
            number(of_loss.map(|s| s.mean), 2),
            number(of_loss.map(|s| s.rms), 2)
        );
        runner.verdict(format!("{} minus {base}, {words} in {label}: {figures}", b.name), out)?;
        out.line("")?;
        let at = |found: Option<(usize, f64)>| {
            found.map(|(i, gap)| {
                json!({ "difference": gap, "torque_nm": other.points[i].torque, "speed_rpm": tidy(other.points[i].speed * RPM) })
            })
        };
        let seen = notes(&b.transmission, &other.seen);
        runner.outside(&seen, out);
        out.line("")?;
        results.push(json!({
            "model_set": b.name,
            "base": base,
            "gear": gear,
            "quantity": entry.quantity,
            "unit": unit,
            "least": at(least),
            "greatest": at(greatest),
            "mean": mean,
            "difference": of_all,
            "loss_difference_percent_of_loss": of_loss,
            "notes": seen,
            "points": differences.iter().zip(&other.points).zip(&solved[0].points).map(|((gap, p), first)| json!({
                "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM), "base_model": quantity(first),
                "model": quantity(p), "difference": gap,
            })).collect::<Vec<_>>(),
        }));
        gaps.push(differences);
    }
    let mut value = head(runner, &built.iter().collect::<Vec<_>>());
    value["comparisons"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    let mark = |x: f64| format!("{}", tidy(x));
    let columns: Vec<String> = speeds.iter().map(|w| mark(w * RPM)).collect();
    let lines: Vec<String> = torques.iter().map(|t| mark(*t)).collect();
    for ((b, other), differences) in built.iter().zip(&solved).skip(1).zip(&gaps) {
        let title = format!("{name}: {words} of {} minus {base} in {label}", b.name);
        let figure = Figure::Map(Map {
            title,
            x: ("speed rpm".to_owned(), columns.clone()),
            y: ("torque Nm".to_owned(), lines.clone()),
            values: differences.clone(),
            diverging: true,
            hatched: solved[0]
                .points
                .iter()
                .zip(&other.points)
                .map(|(a, b)| a.outside || b.outside)
                .collect(),
            unseen: entry.accuracy,
            ..Map::default()
        });
        picture(runner, &format!("{name}-{}", b.name), figure, &entry.write)?;
    }
    let names = built.iter().skip(1).map(|b| b.name.clone());
    let lists = gaps.iter().map(|list| list.iter().flatten().copied().collect());
    let histogram = super::histograms(name, (words, label), names.zip(lists).collect());
    picture(runner, &format!("{name}-histogram"), histogram, &entry.write)?;
    let of_base = &solved[0].points;
    let parity = built.iter().zip(&solved).skip(1).map(|(b, other)| {
        let pairs = of_base.iter().zip(&other.points);
        (
            b.name.clone(),
            pairs.map(|(base, p)| Some((quantity(base)?, quantity(p)?))).collect(),
        )
    });
    let figure = super::parity(name, words, (&format!("{base}: {words}"), words), parity.collect());
    picture(runner, &format!("{name}-parity"), figure, &entry.write)
}
