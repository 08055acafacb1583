//! The table of a map: its columns, and the rows of the points as they are solved.

use gearloss_framework::thermal::Outcome;
use gearloss_studies::analysis::{Numbered, SUMS};
use serde_json::Value;

use super::super::super::solve::RPM;
use super::super::Built;
use super::super::columns::Columns;
use super::{loss_of, sums, tidy, word};

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

    /// The cells of some points.
    pub fn cells(&self, points: &Numbered<'_>, to: &mut Columns) {
        let points = || points.iter().map(|(_, point)| &**point);
        for same in [self.set, self.gear]
            .into_iter()
            .chain(self.bound.iter().map(String::as_str))
        {
            to.texts(points().map(|_| same));
        }
        to.numbers(points().map(|p| Some(p.torque)));
        to.numbers(points().map(|p| Some(tidy(p.speed * RPM))));
        to.numbers(points().map(|p| p.oil));
        to.numbers(points().map(|p| p.surface));
        to.texts(points().map(|p| p.balance.map_or("", Outcome::name)));
        to.texts(points().map(|p| p.status.name()));
        to.numbers(points().map(|p| p.efficiency));
        to.numbers(points().map(|p| p.loss));
        to.numbers(points().map(|p| p.loss_torque));
        to.numbers(points().map(|p| p.input));
        to.numbers(points().map(|p| p.output));
        for sum in 0..SUMS.len() {
            to.numbers(points().map(|p| sums(p).map(|sums| sums[sum])));
        }
        for part in &self.columns {
            match part {
                Some(part) => to.numbers(points().map(|p| loss_of(p, *part))),
                None => to.numbers(points().map(|_| None)),
            }
        }
    }
}
