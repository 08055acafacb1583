//! Checked files: text and records.

mod record;

use gearloss_framework::document::{Diagnostic, visible_json};
use gearloss_framework::language::Language;
use gearloss_studies::checked::{CheckedGearbox, dry_bearings, out_of_bounds, overloaded};

pub use record::{CheckRecord, FileRecord};

use crate::card::{card, stage_lines};
use crate::page::outside;
use crate::point::remarks;

/// The resolved description as a document, with warnings and derived geometry as comments; `file` is the name of the gearbox.
///
/// # Errors
/// That the description cannot be written as YAML.
pub fn resolved_text(language: &Language, file: &str, checked: &CheckedGearbox) -> Result<String, Diagnostic> {
    let CheckedGearbox {
        resolved, transmission, ..
    } = checked;
    let yaml = serde_saphyr::to_string(&language.readable(&resolved.value));
    let yaml = yaml.map_err(|e| Diagnostic::error("", format!("cannot write YAML: {e}")))?;
    let mut text =
        format!("# {file} with all defaults, catalogue values and models; file names are relative to its folder\n");
    // As comments, so that the output is a valid gearbox.
    for warning in &transmission.warnings {
        for line in checked.gearbox.sources.render(warning).lines() {
            text.push_str(format!("# {line}").trim_end());
            text.push('\n');
        }
    }
    text.push_str(&visible_json(&yaml));
    // As comments, because they are not keys of a gearbox.
    text.push_str("# derived geometry\n");
    for stage in transmission.stages() {
        text.push_str(&format!("# {}:\n", stage.mesh));
        for figure in stage_lines(&stage) {
            text.push_str(&format!("#   {figure}\n"));
        }
    }
    for stage in transmission.crossed_stages() {
        text.push_str(&format!("# {}:\n", stage.mesh));
        for figure in stage_lines(&stage) {
            text.push_str(&format!("#   {figure}\n"));
        }
    }
    Ok(text)
}

/// How torques and losses are found in each gear, indented as the text of a gearbox.
pub fn torque_orders_text(checked: &CheckedGearbox) -> String {
    let mut text = String::new();
    for order in checked.transmission.torque_orders() {
        for line in order.to_string().lines() {
            text.push_str(&format!("  {line}\n"));
        }
    }
    text
}

/// A gearbox at a glance: warnings, stages and ratios, overloaded bearings, notes; `file` is its name.
pub fn checked_text(file: &str, checked: &CheckedGearbox) -> String {
    let CheckedGearbox {
        resolved, transmission, ..
    } = checked;
    let mut text = String::new();
    for warning in transmission.warnings.iter().chain(&checked.short_of_oil()) {
        text.push_str(&checked.gearbox.sources.render(warning));
        text.push_str("\n\n");
    }
    let states: Vec<&str> = transmission.states().iter().map(|s| s.name.as_str()).collect();
    text.push_str(&format!(
        "{file}: fine; {} components, gears: {}\n",
        transmission.parts().len(),
        states.join(", ")
    ));
    text.push_str(&card(checked));
    for line in outside(&overloaded(transmission)).lines() {
        let line = line.trim_start_matches("outside: ");
        text.push_str(&format!("  at the rated torque: {line}\n"));
    }
    for found in out_of_bounds(checked) {
        let sentence = found.quantity.sentence().unwrap_or_default();
        text.push_str(&format!(
            "  at the rated torque: {}: {sentence} (ratings.{})\n",
            found.component, found.rating
        ));
    }
    for found in &checked.load_sharings {
        text.push_str(&format!("  {}\n", found.sentence()));
    }
    for found in &checked.planet_sharings {
        text.push_str(&format!("  {}\n", found.sentence()));
    }
    let dry = dry_bearings(checked);
    if let Some(found) = dry.first() {
        let paths: Vec<&str> = dry.iter().map(|found| found.path.as_str()).collect();
        text.push_str(&format!("  {}: {}\n", paths.join(", "), found.message));
    }
    for line in remarks(resolved, &checked.changed, &checked.evidence) {
        text.push_str(&format!("  {line}\n"));
    }
    text
}
