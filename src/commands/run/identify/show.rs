//! A fit on the terminal: a table of the parameters, and what the points say in sentences.

use gearloss_numerics::inference::{Accuracy, Fold, Reach, Verdict};
use gearloss_numerics::least_squares::{Minimum, Status};
use gearloss_studies::identify::{Identified, group_words};
use gearloss_studies::study::{Difference, FoldsEntry, IdentifyEntry, RuleEntry};

use super::super::super::solve::RPM;
use super::super::Runner;
use super::hold_out;
use super::outcome::Outcome;
use super::posterior;
use crate::output::{Failure, Out, Table, figures, fixed};

/// Condition of unit columns from which on it is told, and from which on it is a warning.
const CONDITION: [f64; 2] = [30.0, 1000.0];
/// Singular value of columns times sizes above which a combination is resolved: a 95 % half-width under half of the size.
pub const RESOLVED: f64 = 4.0;

/// Other minima that are printed, and the distance in standard errors from which on a parameter differs there.
const MINIMA: usize = 5;
const DIFFERS: f64 = 0.5;
/// Relative difference from which on a parameter without a standard error differs.
const APART: f64 = 0.01;
/// Residual below which nothing but rounding is left.
const ROUNDING: f64 = 1e-6;

/// A verdict in two or three words.
pub fn verdict(verdict: Verdict) -> String {
    match verdict {
        Verdict::Held => "held".to_owned(),
        Verdict::OnBound(side) => format!("on its {} bound", side.name()),
        Verdict::NotSeen => "not seen".to_owned(),
        Verdict::WellDetermined => "well determined".to_owned(),
        Verdict::OnlyInCombination => "only in combination".to_owned(),
        Verdict::RoughlyDetermined => "roughly determined".to_owned(),
        Verdict::NotDetermined => "not determined".to_owned(),
    }
}

pub fn short(x: f64) -> String {
    figures(x, 4)
}

pub fn span(ends: [f64; 2]) -> String {
    format!("{} to {}", short(ends[0]), short(ends[1]))
}

pub fn show(
    runner: &Runner<'_>,
    name: &str,
    entry: &IdentifyEntry,
    o: &Outcome<'_>,
    out: &mut Out,
) -> Result<(), Failure> {
    search(name, o, out)?;
    misfit(runner, name, o, out)?;
    parameters(o, out)?;
    posterior::show(runner, name, o, out)?;
    let inference = &o.fitted.inference;
    for (k, parameter) in inference.parameters().iter().enumerate() {
        let found = inference.determination_widened(k, o.widening().unwrap_or(1.0));
        if found.verdict != Verdict::WellDetermined {
            out.line(format!("`{}` {}", parameter.name, inference.sentence(k)))?;
        }
    }
    resolved(runner, name, o, out)?;
    for words in o.checks.words(&o.identification) {
        runner.verdict(format!("{name}: {words}"), out)?;
    }
    folds(name, entry, o, out)?;
    hold_out::show(runner, name, o, out)?;
    if let Err(reason) = &o.shares {
        out.line(format!("no bands on the losses: {reason}"))?;
    }
    next(runner, name, entry, o, out)?;
    runner.outside(&o.notes, out);
    out.line("")?;
    Ok(())
}

/// How many combinations of parameters the points tell.
fn resolved(runner: &Runner<'_>, name: &str, o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    let inference = &o.fitted.inference;
    let sized = inference.sized_singular_values();
    if sized.is_empty() {
        return runner.verdict(
            format!("{name}: no parameter is free: each is held or stands on a bound"),
            out,
        );
    }
    let resolved = sized.iter().filter(|value| **value > RESOLVED).count();
    let condition = match inference.condition() {
        None => "columns are parallel".to_owned(),
        Some(c) if c > CONDITION[1] => format!("condition {c:.0}: columns are nearly parallel"),
        Some(c) if c > CONDITION[0] => format!("condition {c:.0}: watch combinations"),
        Some(c) => format!("condition {c:.0}"),
    };
    let count = sized.len();
    runner.verdict(
        format!("{name}: the points resolve {resolved} of {count} combinations of free parameters ({condition})"),
        out,
    )
}

