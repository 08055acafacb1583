//! The engine: the only way from a plan to results.
//!
//! It solves points and jobs on all threads, or takes those that other machines have computed; reports progress; reads the limits of the
//! study at every point; and ends when the caller interrupts.

pub mod head;
mod plan;
mod planner;
pub mod progress;
pub(crate) mod stopped;
mod within;

use std::ops::Deref;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

pub use head::Head;
pub use plan::{BuiltAgain, Plan, Run, Runs, Work};
pub use planner::{Built, Planner, gear_of};
use progress::{Progress, Running};
pub use stopped::Stopped;
pub(crate) use within::JobsWithin;

use crate::limits::limit::Limit;
use crate::limits::reached::Reached;
use crate::points::{Given, GridResult, Make, Numbered, Piece, solve_pieces, take_points};
use crate::table::RowSink;
use crate::tasks::{StorageError, Task, TaskResults};

/// Computes what an analysis has planned. It knows all that its planner knows.
pub struct Engine<'a> {
    planner: &'a Planner<'a>,
    /// Receives the rows of tables that are too large for memory.
    pub sink: Option<&'a dyn RowSink>,
    progress: &'a dyn Progress,
    /// Stored results of tasks.
    tasks: Option<&'a dyn TaskResults>,
    /// Number of the part that is computed; 0 outside all parts.
    part: AtomicUsize,
    /// Number of the stage that is next in it.
    stage: AtomicUsize,
    /// What the limits of the study reached so far, by model set.
    reached: Mutex<Vec<(String, Vec<(Limit, Reached)>)>>,
}

impl<'a> Deref for Engine<'a> {
    type Target = Planner<'a>;

    fn deref(&self) -> &Planner<'a> {
        self.planner
    }
}

