//! Models against measured points: the model minus the measurement.

use gearloss_framework::document::Diagnostic;
use gearloss_studies::analysis::{Note, PointResult, Statistics, bands};
use gearloss_studies::measured::{Measured, Row, Seen, counted};
use gearloss_studies::study::{CompareEntry, Data, Difference};
use serde_json::{Value, json};

use super::super::super::solve::RPM;
use super::super::write::{cell, head, picture, write};
use super::super::{Built, Runner};
use crate::commands::run::shown::in_file;
use crate::output::{Failure, Out, Table, number};
use gearloss_report::deviations::{self, Deviation};
use gearloss_studies::analyses::measurable::{is_measurable, note};
use gearloss_studies::analyses::numbers::tidy;
use gearloss_studies::analyses::rows::Solved;

/// One measured point beside one model.
struct Pair {
    row: usize,
    gear: String,
    torque: f64,
    speed: f64,
    oil: Option<f64>,
    measured: Option<f64>,
    model: Option<f64>,
    difference: Option<f64>,
    /// The same difference as a loss, in percent of the measured loss.
    of_loss: Option<f64>,
    /// The measured loss is too small to state a difference in percent of it.
    omitted: bool,
    /// Accuracy of the measured quantity, where a column tells it.
    accuracy: Option<f64>,
    /// How much the point counts; one where no column says it.
    weight: f64,
}

/// One set of models at all measured points.
struct Compared<'a> {
    built: Vec<Built<'a>>,
    name: String,
    pairs: Vec<Pair>,
    notes: Vec<Note>,
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &CompareEntry, data: &Data, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let bind: Vec<&str> = entry.bind.ids().collect();
    let measured = runner.read(&format!("{path}.data"), data, &bind)?;
    let data = runner.data(&format!("{path}.data"), data)?;
    for note in &measured.notes {
        out.line(format!("{name}: {}: {note}", data.file))?;
    }
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let all: Vec<Compared<'_>> = runner
        .at_rows(
            gearbox,
            &entry.against,
            &entry.bind,
            entry.gear.as_deref(),
            &measured,
            false,
        )?
        .into_iter()
        .map(|solved| compared(entry, &measured, solved))
        .collect();
    if runner.only_checks {
        return Ok(());
    }
    if all.iter().all(|c| c.pairs.iter().all(|p| p.measured.is_none())) {
        let error = Diagnostic::error(
            format!("{path}.data"),
            format!("{}: nothing gives a measured {}", data.file, entry.quantity.name()),
        )
        .mend("name a column of it, or columns of torque and speed at both ports");
        return Err(runner.study.findings(vec![error]).into());
    }
    let unit = entry.quantity.unit(entry.difference);
    let what = entry.quantity.name();
    let header = [
        "model_set",
        "line",
        "name",
        "gear",
        "torque_nm",
        "speed_rpm",
        "oil_temperature_degc",
        &format!("measured_{what}"),
        what,
        &format!("difference_{unit}"),
        "loss_difference_percent_of_loss",
        &format!("accuracy_{what}"),
    ]
    .map(str::to_owned);
    let (mut rows, mut results) = (Vec::new(), Vec::new());
    for c in &all {
        for pair in &c.pairs {
            let row = &measured.rows[pair.row];
            let mut cells = vec![c.name.clone(), measured.line(row)];
            cells.push(row.name.clone().unwrap_or_default());
            cells.push(pair.gear.clone());
            cells.extend([cell(Some(pair.torque)), cell(Some(tidy(pair.speed * RPM)))]);
            cells.extend(
                [
                    pair.oil,
                    pair.measured,
                    pair.model,
                    pair.difference,
                    pair.of_loss,
                    pair.accuracy,
                ]
                .map(cell),
            );
            rows.push(cells);
        }
        results.push(show(runner, name, entry, &measured, c, out)?);
    }
    verdict(runner, name, entry, &all, out)?;
    let built: Vec<&Built<'_>> = all.iter().flat_map(|c| &c.built).collect();
    let mut value = head(runner, &built);
    value["data"] = json!({ "file": data.file, "points": measured.rows.len(), "notes": measured.notes });
    value["comparisons"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    pictures(runner, name, entry, &all)
}

