//! Context of an analysis: the study, the solution of points, and progress.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use gearloss_framework::document::{Code, Diagnostic};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{OWN_MODELS, Resolved};
use gearloss_framework::transmission::{Case, Transmission};
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::head::{Head, InputFile};
use super::limits::at_points::Watch;
use super::limits::reached::Reached;
use super::limits::{Limit, Scope};
use super::progress::{Progress, Running};
use crate::codes;
use crate::points::{Field, Given, GridResult, Make, Numbered, Piece, Points, solve_pieces, take_points};
use crate::study::{Grid, Study};
use crate::table::RowSink;
use crate::tasks::{StorageError, Task, TaskResults};

/// Why an analysis has no outcome.
#[derive(Debug, thiserror::Error)]
pub enum Stopped {
    /// Errors of its input.
    #[error("{0}")]
    Found(#[from] Findings),
    /// Independent errors of several inputs.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<String>())]
    Several(Vec<Findings>),
    /// Interrupted by the caller.
    #[error("interrupted")]
    Interrupted,
    /// It was only checked, and has no errors.
    #[error("nothing was computed")]
    Checked,
    /// It needs results of tasks of other runs.
    #[error("it needs results that other runs compute")]
    Elsewhere,
    /// Results cannot be written or read.
    #[error("{0}")]
    Unwritten(#[from] StorageError),
}

impl Stopped {
    /// What was found: none where the input is right.
    pub fn findings(&self) -> &[Findings] {
        match self {
            Self::Found(findings) => std::slice::from_ref(findings),
            Self::Several(list) => list,
            Self::Interrupted | Self::Checked | Self::Elsewhere | Self::Unwritten(_) => &[],
        }
    }
}

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
}

/// The context of an analysis.
pub struct Context<'a> {
    /// The language of all documents.
    pub language: &'a Language,
    /// The study.
    pub study: &'a Study,
    /// Name of the analysis in the study.
    pub name: &'a str,
    /// True if the analysis must end before it computes and report its errors.
    pub only_checks: bool,
    /// Receives the rows of tables that are too large for memory.
    pub sink: Option<&'a dyn RowSink>,
    progress: &'a dyn Progress,
    /// Stored results of tasks.
    tasks: Option<&'a dyn TaskResults>,
    /// Number of the part of the analysis that is computed.
    part: AtomicUsize,
    /// Number of the stage that is next in it.
    stage: AtomicUsize,
    /// Whether a part was omitted because it needs results that other runs compute.
    incomplete: AtomicBool,
    /// Why the current part ends early, where a function that cannot say so was in between.
    ended: Mutex<Option<Stopped>>,
    has_ended: AtomicBool,
    /// What the limits of the study reached so far, by model set.
    reached: Mutex<Vec<(String, Vec<(Limit, Reached)>)>>,
    /// Its own lock, because files are also read in parallel.
    record: Mutex<Record>,
}

impl<'a> Context<'a> {
    /// For an analysis of a study.
    pub fn new(language: &'a Language, study: &'a Study, name: &'a str, progress: &'a dyn Progress) -> Self {
        Self {
            language,
            study,
            name,
            only_checks: false,
            sink: None,
            progress,
            tasks: None,
            part: AtomicUsize::new(0),
            stage: AtomicUsize::new(0),
            incomplete: AtomicBool::new(false),
            ended: Mutex::default(),
            has_ended: AtomicBool::new(false),
            reached: Mutex::default(),
            record: Mutex::default(),
        }
    }

    /// With stored results of tasks.
    pub fn with_tasks(self, tasks: Option<&'a dyn TaskResults>) -> Self {
        Self { tasks, ..self }
    }

    /// With a receiver of the rows of large tables.
    pub fn with_sink(self, sink: &'a dyn RowSink) -> Self {
        Self {
            sink: Some(sink),
            ..self
        }
    }

    /// For checks only.
    pub fn checking(self) -> Self {
        Self {
            only_checks: true,
            ..self
        }
    }

    /// Path of the analysis in the study.
    pub fn path(&self) -> String {
        format!("analyses.{}", self.name)
    }

    /// Ends an analysis that is only checked.
    ///
    /// # Errors
    /// [`Stopped::Checked`] in this case.
    pub fn begin(&self) -> Result<(), Stopped> {
        if self.only_checks {
            Err(Stopped::Checked)
        } else {
            Ok(())
        }
    }

