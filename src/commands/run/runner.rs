//! Shared state of the analyses of one run: study, result folder and report.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::ops::Deref;
use std::path::PathBuf;

use gearloss_framework::language::Language;
use gearloss_report::html::{Report, Section};
use gearloss_studies::analyses::{AnalysisEntry, Engine, Outcome, Planner};
use gearloss_studies::distinct::distinct;
use gearloss_studies::engine::progress::{Progress, Steps};
use gearloss_studies::limits::reached::LimitReached;
use gearloss_studies::run::StudyRun;
use gearloss_studies::study::{LimitEntry, Severity, Study, Write};
use gearloss_studies::tasks::TaskResults;
use indicatif::{ProgressBar, ProgressStyle};

use super::console::Shown;
use super::result_files::Files;
use super::table::Tables;
use super::write;
use crate::interrupt;
use crate::output::{Failure, Out};

/// Shared state of the analyses of one run.
pub struct Run<'a> {
    pub(super) language: &'a Language,
    pub(super) study: &'a Study,
    bars: Bars,
    pub(super) report: RefCell<Report>,
    /// Folder of the results.
    pub(super) files: Files,
    /// Quantities outside their stated ranges, counted over all analyses.
    pub(super) left: Cell<usize>,
    /// Limits whose quantity was known in an analysis.
    pub(super) limited: RefCell<BTreeSet<String>>,
    /// Limits that are not kept, each with the name of its analysis.
    pub(super) broken: RefCell<Vec<(String, LimitReached)>>,
    pub(super) analyses: StudyRun<'a>,
    /// Results of tasks that other processes have computed.
    tasks: Option<&'a dyn TaskResults>,
    /// What is printed.
    pub(super) shown: Shown,
}

/// One analysis of a run.
pub struct Runner<'a> {
    engine: Engine<'a>,
    pub(super) run: &'a Run<'a>,
}

impl<'a> Deref for Runner<'a> {
    type Target = Engine<'a>;

    fn deref(&self) -> &Engine<'a> {
        &self.engine
    }
}

/// Progress bars on standard error, on a terminal only.
struct Bars {
    shown: bool,
}

impl Progress for Bars {
    fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_> {
        Box::new(Bar(self.bar(count as u64, label)))
    }

    fn should_continue(&self) -> bool {
        !interrupt::pressed()
    }
}

impl Bars {
    fn bar(&self, count: u64, label: &str) -> ProgressBar {
        let bar = if self.shown {
            ProgressBar::new(count)
        } else {
            ProgressBar::hidden()
        };
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:30} {pos}/{len}") {
            bar.set_style(style);
        }
        bar.set_message(label.to_owned());
        bar
    }
}

struct Bar(ProgressBar);

impl Steps for Bar {
    fn advance(&self, count: usize) {
        self.0.inc(count as u64);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

impl<'a> Run<'a> {
    pub(super) fn new(
        language: &'a Language,
        study: &'a Study,
        folder: PathBuf,
        tasks: Option<&'a dyn TaskResults>,
        shown: Shown,
    ) -> Self {
        Self {
            shown,
            language,
            study,
            analyses: StudyRun::new(language, study),
            files: Files::new(folder),
            bars: Bars {
                shown: Out::error().is_terminal(),
            },
            report: RefCell::default(),
            left: Cell::new(0),
            limited: RefCell::default(),
            broken: RefCell::default(),
            tasks,
        }
    }

    /// The engine of a planner, whose study is that of [`StudyRun::study_for_analysis`].
    pub(super) fn engine<'r>(&'r self, planner: &'r Planner<'r>) -> Engine<'r> {
        Engine::new(planner, &self.bars).with_tasks(self.tasks)
    }

    /// Limits of the study whose quantity no analysis knows.
    pub(super) fn limits_never_known(&self, wanted: impl Fn(&LimitEntry) -> bool) -> Vec<String> {
        let limited = self.limited.borrow();
        let entries = self.study.entry.limits.iter();
        let never = entries.filter(|(name, entry)| !limited.contains(*name) && wanted(entry));
        never.map(|(name, _)| name.to_owned()).collect()
    }

    /// Limits of the severity `error` that are not kept or never known.
    pub(super) fn limits_not_kept(&self) -> Vec<String> {
        let broken = self.broken.borrow();
        let broken = broken.iter().filter(|(_, limit)| limit.severity == Severity::Error);
        let broken = broken.map(|(_, limit)| limit.limit.clone());
        let unknown = self.limits_never_known(|entry| entry.severity == Severity::Error);
        distinct(broken.chain(unknown))
    }

    /// Runs an analysis and adds its section to the report.
    pub(super) fn attempt(&self, name: &str, analysis: &AnalysisEntry, out: &mut Out) -> Result<(), Failure> {
        self.report
            .borrow_mut()
            .begin(&self.study.entry.analyses, name, analysis);
        let tables = Tables::new(&self.files, &analysis.write);
        let study = self.analyses.study_for_analysis();
        let planner = Planner::new(self.language, &study, name);
        let runner = Runner {
            engine: self.engine(&planner).with_sink(&tables),
            run: self,
        };
        match self.analyses.run(&runner.engine) {
            Ok(outcome) => {
                let shown = runner.present(analysis, outcome.as_ref(), out);
                drop(runner);
                let tables = tables.finish(&outcome.tables())?;
                shown?;
                if analysis.write.contains(&Write::Xlsx) {
                    write::workbook(self, name, &tables)?;
                }
                Ok(())
            }
            Err(stopped) => Err(stopped.into()),
        }
    }

    /// Changes the section of the present analysis.
    pub(super) fn in_section<T>(&self, change: impl FnOnce(&mut Section) -> T) -> Option<T> {
        self.report.borrow_mut().sections.last_mut().map(change)
    }
}

impl Runner<'_> {
    /// Prints an outcome, writes its files and adds it to the report.
    fn present(&self, analysis: &AnalysisEntry, outcome: &dyn Outcome, out: &mut Out) -> Result<(), Failure> {
        let outside = outcome.notes().iter().filter(|note| note.outside > 0).count();
        let left = outside + outcome.left_at_samples().len() + outcome.unlisted();
        self.run.left.set(self.run.left.get() + left);
        let limits = &outcome.head().study_limits;
        let known = limits.iter().filter(|limit| limit.points > 0);
        self.run
            .limited
            .borrow_mut()
            .extend(known.map(|limit| limit.limit.clone()));
        let broken = limits.iter().filter(|limit| limit.is_broken());
        let broken = broken.map(|limit| (self.name.to_owned(), limit.clone()));
        self.run.broken.borrow_mut().extend(broken);
        let mut page = self.run.report.borrow_mut().page(self.name, outcome);
        self.run.shown.page(&page, out)?;
        let formats = &analysis.write;
        for file in outcome.files() {
            write::keep(self.run, &file.name, Ok(file.text.into_bytes()))?;
        }
        if formats.contains(&Write::Json) {
            write::outcome(self, outcome)?;
        }
        for file in std::mem::take(&mut page.files) {
            write::keep(self.run, &file.name, Ok(file.bytes))?;
        }
        if formats.contains(&Write::Svg) {
            for named in &page.figures {
                write::picture(self.run, &named.name, &named.figure)?;
            }
        }
        let faults = std::mem::take(&mut page.faults);
        self.run.in_section(|section| section.add(page));
        if !faults.is_empty() {
            return Err(self.found(faults).into());
        }
        match outcome.failures() {
            [] => Ok(()),
            failures => Err(failures.into()),
        }
    }
}
