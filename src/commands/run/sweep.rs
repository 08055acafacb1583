//! Losses and efficiency over the values of one path, or of two.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Extent;
use gearloss_framework::thermal::Outcome;
use gearloss_report::plot::{Line, Stroke};
use gearloss_report::{Figure, Map};
use gearloss_studies::analysis::{PointResult, merge, notes};
use gearloss_studies::study::{By, SecondEntry, SweepEntry};
use gearloss_studies::varied::{Tie, Varied};
use serde_json::{Value, json};

use super::super::solve::RPM;
use super::write::{cell, head, picture, write};
use super::{Built, Runner, gear_of, speeds, torques};
use crate::commands::run::shown::show_published;
use crate::output::{Failure, Out, Table, fixed, number};
use gearloss_studies::analyses::numbers::{tidy, word};
use gearloss_studies::analyses::shares::{Shares, together};

/// A quantity in short, in words, and how to read it.
type Shown = (&'static str, &'static str, fn(&PointResult) -> Option<f64>);

/// All points under one set at one value.
struct At<'a> {
    /// Number of the value, and of the second one.
    value: [usize; 2],
    built: Built<'a>,
    points: Vec<PointResult>,
    seen: Vec<Extent>,
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &SweepEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let words: Vec<String> = entry.values.iter().map(word).collect();
    let second_words: Vec<String> = entry.second.iter().flat_map(|s| s.values.iter().map(word)).collect();
    let paths = || std::iter::once(&entry.path).chain(entry.second.as_ref().map(|s| &s.path));
    if paths().any(|path| path == "thermal.oil") && runner.study.entry.conditions.oil_temperature.is_some() {
        let error = Diagnostic::error(
            format!("{path}.path"),
            "the conditions fix the temperature, so it cannot change",
        )
        .mend("leave `conditions.oil_temperature` out");
        return Err(runner.study.findings(vec![error]).into());
    }
    let mut all: Vec<At<'_>> = Vec::new();
    let seconds: Vec<Option<(&String, &Value)>> = match &entry.second {
        Some(second) => second.values.iter().map(|value| Some((&second.path, value))).collect(),
        None => vec![None],
    };
    for (k, second) in seconds.iter().enumerate() {
        for (i, change) in entry.values.iter().enumerate() {
            // Where every value fails it is the path that is wrong, which stands first.
            let mut changes = vec![(entry.path.clone(), change.clone(), format!("{path}.values.{i}"))];
            changes
                .extend(second.map(|(own, value)| (own.clone(), value.clone(), format!("{path}.second.values.{k}"))));
            for built in runner.built_with(gearbox, &entry.model_sets, &changes)? {
                let gear = gear_of(entry.gear.as_deref(), &built.transmission);
                let torques = torques(runner, &format!("{path}.torque"), &entry.torque, &built.transmission)?;
                let speeds = speeds(runner, &format!("{path}.speed"), &entry.speed, &built.transmission)?;
                let mut points = runner.points(&built.transmission, gear, torques, speeds);
                points.terms = entry.by == By::Term;
                let held: usize = all.iter().map(|at| at.points.len()).sum();
                runner.holds(&path, held + points.field.len(), 1)?;
                if runner.checked(&built, &points)? {
                    continue;
                }
                let solved = runner.solve(&built, &points)?;
                all.push(At {
                    value: [i, k],
                    built,
                    points: solved.points,
                    seen: solved.seen,
                });
            }
        }
    }
    if runner.only_checks {
        return Ok(());
    }
    let shares = together(all.iter().map(|at| &at.built.transmission), entry.by);
    let mut header: Vec<String> = ["model_set", "gear"].map(str::to_owned).to_vec();
    header.extend(paths().cloned());
    header.extend(
        [
            "torque_nm",
            "speed_rpm",
            "oil_temperature_degc",
            "balance",
            "status",
            "efficiency",
            "loss_w",
        ]
        .map(str::to_owned),
    );
    header.extend(shares.iter().map(|s| format!("{s}_w")));
    let (mut rows, mut results) = (Vec::new(), Vec::new());
    for at in &all {
        let gear = gear_of(entry.gear.as_deref(), &at.built.transmission);
        let mut points = Vec::new();
        let own = Shares::of(&at.built.transmission, entry.by).under(&shares);
        for p in &at.points {
            let stack = own.stack(p);
            let mut row = vec![at.built.name.clone(), gear.to_owned(), words[at.value[0]].clone()];
            row.extend(second_words.get(at.value[1]).cloned());
            row.extend([cell(Some(p.torque)), cell(Some(tidy(p.speed * RPM))), cell(p.oil)]);
            row.extend([
                p.balance.map_or("", Outcome::name).to_owned(),
                p.status.name().to_owned(),
            ]);
            row.extend([cell(p.efficiency), cell(p.loss)]);
            row.extend((0..shares.len()).map(|i| cell(stack.as_ref().map(|s| s[i]))));
            rows.push(row);
            points.push(json!({
                "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM), "oil_temperature_degc": p.oil, "balance": p.balance,
                "status": p.status, "efficiency": p.efficiency, "loss_w": p.loss, "losses_w": stack,
            }));
        }
        results.push(json!({
            "model_set": at.built.name, "gear": gear, "path": entry.path, "value": entry.values[at.value[0]],
            "second": entry.second.as_ref().map(|s| json!({ "path": s.path, "value": s.values[at.value[1]] })),
            "shares": shares, "points": points, "notes": notes(&at.built.transmission, &at.seen),
        }));
    }
    if let Some(at) = all.first() {
        let quantity = |path: &String| Varied::new(runner.language, &at.built.resolved, path, Tie::Value).ok();
        let varied: Vec<Varied> = paths().filter_map(quantity).collect();
        show_published(varied.iter(), out)?;
    }
    show(runner, name, entry, &words, &all, out)?;
    let mut value = head(runner, &all.iter().map(|at| &at.built).collect::<Vec<_>>());
    value["sweep"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    pictures(runner, name, entry, &words, &all)
}

