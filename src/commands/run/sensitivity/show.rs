//! What is printed: a table for each method, of the mean loss and of the relative change of the loss at the points, and what it says.

use gearloss_numerics::sensitivity::{Estimate, Influence, VarianceShares};

use super::super::Runner;
use super::Found;
use super::outputs::Kind;
use crate::commands::run::shown::show_published;
use crate::output::{Failure, Out, Table, number, significant};

/// Share of the variance, with others, below which a parameter counts as not influential: that of the screening.
const SMALL: f64 = 0.05;

pub fn show(runner: &Runner<'_>, name: &str, f: &Found<'_>, out: &mut Out) -> Result<(), Failure> {
    let set = &f.built.name;
    let efficiency = f.outputs.list.iter().position(|o| o.kind == Kind::Efficiency);
    let efficiency = efficiency.map_or_else(String::new, |i| {
        format!(", mean efficiency {:.3} %", 100.0 * f.values[i])
    });
    out.line(format!(
        "{name}: mean loss {:.3} W{efficiency} over {} points, models {set}",
        f.values[0], f.points
    ))?;
    show_published(f.ranges.iter().map(|range| &range.varied), out)?;
    out.line("")?;
    if f.local.is_some() {
        local(name, f, out)?;
    }
    if f.morris.is_some() {
        morris(runner, name, f, out)?;
    }
    if f.sobol.is_some() {
        sobol(runner, name, f, out)?;
    }
    Ok(())
}

impl Found<'_> {
    /// Number of the output of relative changes at the points.
    fn relative(&self) -> Option<usize> {
        self.outputs.list.iter().position(|o| o.kind == Kind::RelativeLoss)
    }
}

fn local(name: &str, f: &Found<'_>, out: &mut Out) -> Result<(), Failure> {
    out.line(format!(
        "{name}: slopes of the mean loss at the values of the gearbox, models {}; scaled: over the whole range, in % of the loss",
        f.built.name
    ))?;
    let mut table = Table::new(&[
        "parameter",
        "at",
        "from",
        "to",
        "slope W per unit",
        "scaled %",
        "elasticity",
    ]);
    for (k, range) in f.ranges.iter().enumerate() {
        let Some(l) = f.slopes(0, k) else { continue };
        let words = |value: f64| range.varied.words(value);
        table.row(vec![
            range.varied.pattern.clone(),
            range.varied.start().map_or_else(|| "-".to_owned(), words),
            words(range.ends[0]),
            words(range.ends[1]),
            significant(l.slope),
            number(l.scaled.map(|s| 100.0 * s), 3),
            number(l.elasticity, 4),
        ]);
    }
    out.text(&table.render())?;
    out.line("")?;
    Ok(())
}

fn morris(runner: &Runner<'_>, name: &str, f: &Found<'_>, out: &mut Out) -> Result<(), Failure> {
    let Some(morris) = &f.morris else { return Ok(()) };
    let set = &f.built.name;
    out.line(format!(
        "{name}: change of the mean loss over the whole range of a parameter in W, and mu* of the relative change of the loss at the \
         points (rms) in %, {} runs, models {set}",
        morris.runs
    ))?;
    let points = f.relative();
    let influences_at_points = points.map(|i| morris.influences(i)).unwrap_or_default();
    let at_points = |k: usize| points.map(|i| 100.0 * morris.effects[i][k].magnitude);
    let influences = morris.influences(0);
    let mut table = Table::new(&["parameter", "mu", "mu*", "sigma", "at points %", "says"]);
    for (k, effect) in morris.effects[0].iter().enumerate() {
        table.row(vec![
            f.ranges[k].varied.pattern.clone(),
            number(Some(effect.mean), 3),
            number(Some(effect.magnitude), 3),
            number(Some(effect.deviation), 3),
            number(at_points(k), 3),
            match influences[k] {
                Influence::None => format!("{} on the mean loss", influences[k].words()),
                influence => influence.words().to_owned(),
            },
        ]);
    }
    out.text(&table.render())?;
    let magnitudes: Vec<f64> = morris.effects[0].iter().map(|e| e.magnitude).collect();
    let order = descending(&magnitudes);
    let which = |of: Influence| named(f, order.iter().filter(|k| influences[**k] == of));
    let [none, curved] = [Influence::None, Influence::NonlinearOrInteracting].map(which);
    let first = order[0];
    let mut sentence = if magnitudes[first] == 0.0 {
        format!("{name}: `{set}`: the mean loss does not depend on any of the parameters")
    } else {
        format!(
            "{name}: `{set}`: the mean loss depends most on {}, by {:.2} W over its range",
            f.ranges[first].varied.pattern, magnitudes[first]
        )
    };
    if magnitudes[first] > 0.0 && !none.is_empty() {
        sentence.push_str(&format!("; not influential on the mean loss: {none}"));
    }
    // What moves loss from one region to another.
    let moves = |k: &&usize| {
        influences[**k] == Influence::None && influences_at_points.get(**k).is_some_and(|i| *i != Influence::None)
    };
    let word = |k: &usize| {
        let share = at_points(*k).unwrap_or(0.0);
        format!("{}, by {share:.2} %", f.ranges[*k].varied.pattern)
    };
    let moving: Vec<String> = order.iter().filter(moves).map(word).collect();
    if !moving.is_empty() {
        sentence.push_str(&format!(
            "; but influential on the loss at single points (rms over the points): {}",
            moving.join("; ")
        ));
    }
    if !curved.is_empty() {
        sentence.push_str(&format!("; nonlinear or interacting: {curved}"));
    }
    runner.verdict(sentence, out)?;
    out.line("")?;
    Ok(())
}

