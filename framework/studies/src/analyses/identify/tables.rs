//! Tables of identifications: points, losses by mechanism, parameters.

pub(super) mod compare;
pub(super) mod hold_out;
pub(super) mod next;
pub(super) mod posterior;

use gearloss_numerics::inference::Reach;

use super::outcome::IdentificationOfSet;
use super::parameter::verdict_words;
use crate::analyses::numbers::{RPM, tidy};
use crate::cells;
use crate::identify::Pair;
use crate::table::{Cell, Column, Table};

/// Unit of columns whose unit is in another column of the row.
const UNIT: &str = "mixed";

/// Whether lines include their file, because there are several.
fn has_files(all: &[IdentificationOfSet]) -> bool {
    let mut measured = all.iter().map(|o| &o.found.measured);
    measured.any(|measured| measured.rows.iter().any(|row| measured.file(row).is_some()))
}

/// The column of lines.
fn line_column(all: &[IdentificationOfSet]) -> Column {
    if has_files(all) {
        Column::text("line", "File and line")
    } else {
        Column::number("line", "-", "Line in the file")
    }
}

/// The line of a row.
fn line(o: &IdentificationOfSet, row: usize, has_files: bool) -> Cell<'static> {
    let measured = &o.found.measured;
    let row = &measured.rows[row];
    if has_files {
        measured.line(row).into()
    } else {
        (row.line as usize).into()
    }
}

/// One row for each measured value.
pub(super) fn points(name: &str, all: &[IdentificationOfSet]) -> Table {
    let columns = [
        Column::text("model_set", "Model set"),
        line_column(all),
        Column::text("name", "Name of the row"),
        Column::text("gear", "Gear"),
        Column::number("torque_nm", "Nm", "Torque"),
        Column::number("speed_rpm", "rpm", "Speed"),
        Column::number("oil_temperature_degc", "degC", "Oil temperature"),
        Column::text(
            "quantity",
            "Quantity of this row with its unit; efficiencies as fractions",
        ),
        Column::number(
            "measured_before",
            UNIT,
            "Measured, without the contribution of the rig at the start",
        ),
        Column::number("model_before", UNIT, "Calculated at the start"),
        Column::number(
            "measured",
            UNIT,
            "Measured, without the contribution of the identified rig",
        ),
        Column::number("model", UNIT, "Calculated"),
        Column::number(
            "accuracy",
            UNIT,
            "Standard deviation of the measurement, including its weight",
        ),
        Column::number(
            "residual_before",
            "-",
            "Calculated minus measured, relative to the accuracy, at the start",
        ),
        Column::number("residual", "-", "Calculated minus measured, relative to the accuracy"),
        Column::number("standardised_residual", "-", "Residual over its own standard deviation"),
        Column::number("leverage", "-", "Leverage of the point"),
    ];
    let (mut table, files) = (Table::new(name, columns), has_files(all));
    for o in all {
        let found = &o.found;
        for (i, (observation, point)) in found.observations.iter().zip(&o.points).enumerate() {
            let before: Pair = found.pairs[0][i];
            table.push([
                Cell::from(&o.model_set),
                line(o, observation.row, files),
                point.name.as_deref().unwrap_or_default().into(),
                (&point.gear).into(),
                point.torque_nm.into(),
                point.speed_rpm.into(),
                point.oil_temperature_degc.into(),
                point.quantity.into(),
                point.measured_before.into(),
                point.model_before.into(),
                point.measured.into(),
                point.model.into(),
                point.accuracy.into(),
                ((before.model - before.measured) / observation.deviation).into(),
                point.residual.into(),
                point.standardised_residual.into(),
                point.leverage.into(),
            ]);
        }
    }
    table
}

