//! What is known of the error of the models that bands contain, in words.

use gearloss_framework::resolve::OWN_MODELS;
use gearloss_studies::analyses::common::model_error::{ModelError, ModelErrorOfSet, StateOfModelError};

use crate::page::Page;
use crate::text::{TextTable, number, significant};

/// Share of the loss from which a law without a known error is named in a sentence.
const NAMED: f64 = 0.05;

/// Adds the laws as a table, and those without a known error as a sentence.
pub fn add(all: &[ModelErrorOfSet], page: &mut Page) {
    for of_set in all {
        page.table(table(of_set).titled(format!(
            "Error of the models: factor on the loss, from measured sets{}",
            of_models(&of_set.model_set)
        )));
        for law in of_set.laws.iter().filter(|law| !law.seen.is_empty()) {
            let sets: Vec<String> = law
                .seen
                .iter()
                .map(|set| format!("{} ({})", set.set, significant(set.ratio)))
                .collect();
            page.line(format!(
                "{}: derived from {}, which do not count",
                name(law),
                sets.join(", ")
            ));
        }
        if let Some(sentence) = unknown(of_set) {
            page.careful.push(sentence);
        }
    }
}

fn name(law: &ModelError) -> String {
    format!("{} {}", law.mechanism, law.model)
}

fn of_models(set: &str) -> String {
    if set == OWN_MODELS {
        String::new()
    } else {
        format!(", models {set}")
    }
}

fn table(of_set: &ModelErrorOfSet) -> TextTable {
    let end = |law: &ModelError, end: fn(f64, f64) -> f64| {
        let ratio = law.sets.iter().map(|set| set.ratio).reduce(end);
        ratio.map_or_else(|| "-".to_owned(), two_decimals)
    };
    let factor = |law: &ModelError, k: usize| match law.factor {
        Some(factor) => two_decimals(factor[k]),
        None => "unknown".to_owned(),
    };
    TextTable::of(&of_set.laws)
        .column("law", |law| name(law))
        .column("in", |law| law.kind.clone().unwrap_or_default())
        .column("components", |law| law.components.len().to_string())
        .column("% of the loss", |law| {
            number(law.share_of_loss.map(|share| 100.0 * share), 1)
        })
        .column("measured sets", |law| law.sets.len().to_string())
        .column("ratio from", |law| end(law, f64::min))
        .column("to", |law| end(law, f64::max))
        .column("factor 2.5 %", |law| factor(law, 0))
        .column("median", |law| factor(law, 1))
        .column("97.5 %", |law| factor(law, 2))
        .column("error", |law| law.state.words())
        .column("others' band contains", |law| match law.left_out {
            Some(left) => format!(
                "{} of {} means, all points of {}",
                left.means_inside, left.sets, left.points_inside
            ),
            None => "-".to_owned(),
        })
        .finish()
}

/// A factor or ratio with two decimals; beyond one hundred or below a hundredth in digits that count.
fn two_decimals(x: f64) -> String {
    if (0.01..100.0).contains(&x) {
        format!("{x:.2}")
    } else {
        format!("{x:.1e}")
    }
}

/// Which laws the bands do not contain the error of, the largest share of the loss first.
fn unknown(of_set: &ModelErrorOfSet) -> Option<String> {
    let mut unknown: Vec<&ModelError> = of_set
        .laws
        .iter()
        .filter(|law| law.state != StateOfModelError::Known)
        .collect();
    let share = |law: &ModelError| law.share_of_loss.unwrap_or(0.0);
    unknown.sort_by(|a, b| share(b).total_cmp(&share(a)));
    let weighed = of_set.laws.iter().any(|law| law.share_of_loss.is_some());
    let whole: f64 = unknown.iter().map(|law| share(law)).sum();
    let words = |law: &&ModelError| {
        let percent = law
            .share_of_loss
            .map_or_else(String::new, |x| format!(", {:.0} % of the loss", 100.0 * x));
        format!("{}{percent} ({})", name(law), law.state.words())
    };
    let named: Vec<String> = unknown
        .iter()
        .filter(|law| !weighed || share(law) >= NAMED)
        .map(words)
        .collect();
    if unknown.is_empty() {
        return None;
    }
    let of = if weighed {
        format!(" for {:.0} % of the loss", 100.0 * whole)
    } else {
        String::new()
    };
    let named = if named.is_empty() {
        String::new()
    } else {
        format!(": {}", named.join("; "))
    };
    let models = of_models(&of_set.model_set);
    Some(format!(
        "the error of the models is unknown and not in the bands{of}{models}{named}"
    ))
}
