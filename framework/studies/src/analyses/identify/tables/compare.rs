//! Comparison table of the model sets.

use super::super::compare::ComparisonOfSets;
use crate::table::Table;

/// The comparison of the sets.
pub(in crate::analyses::identify) fn table(name: &str, compared: &ComparisonOfSets) -> Table {
    let rows = compared.sets.iter().map(|set| {
        let against = set.first_against_it.as_ref();
        (set, against, against.and_then(|against| against.folds.as_ref()))
    });
    Table::of(format!("{name}-sets"), rows)
        .text("model_set", "Model set, the best first", |(set, ..)| &set.model_set)
        .number("parameters", "-", "Number of parameters", |(set, ..)| {
            set.parameters as f64
        })
        .number(
            "criterion_difference",
            "-",
            "Akaike's criterion minus that of the first set",
            |(set, ..)| set.criterion_difference,
        )
        .text(
            "fold_rms",
            "Root mean square of the cross-validation errors, relative to the accuracy",
            |(set, ..)| {
                let errors = set.fold_rms.iter().flatten();
                errors.map(|x| finite(*x)).collect::<Vec<_>>().join(" ")
            },
        )
        .number("folds", "-", "Number of groups", |(set, ..)| {
            set.fold_rms.as_ref().map_or(0, Vec::len) as f64
        })
        .number(
            "folds_won_by_first",
            "-",
            "Number of groups that the first set predicts better",
            |(.., folds)| folds.map(|compared| compared.won as f64),
        )
        .number(
            "ratio_of_first",
            "-",
            "Error of the first set over that of this one",
            |(.., folds)| folds.map(|compared| compared.ratio),
        )
        .ends(
            ["ratio_low", "ratio_high"],
            "-",
            "the 95 % interval of the ratio",
            |(.., folds)| folds.map(|compared| compared.interval),
        )
        .number(
            "separation",
            "-",
            "Distance of the predictions in units of the errors of the set of points",
            |(_, against, _)| against.and_then(|compared| compared.separation),
        )
        .number(
            "evidence",
            "-",
            "Misfit of this set minus that of the first, allowing for common errors",
            |(_, against, _)| against.and_then(|compared| compared.evidence),
        )
        .number(
            "correlation",
            "-",
            "Correlation of the errors used for the distance",
            |(_, against, _)| against.and_then(|compared| compared.correlation),
        )
        .number(
            "lack_of_fit_probability",
            "-",
            "Probability of a misfit at least this large",
            |(set, ..)| set.lack_of_fit_probability,
        )
        .text("decision", "Whether the first set is better", |(_, against, _)| {
            against.map_or("", |compared| compared.decision)
        })
        .text("reason", "Why", |(_, against, _)| {
            against.map_or("", |compared| compared.reason)
        })
        .finish()
}

/// A number with all its digits; empty if not finite.
fn finite(x: f64) -> String {
    if x.is_finite() { x.to_string() } else { String::new() }
}
