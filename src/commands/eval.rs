//! `eval`: one model without a gearbox.

use std::path::Path;

use gearloss_framework::eval;
use gearloss_framework::files::LONGEST_TEXT;
use gearloss_framework::gearbox::Findings;
use gearloss_framework::loss::Step;
use serde_json::json;

use crate::args::{EvalArgs, Format};
use crate::output::{End, Failure, Out, beyond, significant};

pub fn run(args: &EvalArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let (mechanism, entry) = eval::named(language, &args.model).map_err(Findings::from)?;
    let (text, folder) = match &args.input {
        Some(file) => (
            super::read_file(file, LONGEST_TEXT, "check the file name")?,
            file.parent().map(Path::to_path_buf).unwrap_or_default(),
        ),
        None => Default::default(),
    };
    let source = args.input.as_deref().unwrap_or(Path::new("")).display().to_string();
    let evaluated = eval::evaluate_input(language, &args.model, &source, &text, &folder)?;
    if !evaluated.total.is_finite() {
        return Err(Failure::input(
            format!("{source}: {} has no finite result at these values", args.model),
            "give quantities of realistic size",
        ));
    }
    if args.format == Format::Json {
        let value = json!({
            "format": "gearloss-eval/1",
            "gearloss": env!("CARGO_PKG_VERSION"),
            "packages": language.registry().packages(),
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
        });
        out.line(serde_json::to_string_pretty(&value).unwrap_or_default())?;
        return Ok(End::Fine);
    }
    out.line(format!("{}: {}", args.model, entry.meaning()))?;
    out.line(format!("source: {}", entry.source))?;
    for (name, value, unit, law) in &evaluated.followed {
        out.line(format!("follows: {name} = {} {unit} ({law})", significant(*value)))?;
    }
    for (path, step) in &evaluated.steps {
        let place = if path == "model" {
            String::new()
        } else {
            format!("{path}: ")
        };
        match step {
            Step::Value {
                symbol, unit, value, ..
            } => {
                let unit = if *unit == "-" { "" } else { unit };
                out.line(format!("  {place}{symbol} = {} {unit}", significant(*value)).trim_end())?;
            }
            Step::Branch { taken, .. } => out.line(format!("  {place}branch: {taken}"))?,
        }
    }
    if evaluated.moment.is_some() {
        for (name, watts) in &evaluated.values {
            out.line(format!("{name}: {} W", significant(*watts)))?;
        }
        out.line(format!(
            "together: {} W, {} Nm",
            significant(evaluated.total),
            significant(evaluated.moment.unwrap_or(0.0))
        ))?;
    } else {
        out.line(format!("{} {}", mechanism.answer, significant(evaluated.total)))?;
    }
    for (path, limit, extent) in evaluated.limits.iter().filter(|(_, _, e)| e.outside > 0) {
        out.line(format!(
            "outside: {path}: {} {} {} is {} ({})",
            limit.name,
            significant(if extent.least < limit.least {
                extent.least
            } else {
                extent.greatest
            }),
            limit.unit,
            beyond(limit.least, limit.greatest),
            limit.origin
        ))?;
    }
    Ok(End::Fine)
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}
