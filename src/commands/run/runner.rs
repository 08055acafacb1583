//! What the analyses of one run share: the study, where its results go, and the report.

use std::cell::{Cell, RefCell};
use std::ops::Deref;
use std::path::PathBuf;

use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::loss::Extent;
use gearloss_framework::transmission::Transmission;
use gearloss_report::page::{Page, Text};
use gearloss_studies::analyses::progress::{Progress, Steps};
use gearloss_studies::analyses::{AnalysisEntry, AnyOutcome, Built, Context, Stopped};
use gearloss_studies::analysis::{GridResult, Make, Piece, Points, held, merge, notes};
use gearloss_studies::study::{
    BreakdownEntry, CompareEntry, ComponentCompareEntry, ContactPathEntry, CycleAnalysisEntry, FluidSweepEntry,
    MapEntry, OperatingPointsEntry, RmsSurfaceEntry, SensitivityEntry, SpinLossEntry, Study, SweepEntry,
    TemperatureSweepEntry, ThermalLimitEntry, TournamentEntry, UncertaintyEntry,
};
use indicatif::{ProgressBar, ProgressStyle};

use super::stated_ranges::StatedRanges;
use super::{
    Parts, breakdown, compare, component_compare, contact_path, cycle, fluid_sweep, map, operating_points, rms_surface,
    sensitivity, sweep, thermal_limit, tournament, uncertainty, write,
};
use crate::interrupt;
use crate::output::{Failure, Out};
use crate::report::Report;

/// What all analyses of one run share.
pub struct Run<'a> {
    pub(super) language: &'a Language,
    pub(super) study: &'a Study,
    pub(super) folder: PathBuf,
    bars: Bars,
    pub(super) report: RefCell<Report>,
    /// Files that were written.
    pub(super) names: write::Names,
    /// Limits that were left at any point, counted over all analyses.
    pub(super) left: Cell<usize>,
    /// The same limits, for the end of the run.
    pub(super) stated_ranges: RefCell<StatedRanges>,
    /// Files that the gearboxes had read before any analysis.
    known: Vec<Vec<PathBuf>>,
    /// What shards have computed, where they are merged.
    pub(super) parts: Option<Parts>,
    /// True for `check`: an analysis ends where it would begin to compute, with all that it refuses before.
    only_checks: bool,
}

/// One analysis of a run.
pub struct Runner<'a> {
    cx: Context<'a>,
    pub(super) run: &'a Run<'a>,
}

impl<'a> Deref for Runner<'a> {
    type Target = Context<'a>;

    fn deref(&self) -> &Context<'a> {
        &self.cx
    }
}

/// Bars on standard error, on a terminal only.
struct Bars {
    shown: bool,
}

impl Progress for Bars {
    fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_> {
        Box::new(Bar(self.bar(count as u64, label)))
    }

    fn goes_on(&self) -> bool {
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
    pub(super) fn new(language: &'a Language, study: &'a Study, folder: PathBuf, parts: Option<Parts>) -> Self {
        let known = |(_, gearbox): &(String, Gearbox)| gearbox.files.all().into_iter().map(|(file, _)| file).collect();
        Self {
            language,
            study,
            folder,
            bars: Bars {
                shown: Out::error().is_terminal(),
            },
            report: RefCell::default(),
            names: write::Names::default(),
            left: Cell::new(0),
            stated_ranges: RefCell::default(),
            known: study.gearboxes.iter().map(known).collect(),
            parts,
            only_checks: false,
        }
    }

    /// For `check`, which computes and writes nothing.
    pub(super) fn for_check(language: &'a Language, study: &'a Study) -> Self {
        Self {
            bars: Bars { shown: false },
            only_checks: true,
            ..Self::new(language, study, PathBuf::new(), None)
        }
    }

    /// An analysis by its name.
    pub(super) fn runner<'r>(&'r self, name: &'r str) -> Runner<'r> {
        let cx = Context::new(self.language, self.study, name, &self.bars);
        let cx = if self.only_checks { cx.checking() } else { cx };
        Runner { cx, run: self }
    }

    /// All analyses in their order.
    pub(super) fn all(&self) -> Vec<Runner<'_>> {
        self.study.entry.analyses.ids().map(|name| self.runner(name)).collect()
    }

    /// Runs an analysis, with its section in the report. What another one has read is forgotten: the inputs that its results
    /// name are its own, whatever ran before.
    pub(super) fn attempt(&self, name: &str, analysis: &AnalysisEntry, out: &mut Out) -> Result<(), Failure> {
        self.report.borrow_mut().begin(name, analysis.kind().meaning);
        for ((_, gearbox), known) in self.study.gearboxes.iter().zip(&self.known) {
            gearbox.files.forget_all_but(known);
        }
        let runner = self.runner(name);
        if let Some((set, by)) = self.study.pending(analysis).filter(|_| !self.only_checks) {
            let message = format!("the set `{set}` has no values: the analysis `{by}` found none");
            let mend = format!("correct `{by}`, or choose another set");
            return Err(runner.wrong(&format!("analyses.{name}"), message, &mend));
        }
        out.begin_copy();
        let done = match analysis.run(&runner.cx) {
            Some(Ok(outcome)) => runner.present(analysis, outcome.as_ref(), out),
            Some(Err(Stopped::Checked)) => Ok(()),
            Some(Err(stopped)) => Err(stopped.into()),
            None => runner.legacy(name, analysis, out),
        };
        let printed = out.end_copy();
        self.report.borrow_mut().text(&printed);
        done
    }
}

