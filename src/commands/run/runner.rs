//! What the analyses of one run share: the study, the way to solve its points, and where its results go.

use std::cell::{Cell, RefCell};
use std::path::PathBuf;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::loss::Extent;
use gearloss_framework::resolve::{OWN_MODELS, Resolved};
use gearloss_framework::transmission::{Case, Transmission};
use gearloss_studies::analyses::AnalysisEntry;
use gearloss_studies::analysis::{Field, Given, GridResult, Make, Piece, Points, held, merge, notes, solve_pieces};
use gearloss_studies::study::{
    BalanceEntry, BreakdownEntry, CompareEntry, ComponentCompareEntry, ContactPathEntry, CycleAnalysisEntry,
    FluidSweepEntry, Grid, IdentifyEntry, MapEntry, OperatingPointsEntry, RmsSurfaceEntry, SensitivityEntry,
    SpinLossEntry, Study, SweepEntry, TemperatureSweepEntry, ThermalLimitEntry, TournamentEntry, UncertaintyEntry,
};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;

use super::stated_ranges::StatedRanges;
use super::{
    Parts, balance, breakdown, compare, component_compare, contact_path, cycle, fluid_sweep, identify, map,
    operating_points, rms_surface, sensitivity, sweep, thermal_limit, tournament, uncertainty, write,
};
use crate::interrupt;
use crate::output::{Failure, Out};
use crate::report::Report;

/// One gearbox under one set of models.
pub struct Built<'a> {
    pub name: String,
    pub gearbox: &'a Gearbox,
    pub resolved: Resolved,
    pub transmission: Transmission,
}

impl Built<'_> {
    /// The set as a choice names it: without the product, absent for the gearbox's own models.
    pub fn set(&self) -> Option<&str> {
        let set = self.name.rsplit('/').next();
        set.filter(|set| *set != OWN_MODELS)
    }
}

/// The most points that an analysis may hold at a time, some of them as samples; with all that is made of each they take a few
/// gigabytes. Maps over grids hold none.
const MOST_HELD: usize = 2_000_000;

/// What all analyses of one run share.
pub struct Runner<'a> {
    pub(super) language: &'a Language,
    pub(super) study: &'a Study,
    pub(super) folder: PathBuf,
    pub(super) progress: bool,
    pub(super) report: RefCell<Report>,
    /// Files that were written.
    pub(super) names: write::Names,
    /// Limits that were left at any point, counted over all analyses.
    pub(super) left: Cell<usize>,
    /// Name of the analysis at hand.
    pub(super) analysis: RefCell<String>,
    /// The same limits, for the end of the run.
    pub(super) stated_ranges: RefCell<StatedRanges>,
    /// Files of points that the analysis at hand has read, with their hashes.
    pub(super) read: RefCell<Vec<(String, String)>>,
    /// Files that the gearboxes had read before any analysis.
    pub(super) known: Vec<Vec<PathBuf>>,
    /// What shards have computed, where they are merged.
    pub(super) parts: Option<Parts>,
    /// True for `check`: an analysis ends where it would begin to compute, with all that it refuses before.
    pub(super) only_checks: bool,
}

impl<'a> Runner<'a> {
    pub(super) fn new(language: &'a Language, study: &'a Study, folder: PathBuf, parts: Option<Parts>) -> Self {
        let known = |(_, gearbox): &(String, Gearbox)| gearbox.files.all().into_iter().map(|(file, _)| file).collect();
        Self {
            language,
            study,
            folder,
            progress: Out::error().is_terminal(),
            report: RefCell::default(),
            names: write::Names::default(),
            left: Cell::new(0),
            analysis: RefCell::default(),
            stated_ranges: RefCell::default(),
            read: RefCell::default(),
            known: study.gearboxes.iter().map(known).collect(),
            parts,
            only_checks: false,
        }
    }

