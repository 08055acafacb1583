//! Several models of one component over speed, term by term, with measured points beside them.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{PartLoss, Point};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loss::Term;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::{Case, Transmission};
use gearloss_report::Figure;
use gearloss_report::plot::{Line, Stroke};
use gearloss_studies::analysis::{Note, Points, notes};
use gearloss_studies::study::{ComponentCompareEntry, Data};
use serde_json::{Value, json};

use super::super::solve::RPM;
use super::write::{cell, head, picture, write};
use super::{Built, Runner, speeds, torques};
use crate::output::{Failure, Out, Table, fixed, number};
use gearloss_report::text::spread;
use gearloss_studies::analyses::measurable::{is_measurable, note};
use gearloss_studies::analyses::numbers::tidy;

/// The component under one model at one point.
struct Answer {
    torque: f64,
    speed: f64,
    loss: PartLoss,
}

/// One model with its answers.
struct Model<'a> {
    built: Built<'a>,
    gear: String,
    terms: &'static [Term],
    answers: Vec<Answer>,
    notes: Vec<Note>,
}

/// One measured point. \[Nm, rad/s, W\]
struct Measured {
    torque: f64,
    speed: f64,
    watts: f64,
}

/// The slot of a component: drags are slots themselves.
fn slot(component: &str) -> String {
    if component.contains(".drag.") {
        component.to_owned()
    } else {
        format!("{component}.model")
    }
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &ComponentCompareEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let own = runner.built(gearbox, entry.model_set.as_slice())?;
    // A drag may come with the models.
    let known = |b: &Built<'_>| b.transmission.parts().iter().any(|part| part.path == entry.component);
    if !entry.component.contains(".drag.") && !own.iter().any(known) {
        return Err(no_part(runner, &path, &entry.component, &own[0].transmission));
    }
    let torques = torques(runner, &format!("{path}.torque"), &entry.torque, &own[0].transmission)?;
    let speeds = speeds(runner, &format!("{path}.speed"), &entry.speed, &own[0].transmission)?;
    runner.holds(&path, torques.len().saturating_mul(speeds.len()), entry.models.len())?;
    let points: Vec<(f64, f64)> = torques
        .iter()
        .flat_map(|t| speeds.iter().map(move |w| (*t, *w)))
        .collect();
    let measured = match &entry.measured {
        Some(data) => measured(runner, &format!("{path}.measured"), data)?,
        None => Vec::new(),
    };
    names(runner, &path, entry)?;
    // What one model cannot do keeps no other from its answers.
    let (mut models, mut failed) = (Vec::new(), String::new());
    for (model, value) in entry.models.iter() {
        match answered(runner, &path, entry, gearbox, (model, value), &points, &measured) {
            Ok(model) => models.push(model),
            Err(failure) => match failure.text() {
                Some(text) => failed.push_str(&text),
                None => return Err(failure),
            },
        }
    }
    if runner.only_checks && failed.is_empty() {
        return Ok(());
    }
    if models.is_empty() || runner.only_checks {
        return Err(Failure::Input(failed));
    }
    let rows = rows(&models, &measured);
    show(name, entry, &models, &torques, &speeds, out)?;
    figures(runner, name, entry, &models, &measured, (&torques, &speeds))?;
    let deviations = deviations(&models, &points, &measured);
    for (model, mean, rms, count) in &deviations {
        out.line(format!(
            "{model}: model minus measurement {} % in the mean, {} % rms, {} points",
            number(Some(*mean), 1),
            number(Some(*rms), 1),
            count
        ))?;
    }
    let omitted = |model: &Model<'_>| {
        let pairs = model.answers[points.len()..].iter().zip(&measured);
        pairs
            .filter(|(answer, m)| watts(answer).is_some_and(|w| !is_measurable(m.watts, w)))
            .count()
    };
    let omitted = models.iter().map(omitted).max().unwrap_or(0);
    if omitted > 0 {
        out.line(note(omitted, "the model minus measurement"))?;
    }
    out.line("")?;
    let header = [
        "model",
        "torque_nm",
        "speed_rpm",
        "term",
        "loss_w",
        "moment_of_one_nm",
        "undefined",
    ]
    .map(str::to_owned);
    let mut value = head(runner, &models.iter().map(|m| &m.built).collect::<Vec<_>>());
    let given = runner.points(&models[0].built.transmission, "", Vec::new(), Vec::new());
    value["component_comparison"] = json!({
        "component": entry.component,
        "model_set": entry.model_set,
        "gear": models[0].gear,
        "oil_temperature_degc": given.oil.given(),
        "models": models.iter().map(|m| json_of(m, points.len())).collect::<Vec<_>>(),
        "measured": measured.iter().map(|m| json!({
            "torque_nm": m.torque, "speed_rpm": tidy(m.speed * RPM), "loss_w": m.watts,
        })).collect::<Vec<_>>(),
        "deviations": deviations.iter().map(|(model, mean, rms, count)| json!({
            "model": model, "count": count, "mean_percent": mean, "rms_percent": rms,
        })).collect::<Vec<_>>(),
    });
    write(runner, name, &entry.write, &header, &rows, &value)?;
    if failed.is_empty() {
        Ok(())
    } else {
        Err(Failure::Input(failed))
    }
}

