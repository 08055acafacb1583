//! `models --format json`: all data of mechanisms and models, for programs.

use gearloss_framework::document::Unit;
use gearloss_framework::language::{Kind, Language};
use gearloss_framework::loss::Limit;
use gearloss_framework::mechanism::QuantityDoc;
use gearloss_framework::registry::{Check, Entry, Graded, MechanismEntry, RatingPlugin};
use serde_json::{Value, json};

use super::ratings::rating_json;
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
    let fits = |rating: &&RatingPlugin| {
        let own = mechanism.is_none_or(|only| only.key == rating.entry.mechanism);
        own && model.is_none()
    };
    let ratings = registry.ratings().iter().filter(fits);
    let ratings: Vec<Value> = ratings.map(|rating| rating_json(rating, &schema)).collect();
    json!({
        "format": "gearloss-models/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": registry.packages(),
        "mechanisms": mechanisms,
        "sets": sets,
        "ratings": ratings,
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
        "unit": quantity.unit.symbol,
        "usual": quantity.usual,
        "least": quantity.least,
        "greatest": quantity.greatest,
        "from": quantity.from,
    })
}

fn of_model(language: &Language, entry: &Entry, schema: &Value) -> Value {
    let parameters: Vec<Value> = parameters(entry, schema)
        .iter()
        .map(|(name, field)| parameter(name, field))
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
        "limits": entry.limits.iter().map(limit).collect::<Vec<_>>(),
        "evidence": evidence(entry),
        "checks": checks(entry),
    })
}

/// A parameter of a model or rating.
pub(super) fn parameter(name: &str, field: &Value) -> Value {
    let doc = field["description"].as_str().unwrap_or_default();
    json!({
        "name": name,
        "meaning": meaning(doc),
        "unit": Unit::of_doc(doc).map(|unit| unit.symbol),
        "default": field["default"],
        "least": field["minimum"],
        "greatest": field["maximum"],
    })
}

/// The check values of a model or rating.
pub(super) fn checks(entry: &Entry) -> Vec<Value> {
    let check = |check: &Check| {
        let values = check.values.iter();
        json!({
            "input": check.input,
            "values": values.map(|(quantity, value)| json!({ "quantity": quantity, "value": value })).collect::<Vec<_>>(),
            "tolerance": check.tolerance,
            "because": check.because,
            "source": check.source,
        })
    };
    entry.checks.iter().map(check).collect()
}

/// A stated range.
pub(super) fn limit(limit: &Limit) -> Value {
    json!({
        "name": limit.name,
        "meaning": limit.meaning,
        "unit": limit.unit,
        "least": limit.least.is_finite().then_some(limit.least),
        "greatest": limit.greatest.is_finite().then_some(limit.greatest),
        "origin": limit.origin,
    })
}

/// The grades of formula and defaults.
pub(super) fn evidence(entry: &Entry) -> Vec<Value> {
    let graded = |graded: &Graded| {
        json!({
            "default_of": (!graded.key.is_empty()).then_some(graded.key),
            "grade": graded.grade.name(),
            "because": graded.because,
        })
    };
    entry.evidence.iter().map(graded).collect()
}
