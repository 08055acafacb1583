//! The best combination, or the spread, in one sentence.

use gearloss_studies::analyses::tournament::{Tournament, TournamentOutcome};

use crate::names::{listed, share as share_words};
use crate::page::Page;
use crate::text::{extremes, range, short};

pub fn add(outcome: &TournamentOutcome, page: &mut Page) {
    match &outcome.tournament {
        Tournament::Ranking(ranking) => {
            let winner = &ranking.ranking[ranking.winner];
            let alike = ranking
                .ranking
                .iter()
                .filter(|c| c.weight.is_some())
                .count()
                .saturating_sub(1);
            let others = match alike {
                0 => "better than all others".to_owned(),
                alike => format!("{alike} others are not distinguishable from it"),
            };
            page.headline = Some(format!(
                "Best of {} combinations of models: {}, with errors of {} times the accuracy; {others}",
                ranking.combinations,
                listed(
                    &winner
                        .models
                        .iter()
                        .map(|model| format!("`{model}`"))
                        .collect::<Vec<_>>()
                ),
                short(winner.predicted_over_accuracy)
            ));
            let models = winner.models.join(", ");
            page.key_figure("error over accuracy", short(winner.predicted_over_accuracy), "", models);
            if let Some(rms) = winner.predicted_rms {
                page.key_figure(
                    "predicted error",
                    short(rms),
                    ranking.unit_in_words,
                    "rms, in groups of points that were not fitted",
                );
            }
            page.key_figure(
                "not distinguishable",
                alike.to_string(),
                "",
                format!("of {} combinations", ranking.combinations),
            );
            if !winner.marks.is_empty() {
                page.careful
                    .push(format!("the best combination is marked: {}", winner.marks.join("; ")));
            }
        }
        Tournament::Spread(spread) => {
            let halves = spread
                .points
                .iter()
                .map(|p| (0.5 * (p.greatest_loss_w - p.least_loss_w) * p.scale, ()));
            let Some([low, high]) = extremes(halves) else { return };
            let unit = spread.unit_in_words;
            page.headline = Some(format!(
                "{} combinations of models differ by ±{} {unit}, standard deviation {} {unit}",
                spread.combinations,
                range(low.0, high.0, 2),
                short(spread.deviation_rms)
            ));
            page.key_figure(
                "standard deviation",
                short(spread.deviation_rms),
                unit,
                "over all combinations, rms over the points",
            );
            let shares = spread
                .shares_of_spread
                .iter()
                .filter_map(|of_mechanism| Some((of_mechanism.share?, of_mechanism)));
            if let Some([_, (share, of_mechanism)]) = extremes(shares) {
                page.key_figure(
                    "largest share of the spread",
                    short(100.0 * share),
                    "%",
                    share_words(of_mechanism.mechanism.as_str()),
                );
            }
        }
    }
}
