//! `models --format json`: all data of mechanisms and models, for programs.

use gearloss_framework::coefficients::COEFFICIENTS;
use gearloss_framework::document::{Unit, records_by_type};
use gearloss_framework::language::{Kind, Language};
use gearloss_framework::mechanism::QuantityDoc;
use gearloss_framework::registry::{Entry, MechanismEntry};
use serde_json::{Map, Value, json};

use crate::output::{Failure, Out};

/// Prints mechanisms with the selected `models`; without a selection all of them.
pub fn run(
    language: &Language,
    mechanism: Option<&MechanismEntry>,
    model: Option<&Entry>,
    out: &mut Out,
) -> Result<(), Failure> {
    let schema = language.published(Kind::Gearbox);
    let registry = language.registry();
    let mechanisms: Vec<Value> = registry
        .mechanisms()
        .iter()
        .filter(|own| mechanism.is_none_or(|only| only.key == own.key))
        .map(|own| {
            let models: Vec<Value> = registry
                .models(own.key)
                .filter(|entry| model.is_none_or(|only| only.name == entry.name))
                .map(|entry| of_model(entry, &schema))
                .collect();
            json!({
                "mechanism": own.key,
                "meaning": own.meaning,
                "answer": own.answer,
                "section": own.section.as_ref().map(|section| section.name),
                "package": own.origin.package.name,
                "quantities": (own.quantities)().iter().map(quantity).collect::<Vec<_>>(),
                "laws": (own.laws)(),
                "models": models,
            })
        })
        .collect();
    let sets: Vec<Value> = registry
        .shipped_sets()
        .iter()
        .map(|set| json!({ "name": set.name, "meaning": set.meaning, "package": set.origin.package.name }))
        .collect();
    let value = json!({
        "format": "gearloss-models/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": registry.packages(),
        "mechanisms": mechanisms,
        "sets": sets,
    });
    out.line(serde_json::to_string_pretty(&value).unwrap_or_default())?;
    Ok(())
}

/// A doc comment without its unit at the end.
fn meaning(doc: &str) -> String {
    let doc = doc.trim();
    let meaning = doc
        .rfind(" [")
        .filter(|_| doc.ends_with(']'))
        .map_or(doc, |at| &doc[..at]);
    meaning.replace('\n', " ")
}

fn quantity(quantity: &QuantityDoc) -> Value {
    json!({
        "name": quantity.name,
        "meaning": meaning(quantity.doc),
        "unit": Unit::of_doc(quantity.doc).map(|unit| unit.symbol),
        "usual": quantity.usual,
        "least": quantity.least,
        "greatest": quantity.greatest,
        "from": quantity.from,
    })
}

fn of_model(entry: &Entry, schema: &Value) -> Value {
    let own = records_by_type(&schema["definitions"][format!("{}_model", entry.mechanism)])
        .into_iter()
        .find_map(|(name, record)| (name == entry.name).then_some(record));
    let no_fields = Map::new();
    let fields = own
        .and_then(|record| record["properties"].as_object())
        .unwrap_or(&no_fields);
    let parameters: Vec<Value> = fields
        .iter()
        .filter(|(name, _)| !["type", COEFFICIENTS].contains(&name.as_str()))
        .map(|(name, field)| {
            let doc = field["description"].as_str().unwrap_or_default();
            json!({
                "name": name,
                "meaning": meaning(doc),
                "unit": Unit::of_doc(doc).map(|unit| unit.symbol),
                "default": field["default"],
                "least": field["minimum"],
                "greatest": field["maximum"],
            })
        })
        .collect();
    let evidence: Vec<Value> = entry
        .evidence
        .iter()
        .map(|graded| {
            json!({
                "default_of": (!graded.key.is_empty()).then_some(graded.key),
                "grade": graded.grade.name(),
                "because": graded.because,
            })
        })
        .collect();
    json!({
        "model": entry.name,
        "meaning": entry.meaning(),
        "source": entry.source,
        "package": entry.origin.package.name,
        "example": entry.example,
        "parameters": parameters,
        "coefficients": entry.coefficients(),
        "terms": entry.terms.iter().map(|t| json!({ "name": t.name, "load_dependent": t.load_dependent })).collect::<Vec<_>>(),
        "observed": entry.observed.iter().map(|o| json!({ "name": o.name, "meaning": o.meaning, "unit": o.unit })).collect::<Vec<_>>(),
        "limits": entry.limits.iter().map(|l| json!({
            "name": l.name,
            "unit": l.unit,
            "least": l.least.is_finite().then_some(l.least),
            "greatest": l.greatest.is_finite().then_some(l.greatest),
            "origin": l.origin,
        })).collect::<Vec<_>>(),
        "evidence": evidence,
    })
}
