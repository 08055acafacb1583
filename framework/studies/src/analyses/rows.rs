//! Reads points of a file and solves them with model sets.

use crate::distinct::distinct;
use crate::measured::{Measured, MeasuredEntry, PortSpeeds};
use crate::points::{Note, OnRig, PointResult, Rows, TotalLoss, notes_with_shares};
use crate::study::Data;
use gearloss_framework::description::Ordered;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::{OWN_MODELS, Resolved};
use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;
use serde_json::Value;

use super::trial::{Left, Trial, left, why};
use super::{Built, Context, Stopped};

/// All rows of a file with one set.
pub struct Solved<'a> {
    /// Name of the set.
    pub name: String,
    /// One transmission for each combination of bound values.
    pub built: Vec<Built<'a>>,
    /// For each row the index of its transmission, its gear and its point.
    pub rows: Vec<(usize, String, PointResult)>,
    /// Observed limits over all rows.
    pub notes: Vec<Note>,
}

impl Context<'_> {
    /// The data entry: from the measurements of the study, or from the analysis.
    pub fn data<'s>(&'s self, path: &str, data: &'s Data) -> Result<&'s MeasuredEntry, Stopped> {
        Ok(self.study.measurement(path, data)?)
    }

    /// Reads a file of points; `path` is the analysis' key that names it.
    pub fn read(&self, path: &str, data: &Data, bind: &[&str]) -> Result<Measured, Stopped> {
        let entry = self.data(path, data)?;
        if let Some(about) = &entry.about {
            self.keep_about(&entry.file.to_string(), about);
        }
        let (measured, files) = self.study.measured(path, data, bind)?;
        for (file, bytes) in files {
            self.keep_input(&file, &bytes);
        }
        Ok(measured)
    }

    /// As [`Context::read`], for analyses that need torque and speed at the ports of the conditions.
    pub fn read_at_ports(&self, path: &str, data: &Data, bind: &[&str]) -> Result<Measured, Stopped> {
        let measured = self.read(path, data, bind)?;
        let given = [
            (measured.torque_at_other_port, "torque"),
            (measured.speed_at_other_port, "speed"),
        ];
        match given.into_iter().find(|(other, _)| *other) {
            Some((_, quantity)) => Err(self.wrong(
                path,
                format!(
                    "{}: `{quantity}_out` alone does not determine the {quantity} that this analysis needs",
                    self.data(path, data)?.file
                ),
                &format!(
                    "add a column of the {quantity} at the port of the conditions: `columns: {{ {quantity}: ... }}`"
                ),
            )),
            None => Ok(measured),
        }
    }

    /// Solves every row with each set, with torques corrected for the rig; solves none if an analysis is only checked.
    pub fn at_rows<'s>(
        &'s self,
        gearbox: &'s Gearbox,
        sets: &'s [String],
        bind: &Ordered<String>,
        gear: Option<&str>,
        measured: &Measured,
        terms: bool,
    ) -> Result<Vec<Solved<'s>>, Stopped> {
        let rows = self.study.rows(measured, bind, gear, terms);
        let own = |set: Option<&'s String>| -> Result<Option<Solved<'s>>, Stopped> {
            let (gearbox, choice) = match set {
                Some(name) => self.study.reference("analyses", name, gearbox)?,
                None => (gearbox, None),
            };
            let name = set.map_or(OWN_MODELS, String::as_str);
            let choice = self.study.choice(choice);
            let variants = Variants::new(self.language, gearbox, choice);
            let transmissions = self.rows_fit(&rows, gearbox, &variants)?;
            if self.only_checks {
                self.limits_fit(name, gearbox, rows.resolved(&variants)?, transmissions)?;
                return Ok(None);
            }
            let running = self.running(measured.rows.len(), name);
            let going = |n: usize| running.advance(n);
            let solve = |transmissions: Vec<Transmission>, on: Option<OnRig<'_>>| {
                let solved = rows.solve(transmissions, on, &going);
                let solved = solved.map_err(|list| Stopped::from(gearbox.findings(list)))?;
                solved.ok_or(Stopped::Interrupted)
            };
            let mut solved = solve(transmissions, None)?;
            if !measured.rig.is_silent() {
                let speeds = rows.speeds(&solved, measured.rig.at_out());
                let speeds = speeds.map_err(|error| self.found(vec![error]))?;
                let (rig, speeds) = (measured.rig, &speeds[..]);
                solved = solve(solved.transmissions, Some(OnRig { rig, speeds }))?;
            }
            let resolved = rows.resolved(&variants)?;
            let built = resolved.into_iter().zip(solved.transmissions);
            let built = built.map(|(resolved, transmission)| Built {
                name: name.to_owned(),
                gearbox,
                resolved,
                transmission,
            });
            let built: Vec<Built<'s>> = built.collect();
            self.mark_rows(&rows, &built, &mut solved.rows)?;
            let lost = TotalLoss::of(solved.rows.iter().map(|(_, _, point)| point));
            Ok(Some(Solved {
                name: name.to_owned(),
                rows: solved.rows,
                notes: notes_with_shares(&built[0].transmission, &solved.seen, lost),
                built,
            }))
        };
        if sets.is_empty() {
            return Ok(own(None)?.into_iter().collect());
        }
        let all: Vec<_> = sets.iter().map(|set| own(Some(set))).collect::<Result<_, Stopped>>()?;
        Ok(all.into_iter().flatten().collect())
    }

    /// Whether the limits of the study fit the first transmission of rows.
    fn limits_fit(
        &self,
        name: &str,
        gearbox: &Gearbox,
        resolved: Vec<Resolved>,
        transmissions: Vec<Transmission>,
    ) -> Result<(), Stopped> {
        for (resolved, transmission) in resolved.into_iter().zip(transmissions).take(1) {
            let built = Built {
                name: name.to_owned(),
                gearbox,
                resolved,
                transmission,
            };
            self.watch(&built)?;
        }
        Ok(())
    }

    /// Adds the limited quantities to solved rows, and notes what the limits reach.
    fn mark_rows(
        &self,
        rows: &Rows<'_>,
        built: &[Built<'_>],
        solved: &mut [(usize, String, PointResult)],
    ) -> Result<(), Stopped> {
        for (place, b) in built.iter().enumerate() {
            let Some(watch) = self.watch(b)? else { continue };
            let gears = solved.iter().filter(|row| row.0 == place).map(|row| row.1.clone());
            for gear in distinct(gears) {
                let own = solved.iter_mut().enumerate();
                let own = own.filter(|(_, row)| row.0 == place && row.1 == gear);
                let mut own: Vec<(usize, &mut PointResult)> = own.map(|(i, row)| (i, &mut row.2)).collect();
                let points = rows.points(&gear, &b.transmission, Vec::new());
                self.mark(b, &watch, &points, &mut own);
            }
        }
        Ok(())
    }

    /// The transmissions of rows; rows with invalid bound values, gears or ports are errors.
    pub fn rows_fit(
        &self,
        rows: &Rows<'_>,
        gearbox: &Gearbox,
        variants: &Variants<'_>,
    ) -> Result<Vec<Transmission>, Stopped> {
        let transmissions = rows.build(variants, &[]).map_err(|findings| {
            // Errors without a key of the gearbox belong to the analysis.
            if findings.list.iter().any(|error| !error.path.is_empty()) {
                return findings;
            }
            let path = self.path();
            let at_analysis = |error| Diagnostic {
                path: path.clone(),
                ..error
            };
            self.study
                .findings(findings.list.into_iter().map(at_analysis).collect())
        })?;
        for (place, points) in rows.kinds(&transmissions) {
            self.case(gearbox, &transmissions[place], &points)?;
        }
        Ok(transmissions)
    }
}