/// How the search went.
fn search(name: &str, o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    let (fit, minima) = (o.fitted.fit(), &o.fitted.minima);
    out.line(format!(
        "{name}: models {}, {} measured numbers, {} parameters",
        o.name,
        fit.rows,
        o.identification.parameters().len()
    ))?;
    let starts: usize = minima.minima.iter().map(|m| m.starts.len()).sum();
    let ended = match fit.status {
        Status::Converged if !fit.kinks.is_empty() => format!("converged at a kink ({})", fit.reason.name()),
        Status::Converged => format!("converged ({})", fit.reason.name()),
        Status::Singular => "converged, but a combination of parameters changes nothing (singular)".to_owned(),
        Status::Failed | Status::Interrupted => format!("{} ({}): no minimum", fit.status.name(), fit.reason.name()),
    };
    let many = match (starts, minima.minima.len()) {
        (1, _) => String::new(),
        (starts, 1) => format!("; all {starts} starts lead there"),
        (starts, several) => format!(
            "; {} of {starts} starts lead there, the others to {}",
            minima.minima[0].starts.len(),
            if several == 2 {
                "another minimum".to_owned()
            } else {
                format!("{} other minima", several - 1)
            }
        ),
    };
    out.line(format!(
        "search {ended} after {} steps and {} evaluations of all points{many}",
        fit.counts.steps, minima.evaluations
    ))?;
    for kink in &o.fitted.kinks {
        out.line(format!("{name}: {}", kink.sentence()))?;
    }
    if fit.kinks.len() > o.fitted.kinks.len() && o.fitted.kinks.is_empty() {
        out.line(format!(
            "{name}: minimum at a kink of the residuals, at which no part's loss jumps"
        ))?;
    }
    for other in minima.minima.iter().skip(1).take(MINIMA) {
        out.line(format!("{name}: {}", another(o, other)))?;
    }
    if minima.minima.len() > MINIMA + 1 {
        out.line(format!(
            "{name}: {} more minima are in the JSON",
            minima.minima.len() - MINIMA - 1
        ))?;
    }
    for note in fit.notes.iter().chain(&minima.notes) {
        out.line(format!("note: {note}"))?;
    }
    if let Some(kinship) = minima.kinship {
        out.line(format!("minima of the same misfit: {}", kinship.name()))?;
    }
    for (quantity, factor) in &o.fitted.factors {
        let what = quantity.words(Difference::Points).0;
        out.line(format!(
            "the stated accuracy of the {what} is to be multiplied by {factor:.2}"
        ))?;
    }
    Ok(())
}

/// Another minimum: its misfit, and the parameters that differ.
fn another(o: &Outcome<'_>, other: &Minimum) -> String {
    let fit = o.fitted.fit();
    let differs = |(k, parameter): (usize, &Identified)| {
        let (here, there) = (fit.theta[k], other.fit.theta[k]);
        match o.fitted.distance(other, k) {
            Some(distance) if distance.abs() >= DIFFERS => Some(format!(
                "{} {} ({distance:+.1} standard errors)",
                parameter.name,
                short(there)
            )),
            None if (there - here).abs() > APART * here.abs().max(there.abs()) => {
                Some(format!("{} {}", parameter.name, short(there)))
            }
            _ => None,
        }
    };
    let list: Vec<String> = o
        .identification
        .parameters()
        .iter()
        .enumerate()
        .filter_map(differs)
        .collect();
    let list = if list.is_empty() {
        "no parameter differs by half a standard error".to_owned()
    } else {
        list.join(", ")
    };
    let more = if fit.cost > 0.0 {
        format!("{:.2} % more", 100.0 * (other.fit.cost / fit.cost - 1.0))
    } else {
        "more".to_owned()
    };
    format!(
        "another minimum, from {} of the starts, has a sum of squares of {} ({more}): {list}",
        other.starts.len(),
        short(other.fit.chi2())
    )
}