/// Losses by mechanism at every measured row, with their bands.
pub(super) fn shares(name: &str, all: &[IdentificationOfSet]) -> Table {
    let columns = [
        Column::text("model_set", "Model set"),
        line_column(all),
        Column::text("gear", "Gear"),
        Column::number("torque_nm", "Nm", "Torque"),
        Column::number("speed_rpm", "rpm", "Speed"),
        Column::number("oil_temperature_degc", "degC", "Oil temperature"),
        Column::text("mechanism", "Mechanism, or all mechanisms"),
        Column::number("loss_before_w", "W", "Loss at the start"),
        Column::number("loss_w", "W", "Loss"),
        Column::number("loss_low_w", "W", "Lower end of the 95 % band of the loss"),
        Column::number("loss_high_w", "W", "Upper end of the 95 % band of the loss"),
        Column::number("share", "-", "Share of the total loss"),
        Column::number("share_low", "-", "Lower end of the 95 % band of the share"),
        Column::number("share_high", "-", "Upper end of the 95 % band of the share"),
    ];
    let (mut table, files) = (Table::new(format!("{name}-shares"), columns), has_files(all));
    for o in all {
        let Ok(shares) = &o.found.shares else { continue };
        for (i, breakdown) in shares.rows.iter().enumerate() {
            let [before, there] = [0, 1].map(|which| &o.found.rows[which][i]);
            let sum: f64 = before.losses.iter().sum();
            let names = shares.mechanisms.iter().copied().chain(["all"]);
            let losses = breakdown.parts.iter().chain([&breakdown.total]);
            let before = before.losses.iter().chain([&sum]);
            for (k, ((mechanism, loss), before)) in names.zip(losses).zip(before).enumerate() {
                let band = shares.bands[i][k];
                let share = shares.share(i, k);
                let ends = share.and_then(|(_, ends)| ends);
                table.push([
                    Cell::from(&o.model_set),
                    line(o, i, files),
                    (&there.gear).into(),
                    there.torque.into(),
                    tidy(there.speed * RPM).into(),
                    there.oil.into(),
                    mechanism.into(),
                    (*before).into(),
                    loss.value.into(),
                    band.map(|band| band[0]).into(),
                    band.map(|band| band[1]).into(),
                    share.map(|(share, _)| share.value).into(),
                    ends.map(|ends| ends[0]).into(),
                    ends.map(|ends| ends[1]).into(),
                ]);
            }
        }
    }
    table
}

/// One row for each parameter.
pub(super) fn parameters(name: &str, all: &[IdentificationOfSet]) -> Table {
    let columns = [
        Column::text("model_set", "Model set"),
        Column::text("parameter", "Name of the parameter"),
        Column::text("path", "Its path as written"),
        Column::text("unit", "Unit of the values of this row"),
        Column::number("stated", UNIT, "Value of the gearbox or the rig before the fit"),
        Column::number(
            "published",
            UNIT,
            "Published value, if it changes coefficients of formulas",
        ),
        Column::number("start", UNIT, "Start value"),
        Column::number("least", UNIT, "Lower bound"),
        Column::number("greatest", UNIT, "Upper bound"),
        Column::number("fitted", UNIT, "Identified value"),
        Column::number("low", UNIT, "Lower end of the 95 % interval of the linearised fit"),
        Column::number("high", UNIT, "Upper end of the 95 % interval of the linearised fit"),
        Column::number("profile_low", UNIT, "Lower end of the 95 % profile interval"),
        Column::number("profile_high", UNIT, "Upper end of the 95 % profile interval"),
        Column::text("verdict", "Verdict"),
        Column::text("sentence", "The same as a sentence"),
    ];
    let mut table = Table::new(format!("{name}-parameters"), columns);
    for o in all {
        for (parameter, profile) in o.parameters.iter().zip(&o.found.profiles) {
            let profile = profile.as_ref().and_then(|p| p.as_ref().ok());
            let profile = profile.filter(|p| p.ends.iter().all(|end| end.reach != Reach::Unresolved));
            table.push(cells![
                &o.model_set,
                &parameter.name,
                &parameter.path,
                parameter.unit,
                parameter.stated,
                parameter.published,
                parameter.start,
                parameter.least,
                parameter.greatest,
                parameter.value,
                parameter.interval.map(|ends| ends[0]),
                parameter.interval.map(|ends| ends[1]),
                profile.map(|p| p.theta[0]),
                profile.map(|p| p.theta[1]),
                verdict_words(parameter.judgement),
                &parameter.sentence,
            ]);
        }
    }
    table
}
