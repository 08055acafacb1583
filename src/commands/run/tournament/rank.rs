//! Combinations ranked by how well they meet measured points; with factors, points that the factors were not fitted to.

use gearloss_framework::analysis::Statistics;
use gearloss_framework::inference::folds;
use gearloss_framework::least_squares::{Options, Parameter, Problem, solve};
use gearloss_framework::report::Figure;
use gearloss_framework::report::plot::{Bar, Line, Stroke};
use gearloss_framework::study::TournamentEntry;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::map::tidy;
use super::super::write::{cell, head, picture, write};
use super::{Field, Measurement, json_of, unit};
use crate::interrupt;
use crate::output::{Failure, Out, Table, number};

/// One combination against the measurement; errors in the unit of the tournament.
struct Ranked {
    places: Vec<usize>,
    /// Root of the mean square over all points, factors fitted to all.
    rms: f64,
    /// Over all points, each predicted with factors fitted to the other groups.
    predicted: f64,
    /// That of the worst group.
    worst: f64,
    /// Mean over all points.
    mean: f64,
    /// Factors of the slots; one each where none are fitted.
    factors: Vec<f64>,
    /// Slots whose factor stands on a bound.
    on_bound: Vec<usize>,
}

/// Root of the mean square of errors with their weights; absent without any that counts.
fn rms(errors: impl IntoIterator<Item = (f64, f64)>) -> Option<f64> {
    Statistics::weighted(errors).map(|s| s.rms)
}

/// The factors that fit a combination to some of the points; ones where none are fitted, absent where the fit fails.
fn factors(
    entry: &TournamentEntry,
    field: &Field<'_>,
    rows: &[Measurement],
    places: &[usize],
    of: &[usize],
) -> Option<Vec<f64>> {
    let Some(bounds) = entry.factors else {
        return Some(vec![1.0; places.len()]);
    };
    let residual = |theta: &[f64]| -> Result<Vec<f64>, String> {
        Ok(of
            .iter()
            .map(|i| rows[*i].weight.sqrt() * error(field, rows, places, theta, *i))
            .collect())
    };
    let parameters = field.slots.iter().map(|slot| {
        let start = 1.0_f64.clamp(bounds.least, bounds.greatest);
        Parameter::new(slot.name.clone(), start).within(bounds.least, bounds.greatest)
    });
    let problem = Problem::new(residual, parameters.collect());
    solve(&problem, &Options::exact()).ok().map(|fit| fit.theta)
}

/// Model minus measurement at one point, in the unit of the tournament.
fn error(field: &Field<'_>, rows: &[Measurement], places: &[usize], factors: &[f64], i: usize) -> f64 {
    let slots = field.slots.iter().zip(places).zip(factors);
    let loss = slots.fold(field.rest[i], |sum, ((slot, place), f)| {
        sum + f * slot.candidates[*place].loss[i]
    });
    (loss - rows[i].loss) * field.scale[i]
}

fn ranked(
    entry: &TournamentEntry,
    field: &Field<'_>,
    rows: &[Measurement],
    groups: &[Vec<usize>],
    places: Vec<usize>,
) -> Option<Ranked> {
    let all: Vec<usize> = (0..rows.len()).collect();
    let whole = factors(entry, field, rows, &places, &all)?;
    let errors: Vec<(f64, f64)> = all
        .iter()
        .map(|i| (error(field, rows, &places, &whole, *i), rows[*i].weight))
        .collect();
    let (mut predicted, mut worst) = (Vec::new(), 0.0_f64);
    for group in groups {
        let others: Vec<usize> = all.iter().copied().filter(|i| !group.contains(i)).collect();
        let own = factors(entry, field, rows, &places, &others)?;
        let of_group: Vec<(f64, f64)> = group
            .iter()
            .map(|i| (error(field, rows, &places, &own, *i), rows[*i].weight))
            .collect();
        // A group in which no point counts has no error.
        worst = worst.max(rms(of_group.iter().copied()).unwrap_or(0.0));
        predicted.extend(of_group);
    }
    let on_bound = entry.factors.map_or_else(Vec::new, |bounds| {
        let at = |f: f64| (f - bounds.least).abs() < 1e-9 || (f - bounds.greatest).abs() < 1e-9;
        (0..whole.len()).filter(|k| at(whole[*k])).collect()
    });
    let of_all = Statistics::weighted(errors)?;
    Some(Ranked {
        places,
        rms: of_all.rms,
        predicted: rms(predicted)?,
        worst,
        mean: of_all.mean,
        factors: whole,
        on_bound,
    })
}