    /// The head of its outcome: provenance.
    pub fn head(&self, built: &[&Built<'_>]) -> Head {
        let record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        let mut head = Head::new(self, built, &record.inputs, &record.about);
        let mut reached = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        // In the order of the sets, whichever was first.
        reached.sort_by_key(|(set, _)| built.iter().position(|b| b.name == *set));
        for (set, limits) in std::mem::take(&mut *reached) {
            head.study_limits
                .extend(limits.into_iter().map(|(limit, reached)| reached.record(&limit, &set)));
        }
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

    /// Adds what limits of the study reach with a model set.
    pub fn note_limits(&self, set: &str, limits: &[Limit], reached: Vec<Reached>) {
        let mut all = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        let place = all.iter().position(|(known, _)| known == set).unwrap_or_else(|| {
            let none = limits.iter().map(|limit| (limit.clone(), Reached::default()));
            all.push((set.to_owned(), none.collect()));
            all.len() - 1
        });
        let own = &mut all[place].1;
        for ((limit, known), more) in own.iter_mut().zip(reached) {
            known.merge(limit, more);
        }
    }

    /// Notes what the limits of the study reach at points that an analysis solves in its own way, each with its oil temperature.
    ///
    /// # Errors
    /// As [`Context::solve_here`].
    pub fn note_points(&self, built: &Built<'_>, points: &Points, list: Vec<Given>) -> Result<(), Stopped> {
        if !self.study.entry.limits.is_empty() {
            let field = Field::List(list);
            self.solve_here(
                built,
                &Points {
                    field,
                    ..points.clone()
                },
            )?;
        }
        Ok(())
    }

    /// Adds the limited quantities to solved points, and notes what the limits reach.
    pub fn mark(&self, built: &Built<'_>, watch: &Watch, points: &Points, solved: &mut Numbered<'_>) {
        // Points that do not fit were rejected before they were solved.
        if let Ok(reached) = watch.mark(&built.transmission, points, solved) {
            self.note_limits(&built.name, watch.limits(), reached);
        }
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
    pub fn built<'s>(&'s self, gearbox: &'s Gearbox, sets: &'s [String]) -> Result<Vec<Built<'s>>, Stopped> {
        self.built_with(gearbox, sets, &[])
    }

    /// As [`Context::built`], with further overrides, each with its place in the study.
    ///
    /// # Errors
    /// As [`Context::built`].
    pub fn built_with<'s>(
        &'s self,
        gearbox: &'s Gearbox,
        sets: &'s [String],
        changes: &[(String, Value, String)],
    ) -> Result<Vec<Built<'s>>, Stopped> {
        let build = |name: Option<&'s str>| -> Result<Built<'s>, Stopped> {
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

    /// Rejects invalid points for a gearbox; true if the analysis must end there.
    ///
    /// # Errors
    /// As [`Context::case`].
    pub fn checked(&self, built: &Built<'_>, points: &Points) -> Result<bool, Stopped> {
        self.case(built.gearbox, &built.transmission, points)?;
        self.watch(built)?;
        Ok(self.only_checks)
    }

    /// The case of points under the conditions.
    ///
    /// # Errors
    /// If the gear, the ports or their number are invalid.
    pub fn case(&self, gearbox: &Gearbox, t: &Transmission, points: &Points) -> Result<Case, Stopped> {
        Ok(self.study.case(&self.path(), gearbox, t, points)?)
    }

    /// Reports the start of work.
    pub fn running(&self, count: usize, label: &str) -> Running<'_> {
        Running::new(self.progress, label, count)
    }

    /// False if the caller aborts, or if the analysis has ended.
    pub fn should_continue(&self) -> bool {
        self.progress.should_continue() && !self.has_ended.load(Ordering::Relaxed)
    }

    /// Ends the analysis from within a function that has its own error type: [`Context::should_continue`] becomes false, and
    /// [`Context::why_ended`] returns the reason.
    pub fn end(&self, why: Stopped) {
        *self.ended.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
        self.has_ended.store(true, Ordering::Relaxed);
    }

    /// Why [`Context::should_continue`] is false.
    pub fn why_ended(&self) -> Stopped {
        let why = self.ended.lock().unwrap_or_else(PoisonError::into_inner).take();
        self.has_ended.store(false, Ordering::Relaxed);
        why.unwrap_or(Stopped::Interrupted)
    }

    /// Solves all points in this run, and holds them: for few points on which later stages depend.
    ///
    /// # Errors
    /// Points that do not fit or are too many, and an interruption.
    pub fn solve_here(&self, built: &Built<'_>, points: &Points) -> Result<GridResult, Stopped> {
        self.holds("analyses", points.field.len(), 1)?;
        self.checked(built, points)?;
        let mut all = GridResult::default();
        let numbers: Vec<usize> = (0..points.field.pieces()).collect();
        let watch = self.watch(built)?;
        let make = self.marking(built, points, watch.as_ref(), &take_points);
        self.evaluate(built, points, &numbers, &make, &mut |piece| {
            all.add(piece);
            Ok(())
        })?;
        Ok(all)
    }