/// The models must be there, and none may be called as the measured points are.
fn names(runner: &Runner<'_>, path: &str, entry: &ComponentCompareEntry) -> Result<(), Failure> {
    let path = format!("{path}.models");
    let fault = |message: &str, mend: &str| -> Failure {
        let error = Diagnostic::error(path.clone(), message).mend(mend);
        runner.study.findings(vec![error]).into()
    };
    if entry.models.is_empty() {
        return Err(fault(
            "no model is named",
            "write `models: { ours: { type: skf } }`, say",
        ));
    }
    if entry.models.iter().any(|(name, _)| name == "measured") {
        return Err(fault(
            "`measured` is the name of the measured points",
            "call the model otherwise",
        ));
    }
    Ok(())
}

/// One model at all points, then at the measured ones.
fn answered<'a>(
    runner: &'a Runner<'_>,
    path: &str,
    entry: &ComponentCompareEntry,
    gearbox: &'a Gearbox,
    (model, value): (&str, &Value),
    points: &[(f64, f64)],
    measured: &[Measured],
) -> Result<Model<'a>, Failure> {
    let mut choice: Choice = runner.study.choice(entry.model_set.as_deref());
    choice
        .overrides
        .extend(entry.set.iter().map(|(path, value)| (path.to_owned(), value.clone())));
    choice.overrides.push((slot(&entry.component), value.clone()));
    let own = (slot(&entry.component), format!("{path}.models.{model}"));
    let (resolved, transmission) = runner.study.built(runner.language, gearbox, &choice, &[own])?;
    let first = transmission.states().first().map_or("", |s| s.name.as_str());
    let gear = entry.gear.clone().unwrap_or_else(|| first.to_owned());
    let part = transmission.parts().iter().position(|p| p.path == entry.component);
    let Some(part) = part else {
        return Err(no_part(runner, path, &entry.component, &transmission));
    };
    let given = runner.points(&transmission, &gear, Vec::new(), Vec::new());
    let case = runner.case(gearbox, &transmission, &given)?;
    let all: Vec<(f64, f64)> = points
        .iter()
        .copied()
        .filter(|_| !runner.only_checks)
        .chain(measured.iter().map(|m| (m.torque, m.speed)))
        .collect();
    let (answers, seen) = answers(runner, &transmission, (&given, &case), part, &all);
    let instance = transmission.parts()[part].notes.instance();
    Ok(Model {
        terms: transmission.instances()[instance].entry.terms,
        notes: seen,
        gear,
        built: Built {
            name: model.to_owned(),
            gearbox,
            resolved,
            transmission,
        },
        answers,
    })
}

fn no_part(runner: &Runner<'_>, path: &str, component: &str, transmission: &Transmission) -> Failure {
    let paths: Vec<&str> = transmission.parts().iter().map(|p| p.path.as_str()).collect();
    let error = gearloss_framework::attach::dangling(&format!("{path}.component"), "component", component, &paths);
    runner.study.findings(vec![error]).into()
}

