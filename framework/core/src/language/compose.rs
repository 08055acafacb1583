//! Combines the schemas of the framework, of mechanisms and of models into one per kind of document.

use schemars::generate::SchemaSettings;
use schemars::transform::{RemoveRefSiblings, Transform as _};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Map, Value, json};

use super::{HELD, NAMED};
use crate::description::GearboxEntry;
use crate::document::publish;
use crate::registry::{MechanismEntry, RatingPlugin, Registry};
use crate::resolve::RATINGS;

/// The schema of a gearbox.
pub(super) fn gearbox(registry: &Registry) -> Value {
    let mut generator = generator();
    let mut root = GearboxEntry::json_schema(&mut generator).to_value();
    let sections: Vec<(&str, Value)> = registry
        .sections()
        .map(|(m, s)| (s.name, section(m, &(s.schemas)(&mut generator))))
        .collect();
    let properties = properties(&mut root);
    for (name, schema) in sections {
        properties.insert(name.to_owned(), schema);
    }
    properties.insert(
        "models".to_owned(),
        models(registry, &mut Map::new(), "Default model of components, by mechanism."),
    );
    properties.insert("model_sets".to_owned(), sets(registry));
    let ratings: Map<String, Value> = registry
        .ratings()
        .iter()
        .map(|r| (r.entry.name.to_owned(), choice_of_rating(r, &mut generator)))
        .collect();
    let properties = self::properties(&mut root);
    properties.insert(
        RATINGS.to_owned(),
        json!({
            "type": "object",
            "description": "Ratings at solved points, by name: life, safety, film, temperature. All are on with their defaults; `none` omits one.",
            "properties": ratings,
        }),
    );
    let mut schema = finish(registry, generator, root);
    // Omitted keys of a gearbox may be in the one that it extends.
    if let Some(object) = schema.as_object_mut()
        && let Some(required) = object.shift_remove("required")
    {
        object.insert("if".to_owned(), json!({ "required": ["extends"] }));
        object.insert("else".to_owned(), json!({ "required": required }));
    }
    schema
}

/// The schema of a document of another crate, with model sets like those of a gearbox.
pub(super) fn document(registry: &Registry, schema: fn(&mut SchemaGenerator) -> Schema) -> Value {
    let mut generator = generator();
    let mut root = schema(&mut generator).to_value();
    properties(&mut root).insert("model_sets".to_owned(), sets(registry));
    finish(registry, generator, root)
}

/// The schema of `eval` input, for all mechanisms.
pub(super) fn eval(registry: &Registry) -> Value {
    let mut generator = generator();
    let variants: Vec<Value> = registry
        .mechanisms()
        .iter()
        .map(|m| eval_record(m, &mut generator))
        .collect();
    let root = json!({ "title": "eval", "description": "Input of `gearloss eval`, by mechanism.", "anyOf": variants });
    finish(registry, generator, root)
}

/// The schema of `eval` input for one mechanism.
pub(super) fn eval_of(registry: &Registry, mechanism: &str) -> Value {
    let mut generator = generator();
    let root = match registry.mechanism(mechanism) {
        Some(m) => eval_record(m, &mut generator),
        None => json!({ "type": "object", "properties": {} }),
    };
    finish(registry, generator, root)
}

/// The parameters of a rating.
fn parameters_of_rating(rating: &RatingPlugin, generator: &mut SchemaGenerator) -> Value {
    let mut schema = (rating.entry.schema)(generator).to_value();
    if let Some(object) = schema.as_object_mut() {
        object.remove("title");
        object.entry("type").or_insert(json!("object"));
        object.entry("properties").or_insert_with(|| json!({}));
    }
    schema
}

/// The parameters of a rating, or `none`.
fn choice_of_rating(rating: &RatingPlugin, generator: &mut SchemaGenerator) -> Value {
    json!({
        "description": rating.entry.meaning(),
        "anyOf": [
            parameters_of_rating(rating, generator),
            { "type": "string", "enum": ["none"], "description": "Not rated." },
        ],
    })
}