/// How far the models are from the points, before and after.
fn misfit(runner: &Runner<'_>, name: &str, o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    for quantity in o.quantities() {
        let (what, unit) = quantity.words(Difference::Points);
        let [before, after] = o.rms(quantity);
        let weighted = match o.fitted.inference.accuracy() {
            Accuracy::Given => {
                let [before, after] = o.weighted_rms(quantity).map(short);
                format!("; over the accuracy of the points {before} and {after}")
            }
            Accuracy::Estimated => String::new(),
        };
        runner.verdict(
            format!(
                "{name}: {}: {what} {} {unit} rms off the points before, {} after{weighted}",
                o.name,
                short(before),
                short(after)
            ),
            out,
        )?;
    }
    let inference = &o.fitted.inference;
    match (inference.accuracy(), &o.checks.lack) {
        (Accuracy::Given, Some(lack)) => out.line(format!(
            "sum of squares over the stated accuracies {:.1} at {:.0} degrees of freedom, {}",
            lack.objective,
            lack.freedom,
            if lack.probability < 0.001 {
                "p < 0.001".to_owned()
            } else {
                format!("p = {:.3}", lack.probability)
            }
        ))?,
        (Accuracy::Given, None) => {}
        (Accuracy::Estimated, _) => out.line(format!(
            "no accuracy is stated: intervals follow from the scatter of the points, {}{}",
            short(inference.scatter()),
            o.quantities()
                .first()
                .map_or_else(String::new, |q| format!(" {}", q.words(Difference::Points).1))
        ))?,
    }
    Ok(())
}

fn parameters(o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    let inference = &o.fitted.inference;
    let widening = o.widening();
    let mut head = vec!["parameter", "unit", "stated", "fitted", "95 % linearised"];
    if widening.is_some() {
        head.push("widened");
    }
    head.extend(["95 % by profile", "verdict"]);
    let mut table = Table::new(&head);
    for (k, (parameter, theta)) in o.identification.parameters().iter().zip(o.fitted.theta()).enumerate() {
        let interval = |widening: f64| {
            inference.interval(k, 0.95, widening).map_or_else(
                || "-".to_owned(),
                |i| {
                    let cut = if i.ends == i.uncut { "" } else { " (cut)" };
                    format!("{}{cut}", span(i.ends))
                },
            )
        };
        let mut row = vec![
            parameter.name.clone(),
            parameter.unit.symbol.to_owned(),
            parameter.stated.map_or_else(|| "-".to_owned(), short),
            short(*theta),
            interval(1.0),
        ];
        if o.fitted.is_kinked(k) {
            row[4].push_str(" (kink)");
        }
        row.extend(widening.map(interval));
        row.push(match &o.profiles[k] {
            Some(Ok(profile)) => {
                let bound = profile.ends.iter().any(|end| end.reach == Reach::Bound);
                let open = profile.ends.iter().any(|end| end.reach == Reach::Unresolved);
                let remark = match (bound, open, profile.nonlinear) {
                    (_, true, _) => " (open)",
                    (true, ..) => " (bound)",
                    (.., true) => " (nonlinear)",
                    _ => "",
                };
                format!("{}{remark}", span(profile.theta))
            }
            Some(Err(_)) => "failed".to_owned(),
            None => "-".to_owned(),
        });
        row.push(verdict(
            inference.determination_widened(k, o.widening().unwrap_or(1.0)).verdict,
        ));
        table.row(row);
    }
    out.text(&table.render())?;
    for (parameter, theta) in o.identification.parameters().iter().zip(o.fitted.theta()) {
        if let Some(words) = parameter.changed_from_source(*theta) {
            out.line(format!("`{}`: coefficient {words}", parameter.name))?;
        }
    }
    for (k, profile) in o.profiles.iter().enumerate() {
        if let Some(Err(reason)) = profile {
            out.line(format!(
                "no profile of `{}`: {reason}",
                o.identification.parameters()[k].name
            ))?;
        }
    }
    let kinked: Vec<&str> = (0..o.identification.parameters().len())
        .filter(|k| o.fitted.is_kinked(*k))
        .map(|k| o.identification.parameters()[k].name.as_str())
        .collect();
    if !kinked.is_empty() {
        out.line(format!(
            "kink: derivatives differ on both sides of the minimum, so that the linearised intervals of {} are a guess; trust those by profile",
            kinked.join(", ")
        ))?;
    }
    if o.fitted.inference.is_robust() {
        out.line("a robust loss has no intervals by profile")?;
    }
    Ok(())
}

/// Unit of the bands by which rows are grouped; empty where they are groups, not bands, or of a column.
pub fn fold_unit(entry: &FoldsEntry) -> &'static str {
    match entry {
        FoldsEntry::Torques(_) => "Nm",
        FoldsEntry::By(by) => match by.by.as_str() {
            "torque" => "Nm",
            "speed" => "rpm",
            "oil_temperature" => "degC",
            _ => "",
        },
    }
}

