//! How well models meet a measurement over two quantities of the gearbox.

mod least;
mod show;
mod solve;

use gearloss_framework::resolve::matches;
use gearloss_studies::measured::Measured;
use gearloss_studies::study::{RmsSurfaceEntry, SurfaceAxisEntry};
use gearloss_studies::varied::Varied;
use serde_json::Value;

use self::least::Least;
use self::solve::Pair;
use super::write::{cell, head, write};
use super::{Built, Runner};
use crate::output::{Failure, Out};
use gearloss_studies::analyses::measurable::countable;
use gearloss_studies::analyses::ranges::varied;
use gearloss_studies::analyses::trial::Left;

/// A quantity and its values, rising, in its unit.
struct Axis {
    varied: Varied,
    values: Vec<f64>,
}

/// A surface of one set of models.
struct Surface<'a> {
    built: Built<'a>,
    /// x and y.
    axes: [Axis; 2],
    /// Every pair, x first.
    pairs: Vec<Pair>,
    /// Root of the mean square at each pair, over the points that count everywhere.
    rms: Vec<Option<f64>>,
    least: Least,
}

/// Which points count.
struct Counted {
    /// Rows that have a value at every pair of every set.
    places: Vec<usize>,
    /// The others, with the reason.
    left_out: Vec<(usize, String)>,
    /// Accuracy of the measurement, in the unit of the difference.
    accuracy: Option<f64>,
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &RmsSurfaceEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    countable(runner, &path, entry.quantity, entry.difference)?;
    let bind: Vec<&str> = entry.bind.ids().collect();
    let measured = runner.read(&format!("{path}.data"), &entry.data, &bind)?;
    let file = &runner.data(&format!("{path}.data"), &entry.data)?.file;
    for note in &measured.notes {
        out.line(format!("{name}: {file}: {note}"))?;
    }
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let rows = runner.study.rows(&measured, &entry.bind, entry.gear.as_deref(), false);
    let mut sets = Vec::new();
    for built in runner.built(gearbox, &entry.against)? {
        let axes = axes(runner, &path, entry, &measured, &built)?;
        runner.rows_fit(&rows, built.gearbox, &runner.study.choice(built.set()))?;
        sets.push((built, axes));
    }
    if runner.only_checks {
        return Ok(());
    }
    let mut seen = Left::new();
    let mut solved = Vec::new();
    for (built, axes) in &sets {
        solved.push(solve::pairs(runner, entry, built, axes, &rows, &mut seen)?);
    }
    runner.left_at_samples(&seen, out);
    let counted = solve::counted_points(runner, &path, entry, &measured, &sets, &solved)?;
    let mut all = Vec::new();
    for ((built, axes), pairs) in sets.into_iter().zip(solved) {
        let rms: Vec<Option<f64>> = pairs.iter().map(|pair| pair.rms(&measured, &counted.places)).collect();
        let Some(least) = Least::of(&rms, axes[0].values.len(), counted.accuracy) else {
            let why = pairs.iter().find_map(|pair| pair.differences.as_ref().err());
            let message = format!(
                "models {}: no pair has a value: {}",
                built.name,
                why.map_or("no point has one", String::as_str)
            );
            return Err(runner.wrong(&path, message, "move the values of `x` and `y`"));
        };
        all.push(Surface {
            built,
            axes,
            pairs,
            rms,
            least,
        });
    }
    show::left_out(name, &measured, &counted, out)?;
    let unit = entry.quantity.unit(entry.difference);
    let header = [
        "model_set",
        &entry.x.path,
        &entry.y.path,
        "points",
        &format!("rms_{unit}"),
    ]
    .map(str::to_owned);
    let (mut table, mut results) = (Vec::new(), Vec::new());
    for surface in &all {
        show::show(runner, name, entry, &counted, surface, out)?;
        for (pair, rms) in surface.pairs.iter().zip(&surface.rms) {
            let mut row = vec![
                surface.built.name.clone(),
                cell(Some(pair.at[0])),
                cell(Some(pair.at[1])),
            ];
            row.push(if rms.is_some() { counted.places.len() } else { 0 }.to_string());
            row.push(cell(*rms));
            table.push(row);
        }
        results.push(show::result(&file.to_string(), entry, &measured, &counted, surface));
    }
    let mut value = head(runner, &all.iter().map(|surface| &surface.built).collect::<Vec<_>>());
    value["surfaces"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &table, &value)?;
    all.iter()
        .try_for_each(|surface| show::picture_of(runner, name, entry, surface))
}

/// Both axes under one set.
fn axes(
    runner: &Runner<'_>,
    path: &str,
    entry: &RmsSurfaceEntry,
    measured: &Measured,
    built: &Built<'_>,
) -> Result<[Axis; 2], Failure> {
    let x = axis(runner, &format!("{path}.x"), &entry.x, built)?;
    let y = axis(runner, &format!("{path}.y"), &entry.y, built)?;
    let shared = |a: &[String], b: &[String]| a.iter().any(|path| b.contains(path));
    if shared(&x.varied.paths, &y.varied.paths) {
        let message = format!(
            "`{}` and `{}` change the same value",
            x.varied.pattern, y.varied.pattern
        );
        return Err(runner.wrong(
            &format!("{path}.y.path"),
            message,
            "name another quantity for one of them",
        ));
    }
    for (key, axis) in [("x", &x), ("y", &y)] {
        let wrong = |message: String, mend: &str| runner.wrong(&format!("{path}.{key}.path"), message, mend);
        for (column, pattern) in entry.bind.iter() {
            if shared(&axis.varied.paths, &matches(&built.resolved.value, pattern)) {
                let message = format!("column `{column}` of the data changes `{}` too", axis.varied.pattern);
                return Err(wrong(
                    message,
                    "leave the column out of `bind`, or name another quantity",
                ));
            }
        }
        let oil = axis.varied.paths.iter().any(|path| path == "thermal.oil");
        if oil && measured.holds("oil_temperature") {
            let message = "the data give the temperature of every point, so it cannot change".to_owned();
            return Err(wrong(message, "name another quantity"));
        }
    }
    Ok([x, y])
}

fn axis(runner: &Runner<'_>, path: &str, entry: &SurfaceAxisEntry, built: &Built<'_>) -> Result<Axis, Failure> {
    let varied = varied(runner, &format!("{path}.path"), (&entry.path, entry.tie), built)?;
    let mut values: Vec<f64> = Vec::new();
    for (i, written) in entry.values.iter().enumerate() {
        let wrong = |message: String, mend: &str| {
            let message = format!("{}: {message}", entry.path);
            runner.wrong(&format!("{path}.values.{i}"), message, mend)
        };
        let value = varied
            .quantity(written, false)
            .map_err(|reason| wrong(reason, "write a quantity of the path, such as `5 mm`"))?;
        let [least, greatest] = varied.range;
        if value < least || value > greatest {
            let message = format!("{} is outside of {least} to {greatest}", varied.words(value));
            return Err(wrong(message, "leave it out"));
        }
        if values.last().is_some_and(|last| *last >= value) {
            return Err(wrong(
                "the values do not rise all along".to_owned(),
                "sort them, and name each once",
            ));
        }
        values.push(value);
    }
    Ok(Axis { varied, values })
}
