//! Tables of identifications: points, losses by mechanism, parameters, points to be measured, and the values for a study.

use std::fmt::Write as _;

use gearloss_numerics::inference::Reach;
use gearloss_studies::identify::Target;
use gearloss_studies::study::IdentifyEntry;

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::table::TableFile;
use super::super::write::{cell, keep};
use super::hold_out;
use super::outcome::Outcome;
use super::posterior;
use super::show::verdict;
use crate::output::Failure;
use gearloss_studies::analyses::numbers::tidy;

fn header(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

pub fn write(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, all: &[Outcome<'_>]) -> Result<(), Failure> {
    points(runner, name, entry, all)?;
    shares(runner, name, entry, all)?;
    parameters(runner, name, entry, all)?;
    if entry.posterior.is_some() {
        posterior::write(runner, name, entry, all)?;
    }
    if entry.hold_out.is_some() {
        hold_out::table(runner, name, entry, all)?;
    }
    if entry.next.is_some() {
        next(runner, name, entry, all)?;
    }
    for o in all {
        let file = format!("{name}-{}.yaml", o.name.replace('/', "-"));
        keep(runner.run, &file, Ok(values(name, o).into_bytes()))?;
    }
    Ok(())
}

/// One row for each measured number.
fn points(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, all: &[Outcome<'_>]) -> Result<(), Failure> {
    let header = header(&[
        "model_set",
        "line",
        "name",
        "gear",
        "torque_nm",
        "speed_rpm",
        "oil_temperature_degc",
        "quantity",
        "measured_before",
        "model_before",
        "measured",
        "model",
        "accuracy",
        "residual_before",
        "residual",
        "standardised_residual",
        "leverage",
    ]);
    let mut table = TableFile::new(runner.run, name, &entry.write, &header)?;
    let mut rows: Vec<Vec<String>> = Vec::new();
    for o in all {
        let measured = o.identification.measured();
        let leverage = o.fitted.inference.leverage();
        for (i, observation) in o.identification.observations().iter().enumerate() {
            let row = &measured.rows[observation.row];
            let (_, gear, point) = &o.calculated[1].solved.rows[observation.row];
            let [before, after] = [0, 1].map(|k| o.pairs[k][i]);
            let residual =
                |pair: gearloss_studies::identify::Pair| (pair.model - pair.measured) / observation.deviation;
            let mut cells = vec![o.name.clone(), measured.line(row), row.name.clone().unwrap_or_default()];
            cells.push(gear.clone());
            cells.extend([
                cell(measured.value(row, "torque")),
                cell(Some(tidy(point.speed * RPM))),
                cell(point.oil),
            ]);
            cells.push(observation.quantity.name().to_owned());
            let numbers = [
                before.measured,
                before.model,
                after.measured,
                after.model,
                observation.deviation,
                residual(before),
                residual(after),
                o.checks.standardised[i],
                leverage[i],
            ];
            cells.extend(numbers.map(|x| cell(Some(x))));
            rows.push(cells);
        }
    }
    table.push_all(&rows)?;
    table.finish()
}

/// Losses by mechanism at every measured point, with their bands.
fn shares(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, all: &[Outcome<'_>]) -> Result<(), Failure> {
    let header = header(&[
        "model_set",
        "line",
        "gear",
        "torque_nm",
        "speed_rpm",
        "oil_temperature_degc",
        "mechanism",
        "loss_before_w",
        "loss_w",
        "loss_low_w",
        "loss_high_w",
        "share",
        "share_low",
        "share_high",
    ]);
    let mut table = TableFile::new(runner.run, &format!("{name}-shares"), &entry.write, &header)?;
    let mut rows: Vec<Vec<String>> = Vec::new();
    for o in all {
        let Ok(shares) = &o.shares else { continue };
        for (i, breakdown) in shares.rows.iter().enumerate() {
            let (_, gear, point) = &o.calculated[1].solved.rows[i];
            let before = losses_by(o, 0, i, &shares.mechanisms);
            let sum: f64 = before.iter().sum();
            let names = shares.mechanisms.iter().copied().chain(["all"]);
            let losses = breakdown.parts.iter().chain([&breakdown.total]);
            let before = before.iter().chain([&sum]);
            for (k, ((mechanism, loss), before)) in names.zip(losses).zip(before).enumerate() {
                let band = shares.bands[i][k];
                let share = shares.share(i, k);
                let ends = share.and_then(|(_, ends)| ends);
                let mut cells = vec![
                    o.name.clone(),
                    o.identification.measured().line(&o.identification.measured().rows[i]),
                    gear.clone(),
                ];
                cells.extend([
                    cell(Some(point.torque)),
                    cell(Some(tidy(point.speed * RPM))),
                    cell(point.oil),
                ]);
                cells.push(mechanism.to_owned());
                cells.extend([cell(Some(*before)), cell(Some(loss.value))]);
                cells.extend([0, 1].map(|e| cell(band.map(|b| b[e]))));
                cells.push(cell(share.map(|(share, _)| share.value)));
                cells.extend([0, 1].map(|e| cell(ends.map(|b| b[e]))));
                rows.push(cells);
            }
        }
    }
    table.push_all(&rows)?;
    table.finish()
}

/// Losses of the mechanisms at a row, before (0) or after (1). \[W\]
pub fn losses_by(o: &Outcome<'_>, which: usize, row: usize, mechanisms: &[&'static str]) -> Vec<f64> {
    let solved = &o.calculated[which].solved;
    let (number, _, point) = &solved.rows[row];
    let parts = solved.transmissions[*number].1.parts();
    let of = |mechanism: &&str| {
        let own = parts
            .iter()
            .zip(&point.parts)
            .filter(|(part, _)| part.mechanism == *mechanism);
        own.map(|(_, watts)| watts).sum()
    };
    mechanisms.iter().map(of).collect()
}

fn parameters(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, all: &[Outcome<'_>]) -> Result<(), Failure> {
    let header = header(&[
        "model_set",
        "parameter",
        "path",
        "unit",
        "stated",
        "published",
        "start",
        "least",
        "greatest",
        "fitted",
        "low",
        "high",
        "profile_low",
        "profile_high",
        "verdict",
        "sentence",
    ]);
    let mut table = TableFile::new(runner.run, &format!("{name}-parameters"), &entry.write, &header)?;
    let mut rows: Vec<Vec<String>> = Vec::new();
    for o in all {
        let inference = &o.fitted.inference;
        for (k, (parameter, theta)) in o.identification.parameters().iter().zip(o.fitted.theta()).enumerate() {
            let interval = inference.interval(k, 0.95, 1.0).map(|i| i.ends);
            let profile = o.profiles[k].as_ref().and_then(|p| p.as_ref().ok());
            let profile = profile.filter(|p| p.ends.iter().all(|end| end.reach != Reach::Unresolved));
            let mut cells = vec![
                o.name.clone(),
                parameter.name.clone(),
                parameter.path.clone(),
                parameter.unit.symbol.to_owned(),
            ];
            cells.extend([
                cell(parameter.stated),
                cell(parameter.published()),
                cell(Some(parameter.start)),
                cell(Some(parameter.bounds[0])),
                cell(Some(parameter.bounds[1])),
                cell(Some(*theta)),
            ]);
            cells.extend([0, 1].map(|e| cell(interval.map(|i| i[e]))));
            cells.extend([0, 1].map(|e| cell(profile.map(|p| p.theta[e]))));
            cells.extend([
                verdict(inference.determination_widened(k, o.widening().unwrap_or(1.0)).verdict),
                inference.sentence(k),
            ]);
            rows.push(cells);
        }
    }
    table.push_all(&rows)?;
    table.finish()
}

fn next(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, all: &[Outcome<'_>]) -> Result<(), Failure> {
    let header = header(&[
        "model_set",
        "gear",
        "torque_nm",
        "speed_rpm",
        "oil_temperature_degc",
        "accuracy",
        "gain_alone",
        "places_in_plan",
    ]);
    let mut table = TableFile::new(runner.run, &format!("{name}-next"), &entry.write, &header)?;
    let mut rows: Vec<Vec<String>> = Vec::new();
    for o in all {
        let Some(Ok(next)) = &o.next else { continue };
        for (i, at) in next.candidates.iter().enumerate() {
            let choices = next.plan.plan.choices.iter().enumerate();
            let places: Vec<String> = choices
                .filter(|(_, choice)| choice.candidate == i)
                .map(|(place, _)| (place + 1).to_string())
                .collect();
            let mut cells = vec![o.name.clone(), next.gear.clone()];
            cells.extend([
                cell(Some(at.torque)),
                cell(Some(tidy(at.speed * RPM))),
                cell(at.oil),
                cell(Some(next.plan.deviations[i])),
                cell(Some(next.plan.gains[i])),
                places.join(" "),
            ]);
            rows.push(cells);
        }
    }
    table.push_all(&rows)?;
    table.finish()
}

/// The values as a study takes them.
fn values(name: &str, o: &Outcome<'_>) -> String {
    let mut text = format!(
        "# What `{name}` found for the models `{}`. Lines below `set` go into a study.\n",
        o.name
    );
    let theta = o.fitted.theta();
    let parameters = o.identification.parameters();
    text.push_str("conditions:\n  set:\n");
    let mut any = false;
    for (i, (parameter, value)) in parameters.iter().zip(theta).enumerate() {
        // What the points do not see at all is as it was; a curve is written where one of its torques is seen.
        let seen = |k: usize| o.fitted.inference.column(k) > 0.0;
        let unseen = match &parameter.target {
            Target::Over { torques, place: 0, .. } => !(i..i + torques.len()).any(seen),
            Target::Over { .. } => false,
            Target::Path(_) | Target::Rig(_) => !seen(i),
        };
        if unseen {
            let _ = writeln!(text, "    # not seen: {}", parameter.name);
            continue;
        }
        any |= matches!(parameter.target, Target::Path(_) | Target::Over { place: 0, .. });
        match &parameter.target {
            Target::Path(varied) => {
                for (path, own) in varied.overrides(*value) {
                    // A factor leaves each path its own unit.
                    let unit = if parameter.unit.symbol == "-" {
                        ""
                    } else {
                        parameter.unit.symbol
                    };
                    let _ = writeln!(text, "    {path}: {}", format!("{own} {unit}").trim_end());
                }
            }
            Target::Over {
                varied,
                port,
                torques,
                place: 0,
            } => {
                let factors = &theta[i..i + torques.len()];
                for path in &varied.paths {
                    let _ = writeln!(
                        text,
                        "    {path}: {{ port: {port}, torques: {torques:?}, factors: {factors:?} }}"
                    );
                }
            }
            Target::Over { .. } | Target::Rig(_) => {}
        }
    }
    if !any {
        text = text.replace("  set:\n", "  set: {}\n");
    }
    for (parameter, value) in parameters.iter().zip(theta) {
        if matches!(parameter.target, Target::Rig(_)) {
            let _ = writeln!(text, "# of the rig, under the data: {}: {value} Nm", parameter.path);
        }
    }
    text
}
