//! Running a study: its analyses one after the other, each with the model sets that those before it have found.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use gearloss_framework::attach::dangling;
use gearloss_framework::language::Language;
use serde_json::{Map, Value};

use crate::analyses::identify::IdentifyOutcome;
use crate::analyses::{AnalysisEntry, BuiltAgain, Engine, Outcome, Planner, Stopped, Work};
use crate::codes;
use crate::engine::progress::{Progress, Silent};
use crate::study::Study;

/// Before the name of an analysis: where its corrections are among the found sets, whose names have no `/`.
const CORRECTION_OF: &str = "correction/";

/// Model sets that analyses have found (`then`): resolved path to value, by name of the set.
pub type FoundSets = BTreeMap<String, Map<String, Value>>;

/// A study that is run. It prints nothing and writes no file. Runs of one study do not affect each other.
pub struct StudyRun<'a> {
    language: &'a Language,
    /// The study before any analysis.
    study: Study,
    found: Mutex<FoundSets>,
}

impl<'a> StudyRun<'a> {
    /// The run of a study that was checked ([`Study::check`]).
    pub fn new(language: &'a Language, study: &Study) -> Self {
        Self {
            language,
            study: study.clone(),
            found: Mutex::default(),
        }
    }

    /// The run of a study of which other runs have finished analyses: with the model sets that those found.
    pub fn continued(language: &'a Language, study: &Study, found: FoundSets) -> Self {
        Self {
            found: Mutex::new(found),
            ..Self::new(language, study)
        }
    }

    /// The language of its documents.
    pub fn language(&self) -> &'a Language {
        self.language
    }

    /// Model sets that the finished analyses have found.
    pub fn found_sets(&self) -> FoundSets {
        self.found().clone()
    }

    /// The study for the next analysis: with the model sets found so far, and with gearboxes that have read no files of other analyses,
    /// so that the inputs listed in an outcome are its own.
    pub fn study_for_analysis(&self) -> Study {
        let mut study = self.study.clone();
        for (set, values) in self.found().iter() {
            match set.strip_prefix(CORRECTION_OF) {
                Some(analysis) => study.fill_correction(analysis, Value::Object(values.clone())),
                None => study.fill_set(set, values.clone()),
            }
        }
        study
    }

    /// The outcome of one analysis. Analyses whose model sets it uses (`then`) must have run before it.
    ///
    /// # Errors
    /// That no analysis has the name; everything that is wrong with its input.
    pub fn analysis(&self, name: &str) -> Result<Box<dyn Outcome>, Stopped> {
        self.analysis_with(name, &Silent)
    }

    /// The same with progress, by which the caller may interrupt.
    ///
    /// # Errors
    /// As [`StudyRun::analysis`].
    pub fn analysis_with(&self, name: &str, progress: &dyn Progress) -> Result<Box<dyn Outcome>, Stopped> {
        let study = self.study_for_analysis();
        let planner = Planner::new(self.language, &study, name);
        self.run(&Engine::new(&planner, progress))
    }

    /// Every analysis with its name and its outcome, in the order of the study; each runs when the iterator reaches it. An error
    /// of one does not stop those after it.
    pub fn outcomes(&self) -> impl Iterator<Item = (&str, Result<Box<dyn Outcome>, Stopped>)> {
        let names = self.study.entry.analyses.ids();
        names.map(|name| (name, self.analysis(name)))
    }

    /// The plan of the analysis of a planner, whose study is the one of [`StudyRun::study_for_analysis`]: the whole of `check`.
    ///
    /// # Errors
    /// That no analysis has the name; everything that is wrong with its input.
    pub fn plan(&self, planner: &Planner<'_>) -> Result<Vec<Work>, Stopped> {
        entry(planner)?.plan(planner)
    }

    /// How other values of the varied quantities of an analysis get into the gearbox of a sample; empty where it is not stated.
    ///
    /// # Errors
    /// As [`StudyRun::plan`].
    pub fn samples(&self, planner: &Planner<'_>) -> Result<Vec<BuiltAgain>, Stopped> {
        entry(planner)?.samples(planner)
    }

    /// The outcome of the analysis of an engine, which may report progress, keep results of tasks or take rows of large tables.
    ///
    /// # Errors
    /// As [`StudyRun::analysis`].
    pub fn run(&self, engine: &Engine<'_>) -> Result<Box<dyn Outcome>, Stopped> {
        let analysis = entry(engine)?;
        if let Some((set, by)) = engine.study.pending(analysis) {
            let message = format!("the model set `{set}` has no values, because the analysis `{by}` produced none");
            let help = format!("correct `{by}`, or choose another set");
            return Err(engine.wrong_as(codes::NOT_FOUND_YET, &engine.path(), message, &help));
        }
        let outcome = analysis.run(engine)?;
        if let Some(then) = analysis.then() {
            let values = outcome.found().into_iter().collect();
            self.found().insert(then.set.to_owned(), values);
        }
        if let Some(corrections) = outcome.get::<IdentifyOutcome>().and_then(IdentifyOutcome::corrections) {
            self.found()
                .insert(format!("{CORRECTION_OF}{}", engine.name), corrections);
        }
        Ok(outcome)
    }

    fn found(&self) -> MutexGuard<'_, FoundSets> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The analysis of a planner.
fn entry<'a>(planner: &Planner<'a>) -> Result<&'a AnalysisEntry, Stopped> {
    let analyses = &planner.study.entry.analyses;
    analyses.get(planner.name).ok_or_else(|| {
        let names: Vec<&str> = analyses.ids().collect();
        planner.found(vec![dangling("analyses", "analysis", planner.name, &names)])
    })
}
