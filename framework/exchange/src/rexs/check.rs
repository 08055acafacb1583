//! Fits a draft to what models need: bearings whose data do not suffice for a model get another one, or none.

use std::collections::BTreeMap;

use gearloss_document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;

use super::draft::Draft;
use super::source::Source;
use super::yaml;

/// Rounds of changes; each bearing has at most two, and a change may uncover an error of the next stage.
const ROUNDS: usize = 6;

/// Changes the models of bearings and the supports of shafts until they cause no error. Other errors remain for `check`.
pub fn fit(draft: &mut Draft, language: &Language, source: &Source<'_>) {
    let mut reasons: BTreeMap<String, String> = BTreeMap::new();
    for _ in 0..ROUNDS {
        let found = findings(&yaml::gearbox(draft), language);
        let mut changed = false;
        for finding in &found {
            changed |= other_model(draft, finding, &mut reasons) || without_bearings(draft, finding, source);
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
}

/// The errors of a gearbox.
fn findings(text: &str, language: &Language) -> Vec<Diagnostic> {
    let read = Gearbox::of_text(language, text, "gearbox.yaml", "");
    match read.and_then(|gearbox| gearbox.transmission(language, &Choice::default())) {
        Ok(_) => Vec::new(),
        Err(findings) => findings.list,
    }
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
