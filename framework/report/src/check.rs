//! Checked files: text and records.

pub mod document;

use gearloss_framework::document::{Diagnostic, PlacedDiagnostic, Sources, visible_json};
use gearloss_framework::language::Language;
use gearloss_framework::transmission::{GearState, Transmission};
use gearloss_studies::bearings::bearing_cards;
use gearloss_studies::checked::{CheckedGearbox, out_of_bounds, overloaded};
use serde_json::{Map, Value, json};

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
    Ok(text)
}

/// A gearbox at a glance: warnings, stages and ratios, overloaded bearings, notes; `file` is its name.
pub fn checked_text(file: &str, checked: &CheckedGearbox) -> String {
    let CheckedGearbox {
        resolved, transmission, ..
    } = checked;
    let mut text = String::new();
    for warning in &transmission.warnings {
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
    for own in out_of_bounds(checked) {
        let sentence = own.quantity.sentence().unwrap_or_default();
        text.push_str(&format!(
            "  at the rated torque: {}: {sentence} (ratings.{})\n",
            own.component, own.rating
        ));
    }
    for line in remarks(resolved, &checked.changed, &checked.evidence) {
        text.push_str(&format!("  {line}\n"));
    }
    text
}

/// The same as a record, with the resolved description if `with_resolved`.
fn checked_json(checked: &CheckedGearbox, with_resolved: bool) -> Map<String, Value> {
    let CheckedGearbox {
        resolved, transmission, ..
    } = checked;
    let states: Vec<&str> = transmission.states().iter().map(|s| s.name.as_str()).collect();
    let notes: Vec<&String> = resolved
        .unreached
        .iter()
        .chain(&resolved.without)
        .chain(&resolved.designations)
        .collect();
    let mut built = Map::new();
    built.insert("parts".to_owned(), transmission.parts().len().into());
    built.insert("gear_states".to_owned(), json!(states));
    built.insert("stages".to_owned(), json!(transmission.stages().collect::<Vec<_>>()));
    built.insert("bearings".to_owned(), json!(bearing_cards(checked)));
    let fill = transmission.oil_fill().map(|(volume, mass)| {
        json!({ "volume_l": 1e3 * volume, "mass_kg": mass, "temperature_degc": transmission.oil_temperature })
    });
    built.insert("oil".to_owned(), json!(fill));
    built.insert("ratios".to_owned(), ratios(transmission));
    built.insert("notes".to_owned(), json!(notes));
    built.insert("changed_from_source".to_owned(), json!(checked.changed));
    built.insert(
        "weakest_evidence".to_owned(),
        checked.evidence.first().map_or(
            Value::Null,
            |weak| json!({ "grade": weak.grade.name(), "what": weak.what, "because": weak.because }),
        ),
    );
    if with_resolved {
        built.insert("resolved".to_owned(), resolved.value.clone());
    }
    built
}

/// Warnings of a valid gearbox with file, line and column.
fn warnings(checked: &CheckedGearbox) -> Vec<PlacedDiagnostic> {
    placed(&checked.warnings(), &checked.gearbox.sources)
}

/// The ratio from the reference port to each other port for each gear.
fn ratios(t: &Transmission) -> Value {
    let from = &t.ports()[t.reference_port()].name;
    let of_gear = |(i, gear): (usize, &GearState)| {
        let ratios = t.ratios(i).into_iter();
        ratios
            .map(|(to, ratio)| json!({ "gear": gear.name, "from": from, "to": t.ports()[to].name, "ratio": ratio }))
            .collect::<Vec<_>>()
    };
    t.states().iter().enumerate().flat_map(of_gear).collect()
}

/// Findings with file, line and column instead of spans.
fn placed(list: &[Diagnostic], sources: &Sources) -> Vec<PlacedDiagnostic> {
    list.iter().map(|finding| sources.placed(finding)).collect()
}
