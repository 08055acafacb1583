//! Points of a file: read, solved under one set of models, with the transmissions that their bound columns need.

use gearloss_framework::analysis::{Given, Note, PointResult, merge, notes};
use gearloss_framework::description::{Ordered, ThermalMode};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loss::Extent;
use gearloss_framework::measured::{Measured, MeasuredEntry, Row};
use serde_json::Value;

use super::write::hash;
use super::{Built, Runner, gear_of};
use crate::output::Failure;

/// All rows of a file under one set.
pub struct Solved<'a> {
    /// Name of the set.
    pub name: String,
    /// One transmission for each combination of bound values.
    pub built: Vec<Built<'a>>,
    /// For each row the number of its transmission, its gear state and its point.
    pub rows: Vec<(usize, String, PointResult)>,
    /// What was seen over all rows.
    pub notes: Vec<Note>,
}

impl Runner<'_> {
    /// Reads a file of points; `path` is the analysis' key that names it.
    pub(super) fn read(&self, path: &str, entry: &MeasuredEntry, bind: &[&str]) -> Result<Measured, Failure> {
        let wrong = |message: String, mend: String| -> Failure {
            let error = Diagnostic::error(path, format!("{}: {message}", entry.file)).mend(mend);
            self.study.findings(vec![error]).into()
        };
        if let Some(about) = &entry.about {
            self.report.borrow_mut().verdict(&format!("{}: {about}", entry.file));
        }
        let bytes = std::fs::read(self.study.folder.join(&entry.file)).map_err(|e| {
            wrong(
                format!("cannot read: {e}"),
                "file names are relative to the study".to_owned(),
            )
        })?;
        let known = (entry.file.clone(), hash(&bytes));
        if !self.read.borrow().contains(&known) {
            self.read.borrow_mut().push(known);
        }
        entry
            .read(&bytes, bind)
            .map_err(|fault| wrong(fault.message, fault.mend))
    }

    /// Solves every row under each set. A measured temperature of the oil counts where the model does not find its own.
    pub(super) fn at_rows<'s>(
        &'s self,
        gearbox: &'s Gearbox,
        sets: &'s [String],
        bind: &Ordered<String>,
        gear: Option<&str>,
        measured: &Measured,
        terms: bool,
    ) -> Result<Vec<Solved<'s>>, Failure> {
        let mut combinations: Vec<&Vec<String>> = Vec::new();
        for row in &measured.rows {
            if !combinations.contains(&&row.bound) {
                combinations.push(&row.bound);
            }
        }
        let mut sets_built: Vec<Vec<Built<'_>>> = Vec::new();
        for bound in &combinations {
            let paths = bind.iter().map(|(_, path)| path.clone());
            let overrides: Vec<(String, Value)> = paths.zip(bound.iter().map(|v| bound_value(v))).collect();
            for (i, built) in self.built_with(gearbox, sets, &overrides)?.into_iter().enumerate() {
                match sets_built.get_mut(i) {
                    Some(of_set) => of_set.push(built),
                    None => sets_built.push(vec![built]),
                }
            }
        }
        let mut all = Vec::new();
        for built in sets_built {
            // Rows of one transmission and gear state are solved together.
            let place = |row: &Row| combinations.iter().position(|c| **c == row.bound).unwrap_or(0);
            let state = |row: &Row, b: &Built<'_>| gear_of(row.gear.as_deref().or(gear), &b.transmission).to_owned();
            let keys: Vec<(usize, String)> = measured
                .rows
                .iter()
                .map(|row| (place(row), state(row, &built[place(row)])))
                .collect();
            let mut found: Vec<Option<PointResult>> = vec![None; keys.len()];
            let mut seen: Vec<Extent> = Vec::new();
            for (i, key) in keys.iter().enumerate() {
                if found[i].is_some() {
                    continue;
                }
                let own: Vec<usize> = (i..keys.len()).filter(|k| keys[*k] == *key).collect();
                let b = &built[key.0];
                let list = own.iter().map(|k| given(measured, &measured.rows[*k], b)).collect();
                let mut points = self.listed(&b.transmission, &key.1, list);
                points.terms = terms;
                let solved = self.solve(b, &points)?;
                // The transmissions of one set differ in bound values only, so their notes stand in the same order.
                merge(&mut seen, &solved.seen);
                for (k, point) in own.into_iter().zip(solved.points) {
                    found[k] = Some(point);
                }
            }
            let rows = keys.into_iter().zip(found.into_iter().flatten());
            all.push(Solved {
                name: built[0].name.clone(),
                rows: rows.map(|((place, gear), point)| (place, gear, point)).collect(),
                notes: notes(&built[0].transmission, &seen),
                built,
            });
        }
        Ok(all)
    }
}

fn given(measured: &Measured, row: &Row, built: &Built<'_>) -> Given {
    let value = |quantity: &str| measured.value(row, quantity);
    let fixed = built.transmission.thermal_mode == ThermalMode::Fixed;
    Given {
        torque: value("torque").unwrap_or(0.0),
        speed: value("speed").unwrap_or(0.0),
        oil: value("oil_temperature").filter(|_| fixed),
    }
}

/// A bound value as it goes into the document: a text with its unit, or a bare number.
fn bound_value(text: &str) -> Value {
    text.parse::<f64>().map_or_else(|_| Value::from(text), Value::from)
}
