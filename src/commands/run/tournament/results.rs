//! The files of a ranking.

use gearloss_numerics::inference::{Decision, Paired};
use gearloss_numerics::selection::Standing;
use gearloss_studies::study::TournamentEntry;
use serde_json::{Value, json};

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::table::TableFile;
use super::super::write::{cell, head, write};
use super::rank::{Outcome, marks};
use super::{Field, Measurements, json_of, unit};
use crate::output::Failure;
use gearloss_studies::analyses::numbers::tidy;

pub fn write_all(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    gear: &str,
    (rows, field): (&Measurements, &Field<'_>),
    o: &Outcome,
) -> Result<(), Failure> {
    shortlist(runner, name, entry, gear, (rows, field), o)?;
    let (header, cells) = ranking(field, o);
    let mut value = head(runner, &[&field.base]);
    value["tournament"] = json_of_ranking(entry, gear, (rows, field), o);
    write(runner, name, &entry.write, &header, &cells, &value)
}

fn is_alike(standing: &Standing) -> bool {
    standing.decision != Decision::Better
}

/// One row for each combination.
fn ranking(field: &Field<'_>, o: &Outcome) -> (Vec<String>, Vec<Vec<String>>) {
    let mut header = vec!["rank".to_owned()];
    header.extend(field.header());
    let errors = [
        "predicted_over_accuracy",
        "predicted_rms",
        "worst_group_rms",
        "fitted_rms",
        "mean",
    ];
    header.extend(errors.map(str::to_owned));
    header.extend(field.slots.iter().map(|s| format!("factor_{}", s.name)));
    let standing = [
        "on_bound",
        "winner",
        "indistinguishable",
        "ratio_of_winner",
        "ratio_low",
        "ratio_high",
        "groups_won_by_winner",
        "separation",
        "evidence",
        "weight",
        "marks",
    ];
    header.extend(standing.map(str::to_owned));
    let row = |(i, c): (usize, &gearloss_numerics::selection::Combination)| {
        let mut row = vec![(i + 1).to_string()];
        row.extend(field.names(&c.places).into_iter().map(str::to_owned));
        row.push(cell(Some(c.predicted)));
        let printed = c.printed.map(|p| [p.predicted, p.worst, p.fitted, p.mean]);
        row.extend((0..4).map(|k| cell(printed.map(|p| p[k]))));
        row.extend(c.factors.iter().map(|f| cell(Some(*f))));
        let bounds: Vec<&str> = c.on_bound.iter().map(|k| field.slots[*k].name.as_str()).collect();
        row.extend([bounds.join(" "), (i == o.winner.place).to_string()]);
        let standing = &o.winner.standings[i];
        row.push((i == o.winner.place || is_alike(standing)).to_string());
        let folds = standing.folds;
        row.extend(
            [
                folds.map(|p| p.ratio),
                folds.map(|p| p.interval[0]),
                folds.map(|p| p.interval[1]),
            ]
            .map(cell),
        );
        row.push(folds.map_or_else(String::new, |p| p.won.to_string()));
        row.extend(
            [
                Some(standing.separation.square.sqrt()),
                Some(standing.separation.evidence),
                o.weight(i),
            ]
            .map(cell),
        );
        row.push(marks(field, c).join("; "));
        row
    };
    (header, o.ranked.iter().enumerate().map(row).collect())
}

/// One row for each point: what the shortlist predicts, and how far it spreads.
fn shortlist(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    gear: &str,
    (rows, field): (&Measurements, &Field<'_>),
    o: &Outcome,
) -> Result<(), Failure> {
    let header = [
        "gear",
        "torque_nm",
        "speed_rpm",
        "measured_loss_w",
        "loss_accuracy_w",
        "winner_loss_w",
        "mean_loss_w",
        "deviation_w",
        "least_loss_w",
        "greatest_loss_w",
    ]
    .map(str::to_owned);
    let winner = &o.ranked[o.winner.place];
    let best = field.losses().all(&winner.places, &winner.factors);
    let row = |i: usize| {
        let list = &o.shortlist;
        let numbers = [
            rows.torques[i],
            tidy(rows.speeds[i] * RPM),
            rows.losses.losses[i],
            rows.losses.deviations[i],
            best[i],
            list.means[i],
            list.deviations[i],
            list.ranges[i][0],
            list.ranges[i][1],
        ];
        let mut cells = vec![gear.to_owned()];
        cells.extend(numbers.map(|x| cell(Some(x))));
        cells
    };
    let mut table = TableFile::new(runner.run, &format!("{name}-shortlist"), &entry.write, &header)?;
    table.push_all(&(0..rows.losses.len()).map(row).collect::<Vec<_>>())?;
    table.finish()
}

fn json_of_ranking(
    entry: &TournamentEntry,
    gear: &str,
    (rows, field): (&Measurements, &Field<'_>),
    o: &Outcome,
) -> Value {
    let list = &o.shortlist;
    let folds = |p: Option<Paired>| {
        p.map(|p| json!({ "ratio": p.ratio, "interval": p.interval, "won": p.won, "groups": p.folds }))
    };
    let standing = |s: &Standing| {
        json!({
            "decision": s.decision.name(), "folds": folds(s.folds), "separation": s.separation.square.sqrt(), "evidence": s.separation.evidence,
        })
    };
    let ranked = |(i, c): (usize, &gearloss_numerics::selection::Combination)| {
        let printed = c.printed;
        json!({
            "models": field.names(&c.places), "predicted_over_accuracy": c.predicted, "predicted_rms": printed.map(|p| p.predicted),
            "worst_group_rms": printed.map(|p| p.worst), "fitted_rms": printed.map(|p| p.fitted), "mean": printed.map(|p| p.mean),
            "factors": c.factors,
            "on_bound": c.on_bound.iter().map(|k| Value::from(field.slots[*k].name.as_str())).collect::<Vec<_>>(),
            "marks": marks(field, c),
            "winner_against_it": (i != o.winner.place).then(|| standing(&o.winner.standings[i])),
            "weight": o.weight(i),
        })
    };
    let point = |i: usize| {
        json!({
            "torque_nm": rows.torques[i], "speed_rpm": tidy(rows.speeds[i] * RPM), "measured_loss_w": rows.losses.losses[i],
            "loss_accuracy_w": rows.losses.deviations[i], "accuracy": rows.accuracy(i), "weight": rows.losses.weights[i],
            "mean_loss_w": list.means[i], "deviation_w": list.deviations[i], "least_loss_w": list.ranges[i][0],
            "greatest_loss_w": list.ranges[i][1],
        })
    };
    json!({
        "model_set": field.base.name, "gear": gear, "unit": unit(entry), "combinations": o.ranked.len(), "accuracy": o.accuracy,
        "notes": rows.notes,
        "correlation": o.winner.errors.correlation, "correlation_estimated": o.winner.is_estimated,
        "variance_over_stated": o.winner.errors.variance,
        "winner": o.winner.place, "best_unmarked": o.winner.unmarked,
        "best_against_unmarked": o.winner.best_against_unmarked.as_ref().map(standing),
        "mechanisms": json_of(field),
        "points": (0..rows.losses.len()).map(point).collect::<Vec<_>>(),
        "ranking": o.ranked.iter().enumerate().map(ranked).collect::<Vec<_>>(),
    })
}
