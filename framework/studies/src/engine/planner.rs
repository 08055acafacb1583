//! The planner of an analysis: reads, builds and checks what the entry asks for.

use std::sync::{Arc, Mutex, PoisonError};

use gearloss_framework::document::{Code, Diagnostic};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{OWN_MODELS, Resolved};
use gearloss_framework::transmission::{Case, Transmission};
use serde_json::Value;

use super::head::{Head, InputFile};
use super::stopped::Stopped;
use crate::analyses::AnalysisEntry;
use crate::analyses::common::machine_demand::MachineDemand;
use crate::analyses::common::model_error::{ModelError, ModelErrorOfSet, weigh};
use crate::analyses::identify::IdentifyEntry;
use crate::codes;
use crate::correction::{CorrectionFrom, ReadyCorrection, UsedCorrection};
use crate::limits::Scope;
use crate::limits::at_points::Watch;
use crate::points::{Field, Given, OilTemperature, Points};
use crate::study::{Grid, Study, Write};

/// One gearbox under one model set.
pub struct Built<'a> {
    /// Name of the set in the study.
    pub name: String,
    /// The gearbox.
    pub gearbox: &'a Gearbox,
    /// Its resolved description.
    pub resolved: Resolved,
    /// Its transmission.
    pub transmission: Transmission,
}

impl Built<'_> {
    /// The set without the product; absent for the default models of the gearbox.
    pub fn set(&self) -> Option<&str> {
        let set = self.name.rsplit('/').next();
        set.filter(|set| *set != OWN_MODELS)
    }
}

/// Maximum number of points in memory, samples included; with derived data they need a few gigabytes. Maps over grids store none.
const MOST_POINTS: usize = 2_000_000;

/// Maximum memory for the numbers that an analysis keeps of its samples. \[bytes\]
const MOST_MEMORY: usize = 4_000_000_000;

/// Files read by an analysis, and the notes of their entries.
#[derive(Debug, Default)]
struct Record {
    inputs: Vec<InputFile>,
    about: Vec<String>,
    model_errors: Vec<ModelErrorOfSet>,
    corrections: Vec<UsedCorrection>,
}

/// Plans analyses of a study: reads, builds and checks what an entry asks for, and solves nothing.
pub struct Planner<'a> {
    /// The language of all documents.
    pub language: &'a Language,
    /// The study.
    pub study: &'a Study,
    /// Name of the analysis in the study.
    pub name: &'a str,
    /// Its own lock, because files are also read in parallel.
    record: Mutex<Record>,
    /// What points demand of machines; absent where nothing reads it.
    machine_demand: Option<Mutex<MachineDemand>>,
}

impl<'a> Planner<'a> {
    /// For an analysis of a study.
    pub fn new(language: &'a Language, study: &'a Study, name: &'a str) -> Self {
        Self {
            language,
            study,
            name,
            record: Mutex::default(),
            machine_demand: None,
        }
    }

    /// The same, which also finds what the points demand of machines, for [`Planner::warnings`].
    pub fn with_machine_demand(self) -> Self {
        Self {
            machine_demand: Some(Mutex::default()),
            ..self
        }
    }

    /// Adds what points in a gear, or in the best one of several gears, demand of machines.
    pub(crate) fn add_machine_demand(&self, built: &Built<'_>, gears: &[&Points]) {
        if let Some(demand) = &self.machine_demand {
            demand.lock().unwrap_or_else(PoisonError::into_inner).add(built, gears);
        }
    }

    /// Warnings about the points that were planned; absent without any.
    pub fn warnings(&self) -> Option<Findings> {
        let demand = self.machine_demand.as_ref()?;
        let list = demand
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .warnings(&self.path());
        (!list.is_empty()).then(|| self.study.findings(list))
    }

    /// Whether the machines of a gearbox lose power under the conditions of the study.
    pub fn has_machines(&self, t: &Transmission) -> bool {
        let oil = OilTemperature::from_conditions(t, self.study.entry.conditions.oil_temperature);
        t.active_machines(oil == OilTemperature::Network).next().is_some()
    }

    /// Path of the analysis in the study.
    pub fn path(&self) -> String {
        format!("analyses.{}", self.name)
    }

