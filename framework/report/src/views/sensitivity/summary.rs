//! The most influential parameters in one sentence.

use gearloss_studies::analyses::sensitivity::{OutputSensitivity, SensitivityOfSet, SensitivityOutcome};

use super::descending;
use crate::page::Page;
use crate::text::{of_set, short};

/// Parameters that are named.
const NAMED: usize = 3;

pub fn add(outcome: &SensitivityOutcome, page: &mut Page) {
    let mut words = Vec::new();
    for set in &outcome.sensitivities {
        let Some(loss) = set.outputs.first() else { continue };
        let Some((values, unit, of)) = influence(loss) else {
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

/// The influence of each parameter on the mean loss by the best method that was run: value, unit, meaning.
fn influence(loss: &OutputSensitivity) -> Option<(Vec<f64>, &'static str, &'static str)> {
    if let Some(shares) = loss.sobol.as_ref().filter(|shares| shares.variance > 0.0) {
        let shares = shares.total.iter().map(|share| 100.0 * share.value.max(0.0));
        return Some((shares.collect(), "%", "share of the variance of the mean loss"));
    }
    if let Some(effects) = &loss.morris {
        let effects = effects.iter().map(|effect| effect.mu_star);
        return Some((effects.collect(), "W", "change of the mean loss over the range"));
    }
    let slopes = loss
        .local
        .as_ref()?
        .iter()
        .map(|slope| slope.scaled.map_or(0.0, |s| 100.0 * s.abs()));
    Some((slopes.collect(), "%", "slope times range, of the mean loss"))
}

/// The end of the path of a parameter.
fn name(set: &SensitivityOfSet, k: usize) -> &str {
    let path = &set.parameters[k].path;
    path.rsplit('.').next().unwrap_or(path)
}
