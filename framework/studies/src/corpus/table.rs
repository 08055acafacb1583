//! The cells of a corpus as a table: the one that models carry in the registry.

use std::fmt::Write as _;

use super::{Basis, CellOfSet};

/// Names of the columns.
const COLUMNS: &str = "mechanism,model,nested,part,set,kind,seen,points,ratio,least,greatest,bias_percent,rms_percent,max_percent,in_band,in_range,error,scatter";

/// The cells as CSV with three significant digits, so that a change of a law shows and a rounding of another machine does not.
pub fn cells_csv(cells: &[CellOfSet]) -> String {
    let mut text = format!("{COLUMNS}\n");
    for of in cells {
        let cell = of.cell;
        let kind = match of.kind {
            Basis::Measured => "measured",
            Basis::MakersData => "makers_data",
            Basis::Calculated => "calculated",
        };
        let numbers = [
            cell.ratio,
            cell.least,
            cell.greatest,
            cell.bias_percent,
            cell.rms_percent,
            cell.max_percent,
        ];
        let numbers = numbers.map(three_digits).join(",");
        let in_band = cell.in_band.map_or_else(String::new, |share| format!("{share:.2}"));
        // Writing into a text does not fail.
        let _ = writeln!(
            text,
            "{},{},{},{},{},{kind},{},{},{numbers},{in_band},{:.2},{},{}",
            of.mechanism,
            of.model,
            of.nested,
            of.part,
            of.set,
            if of.seen { "yes" } else { "no" },
            cell.points,
            cell.in_range,
            cell.error.map_or_else(String::new, three_digits),
            cell.scatter.map_or_else(String::new, three_digits)
        );
    }
    text
}

/// A number with three significant digits.
fn three_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    format!("{rounded}")
}
