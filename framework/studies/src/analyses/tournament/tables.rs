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
        .number(
            "predicted_over_accuracy",
            "-",
            "Root mean square of the predicted errors relative to the accuracy of the points",
            |(_, c)| c.predicted_over_accuracy,
        )
        .number(
            "predicted_rms",
            unit,
            "Root mean square of the predicted errors",
            |(_, c)| c.predicted_rms,
        )
        .number(
            "worst_group_rms",
            unit,
            "Root mean square of the predicted errors of the worst group",
            |(_, c)| c.worst_group_rms,
        )
        .number(
            "fitted_rms",
            unit,
            "Root mean square of the errors with fitted factors",
            |(_, c)| c.fitted_rms,
        )
        .number("mean", unit, "Mean of the errors with fitted factors", |(_, c)| c.mean)
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
        .number(
            "separation",
            "-",
            "Separation of its predictions from those of the winner in standard deviations of the set of points",
            |(_, c)| c.against.separation,
        )
        .number("evidence", "-", "Its misfit minus that of the winner", |(_, c)| {
            c.against.evidence
        })
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
        .number("torque_nm", "Nm", "Torque", |(point, _)| point.torque_nm)
        .number("speed_rpm", "rpm", "Speed", |(point, _)| point.speed_rpm)
        .number("measured_loss_w", "W", "Measured loss", |(point, _)| {
            point.measured_loss_w
        })
        .number(
            "loss_accuracy_w",
            "W",
            "Standard deviation of the measured loss",
            |(point, _)| point.loss_accuracy_w,
        )
        .number("winner_loss_w", "W", "Loss predicted by the winner", |(_, winner)| {
            *winner
        })
        .number(
            "mean_loss_w",
            "W",
            "Weighted mean of the losses predicted by the shortlist",
            |(point, _)| point.mean_loss_w,
        )
        .number(
            "deviation_w",
            "W",
            "Weighted standard deviation of these losses",
            |(point, _)| point.deviation_w,
        )
        .number("least_loss_w", "W", "The smallest of these losses", |(point, _)| {
            point.least_loss_w
        })
        .number("greatest_loss_w", "W", "The largest of these losses", |(point, _)| {
            point.greatest_loss_w
        })
        .finish()
}

/// One row for each point of the grid.
fn points(name: &str, spread: &Spread) -> Table {
    Table::of(name, &spread.points)
        .text("gear", "Gear", |_| &spread.gear)
        .number("torque_nm", "Nm", "Torque", |point| point.torque_nm)
        .number("speed_rpm", "rpm", "Speed", |point| point.speed_rpm)
        .number("least_loss_w", "W", "The smallest loss of all combinations", |point| {
            point.least_loss_w
        })
        .number("mean_loss_w", "W", "Mean loss of all combinations", |point| {
            point.mean_loss_w
        })
        .number(
            "greatest_loss_w",
            "W",
            "The largest loss of all combinations",
            |point| point.greatest_loss_w,
        )
        .number(
            "deviation_w",
            "W",
            "Standard deviation over the combinations",
            |point| point.deviation_w,
        )
        .finish()
}
