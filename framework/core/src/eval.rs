//! Evaluates one model without a gearbox, on a part and a context given by the caller.

use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

use serde_json::{Map, Value};

use crate::codes;
use crate::document::{Diagnostic, Sources, classify, did_you_mean, read_yaml};
use crate::gearbox::Findings;
use crate::language::Language;
use crate::loss::{Notebook, Notes, Seen, Trace};
use crate::mechanism::{Answer, Inputs as _, Mechanism, settle};
pub use crate::registry::Evaluated;
use crate::registry::{Build, Entry, Files, MechanismEntry, RatedAlone, RatingPlugin, Registry, from_resolved};

/// A mechanism and a model of a language by their names, `MECHANISM/MODEL`.
///
/// # Errors
/// If there is no such model; the error lists the available ones, or a close match.
pub fn named<'a>(language: &'a Language, name: &str) -> Result<(&'a MechanismEntry, &'a Entry), Diagnostic> {
    let Some((mechanism, model)) = name.split_once('/') else {
        let error = Diagnostic::error("", format!("`{name}` is not a model")).code(codes::EVAL);
        return Err(error.help("write MECHANISM/MODEL, such as bearing/skf"));
    };
    let mechanism = language.registry().mechanism_named(mechanism)?;
    Ok((mechanism, language.registry().model_named(mechanism.key, model)?))
}

/// Evaluates `MECHANISM/MODEL` at an input in YAML with `part`, `at` and optionally `model`; omitted quantities are those of the
/// example at its usual point. `source` names the input in errors; `folder` is searched for files.
///
/// # Errors
/// If there is no such model, or the input is invalid, or [`eval`] fails.
pub fn evaluate_input(
    language: &Language,
    name: &str,
    source: &str,
    input: &str,
    folder: &Path,
) -> Result<Evaluated, Findings> {
    let (_, entry) = named(language, name)?;
    evaluate(language, entry, (source, input), Some(folder))
}

/// Evaluates a model at the input of one of its checks, with the files of its example only.
///
/// # Errors
/// As [`evaluate_input`].
pub(crate) fn evaluate_check(language: &Language, entry: &Entry, input: &str) -> Result<Evaluated, Findings> {
    evaluate(language, entry, ("check", input), None)
}

/// Evaluates a model at a named input; without a folder it has only the files of its example.
fn evaluate(
    language: &Language,
    entry: &Entry,
    (source, input): (&str, &str),
    folder: Option<&Path>,
) -> Result<Evaluated, Findings> {
    let mut sources = Sources::default();
    let source = sources.add(source.to_owned(), input);
    let found = |mut list: Vec<Diagnostic>| {
        classify(&mut list, codes::EVAL);
        Findings {
            list,
            sources: sources.clone(),
        }
    };
    let mechanism = language
        .registry()
        .mechanism_named(entry.mechanism)
        .map_err(|d| found(vec![d]))?;
    let (example, mut part) = language.example_of(entry).map_err(found)?;
    let mut model = None;
    let mut at = Map::new();
    let mut places = None;
    if !input.trim().is_empty() {
        let read = read_yaml(source, input);
        if !read.findings.is_empty() {
            return Err(found(read.findings));
        }
        let walked = language.walk_eval(mechanism.key, &read.node).map_err(found)?;
        if !walked.findings.is_empty() {
            return Err(found(walked.findings));
        }
        // Findings without their own position are shown at the start of the input.
        let start = read.node.span;
        let place = move |finding: Diagnostic| {
            let finding = walked.places.place(finding);
            if finding.spans.is_empty() {
                finding.at_span(start)
            } else {
                finding
            }
        };
        let Value::Object(mut written) = walked.value else {
            return Err(found(vec![
                Diagnostic::error("", "the input is not a mapping").help("write `part`, `at` or `model`"),
            ]));
        };
        if let Some(given) = written.remove("model") {
            let of = given.as_str().or_else(|| given["type"].as_str()).unwrap_or_default();
            if of != entry.name {
                let error = Diagnostic::error("model", format!("the input is for `{of}`, not for `{}`", entry.name));
                let help = format!("write `model: {{ type: {} }}`, or omit `model`", entry.name);
                return Err(found(vec![place(error.help(help))]));
            }
            model = Some(given);
        }
        if let Some(given) = written.remove("part") {
            part = given;
        }
        if let Some(Value::Object(given)) = written.remove("at") {
            at = given;
        }
        places = Some(place);
    }
    let files = folder.map_or_else(Files::default, Files::beside);
    // The example has its own files; for a written record they are used if the folder has no file of that name.
    for (name, text) in entry.files {
        if model.is_none() || !folder.is_some_and(|folder| folder.join(name).is_file()) {
            files.put(name, text);
        }
    }
    let model = model.unwrap_or(example);
    (mechanism.eval)(language.registry(), &files, &model, &part, &at).map_err(|error| {
        found(vec![match &places {
            Some(place) => place(error),
            None => error,
        }])
    })
}

