//! One evaluated model: text and record.

use gearloss_framework::eval::Evaluated;
use gearloss_framework::loss::Step;
use gearloss_framework::registry::{Entry, MechanismEntry, RatedAlone, RatingPlugin};
use serde::Serialize;
use serde_json::{Value, json};

use crate::text::{Lines, beyond, significant};

/// An evaluated model as a record of the format `gearloss-eval/1`; `packages` are the crates with models.
pub fn eval_json(mechanism: &MechanismEntry, entry: &Entry, evaluated: &Evaluated, packages: impl Serialize) -> Value {
    json!({
        "format": "gearloss-eval/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": packages,
        "mechanism": mechanism.key,
        "model": entry.name,
        "answer": mechanism.answer,
        "values": evaluated.values.iter().map(|(n, v)| json!({ "name": n, "value": v })).collect::<Vec<_>>(),
        "total": evaluated.total,
        "followed": evaluated.followed.iter().map(|(n, v, u, law)| json!({
            "name": n, "unit": u, "value": finite(*v), "law": law,
        })).collect::<Vec<_>>(),
        "moment_nm": evaluated.moment,
        "observed": evaluated.observed.iter().map(|(p, o, e)| json!({
            "path": p, "name": o.name, "unit": o.unit, "least": finite(e.least), "greatest": finite(e.greatest),
        })).collect::<Vec<_>>(),
        "limits": evaluated.limits.iter().map(|(p, l, e)| json!({
            "path": p, "name": l.name, "unit": l.unit, "least": l.least, "greatest": finite(l.greatest),
            "value": finite(e.least), "outside": e.outside > 0,
        })).collect::<Vec<_>>(),
    })
}

/// An evaluated model as text: source, steps, result, and what was outside its stated range.
pub fn eval_text(mechanism: &MechanismEntry, entry: &Entry, evaluated: &Evaluated) -> String {
    let mut out = Lines::default();
    let model = format!("{}/{}", entry.mechanism, entry.name);
    out.line(format!("{}: {}", model, entry.meaning()));
    out.line(format!("source: {}", entry.source));
    for (name, value, unit, law) in &evaluated.followed {
        out.line(format!("follows: {name} = {} {unit} ({law})", significant(*value)));
    }
    steps("model", &evaluated.steps, &mut out);
    if evaluated.moment.is_some() {
        for (name, watts) in &evaluated.values {
            out.line(format!("{name}: {} W", significant(*watts)));
        }
        out.line(format!(
            "together: {} W, {} Nm",
            significant(evaluated.total),
            significant(evaluated.moment.unwrap_or(0.0))
        ));
    } else {
        out.line(format!("{} {}", mechanism.answer, significant(evaluated.total)));
    }
    for (path, limit, extent) in evaluated.limits.iter().filter(|(_, _, e)| e.outside > 0) {
        out.line(format!(
            "outside: {path}: {} {} {} {} is {} ({})",
            limit.meaning,
            limit.name,
            significant(if extent.least < limit.least {
                extent.least
            } else {
                extent.greatest
            }),
            limit.unit,
            beyond(limit.least, limit.greatest),
            limit.origin
        ));
    }
    out.into_text()
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

/// Steps of a formula; those of nested models with their path.
fn steps(alone: &str, steps: &[(String, Step)], out: &mut Lines) {
    for (path, step) in steps {
        let place = if path == alone {
            String::new()
        } else {
            format!("{path}: ")
        };
        match step {
            Step::Value {
                symbol, unit, value, ..
            } => {
                let unit = if *unit == "-" { "" } else { unit };
                out.line(format!("  {place}{symbol} = {} {unit}", significant(*value)).trim_end());
            }
            Step::Branch { taken, .. } => out.line(format!("  {place}branch: {taken}")),
        }
    }
}

/// An evaluated rating as a record of the format `gearloss-eval/1`; `packages` are the crates with models.
pub fn rated_json(plugin: &RatingPlugin, alone: &RatedAlone, packages: impl Serialize) -> Value {
    json!({
        "format": "gearloss-eval/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": packages,
        "mechanism": plugin.entry.mechanism,
        "rating": plugin.entry.name,
        "quantities": alone.rated.figures().iter().map(|rated| json!({
            "symbol": rated.figure.symbol,
            "meaning": rated.figure.meaning,
            "unit": rated.figure.unit,
            "value": rated.value,
            "least": finite(rated.bound.least),
            "greatest": finite(rated.bound.greatest),
            "outside": rated.is_outside(),
        })).collect::<Vec<_>>(),
    })
}

/// An evaluated rating as text: source, steps, quantities, and which of them are outside their bounds.
pub fn rated_text(plugin: &RatingPlugin, alone: &RatedAlone) -> String {
    let mut out = Lines::default();
    out.line(format!("rating {}: {}", plugin.entry.name, plugin.entry.meaning()));
    out.line(format!("source: {}", plugin.entry.source));
    steps("rating", &alone.steps, &mut out);
    for rated in alone.rated.figures() {
        let unit = if rated.figure.unit == "-" {
            ""
        } else {
            rated.figure.unit
        };
        let value = format!(
            "{} {} = {} {unit}",
            rated.figure.meaning,
            rated.figure.symbol,
            significant(rated.value)
        );
        let fault = rated
            .fault()
            .map(|(side, bound)| format!(", which is {side} {}", significant(bound)));
        out.line(value.trim_end().to_owned() + &fault.unwrap_or_default());
    }
    out.into_text()
}
