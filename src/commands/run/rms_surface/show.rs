//! What is printed, drawn and written of a surface.

use gearloss_numerics::inference::Side;
use gearloss_report::{Figure, Map};
use gearloss_studies::measured::Measured;
use gearloss_studies::study::RmsSurfaceEntry;
use serde_json::{Value, json};

use super::super::Runner;
use super::super::write::picture;
use super::least::Flat;
use super::{Axis, Counted, Surface};
use crate::commands::run::shown::in_file;
use crate::output::{Failure, Out, Table, number};
use gearloss_report::text::spread;

/// Points that are named one by one.
const NAMED: usize = 5;

/// Says which points count nowhere.
pub fn left_out(name: &str, measured: &Measured, counted: &Counted, out: &mut Out) -> Result<(), Failure> {
    if counted.left_out.is_empty() {
        return Ok(());
    }
    out.line(format!(
        "{name}: {} of {} points lack a value somewhere and are left out of all pairs:",
        counted.left_out.len(),
        measured.rows.len()
    ))?;
    for (i, why) in counted.left_out.iter().take(NAMED) {
        out.line(format!("  line {}: {why}", measured.rows[*i].line))?;
    }
    if counted.left_out.len() > NAMED {
        out.line(format!("  and {} more", counted.left_out.len() - NAMED))?;
    }
    Ok(())
}

/// A table of the surface and what it says.
pub fn show(
    runner: &Runner<'_>,
    name: &str,
    entry: &RmsSurfaceEntry,
    counted: &Counted,
    s: &Surface<'_>,
    out: &mut Out,
) -> Result<(), Failure> {
    let (what, unit) = entry.quantity.words(entry.difference);
    let [x, y] = &s.axes;
    out.line(format!(
        "{name}: {what} of {} minus measurement, rms in {unit} over {} points, over {}",
        s.built.name,
        counted.places.len(),
        x.varied.pattern
    ))?;
    let shown = spread(x.values.len());
    let mut titles = vec![y.varied.pattern.clone()];
    titles.extend(shown.iter().map(|i| x.varied.words(x.values[*i])));
    let mut table = Table::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
    for j in spread(y.values.len()) {
        let mut row = vec![y.varied.words(y.values[j])];
        row.extend(shown.iter().map(|i| number(s.rms[j * x.values.len() + i], 3)));
        table.row(row);
    }
    out.text(&table.render())?;
    let without = s
        .pairs
        .iter()
        .filter_map(|pair| Some((pair, pair.differences.as_ref().err()?)));
    for (n, (pair, why)) in without.enumerate() {
        if n == NAMED {
            out.line("further pairs have no value")?;
            break;
        }
        out.line(format!("no value at {}: {why}", pair.words(&s.axes)))?;
    }
    runner.verdict(
        format!("{name}: `{}`: {}", s.built.name, verdict(s, unit, counted.accuracy)),
        out,
    )?;
    out.line("")?;
    Ok(())
}