pub fn show(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    gear: &str,
    rows: &[Measurement],
    field: &Field<'_>,
    out: &mut Out,
) -> Result<(), Failure> {
    let torques: Vec<f64> = rows.iter().map(|row| row.torque).collect();
    let groups = folds(&torques, entry.folds as usize).map_err(|reason| {
        let path = format!("analyses.{name}.data");
        runner.wrong(&path, reason, "give points at two torques at least")
    })?;
    let groups: Vec<Vec<usize>> = groups.into_iter().map(|fold| fold.points).collect();
    let fewest = groups.iter().map(|g| rows.len() - g.len()).min().unwrap_or(0);
    if entry.factors.is_some() && fewest < field.slots.len() {
        let message = format!(
            "{fewest} points outside of a group cannot fit {} factors",
            field.slots.len()
        );
        return Err(runner.wrong(
            &format!("analyses.{name}.data"),
            message,
            "give more points, or fewer mechanisms",
        ));
    }
    let bar = runner.bar(field.count() as u64, name);
    let mut all: Vec<Ranked> = (0..field.count())
        .into_par_iter()
        .filter_map(|number| {
            bar.inc(1);
            if interrupt::pressed() {
                return None;
            }
            ranked(entry, field, rows, &groups, field.combination(number))
        })
        .collect();
    bar.finish_and_clear();
    if interrupt::pressed() {
        return Err(Failure::Interrupted);
    }
    let unranked = field.count() - all.len();
    if unranked > 0 {
        out.line(format!(
            "{unranked} combinations could not be fitted, or have no point that counts"
        ))?;
    }
    all.sort_by(|a, b| a.predicted.total_cmp(&b.predicted));
    // Root of the mean square of the accuracies that are stated.
    let stated = rows.iter().filter_map(|row| Some((row.accuracy?, row.weight)));
    let accuracy = Statistics::weighted(stated).map(|s| s.rms);
    let best = all.first().map_or(0.0, |r| r.predicted);
    let alike = |r: &Ranked| accuracy.is_some_and(|a| r.predicted - best < a);
    table(name, entry, field, &all, &alike, out)?;
    out.line(format!(
        "{name}: {} points in {} groups of neighbouring torques; errors in {}",
        rows.len(),
        groups.len(),
        field.unit
    ))?;
    let sentence = match (accuracy, all.iter().filter(|r| alike(r)).count()) {
        (Some(a), count) if count > 1 => format!(
            "indistinguishable: {count} of {} combinations are within the accuracy of the measurement, {a:.3} {}, of the best",
            all.len(),
            field.unit
        ),
        (Some(a), _) => format!(
            "the best stands apart by more than the accuracy of the measurement, {a:.3} {}",
            field.unit
        ),
        (None, _) => "the file states no accuracy, so nothing says which differences can be seen".to_owned(),
    };
    if let Some(best) = all.first() {
        let names = field.names(&best.places).join(", ");
        let how = if entry.factors.is_some() {
            "predicted, with factors from the other groups, to"
        } else {
            "nothing fitted, meets the measurement to"
        };
        let sentence = format!(
            "best: {names}, {how} {:.3} {} rms; {sentence}",
            best.predicted, field.unit
        );
        runner.verdict(sentence, out)?;
    }
    if let Some(first) = all.first() {
        out.line(added_up(runner, field, first)?)?;
    }
    out.line("")?;
    results(runner, name, entry, gear, field, (&all, rows), accuracy)?;
    pictures(runner, name, entry, rows, field, &all)
}

/// How far losses that were added are from the combination solved as a whole.
fn added_up(runner: &Runner<'_>, field: &Field<'_>, r: &Ranked) -> Result<String, Failure> {
    let mut resolved = field.base.resolved.clone();
    for (slot, place) in field.slots.iter().zip(&r.places) {
        let candidate = &slot.candidates[*place];
        resolved = slot
            .with(runner.language, &resolved, &candidate.model)
            .map_err(|reason| Failure::input(reason, "report this"))?;
    }
    let transmission = field.base.gearbox.build(runner.language, &resolved)?;
    let list = field.points.iter().map(|p| gearloss_framework::analysis::Given {
        torque: p.torque,
        speed: p.speed,
        oil: p.oil,
    });
    let gear = field.gear.clone();
    let points = runner.listed(&transmission, &gear, list.collect());
    let solved = gearloss_framework::analysis::run_grid(&transmission, &points, &|_| !interrupt::pressed());
    let solved = solved.map_err(|list| Failure::from(field.base.gearbox.findings(list)))?;
    let solved = solved.ok_or(Failure::Interrupted)?;
    let added = field.loss(&r.places);
    let gap = solved
        .points
        .iter()
        .zip(&added)
        .filter_map(|(p, added)| Some(100.0 * (added - p.loss?) / p.loss?))
        .fold(0.0_f64, |worst, gap| if gap.abs() > worst.abs() { gap } else { worst });
    Ok(format!(
        "losses are added, each mechanism at the torques of the set: for the best combination that is {gap:.3} % of the loss off at most"
    ))
}

