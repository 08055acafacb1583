//! A study that is checked without computing anything: what `run` would refuse or warn about.

use std::path::Path;

use gearloss_framework::files::SharedSource;
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;

use crate::analyses::{BuiltAgain, Planner, Stopped, Work};
use crate::engine::progress::Progress;
use crate::run::StudyRun;
use crate::study::{Cautions, Study};

/// Findings of a study before it runs.
#[derive(Debug, Default)]
pub struct CheckedStudy {
    /// Errors that `run` reports before it computes, by analysis, without repetition.
    pub refused: Vec<Stopped>,
    /// What each analysis computes, by its name; nothing of those that are refused.
    pub plans: Vec<(String, Vec<Work>)>,
    /// Warnings of its gearboxes, and of its analyses about what their points demand of machines.
    pub warnings: Vec<Findings>,
    /// Components of its gearboxes without a model, and coefficients that differ from their source.
    pub notes: Vec<String>,
}

impl CheckedStudy {
    /// Reads a study of a source with its gearboxes, and checks every analysis. Nothing is computed. The caller can interrupt it; then
    /// the last of [`CheckedStudy::refused`] is [`Stopped::Interrupted`].
    pub fn read(language: &Language, files: &SharedSource, file: &Path, progress: &dyn Progress) -> Self {
        let study = Study::read_from(language, files, file).and_then(|study| {
            study.check(language)?;
            Ok(study)
        });
        match study {
            Ok(study) => Self::new(language, &study, progress),
            Err(findings) => Self {
                refused: vec![findings.into()],
                ..Self::default()
            },
        }
    }

    fn new(language: &Language, study: &Study, progress: &dyn Progress) -> Self {
        let run = StudyRun::new(language, study);
        let mut reported = Reported::default();
        let mut refused: Vec<Stopped> = Vec::new();
        let (mut plans, mut demand) = (Vec::new(), Vec::<Findings>::new());
        if let Some(findings) = study.data_findings() {
            reported.add(&findings);
            refused.push(findings.into());
        }
        for name in study.entry.analyses.ids() {
            if !progress.should_continue() {
                refused.push(Stopped::Interrupted);
                break;
            }
            let shortened = run.study_for_analysis();
            let planner = Planner::new(language, &shortened, name).with_machine_demand();
            let stopped = match run.plan(&planner) {
                Ok(work) => {
                    plans.push((name.to_owned(), work));
                    // Analyses of one grid demand the same: the first says it.
                    if let Some(mut warnings) = planner.warnings() {
                        let known = demand.iter().flat_map(|findings| &findings.list);
                        warnings
                            .list
                            .retain(|warning| known.clone().all(|other| other.message != warning.message));
                        demand.push(warnings);
                    }
                    continue;
                }
                Err(stopped) => stopped,
            };
            let Some(stopped) = reported.unreported(stopped) else {
                continue;
            };
            let text = stopped.to_string();
            if refused.iter().all(|other| other.to_string() != text) {
                refused.push(stopped);
            }
        }
        let Cautions { mut warnings, notes } = study.cautions(language);
        warnings.extend(demand);
        Self {
            refused,
            plans,
            warnings,
            notes,
        }
    }
}

/// What other values of varied quantities build again in the samples of each analysis of a study that is fine.
pub fn built_again(language: &Language, files: &SharedSource, file: &Path) -> Vec<(String, Vec<BuiltAgain>)> {
    let Ok(study) = Study::read_from(language, files, file) else {
        return Vec::new();
    };
    let run = StudyRun::new(language, &study);
    let of_analysis = |name: &str| {
        let study = run.study_for_analysis();
        let samples = run.samples(&Planner::new(language, &study, name));
        Some((name.to_owned(), samples.ok()?))
    };
    study.entry.analyses.ids().filter_map(of_analysis).collect()
}

/// Findings that were reported before the analyses began: path and message.
#[derive(Debug, Default)]
pub struct Reported(Vec<(String, String)>);

impl Reported {
    /// Findings that are reported now.
    pub fn add(&mut self, findings: &Findings) {
        let list = findings.list.iter();
        self.0
            .extend(list.map(|finding| (finding.path.clone(), finding.message.clone())));
    }

    /// The findings that were not reported yet; `None` if all were.
    pub fn new_findings(&self, mut findings: Findings) -> Option<Findings> {
        findings.list.retain(|finding| {
            let known = |(path, message): &(String, String)| finding.path == *path && finding.message == *message;
            !self.0.iter().any(known)
        });
        (!findings.list.is_empty()).then_some(findings)
    }

    /// The part of the reason of an analysis that was not reported yet.
    fn unreported(&self, stopped: Stopped) -> Option<Stopped> {
        match stopped {
            Stopped::Found(findings) => self.new_findings(findings).map(Stopped::Found),
            other => Some(other),
        }
    }
}