    /// Files that the entry of the analysis requests.
    pub fn formats(&self) -> &'a [Write] {
        let entry = self.study.entry.analyses.get(self.name);
        entry.map_or(&[], |entry| &entry.write)
    }

    /// The head of an outcome without what limits reached: provenance.
    pub(crate) fn provenance(&self, built: &[&Built<'_>]) -> Head {
        let record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        let mut head = Head::new(self, built, &record.inputs, &record.about);
        head.model_error.clone_from(&record.model_errors);
        head.corrections.clone_from(&record.corrections);
        head
    }

    /// What the limits of the study are read for, at points of a gearbox.
    pub fn scope<'s>(&'s self, built: &'s Built<'_>) -> Scope<'s> {
        Scope {
            language: self.language,
            study: self.study,
            transmission: &built.transmission,
            cycles: None,
        }
    }

    /// The limits of the study at points of a gearbox.
    ///
    /// # Errors
    /// Wrong limits.
    pub fn watch(&self, built: &Built<'_>) -> Result<Option<Watch>, Stopped> {
        Ok(Watch::new(self.scope(built), built.gearbox, &built.resolved)?)
    }

    /// Records the hash of a file read by the analysis.
    pub fn keep_input(&self, file: &str, bytes: &[u8]) {
        let known = InputFile::new(None, file, bytes);
        let mut record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        if !record.inputs.contains(&known) {
            record.inputs.push(known);
        }
    }

    /// Records the note of a data entry on its file.
    pub fn keep_about(&self, file: &str, about: &str) {
        let mut record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        record.about.push(format!("{file}: {about}"));
    }

    /// Records what is known of the error of the models of a set.
    pub fn keep_model_error(&self, model_set: &str, laws: Vec<ModelError>) {
        let model_set = model_set.to_owned();
        let mut record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        record.model_errors.push(ModelErrorOfSet { model_set, laws });
    }

    /// The corrections of an identification; none before it has run.
    ///
    /// # Errors
    /// A file that cannot be read or has no correction; no such analysis above this one.
    pub fn corrections(&self, path: &str, from: &CorrectionFrom) -> Result<Vec<ReadyCorrection>, Stopped> {
        let at = |found: Diagnostic| {
            self.found(vec![Diagnostic {
                path: path.to_owned(),
                ..found
            }])
        };
        match (&from.of, &from.file) {
            (Some(analysis), None) => {
                if let Some(result) = self.study.correction(analysis) {
                    return from.take(result).map_err(at);
                }
                let above = self
                    .study
                    .entry
                    .analyses
                    .iter()
                    .take_while(|(name, _)| *name != self.name);
                let is_one = |(name, entry): &(&str, &AnalysisEntry)| {
                    let with = entry
                        .entry::<IdentifyEntry>()
                        .is_some_and(|entry| entry.correction.is_some());
                    name == analysis && with
                };
                if above.into_iter().any(|of| is_one(&of)) {
                    return Ok(Vec::new());
                }
                let message = format!("no analysis `{analysis}` above this one identifies with `correction`");
                let help =
                    "name an analysis of type `identify` that has `correction: {}`, and place it before this one";
                Err(self.wrong_as(codes::CORRECTION, &format!("{path}.of"), message, help))
            }
            (None, Some(file)) => {
                let bytes = self.study.read_file(file).map_err(|e| {
                    let help = "run the identification that writes it first; file names are relative to the study";
                    self.wrong_as(
                        codes::CORRECTION,
                        &format!("{path}.file"),
                        format!("{file}: cannot read: {e}"),
                        help,
                    )
                })?;
                self.keep_input(file, &bytes);
                from.read(&bytes).map_err(at)
            }
            _ => {
                let help = "write `correction: { of: ANALYSIS }`, or `correction: { file: RESULT.json }`";
                Err(self.wrong_as(
                    codes::CORRECTION,
                    path,
                    "a correction is either `of` an analysis or from a `file`",
                    help,
                ))
            }
        }
    }

    /// Records that numbers of the result contain a correction.
    pub fn keep_correction(&self, used: UsedCorrection) {
        let mut record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        let same =
            |of: &&mut UsedCorrection| (&of.from, &of.model_set, &of.gear) == (&used.from, &used.model_set, &used.gear);
        if let Some(known) = record.corrections.iter_mut().find(same) {
            known.inside += used.inside;
            known.outside += used.outside;
        } else {
            record.corrections.push(used);
        }
    }

    /// Records the nominal losses of a set by part, for the shares of its models.
    pub fn weigh_model_error(&self, model_set: &str, losses: &[f64]) {
        let mut record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        let of_set = record.model_errors.iter_mut().filter(|of| of.model_set == model_set);
        of_set.for_each(|of| weigh(&mut of.laws, losses));
    }

    /// The gearbox of an entry, or the first.
    ///
    /// # Errors
    /// If there is none.
    pub fn gearbox(&self, name: Option<&String>) -> Result<&'a Gearbox, Stopped> {
        let (_, gearbox) = self.study.gearbox(&self.path(), name)?;
        Ok(gearbox)
    }

    /// The gearbox with each set; with its default models if no set is given.
    ///
    /// # Errors
    /// All errors of resolving and building.
    pub fn built(&self, gearbox: &'a Gearbox, sets: &[String]) -> Result<Vec<Arc<Built<'a>>>, Stopped> {
        self.built_with(gearbox, sets, &[])
    }

    /// As [`Planner::built`], with further overrides, each with its place in the study.
    ///
    /// # Errors
    /// As [`Planner::built`].
    pub fn built_with(
        &self,
        gearbox: &'a Gearbox,
        sets: &[String],
        changes: &[(String, Value, String)],
    ) -> Result<Vec<Arc<Built<'a>>>, Stopped> {
        if sets.is_empty() {
            return Ok(vec![Arc::new(self.built_as(gearbox, None, None, changes)?)]);
        }
        let built = |set: &String| Ok(Arc::new(self.built_as(gearbox, Some(set), None, changes)?));
        sets.iter().map(built).collect()
    }

    /// The gearbox with one set and further overrides, under another name than that of the set.
    ///
    /// # Errors
    /// As [`Planner::built`].
    pub fn built_as(
        &self,
        gearbox: &'a Gearbox,
        set: Option<&str>,
        name: Option<&str>,
        changes: &[(String, Value, String)],
    ) -> Result<Built<'a>, Stopped> {
        let (gearbox, set_of_gearbox) = match set {
            Some(set) => self.study.reference("analyses", set, gearbox)?,
            None => (gearbox, None),
        };
        let mut choice = self.study.choice(set_of_gearbox);
        let overrides = changes.iter().map(|(path, value, _)| (path.clone(), value.clone()));
        choice.overrides.extend(overrides);
        let places: Vec<_> = changes
            .iter()
            .map(|(path, _, place)| (path.clone(), place.clone()))
            .collect();
        let (resolved, transmission) = self.study.built(self.language, gearbox, &choice, &places)?;
        Ok(Built {
            name: name.or(set).unwrap_or(OWN_MODELS).to_owned(),
            gearbox,
            resolved,
            transmission,
        })
    }

    /// The points of axes under the study's conditions.
    pub fn points(&self, transmission: &Transmission, gear: &str, torques: Vec<f64>, speeds: Vec<f64>) -> Points {
        self.field(transmission, gear, Field::Grid { torques, speeds })
    }

    /// The points of a list under the study's conditions.
    pub fn listed(&self, transmission: &Transmission, gear: &str, list: Vec<Given>) -> Points {
        self.field(transmission, gear, Field::List(list))
    }

    /// Points under the study's conditions.
    pub fn field(&self, transmission: &Transmission, gear: &str, field: Field) -> Points {
        self.study.points(transmission, gear, field)
    }

    /// The case of points under the conditions.
    ///
    /// # Errors
    /// If the gear, the ports or their number are invalid.
    pub fn case(&self, gearbox: &Gearbox, t: &Transmission, points: &Points) -> Result<Case, Stopped> {
        Ok(self.study.case(&self.path(), gearbox, t, points)?)
    }

    /// The single gear of a grid.
    ///
    /// # Errors
    /// If it has several.
    pub fn one_gear(&self, path: &str, grid: &Grid, t: &Transmission) -> Result<String, Stopped> {
        match &grid.gear.selected(t)[..] {
            [gear] => Ok(gear.clone()),
            several => Err(self.wrong(
                path,
                format!("this analysis needs a grid with one gear, not {}", several.len()),
                "give it its own grid",
            )),
        }
    }

    /// An error of the study at a path.
    pub fn wrong(&self, path: &str, message: impl Into<String>, help: &str) -> Stopped {
        self.wrong_as(codes::ANALYSIS, path, message, help)
    }

    /// As [`Planner::wrong`], with the code of its kind.
    pub fn wrong_as(&self, code: Code, path: &str, message: impl Into<String>, help: &str) -> Stopped {
        self.found(vec![Diagnostic::error(path, message.into()).help(help).code(code)])
    }

    /// Findings about the study.
    pub fn found(&self, list: Vec<Diagnostic>) -> Stopped {
        self.study.findings(list).into()
    }

    /// Rejects more samples than fit into memory, each with so many bytes of results.
    ///
    /// # Errors
    /// There.
    pub fn fit_in_memory(&self, path: &str, samples: usize, bytes: usize) -> Result<(), Stopped> {
        let needed = samples.saturating_mul(bytes);
        if needed <= MOST_MEMORY {
            return Ok(());
        }
        let [needed, most] = [needed, MOST_MEMORY].map(|bytes| bytes as f64 / 1e9);
        let message = format!("the results of {samples} samples need {needed:.1} GB of memory, more than {most} GB");
        Err(self.wrong_as(codes::TOO_LARGE, path, message, "use fewer samples or points"))
    }

    /// Rejects too many points in memory: `times` times `points`.
    ///
    /// # Errors
    /// There.
    pub fn holds(&self, path: &str, points: usize, times: usize) -> Result<(), Stopped> {
        if points.saturating_mul(times) <= MOST_POINTS {
            return Ok(());
        }
        let of = if times > 1 {
            format!(", {times} times {points},")
        } else {
            format!(", {points},")
        };
        let message = format!("more points{of} than the maximum of {MOST_POINTS} in memory");
        Err(self.wrong_as(
            codes::TOO_LARGE,
            path,
            message,
            "use fewer samples, values or points; a `map` over a grid can have more, because it stores none",
        ))
    }
}

/// The gear of an entry, or the first.
pub fn gear_of<'t>(named: Option<&'t str>, transmission: &'t Transmission) -> &'t str {
    let first = transmission.states().first().map_or("", |s| s.name.as_str());
    named.unwrap_or(first)
}