fn answers(
    runner: &Runner<'_>,
    transmission: &Transmission,
    (given, case): (&Points, &Case),
    part: usize,
    points: &[(f64, f64)],
) -> (Vec<Answer>, Vec<Note>) {
    let mut scratch = transmission.scratch(case);
    let answers = points
        .iter()
        .map(|(torque, speed)| {
            let torques = [*torque];
            let point = Point {
                speeds: &[*speed],
                torques: &torques[..case.torque_ports.len()],
                flow: given.flow,
                tolerance: Tolerance::default(),
            };
            let warm = given.oil.find(transmission, case, &point, &mut scratch);
            let solution = transmission.evaluate(case, &point, warm.temperatures(), &mut scratch);
            let loss = solution.explain(part).0;
            Answer {
                torque: *torque,
                speed: *speed,
                loss,
            }
        })
        .collect();
    runner.seen(transmission, &scratch.totals);
    (answers, notes(transmission, &scratch.totals))
}

/// Loss of all copies, where it has a value.
fn watts(answer: &Answer) -> Option<f64> {
    answer.loss.result.is_ok().then(|| answer.loss.watts())
}

/// Every model at every point, the measured ones included.
fn rows(models: &[Model<'_>], measured: &[Measured]) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    let mut row = |model: &str, torque: f64, speed: f64, term: &str, rest: [String; 3]| {
        let mut cells = vec![
            model.to_owned(),
            cell(Some(torque)),
            cell(Some(tidy(speed * RPM))),
            term.to_owned(),
        ];
        cells.extend(rest);
        rows.push(cells);
    };
    for model in models {
        for answer in &model.answers {
            let reason = answer.loss.result.err().map_or_else(String::new, |u| u.to_string());
            let (name, t, w) = (&model.built.name, answer.torque, answer.speed);
            let whole = [cell(watts(answer)), cell(answer.loss.moment()), reason.clone()];
            row(name, t, w, "total", whole);
            for term in model.terms {
                let power = watts(answer).map(|_| answer.loss.term_watts(term.index));
                row(name, t, w, term.name, [cell(power), String::new(), reason.clone()]);
            }
        }
    }
    for point in measured {
        let rest = [cell(Some(point.watts)), String::new(), String::new()];
        row("measured", point.torque, point.speed, "total", rest);
    }
    rows
}

fn json_of(model: &Model<'_>, points: usize) -> Value {
    let describe = |answers: &[Answer]| -> Vec<Value> {
        answers
            .iter()
            .map(|a| {
                let terms: serde_json::Map<String, Value> = model
                    .terms
                    .iter()
                    .map(|t| (t.name.to_owned(), json!(watts(a).map(|_| a.loss.term_watts(t.index)))))
                    .collect();
                json!({
                    "torque_nm": a.torque,
                    "speed_rpm": tidy(a.speed * RPM),
                    "loss_w": watts(a),
                    "moment_of_one_nm": a.loss.moment(),
                    "terms_w": terms,
                    "undefined": a.loss.result.err().map(|u| u.to_string()),
                })
            })
            .collect()
    };
    json!({
        "model": model.built.name,
        "points": describe(&model.answers[..points]),
        "at_measured": describe(&model.answers[points..]),
        "notes": model.notes,
    })
}

