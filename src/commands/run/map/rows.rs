//! The table of a map: its columns, and the rows of the points as they are solved.

use gearloss_framework::analysis::{Piece, PointResult, SUMS};
use gearloss_framework::thermal::Outcome;
use serde_json::Value;

use super::super::super::solve::RPM;
use super::super::Built;
use super::super::write::{Cell, TableFile};
use super::{loss_of, sums, tidy, word};
use crate::output::Failure;

/// Names of the columns.
pub fn header(bound: &[String], parts: &[String]) -> Vec<String> {
    let mut header: Vec<String> = ["model_set", "gear"].map(str::to_owned).to_vec();
    header.extend_from_slice(bound);
    header.extend(
        [
            "torque_nm",
            "speed_rpm",
            "oil_temperature_degc",
            "surface_temperature_degc",
            "balance",
            "status",
            "efficiency",
            "loss_w",
            "loss_torque_nm",
            "input_w",
            "output_w",
        ]
        .map(str::to_owned),
    );
    header.extend(SUMS.iter().map(|(sum, _)| format!("{sum}_w")));
    header.extend(parts.iter().map(|p| format!("{p}_w")));
    header
}

/// What all rows of one map share.
pub struct RowsOf<'a> {
    set: &'a str,
    gear: &'a str,
    bound: Vec<String>,
    /// For each column of parts the number of the part in this map; absent where it has none.
    columns: Vec<Option<usize>>,
}

impl<'a> RowsOf<'a> {
    pub fn new(built: &'a Built<'_>, gear: &'a str, bound: &[(String, Value)], parts: &[String]) -> Self {
        let own = built.transmission.parts();
        Self {
            set: &built.name,
            gear,
            bound: bound.iter().map(|(_, value)| word(value)).collect(),
            columns: parts.iter().map(|p| own.iter().position(|o| o.path == *p)).collect(),
        }
    }

    /// Writes the rows of a piece that follows.
    pub fn write(&self, piece: &Piece, table: &mut TableFile) -> Result<(), Failure> {
        let points: Vec<&PointResult> = piece.points().collect();
        table.push_rows(&points, |point, row| {
            row.extend([Cell::Text(self.set), Cell::Text(self.gear)]);
            row.extend(self.bound.iter().map(|word| Cell::Text(word)));
            row.extend([
                Cell::Number(point.torque),
                Cell::Number(tidy(point.speed * RPM)),
                point.oil.into(),
                point.surface.into(),
                Cell::Text(point.balance.map_or("", Outcome::name)),
                Cell::Text(point.status.name()),
                point.efficiency.into(),
                point.loss.into(),
                point.loss_torque.into(),
                point.input.into(),
                point.output.into(),
            ]);
            let sums = sums(point);
            row.extend((0..SUMS.len()).map(|i| Cell::from(sums.map(|s| s[i]))));
            row.extend(
                self.columns
                    .iter()
                    .map(|c| Cell::from(c.and_then(|c| loss_of(point, c)))),
            );
        })
    }
}