/// A solved row: its point, and the reason if it has no loss.
pub type SolvedRow = (PointResult, Option<String>);

impl Trial<'_> {
    /// Speeds of the ports in every row, if the rig of the rows contributes.
    pub fn speeds(&self, rows: &Rows<'_>) -> Result<Vec<PortSpeeds>, String> {
        let rig = &rows.measured.rig;
        if rig.is_silent() {
            return Ok(Vec::new());
        }
        let solved = self.solved_rows(rows, &[], None)?;
        rows.speeds(&solved, rig.at_out()).map_err(|error| error.message)
    }

    /// Solves every row with further overrides, like [`Context::at_rows`], and adds quantities outside their stated ranges. The speeds are
    /// those of [`Trial::speeds`].
    pub fn rows(
        &self,
        rows: &Rows<'_>,
        speeds: &[PortSpeeds],
        overrides: &[(String, Value)],
        seen: &mut Left,
    ) -> Result<Vec<SolvedRow>, String> {
        let rig = rows.measured.rig;
        let on = (!rig.is_silent()).then_some(OnRig { rig, speeds });
        let solved = self.solved_rows(rows, overrides, on)?;
        seen.extend(left(&solved.transmissions[0], &solved.seen));
        let row = |(place, _, point): (usize, String, PointResult)| {
            let why = point.loss.is_none().then(|| why(&solved.transmissions[place], &point));
            (point, why)
        };
        Ok(solved.rows.into_iter().map(row).collect())
    }
}