    /// For `check`, which computes and writes nothing.
    pub(super) fn for_check(language: &'a Language, study: &'a Study) -> Self {
        Self {
            progress: false,
            only_checks: true,
            ..Self::new(language, study, PathBuf::new(), None)
        }
    }
}

impl Runner<'_> {
    /// Runs an analysis, with its section in the report. What another one has read is forgotten: the inputs that its results
    /// name are its own, whatever ran before.
    pub(super) fn attempt(&self, name: &str, analysis: &AnalysisEntry, out: &mut Out) -> Result<(), Failure> {
        self.report.borrow_mut().begin(name, analysis.kind().meaning);
        name.clone_into(&mut self.analysis.borrow_mut());
        self.read.borrow_mut().clear();
        for ((_, gearbox), known) in self.study.gearboxes.iter().zip(&self.known) {
            gearbox.files.forget_all_but(known);
        }
        if let Some((set, by)) = self.study.pending(analysis).filter(|_| !self.only_checks) {
            let message = format!("the set `{set}` has no values: the analysis `{by}` found none");
            let mend = format!("correct `{by}`, or choose another set");
            return Err(self.wrong(&format!("analyses.{name}"), message, &mend));
        }
        out.begin_copy();
        let done = self.legacy(name, analysis, out);
        let printed = out.end_copy();
        self.report.borrow_mut().text(&printed);
        done
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
            BalanceEntry => balance::run,
            SweepEntry => sweep::run,
            TournamentEntry => tournament::run,
            UncertaintyEntry => uncertainty::run,
            IdentifyEntry => identify::run,
            SensitivityEntry => sensitivity::run,
            RmsSurfaceEntry => rms_surface::run,
            CycleAnalysisEntry => cycle::run,
            FluidSweepEntry => fluid_sweep::run,
            SpinLossEntry => breakdown::spin_loss,
            TemperatureSweepEntry => breakdown::temperature_sweep,
        }
        Ok(())
    }

    /// The gearbox under each set; under its own models where no set is named.
    pub(super) fn built<'s>(&'s self, gearbox: &'s Gearbox, sets: &'s [String]) -> Result<Vec<Built<'s>>, Failure> {
        self.built_with(gearbox, sets, &[])
    }

    /// As [`Runner::built`], with further overrides, each with its place in the study.
    pub(super) fn built_with<'s>(
        &'s self,
        gearbox: &'s Gearbox,
        sets: &'s [String],
        changes: &[(String, Value, String)],
    ) -> Result<Vec<Built<'s>>, Failure> {
        let build = |name: Option<&'s str>| -> Result<Built<'s>, Failure> {
            let (gearbox, set) = match name {
                Some(name) => self.study.reference("analyses", name, gearbox)?,
                None => (gearbox, None),
            };
            let mut choice = self.study.choice(set);
            let overrides = changes.iter().map(|(path, value, _)| (path.clone(), value.clone()));
            choice.overrides.extend(overrides);
            let places: Vec<_> = changes
                .iter()
                .map(|(path, _, place)| (path.clone(), place.clone()))
                .collect();
            let (resolved, transmission) = self.study.built(self.language, gearbox, &choice, &places)?;
            Ok(Built {
                name: name.unwrap_or(OWN_MODELS).to_owned(),
                gearbox,
                resolved,
                transmission,
            })
        };
        if sets.is_empty() {
            Ok(vec![build(None)?])
        } else {
            sets.iter().map(|set| build(Some(set))).collect()
        }
    }

    /// The points of axes under the study's conditions.
    pub(super) fn points(
        &self,
        transmission: &Transmission,
        gear: &str,
        torques: Vec<f64>,
        speeds: Vec<f64>,
    ) -> Points {
        self.field(transmission, gear, Field::Grid { torques, speeds })
    }

    /// The points of a list under the study's conditions.
    pub(super) fn listed(&self, transmission: &Transmission, gear: &str, list: Vec<Given>) -> Points {
        self.field(transmission, gear, Field::List(list))
    }

    pub(super) fn field(&self, transmission: &Transmission, gear: &str, field: Field) -> Points {
        self.study.points(transmission, gear, field)
    }

    /// Refuses points that do not fit a gearbox; true where an analysis shall end there.
    pub(super) fn checked(&self, built: &Built<'_>, points: &Points) -> Result<bool, Failure> {
        self.case(built.gearbox, &built.transmission, points)?;
        Ok(self.only_checks)
    }

    /// The case of points under the conditions.
    pub(super) fn case(&self, gearbox: &Gearbox, t: &Transmission, points: &Points) -> Result<Case, Failure> {
        let place = format!("analyses.{}", self.analysis.borrow());
        Ok(self.study.case(&place, gearbox, t, points)?)
    }

    /// A bar of progress on standard error, on a terminal only.
    pub(super) fn bar(&self, count: u64, name: &str) -> ProgressBar {
        let bar = if self.progress {
            ProgressBar::new(count)
        } else {
            ProgressBar::hidden()
        };
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:30} {pos}/{len}") {
            bar.set_style(style);
        }
        bar.set_message(name.to_owned());
        bar
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
        let solved = self.parts.as_ref().zip(of).and_then(|(parts, of)| parts.pieces(of));
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
        self.checked(built, points)?;
        let count = points.field.len();
        let own = count * numbers.len() / points.field.pieces().max(1);
        let bar = self.bar(own as u64, &built.name);
        let going = |n: usize| {
            bar.inc(n as u64);
            !interrupt::pressed()
        };
        let mut fault = None;
        let whole = solve_pieces(&built.transmission, points, numbers, make, &going, &mut |piece| {
            fault = take(piece).err();
            fault.is_none()
        });
        bar.finish_and_clear();
        let whole = whole.map_err(|list| Failure::from(built.gearbox.findings(list)))?;
        match fault {
            Some(fault) => Err(fault),
            None if whole => Ok(()),
            None => Err(Failure::Interrupted),
        }
    }

    /// Prints a sentence that a reader must not miss, and puts it where the report begins to tell of the analysis.
    pub(super) fn verdict(&self, sentence: String, out: &mut Out) -> Result<(), Failure> {
        out.line(&sentence)?;
        self.report.borrow_mut().verdict(&sentence);
        Ok(())
    }

    /// The one gear state of a grid.
    pub(super) fn one_gear(&self, path: &str, grid: &Grid, t: &Transmission) -> Result<String, Failure> {
        match &grid.gear.of(t)[..] {
            [gear] => Ok(gear.clone()),
            several => Err(self.wrong(
                path,
                format!("this analysis takes a grid of one gear state, not of {}", several.len()),
                "give it a grid of its own",
            )),
        }
    }

    /// A fault of the study at a path.
    pub(super) fn wrong(&self, path: &str, message: impl Into<String>, mend: &str) -> Failure {
        self.study
            .findings(vec![Diagnostic::error(path, message.into()).mend(mend)])
            .into()
    }

    /// Refuses what would hold too many points: so many times so many.
    pub(super) fn holds(&self, path: &str, points: usize, times: usize) -> Result<(), Failure> {
        if points.saturating_mul(times) <= MOST_HELD {
            return Ok(());
        }
        let of = if times > 1 {
            format!(", {times} times {points},")
        } else {
            format!(", {points},")
        };
        let message = format!("more points{of} than the {MOST_HELD} that an analysis can hold");
        Err(self.wrong(
            path,
            message,
            "take fewer samples, values or points; a `map` over a grid takes more, piece by piece",
        ))
    }

    /// Counts the limits that were left.
    pub(super) fn seen(&self, transmission: &Transmission, seen: &[Extent]) {
        let left = notes(transmission, seen).iter().filter(|n| n.outside > 0).count();
        self.left.set(self.left.get() + left);
    }
}