/// A group in words.
pub fn fold_name(fold: &Fold, entry: &FoldsEntry) -> String {
    let [from, to] = match (&fold.label, fold.band) {
        (Some(label), _) => return label.clone(),
        (None, Some(band)) => band,
        (None, None) => return String::new(),
    };
    let [first, last] = [format!("{from:.1}"), format!("{to:.1}")];
    let band = if first == last {
        first
    } else {
        format!("{first} to {last}")
    };
    match fold_unit(entry) {
        "rpm" if (from - to).abs() * RPM < 0.5 => format!("{:.0} rpm", from * RPM),
        "rpm" => format!("{:.0} to {:.0} rpm", from * RPM, to * RPM),
        "" => band,
        unit => format!("{band} {unit}"),
    }
}

fn folds(name: &str, entry: &IdentifyEntry, o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    let inference = &o.fitted.inference;
    match &o.folds {
        None => {}
        Some(Err(reason)) => out.line(format!("no cross-validation: {reason}"))?,
        Some(Ok((folds, validation))) => {
            let inside = (inference.chi_square() / inference.residuals().len() as f64).sqrt();
            let groups = if folds.iter().all(|fold| fold.band.is_some()) {
                "bands"
            } else {
                "groups"
            };
            out.line(format!(
                "predicted without its own {} a residual is {:.3} rms over {} {groups}, fitted {inside:.3}",
                group_words(&entry.folds),
                validation.rms,
                folds.len()
            ))?;
            let strange = validation.strange(inside).into_iter();
            for place in strange.filter(|_| validation.rms > ROUNDING) {
                out.line(format!(
                    "{name}: the model does not extrapolate to {}: {:.3} rms there",
                    fold_name(&folds[place], &entry.folds),
                    validation.fold_rms()[place]
                ))?;
            }
        }
    }
    Ok(())
}

fn next(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    if let Some(Err(reason)) = &o.next {
        out.line(format!("nothing can be said of what to measure next: {reason}"))?;
    }
    let Some(Ok(next)) = &o.next else {
        return Ok(());
    };
    let plan = &next.plan.plan;
    let names = |k: usize| o.identification.parameters()[next.plan.parameters[k]].name.clone();
    let worst = |deviations: &[f64]| {
        let place = (0..deviations.len()).max_by(|a, b| deviations[*a].total_cmp(&deviations[*b]))?;
        Some((names(place), deviations[place]))
    };
    let rule = match next.rule {
        RuleEntry::Worst => "the widest interval over its range",
        RuleEntry::Trace => "the sum of the variances over the squared ranges",
        RuleEntry::Determinant => "the volume of the joint region",
    };
    let mut table = Table::new(&[
        "measure",
        "torque Nm",
        "speed rpm",
        "oil degC",
        "gain",
        "hangs on the parameters",
    ]);
    let mut place = 0;
    for group in plan.choices.chunk_by(|a, b| a.candidate == b.candidate) {
        let choice = &group[0];
        let at = &next.candidates[choice.candidate];
        let first = place + 1;
        place += group.len();
        let measure = if group.len() == 1 {
            first.to_string()
        } else {
            format!("{first} to {place}")
        };
        let lacking = next.plan.lacking.iter().find(|(c, _)| *c == choice.candidate);
        table.row(vec![
            measure,
            short(at.torque),
            fixed(at.speed * RPM, 0),
            at.oil.map_or_else(|| "-".to_owned(), short),
            short(choice.gain),
            lacking.map_or_else(
                || "no".to_owned(),
                |(_, count)| format!("in {count} of {} plans not", next.plan.others),
            ),
        ]);
    }
    out.line(format!(
        "what to measure next, in gear `{}`, so that {rule} shrinks:",
        next.gear
    ))?;
    out.text(&table.render())?;
    if let (Some((before, was)), Some((after, will))) = (worst(&plan.before.deviations), worst(&plan.after.deviations))
    {
        let half = |deviation: f64| short(100.0 * 1.96 * deviation);
        runner.verdict(
            format!(
                "{name}: {} more points would narrow the widest interval, that of `{before}`, +-{} % of its range, to +-{} % \
                 (then `{after}`)",
                entry.next.as_ref().map_or(0, |n| n.points),
                half(was),
                half(will)
            ),
            out,
        )?;
    }
    Ok(())
}
