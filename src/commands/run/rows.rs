//! Points of a file: read, solved under one set of models, with the transmissions that their bound columns need.

use gearloss_framework::analysis::{Field, Given, Note, PointResult, merge, notes};
use gearloss_framework::description::{Ordered, ThermalMode};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loss::Extent;
use gearloss_framework::measured::{Measured, MeasuredEntry, Row};
use gearloss_framework::transmission::Transmission;
use serde_json::Value;

use super::trial::{Left, Trial, left, why};
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
        let combinations = combinations(measured);
        let mut sets_built: Vec<Vec<Built<'_>>> = Vec::new();
        for bound in &combinations {
            for (i, built) in self
                .built_with(gearbox, sets, &changes(bind, bound))?
                .into_iter()
                .enumerate()
            {
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
            for (key, own) in grouped(&keys) {
                let b = &built[key.0];
                let list = own
                    .iter()
                    .map(|k| given(measured, &measured.rows[*k], &b.transmission))
                    .collect();
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

/// Every combination of bound values, in the order of the rows.
fn combinations(measured: &Measured) -> Vec<&Vec<String>> {
    let mut combinations: Vec<&Vec<String>> = Vec::new();
    for row in &measured.rows {
        if !combinations.contains(&&row.bound) {
            combinations.push(&row.bound);
        }
    }
    combinations
}

/// The overrides of a combination.
fn changes(bind: &Ordered<String>, bound: &[String]) -> Vec<(String, Value)> {
    let paths = bind.iter().map(|(_, path)| path.clone());
    paths.zip(bound.iter().map(|v| bound_value(v))).collect()
}

/// Places of equal keys, in the order of the first of each.
fn grouped<K: PartialEq>(keys: &[K]) -> Vec<(&K, Vec<usize>)> {
    let mut groups: Vec<(&K, Vec<usize>)> = Vec::new();
    for (i, key) in keys.iter().enumerate() {
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, places)) => places.push(i),
            None => groups.push((key, vec![i])),
        }
    }
    groups
}

/// Measured points and how they are read.
pub struct Rows<'a> {
    pub measured: &'a Measured,
    pub bind: &'a Ordered<String>,
    /// Gear state where no column says it; absent, the first.
    pub gear: Option<&'a str>,
}

/// A row that was solved: its point, and why it has no loss where it has none.
pub type SolvedRow = (PointResult, Option<String>);

impl Trial<'_> {
    /// Solves every row with further overrides, as [`Runner::at_rows`] does, and adds the stated ranges that were left.
    pub(super) fn rows(
        &self,
        rows: &Rows<'_>,
        overrides: &[(String, Value)],
        seen: &mut Left,
    ) -> Result<Vec<SolvedRow>, String> {
        let measured = rows.measured;
        let mut found: Vec<Option<SolvedRow>> = vec![None; measured.rows.len()];
        for bound in combinations(measured) {
            let mut all = changes(rows.bind, bound);
            all.extend_from_slice(overrides);
            let t = self.build(all)?;
            let own: Vec<usize> = (0..found.len()).filter(|i| measured.rows[*i].bound == *bound).collect();
            let gears: Vec<&str> = own
                .iter()
                .map(|i| gear_of(measured.rows[*i].gear.as_deref().or(rows.gear), &t))
                .collect();
            for (gear, places) in grouped(&gears) {
                let row = |place: &usize| given(measured, &measured.rows[own[*place]], &t);
                let points = self.points(&t, gear, Field::List(places.iter().map(row).collect()));
                let solved = self.solve(&t, &points)?;
                seen.extend(left(&t, &solved));
                for (place, point) in places.into_iter().zip(solved.points) {
                    let why = point.loss.is_none().then(|| why(&t, &point));
                    found[own[place]] = Some((point, why));
                }
            }
        }
        Ok(found.into_iter().flatten().collect())
    }
}

fn given(measured: &Measured, row: &Row, transmission: &Transmission) -> Given {
    let value = |quantity: &str| measured.value(row, quantity);
    let fixed = transmission.thermal_mode == ThermalMode::Fixed;
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
