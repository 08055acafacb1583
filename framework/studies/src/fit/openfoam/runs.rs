//! A list of runs at the points of a grid, whose mean moments become a table of a drag model.

use std::cmp::Ordering;
use std::fmt::Write as _;

use gearloss_framework::document::{Diagnostic, Unit};
use gearloss_framework::mechanism::Mechanism;
use gearloss_framework::mechanism::planetary_drag::PlanetaryDrag;
use gearloss_framework::table::{Reading, Table};

use super::{Axis, Mean};
use crate::codes;
use crate::numbers::significant;

/// One run of the list.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Coordinates of the point as written, one for each axis.
    pub point: Vec<String>,
    /// Folder or file with the moments.
    pub folder: String,
    /// Line in the list.
    pub line: u64,
}

impl Run {
    fn coordinates(&self) -> impl Iterator<Item = f64> {
        self.point.iter().filter_map(|cell| cell.parse().ok())
    }
}

/// A list of runs: a column `name [unit]` for each axis and the folder of each run.
#[derive(Debug, Clone, PartialEq)]
pub struct Runs {
    axes: Vec<String>,
    runs: Vec<Run>,
}

impl Runs {
    /// Reads the list from CSV, whose last column is `folder`.
    ///
    /// # Errors
    /// If a column is missing, a coordinate is not a number, or there is no run.
    pub fn from_text(text: &str) -> Result<Self, Diagnostic> {
        read(text).map_err(|fault| {
            wrong(
                fault,
                "write a column `name [unit]` for each axis and `folder` as the last column",
            )
        })
    }

    /// The runs in the order of the list.
    pub fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// Makes the mean moments positive, as drag is. All must have the same sign, because drag opposes the motion.
    ///
    /// # Errors
    /// If a moment is zero or its sign differs from that of the first run.
    pub fn opposing(&self, means: Vec<Mean>, axis: Axis) -> Result<Vec<Mean>, Diagnostic> {
        let sign = means.first().map_or(1.0, |first| first.total().signum());
        if let Some((run, mean)) = self.runs.iter().zip(&means).find(|(_, m)| m.total() * sign <= 0.0) {
            return Err(wrong(
                format!(
                    "line {}: the mean moment about {} is {} Nm, whose sign differs from the first run",
                    run.line,
                    axis.name(),
                    significant(mean.total())
                ),
                "check the axis, the sense of rotation and the start of the averaging time",
            ));
        }
        Ok(means
            .into_iter()
            .map(|mean| Mean {
                pressure: sign * mean.pressure,
                viscous: sign * mean.viscous,
                ..mean
            })
            .collect())
    }

    /// The table of the moments, one mean for each run, as drag models read it; its points ascend along the axes.
    ///
    /// # Errors
    /// If the runs do not fill a grid, or an axis is no quantity of a drag model or in another unit.
    pub fn table(&self, means: &[Mean], axis: Axis, [from, to]: [f64; 2]) -> Result<String, Diagnostic> {
        let end = if to.is_finite() {
            format!(" to {to} s")
        } else {
            String::new()
        };
        let mut text = format!(
            "# Means of OpenFOAM moments about {} from {from} s{end}.\n",
            axis.name()
        );
        let _ = writeln!(text, "{},pressure [Nm],viscous [Nm]", self.axes.join(","));
        let mut rows: Vec<(&Run, &Mean)> = self.runs.iter().zip(means).collect();
        rows.sort_by(|(a, _), (b, _)| {
            let mut orders = a.coordinates().zip(b.coordinates()).map(|(a, b)| a.total_cmp(&b));
            orders.find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
        });
        for (run, mean) in rows {
            let _ = writeln!(text, "{},{},{}", run.point.join(","), mean.pressure, mean.viscous);
        }
        is_of_a_drag_model(&text, self.axes.len()).map_err(|fault| {
            wrong(
                format!("the runs do not form a table: {fault}"),
                "give one run for each point of a full grid, with quantities and units as names of the axes",
            )
        })?;
        Ok(text)
    }
}

fn wrong(message: String, help: &str) -> Diagnostic {
    Diagnostic::error("", message).help(help).code(codes::DATA)
}

fn read(text: &str) -> Result<Runs, String> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| e.to_string())?.clone();
    let axes: Vec<String> = header.iter().map(str::to_owned).collect();
    let Some((last, axes)) = axes.split_last().filter(|(_, axes)| !axes.is_empty()) else {
        return Err("line 1: too few columns".to_owned());
    };
    if last != "folder" {
        return Err(format!("line 1: the last column is `{last}`, not `folder`"));
    }
    let mut runs = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| e.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut point: Vec<String> = record.iter().map(str::to_owned).collect();
        let folder = point.pop().unwrap_or_default();
        for (column, (cell, name)) in (1..).zip(point.iter().zip(axes)) {
            if cell.parse::<f64>().ok().is_none_or(|x| !x.is_finite()) {
                return Err(format!(
                    "line {line}, column {column} `{name}`: `{cell}` is not a number"
                ));
            }
        }
        runs.push(Run { point, folder, line });
    }
    if runs.is_empty() {
        return Err("line 1: no runs below the header".to_owned());
    }
    Ok(Runs {
        axes: axes.to_vec(),
        runs,
    })
}

/// Full grid, known axes and units.
fn is_of_a_drag_model(table: &str, axes: usize) -> Result<(), String> {
    let read = Table::several_from_file(table, &Reading::default(), axes)?;
    for axis in read.iter().flat_map(Table::axes) {
        let Some(quantity) = PlanetaryDrag::QUANTITIES.iter().find(|q| q.name == axis.name) else {
            let names: Vec<&str> = PlanetaryDrag::QUANTITIES.iter().map(|q| q.name).collect();
            return Err(format!(
                "`{}` is not a known quantity; known: {}",
                axis.name,
                names.join(", ")
            ));
        };
        let unit = quantity.unit.symbol;
        if !Unit::is_same(unit, &axis.unit) {
            return Err(format!("`{}` is in {}, not in {unit}", axis.name, axis.unit));
        }
    }
    Ok(())
}