    /// Solves all points, as [`Context::solve_pieces`] does, and holds them.
    ///
    /// # Errors
    /// Invalid points, too many points, or an interruption.
    pub fn solve(&self, built: &Built<'_>, points: &Points) -> Result<GridResult, Stopped> {
        self.holds("analyses", points.field.len(), 1)?;
        let mut all = GridResult::default();
        self.solve_pieces(built, points, &take_points, &mut |piece| {
            all.add(piece);
            Ok(())
        })?;
        Ok(all)
    }

    /// Solves all points in a stage with one task for each piece, and passes the results of `make` to `take`, piece by piece.
    ///
    /// # Errors
    /// Invalid points, an interruption, and errors of `take`.
    pub fn solve_pieces<T: Send>(
        &self,
        built: &Built<'_>,
        points: &Points,
        make: &Make<'_, T>,
        take: &mut dyn FnMut(Piece<T>) -> Result<(), Stopped>,
    ) -> Result<(), Stopped> {
        self.checked(built, points)?;
        let watch = self.watch(built)?;
        let make = &self.marking(built, points, watch.as_ref(), make);
        let all: Vec<usize> = (0..points.field.pieces()).collect();
        let stage = self.next_stage();
        let Some(kept) = self.tasks.filter(|kept| !self.is_alone(*kept, stage, all.len())) else {
            return self.evaluate(built, points, &all, make, take);
        };
        let missing = self.missing(kept, stage, all.len())?;
        self.evaluate(built, points, &missing.own, &take_points, &mut |piece| {
            let bytes = postcard::to_stdvec(&piece).map_err(StorageError::Encode)?;
            kept.keep(self.task(stage, piece.number), &bytes)
        })?;
        missing.end()?;
        for number in all {
            let task = self.task(stage, number);
            let own = points.field.of_piece(number);
            let piece = postcard::from_bytes::<Piece>(&kept.read(task)?).ok();
            let piece = piece.filter(|piece| piece.is_sound(number, own.len()));
            let piece = piece.ok_or_else(|| unlike(task))?;
            take(piece.made(own.start, make))?;
        }
        Ok(())
    }

