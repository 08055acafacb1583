//! The correction of an identification: its points from the rows at the end of the search.

use crate::analyses::{Planner, Stopped};
use crate::codes;
use crate::correction::{Correction, CorrectionEntry, PointOfCorrection};
use crate::distinct::distinct;
use crate::identify::Calculated;
use crate::measured::{Measured, Seen};
use crate::study::Quantity;

/// Speeds in results. \[rpm\]
const RPM: f64 = 30.0 / std::f64::consts::PI;

/// The corrections of all gears with rows that have a measured and a calculated loss.
///
/// # Errors
/// No such row, or more than a correction takes.
pub fn fit(
    cx: &Planner<'_>,
    entry: &CorrectionEntry,
    measured: &Measured,
    after: &Calculated,
) -> Result<Vec<Correction>, Stopped> {
    let path = format!("{}.correction", cx.path());
    let mut all: Vec<(String, PointOfCorrection)> = Vec::new();
    for ((_, gear, point), row) in after.solved.rows.iter().zip(&measured.rows) {
        let seen = Seen::with_rig(&after.rig, measured, row, point);
        let speed = point.reference_speed.abs();
        let (Some(loss), Some(calculated), Some(oil)) = (seen.loss, point.loss_torque, point.oil) else {
            continue;
        };
        if speed == 0.0 {
            continue;
        }
        // Losses over the speed of the reference port, like the calculated one.
        let of_correction = PointOfCorrection {
            line: row.line,
            torque_nm: point.torque,
            speed_rpm: point.speed * RPM,
            oil_temperature_degc: oil,
            calculated_nm: calculated,
            correction_nm: loss / speed - calculated,
            accuracy_nm: seen.accuracy(Quantity::Loss).unwrap_or(0.0) / speed,
        };
        all.push((gear.clone(), of_correction));
    }
    if all.is_empty() {
        let message = "no row has a measured loss at a speed, so that there is nothing to correct";
        let help = "give columns of `loss`, `loss_torque` or `efficiency`, or torques and speeds at both ports";
        return Err(cx.wrong_as(codes::CORRECTION, &path, message, help));
    }
    let mut corrections = Vec::new();
    for gear in distinct(all.iter().map(|(gear, _)| gear)) {
        let own = all
            .iter()
            .filter(|(of, _)| of == gear)
            .map(|(_, point)| *point)
            .collect();
        let fitted = Correction::fit(entry, gear, own);
        let help = "thin the rows out with `rows` or `hold_out`";
        corrections.extend(fitted.map_err(|reason| cx.wrong_as(codes::CORRECTION, &path, reason, help))?);
    }
    Ok(corrections)
}
