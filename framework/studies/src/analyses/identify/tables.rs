//! Tables of identifications: points, losses by mechanism, parameters.

pub(super) mod compare;
pub(super) mod hold_out;
pub(super) mod means;
pub(super) mod next;
pub(super) mod posterior;

use gearloss_numerics::inference::Reach;

use super::found::RowOfSet;
use super::outcome::IdentificationOfSet;
use super::parameter::verdict_words;
use crate::numbers::{RPM, tidy};
use crate::table::{Table, TableOf};

/// Unit of columns whose unit is in another column of the row.
const UNIT: &str = "mixed";

/// Whether lines include their file, because there are several.
fn has_files(all: &[IdentificationOfSet]) -> bool {
    let mut measured = all.iter().map(|o| &o.found.measured);
    measured.any(|measured| measured.rows.iter().any(|row| measured.file(row).is_some()))
}

/// Adds the column of lines of measured rows.
fn line_column<R>(
    table: TableOf<R>,
    all: &[IdentificationOfSet],
    row: impl Fn(&R) -> (&IdentificationOfSet, usize),
) -> TableOf<R> {
    if has_files(all) {
        table.text("line", "File and line", |at| {
            let (o, row) = row(at);
            o.found.measured.line(&o.found.measured.rows[row])
        })
    } else {
        table.number("line", "-", "Line in the file", |at| {
            let (o, row) = row(at);
            o.found.measured.rows[row].line as f64
        })
    }
}

/// One row for each measured value.
pub(super) fn points(name: &str, all: &[IdentificationOfSet]) -> Table {
    let mut rows = Vec::new();
    for o in all {
        let of_points = o.found.observations.iter().zip(&o.points).zip(&o.found.pairs[0]);
        rows.extend(of_points.map(|((observation, point), before)| (o, observation, before, point)));
    }
    let table = Table::of(name, rows).text("model_set", "Model set", |(o, ..)| &o.model_set);
    line_column(table, all, |(o, observation, ..)| (o, observation.row))
        .fields(
            "name gear torque_nm speed_rpm oil_temperature_degc quantity",
            |(.., point)| point,
        )
        .fields_in(
            UNIT,
            "measured_before model_before measured model accuracy",
            |(.., point)| point,
        )
        .number(
            "residual_before",
            "-",
            "Calculated minus measured, relative to the accuracy, at the start",
            |(_, observation, before, _)| (before.model - before.measured) / observation.deviation,
        )
        .fields("residual standardised_residual leverage", |(.., point)| point)
        .finish()
}

/// Loss of a mechanism at a measured row, with its bands.
struct MechanismLoss<'o> {
    of_set: &'o IdentificationOfSet,
    /// Index of the measured row.
    row: usize,
    /// The point of the row with the fit.
    there: &'o RowOfSet,
    mechanism: &'static str,
    before: f64,
    loss: f64,
    band: Option<[f64; 2]>,
    share: Option<f64>,
    share_band: Option<[f64; 2]>,
}

/// Losses by mechanism at every measured row, with their bands.
pub(super) fn shares(name: &str, all: &[IdentificationOfSet]) -> Table {
    let mut list = Vec::new();
    for o in all {
        let Ok(shares) = &o.found.shares else { continue };
        for (i, breakdown) in shares.rows.iter().enumerate() {
            let before = &o.found.rows[0][i].losses;
            let sum: f64 = before.iter().sum();
            let names = shares.mechanisms.iter().copied().chain(["all"]);
            let losses = breakdown.parts.iter().chain([&breakdown.total]);
            let before = before.iter().chain([&sum]);
            for (k, ((mechanism, loss), before)) in names.zip(losses).zip(before).enumerate() {
                let share = shares.share(i, k);
                list.push(MechanismLoss {
                    of_set: o,
                    row: i,
                    there: &o.found.rows[1][i],
                    mechanism,
                    before: *before,
                    loss: loss.value,
                    band: shares.bands[i][k],
                    share: share.map(|(share, _)| share.value),
                    share_band: share.and_then(|(_, ends)| ends),
                });
            }
        }
    }
    let table = Table::of(format!("{name}-shares"), list).text("model_set", "Model set", |at| &at.of_set.model_set);
    line_column(table, all, |at| (at.of_set, at.row))
        .text("gear", "Gear", |at| &at.there.gear)
        .number("torque_nm", "Nm", "Torque", |at| at.there.torque)
        .number("speed_rpm", "rpm", "Speed", |at| tidy(at.there.speed * RPM))
        .number("oil_temperature_degc", "degC", "Oil temperature", |at| at.there.oil)
        .text("mechanism", "Mechanism, or all mechanisms", |at| at.mechanism)
        .number("loss_before_w", "W", "Loss at the start", |at| at.before)
        .number("loss_w", "W", "Loss", |at| at.loss)
        .ends(["loss_low_w", "loss_high_w"], "W", "the 95 % band of the loss", |at| {
            at.band
        })
        .number("share", "-", "Share of the total loss", |at| at.share)
        .ends(["share_low", "share_high"], "-", "the 95 % band of the share", |at| {
            at.share_band
        })
        .finish()
}

/// One row for each parameter.
pub(super) fn parameters(name: &str, all: &[IdentificationOfSet]) -> Table {
    let mut rows = Vec::new();
    for o in all {
        for (parameter, profile) in o.parameters.iter().zip(&o.found.profiles) {
            let profile = profile.as_ref().and_then(|p| p.as_ref().ok());
            let profile = profile.filter(|p| p.ends.iter().all(|end| end.reach != Reach::Unresolved));
            rows.push((o, profile, parameter));
        }
    }
    Table::of(format!("{name}-parameters"), rows)
        .text("model_set", "Model set", |(o, ..)| &o.model_set)
        .text("parameter", "Name of the parameter", |(.., parameter)| &parameter.name)
        .fields("path unit", |(.., parameter)| parameter)
        .fields_in(UNIT, "stated published start least greatest", |(.., parameter)| {
            parameter
        })
        .number("fitted", UNIT, "Identified value", |(.., parameter)| parameter.value)
        .ends(
            ["low", "high"],
            UNIT,
            "the 95 % interval of the linearised fit",
            |(.., parameter)| parameter.interval,
        )
        .ends(
            ["profile_low", "profile_high"],
            UNIT,
            "the 95 % profile interval",
            |(_, profile, _)| profile.map(|p| p.theta),
        )
        .text("verdict", "Verdict", |(.., parameter)| {
            verdict_words(parameter.judgement)
        })
        .text("sentence", "The same as a sentence", |(.., parameter)| {
            &parameter.sentence
        })
        .finish()
}