fn sobol(runner: &Runner<'_>, name: &str, f: &Found<'_>, out: &mut Out) -> Result<(), Failure> {
    let Some(sobol) = &f.sobol else { return Ok(()) };
    let (set, shares) = (&f.built.name, &sobol[0]);
    out.line(format!(
        "{name}: shares of the variance of the mean loss, deviation {:.3} W, and of the relative change of the loss at the points (rms), \
         {} samples, models {set}",
        shares.variance.sqrt(),
        f.samples
    ))?;
    let at_points = f.relative().map(|i| &sobol[i]);
    let mut table = Table::new(&[
        "parameter",
        "alone",
        "95 % from",
        "to",
        "with others",
        "95 % from",
        "to",
        "at points alone",
        "with others",
    ]);
    for (k, range) in f.ranges.iter().enumerate() {
        let mut row = vec![range.varied.pattern.clone()];
        for e in [&shares.first[k], &shares.total[k]] {
            row.extend([e.value, e.interval[0], e.interval[1]].map(|x| number(Some(x), 3)));
        }
        let there = |which: fn(&VarianceShares) -> &Vec<Estimate>| number(at_points.map(|s| which(s)[k].value), 3);
        row.extend([there(|s| &s.first), there(|s| &s.total)]);
        table.row(row);
    }
    out.text(&table.render())?;
    let mut sentence = format!("{name}: `{set}`: {}", together(f, shares));
    if let Some(there) = at_points.filter(|there| there.variance > 0.0) {
        let moves = |k: &usize| shares.total[*k].value < SMALL && there.total[*k].value >= SMALL;
        let word = |k: usize| {
            let share = 100.0 * there.total[k].value;
            format!("{}, with {share:.0} % of its variance", f.ranges[k].varied.pattern)
        };
        let moving: Vec<String> = (0..f.ranges.len()).filter(moves).map(word).collect();
        if !moving.is_empty() {
            sentence.push_str(&format!(
                "; influential on the loss at single points only: {}",
                moving.join("; ")
            ));
        }
    }
    runner.verdict(sentence, out)?;
    out.line("")?;
    Ok(())
}

/// Whether parameters act together on the loss, and on which of its parts they do.
fn together(f: &Found<'_>, shares: &VarianceShares) -> String {
    if shares.variance == 0.0 {
        return "nothing that is varied changes the mean loss".to_owned();
    }
    let alone: f64 = shares.first.iter().map(|s| s.value).sum();
    let said = if shares.interact() {
        format!(
            "parameters act together on the mean loss: alone they explain an estimated {:.0} % of its variance",
            100.0 * alone
        )
    } else {
        format!(
            "each parameter acts for itself on the mean loss: alone they explain an estimated {:.0} % of its variance",
            100.0 * alone
        )
    };
    let interact = |(i, output): (usize, &super::outputs::Output)| {
        let own = f.sobol.as_ref()?.get(i)?;
        (output.kind == Kind::Mechanism && own.interact()).then(|| format!("`{}`", output.name))
    };
    let parts: Vec<String> = f.outputs.list.iter().enumerate().filter_map(interact).collect();
    if parts.is_empty() {
        said
    } else {
        format!("{said}; they interact in {}", parts.join(", "))
    }
}

/// Numbers of values, the greatest first.
pub fn descending(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    order
}

fn named<'k>(f: &Found<'_>, which: impl Iterator<Item = &'k usize>) -> String {
    let names: Vec<&str> = which.map(|k| f.ranges[*k].varied.pattern.as_str()).collect();
    names.join(", ")
}
