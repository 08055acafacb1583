//! A tournament as columns.

use super::super::{Head, Outcome};
use super::{Ranking, Spread, Tournament, TournamentOutcome};
use crate::points::Note;
use crate::table::Table;

impl Outcome for TournamentOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let name = &self.head.analysis;
        match &self.tournament {
            Tournament::Ranking(ranking) => vec![combinations(name, ranking), shortlist(name, ranking)],
            Tournament::Spread(spread) => vec![points(name, spread)],
        }
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }

    fn unlisted(&self) -> usize {
        match &self.tournament {
            Tournament::Ranking(ranking) => ranking.unlisted,
            Tournament::Spread(spread) => spread.unlisted,
        }
    }
}

/// One row for each combination.
fn combinations(name: &str, ranking: &Ranking) -> Table {
    let mechanisms = || ranking.mechanisms.iter().map(|m| &m.mechanism).enumerate();
    let unit = ranking.unit_in_words;
    Table::of(name, ranking.ranking.iter().enumerate())
        .number("rank", "-", "Position in the ranking", |(i, _)| (i + 1) as f64)
        .each(mechanisms(), |table, (k, mechanism)| {
            table.text(mechanism, format!("Model of {mechanism}"), |(_, c)| &c.models[k])
        })
        .fields("predicted_over_accuracy", |(_, c)| c)
        .fields_in(unit, "predicted_rms worst_group_rms fitted_rms mean", |(_, c)| c)
        .each(mechanisms(), |table, (k, mechanism)| {
            let meaning = format!("Factor on the loss of {mechanism}");
            table.number(format!("factor_{mechanism}"), "-", meaning, |(_, c)| c.factors[k])
        })
        .text("on_bound", "Mechanisms whose factor is at a bound", |(_, c)| {
            c.on_bound.join(" ")
        })
        .text("winner", "Whether it is the winner", |(i, _)| {
            (*i == ranking.winner).to_string()
        })
        .text(
            "indistinguishable",
            "Whether it is not distinguishable from the winner",
            |(i, _)| ranking.is_alike(*i).to_string(),
        )
        .number(
            "ratio_of_winner",
            "-",
            "Ratio of the errors of the winner to its errors, by group",
            |(_, c)| c.against.folds.map(|groups| groups.ratio),
        )
        .ends(
            ["ratio_low", "ratio_high"],
            "-",
            "the 95 % interval of the ratio",
            |(_, c)| c.against.folds.map(|groups| groups.interval),
        )
        .number(
            "groups_won_by_winner",
            "-",
            "Number of groups in which the winner predicts better",
            |(_, c)| c.against.folds.map(|groups| groups.won as f64),
        )
        .fields("separation evidence", |(_, c)| &c.against)
        .number("weight", "-", "Weight on the shortlist", |(_, c)| c.weight)
        .text(
            "marks",
            "Marks: quantities outside stated ranges, factors at a bound",
            |(_, c)| c.marks.join("; "),
        )
        .finish()
}

/// One row for each measured point: predictions of the shortlist and their spread.
fn shortlist(name: &str, ranking: &Ranking) -> Table {
    let winner = ranking.losses(&ranking.ranking[ranking.winner]);
    Table::of(format!("{name}-shortlist"), ranking.points.iter().zip(winner))
        .text("gear", "Gear", |_| &ranking.gear)
        .fields("torque_nm speed_rpm measured_loss_w loss_accuracy_w", |(point, _)| {
            point
        })
        .number("winner_loss_w", "W", "Loss predicted by the winner", |(_, winner)| {
            *winner
        })
        .fields("mean_loss_w deviation_w least_loss_w greatest_loss_w", |(point, _)| {
            point
        })
        .finish()
}

/// One row for each point of the grid.
fn points(name: &str, spread: &Spread) -> Table {
    let with_bands = spread.points.iter().any(|point| point.band_w.is_some());
    let ends = [
        ("band_low_w", "Lower end of the 95 % band with the error of the models"),
        ("band_median_w", "Its median"),
        ("band_high_w", "Its upper end"),
    ];
    let ends = with_bands.then_some(ends.into_iter().enumerate());
    Table::of(name, &spread.points)
        .text("gear", "Gear", |_| &spread.gear)
        .fields(
            "torque_nm speed_rpm least_loss_w mean_loss_w greatest_loss_w deviation_w",
            |point| point,
        )
        .each(ends.into_iter().flatten(), |table, (k, (name, meaning))| {
            table.number(name, "W", meaning, |point| point.band_w.map(|band| band[k]))
        })
        .finish()
}