/// Where the least value lies and how well that is known.
fn verdict(s: &Surface<'_>, unit: &str, accuracy: Option<f64>) -> String {
    let least = &s.least;
    let at = |axis: &Axis, place: usize| axis.varied.words(axis.values[place]);
    let mut places = Vec::new();
    let (mut on, mut nothing) = (Vec::new(), Vec::new());
    for (k, axis) in s.axes.iter().enumerate() {
        let (pattern, value) = (&axis.varied.pattern, at(axis, least.place[k]));
        if !least.depends[k] {
            nothing.push(pattern.as_str());
            continue;
        }
        places.push(format!("{pattern} = {value}"));
        match least.ends[k] {
            Some(Side::Upper) => on.push(format!(
                "the upper end of {pattern}: the fit would go on beyond {value}"
            )),
            Some(Side::Lower) => on.push(format!("the lower end of {pattern}: the fit would go on below {value}")),
            None => {}
        }
    }
    let mut said = format!("least rms {:.3} {unit}", least.value);
    if places.is_empty() {
        return format!("{said} all over: {} change nothing", nothing.join(" and "));
    }
    said.push_str(&format!(" at {}", places.join(", ")));
    if on.is_empty() {
        said.push_str(", inside of the surface");
    } else {
        said.push_str(&format!(", on {}", on.join(", and on ")));
    }
    for pattern in &nothing {
        said.push_str(&format!("; {pattern} changes nothing"));
    }
    let flat = |flat: &Flat| {
        let range = |k: usize| {
            let ([low, high], axis) = (flat[k], &s.axes[k]);
            let whole = low == 0 && high + 1 == axis.values.len();
            let pattern = &axis.varied.pattern;
            match (whole, low == high) {
                (true, _) => format!("any {pattern}"),
                (_, true) => format!("{pattern} {} alone", at(axis, low)),
                _ => format!("{pattern} {} to {}", at(axis, low), at(axis, high)),
            }
        };
        let ranges: Vec<String> = (0..2).filter(|k| least.depends[*k]).map(range).collect();
        ranges.join(", ")
    };
    said.push_str(&format!("; within 5 % of it: {}", flat(&least.close)));
    if let (Some(unseen), Some(accuracy)) = (&least.unseen, accuracy) {
        said.push_str(&format!(
            "; within the accuracy of one measurement, {accuracy:.3}: {}",
            flat(unseen)
        ));
    }
    said
}

pub fn picture_of(runner: &Runner<'_>, name: &str, entry: &RmsSurfaceEntry, s: &Surface<'_>) -> Result<(), Failure> {
    let (what, unit) = entry.quantity.words(entry.difference);
    let [x, y] = &s.axes;
    let labels = |axis: &Axis| {
        let words = axis.values.iter().map(|value| axis.varied.words(*value));
        (axis.varied.pattern.clone(), words.collect())
    };
    let figure = Figure::Map(Map {
        title: format!("{name}: {what} of {} minus measurement, rms in {unit}", s.built.name),
        x: labels(x),
        y: labels(y),
        values: s.rms.clone(),
        crossed: Some((
            s.least.place[1] * x.values.len() + s.least.place[0],
            format!("least, {:.3}", s.least.value),
        )),
        ..Map::default()
    });
    picture(runner, &format!("{name}-{}", s.built.name), figure, &entry.write)
}

pub fn result(file: &str, entry: &RmsSurfaceEntry, measured: &Measured, counted: &Counted, s: &Surface<'_>) -> Value {
    let axis = |axis: &Axis| {
        json!({
            "path": axis.varied.pattern, "paths": axis.varied.paths, "unit": axis.varied.unit.symbol, "values": axis.values,
        })
    };
    let least = &s.least;
    let value = |k: usize, place: usize| s.axes[k].values[place];
    let flat = |flat: &Flat| {
        let [x, y] = [0, 1].map(|k| flat[k].map(|place| value(k, place)));
        json!({ "x": x, "y": y })
    };
    let end = |k: usize| least.ends[k].map(Side::name);
    let left_out = |(i, why): &(usize, String)| {
        let row = &measured.rows[*i];
        in_file(
            json!({ "line": row.line, "name": row.name, "reason": why }),
            measured,
            row,
        )
    };
    let pairs = s.pairs.iter().zip(&s.rms).map(|(pair, rms)| {
        json!({ "x": pair.at[0], "y": pair.at[1], "rms": rms, "reason": pair.differences.as_ref().err() })
    });
    json!({
        "model_set": s.built.name, "file": file, "quantity": entry.quantity,
        "unit": entry.quantity.unit(entry.difference), "points": counted.places.len(),
        "left_out": counted.left_out.iter().map(left_out).collect::<Vec<_>>(), "accuracy": counted.accuracy,
        "x": axis(&s.axes[0]), "y": axis(&s.axes[1]), "pairs": pairs.collect::<Vec<_>>(),
        "least": {
            "x": value(0, least.place[0]), "y": value(1, least.place[1]), "rms": least.value,
            "x_end": end(0), "y_end": end(1), "x_depends": least.depends[0], "y_depends": least.depends[1],
            "close": flat(&least.close), "within_accuracy": least.unseen.as_ref().map(flat),
        },
    })
}
