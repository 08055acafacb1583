//! A tournament as columns.

use super::super::{Head, Outcome};
use super::{RankedCombination, Ranking, Spread, Tournament, TournamentOutcome};
use crate::analysis::Note;
use crate::cells;
use crate::table::{Cell, Column, Table};

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
    let mechanisms = || ranking.mechanisms.iter().map(|m| m.mechanism.as_str());
    let unit = ranking.unit_in_words;
    let mut columns = vec![Column::number("rank", "-", "Position in the ranking")];
    columns.extend(mechanisms().map(|name| Column::text(name, format!("Model of {name}"))));
    columns.extend([
        Column::number(
            "predicted_over_accuracy",
            "-",
            "Root mean square of the predicted errors relative to the accuracy of the points",
        ),
        Column::number("predicted_rms", unit, "Root mean square of the predicted errors"),
        Column::number(
            "worst_group_rms",
            unit,
            "Root mean square of the predicted errors of the worst group",
        ),
        Column::number("fitted_rms", unit, "Root mean square of the errors with fitted factors"),
        Column::number("mean", unit, "Mean of the errors with fitted factors"),
    ]);
    columns.extend(
        mechanisms().map(|name| Column::number(format!("factor_{name}"), "-", format!("Factor on the loss of {name}"))),
    );
    columns.extend([
        Column::text("on_bound", "Mechanisms whose factor is at a bound"),
        Column::text("winner", "Whether it is the winner"),
        Column::text("indistinguishable", "Whether it is not distinguishable from the winner"),
        Column::number(
            "ratio_of_winner",
            "-",
            "Ratio of the errors of the winner to its errors, by group",
        ),
        Column::number("ratio_low", "-", "Lower end of the 95 % interval of the ratio"),
        Column::number("ratio_high", "-", "Upper end of the 95 % interval of the ratio"),
        Column::number(
            "groups_won_by_winner",
            "-",
            "Number of groups in which the winner predicts better",
        ),
        Column::number(
            "separation",
            "-",
            "Separation of its predictions from those of the winner in standard deviations of the set of points",
        ),
        Column::number("evidence", "-", "Its misfit minus that of the winner"),
        Column::number("weight", "-", "Weight on the shortlist"),
        Column::text("marks", "Marks: quantities outside stated ranges, factors at a bound"),
    ]);
    let mut table = Table::new(name, columns);
    for (i, combination) in ranking.ranking.iter().enumerate() {
        table.push(row(ranking, i, combination));
    }
    table
}

fn row<'c>(ranking: &Ranking, i: usize, c: &'c RankedCombination) -> Vec<Cell<'c>> {
    let mut row = vec![Cell::from(i + 1)];
    row.extend(c.models.iter().map(Cell::from));
    row.extend(cells![
        c.predicted_over_accuracy,
        c.predicted_rms,
        c.worst_group_rms,
        c.fitted_rms,
        c.mean,
    ]);
    row.extend(c.factors.iter().map(|factor| Cell::from(*factor)));
    let groups = c.against.folds;
    row.extend(cells![
        c.on_bound.join(" "),
        (i == ranking.winner).to_string(),
        ranking.is_alike(i).to_string(),
        groups.map(|groups| groups.ratio),
        groups.map(|groups| groups.interval[0]),
        groups.map(|groups| groups.interval[1]),
        groups.map(|groups| groups.won as f64),
        c.against.separation,
        c.against.evidence,
        c.weight,
        c.marks.join("; "),
    ]);
    row
}

/// One row for each measured point: predictions of the shortlist and their spread.
fn shortlist(name: &str, ranking: &Ranking) -> Table {
    let mut table = Table::new(
        format!("{name}-shortlist"),
        [
            Column::text("gear", "Gear"),
            Column::number("torque_nm", "Nm", "Torque"),
            Column::number("speed_rpm", "rpm", "Speed"),
            Column::number("measured_loss_w", "W", "Measured loss"),
            Column::number("loss_accuracy_w", "W", "Standard deviation of the measured loss"),
            Column::number("winner_loss_w", "W", "Loss predicted by the winner"),
            Column::number(
                "mean_loss_w",
                "W",
                "Weighted mean of the losses predicted by the shortlist",
            ),
            Column::number("deviation_w", "W", "Weighted standard deviation of these losses"),
            Column::number("least_loss_w", "W", "The smallest of these losses"),
            Column::number("greatest_loss_w", "W", "The largest of these losses"),
        ],
    );
    let winner = ranking.losses(&ranking.ranking[ranking.winner]);
    for (point, winner) in ranking.points.iter().zip(winner) {
        table.push(cells![
            &ranking.gear,
            point.torque_nm,
            point.speed_rpm,
            point.measured_loss_w,
            point.loss_accuracy_w,
            winner,
            point.mean_loss_w,
            point.deviation_w,
            point.least_loss_w,
            point.greatest_loss_w,
        ]);
    }
    table
}

/// One row for each point of the grid.
fn points(name: &str, spread: &Spread) -> Table {
    let mut table = Table::new(
        name,
        [
            Column::text("gear", "Gear"),
            Column::number("torque_nm", "Nm", "Torque"),
            Column::number("speed_rpm", "rpm", "Speed"),
            Column::number("least_loss_w", "W", "The smallest loss of all combinations"),
            Column::number("mean_loss_w", "W", "Mean loss of all combinations"),
            Column::number("greatest_loss_w", "W", "The largest loss of all combinations"),
            Column::number("deviation_w", "W", "Standard deviation over the combinations"),
        ],
    );
    for point in &spread.points {
        table.push(cells![
            &spread.gear,
            point.torque_nm,
            point.speed_rpm,
            point.least_loss_w,
            point.mean_loss_w,
            point.greatest_loss_w,
            point.deviation_w,
        ]);
    }
    table
}
