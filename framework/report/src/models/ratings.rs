//! Ratings of a program: tables and records.

use gearloss_framework::language::{Kind, Language};
use gearloss_framework::registry::RatingPlugin;
use gearloss_framework::resolve::RATINGS;
use serde_json::Value;

use super::{grade, parameters_table, ranges_and_evidence};
use crate::text::{Lines, TextTable};

/// Names and schemas of the parameters of a rating, from the schema of gearboxes.
pub(super) fn parameters(rating: &RatingPlugin, schema: &Value) -> Vec<(String, Value)> {
    let choice = &schema["properties"][RATINGS]["properties"][rating.entry.name];
    let records = choice["anyOf"].as_array().into_iter().flatten();
    let fields = records.filter_map(|record| record["properties"].as_object()).flatten();
    fields.map(|(name, field)| (name.clone(), field.clone())).collect()
}

/// All ratings with their mechanism.
pub fn ratings_list(language: &Language) -> String {
    TextTable::of(language.registry().ratings().iter().map(|rating| &rating.entry))
        .column("rating", |entry| entry.name)
        .column("mechanism", |entry| entry.mechanism)
        .column("crate", |entry| entry.origin.package.name)
        .column("evidence", |entry| grade(entry))
        .column("description", |entry| entry.meaning())
        .finish()
        .render()
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
    let fields = parameters(rating, &language.published(Kind::Gearbox));
    out.text(&parameters_table(&fields).render());
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
