//! `eval`: one model alone, without a gearbox.

use gearloss_framework::document::{Sources, read_yaml};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;
use gearloss_framework::loss::Step;
use gearloss_framework::registry::Files;
use serde_json::{Map, Value, json};

use super::models::{no_mechanism, no_model};
use crate::args::{EvalArgs, Format};
use crate::output::{End, Failure, Out, significant};

pub fn run(args: &EvalArgs, out: &mut Out) -> Result<End, Failure> {
    let language = Language::linked()?;
    let Some((mechanism, model)) = args.model.split_once('/') else {
        return Err(Failure::input(
            format!("`{}` is no model", args.model),
            "write MECHANISM/MODEL, such as bearing/skf",
        ));
    };
    let entry_of = language
        .registry()
        .mechanism(mechanism)
        .ok_or_else(|| no_mechanism(&language, mechanism))?;
    let entry = language
        .registry()
        .model(mechanism, model)
        .ok_or_else(|| no_model(&language, mechanism, model))?;
    let (example, part) = language.example_of(entry).map_err(|list| Findings {
        list,
        sources: Sources::default(),
    })?;
    let mut sources = Sources::default();
    let (mut model_value, mut part_value, mut at) = (example, part, Map::new());
    let mut folder = std::path::PathBuf::new();
    if let Some(file) = &args.input {
        let text = std::fs::read_to_string(file).map_err(|e| {
            Failure::input(
                format!("cannot read {}: {e}", file.display()),
                "check the name of the file",
            )
        })?;
        folder = file.parent().map(std::path::Path::to_path_buf).unwrap_or_default();
        let source = sources.add(file.display().to_string(), text.as_str());
        let read = read_yaml(source, &text);
        if !read.findings.is_empty() {
            return Err(Findings {
                list: read.findings,
                sources,
            }
            .into());
        }
        let walked = language.walk_eval(mechanism, &read.node).map_err(|list| Findings {
            list,
            sources: sources.clone(),
        })?;
        if !walked.findings.is_empty() {
            return Err(Findings {
                list: walked.findings,
                sources,
            }
            .into());
        }
        if let Some(written) = walked.value.get("model") {
            let name = written
                .as_str()
                .or_else(|| written["type"].as_str())
                .unwrap_or_default();
            if name != model {
                return Err(Failure::input(
                    format!("the input is for `{name}`, not for `{model}`"),
                    format!("write `model: {{ type: {model} }}`, or leave `model` out"),
                ));
            }
            model_value = written.clone();
        }
        if let Some(written) = walked.value.get("part") {
            part_value = written.clone();
        }
        at = walked
            .value
            .get("at")
            .and_then(Value::as_object)
            .cloned()
            .unwrap_or_default();
    }
    let files = Files::beside(folder);
    let evaluated =
        (entry_of.eval)(language.registry(), &files, &model_value, &part_value, &at).map_err(|error| Findings {
            list: vec![error],
            sources,
        })?;
    if args.format == Format::Json {
        let value = json!({
            "format": "gearloss-eval/1",
            "gearloss": env!("CARGO_PKG_VERSION"),
            "mechanism": mechanism,
            "model": model,
            "answer": entry_of.answer,
            "values": evaluated.values.iter().map(|(n, v)| json!({ "name": n, "value": v })).collect::<Vec<_>>(),
            "total": evaluated.total,
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
    out.line(format!("{mechanism}/{model}: {}", entry.meaning))?;
    out.line(format!("source: {}", entry.source))?;
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
        out.line(format!("{} {}", entry_of.answer, significant(evaluated.total)))?;
    }
    for (path, limit, extent) in evaluated.limits.iter().filter(|(_, _, e)| e.outside > 0) {
        out.line(format!(
            "outside: {path}: {} {} {} is outside of {} to {} ({})",
            limit.name,
            significant(if extent.least < limit.least {
                extent.least
            } else {
                extent.greatest
            }),
            limit.unit,
            significant(limit.least),
            significant(limit.greatest),
            limit.origin
        ))?;
    }
    Ok(End::Fine)
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}
