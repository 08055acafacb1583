//! Sensitivity: for each method a table of the mean loss and of the relative change of the loss at the points, verdicts and figures.

mod pictures;
mod summary;

use gearloss_numerics::sensitivity::{Estimate, Influence};
use gearloss_studies::analyses::common::ranges::published;
use gearloss_studies::analyses::sensitivity::{
    EffectOfParameter, OutputKind, OutputSensitivity, SensitivityOfSet, SensitivityOutcome, SharesOfVariance,
};

use crate::page::Page;
use crate::register_view;
use crate::text::{TextTable, number, significant};

/// Total share of the variance below which a parameter counts as not influential, as in the screening.
const SMALL: f64 = 0.05;

register_view!(SensitivityOutcome, show);

fn show(outcome: &SensitivityOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for set in &outcome.sensitivities {
        let Some(loss) = set.outputs.first() else { continue };
        let efficiency = set.outputs.iter().find(|output| output.kind == OutputKind::Efficiency);
        let efficiency = efficiency.map_or_else(String::new, |output| {
            format!(", mean efficiency {:.3} %", 100.0 * output.mean)
        });
        page.line(format!(
            "{name}: mean loss {:.3} W{efficiency} over {} points, models {}",
            loss.mean, set.points, set.model_set
        ));
        page.published(&published(set.parameters.iter().map(|parameter| &parameter.varied)));
        page.line("");
        slopes(name, set, loss, page);
        effects(name, set, loss, page);
        shares(name, set, loss, page);
        pictures::draw(name, set, page);
    }
}

/// The relative change of the loss at the points.
fn relative(set: &SensitivityOfSet) -> Option<&OutputSensitivity> {
    set.outputs
        .iter()
        .find(|output| output.kind == OutputKind::RelativeLoss)
}

fn slopes(name: &str, set: &SensitivityOfSet, loss: &OutputSensitivity, page: &mut Page) {
    let Some(slopes) = &loss.local else { return };
    page.line(format!(
        "{name}: slopes of the mean loss at the values of the gearbox, models {}; scaled: slope times range in % of the loss",
        set.model_set
    ));
    let table = TextTable::of(set.parameters.iter().zip(slopes))
        .column("parameter", |(parameter, _)| &parameter.path)
        .column("at", |(parameter, _)| match parameter.start {
            Some(start) => parameter.varied.words(start),
            None => "-".to_owned(),
        })
        .column("from", |(parameter, _)| parameter.varied.words(parameter.from))
        .column("to", |(parameter, _)| parameter.varied.words(parameter.to))
        .column("slope W per unit", |(_, slope)| significant(slope.slope))
        .column("scaled %", |(_, slope)| number(slope.scaled.map(|s| 100.0 * s), 3))
        .column("elasticity", |(_, slope)| number(slope.elasticity, 4));
    page.table(table.finish());
    page.line("");
}

fn effects(name: &str, set: &SensitivityOfSet, loss: &OutputSensitivity, page: &mut Page) {
    let (Some(effects), Some(runs)) = (&loss.morris, set.runs.morris) else {
        return;
    };
    page.line(format!(
        "{name}: change of the mean loss over the whole range of a parameter in W, and mu* of the relative change of the loss at the \
         points (rms) in %, {runs} runs, models {}",
        set.model_set
    ));
    let at_points = relative(set).and_then(|output| output.morris.as_deref());
    let mut table = TextTable::new(&["parameter", "mu", "mu*", "sigma", "at points %", "influence"]);
    for (k, effect) in effects.iter().enumerate() {
        table.row(vec![
            set.parameters[k].path.clone(),
            number(Some(effect.mu), 3),
            number(Some(effect.mu_star), 3),
            number(Some(effect.sigma), 3),
            number(at_points.map(|effects| 100.0 * effects[k].mu_star), 3),
            match effect.influence {
                Influence::None => format!("{} on the mean loss", effect.influence.words()),
                influence => influence.words().to_owned(),
            },
        ]);
    }
    page.table(table);
    page.verdict(effects_in_words(name, set, effects, at_points));
    page.line("");
}

/// The influential parameters of the mean loss and of the losses at single points.
fn effects_in_words(
    name: &str,
    set: &SensitivityOfSet,
    effects: &[EffectOfParameter],
    at_points: Option<&[EffectOfParameter]>,
) -> String {
    let magnitudes: Vec<f64> = effects.iter().map(|effect| effect.mu_star).collect();
    let order = descending(&magnitudes);
    let path = |k: usize| set.parameters[k].path.as_str();
    let with = |influence: Influence| {
        let parameters = order.iter().filter(|k| effects[**k].influence == influence);
        parameters.map(|k| path(*k)).collect::<Vec<_>>().join(", ")
    };
    let [none, curved] = [Influence::None, Influence::NonlinearOrInteracting].map(with);
    let first = order[0];
    let set_name = &set.model_set;
    let mut sentence = if magnitudes[first] == 0.0 {
        format!("{name}: `{set_name}`: the mean loss does not depend on any of the parameters")
    } else {
        format!(
            "{name}: `{set_name}`: the mean loss depends most on {}, by {:.2} W over its range",
            path(first),
            magnitudes[first]
        )
    };
    if magnitudes[first] > 0.0 && !none.is_empty() {
        sentence.push_str(&format!("; not influential on the mean loss: {none}"));
    }
    // Parameters that change single points but not the mean.
    let moved = |k: &usize| {
        let there = at_points.map(|effects| effects[*k])?;
        let moves = effects[*k].influence == Influence::None && there.influence != Influence::None;
        moves.then(|| format!("{}, by {:.2} %", path(*k), 100.0 * there.mu_star))
    };
    let moving: Vec<String> = order.iter().filter_map(moved).collect();
    if !moving.is_empty() {
        sentence.push_str(&format!(
            "; but influential on the loss at single points (rms over the points): {}",
            moving.join("; ")
        ));
    }
    if !curved.is_empty() {
        sentence.push_str(&format!("; nonlinear or interacting: {curved}"));
    }
    sentence
}