impl<'a> Engine<'a> {
    /// For the analysis of a planner.
    pub fn new(planner: &'a Planner<'a>, progress: &'a dyn Progress) -> Self {
        Self {
            planner,
            sink: None,
            progress,
            tasks: None,
            part: AtomicUsize::new(0),
            stage: AtomicUsize::new(0),
            reached: Mutex::default(),
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

    /// The planner.
    pub fn planner(&self) -> &'a Planner<'a> {
        self.planner
    }

    /// The head of an outcome: provenance, and what the limits of the study reached.
    pub fn head(&self, built: &[Arc<Built<'_>>]) -> Head {
        let built: Vec<&Built<'_>> = built.iter().map(|b| &**b).collect();
        let mut head = self.provenance(&built);
        let mut reached = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        // In the order of the sets, whichever was first.
        reached.sort_by_key(|(set, _)| built.iter().position(|b| b.name == *set));
        for (set, limits) in std::mem::take(&mut *reached) {
            head.study_limits
                .extend(limits.into_iter().map(|(limit, reached)| reached.record(&limit, &set)));
        }
        head
    }

    /// Reports the start of work.
    pub fn running(&self, count: usize, label: &str) -> Running<'_> {
        Running::new(self.progress, label, count)
    }

    /// False if the caller interrupts.
    pub fn should_continue(&self) -> bool {
        self.progress.should_continue()
    }

    /// Solves the points of runs, which do not wait for each other, and holds them.
    ///
    /// # Errors
    /// Too many points, or an interruption.
    pub fn solve_all(&self, runs: &Runs<'_>) -> Result<Vec<GridResult>, Stopped> {
        self.parts(&runs.0, |run| self.solve(run))
    }

    /// Solves the points of a run in a stage with one task for each piece, and holds them.
    ///
    /// # Errors
    /// Too many points, or an interruption.
    pub fn solve(&self, run: &Run<'_>) -> Result<GridResult, Stopped> {
        self.holds("analyses", run.points.field.len(), 1)?;
        let mut all = GridResult::default();
        self.solve_pieces(run, &take_points, &mut |piece| {
            all.add(piece);
            Ok(())
        })?;
        Ok(all)
    }

    /// Solves the points of a run in this process, whoever computes the tasks: for few points on which later stages depend.
    ///
    /// # Errors
    /// Too many points, or an interruption.
    pub fn solve_here(&self, run: &Run<'_>) -> Result<GridResult, Stopped> {
        self.holds("analyses", run.points.field.len(), 1)?;
        let mut all = GridResult::default();
        let numbers: Vec<usize> = (0..run.points.field.pieces()).collect();
        self.evaluate(run, &numbers, &self.marking(run, &take_points), &mut |piece| {
            all.add(piece);
            Ok(())
        })?;
        Ok(all)
    }

    /// Reads the limits of the study at points that an analysis has found in its own way, each with its oil temperature.
    ///
    /// # Errors
    /// As [`Engine::solve_here`].
    pub fn read_limits(&self, run: &Run<'_>, list: Vec<Given>) -> Result<(), Stopped> {
        if run.watch.is_some() {
            self.solve_here(&run.with_list(list))?;
        }
        Ok(())
    }

    /// Solves the points of a run as [`Engine::solve`] does, and passes the results of `make` to `take`, piece by piece, so that few are
    /// in memory.
    ///
    /// # Errors
    /// An interruption, and errors of `take`.
    pub fn solve_pieces<T: Send>(
        &self,
        run: &Run<'_>,
        make: &Make<'_, T>,
        take: &mut dyn FnMut(Piece<T>) -> Result<(), Stopped>,
    ) -> Result<(), Stopped> {
        let make = &self.marking(run, make);
        let field = &run.points.field;
        let all: Vec<usize> = (0..field.pieces()).collect();
        let stage = self.next_stage();
        let Some(kept) = self.tasks.filter(|kept| !self.is_alone(*kept, stage, all.len())) else {
            return self.evaluate(run, &all, make, take);
        };
        let missing = self.missing(kept, stage, all.len())?;
        self.evaluate(run, &missing.ours, &take_points, &mut |piece| {
            let bytes = postcard::to_stdvec(&piece).map_err(StorageError::Encode)?;
            kept.keep(self.task(stage, piece.number), &bytes)
        })?;
        missing.end()?;
        for number in all {
            let task = self.task(stage, number);
            let numbers = field.of_piece(number);
            let piece = postcard::from_bytes::<Piece>(&kept.read(task)?).ok();
            let piece = piece.filter(|piece| piece.is_sound(number, numbers.len()));
            let piece = piece.ok_or_else(|| unlike(task))?;
            take(piece.made(numbers.start, make))?;
        }
        Ok(())
    }

    /// A function that reads the limits of the study at points before it passes them on.
    fn marking<'m, T>(
        &'m self,
        run: &'m Run<'_>,
        make: &'m Make<'_, T>,
    ) -> impl Fn(&mut Numbered<'_>) -> T + Sync + use<'m, 'a, T> {
        move |solved| {
            self.mark(run, solved);
            make(solved)
        }
    }

    /// Adds the limited quantities to solved points, and notes what the limits reach.
    pub(crate) fn mark(&self, run: &Run<'_>, solved: &mut Numbered<'_>) {
        let Some(watch) = &run.watch else { return };
        // Points that do not fit were rejected by the plan.
        if let Ok(reached) = watch.mark(&run.built.transmission, &run.points, solved) {
            self.note_limits(&run.built.name, watch.limits(), reached);
        }
    }

    /// Adds what limits of the study reach with a model set, in jobs that have limited quantities of their own.
    pub fn note_limits(&self, set: &str, limits: &[Limit], reached: Vec<Reached>) {
        let mut all = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        let place = all.iter().position(|(known, _)| known == set).unwrap_or_else(|| {
            let none = limits.iter().map(|limit| (limit.clone(), Reached::default()));
            all.push((set.to_owned(), none.collect()));
            all.len() - 1
        });
        let limits_of_set = &mut all[place].1;
        for ((limit, known), more) in limits_of_set.iter_mut().zip(reached) {
            known.merge(limit, more);
        }
    }

    /// Computes a stage of so many jobs on all threads, and gives their results in their order. Results are stored to the bit. A
    /// result that was computed while [`Engine::should_continue`] turned false is dropped.
    ///
    /// # Errors
    /// An interruption, the error of the first job that has one, and results that other runs compute.
    pub fn jobs<R: Serialize + DeserializeOwned + Send>(
        &self,
        label: &str,
        count: usize,
        compute: impl Fn(usize) -> Result<R, Stopped> + Sync,
    ) -> Result<Vec<R>, Stopped> {
        let stage = self.next_stage();
        let missing = match self.tasks {
            Some(kept) => self.missing(kept, stage, count)?,
            None => Missing {
                ours: (0..count).collect(),
                others: 0,
            },
        };
        let running = self.running(missing.ours.len(), label);
        let compute = |number: usize| {
            if !self.should_continue() {
                return Err(Stopped::Interrupted);
            }
            let result = compute(number)?;
            if !running.advance(1) {
                return Err(Stopped::Interrupted);
            }
            if let Some(kept) = self.tasks.filter(|kept| !kept.completes()) {
                let bytes = postcard::to_stdvec(&result).map_err(StorageError::Encode)?;
                kept.keep(self.task(stage, number), &bytes)?;
            }
            Ok(result)
        };
        let results: Vec<Result<R, Stopped>> = missing.ours.par_iter().with_max_len(1).map(|i| compute(*i)).collect();
        let results: Vec<R> = results.into_iter().collect::<Result<_, _>>()?;
        let Some(kept) = self.tasks else { return Ok(results) };
        missing.end()?;
        let mut results = missing.ours.iter().zip(results).peekable();
        let result = |number: usize| {
            if let Some((_, result)) = results.next_if(|(next, _)| **next == number) {
                return Ok(result);
            }
            let task = self.task(stage, number);
            postcard::from_bytes(&kept.read(task)?).map_err(|_| unlike(task))
        };
        (0..count).map(result).collect()
    }

    /// Computes parts of the analysis that do not wait for each other, such as its model sets, each with stages of its own. Parts do not
    /// contain parts, and an analysis has parts once.
    ///
    /// # Errors
    /// Those of a part; results that other runs compute, after all parts that need none.
    pub fn parts<'p, P: 'p, T>(
        &self,
        all: impl IntoIterator<Item = P>,
        mut compute: impl FnMut(P) -> Result<T, Stopped>,
    ) -> Result<Vec<T>, Stopped> {
        let stage = self.stage.swap(0, Ordering::Relaxed);
        let (mut results, mut stopped) = (Vec::new(), None);
        for (number, part) in all.into_iter().enumerate() {
            self.part.store(number + 1, Ordering::Relaxed);
            self.stage.store(0, Ordering::Relaxed);
            match compute(part) {
                Ok(result) => results.push(result),
                Err(Stopped::Elsewhere) => stopped = Some(Stopped::Elsewhere),
                Err(why) => {
                    stopped = Some(why);
                    break;
                }
            }
        }
        self.part.store(0, Ordering::Relaxed);
        self.stage.store(stage, Ordering::Relaxed);
        stopped.map_or(Ok(results), Err)
    }

    /// Computes what is not divided into tasks: only in the run that completes what others have begun.
    ///
    /// # Errors
    /// [`Stopped::Elsewhere`] in the others; those of `compute`.
    pub fn undivided<T>(&self, compute: impl FnOnce() -> Result<T, Stopped>) -> Result<T, Stopped> {
        match self.tasks {
            Some(kept) if !kept.completes() => Err(Stopped::Elsewhere),
            _ => compute(),
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
        let (ours, others): (Vec<usize>, Vec<usize>) =
            missing.partition(|number| kept.is_own(self.task(stage, *number)));
        if self.should_continue() {
            Ok(Missing {
                ours,
                others: others.len(),
            })
        } else {
            Err(Stopped::Interrupted)
        }
    }

    /// Solves pieces of given numbers.
    fn evaluate<T: Send>(
        &self,
        run: &Run<'_>,
        numbers: &[usize],
        make: &Make<'_, T>,
        take: &mut dyn FnMut(Piece<T>) -> Result<(), Stopped>,
    ) -> Result<(), Stopped> {
        if numbers.is_empty() {
            return Ok(());
        }
        let field = &run.points.field;
        let points = field.len() * numbers.len() / field.pieces().max(1);
        let running = self.running(points, &run.built.name);
        let going = |n: usize| running.advance(n);
        let mut fault = None;
        let transmission = &run.built.transmission;
        let whole = solve_pieces(transmission, &run.points, numbers, make, &going, &mut |piece| {
            fault = take(piece).err();
            fault.is_none()
        });
        let whole = whole.map_err(|list| Stopped::from(run.findings(list)))?;
        match fault {
            Some(fault) => Err(fault),
            None if whole => Ok(()),
            None => Err(Stopped::Interrupted),
        }
    }
}

/// Tasks of a stage without results.
struct Missing {
    /// Those of this run.
    ours: Vec<usize>,
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
