//! Reads points of a file and solves them with model sets.

use std::sync::Arc;

use crate::measured::{Measured, MeasuredEntry, PortSpeeds};
use crate::points::{Note, OnRig, PointResult, Rows, TotalLoss, notes_with_shares};
use crate::study::Data;
use gearloss_framework::description::Ordered;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::OWN_MODELS;
use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;
use serde_json::Value;

use super::trial::{Left, Trial, left, why};
use crate::analyses::{Built, Engine, Plan, Planner, Run, Stopped, Work};

/// All rows of a file with one set.
pub struct Solved<'a> {
    /// Name of the set.
    pub name: String,
    /// One transmission for each combination of bound values.
    pub built: Vec<Arc<Built<'a>>>,
    /// One for each transmission and gear, without points, with the index of the transmission.
    pub runs: Vec<(usize, Run<'a>)>,
    /// For each row the index of its transmission, its gear and its point.
    pub rows: Vec<(usize, String, PointResult)>,
    /// Observed limits over all rows.
    pub notes: Vec<Note>,
}

impl Planner<'_> {
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

    /// As [`Planner::read`], for analyses that need torque and speed at the ports of the conditions.
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

/// Rows of a file with model sets: read, and built for each combination of bound values.
pub struct RowsPlan<'a> {
    /// The file.
    pub measured: Measured,
    bind: &'a Ordered<String>,
    gear: Option<&'a str>,
    terms: bool,
    sets: Vec<RowsOfSet<'a>>,
}

/// Rows with one set.
struct RowsOfSet<'a> {
    name: String,
    gearbox: &'a Gearbox,
    built: Vec<Arc<Built<'a>>>,
    /// One for each gear, with the index of its transmission.
    runs: Vec<(usize, Run<'a>)>,
}

impl Plan for RowsPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let work = |set: &RowsOfSet<'_>| Work::new(&set.name, "row", self.measured.rows.len());
        self.sets.iter().map(work).collect()
    }
}