fn compared<'a>(entry: &CompareEntry, measured: &Measured, solved: Solved<'a>) -> Compared<'a> {
    let pairs = measured.rows.iter().zip(&solved.rows).enumerate();
    Compared {
        pairs: pairs
            .map(|(i, (row, (_, gear, point)))| pair(entry, measured, (i, row, gear), point))
            .collect(),
        notes: solved.notes,
        built: solved.built,
        name: solved.name,
    }
}

fn pair(entry: &CompareEntry, measured: &Measured, (i, row, gear): (usize, &Row, &str), point: &PointResult) -> Pair {
    let seen = Seen::of(measured, row, point);
    let (saw, model) = (seen.quantity(entry.quantity), entry.quantity.of(point));
    Pair {
        row: i,
        gear: gear.to_owned(),
        torque: point.torque,
        speed: point.speed,
        oil: point.oil,
        measured: saw,
        model,
        difference: saw
            .zip(model)
            .filter(|(saw, model)| entry.difference == Difference::Points || is_measurable(*saw, *model))
            .and_then(|(saw, model)| entry.quantity.difference(entry.difference, saw, model)),
        of_loss: seen
            .loss
            .zip(point.loss)
            .filter(|(saw, model)| is_measurable(*saw, *model))
            .map(|(saw, model)| 100.0 * (model - saw) / saw),
        omitted: seen
            .loss
            .zip(point.loss)
            .is_some_and(|(saw, model)| !is_measurable(saw, model)),
        accuracy: seen.accuracy(entry.quantity),
        weight: measured.value(row, "weight").unwrap_or(1.0),
    }
}

fn show(
    runner: &Runner<'_>,
    name: &str,
    entry: &CompareEntry,
    measured: &Measured,
    c: &Compared<'_>,
    out: &mut Out,
) -> Result<Value, Failure> {
    let unit = entry.quantity.unit(entry.difference);
    let of_all = Statistics::weighted(c.pairs.iter().filter_map(|p| Some((p.difference?, p.weight))));
    let of_loss = Statistics::weighted(c.pairs.iter().filter_map(|p| Some((p.of_loss?, p.weight))));
    let (words, label) = entry.quantity.words(entry.difference);
    out.line(format!("{name}: {} minus measurement, {words} in {label}", c.name))?;
    let figures = |s: &Statistics| {
        [s.least, s.greatest, s.mean, s.rms]
            .map(|x| number(Some(x), 3))
            .to_vec()
    };
    let mut table = Table::new(&["over", "points", "least", "greatest", "mean", "rms"]);
    let mut line = |over: String, s: Option<Statistics>| {
        let mut row = vec![over, s.map_or(0, |s| s.count).to_string()];
        row.extend(s.map_or_else(|| vec!["-".to_owned(); 4], |s| figures(&s)));
        table.row(row);
    };
    line("all points".to_owned(), of_all);
    line("all points, loss in % of loss".to_owned(), of_loss);
    let mut groups = Vec::new();
    for (what, unit_of, factor) in [("torque", "Nm", 1.0), ("speed", "rpm", RPM)] {
        let at: Vec<f64> = c
            .pairs
            .iter()
            .map(|p| if what == "torque" { p.torque } else { p.speed * factor })
            .collect();
        for ([from, to], places) in bands(&at) {
            let of_band = Statistics::weighted(
                places
                    .iter()
                    .filter_map(|i| Some((c.pairs[*i].difference?, c.pairs[*i].weight))),
            );
            let range = if (to - from).abs() <= 0.005 * to.abs() {
                format!("{from:.1}")
            } else {
                format!("{from:.1} to {to:.1}")
            };
            line(format!("{what} {range} {unit_of}"), of_band);
            groups.push(
                json!({ "over": what, "unit": unit_of.to_lowercase(), "from": from, "to": to, "difference": of_band }),
            );
        }
    }
    out.text(&table.render())?;
    let omitted = c.pairs.iter().filter(|p| p.omitted).count();
    if omitted > 0 {
        out.line(note(omitted, "the difference"))?;
    }
    runner.outside(&c.notes, out);
    out.line("")?;
    Ok(json!({
        "model_set": c.name,
        "quantity": entry.quantity,
        "unit": unit,
        "difference": of_all,
        "loss_difference_percent_of_loss": of_loss,
        "bands": groups,
        "notes": c.notes,
        "points": c.pairs.iter().map(|p| in_file(json!({
            "line": measured.rows[p.row].line, "name": measured.rows[p.row].name, "gear": p.gear,
            "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM), "oil_temperature_degc": p.oil,
            "measured": p.measured, "model": p.model, "difference": p.difference,
            "loss_difference_percent_of_loss": p.of_loss,
            "accuracy": p.accuracy,
        }), measured, &measured.rows[p.row])).collect::<Vec<_>>(),
    }))
}