/// Names of the sets in their order.
fn sets<'a>(all: &'a [At<'_>]) -> Vec<&'a str> {
    let first = all.iter().take_while(|at| at.value == [0, 0]);
    first.map(|at| at.built.name.as_str()).collect()
}

/// What belongs to one set and one second value, in the order of the first values.
fn of<'r, 'a>(all: &'r [At<'a>], set: &str, second: usize) -> Vec<&'r At<'a>> {
    let own = all.iter().filter(|at| at.built.name == set && at.value[1] == second);
    own.collect()
}

/// The second value in words, for headings; nothing without one.
fn beside(entry: &SweepEntry, second: usize) -> String {
    let named = |s: &SecondEntry| s.values.get(second).map(|v| format!(", {} {}", s.path, word(v)));
    entry.second.as_ref().and_then(named).unwrap_or_default()
}

fn show(
    runner: &Runner<'_>,
    name: &str,
    entry: &SweepEntry,
    words: &[String],
    all: &[At<'_>],
    out: &mut Out,
) -> Result<(), Failure> {
    let seconds = entry.second.as_ref().map_or(1, |s| s.values.len());
    for set in sets(all) {
        let mut seen = Vec::new();
        for second in 0..seconds {
            let own = of(all, set, second);
            let more = beside(entry, second);
            out.line(format!("{name}: loss in W over {}, models {set}{more}", entry.path))?;
            let mut titles = vec!["torque Nm".to_owned(), "speed rpm".to_owned()];
            titles.extend(words.iter().cloned());
            let mut table = Table::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
            for (i, point) in own[0].points.iter().enumerate() {
                let mut row = vec![format!("{}", point.torque), fixed(point.speed * RPM, 0)];
                row.extend(own.iter().map(|at| number(at.points[i].loss, 2)));
                table.row(row);
            }
            out.text(&table.render())?;
            // The transmissions differ in values only, so their notes stand in the same order.
            for at in &own {
                merge(&mut seen, &at.seen);
            }
        }
        runner.outside(&notes(&of(all, set, 0)[0].built.transmission, &seen), out);
        out.line("")?;
    }
    Ok(())
}

/// Loss and efficiency over the values, a line for each torque and speed. Values that are no numbers stand by their place.
fn pictures(
    runner: &Runner<'_>,
    name: &str,
    entry: &SweepEntry,
    words: &[String],
    all: &[At<'_>],
) -> Result<(), Failure> {
    let parsed: Option<Vec<f64>> = words.iter().map(|w| w.split(' ').next()?.parse().ok()).collect();
    let unit = words
        .first()
        .and_then(|w| w.split_once(' '))
        .map_or("", |(_, unit)| unit);
    let (places, x) = match parsed {
        Some(places) if unit.is_empty() => (places, entry.path.clone()),
        Some(places) => (places, format!("{} in {unit}", entry.path)),
        None => (
            (1..=words.len()).map(|i| i as f64).collect(),
            format!("{}: {}", entry.path, words.join(", ")),
        ),
    };
    let quantities: [Shown; 2] = [
        ("loss", "loss in W", |p| p.loss),
        ("efficiency", "efficiency in %", |p| p.efficiency.map(|e| 100.0 * e)),
    ];
    for (short, y, quantity) in quantities {
        for figure in figures(name, entry, words, all, (&places, &x), (y, quantity)) {
            let file = match &figure {
                Figure::Map(map) => format!("{name}-{short}-{}", map.title.replace([' ', ',', ':'], "")),
                _ => format!("{name}-{short}"),
            };
            picture(runner, &file, figure, &entry.write)?;
        }
    }
    Ok(())
}

/// Lines over the values of one path; a map over both for each set, torque and speed where there are two.
fn figures(
    name: &str,
    entry: &SweepEntry,
    words: &[String],
    all: &[At<'_>],
    (places, x): (&[f64], &str),
    (y, quantity): (&str, fn(&PointResult) -> Option<f64>),
) -> Vec<Figure> {
    let mut figures = Vec::new();
    let mut lines = Vec::new();
    for set in sets(all) {
        let first = of(all, set, 0);
        for (i, point) in first[0].points.iter().enumerate() {
            let at_point = format!("{} Nm, {} rpm", point.torque, fixed(point.speed * RPM, 0));
            if let Some(second) = &entry.second {
                let rows = (0..second.values.len()).flat_map(|k| of(all, set, k));
                let values: Vec<Option<f64>> = rows.map(|at| quantity(&at.points[i])).collect();
                if values.iter().any(Option::is_some) {
                    figures.push(Figure::Map(Map {
                        title: format!("{name}: {y}, models {set}, {at_point}"),
                        x: (entry.path.clone(), words.to_vec()),
                        y: (second.path.clone(), second.values.iter().map(word).collect()),
                        values,
                        ..Map::default()
                    }));
                }
                continue;
            }
            let points: Vec<_> = first
                .iter()
                .map(|at| Some((places[at.value[0]], quantity(&at.points[i])?)))
                .collect();
            if points.iter().any(Option::is_some) {
                lines.push(Line {
                    name: format!("{set}: {at_point}"),
                    points,
                    stroke: Stroke::Marked,
                });
            }
        }
    }
    if !lines.is_empty() {
        figures.push(Figure::Lines {
            title: format!("{name}: {y}"),
            x: x.to_owned(),
            y: y.to_owned(),
            lines,
        });
    }
    figures
}