impl<'a> RowsPlan<'a> {
    /// The runs of all sets.
    pub fn runs(&self) -> Vec<&Run<'a>> {
        let sets = self.sets.iter();
        sets.flat_map(|set| set.runs.iter().map(|(_, run)| run)).collect()
    }

    /// Builds the gearbox of every row with each set.
    ///
    /// # Errors
    /// Rows with invalid bound values, gears or ports; wrong limits of the study.
    pub fn new(
        cx: &Planner<'a>,
        gearbox: &'a Gearbox,
        sets: &[String],
        (measured, bind): (Measured, &'a Ordered<String>),
        gear: Option<&'a str>,
        terms: bool,
    ) -> Result<Self, Stopped> {
        let rows = cx.study.rows(&measured, bind, gear, terms);
        let of_set = |set: Option<&String>| -> Result<RowsOfSet<'a>, Stopped> {
            let (gearbox, choice) = match set {
                Some(name) => cx.study.reference("analyses", name, gearbox)?,
                None => (gearbox, None),
            };
            let name = set.map_or(OWN_MODELS, String::as_str).to_owned();
            let variants = Variants::new(cx.language, gearbox, cx.study.choice(choice));
            let transmissions = cx.rows_fit(&rows, gearbox, &variants)?;
            let built = rows.resolved(&variants)?.into_iter().zip(transmissions);
            let built = built.map(|(resolved, transmission)| {
                Arc::new(Built {
                    name: name.clone(),
                    gearbox,
                    resolved,
                    transmission,
                })
            });
            let built: Vec<_> = built.collect();
            let transmissions: Vec<&Transmission> = built.iter().map(|b| &b.transmission).collect();
            let runs = rows.kinds(&transmissions).into_iter();
            let runs = runs.map(|(place, points)| Ok((place, Run::new(cx, &built[place], points)?)));
            let runs = runs.collect::<Result<_, Stopped>>()?;
            Ok(RowsOfSet {
                name,
                gearbox,
                built,
                runs,
            })
        };
        let sets = if sets.is_empty() {
            vec![of_set(None)?]
        } else {
            sets.iter().map(|set| of_set(Some(set))).collect::<Result<_, _>>()?
        };
        Ok(Self {
            measured,
            bind,
            gear,
            terms,
            sets,
        })
    }

    /// Solves every row with each set, with torques corrected for the rig.
    ///
    /// # Errors
    /// An interruption.
    pub fn solve(&self, engine: &Engine<'_>) -> Result<Vec<Solved<'a>>, Stopped> {
        let rows = engine.study.rows(&self.measured, self.bind, self.gear, self.terms);
        let solve = |set| self.with_set(engine, &rows, set);
        engine.undivided(|| self.sets.iter().map(solve).collect())
    }

    fn with_set(&self, engine: &Engine<'_>, rows: &Rows<'_>, set: &RowsOfSet<'a>) -> Result<Solved<'a>, Stopped> {
        let rig = self.measured.rig;
        let running = engine.running(self.measured.rows.len(), &set.name);
        let solve = |on: Option<OnRig<'_>>| {
            let transmissions: Vec<&Transmission> = set.built.iter().map(|b| &b.transmission).collect();
            let solved = rows.solve(transmissions, on, &|n: usize| running.advance(n));
            let solved = solved.map_err(|list| Stopped::from(set.gearbox.findings(list)))?;
            solved.ok_or(Stopped::Interrupted)
        };
        let mut solved = solve(None)?;
        if !rig.is_silent() {
            let speeds = rows.speeds(&solved, rig.at_out());
            let speeds = speeds.map_err(|error| engine.found(vec![error]))?;
            solved = solve(Some(OnRig { rig, speeds: &speeds }))?;
        }
        let mut rows = solved.rows;
        for (place, run) in &set.runs {
            let of_run = rows.iter_mut().enumerate();
            let of_run = of_run.filter(|(_, row)| row.0 == *place && row.1 == run.points.gear);
            let mut of_run: Vec<(usize, &mut PointResult)> = of_run.map(|(i, row)| (i, &mut row.2)).collect();
            engine.mark(run, &mut of_run);
        }
        let lost = TotalLoss::of(rows.iter().map(|(_, _, point)| point));
        Ok(Solved {
            name: set.name.clone(),
            notes: notes_with_shares(&set.built[0].transmission, &solved.seen, lost),
            built: set.built.clone(),
            runs: set.runs.clone(),
            rows,
        })
    }
}

/// A solved row: its point, and the reason if it has no loss.
pub type SolvedRow = (PointResult, Option<String>);

impl Trial<'_> {
    /// Speeds of the ports in every row, if the rig of the rows contributes.
    pub fn speeds(&self, engine: &Engine<'_>, rows: &Rows<'_>) -> Result<Vec<PortSpeeds>, String> {
        let rig = &rows.measured.rig;
        if rig.is_silent() {
            return Ok(Vec::new());
        }
        let solved = self.solved_rows(engine, rows, &[], None)?;
        rows.speeds(&solved, rig.at_out()).map_err(|error| error.message)
    }

    /// Solves every row with further overrides, like [`RowsPlan::solve`], and adds quantities outside their stated ranges. The speeds are
    /// those of [`Trial::speeds`].
    pub fn rows(
        &self,
        engine: &Engine<'_>,
        rows: &Rows<'_>,
        speeds: &[PortSpeeds],
        overrides: &[(String, Value)],
        seen: &mut Left,
    ) -> Result<Vec<SolvedRow>, String> {
        let rig = rows.measured.rig;
        let on = (!rig.is_silent()).then_some(OnRig { rig, speeds });
        let solved = self.solved_rows(engine, rows, overrides, on)?;
        seen.extend(left(&solved.transmissions[0], &solved.seen));
        let row = |(place, _, point): (usize, String, PointResult)| {
            let why = point.loss.is_none().then(|| why(&solved.transmissions[place], &point));
            (point, why)
        };
        Ok(solved.rows.into_iter().map(row).collect())
    }
}
