//! Ratings at a solved point: a table for each mechanism, and what is outside its bounds.

use gearloss_framework::evaluate::{Ratings, Solution};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::distinct::distinct;
use gearloss_studies::ratings::{RatedComponent, RatedQuantity, rated};

use super::explain::steps;
use crate::page::Blocks;
use crate::text::{Lines, TextTable, figures, significant};

/// Mark of a value outside its bound.
const OUTSIDE: &str = "!";

/// Digits of values in tables and warnings.
const DIGITS: u32 = 4;

/// The ratings as text. Empty without any.
pub fn ratings_text(ratings: &[RatedComponent]) -> String {
    ratings_blocks(ratings).render()
}

/// The ratings: a table for each mechanism with a row for each component, then one line for each value outside its bound. Empty without
/// any.
pub fn ratings_blocks(ratings: &[RatedComponent]) -> Blocks {
    let mut blocks = Blocks::default();
    let mut mechanisms: Vec<&str> = Vec::new();
    for rated in ratings {
        if !mechanisms.contains(&rated.mechanism) {
            mechanisms.push(rated.mechanism);
        }
    }
    for mechanism in mechanisms {
        let of_mechanism: Vec<&RatedComponent> = ratings.iter().filter(|rated| rated.mechanism == mechanism).collect();
        if let Some(table) = table(mechanism, &of_mechanism) {
            blocks.text("\n");
            blocks.table(table);
        }
    }
    for line in ratings.iter().flat_map(rating_lines) {
        blocks.text(&format!("{line}\n"));
    }
    if let Some(lowest) = ratings.iter().map(|rated| rated.evidence).max() {
        let lowest_rated = ratings
            .iter()
            .filter(|rated| rated.evidence == lowest)
            .map(|rated| rated.rating);
        let grade = lowest.name();
        blocks.text(&format!(
            "lowest evidence grade of the ratings: {grade} ({})\n",
            distinct(lowest_rated).join(", ")
        ));
    }
    blocks
}

/// A table of the components of one mechanism; a column for each quantity that is not an intermediate.
fn table(mechanism: &str, ratings: &[&RatedComponent]) -> Option<TextTable> {
    let mut columns: Vec<(&str, &str)> = Vec::new();
    let mut components: Vec<&str> = Vec::new();
    for rated in ratings {
        for quantity in rated.quantities.iter().filter(|q| !q.detail) {
            if !columns.contains(&(rated.rating, quantity.symbol)) {
                columns.push((rated.rating, quantity.symbol));
            }
            if components.last() != Some(&rated.component.as_str()) {
                components.push(&rated.component);
            }
        }
    }
    let quantity = |component: Option<&str>, (rating, symbol): (&str, &str)| -> Option<&RatedQuantity> {
        let of = ratings
            .iter()
            .filter(|rated| rated.rating == rating && component.is_none_or(|component| component == rated.component));
        of.flat_map(|rated| &rated.quantities).find(|q| q.symbol == symbol)
    };
    let head = |column: &(&str, &str)| match quantity(None, *column) {
        Some(q) if q.unit != "-" => format!("{} {}", q.symbol, q.unit),
        _ => column.1.to_owned(),
    };
    let table = TextTable::of(&components)
        .column("component", |component| **component)
        .each(&columns, |table, column| {
            table.column(head(column), |component| match quantity(Some(component), *column) {
                Some(q) if q.outside => format!("{}{OUTSIDE}", figures(q.value, DIGITS)),
                Some(q) => figures(q.value, DIGITS),
                None => "-".to_owned(),
            })
        });
    (!components.is_empty()).then(|| table.finish().titled(format!("Ratings: {mechanism}")))
}

/// A line for each value outside its bound, for a rating that is undefined, and for a formula outside its stated range.
pub fn rating_lines(rated: &RatedComponent) -> Vec<String> {
    let mut lines = Vec::new();
    let faults = rated.quantities.iter().filter_map(RatedQuantity::sentence);
    lines.extend(faults.map(|sentence| format!("warning: {}: {sentence} (ratings.{})", rated.component, rated.rating)));
    lines.extend(
        rated
            .undefined
            .iter()
            .map(|reason| format!("note: {}: {}: {reason}", rated.component, rated.rating)),
    );
    let left = rated.outside_ranges.iter();
    lines.extend(left.map(|sentence| format!("note: {}: {}: {sentence}", rated.component, rated.rating)));
    lines
}

/// The steps of the ratings of a part, by its number.
pub fn explain_ratings(transmission: &Transmission, ratings: &Ratings, solution: &Solution<'_>, part: usize) -> String {
    let (found, trace) = ratings.explain(solution, part);
    let mut out = Lines::default();
    if found.is_empty() {
        return String::new();
    }
    out.line(format!("{}: ratings", transmission.parts()[part].path));
    for found_rating in &found {
        let entry = &found_rating.plugin.entry;
        out.line(format!("  {}: {}", entry.name, entry.meaning()));
        out.line(format!("  source: {}", entry.source));
        for graded in entry.evidence.iter().filter(|graded| graded.key.is_empty()) {
            out.line(format!("  evidence: {} ({})", graded.grade.name(), graded.because));
        }
    }
    steps(ratings.instances(), trace, &mut out);
    let path = &transmission.parts()[part].path;
    for component in rated(ratings, transmission, solution)
        .iter()
        .filter(|component| component.component == *path)
    {
        for quantity in &component.quantities {
            let unit = if quantity.unit == "-" { "" } else { quantity.unit };
            let line = format!(
                "  {} {} = {} {unit}",
                quantity.meaning,
                quantity.symbol,
                significant(quantity.value)
            );
            out.line(line.trim_end());
        }
        for line in rating_lines(component) {
            out.line(format!("  {line}"));
        }
    }
    out.line("");
    out.into_text()
}
