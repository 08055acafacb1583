//! The winner as a sentence.

use gearloss_studies::analyses::tournament::{Comparison, RankedCombination, Ranking};

/// The winner, its marks, and the number of combinations that are not distinguishable from it.
pub fn verdict(ranking: &Ranking) -> String {
    let names = |place: usize| ranking.ranking[place].models.join(", ");
    let error = |place: usize| {
        let c = &ranking.ranking[place];
        let rms = c
            .predicted_rms
            .map_or_else(String::new, |rms| format!(" ({rms:.3} {} rms)", ranking.unit_in_words));
        format!("{:.2} times the accuracy{rms}", c.predicted_over_accuracy)
    };
    let marks = |place: usize| short_marks(ranking, &ranking.ranking[place]);
    let how = if ranking.fits_factors {
        "predicted with factors from the other groups"
    } else {
        "without fitted factors"
    };
    let winner = ranking.winner;
    let mut sentence = format!("best: {}, {how}, errors {}", names(winner), error(winner));
    match (ranking.best_unmarked, ranking.best_against_unmarked) {
        (None, _) => sentence.push_str(&format!("; it is marked ({}), as every combination is", marks(winner))),
        (Some(unmarked), Some(against)) if winner == 0 => sentence.push_str(&format!(
            "; it is marked ({}), but significantly better than the best combination without a mark, {}, errors {}: {}",
            marks(0),
            names(unmarked),
            error(unmarked),
            comparison(&against)
        )),
        (Some(_), Some(against)) => sentence.push_str(&format!(
            "; the smallest errors of all, {}, are those of {}, which is marked ({}) and not significantly better: {}",
            error(0),
            names(0),
            marks(0),
            comparison(&against)
        )),
        (Some(_), None) => {}
    }
    let all = ranking.ranking.len() - 1;
    let members = ranking.ranking.iter().filter(|c| c.weight.is_some()).count();
    match members - 1 {
        0 => format!("{sentence}; it is significantly better than all {all} others"),
        others => format!("{sentence}; {others} of the {all} other combinations are not distinguishable from it"),
    }
}

/// A comparison as text.
fn comparison(against: &Comparison) -> String {
    let groups = against.folds.map_or_else(
        || "too few groups to compare".to_owned(),
        |groups| {
            let [low, high] = groups.interval;
            format!(
                "errors {:.2} times as large (95 % {low:.2} to {high:.2}), smaller in {} of {} groups",
                groups.ratio, groups.won, groups.groups
            )
        },
    );
    format!(
        "{groups}, predictions differ by {:.1} standard deviations of the set",
        against.separation
    )
}

/// The marks of a combination for a column of a table.
pub fn short_marks(ranking: &Ranking, c: &RankedCombination) -> String {
    let mut list: Vec<String> = Vec::new();
    for (mechanism, place) in ranking.mechanisms.iter().zip(&c.places) {
        let quantities = &mechanism.candidates[*place].quantities_outside;
        if !quantities.is_empty() {
            list.push(format!("{}: range of {}", mechanism.mechanism, quantities.join(", ")));
        }
    }
    list.extend(c.on_bound.iter().map(|mechanism| format!("{mechanism}: bound")));
    list.join("; ")
}
