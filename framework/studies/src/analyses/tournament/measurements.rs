//! The measured points of a tournament, with their accuracy.

use gearloss_numerics::inference::{PointSet, folds};
use gearloss_numerics::selection::{LossErrors, MeasuredLosses};

use super::super::{Planner, Stopped};
use super::entry::TournamentEntry;
use super::field::Field;
use crate::measured::{Measured, Row, Seen};
use crate::numbers::significant;
use crate::points::Given;
use crate::study::{Difference, Quantity};

/// The rows of a file in one gear.
pub struct OwnRows<'r> {
    pub rows: Vec<&'r Row>,
    pub given: Vec<Given>,
    /// Number of rows in other gears.
    pub others: usize,
}

impl<'r> OwnRows<'r> {
    /// The rows in the gear of the analysis.
    pub fn new(cx: &Planner<'_>, measured: &'r Measured, gear: &str) -> Result<Self, Stopped> {
        let of_gear = |row: &&Row| row.gear.as_deref().is_none_or(|g| g == gear);
        let rows: Vec<&Row> = measured.rows.iter().filter(of_gear).collect();
        if rows.len() < 3 {
            let message = format!("{} points in gear `{gear}` are not enough for a ranking", rows.len());
            let help = "select the gear with `gear`";
            return Err(cx.wrong(&format!("{}.data", cx.path()), message, help));
        }
        let given = |row: &&Row| Given {
            torque: measured.value(row, "torque").unwrap_or(0.0),
            speed: measured.value(row, "speed").unwrap_or(0.0),
            oil: measured.value(row, "oil_temperature"),
        };
        Ok(Self {
            given: rows.iter().map(given).collect(),
            others: measured.rows.len() - rows.len(),
            rows,
        })
    }
}

/// The measured points.
pub struct Measurements {
    /// \[Nm\]
    pub torques: Vec<f64>,
    /// \[rad/s\]
    pub speeds: Vec<f64>,
    pub losses: MeasuredLosses,
    /// Notes on their accuracy.
    pub notes: Vec<String>,
}

impl Measurements {
    /// Measured losses at the solved points with their accuracy.
    pub fn new(
        cx: &Planner<'_>,
        entry: &TournamentEntry,
        (measured, rows): (&Measured, &[&Row]),
        field: &Field<'_>,
    ) -> Result<Self, Stopped> {
        let data = format!("{}.data", cx.path());
        let (mut losses, mut stated) = (Vec::new(), Vec::new());
        for (row, point) in rows.iter().zip(&field.points) {
            let seen = Seen::without_rig(measured, row, point);
            let Some(loss) = seen.loss else {
                let message = format!("{}: the measured loss cannot be determined", measured.origin(row));
                let help = "give the loss, the loss torque, the efficiency, or torque and speed at both ports";
                return Err(cx.wrong(&data, message, help));
            };
            losses.push(loss);
            stated.push(seen.accuracy(Quantity::Loss).filter(|a| *a > 0.0));
        }
        let (deviations, mut notes) = accuracies(entry, &losses, &stated);
        if let Some(i) = deviations.iter().position(|d| !(*d > 0.0 && d.is_finite())) {
            let message = format!(
                "line {}: the accuracy of a loss of {} W is zero",
                rows[i].line, losses[i]
            );
            let help = "state an absolute accuracy too: `errors: { percent: 2, absolute: 5 W }`";
            return Err(cx.wrong(&format!("{}.errors", cx.path()), message, help));
        }
        let torques: Vec<f64> = field.points.iter().map(|p| p.torque).collect();
        let speeds: Vec<f64> = field.points.iter().map(|p| p.speed).collect();
        let oils: Vec<f64> = field.points.iter().map(|p| p.oil.unwrap_or(0.0)).collect();
        let groups = folds(&torques, entry.folds as usize);
        let groups = groups.map_err(|reason| cx.wrong(&data, reason, "give points at two or more torques"))?;
        let without = field.scale.iter().filter(|s| s.is_none()).count();
        if without > 0 {
            let what = entry.quantity.words(Difference::Points).0;
            notes.push(format!(
                "{without} points have no {what}: they are ranked by their loss, but omitted from errors in {}",
                entry.unit_in_words()
            ));
        }
        let weight = |row: &&Row| measured.value(row, "weight").unwrap_or(1.0);
        let measured = MeasuredLosses {
            losses,
            deviations,
            weights: rows.iter().map(weight).collect(),
            units: field.scale.clone(),
            folds: groups.into_iter().map(|fold| fold.points).collect(),
            points: PointSet::default(),
        };
        Ok(Self {
            losses: measured.with_conditions(&torques, &speeds, &oils),
            torques,
            speeds,
            notes,
        })
    }

    /// Accuracy of a point in the printed unit.
    pub fn accuracy(&self, i: usize) -> Option<f64> {
        Some(self.losses.units[i]? * self.losses.deviations[i])
    }
}

/// Accuracy of each loss, and notes on accuracies that are not in the file.
fn accuracies(entry: &TournamentEntry, losses: &[f64], stated: &[Option<f64>]) -> (Vec<f64>, Vec<String>) {
    let errors = entry.errors.map(|errors| LossErrors {
        percent: errors.percent.unwrap_or(0.0),
        absolute: errors.absolute.unwrap_or(0.0),
    });
    let (errors, word) = match errors {
        Some(errors) => (errors, "stated under `errors`"),
        None => (LossErrors::assumed(losses), "assumed: state them under `errors`"),
    };
    let lacking = stated.iter().filter(|a| a.is_none()).count();
    let mut notes = Vec::new();
    if lacking > 0 {
        notes.push(format!(
            "{lacking} of {} points have no accuracy in the file: {} % of the loss and {} W, standard deviations, added as squares, \
             {word}",
            losses.len(),
            significant(errors.percent),
            significant(errors.absolute)
        ));
    } else if entry.errors.is_some() {
        notes.push("the file states the accuracy of every point, so `errors` is not used".to_owned());
    }
    let accuracies = losses.iter().zip(stated);
    let accuracies = accuracies.map(|(loss, a)| a.unwrap_or_else(|| errors.standard_deviation(*loss)));
    (accuracies.collect(), notes)
}
