//! Ratings of a program: tables and records.

use gearloss_framework::language::{Kind, Language};
use gearloss_framework::registry::RatingPlugin;
use gearloss_framework::resolve::RATINGS;
use serde_json::Value;

use super::ranges_and_evidence;
use crate::text::{Lines, TextTable, significant};

/// Names and schemas of the parameters of a rating, from the schema of gearboxes.
pub(super) fn parameters(rating: &RatingPlugin, schema: &Value) -> Vec<(String, Value)> {
    let choice = &schema["properties"][RATINGS]["properties"][rating.entry.name];
    let records = choice["anyOf"].as_array().into_iter().flatten();
    let fields = records.filter_map(|record| record["properties"].as_object()).flatten();
    fields.map(|(name, field)| (name.clone(), field.clone())).collect()
}

/// All ratings with their mechanism.
pub fn ratings_list(language: &Language) -> String {
    let mut table = TextTable::new(&["rating", "mechanism", "crate", "evidence", "description"]);
    for rating in language.registry().ratings() {
        let entry = &rating.entry;
        let formula = entry.evidence.iter().find(|g| g.key.is_empty());
        table.row(vec![
            entry.name.to_owned(),
            entry.mechanism.to_owned(),
            entry.origin.package.name.to_owned(),
            formula.map_or("", |g| g.grade.name()).to_owned(),
            entry.meaning(),
        ]);
    }
    table.render()
}

/// A rating with its parameters, quantities, stated ranges and evidence.
pub fn rating_text(language: &Language, rating: &RatingPlugin) -> String {
    let entry = &rating.entry;
    let mut out = Lines::default();
    out.line(format!("rating {}: {}", entry.name, entry.meaning()));
    out.line(format!("mechanism: {}", entry.mechanism));
    out.line(format!("source: {}", entry.source));
    out.line(format!("registered at {}", entry.origin));
    out.line("");
    let mut table = TextTable::new(&["parameter", "default", "range", "description"]);
    for (name, field) in parameters(rating, &language.published(Kind::Gearbox)) {
        let range = match (field["minimum"].as_f64(), field["maximum"].as_f64()) {
            (Some(least), Some(greatest)) => format!("{} to {}", significant(least), significant(greatest)),
            _ => String::new(),
        };
        let default = match &field["default"] {
            Value::Null => "-".to_owned(),
            value => value.to_string(),
        };
        let doc = field["description"].as_str().unwrap_or_default().to_owned();
        table.row(vec![name, default, range, doc]);
    }
    out.text(&table.render());
    out.line("");
    for figure in rating.figures {
        out.line(format!(
            "quantity: {} [{}]: {}",
            figure.symbol, figure.unit, figure.meaning
        ));
    }
    ranges_and_evidence(&mut out, entry);
    out.into_text()
}
