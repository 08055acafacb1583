//! The spread of all combinations where nothing was measured: the uncertainty of the models.

use gearloss_report::{Figure, Map};
use gearloss_studies::study::TournamentEntry;
use serde_json::json;

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::write::{cell, head, picture, write};
use super::{Field, json_of, unit};
use crate::output::{Failure, Out, Table, number};
use gearloss_studies::analyses::numbers::tidy;

/// Of all combinations at one point, in the unit of errors about the set that the tournament starts from.
struct Range {
    least: f64,
    mean: f64,
    greatest: f64,
    /// Standard deviation over the combinations.
    deviation: f64,
}

pub fn show(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    gear: &str,
    (torques, speeds): &(Vec<f64>, Vec<f64>),
    field: &Field<'_>,
    out: &mut Out,
) -> Result<(), Failure> {
    let scales: Vec<f64> = field.scale.iter().map(|s| s.unwrap_or(0.0)).collect();
    // Losses of slots add up, so extremes and moments over all combinations are the sums of those of the slots.
    let range = |i: usize| {
        let mut range = Range {
            least: field.rest[i],
            mean: field.rest[i],
            greatest: field.rest[i],
            deviation: 0.0,
        };
        for slot in &field.slots {
            let losses: Vec<f64> = slot.candidates.iter().map(|c| c.loss[i]).collect();
            let mean = losses.iter().sum::<f64>() / losses.len() as f64;
            range.least += losses.iter().copied().fold(f64::INFINITY, f64::min);
            range.greatest += losses.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            range.mean += mean;
            range.deviation += losses.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / losses.len() as f64;
        }
        range.deviation = range.deviation.sqrt();
        range
    };
    let ranges: Vec<Range> = (0..field.points.len()).map(range).collect();
    let header = [
        "gear",
        "torque_nm",
        "speed_rpm",
        "least_loss_w",
        "mean_loss_w",
        "greatest_loss_w",
        "deviation_w",
    ]
    .map(str::to_owned);
    let mut rows = Vec::new();
    for (p, r) in field.points.iter().zip(&ranges) {
        let mut row = vec![gear.to_owned(), cell(Some(p.torque)), cell(Some(tidy(p.speed * RPM)))];
        row.extend([r.least, r.mean, r.greatest, r.deviation].map(|x| cell(Some(x))));
        rows.push(row);
    }
    // How much of the variance each mechanism brings, in the mean over the points.
    let variance = |losses: &dyn Fn(usize) -> Vec<f64>| -> f64 {
        let of = |i: usize| {
            let list = losses(i);
            let mean = list.iter().sum::<f64>() / list.len() as f64;
            let scale = scales[i];
            scale * scale * list.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / list.len() as f64
        };
        (0..field.points.len()).map(of).sum()
    };
    let shares: Vec<f64> = field
        .slots
        .iter()
        .map(|slot| variance(&|i| slot.candidates.iter().map(|c| c.loss[i]).collect()))
        .collect();
    let whole: f64 = shares.iter().sum();
    let mut table = Table::new(&["mechanism", "models", "share of the spread %"]);
    for (slot, share) in field.slots.iter().zip(&shares) {
        let share = (whole > 0.0).then(|| 100.0 * share / whole);
        table.row(vec![
            slot.name.clone(),
            slot.candidates.len().to_string(),
            number(share, 1),
        ]);
    }
    out.text(&table.render())?;
    let half = |f: fn(f64, f64) -> f64, start: f64| {
        let of = |(r, scale): (&Range, &f64)| 0.5 * (r.greatest - r.least) * scale;
        ranges.iter().zip(&scales).map(of).fold(start, f)
    };
    let sentence = format!(
        "half of the distance between the extremes: {:.3} to {:.3} {}; standard deviation {:.3} in the root mean square",
        half(f64::min, f64::INFINITY),
        half(f64::max, 0.0),
        field.unit,
        f64::sqrt(whole / field.points.len() as f64),
    );
    runner.verdict(sentence, out)?;
    out.line("")?;
    let mut value = head(runner, &[&field.base]);
    value["tournament"] = json!({
        "model_set": field.base.name, "gear": gear, "unit": unit(entry), "combinations": field.count(), "mechanisms": json_of(field),
        "shares_of_spread": field.slots.iter().zip(&shares).map(|(slot, share)| json!({
            "mechanism": slot.name, "share": (whole > 0.0).then(|| share / whole),
        })).collect::<Vec<_>>(),
        "points": field.points.iter().zip(&ranges).map(|(p, r)| json!({
            "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM), "least_loss_w": r.least, "mean_loss_w": r.mean,
            "greatest_loss_w": r.greatest, "deviation_w": r.deviation,
        })).collect::<Vec<_>>(),
    });
    write(runner, name, &entry.write, &header, &rows, &value)?;
    if torques.len() < 2 || speeds.len() < 2 {
        return Ok(());
    }
    let figure = Figure::Map(Map {
        title: format!(
            "{name}: standard deviation over {} combinations in {}",
            field.count(),
            field.unit
        ),
        x: (
            "speed rpm".to_owned(),
            speeds.iter().map(|w| format!("{}", tidy(w * RPM))).collect(),
        ),
        y: (
            "torque Nm".to_owned(),
            torques.iter().map(|t| format!("{}", tidy(*t))).collect(),
        ),
        values: ranges
            .iter()
            .zip(&scales)
            .map(|(r, scale)| Some(r.deviation * scale))
            .collect(),
        ..Map::default()
    });
    picture(runner, &format!("{name}-spread"), figure, &entry.write)
}
