//! The most influential parameters in one sentence.

use gearloss_studies::analyses::sensitivity::{SensitivityOfSet, SensitivityOutcome};

use super::{Influences, descending, influences};
use crate::names::{listed, quantity};
use crate::page::Page;
use crate::text::{capitalised, of_set, short};

/// Parameters that are named.
const NAMED: usize = 3;

pub fn add(outcome: &SensitivityOutcome, page: &mut Page) {
    let mut words = Vec::new();
    for set in &outcome.sensitivities {
        let Some(loss) = set.outputs.first() else { continue };
        let Some(Influences {
            values,
            unit,
            of,
            brief,
        }) = influences(loss)
        else {
            continue;
        };
        let order = descending(&values);
        let named = order.iter().take(NAMED).filter(|k| values[**k] > 0.0);
        let named: Vec<String> = named
            .enumerate()
            .map(|(i, k)| {
                let brief = if i == 0 { format!(" {brief}") } else { String::new() };
                format!("the {} ({} {unit}{brief})", name(set, *k), short(values[*k]))
            })
            .collect();
        let depends = if named.is_empty() {
            "depends on none of the inputs".to_owned()
        } else {
            format!("depends most on {}", listed(&named))
        };
        words.push(format!(
            "{}the mean loss {depends}",
            of_set(&set.model_set, outcome.sensitivities.len())
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
    page.headline = (!words.is_empty()).then(|| capitalised(&words.join("; ")));
}

/// A parameter in words.
fn name(set: &SensitivityOfSet, k: usize) -> String {
    quantity(&set.parameters[k].path)
}