/// Evaluates a model of a mechanism on a part, at the usual context with the given quantities changed; all values SI. Quantities
/// that are not given follow from the given ones by the laws of the context.
///
/// # Errors
/// If part or model cannot be built, a quantity is unknown, given ones contradict each other, or the formula is undefined there.
pub fn eval<M: Mechanism>(
    registry: &Registry,
    files: &Files,
    model: &Value,
    part: &Value,
    inputs: &Map<String, Value>,
) -> Result<Evaluated, Diagnostic> {
    let part: Arc<M::Part> = Arc::new(from_resolved(part).map_err(|e| Diagnostic::error("part", e.to_string()))?);
    let mut build = Build::new(registry, files);
    let slot = build.slot_at::<M>("model", &part, model)?;
    let (instances, cells) = build.finish();
    let cells = vec![Cell::new(Seen::NOTHING); cells];
    let trace = Trace::default();
    let (answer, speed, followed) = {
        let mut at = M::usual(&part, Notes::new(&cells, slot.notes).traced(&trace));
        let stated = set_inputs::<M>(&mut at, inputs)?;
        let mut followed = Vec::new();
        for (name, law) in settle::<M>(&mut at, &stated)? {
            if let Some(q) = M::QUANTITIES.iter().find(|q| q.name == name) {
                let unit = q.unit;
                followed.push((name, unit.from_si((q.get)(&at)), unit.symbol, law));
            }
        }
        (M::answer(&slot, &at), M::speed(&at), followed)
    };
    let answer = answer.map_err(|undefined| Diagnostic::error("model", undefined.to_string()))?;
    let terms = instances.first().map_or(&[][..], |i| i.entry.terms);
    let mut evaluated = Evaluated {
        values: answer.values(terms, speed),
        total: answer.total(speed),
        moment: answer.moment(speed),
        observed: Vec::new(),
        limits: Vec::new(),
        followed,
        steps: trace
            .into_steps()
            .into_iter()
            .map(|step| (instances[step.instance()].path.clone(), step))
            .collect(),
    };
    for instance in &instances {
        let path = |i: usize| (instance.path.clone(), i);
        for (i, limit) in instance.entry.limits.iter().enumerate() {
            let (path, i) = path(i);
            evaluated
                .limits
                .push((path, *limit, cells[instance.notes.limits() + i].get().extent()));
        }
        for (i, observed) in instance.entry.observed.iter().enumerate() {
            let (path, i) = path(i);
            evaluated
                .observed
                .push((path, *observed, cells[instance.notes.observed() + i].get().extent()));
        }
    }
    Ok(evaluated)
}

