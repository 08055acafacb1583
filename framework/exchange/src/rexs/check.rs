//! Fits a draft to what the program needs: bearings whose data do not suffice for a model get another one, or none, and thrust that several
//! bearings take is divided.

use std::collections::BTreeMap;

use gearloss_document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;

use super::draft::{Bearing, Draft};
use super::source::Source;
use super::yaml;

/// Rounds of changes: each bearing and shaft has at most three, and a change may uncover an error of the next stage.
const ROUNDS: usize = 10;

/// Changes the models of bearings and the arrangement of bearings until they cause no error, and returns the transmission; or lines of other
/// errors, which `check` reports too.
pub fn fit(draft: &mut Draft, language: &Language, source: &Source<'_>) -> Result<Transmission, Vec<String>> {
    let mut reasons: BTreeMap<String, String> = BTreeMap::new();
    let mut built = Err(Vec::new());
    for _ in 0..ROUNDS {
        built = build(&yaml::gearbox(draft), language);
        let mut changed = false;
        for finding in built.as_ref().err().into_iter().flatten() {
            changed |= other_model(draft, finding, &mut reasons)
                || without_bearings(draft, finding, source)
                || arrange(draft, finding, source);
        }
        if !changed {
            break;
        }
    }
    for bearing in &draft.bearings {
        if let Some(reason) = reasons.get(&bearing.id) {
            let (id, comment) = (&bearing.id, &bearing.comment);
            match bearing.model {
                Some("none") => source.missing(format!(
                    "{id} ({comment}): {reason}; its loss is left out (`model: none`)"
                )),
                Some(model) => source.assume(format!("{id} ({comment}): the model is {model}, because {reason}")),
                None => {}
            }
        }
    }
    built.map_err(|found| found.iter().map(ToString::to_string).collect())
}

/// The transmission of a gearbox, or its errors.
fn build(text: &str, language: &Language) -> Result<Transmission, Vec<Diagnostic>> {
    let read = Gearbox::of_text(language, text, "gearbox.yaml", "");
    let built = read.and_then(|gearbox| gearbox.transmission(language, &Choice::default()));
    built.map_err(|findings| findings.list)
}

/// A model that a bearing's data do not suffice for is replaced: ISO/TR 14179-2 instead of SKF, then none.
fn other_model(draft: &mut Draft, finding: &Diagnostic, reasons: &mut BTreeMap<String, String>) -> bool {
    let mut path = finding.path.split('.');
    let (Some("bearings"), Some(id), Some("model")) = (path.next(), path.next(), path.next()) else {
        return false;
    };
    let Some(bearing) = draft.bearings.iter_mut().find(|bearing| bearing.id == id) else {
        return false;
    };
    let next = match bearing.model {
        None => "iso14179_2",
        Some("none") => return false,
        Some(_) => "none",
    };
    // What the usual model lacks is what a user would add.
    reasons.entry(id.to_owned()).or_insert_with(|| match &finding.help {
        Some(help) => format!("{} ({help})", finding.message),
        None => finding.message.clone(),
    });
    bearing.model = Some(next);
    true
}

/// A loaded shaft without bearings says so.
fn without_bearings(draft: &mut Draft, finding: &Diagnostic, source: &Source<'_>) -> bool {
    if finding.code != Some(gearloss_framework::codes::NO_BEARING) {
        return false;
    }
    let id = finding.path.split('.').nth(1).unwrap_or_default();
    let Some(shaft) = draft
        .shafts
        .iter_mut()
        .find(|shaft| shaft.id == id && !shaft.unsupported)
    else {
        return false;
    };
    shaft.unsupported = true;
    source.missing(format!(
        "bearings of {id} ({}): the file has none (`bearings: none`)",
        shaft.comment
    ));
    true
}

/// A single bearing takes the tilting moment. Of several bearings that take thrust in one direction, those in the housing take it; if they are
/// several, each takes an equal part.
fn arrange(draft: &mut Draft, finding: &Diagnostic, source: &Source<'_>) -> bool {
    if finding.code != Some(gearloss_framework::codes::SUPPORT) {
        return false;
    }
    let mut path = finding.path.split('.');
    let (Some("shafts"), Some(id), None) = (path.next(), path.next(), path.next()) else {
        return false;
    };
    let mut touching: Vec<&mut Bearing> = draft
        .bearings
        .iter_mut()
        .filter(|bearing| bearing.shaft == id || bearing.outer.as_deref() == Some(id))
        .collect();
    if let [only] = touching.as_mut_slice() {
        if only.takes_moment {
            return false;
        }
        only.takes_moment = true;
        source.assume(format!("{} supports {id} alone and takes its tilting moment", only.id));
        return true;
    }
    let mut locating: Vec<&mut Bearing> = touching
        .into_iter()
        .filter(|bearing| bearing.shaft == id && bearing.axial != "none")
        .collect();
    let in_housing = locating.iter().any(|bearing| bearing.outer.is_none());
    let between = locating
        .iter_mut()
        .filter(|bearing| in_housing && bearing.outer.is_some());
    let mut changed = false;
    for bearing in between {
        bearing.axial = "none";
        changed = true;
        source.assume(format!(
            "{} takes no thrust of {id}, because bearings in the housing do",
            bearing.id
        ));
    }
    if changed || locating.len() < 2 {
        return changed;
    }
    // Shares apply to each direction: with `left` and `right` bearings the number differs.
    let count = |side: &str| {
        let takes = locating
            .iter()
            .filter(|bearing| bearing.axial == "both" || bearing.axial == side);
        takes.count()
    };
    let most = count("left").max(count("right"));
    if most < 2 || locating.iter().all(|bearing| bearing.axial_share.is_some()) {
        return false;
    }
    for bearing in &mut locating {
        bearing.axial_share = Some(1.0 / most as f64);
    }
    source.assume(format!(
        "the thrust of {id} is divided equally among its {} bearings that can take it",
        locating.len()
    ));
    true
}
