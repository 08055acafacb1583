//! The analyses of a study: their list, and their run with events.

use std::path::Path;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};

use gearloss_framework::files::SharedSource;
use gearloss_framework::language::Language;
use gearloss_report::html::{Frame, Report};
use gearloss_studies::analyses::{Outcome, Planner, Stopped};
use gearloss_studies::engine::progress::{Progress, Steps};
use gearloss_studies::run::StudyRun;
use gearloss_studies::study::Study;
use serde_json::{Value, json};

use crate::answer::Fault;
use crate::section::section_json;

/// Receives the events of a run. False if it must stop.
pub trait Listener: Sync {
    /// An event, as JSON.
    fn event(&self, event: Value);

    /// Keeps the page of a report; its address.
    fn report(&self, html: String) -> String;

    /// False if the run must stop.
    fn should_continue(&self) -> bool;
}

/// The analyses of a study.
pub fn analyses(language: &Language, files: &SharedSource, study: &str) -> Result<Value, Fault> {
    let study = Study::read_from(language, files, Path::new(study))?;
    let list = study.entry.analyses.iter().map(|(name, analysis)| {
        json!({
            "name": name,
            "title": analysis.title.clone().unwrap_or_else(|| name.replace('_', " ")),
            "type": analysis.kind().type_name(),
            "about": analysis.kind().meaning(),
        })
    });
    Ok(list.collect())
}

/// Runs analyses of a study, all of them and the report if none is named.
pub fn run(
    language: &Language,
    files: &SharedSource,
    study: &str,
    wanted: &[String],
    listener: &dyn Listener,
) -> Result<(), Fault> {
    let study = Study::read_from(language, files, Path::new(study))?;
    study.check(language)?;
    let run = StudyRun::new(language, &study);
    let mut report = Report::default();
    let mut failed = 0;
    for (name, analysis) in study.entry.analyses.iter() {
        if !wanted.is_empty() && !wanted.iter().any(|known| known == name) {
            continue;
        }
        report.begin(&study.entry.analyses, name, analysis);
        let title = report.sections.last().map(|section| section.title.clone());
        listener.event(json!({ "event": "begin", "analysis": name, "title": title }));
        let progress = Reported {
            listener,
            analysis: name,
        };
        match run.analysis_with(name, &progress) {
            Ok(outcome) => failed += usize::from(!add(&mut report, name, outcome.as_ref(), &study)),
            Err(Stopped::Interrupted) => return Ok(()),
            Err(stopped) => {
                failed += 1;
                report.fail(stopped.to_string());
            }
        }
        let section = report.sections.last().map(section_json);
        listener.event(json!({ "event": "section", "section": section }));
    }
    if wanted.is_empty() {
        let shortened = run.study_for_analysis();
        report.complete(&Planner::new(language, &shortened, "report"))?;
        let frame = Frame::new(&study, language, env!("CARGO_PKG_VERSION"));
        let address = listener.report(report.html(&frame)?);
        listener.event(json!({ "event": "report", "address": address }));
    }
    listener.event(json!({ "event": "end", "failed": failed }));
    Ok(())
}

/// Adds an outcome to the report; false if a part of it failed.
fn add(report: &mut Report, name: &str, outcome: &dyn Outcome, study: &Study) -> bool {
    let mut page = report.page(name, outcome);
    let faults = std::mem::take(&mut page.faults);
    if let Some(section) = report.sections.last_mut() {
        section.add(page);
    }
    let mut why: Vec<String> = outcome.failures().iter().map(ToString::to_string).collect();
    if !faults.is_empty() {
        why.push(study.findings(faults).to_string());
    }
    if !why.is_empty() {
        report.fail(why.concat());
    }
    why.is_empty()
}

/// Progress as events.
struct Reported<'a> {
    listener: &'a dyn Listener,
    analysis: &'a str,
}

impl Progress for Reported<'_> {
    fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_> {
        Box::new(ReportedSteps {
            of: self,
            label: label.to_owned(),
            count,
            done: AtomicUsize::new(0),
            told: Mutex::new(0),
        })
    }

    fn should_continue(&self) -> bool {
        self.listener.should_continue()
    }
}

struct ReportedSteps<'a> {
    of: &'a Reported<'a>,
    label: String,
    count: usize,
    done: AtomicUsize,
    /// What the last event said.
    told: Mutex<usize>,
}

impl Steps for ReportedSteps<'_> {
    /// At most about a hundred events for one piece of work.
    fn advance(&self, count: usize) {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if done >= *told + self.count.div_ceil(100) || done >= self.count {
            *told = done;
            self.of.listener.event(json!({
                "event": "progress", "analysis": self.of.analysis, "label": self.label, "done": done, "count": self.count,
            }));
        }
    }
}