/// Which set meets the measurement best, and whether the measurement can tell.
fn verdict(
    runner: &Runner<'_>,
    name: &str,
    entry: &CompareEntry,
    all: &[Compared<'_>],
    out: &mut Out,
) -> Result<(), Failure> {
    // Sets are ranked over the points at which every one of them has a value.
    let common = |i: &usize| all.iter().all(|c| c.pairs[*i].difference.is_some());
    let places: Vec<usize> = (0..all[0].pairs.len()).filter(common).collect();
    let rms = |c: &Compared<'_>| {
        let pairs = places.iter().map(|i| &c.pairs[*i]);
        Statistics::weighted(pairs.filter_map(|p| Some((p.difference?, p.weight)))).map(|s| s.rms)
    };
    let mut ranked: Vec<(&str, f64)> = all.iter().filter_map(|c| Some((c.name.as_str(), rms(c)?))).collect();
    ranked.sort_by(|a, b| a.1.total_cmp(&b.1));
    let [first, second, ..] = ranked[..] else {
        return Ok(());
    };
    let accuracy = accuracy(entry, &all[0]);
    let (_, unit) = entry.quantity.words(entry.difference);
    let words = format!(
        "{name}: `{}` meets the measurement best, {:.3} {unit} rms; next `{}`, {:.3}",
        first.0, first.1, second.0, second.1
    );
    let words = match all[0].pairs.len() - places.len() {
        0 => words,
        left => format!(
            "{words}, over the {} points at which all have a value; {left} are left out",
            places.len()
        ),
    };
    let sentence = match accuracy {
        Some(a) if second.1 - first.1 < a => {
            format!("{words}; indistinguishable: the measurement is accurate to {a:.3} {unit}")
        }
        _ => words,
    };
    runner.verdict(sentence, out)?;
    out.line("")?;
    Ok(())
}

/// Accuracy of the measurement, root of the mean square over the points, counted as the difference is.
fn accuracy(entry: &CompareEntry, c: &Compared<'_>) -> Option<f64> {
    let of = |p: &Pair| counted(entry.quantity, entry.difference, p.accuracy?, p.measured);
    Statistics::of(c.pairs.iter().filter_map(of))
        .map(|s| s.rms)
        .or(entry.accuracy)
}

fn points(c: &Compared<'_>) -> Vec<Deviation> {
    c.pairs
        .iter()
        .map(|p| (p.torque, p.speed * RPM, p.difference))
        .collect()
}

fn pictures(runner: &Runner<'_>, name: &str, entry: &CompareEntry, all: &[Compared<'_>]) -> Result<(), Failure> {
    let (what, unit) = entry.quantity.words(entry.difference);
    let pairs = |c: &Compared<'_>| c.pairs.iter().map(|p| Some((p.measured?, p.model?))).collect();
    let figure = super::parity(
        name,
        what,
        (&format!("measured {what}"), &format!("model {what}")),
        all.iter().map(|c| (c.name.clone(), pairs(c))).collect(),
    );
    picture(runner, &format!("{name}-parity"), figure, &entry.write)?;
    for c in all {
        let title = format!("{name}: {what} of {} minus measurement in {unit}", c.name);
        picture(
            runner,
            &format!("{name}-{}", c.name),
            deviations::picture(title, &points(c), accuracy(entry, c), None),
            &entry.write,
        )?;
    }
    let values = |c: &Compared<'_>| c.pairs.iter().filter_map(|p| p.difference).collect();
    let lists = all.iter().map(|c| (c.name.clone(), values(c))).collect();
    let histogram = super::histograms(name, (what, unit), lists);
    picture(runner, &format!("{name}-histogram"), histogram, &entry.write)
}