impl Runner<'_> {
    /// Prints an outcome, writes its files and puts it into the report.
    fn present(&self, analysis: &AnalysisEntry, outcome: &dyn AnyOutcome, out: &mut Out) -> Result<(), Failure> {
        if let Some(then) = analysis.then() {
            self.study.keep_found(then.set, outcome.found());
        }
        let notes: Vec<_> = outcome.notes().into_iter().filter(|note| note.outside > 0).collect();
        let samples = outcome.left_at_samples();
        self.run.left.set(self.run.left.get() + notes.len() + samples.len());
        for note in &notes {
            self.keep_outside(note);
        }
        for (path, name) in samples {
            self.keep_outside_at_samples(path, name);
        }
        let page = Page::of(outcome);
        for text in &page.text {
            match text {
                Text::Everywhere(text) => out.text(text)?,
                Text::InReport(text) => out.only_copy(text),
            }
        }
        for verdict in &page.verdicts {
            self.run.report.borrow_mut().verdict(verdict);
        }
        let formats = analysis.formats();
        write::outcome(self, outcome, formats)?;
        for named in page.figures {
            write::picture(self, &named.name, named.figure, formats)?;
        }
        Ok(())
    }

    /// Runs an analysis that computes, prints and writes at once.
    fn legacy(&self, name: &str, analysis: &AnalysisEntry, out: &mut Out) -> Result<(), Failure> {
        macro_rules! one_of {
            ($($entry:ty => $run:path),* $(,)?) => {
                $(if let Some(entry) = analysis.entry::<$entry>() {
                    return $run(self, name, entry, out);
                })*
            };
        }
        one_of! {
            MapEntry => map::run,
            CompareEntry => compare::run,
            BreakdownEntry => breakdown::run,
            ComponentCompareEntry => component_compare::run,
            ContactPathEntry => contact_path::run,
            OperatingPointsEntry => operating_points::run,
            ThermalLimitEntry => thermal_limit::run,
            SweepEntry => sweep::run,
            TournamentEntry => tournament::run,
            UncertaintyEntry => uncertainty::run,
            SensitivityEntry => sensitivity::run,
            RmsSurfaceEntry => rms_surface::run,
            CycleAnalysisEntry => cycle::run,
            FluidSweepEntry => fluid_sweep::run,
            SpinLossEntry => breakdown::spin_loss,
            TemperatureSweepEntry => breakdown::temperature_sweep,
        }
        Ok(())
    }

    /// Solves all points and holds them.
    pub(super) fn solve(&self, built: &Built<'_>, points: &Points) -> Result<GridResult, Failure> {
        self.holds("analyses", points.field.len(), 1)?;
        let mut all = GridResult::default();
        self.solve_pieces(built, points, None, &held, &mut |piece| {
            all.add(piece);
            Ok(())
        })?;
        Ok(all)
    }

    /// Solves all points and hands over what `make` takes from them, piece by piece. Those `of` a map, its analysis and its
    /// number there, come from the shards where they are merged.
    pub(super) fn solve_pieces<T: Send>(
        &self,
        built: &Built<'_>,
        points: &Points,
        of: Option<(&str, usize)>,
        make: &Make<'_, T>,
        take: &mut dyn FnMut(Piece<T>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut seen = Vec::new();
        let mut counted = |piece: Piece<T>| {
            merge(&mut seen, &piece.seen);
            take(piece)
        };
        let solved = self.run.parts.as_ref().zip(of).and_then(|(parts, of)| parts.pieces(of));
        if let Some(mut solved) = solved {
            solved.try_for_each(|piece| {
                let piece = piece?;
                let own = points.field.of_piece(piece.number);
                if piece.len() != own.len() {
                    return Err(Failure::input(
                        format!(
                            "piece {} of a map has {} points, not {}",
                            piece.number,
                            piece.len(),
                            own.len()
                        ),
                        "take the folders of the shards away and run them again",
                    ));
                }
                counted(piece.made(own.start, make))
            })?;
        } else {
            let numbers: Vec<usize> = (0..points.field.pieces()).collect();
            self.evaluate(built, points, &numbers, make, &mut counted)?;
        }
        self.seen(&built.transmission, &seen);
        Ok(())
    }

    /// Solves pieces of given numbers, however they are wanted.
    pub(super) fn evaluate<T: Send>(
        &self,
        built: &Built<'_>,
        points: &Points,
        numbers: &[usize],
        make: &Make<'_, T>,
        take: &mut dyn FnMut(Piece<T>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut fault = None;
        let solved = self.cx.solve_pieces(built, points, numbers, make, &mut |piece| {
            fault = take(piece).err();
            if fault.is_some() { Err(Stopped::Checked) } else { Ok(()) }
        });
        match fault {
            Some(fault) => Err(fault),
            None => Ok(solved?),
        }
    }

    /// A bar of progress on standard error, on a terminal only.
    pub(super) fn bar(&self, count: u64, name: &str) -> ProgressBar {
        self.run.bars.bar(count, name)
    }

    /// Prints a sentence that a reader must not miss, and puts it where the report begins to tell of the analysis.
    pub(super) fn verdict(&self, sentence: String, out: &mut Out) -> Result<(), Failure> {
        out.line(&sentence)?;
        self.run.report.borrow_mut().verdict(&sentence);
        Ok(())
    }

    /// A fault of the study at a path.
    pub(super) fn wrong(&self, path: &str, message: impl Into<String>, mend: &str) -> Failure {
        self.cx.wrong(path, message, mend).into()
    }

    /// Counts the limits that were left.
    pub(super) fn seen(&self, transmission: &Transmission, seen: &[Extent]) {
        let left = notes(transmission, seen).iter().filter(|n| n.outside > 0).count();
        self.run.left.set(self.run.left.get() + left);
    }
}
