//! The content of a report, collected while the analyses of a study run.

use gearloss_framework::description::Ordered;
use gearloss_studies::analyses::{AnalysisEntry, Outcome, Planner, Stopped};

use super::{Report, Section, gearbox_page};
use crate::page::{Block, Page};
use crate::stated_ranges::StatedRanges;
use crate::text::capitalised;

impl Report {
    /// Begins the section of one of the analyses of a study.
    pub fn begin(&mut self, analyses: &Ordered<AnalysisEntry>, name: &str, analysis: &AnalysisEntry) {
        let alike = |other: &&AnalysisEntry| other.kind().name == analysis.kind().name;
        let is_one_of_several = analyses.iter().filter(|(_, other)| alike(other)).count() > 1;
        self.sections.push(Section {
            name: name.to_owned(),
            title: analysis.title.clone().unwrap_or_else(|| title(name)),
            which: analysis.title.clone().filter(|_| is_one_of_several),
            about: analysis.kind().meaning(),
            note: analysis.note.clone(),
            ..Section::default()
        });
    }

    /// The page of an outcome, for the section that was begun last ([`Section::add`]). The outcome also counts for what the report says
    /// about all analyses.
    pub fn page(&mut self, name: &str, outcome: &dyn Outcome) -> Page {
        self.ranges.add_outcome(name, outcome);
        self.tested.add_outcome(name, outcome);
        Page::from_outcome(outcome)
    }

    /// States in the section that was begun last that its analysis failed, and why.
    pub fn fail(&mut self, why: String) {
        if let Some(section) = self.sections.last_mut() {
            section.failed = why.lines().next().map(str::to_owned);
            section.blocks.push(Block::Text(why));
        }
    }

    /// Quantities outside their stated ranges over all analyses so far.
    pub fn stated_ranges(&self) -> &StatedRanges {
        &self.ranges
    }

    /// Adds what follows the last analysis: gearboxes, and what depends on all outcomes.
    ///
    /// # Errors
    /// Everything that resolving and building the gearboxes find.
    pub fn complete(&mut self, cx: &Planner<'_>) -> Result<(), Stopped> {
        for (name, gearbox) in &cx.study.gearboxes {
            self.gearboxes.push(gearbox_page(cx, name, gearbox)?);
        }
        self.answers.clone_from(&cx.study.entry.answered_by);
        (self.outside, self.worst) = (self.ranges.table(), self.ranges.worst());
        for section in &mut self.sections {
            section.marks = self.ranges.rows_of(&section.name);
        }
        for (name, warning) in self.tested.warnings() {
            for section in self.sections.iter_mut().filter(|section| section.name == name) {
                section.careful.insert(0, warning.clone());
            }
        }
        Ok(())
    }
}

/// The name of an analysis as a title: `rig_fit` becomes `Rig fit`.
fn title(name: &str) -> String {
    capitalised(&name.replace('_', " "))
}