fn shares(name: &str, set: &SensitivityOfSet, loss: &OutputSensitivity, page: &mut Page) {
    let Some(shares) = &loss.sobol else { return };
    page.line(format!(
        "{name}: shares of the variance of the mean loss, deviation {:.3} W, and of the relative change of the loss at the points (rms), \
         {} samples, models {}",
        shares.variance.sqrt(),
        set.samples,
        set.model_set
    ));
    let at_points = relative(set).and_then(|output| output.sobol.as_ref());
    let mut table = TextTable::new(&[
        "parameter",
        "first order",
        "95 % from",
        "to",
        "total",
        "95 % from",
        "to",
        "at points: first order",
        "total",
    ]);
    for (k, parameter) in set.parameters.iter().enumerate() {
        let mut row = vec![parameter.path.clone()];
        for e in [&shares.first[k], &shares.total[k]] {
            row.extend([e.value, e.interval[0], e.interval[1]].map(|x| number(Some(x), 3)));
        }
        let there = |which: fn(&SharesOfVariance) -> &Vec<Estimate>| number(at_points.map(|s| which(s)[k].value), 3);
        row.extend([there(|s| &s.first), there(|s| &s.total)]);
        table.row(row);
    }
    page.table(table);
    let mut sentence = format!("{name}: `{}`: {}", set.model_set, together(set, shares));
    if let Some(there) = at_points.filter(|there| there.variance > 0.0) {
        let moves = |k: &usize| shares.total[*k].value < SMALL && there.total[*k].value >= SMALL;
        let word = |k: usize| {
            let share = 100.0 * there.total[k].value;
            format!("{}, with a total effect of {share:.0} %", set.parameters[k].path)
        };
        let moving: Vec<String> = (0..set.parameters.len()).filter(moves).map(word).collect();
        if !moving.is_empty() {
            sentence.push_str(&format!(
                "; influential only on the loss at single points: {}",
                moving.join("; ")
            ));
        }
    }
    page.verdict(sentence);
    page.line("");
}

/// Whether parameters interact, and in which shares of the loss.
fn together(set: &SensitivityOfSet, shares: &SharesOfVariance) -> String {
    if shares.variance == 0.0 {
        return "no varied parameter changes the mean loss".to_owned();
    }
    let alone: f64 = 100.0 * shares.first.iter().map(|s| s.value).sum::<f64>();
    let how = if shares.interactions {
        "parameters interact"
    } else {
        "parameters do not interact"
    };
    let sentence =
        format!("{how} in the mean loss: first-order effects explain an estimated {alone:.0} % of its variance");
    let interacts = |output: &&OutputSensitivity| {
        output.kind == OutputKind::Mechanism && output.sobol.as_ref().is_some_and(|shares| shares.interactions)
    };
    let parts = set.outputs.iter().filter(interacts);
    let parts: Vec<String> = parts.map(|output| format!("`{}`", output.output)).collect();
    if parts.is_empty() {
        sentence
    } else {
        format!("{sentence}; they interact in {}", parts.join(", "))
    }
}

/// The influence of each parameter on the mean loss.
struct Influences {
    values: Vec<f64>,
    unit: &'static str,
    /// What the values are.
    of: &'static str,
    /// The same behind a value.
    brief: &'static str,
}

/// Influences by the best method that was run: shares of the variance, otherwise effects, otherwise slopes.
fn influences(loss: &OutputSensitivity) -> Option<Influences> {
    if let Some(shares) = loss.sobol.as_ref().filter(|shares| shares.variance > 0.0) {
        return Some(Influences {
            values: shares.total.iter().map(|share| 100.0 * share.value.max(0.0)).collect(),
            unit: "%",
            of: "total effect on the variance of the mean loss, with interactions",
            brief: "of its variance with interactions",
        });
    }
    if let Some(effects) = &loss.morris {
        return Some(Influences {
            values: effects.iter().map(|effect| effect.mu_star).collect(),
            unit: "W",
            of: "change of the mean loss over the range",
            brief: "over its range",
        });
    }
    let slopes = loss.local.as_ref()?.iter();
    Some(Influences {
        values: slopes
            .map(|slope| slope.scaled.map_or(0.0, |s| 100.0 * s.abs()))
            .collect(),
        unit: "%",
        of: "slope times range, of the mean loss",
        brief: "by slope times range",
    })
}

/// Indices of values, the largest first.
fn descending(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    order
}
