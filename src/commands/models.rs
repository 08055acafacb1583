//! `models`: mechanisms and models that are linked into this program.

mod json;

use gearloss_framework::coefficients::COEFFICIENTS;
use gearloss_framework::document::records_by_type;
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;
use gearloss_framework::registry::{Entry, MechanismEntry};
use serde_json::Value;

use super::needs;
use crate::args::{Format, ModelsArgs};
use crate::output::{End, Failure, Out, Table, significant};

pub fn run(args: &ModelsArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    if let Some(file) = &args.needs {
        return needs::run(language, file, args.mechanism.as_deref(), out);
    }
    if args.format == Format::Json {
        let registry = language.registry();
        let mechanism = match &args.mechanism {
            Some(name) => Some(registry.mechanism_named(name).map_err(Findings::from)?),
            None => None,
        };
        let model = match (mechanism, &args.model) {
            (Some(mechanism), Some(name)) => Some(registry.model_named(mechanism.key, name).map_err(Findings::from)?),
            _ => None,
        };
        json::run(language, mechanism, model, out)?;
        return Ok(End::Fine);
    }
    match (&args.mechanism, &args.model) {
        (None, _) => all(language, out)?,
        (Some(mechanism), None) => {
            let mechanism = language.registry().mechanism_named(mechanism).map_err(Findings::from)?;
            one_mechanism(language, mechanism, out)?;
        }
        (Some(mechanism), Some(model)) => {
            let mechanism = language.registry().mechanism_named(mechanism).map_err(Findings::from)?;
            let model = language
                .registry()
                .model_named(mechanism.key, model)
                .map_err(Findings::from)?;
            one_model(language, model, out)?;
        }
    }
    Ok(End::Fine)
}

fn all(language: &Language, out: &mut Out) -> Result<(), Failure> {
    let mut table = Table::new(&["mechanism", "model", "crate", "evidence", "description"]);
    for mechanism in language.registry().mechanisms() {
        for model in language.registry().models(mechanism.key) {
            let grade = model
                .evidence
                .iter()
                .find(|g| g.key.is_empty())
                .map_or("", |g| g.grade.name());
            table.row(vec![
                mechanism.key.to_owned(),
                model.name.to_owned(),
                model.origin.package.name.to_owned(),
                grade.to_owned(),
                model.meaning(),
            ]);
        }
    }
    out.text(&table.render())?;
    out.line("")?;
    for set in language.registry().shipped_sets() {
        out.line(format!(
            "set {}: {} ({})",
            set.name, set.meaning, set.origin.package.name
        ))?;
    }
    for package in language.registry().packages() {
        out.line(format!("crate {package}"))?;
    }
    Ok(())
}

fn one_mechanism(language: &Language, mechanism: &MechanismEntry, out: &mut Out) -> Result<(), Failure> {
    out.line(format!("{}: {}", mechanism.key, mechanism.meaning))?;
    out.line(format!("answer: {}", mechanism.answer))?;
    if let Some(section) = &mechanism.section {
        out.line(format!("section: {}", section.name))?;
    }
    out.line(format!("registered at {}", mechanism.origin))?;
    out.line("")?;
    let mut quantities = Table::new(&["quantity", "usual", "min", "max", "description", "from"]);
    for q in (mechanism.quantities)() {
        quantities.row(vec![
            q.name.to_owned(),
            significant(q.usual),
            significant(q.least),
            significant(q.greatest),
            q.doc.trim().to_owned(),
            q.from.to_owned(),
        ]);
    }
    out.text(&quantities.render())?;
    for law in (mechanism.laws)() {
        out.line(format!("law: {law}"))?;
    }
    out.line("")?;
    let mut models = Table::new(&["model", "description", "source"]);
    for model in language.registry().models(mechanism.key) {
        models.row(vec![model.name.to_owned(), model.meaning(), model.source.to_owned()]);
    }
    out.text(&models.render())?;
    Ok(())
}

fn one_model(language: &Language, entry: &Entry, out: &mut Out) -> Result<(), Failure> {
    out.line(format!("{}/{}: {}", entry.mechanism, entry.name, entry.meaning()))?;
    out.line(format!("source: {}", entry.source))?;
    out.line(format!("registered at {}", entry.origin))?;
    out.line(format!("example: {}", entry.example))?;
    let schema = language.published(gearloss_framework::language::Kind::Gearbox);
    let own = records_by_type(&schema["definitions"][format!("{}_model", entry.mechanism)])
        .into_iter()
        .find_map(|(name, record)| (name == entry.name).then_some(record));
    let fields = own.and_then(|v| v["properties"].as_object());
    let mut parameters = Table::new(&["parameter", "default", "range", "description"]);
    let own = |name: &str| !["type", COEFFICIENTS].contains(&name);
    for (name, field) in fields.into_iter().flatten().filter(|(name, _)| own(name.as_str())) {
        let range = match (field["minimum"].as_f64(), field["maximum"].as_f64()) {
            (Some(least), Some(greatest)) => format!("{} to {}", significant(least), significant(greatest)),
            _ => String::new(),
        };
        let default = match &field["default"] {
            Value::Null => "-".to_owned(),
            value => value.to_string(),
        };
        let doc = field["description"].as_str().unwrap_or_default().to_owned();
        parameters.row(vec![name.clone(), default, range, doc]);
    }
    out.line("")?;
    out.text(&parameters.render())?;
    let coefficients = entry.coefficients();
    if !coefficients.is_empty() {
        out.line(format!(
            "\n{COEFFICIENTS} of the formula, under the key `{COEFFICIENTS}`; published by {}",
            entry.source
        ))?;
        let mut table = Table::new(&["coefficient", "published", "range", "description"]);
        for own in coefficients {
            let range = format!("{} to {}", significant(own.least), significant(own.greatest));
            table.row(vec![own.name, own.published.to_string(), range, own.meaning]);
        }
        out.text(&table.render())?;
    }
    if !entry.terms.is_empty() {
        let words: Vec<String> = entry
            .terms
            .iter()
            .map(|t| {
                format!(
                    "{} ({})",
                    t.name,
                    if t.load_dependent {
                        "load-dependent"
                    } else {
                        "not load-dependent"
                    }
                )
            })
            .collect();
        out.line(format!("\nterms: {}", words.join(", ")))?;
    }
    for observed in entry.observed {
        out.line(format!(
            "observed: {} [{}]: {}",
            observed.name, observed.unit, observed.meaning
        ))?;
    }
    for limit in entry.limits {
        out.line(format!(
            "stated range: {} {} to {} {} ({})",
            limit.name,
            significant(limit.least),
            significant(limit.greatest),
            limit.unit,
            limit.origin
        ))?;
    }
    for graded in entry.evidence {
        let what = if graded.key.is_empty() {
            "formula".to_owned()
        } else {
            format!("default of {}", graded.key)
        };
        out.line(format!(
            "evidence: {what}: {} ({})",
            graded.grade.name(),
            graded.because
        ))?;
    }
    Ok(())
}
