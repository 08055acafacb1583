//! The schema of results: the head, and one record of results for each analysis that is linked.

use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform as _};
use serde_json::{Value, json};

use crate::analyses::AnalysisKind;

/// Format of a result.
pub const FORMAT: &str = "gearloss-result/1";

/// The JSON Schema (draft-07) of what is written of one analysis.
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
        "description": "What `gearloss run` writes of one analysis: a head, and the results under keys of the analysis' own.",
        "anyOf": outcomes,
        "definitions": definitions.into_iter().collect::<serde_json::Map<String, Value>>(),
    })
}

/// Records have no other keys than theirs.
fn close(schema: &mut Schema) {
    if schema.get("properties").is_some() && schema.get("additionalProperties").is_none() {
        schema.insert("additionalProperties".to_owned(), false.into());
    }
}