/// The schema of the input of a rating that is evaluated alone.
pub(super) fn rating(registry: &Registry, rating: &RatingPlugin) -> Value {
    let mut generator = generator();
    let parameters = parameters_of_rating(rating, &mut generator);
    let mut root = match registry.mechanism(rating.entry.mechanism) {
        Some(mechanism) => eval_record(mechanism, &mut generator),
        None => json!({ "type": "object", "properties": {} }),
    };
    let properties = properties(&mut root);
    properties.shift_remove("model");
    properties.insert("rating".to_owned(), parameters);
    finish(registry, generator, root)
}

fn eval_record(mechanism: &MechanismEntry, generator: &mut SchemaGenerator) -> Value {
    let mut at = Map::new();
    for q in (mechanism.quantities)() {
        at.insert(
            q.name.to_owned(),
            json!({ "type": "number", "description": q.doc.trim(), "minimum": q.least, "maximum": q.greatest }),
        );
    }
    let part = (mechanism.part)(generator).to_value();
    json!({
        "type": "object",
        "title": mechanism.key,
        "description": format!("A single {} model.", mechanism.key),
        "properties": {
            "model": { "$ref": format!("#/definitions/{}_model", mechanism.key) },
            "part": part,
            "at": {
                "type": "object",
                "description": "Quantities of the context; default: their usual values.",
                "properties": at,
                "default": {},
            },
        },
    })
}

fn generator() -> SchemaGenerator {
    SchemaSettings::draft07().into_generator()
}

fn properties(schema: &mut Value) -> &mut Map<String, Value> {
    let object = schema.as_object_mut().expect("a record's schema is an object");
    object
        .entry("properties")
        .or_insert_with(|| json!({}))
        .as_object_mut()
        .expect("properties are an object")
}

fn model_ref(key: &str) -> Value {
    json!({ "$ref": format!("#/definitions/{key}_model") })
}

/// A section of components: place, part and common keys, merged, and the slot of the model.
fn section(mechanism: &MechanismEntry, schemas: &[Schema]) -> Value {
    let mut fields = Map::new();
    let mut required: Vec<Value> = Vec::new();
    for schema in schemas {
        let schema = schema.as_value();
        if let Some(more) = schema.get("properties").and_then(Value::as_object) {
            fields.extend(more.iter().map(|(k, v)| (k.clone(), v.clone())));
        }
        required.extend(
            schema
                .get("required")
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
                .cloned(),
        );
    }
    let mut slot = model_ref(mechanism.key);
    slot["description"] = json!("Loss model; default: that of `models`.");
    fields.insert(
        "model".to_owned(),
        json!({ "allOf": [model_ref(mechanism.key)], "description": slot["description"] }),
    );
    json!({
        "type": "object",
        "description": mechanism.meaning,
        "additionalProperties": { "type": "object", "description": mechanism.meaning, "properties": fields, "required": required },
    })
}

/// A record with a slot for each mechanism with a default model.
fn models(registry: &Registry, fields: &mut Map<String, Value>, description: &str) -> Value {
    for mechanism in registry.mechanisms() {
        if NAMED.contains(&mechanism.key) {
            let slots = json!({
                "type": "object",
                "description": format!("{} Models by name.", mechanism.meaning),
                "additionalProperties": model_ref(mechanism.key),
            });
            fields.insert(mechanism.key.to_owned(), slots);
        } else if mechanism.section.is_some() || HELD.iter().any(|(_, key)| *key == mechanism.key) {
            let slot = json!({ "allOf": [model_ref(mechanism.key)], "description": mechanism.meaning });
            fields.insert(mechanism.key.to_owned(), slot);
        }
    }
    json!({ "type": "object", "description": description, "properties": fields })
}

fn sets(registry: &Registry) -> Value {
    let mut fields = Map::new();
    fields.insert(
        "extends".to_owned(),
        json!({ "type": "string", "description": "Model set that this one extends.", "x-refers-to": "model_sets" }),
    );
    fields.insert(
        "components".to_owned(),
        json!({
            "type": "object",
            "description": "Models of single components by path, such as `bearings.B1.model`; `*` matches one id.",
            "x-keys": "path",
            "additionalProperties": true,
        }),
    );
    fields.insert(
        "set".to_owned(),
        json!({
            "type": "object",
            "description": "Values that belong to the set: resolved path to value. The conditions of a study take precedence.",
            "x-keys": "path",
            "additionalProperties": true,
        }),
    );
    let set = models(registry, &mut fields, "A model set; it replaces `models`.");
    json!({ "type": "object", "description": "Model sets by name.", "additionalProperties": set })
}

