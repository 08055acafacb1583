//! The most influential parameters in one sentence.

use gearloss_studies::analyses::sensitivity::{SensitivityOfSet, SensitivityOutcome};

use super::{Influences, descending, influences};
use crate::page::Page;
use crate::text::{last_key, of_set, short};

/// Parameters that are named.
const NAMED: usize = 3;

pub fn add(outcome: &SensitivityOutcome, page: &mut Page) {
    let mut words = Vec::new();
    for set in &outcome.sensitivities {
        let Some(loss) = set.outputs.first() else { continue };
        let Some(Influences { values, unit, of }) = influences(loss) else {
            continue;
        };
        let order = descending(&values);
        let named = order
            .iter()
            .take(NAMED)
            .map(|k| format!("{} {} {unit}", name(set, *k), short(values[*k])));
        words.push(format!(
            "{}{of}: {}",
            of_set(&set.model_set, outcome.sensitivities.len()),
            named.collect::<Vec<_>>().join(", ")
        ));
        if let Some(first) = order.first() {
            page.key_figure(
                "most influential",
                name(set, *first),
                "",
                format!("{} {unit}, {of}", short(values[*first])),
            );
        }
    }
    page.headline = (!words.is_empty()).then(|| words.join("; "));
}

/// The end of the path of a parameter.
fn name(set: &SensitivityOfSet, k: usize) -> &str {
    last_key(&set.parameters[k].path)
}