/// Sets the given quantities of a context, SI; returns their names.
fn set_inputs<M: Mechanism>(
    at: &mut M::At<'_, f64>,
    inputs: &Map<String, Value>,
) -> Result<Vec<&'static str>, Diagnostic> {
    let mut stated = Vec::new();
    for (name, value) in inputs {
        let Some(quantity) = M::QUANTITIES.iter().find(|q| q.name == name) else {
            let error = Diagnostic::error(
                format!("at.{name}"),
                format!("the context of {} has no quantity `{name}`", M::KEY),
            );
            return Err(match did_you_mean(name, M::QUANTITIES.iter().map(|q| q.name)) {
                Some(close) => error.help(format!("write `{close}`")),
                None => error,
            });
        };
        (quantity.set)(at, value.as_f64().unwrap_or(f64::NAN));
        stated.push(quantity.name);
    }
    Ok(stated)
}

/// Evaluates `MECHANISM/RATING` at an input in YAML with `part`, `at` and `rating`, each optional, as [`evaluate_input`] does for models.
///
/// # Errors
/// If there is no such rating, or the input is invalid, or [`rate`] fails.
pub fn rate_input(
    language: &Language,
    plugin: &RatingPlugin,
    source: &str,
    input: &str,
    folder: &Path,
) -> Result<RatedAlone, Findings> {
    let mut sources = Sources::default();
    let source = sources.add(source.to_owned(), input);
    let found = |mut list: Vec<Diagnostic>| {
        classify(&mut list, codes::EVAL);
        Findings {
            list,
            sources: sources.clone(),
        }
    };
    let text = if input.trim().is_empty() { "{}" } else { input };
    let read = read_yaml(source, text);
    if !read.findings.is_empty() {
        return Err(found(read.findings));
    }
    let walked = language.walk_rating(plugin, &read.node).map_err(found)?;
    if !walked.findings.is_empty() {
        return Err(found(walked.findings));
    }
    let (_, example) = language.example_of_rating(plugin).map_err(found)?;
    let written = |key: &str| walked.value.get(key).filter(|value| !value.is_null()).cloned();
    let rating = match written("rating") {
        Some(rating) => rating,
        None => language.default_rating(plugin.entry.name).map_err(found)?,
    };
    let at = match written("at") {
        Some(Value::Object(at)) => at,
        _ => Map::new(),
    };
    let part = written("part").unwrap_or(example);
    let files = Files::beside(folder.to_path_buf());
    (plugin.eval)(language.registry(), &files, plugin, &rating, &part, &at)
        .map_err(|error| found(vec![walked.places.place(error).at_span(read.node.span)]))
}

/// Evaluates a rating on a part, at the usual context with the given quantities changed; all values SI.
///
/// # Errors
/// As [`eval`].
pub fn rate<M: Mechanism>(
    registry: &Registry,
    files: &Files,
    plugin: &RatingPlugin,
    rating: &Value,
    part: &Value,
    inputs: &Map<String, Value>,
) -> Result<RatedAlone, Diagnostic> {
    let part: Arc<M::Part> = Arc::new(from_resolved(part).map_err(|e| Diagnostic::error("part", e.to_string()))?);
    let mut build = Build::new(registry, files);
    let slot = build.rating::<M>("rating", &part, &plugin.entry, rating)?;
    let (instances, cells) = build.finish();
    let cells = vec![Cell::new(Seen::NOTHING); cells];
    let trace = Trace::default();
    let rated = {
        let mut at = M::usual(&part, Notes::MUTED);
        let stated = set_inputs::<M>(&mut at, inputs)?;
        settle::<M>(&mut at, &stated)?;
        let book = Notebook {
            cells: &cells,
            trace: Some(&trace),
            ..Notebook::CLOSED
        };
        slot.rate(&at.with_notes(book.notes(slot.notes)))
    };
    let steps = trace.into_steps().into_iter();
    Ok(RatedAlone {
        rated: rated.map_err(|undefined| Diagnostic::error("rating", undefined.to_string()))?,
        steps: steps
            .map(|step| (instances[step.instance()].path.clone(), step))
            .collect(),
    })
}