    /// A function that marks points before it passes them on.
    fn marking<'m, T>(
        &'m self,
        built: &'m Built<'_>,
        points: &'m Points,
        watch: Option<&'m Watch>,
        make: &'m Make<'_, T>,
    ) -> impl Fn(&mut Numbered<'_>) -> T + Sync + 'm {
        move |solved| {
            if let Some(watch) = watch {
                self.mark(built, watch, points, solved);
            }
            make(solved)
        }
    }

    /// Computes a stage of so many tasks on all threads, and gives their results in their order. Results are stored to the bit. A
    /// result that was computed while [`Context::should_continue`] turned false is dropped.
    ///
    /// # Errors
    /// An interruption, and results that other runs compute.
    pub fn each<R: Serialize + DeserializeOwned + Send>(
        &self,
        label: &str,
        count: usize,
        compute: impl Fn(usize) -> R + Sync,
    ) -> Result<Vec<R>, Stopped> {
        let stage = self.next_stage();
        let missing = match self.tasks {
            Some(kept) => self.missing(kept, stage, count)?,
            None => Missing {
                own: (0..count).collect(),
                others: 0,
            },
        };
        let running = self.running(missing.own.len(), label);
        let compute = |number: usize| {
            if !self.should_continue() {
                return Err(Stopped::Interrupted);
            }
            let result = compute(number);
            if !running.advance(1) {
                return Err(Stopped::Interrupted);
            }
            if let Some(kept) = self.tasks.filter(|kept| !kept.completes()) {
                let bytes = postcard::to_stdvec(&result).map_err(StorageError::Encode)?;
                kept.keep(self.task(stage, number), &bytes)?;
            }
            Ok(result)
        };
        let own: Vec<Result<R, Stopped>> = missing.own.par_iter().with_max_len(1).map(|i| compute(*i)).collect();
        let own: Vec<R> = own.into_iter().collect::<Result<_, _>>()?;
        let Some(kept) = self.tasks else { return Ok(own) };
        missing.end()?;
        let mut own = missing.own.iter().zip(own).peekable();
        let result = |number: usize| {
            if let Some((_, result)) = own.next_if(|(own, _)| **own == number) {
                return Ok(result);
            }
            let task = self.task(stage, number);
            postcard::from_bytes(&kept.read(task)?).map_err(|_| unlike(task))
        };
        (0..count).map(result).collect()
    }

    /// Computes a part of the analysis that does not depend on its other parts, such as one model set. Nothing where it needs results
    /// that other runs compute: they are missing when [`Context::complete`] is called. Parts do not contain parts.
    ///
    /// # Errors
    /// Those of the part.
    pub fn part<T>(&self, number: usize, compute: impl FnOnce() -> Result<T, Stopped>) -> Result<Option<T>, Stopped> {
        let stage = self.stage.swap(0, Ordering::Relaxed);
        self.part.store(number + 1, Ordering::Relaxed);
        let result = compute();
        self.part.store(0, Ordering::Relaxed);
        self.stage.store(stage, Ordering::Relaxed);
        match result {
            Ok(result) => Ok(Some(result)),
            Err(Stopped::Elsewhere) => {
                self.incomplete.store(true, Ordering::Relaxed);
                Ok(None)
            }
            Err(stopped) => Err(stopped),
        }
    }

    /// Comes after all parts.
    ///
    /// # Errors
    /// [`Stopped::Elsewhere`] where one of them is missing.
    pub fn complete(&self) -> Result<(), Stopped> {
        if self.incomplete.load(Ordering::Relaxed) {
            Err(Stopped::Elsewhere)
        } else {
            Ok(())
        }
    }

    /// Comes before work that is not split into tasks: it is left to the run that completes what others have begun.
    ///
    /// # Errors
    /// [`Stopped::Elsewhere`] in other runs.
    pub fn undivided(&self) -> Result<(), Stopped> {
        match self.tasks {
            Some(kept) if !kept.completes() => Err(Stopped::Elsewhere),
            _ => Ok(()),
        }
    }

    fn next_stage(&self) -> usize {
        self.stage.fetch_add(1, Ordering::Relaxed)
    }

    fn task(&self, stage: usize, number: usize) -> Task<'_> {
        Task {
            analysis: self.name,
            part: self.part.load(Ordering::Relaxed),
            stage,
            number,
        }
    }

    /// Whether this run computes the incomplete remainder of a stage that others have started.
    fn is_alone(&self, kept: &dyn TaskResults, stage: usize, count: usize) -> bool {
        kept.completes() && !(0..count).all(|number| kept.is_kept(self.task(stage, number)))
    }

    /// The tasks of a stage without results.
    fn missing(&self, kept: &dyn TaskResults, stage: usize, count: usize) -> Result<Missing, Stopped> {
        let missing = (0..count).filter(|number| !kept.is_kept(self.task(stage, *number)));
        let (own, others): (Vec<usize>, Vec<usize>) =
            missing.partition(|number| kept.is_own(self.task(stage, *number)));
        if self.should_continue() {
            Ok(Missing {
                own,
                others: others.len(),
            })
        } else {
            Err(Stopped::Interrupted)
        }
    }

    /// Solves pieces of given numbers.
    fn evaluate<T: Send>(
        &self,
        built: &Built<'_>,
        points: &Points,
        numbers: &[usize],
        make: &Make<'_, T>,
        take: &mut dyn FnMut(Piece<T>) -> Result<(), Stopped>,
    ) -> Result<(), Stopped> {
        if numbers.is_empty() {
            return Ok(());
        }
        let count = points.field.len();
        let own = count * numbers.len() / points.field.pieces().max(1);
        let running = self.running(own, &built.name);
        let going = |n: usize| running.advance(n);
        let mut fault = None;
        let whole = solve_pieces(&built.transmission, points, numbers, make, &going, &mut |piece| {
            fault = take(piece).err();
            fault.is_none()
        });
        let whole = whole.map_err(|list| Stopped::from(built.gearbox.findings(list)))?;
        match fault {
            Some(fault) => Err(fault),
            None if whole => Ok(()),
            None => Err(Stopped::Interrupted),
        }
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

    /// As [`Context::wrong`], with the code of its kind.
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

/// Tasks of a stage without results.
struct Missing {
    /// Those of this run.
    own: Vec<usize>,
    /// Number of tasks of others.
    others: usize,
}

impl Missing {
    /// Ends the analysis if others have not completed their part of the stage.
    fn end(&self) -> Result<(), Stopped> {
        if self.others == 0 {
            Ok(())
        } else {
            Err(Stopped::Elsewhere)
        }
    }
}

/// A stored result does not belong to its task.
fn unlike(task: Task<'_>) -> Stopped {
    let Task {
        analysis,
        part,
        stage,
        number,
    } = task;
    let analysis = analysis.to_owned();
    Stopped::Unwritten(StorageError::OtherTask {
        analysis,
        part,
        stage,
        number,
    })
}

/// The gear of an entry, or the first.
pub fn gear_of<'t>(named: Option<&'t str>, transmission: &'t Transmission) -> &'t str {
    let first = transmission.states().first().map_or("", |s| s.name.as_str());
    named.unwrap_or(first)
}
