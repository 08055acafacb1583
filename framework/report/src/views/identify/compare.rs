//! Comparison of model sets as text.

use gearloss_studies::analyses::identify::compare::ComparisonOfSets;

use crate::page::Page;
use crate::text::{TextTable, figures, number};

/// A table of the sets and a verdict.
pub(super) fn show(name: &str, compared: &ComparisonOfSets, page: &mut Page) {
    if let Some(first) = compared.sets.first() {
        page.line(format!(
            "{name}: comparison of the model sets; wins and ratio are those of `{}` against the set of the row",
            first.model_set
        ));
        page.table(table(compared));
    }
    page.verdict(format!("{name}: {}", compared.sentence));
    page.line("");
}

fn table(compared: &ComparisonOfSets) -> TextTable {
    let mut table = TextTable::new(&[
        "set",
        "parameters",
        "delta AICc",
        "rms of the bands",
        "wins",
        "ratio (95 %)",
        "lack of fit p",
        "decision",
    ]);
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    for set in &compared.sets {
        let against = set.first_against_it.as_ref();
        let folds = against.and_then(|against| against.folds.as_ref());
        let rms = set.fold_rms.as_ref();
        table.row(vec![
            set.model_set.clone(),
            set.parameters.to_string(),
            number(Some(set.criterion_difference), 1),
            or_dash(rms.map(|list| list.iter().map(|x| figures(*x, 3)).collect::<Vec<_>>().join(" "))),
            or_dash(folds.map(|p| format!("{} of {}", p.won, p.groups))),
            or_dash(folds.map(|p| {
                let [low, high] = p.interval.map(|x| figures(x, 2));
                format!("{} ({low} to {high})", figures(p.ratio, 3))
            })),
            match set.lack_of_fit_probability {
                None => "-".to_owned(),
                Some(p) if p < 0.001 => "<0.001".to_owned(),
                Some(p) => format!("{p:.3}"),
            },
            or_dash(against.map(|c| c.decision.replace('_', " "))),
        ]);
    }
    table
}
