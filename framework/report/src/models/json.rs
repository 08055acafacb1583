//! `models --format json`: all data of mechanisms and models, for programs.

use gearloss_framework::document::Unit;
use gearloss_framework::language::{Kind, Language};
use gearloss_framework::mechanism::QuantityDoc;
use gearloss_framework::registry::{Entry, MechanismEntry};
use serde_json::{Value, json};

use super::{evaluation, parameters};

/// Mechanisms with their models in the format `gearloss-models/1`; all of them, or the selected ones.
pub fn models_json(language: &Language, mechanism: Option<&MechanismEntry>, model: Option<&Entry>) -> Value {
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
                .map(|entry| of_model(language, entry, &schema))
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
    json!({
        "format": "gearloss-models/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": registry.packages(),
        "mechanisms": mechanisms,
        "sets": sets,
    })
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

fn of_model(language: &Language, entry: &Entry, schema: &Value) -> Value {
    let parameters: Vec<Value> = parameters(entry, schema)
        .iter()
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
        "evaluation": evaluation(language, entry),
        "parameters": parameters,
        "coefficients": entry.coefficients(),
        "terms": entry.terms.iter().map(|t| json!({ "name": t.name, "load_dependent": t.load_dependent })).collect::<Vec<_>>(),
        "observed": entry.observed.iter().map(|o| json!({ "name": o.name, "meaning": o.meaning, "unit": o.unit })).collect::<Vec<_>>(),
        "limits": entry.limits.iter().map(|l| json!({
            "name": l.name,
            "meaning": l.meaning,
            "unit": l.unit,
            "least": l.least.is_finite().then_some(l.least),
            "greatest": l.greatest.is_finite().then_some(l.greatest),
            "origin": l.origin,
        })).collect::<Vec<_>>(),
        "evidence": evidence,
    })
}
