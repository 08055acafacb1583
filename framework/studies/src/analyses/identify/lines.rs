//! Lines of measured points: one gear state, torque and temperature, over speed.

use crate::distinct::distinct;
use crate::identify::Identification;
use crate::measured::Measured;
use crate::points::levels;
use crate::study::Quantity;

/// Difference of oil temperatures above which points belong to different lines. \[K\]
const APART: f64 = 3.0;

/// Rows of one gear state, combination of bound values, and temperature of the oil.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sheet {
    /// Their common conditions as text; empty if common to all rows.
    pub name: String,
    /// The rows, in the order of the file.
    pub rows: Vec<usize>,
}

/// The sheets of a file. `gear` is the gear of rows without one.
pub(super) fn sheets(measured: &Measured, gear: &str) -> Vec<Sheet> {
    let oil = |i: usize| measured.value(&measured.rows[i], "oil_temperature");
    let mut order: Vec<usize> = (0..measured.rows.len()).collect();
    order.sort_by(|a, b| oil(*a).unwrap_or(0.0).total_cmp(&oil(*b).unwrap_or(0.0)).then(a.cmp(b)));
    let mut level = vec![0; order.len()];
    let mut count = 0;
    for pair in order.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|i| oil(i).unwrap_or(0.0));
        count += usize::from(b - a > APART);
        level[pair[1]] = count;
    }
    let key = |i: usize| {
        let row = &measured.rows[i];
        (row.gear.as_deref().unwrap_or(gear), &row.bound, level[i])
    };
    let keys = distinct((0..measured.rows.len()).map(key));
    let several = |differ: bool, words: String| differ.then_some(words);
    let sheet = |k: &(&str, &Vec<String>, usize)| {
        let rows: Vec<usize> = (0..measured.rows.len()).filter(|i| key(*i) == *k).collect();
        let warm: Vec<f64> = rows.iter().filter_map(|i| oil(*i)).collect();
        let mean = warm.iter().sum::<f64>() / warm.len().max(1) as f64;
        let words = [
            several(keys.iter().any(|other| other.0 != k.0), k.0.to_owned()),
            several(keys.iter().any(|other| other.1 != k.1), k.1.join(", ")),
            several(count > 0 && !warm.is_empty(), format!("{mean:.0} degC")),
        ];
        Sheet {
            name: words.into_iter().flatten().collect::<Vec<_>>().join(", "),
            rows,
        }
    };
    keys.iter().map(sheet).collect()
}

impl Sheet {
    /// Its rows by torque, each line in the order of the speeds.
    pub fn lines(&self, measured: &Measured) -> Vec<(f64, Vec<usize>)> {
        let value = |i: usize, name: &str| measured.value(&measured.rows[i], name).unwrap_or(0.0);
        let torques: Vec<f64> = self.rows.iter().map(|i| value(*i, "torque")).collect();
        let line = |places: Vec<usize>| {
            let mean = places.iter().map(|p| torques[*p]).sum::<f64>() / places.len() as f64;
            let mut rows: Vec<usize> = places.into_iter().map(|p| self.rows[p]).collect();
            rows.sort_by(|a, b| value(*a, "speed").total_cmp(&value(*b, "speed")));
            (mean, rows)
        };
        levels(&torques).into_iter().map(line).collect()
    }
}

/// Indices of residuals along all lines, by quantity.
pub(super) fn of_residuals(identification: &Identification<'_>, sheets: &[Sheet]) -> Vec<Vec<usize>> {
    let quantities = [
        Quantity::Efficiency,
        Quantity::Loss,
        Quantity::LossTorque,
        Quantity::Temperature,
    ];
    let observations = identification.observations();
    let mut all = Vec::new();
    for quantity in quantities {
        for (_, rows) in sheets.iter().flat_map(|sheet| sheet.lines(identification.measured())) {
            let place = |row: &usize| {
                observations
                    .iter()
                    .position(|o| o.row == *row && o.quantity == quantity)
            };
            let line: Vec<usize> = rows.iter().filter_map(place).collect();
            if !line.is_empty() {
                all.push(line);
            }
        }
    }
    all
}