/// Adds the definitions of all model slots and writes the complete schema.
fn finish(registry: &Registry, mut generator: SchemaGenerator, mut root: Value) -> Value {
    let mut definitions = Map::new();
    for mechanism in registry.mechanisms() {
        let mut variants = Vec::new();
        for entry in registry.models(mechanism.key) {
            let mut schema = (entry.schema)(&mut generator).to_value();
            let object = schema.as_object_mut().expect("a model's parameters are a record");
            object.insert("title".to_owned(), json!(entry.name));
            object.entry("type").or_insert(json!("object"));
            let fields = object.remove("properties").unwrap_or_else(|| json!({}));
            let mut with_type = Map::new();
            with_type.insert(
                "type".to_owned(),
                json!({ "const": entry.name, "description": entry.meaning() }),
            );
            if let Value::Object(fields) = fields {
                with_type.extend(fields);
            }
            object.insert("properties".to_owned(), Value::Object(with_type));
            let mut required = vec![json!("type")];
            required.extend(
                object
                    .remove("required")
                    .and_then(|r| r.as_array().cloned())
                    .into_iter()
                    .flatten(),
            );
            object.insert("required".to_owned(), Value::Array(required));
            variants.push(schema);
        }
        variants.push(json!({
            "const": "none",
            "description": "No loss.",
            "errorMessage": "Expected a model, `{ type: NAME }` with its parameters, or `none`.",
        }));
        let mut slot = Map::new();
        slot.insert("description".to_owned(), json!(mechanism.meaning));
        slot.insert("oneOf".to_owned(), Value::Array(variants));
        slot.insert("x-mechanism".to_owned(), json!(mechanism.key));
        definitions.insert(format!("{}_model", mechanism.key), Value::Object(slot));
    }
    for (name, schema) in generator.take_definitions(false) {
        definitions.insert(name, schema);
    }
    let object = root.as_object_mut().expect("a document's schema is an object");
    object.insert("$schema".to_owned(), json!("http://json-schema.org/draft-07/schema#"));
    object.insert("definitions".to_owned(), Value::Object(definitions));
    flatten_tagged(&mut root);
    let mut schema = Schema::try_from(root).expect("an object is a schema");
    // The one of schemars' transforms for draft-07 that changes something here: tuples are refused when the schema is compiled, and
    // `publish` closes records.
    RemoveRefSiblings::default().transform(&mut schema);
    publish(schema.to_value())
}

/// A variant of a tagged enum consists of its tag and a reference to its record: merges both into one record, so that it can be closed.
fn flatten_tagged(root: &mut Value) {
    let Some(definitions) = root.get_mut("definitions").and_then(Value::as_object_mut) else {
        return;
    };
    let records = definitions
        .iter()
        .filter(|(_, schema)| schema.get("properties").is_some());
    let records: Map<String, Value> = records.map(|(name, record)| (name.clone(), record.clone())).collect();
    for schema in definitions.values_mut() {
        for variant in schema
            .get_mut("oneOf")
            .and_then(Value::as_array_mut)
            .into_iter()
            .flatten()
        {
            let Some(variant) = variant.as_object_mut() else {
                continue;
            };
            let reference = variant
                .get("$ref")
                .or_else(|| variant.get("allOf")?.get(0)?.get("$ref"));
            let name = reference
                .and_then(Value::as_str)
                .and_then(|r| r.rsplit('/').next())
                .map(str::to_owned);
            let (true, Some(record)) = (
                variant.contains_key("properties"),
                name.and_then(|name| records.get(&name)),
            ) else {
                continue;
            };
            variant.shift_remove("$ref");
            variant.shift_remove("allOf");
            for key in ["properties", "required"] {
                match (variant.get_mut(key), record.get(key)) {
                    (Some(Value::Object(present)), Some(Value::Object(more))) => {
                        present.extend(more.iter().map(|(k, v)| (k.clone(), v.clone())));
                    }
                    (Some(Value::Array(present)), Some(Value::Array(more))) => present.extend(more.iter().cloned()),
                    _ => {}
                }
            }
        }
    }
}