fn show(
    name: &str,
    entry: &ComponentCompareEntry,
    models: &[Model<'_>],
    torques: &[f64],
    speeds: &[f64],
    out: &mut Out,
) -> Result<(), Failure> {
    let shown = spread(speeds.len());
    for (t, torque) in torques.iter().enumerate() {
        out.line(format!("{name}: loss in W of {}, {torque} Nm", entry.component))?;
        let mut titles = vec!["model".to_owned(), "term".to_owned()];
        titles.extend(shown.iter().map(|i| format!("{} rpm", fixed(speeds[*i] * RPM, 0))));
        let mut table = Table::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
        for model in models {
            let at = |i: usize| &model.answers[t * speeds.len() + i];
            let mut row = vec![model.built.name.clone(), "total".to_owned()];
            row.extend(shown.iter().map(|i| number(watts(at(*i)), 3)));
            table.row(row);
            for term in model.terms.iter().filter(|_| model.terms.len() > 1) {
                let mut row = vec![String::new(), term.name.to_owned()];
                row.extend(shown.iter().map(|i| {
                    let answer = at(*i);
                    number(watts(answer).map(|_| answer.loss.term_watts(term.index)), 3)
                }));
                table.row(row);
            }
        }
        out.text(&table.render())?;
        out.line("")?;
    }
    Ok(())
}

/// Loss over speed, one picture for each torque; measured points beside the models.
fn figures(
    runner: &Runner<'_>,
    name: &str,
    entry: &ComponentCompareEntry,
    models: &[Model<'_>],
    measured: &[Measured],
    (torques, speeds): (&[f64], &[f64]),
) -> Result<(), Failure> {
    for (t, torque) in torques.iter().enumerate() {
        let line = |model: &Model<'_>| Line {
            name: model.built.name.clone(),
            points: (0..speeds.len())
                .map(|i| Some((speeds[i] * RPM, watts(&model.answers[t * speeds.len() + i])?)))
                .collect(),
            stroke: Stroke::Marked,
        };
        let mut lines: Vec<Line> = models.iter().map(line).collect();
        let near = |m: &&Measured| (m.torque - torque).abs() <= 0.02 * torque.abs().max(1e-9);
        let points: Vec<_> = measured
            .iter()
            .filter(near)
            .map(|m| Some((m.speed * RPM, m.watts)))
            .collect();
        if !points.is_empty() {
            lines.push(Line {
                name: "measured".to_owned(),
                points,
                stroke: Stroke::Dots,
            });
        }
        let figure = Figure::Lines {
            title: format!("{name}: loss of {}, {torque} Nm", entry.component),
            x: "speed in rpm".to_owned(),
            y: "loss in W".to_owned(),
            lines,
        };
        picture(runner, &format!("{name}-{torque}Nm"), figure, &entry.write)?;
    }
    Ok(())
}

/// Mean and rms deviation from the measured points in percent and their number, by model; points without a value are left
/// out.
fn deviations(models: &[Model<'_>], points: &[(f64, f64)], measured: &[Measured]) -> Vec<(String, f64, f64, usize)> {
    models
        .iter()
        .filter_map(|model| {
            let gaps: Vec<f64> = model.answers[points.len()..]
                .iter()
                .zip(measured)
                .filter_map(|(answer, m)| watts(answer).map(|w| (w, m.watts)))
                .filter(|(computed, seen)| is_measurable(*seen, *computed))
                .map(|(computed, seen)| 100.0 * (computed - seen) / seen)
                .collect();
            let count = gaps.len() as f64;
            (!gaps.is_empty()).then(|| {
                let mean = gaps.iter().sum::<f64>() / count;
                let rms = (gaps.iter().map(|g| g * g).sum::<f64>() / count).sqrt();
                (model.built.name.clone(), mean, rms, gaps.len())
            })
        })
        .collect()
}

/// Reads measured points.
fn measured(runner: &Runner<'_>, path: &str, data: &Data) -> Result<Vec<Measured>, Failure> {
    let read = runner.read_at_ports(path, data, &[])?;
    let mut points = Vec::new();
    for row in &read.rows {
        let value = |quantity: &str| read.value(row, quantity);
        let loss = value("loss").filter(|watts| *watts > 0.0);
        let (Some(torque), Some(speed), Some(watts)) = (value("torque"), value("speed"), loss) else {
            let file = &runner.data(path, data)?.file;
            let message = format!("{file}: {}: no loss above zero", read.origin(row));
            return Err(runner.wrong(path, message, "give the loss of the component in a column `loss [W]`"));
        };
        points.push(Measured { torque, speed, watts });
    }
    Ok(points)
}
