//! Comparison table of the model sets.

use super::super::compare::ComparisonOfSets;
use crate::cells;
use crate::table::{Column, Table};

/// The comparison of the sets.
pub(in crate::analyses::identify) fn table(name: &str, compared: &ComparisonOfSets) -> Table {
    let mut table = Table::new(
        format!("{name}-sets"),
        [
            Column::text("model_set", "Model set, the best first"),
            Column::number("parameters", "-", "Number of parameters"),
            Column::number(
                "criterion_difference",
                "-",
                "Akaike's criterion minus that of the first set",
            ),
            Column::text(
                "fold_rms",
                "Root mean square of the cross-validation errors, relative to the accuracy",
            ),
            Column::number("folds", "-", "Number of groups"),
            Column::number(
                "folds_won_by_first",
                "-",
                "Number of groups that the first set predicts better",
            ),
            Column::number("ratio_of_first", "-", "Error of the first set over that of this one"),
            Column::number("ratio_low", "-", "Lower end of the 95 % interval of the ratio"),
            Column::number("ratio_high", "-", "Upper end of the 95 % interval of the ratio"),
            Column::number(
                "separation",
                "-",
                "Distance of the predictions in units of the errors of the set of points",
            ),
            Column::number(
                "evidence",
                "-",
                "Misfit of this set minus that of the first, allowing for common errors",
            ),
            Column::number("correlation", "-", "Correlation of the errors used for the distance"),
            Column::number(
                "lack_of_fit_probability",
                "-",
                "Probability of a misfit at least this large",
            ),
            Column::text("decision", "Whether the first set is better"),
            Column::text("reason", "Why"),
        ],
    );
    for set in &compared.sets {
        let against = set.first_against_it.as_ref();
        let folds = against.and_then(|against| against.folds.as_ref());
        let errors = set.fold_rms.as_deref().unwrap_or_default();
        let texts: Vec<String> = errors.iter().map(|x| finite(*x)).collect();
        table.push(cells![
            &set.model_set,
            set.parameters,
            set.criterion_difference,
            texts.join(" "),
            errors.len(),
            folds.map(|p| p.won as f64),
            folds.map(|p| p.ratio),
            folds.map(|p| p.interval[0]),
            folds.map(|p| p.interval[1]),
            against.and_then(|c| c.separation),
            against.and_then(|c| c.evidence),
            against.and_then(|c| c.correlation),
            set.lack_of_fit_probability,
            against.map_or("", |c| c.decision),
            against.map_or("", |c| c.reason),
        ]);
    }
    table
}

/// A number with all its digits; empty if not finite.
fn finite(x: f64) -> String {
    if x.is_finite() { x.to_string() } else { String::new() }
}
