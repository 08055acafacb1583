//! Mechanisms and models of a program: tables and records.

mod checks;
mod ratings;
mod record;

use gearloss_framework::coefficients::COEFFICIENTS;
use gearloss_framework::document::records_by_type;
use gearloss_framework::language::{Kind, Language};
use gearloss_framework::registry::{Entry, MechanismEntry};
use serde_json::Value;

pub use checks::ChecksText;
pub use ratings::{rating_text, ratings_list};
pub use record::ModelsRecord;

use crate::text::{Lines, TextTable, significant};

/// Names and schemas of the parameters of a model, from the schema of gearboxes.
fn parameters(entry: &Entry, schema: &Value) -> Vec<(String, Value)> {
    let models = records_by_type(&schema["definitions"][format!("{}_model", entry.mechanism)]);
    let named = models.into_iter().find(|(name, _)| *name == entry.name);
    let fields = named.as_ref().and_then(|(_, record)| record["properties"].as_object());
    let fields = fields.into_iter().flatten();
    fields
        .filter(|(name, _)| !["type", COEFFICIENTS].contains(&name.as_str()))
        .map(|(name, field)| (name.clone(), field.clone()))
        .collect()
}

/// A model whose law is written for any number, and any other.
const GENERIC: &str = "generic";
const PLAIN: &str = "plain";

/// [`GENERIC`] or [`PLAIN`].
fn evaluation(language: &Language, entry: &Entry) -> &'static str {
    if language.is_generic(entry) { GENERIC } else { PLAIN }
}

/// The grade of the formula; empty if it states none.
fn grade(entry: &Entry) -> &'static str {
    let formula = entry.evidence.iter().find(|grade| grade.key.is_empty());
    formula.map_or("", |grade| grade.grade.name())
}

/// Parameters with default, range and description, from their schemas.
fn parameters_table(fields: &[(String, Value)]) -> TextTable {
    TextTable::of(fields)
        .column("parameter", |(name, _)| name)
        .column("default", |(_, field)| match &field["default"] {
            Value::Null => "-".to_owned(),
            value => value.to_string(),
        })
        .column("range", |(_, field)| {
            match (field["minimum"].as_f64(), field["maximum"].as_f64()) {
                (Some(least), Some(greatest)) => format!("{} to {}", significant(least), significant(greatest)),
                _ => String::new(),
            }
        })
        .column("description", |(_, field)| {
            field["description"].as_str().unwrap_or_default()
        })
        .finish()
}

/// All models by mechanism, the ratings, the model sets, and the crates with models.
pub fn models_text(language: &Language) -> String {
    let mut out = Lines::default();
    let mechanisms = language.registry().mechanisms().iter();
    let table = TextTable::of(mechanisms.flat_map(|mechanism| language.registry().models(mechanism.key)))
        .column("mechanism", |model| model.mechanism)
        .column("model", |model| model.name)
        .column("crate", |model| model.origin.package.name)
        .column("evidence", |model| grade(model))
        .column("evaluation", |model| evaluation(language, model))
        .column("description", |model| model.meaning());
    out.text(&table.finish().render());
    out.line("");
    out.line("generic: several points at once, exact derivatives; plain: derivatives by differences");
    out.line("");
    out.text(&ratings_list(language));
    out.line("");
    for set in language.registry().shipped_sets() {
        out.line(format!(
            "set {}: {} ({})",
            set.name, set.meaning, set.origin.package.name
        ));
    }
    for package in language.registry().packages() {
        out.line(format!("crate {package}"));
    }
    out.into_text()
}

/// A mechanism with its quantities and models.
pub fn mechanism_text(language: &Language, mechanism: &MechanismEntry) -> String {
    let mut out = Lines::default();
    out.line(format!("{}: {}", mechanism.key, mechanism.meaning));
    out.line(format!("answer: {}", mechanism.answer));
    if let Some(section) = &mechanism.section {
        out.line(format!("section: {}", section.name));
    }
    out.line(format!("registered at {}", mechanism.origin));
    out.line("");
    let quantities = TextTable::of((mechanism.quantities)())
        .column("quantity", |q| q.name)
        .column("usual", |q| significant(q.usual))
        .column("min", |q| significant(q.least))
        .column("max", |q| significant(q.greatest))
        .column("description", |q| q.doc.trim())
        .column("from", |q| q.from);
    out.text(&quantities.finish().render());
    for law in (mechanism.laws)() {
        out.line(format!("law: {law}"));
    }
    out.line("");
    let mut models = TextTable::new(&["model", "description", "source"]);
    for model in language.registry().models(mechanism.key) {
        models.row(vec![model.name.to_owned(), model.meaning(), model.source.to_owned()]);
    }
    out.text(&models.render());
    for rating in language.registry().ratings_of(mechanism.key) {
        out.line(format!("rating {}: {}", rating.entry.name, rating.entry.meaning()));
    }
    out.into_text()
}

/// A model with its parameters, coefficients, stated ranges and evidence.
pub fn model_text(language: &Language, entry: &Entry) -> String {
    let mut out = Lines::default();
    out.line(format!("{}/{}: {}", entry.mechanism, entry.name, entry.meaning()));
    out.line(format!("source: {}", entry.source));
    out.line(format!("registered at {}", entry.origin));
    out.line(format!("example: {}", entry.example));
    out.line(match evaluation(language, entry) {
        GENERIC => "evaluation: generic: several points at once, exact derivatives",
        _ => "evaluation: plain: derivatives by differences",
    });
    let schema = language.published(Kind::Gearbox);
    out.line("");
    out.text(&parameters_table(&parameters(entry, &schema)).render());
    let coefficients = entry.coefficients();
    if !coefficients.is_empty() {
        out.line(format!(
            "\n{COEFFICIENTS} of the formula, under the key `{COEFFICIENTS}`; published by {}",
            entry.source
        ));
        let table = TextTable::of(&coefficients)
            .column("coefficient", |of| &of.name)
            .column("published", |of| of.published.to_string())
            .column("range", |of| {
                format!("{} to {}", significant(of.least), significant(of.greatest))
            })
            .column("description", |of| &of.meaning);
        out.text(&table.finish().render());
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
                        "load-independent"
                    }
                )
            })
            .collect();
        out.line(format!("\nterms: {}", words.join(", ")));
    }
    for observed in entry.observed {
        out.line(format!(
            "observed: {} [{}]: {}",
            observed.name, observed.unit, observed.meaning
        ));
    }
    ranges_and_evidence(&mut out, entry);
    if let Some(words) = entry.compared_in_words(None) {
        out.line(format!("measurements: {words}"));
    }
    for set in entry.compared().sets {
        let [least, greatest] = set.ratio.map(significant);
        let ratio = if least == greatest {
            least
        } else {
            format!("{least} to {greatest}")
        };
        let seen = if set.seen {
            ", from which its constants were derived"
        } else {
            ""
        };
        out.line(format!("  {}: {ratio}{seen}", set.set));
    }
    out.into_text()
}

/// Stated ranges, evidence and number of check values of a model or a rating.
fn ranges_and_evidence(out: &mut Lines, entry: &Entry) {
    for limit in entry.limits {
        out.line(format!(
            "stated range: {} {} {} to {} {} ({})",
            limit.meaning,
            limit.name,
            significant(limit.least),
            significant(limit.greatest),
            limit.unit,
            limit.origin
        ));
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
        ));
    }
    if !entry.checks.is_empty() {
        let values: usize = entry.checks.iter().map(|check| check.values.len()).sum();
        out.line(format!("check values: {values}, listed by `--checks`"));
    }
}
