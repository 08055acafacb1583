//! Schemas of outputs: of results, with a head and one record for each linked analysis, and of documents with one type.

use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform as _};
use schemars::{JsonSchema, Schema};
use serde_json::{Value, json};

use crate::analyses::AnalysisKind;

/// Format of a result.
pub const FORMAT: &str = "gearloss-result/1";

/// The JSON Schema (draft-07) of the result of one analysis.
pub fn schema() -> Value {
    let mut generator = SchemaSettings::draft07().for_serialize().into_generator();
    let outcomes: Vec<Schema> = AnalysisKind::linked()
        .into_iter()
        .map(|kind| kind.outcome_schema(&mut generator))
        .collect();
    let mut definitions: Vec<(String, Value)> = generator.take_definitions(true).into_iter().collect();
    definitions.sort_by(|a, b| a.0.cmp(&b.0));
    for (_, definition) in &mut definitions {
        if let Ok(schema) = <&mut Schema>::try_from(definition) {
            RecursiveTransform(close).transform(schema);
        }
    }
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": FORMAT,
        "description": "Result of one analysis from `gearloss run`: a head, and the results under keys of the analysis.",
        "anyOf": outcomes,
        "definitions": definitions.into_iter().collect::<serde_json::Map<String, Value>>(),
    })
}

/// The JSON Schema (draft-07) of another output of the program, such as a solved point.
pub fn schema_of<T: JsonSchema>() -> Value {
    let generator = SchemaSettings::draft07().for_serialize().into_generator();
    let mut schema = generator.into_root_schema_for::<T>();
    RecursiveTransform(close).transform(&mut schema);
    schema.to_value()
}

/// Records have no additional keys. A record with several forms has the keys of all forms.
fn close(schema: &mut Schema) {
    let forms = ["anyOf", "oneOf"].into_iter().find(|key| schema.get(*key).is_some());
    if let (Some(key), Some(Value::Object(shared))) = (forms, schema.get("properties").cloned()) {
        let required = schema.remove("required");
        schema.remove("properties");
        schema.remove("type");
        for form in schema.get_mut(key).and_then(Value::as_array_mut).into_iter().flatten() {
            let Some(form) = form.as_object_mut() else { continue };
            let mut properties = shared.clone();
            if let Some(Value::Object(fields)) = form.remove("properties") {
                properties.extend(fields);
            }
            let lists = [required.as_ref(), form.get("required")].into_iter().flatten();
            let all: Vec<Value> = lists.filter_map(Value::as_array).flatten().cloned().collect();
            form.insert("properties".to_owned(), Value::Object(properties));
            form.insert("required".to_owned(), Value::Array(all));
        }
    }
    if schema.get("properties").is_some() && schema.get("additionalProperties").is_none() {
        schema.insert("additionalProperties".to_owned(), false.into());
    }
}
