//! The requirements of the framework on ratings.

use std::sync::Arc;

use serde_json::Value;

use super::head;
use crate::checks;
use crate::language::Language;
use crate::loss::{Notes, Undefined};
use crate::mechanism::Mechanism;
use crate::registry::{Build, Files, RatingPlugin, Registry, from_resolved};

/// Checks every linked rating on its example part, and its check values. Returns one line for each fault.
pub(super) fn check_all(language: &Language) -> Vec<String> {
    let mut faults = Vec::new();
    for plugin in language.registry().ratings() {
        let name = plugin.entry.name;
        let checks = checks::faults_of_rating(language, plugin).into_iter();
        faults.extend(checks.map(|fault| format!("rating {name}: {fault}")));
        match language.example_of_rating(plugin) {
            Ok((rating, part)) => {
                let found = (plugin.conform)(language.registry(), &Files::default(), plugin, &rating, &part);
                faults.extend(found.into_iter().map(|fault| format!("rating {name}: {fault}")));
            }
            Err(found) => faults.extend(found.iter().map(|d| format!("rating {name}: its example: {d}"))),
        }
    }
    faults
}

/// The faults of one rating, built from its resolved parameters, on one resolved part: it returns only listed quantities, each once,
/// with finite values, and the same for both directions of rotation.
pub fn conform_rating<M: Mechanism>(
    registry: &Registry,
    files: &Files,
    plugin: &RatingPlugin,
    rating: &Value,
    part: &Value,
) -> Vec<String> {
    let mut faults = head(&plugin.entry);
    for figure in plugin.figures {
        if [figure.symbol, figure.unit, figure.meaning]
            .iter()
            .any(|text| text.is_empty())
        {
            faults.push(format!("`{}` has no symbol, unit or meaning", figure.symbol));
        }
    }
    let part: Arc<M::Part> = match from_resolved(part) {
        Ok(part) => Arc::new(part),
        Err(e) => return vec![format!("the example part cannot be read: {e}")],
    };
    let slot = match Build::new(registry, files).rating::<M>("rating", &part, &plugin.entry, rating) {
        Ok(slot) => slot,
        Err(e) => return vec![format!("cannot be built from its defaults: {e}")],
    };
    let usual = M::usual(&part, Notes::MUTED);
    let mut try_at = |what: &str, changes: &[(usize, f64)]| {
        let (mut at, mut mirrored) = (usual, usual);
        for (i, value) in changes {
            let q = &M::QUANTITIES[*i];
            (q.set)(&mut at, q.unit.to_si(*value));
            (q.set)(&mut mirrored, q.unit.to_si(*value));
        }
        for q in M::QUANTITIES.iter().filter(|q| q.unit.symbol == "rpm" && q.least < 0.0) {
            let speed = (q.get)(&mirrored);
            (q.set)(&mut mirrored, -speed);
        }
        let result = slot.rate(&at);
        if result != slot.rate(&mirrored) {
            faults.push(format!("depends on the direction of rotation at {what}"));
        }
        match result {
            Err(Undefined { what: "", .. }) => faults.push(format!("undefined without a reason at {what}")),
            Err(_) => {}
            Ok(rated) => {
                for (i, one) in rated.figures().iter().enumerate() {
                    let symbol = one.figure.symbol;
                    if !plugin.figures.contains(&one.figure) {
                        faults.push(format!("returns `{symbol}`, which it does not list, at {what}"));
                    }
                    if rated.figures()[..i].iter().any(|other| other.figure == one.figure) {
                        faults.push(format!("returns `{symbol}` twice at {what}"));
                    }
                }
            }
        }
    };
    try_at("the usual point", &[]);
    for (i, q) in M::QUANTITIES.iter().enumerate() {
        for value in [
            q.least,
            q.greatest,
            0.5 * (q.least + q.greatest),
            0.0_f64.clamp(q.least, q.greatest),
        ] {
            try_at(&format!("{} = {value}", q.name), &[(i, value)]);
            for (j, other) in M::QUANTITIES.iter().enumerate().skip(i + 1) {
                for second in [other.least, other.greatest] {
                    let what = format!("{} = {value}, {} = {second}", q.name, other.name);
                    try_at(&what, &[(i, value), (j, second)]);
                }
            }
        }
    }
    faults.dedup();
    faults.truncate(12);
    faults
}
