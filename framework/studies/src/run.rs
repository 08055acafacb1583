//! Running a study: its analyses one after the other, each with the model sets that those before it have found.

use std::path::PathBuf;

use gearloss_framework::attach::dangling;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;

use crate::analyses::progress::Silent;
use crate::analyses::{Context, Outcome, Stopped};
use crate::codes;
use crate::study::Study;

/// A study that is run. It prints nothing and writes no file.
pub struct StudyRun<'a> {
    language: &'a Language,
    study: &'a Study,
    /// Files that the gearboxes had read before any analysis.
    known: Vec<Vec<PathBuf>>,
}

impl<'a> StudyRun<'a> {
    /// The run of a study that was checked ([`Study::check`]).
    pub fn new(language: &'a Language, study: &'a Study) -> Self {
        let known = |(_, gearbox): &(String, Gearbox)| gearbox.files.all().into_iter().map(|(file, _)| file).collect();
        Self {
            language,
            study,
            known: study.gearboxes.iter().map(known).collect(),
        }
    }

    /// The outcome of one analysis. Analyses whose model sets it uses (`then`) must have run before it.
    ///
    /// # Errors
    /// That no analysis has the name; everything that is wrong with its input.
    pub fn analysis(&self, name: &'a str) -> Result<Box<dyn Outcome>, Stopped> {
        self.run(&Context::new(self.language, self.study, name, &Silent))
    }

    /// Every analysis with its name and its outcome, in the order of the study; each runs when the iterator reaches it. An error
    /// of one does not stop those after it.
    pub fn outcomes(&self) -> impl Iterator<Item = (&'a str, Result<Box<dyn Outcome>, Stopped>)> + '_ {
        let names = self.study.entry.analyses.ids();
        names.map(|name| (name, self.analysis(name)))
    }

    /// The outcome of the analysis of a context, which may report progress, keep results of tasks or take rows of large tables.
    ///
    /// Files that other analyses have read are forgotten, so that the inputs listed in the outcome are its own.
    ///
    /// # Errors
    /// As [`StudyRun::analysis`], and [`Stopped::Checked`] of a context that only checks.
    pub fn run(&self, cx: &Context<'_>) -> Result<Box<dyn Outcome>, Stopped> {
        let Some(analysis) = self.study.entry.analyses.get(cx.name) else {
            let names: Vec<&str> = self.study.entry.analyses.ids().collect();
            return Err(cx.found(vec![dangling("analyses", "analysis", cx.name, &names)]));
        };
        for ((_, gearbox), known) in self.study.gearboxes.iter().zip(&self.known) {
            gearbox.files.forget_all_but(known);
        }
        if let Some((set, by)) = self.study.pending(analysis).filter(|_| !cx.only_checks) {
            let message = format!("the model set `{set}` has no values, because the analysis `{by}` produced none");
            let help = format!("correct `{by}`, or choose another set");
            return Err(cx.wrong_as(codes::NOT_FOUND_YET, &cx.path(), message, &help));
        }
        let outcome = analysis.run(cx)?;
        if let Some(then) = analysis.then() {
            self.study.keep_found(then.set, outcome.found());
        }
        Ok(outcome)
    }
}