fn table(
    name: &str,
    entry: &TournamentEntry,
    field: &Field<'_>,
    all: &[Ranked],
    alike: &dyn Fn(&Ranked) -> bool,
    out: &mut Out,
) -> Result<(), Failure> {
    out.line(format!("{name}: the best combinations; errors in {}", field.unit))?;
    let mut head: Vec<String> = vec!["rank".to_owned()];
    head.extend(field.header());
    head.extend(["predicted rms", "worst group", "fitted rms", "mean", "time"].map(str::to_owned));
    if entry.factors.is_some() {
        head.extend(["factors", "on a bound"].map(str::to_owned));
    }
    let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for (i, r) in all.iter().take(entry.shown as usize).enumerate() {
        let mark = if alike(r) { "=" } else { "" };
        let mut row = vec![format!("{}{mark}", i + 1)];
        row.extend(field.names(&r.places).into_iter().map(str::to_owned));
        row.extend([r.predicted, r.worst, r.rms, r.mean].map(|x| number(Some(x), 3)));
        row.push(number(Some(field.time(&r.places)), 2));
        if entry.factors.is_some() {
            let factors: Vec<String> = r.factors.iter().map(|f| format!("{f:.2}")).collect();
            let bounds: Vec<&str> = r.on_bound.iter().map(|k| field.slots[*k].name.as_str()).collect();
            row.extend([factors.join(" "), bounds.join(" ")]);
        }
        table.row(row);
    }
    out.text(&table.render())?;
    Ok(())
}

fn results(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    gear: &str,
    field: &Field<'_>,
    (all, measured): (&[Ranked], &[Measurement]),
    accuracy: Option<f64>,
) -> Result<(), Failure> {
    let mut header = vec!["rank".to_owned()];
    header.extend(field.header());
    header.extend(["predicted_rms", "worst_group_rms", "fitted_rms", "mean"].map(str::to_owned));
    header.extend(field.slots.iter().map(|s| format!("factor_{}", s.name)));
    header.extend(["on_bound", "indistinguishable"].map(str::to_owned));
    let row = |(i, r): (usize, &Ranked)| {
        let mut row = vec![(i + 1).to_string()];
        row.extend(field.names(&r.places).into_iter().map(str::to_owned));
        row.extend([r.predicted, r.worst, r.rms, r.mean].map(|x| cell(Some(x))));
        row.extend(r.factors.iter().map(|f| cell(Some(*f))));
        let bounds: Vec<&str> = r.on_bound.iter().map(|k| field.slots[*k].name.as_str()).collect();
        row.push(bounds.join(" "));
        row.push(accuracy.map_or_else(String::new, |a| (r.predicted - all[0].predicted < a).to_string()));
        row
    };
    let rows: Vec<Vec<String>> = all.iter().enumerate().map(row).collect();
    let mut value = head(runner, name, &[&field.base]);
    value["tournament"] = json!({
        "model_set": field.base.name, "gear": gear, "unit": unit(entry), "combinations": all.len(), "accuracy": accuracy,
        "mechanisms": json_of(field),
        "points": measured.iter().map(|m| json!({
            "torque_nm": m.torque, "speed_rpm": tidy(m.speed * RPM), "measured_loss_w": m.loss,
            "accuracy": m.accuracy, "weight": m.weight,
        })).collect::<Vec<_>>(),
        "ranking": all.iter().map(|r| json!({
            "models": field.names(&r.places), "predicted_rms": r.predicted, "worst_group_rms": r.worst,
            "fitted_rms": r.rms, "mean": r.mean, "factors": r.factors,
            "on_bound": r.on_bound.iter().map(|k| Value::from(field.slots[*k].name.as_str())).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
    });
    write(runner, name, &entry.write, &header, &rows, &value)
}

/// The errors of the best as bars, and where each model stands at best: fitted error of the best combination with it.
fn pictures(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    rows: &[Measurement],
    field: &Field<'_>,
    all: &[Ranked],
) -> Result<(), Failure> {
    let mut bars = Vec::new();
    for (k, slot) in field.slots.iter().enumerate() {
        for (place, candidate) in slot.candidates.iter().enumerate() {
            let best = all.iter().find(|r| r.places[k] == place);
            bars.push(Bar {
                label: format!("{}\n{}", slot.name, candidate.name),
                shares: best.map(|r| r.predicted).into_iter().collect(),
                ..Bar::default()
            });
        }
    }
    let figure = Figure::Bars {
        title: format!(
            "{name}: error of the best combination with each model, in {}",
            field.unit
        ),
        over: String::new(),
        height: format!("predicted rms in {}", field.unit),
        names: vec!["predicted rms".to_owned()],
        bars,
    };
    picture(runner, &format!("{name}-models"), figure, &entry.write)?;
    let line = |r: &Ranked| Line {
        name: field.names(&r.places).join(", "),
        points: (0..rows.len())
            .map(|i| Some((tidy(rows[i].speed * RPM), error(field, rows, &r.places, &r.factors, i))))
            .collect(),
        stroke: Stroke::Dots,
    };
    let figure = Figure::Lines {
        title: format!("{name}: model minus measurement of the best three, in {}", field.unit),
        x: "speed in rpm".to_owned(),
        y: format!("error in {}", field.unit),
        lines: all.iter().take(3).map(line).collect(),
    };
    picture(runner, &format!("{name}-errors"), figure, &entry.write)
}
