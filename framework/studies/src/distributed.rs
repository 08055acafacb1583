//! A study whose tasks other processes compute: an engine such as Dask or Ray sends tasks to its workers and collects their results.
//!
//! The process that leads asks [`Collected::missing`] for tasks, sends them with a [`Parcel`], adds their results, and asks again until
//! none is missing: then the analysis has its outcome. A worker opens the parcel ([`Worker`]) and computes the tasks that it is given. Tasks are pure
//! functions of parcel and earlier results: computed again, also elsewhere, they give the same bytes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use gearloss_framework::files::{InMemory, Recorder};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;
use serde::{Deserialize, Serialize};

use crate::analyses::{Engine, Outcome, Planner, Stopped};
use crate::engine::progress::Progress;
use crate::run::{FoundSets, StudyRun};
use crate::study::Study;
use crate::table::DiscardedRows;
use crate::tasks::{StorageError, Task, TaskResults};

/// Tasks of one stage of an analysis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stage {
    /// Number of the part of the analysis.
    pub part: usize,
    /// Number of the stage in its part.
    pub stage: usize,
    /// Indices of its tasks.
    pub tasks: Vec<usize>,
}

/// Results of tasks of one analysis as bytes, by part, stage and index of the task.
pub type Results = BTreeMap<(usize, usize, usize), Vec<u8>>;

/// Results of tasks, collected in memory, by analysis.
#[derive(Debug, Default)]
pub struct Collected(Mutex<BTreeMap<String, Results>>);

impl Collected {
    /// Adds the results of tasks.
    pub fn add(&self, analysis: &str, results: Results) {
        self.all().entry(analysis.to_owned()).or_default().extend(results);
    }

    /// The results on which the tasks of a stage depend: those of the stages before it, outside all parts and in its own part; what comes
    /// after parts depends on all of them.
    pub fn before(&self, analysis: &str, part: usize, stage: usize) -> Results {
        let all = self.all();
        let results = all.get(analysis).into_iter().flatten();
        let before = results.filter(|((of_part, number, _), _)| match *of_part {
            of_part if of_part == part => *number < stage,
            of_part => of_part == 0 || part == 0,
        });
        before.map(|(place, bytes)| (*place, bytes.clone())).collect()
    }

    /// The tasks of an analysis that are next: they have no results and do not depend on each other. None if the analysis needs no further
    /// results, or computes by itself what it needs.
    ///
    /// # Errors
    /// As [`StudyRun::run`].
    pub fn missing(&self, run: &StudyRun<'_>, name: &str, progress: &dyn Progress) -> Result<Vec<Stage>, Stopped> {
        let study = run.study_for_analysis();
        let lister = Lister {
            collected: self,
            missing: Mutex::default(),
        };
        let planner = Planner::new(run.language(), &study, name);
        let engine = Engine::new(&planner, progress);
        match run.run(&engine.with_tasks(Some(&lister)).with_sink(&DiscardedRows)) {
            Ok(_) | Err(Stopped::Elsewhere) => {}
            Err(stopped) => return Err(stopped),
        }
        let missing = lister.missing.into_inner().unwrap_or_else(PoisonError::into_inner);
        let stages = missing
            .into_iter()
            .map(|((part, stage), tasks)| Stage { part, stage, tasks });
        Ok(stages.collect())
    }

    /// The outcome of an analysis from the results. What has none is computed here.
    ///
    /// # Errors
    /// As [`StudyRun::run`].
    pub fn outcome(
        &self,
        run: &StudyRun<'_>,
        name: &str,
        progress: &dyn Progress,
    ) -> Result<Box<dyn Outcome>, Stopped> {
        let study = run.study_for_analysis();
        let planner = Planner::new(run.language(), &study, name);
        run.run(&Engine::new(&planner, progress).with_tasks(Some(self)))
    }

    fn all(&self) -> MutexGuard<'_, BTreeMap<String, Results>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn get<T>(&self, task: Task<'_>, found: impl FnOnce(&Vec<u8>) -> T) -> Option<T> {
        self.all().get(task.analysis)?.get(&place(task)).map(found)
    }
}

fn place(task: Task<'_>) -> (usize, usize, usize) {
    (task.part, task.stage, task.number)
}

fn missing(task: Task<'_>) -> Stopped {
    Stopped::Unwritten(StorageError::Read {
        analysis: task.analysis.to_owned(),
        error: std::io::ErrorKind::NotFound.into(),
    })
}

/// For the run that completes: it computes what has no result.
impl TaskResults for Collected {
    fn is_own(&self, _: Task<'_>) -> bool {
        true
    }

    fn is_kept(&self, task: Task<'_>) -> bool {
        self.get(task, |_| ()).is_some()
    }

    fn completes(&self) -> bool {
        true
    }

    fn read(&self, task: Task<'_>) -> Result<Vec<u8>, Stopped> {
        self.get(task, Clone::clone).ok_or_else(|| missing(task))
    }

    fn keep(&self, _: Task<'_>, _: &[u8]) -> Result<(), Stopped> {
        Ok(())
    }
}

/// Lists the tasks without results instead of computing them.
struct Lister<'a> {
    collected: &'a Collected,
    missing: Mutex<BTreeMap<(usize, usize), Vec<usize>>>,
}

impl TaskResults for Lister<'_> {
    fn is_own(&self, task: Task<'_>) -> bool {
        let mut missing = self.missing.lock().unwrap_or_else(PoisonError::into_inner);
        missing.entry((task.part, task.stage)).or_default().push(task.number);
        false
    }

    fn is_kept(&self, task: Task<'_>) -> bool {
        self.collected.is_kept(task)
    }

    fn completes(&self) -> bool {
        false
    }

    fn read(&self, task: Task<'_>) -> Result<Vec<u8>, Stopped> {
        self.collected.read(task)
    }

    fn keep(&self, _: Task<'_>, _: &[u8]) -> Result<(), Stopped> {
        Ok(())
    }
}

/// A study with everything that its analyses read, to be sent to workers.
#[derive(Debug, Serialize, Deserialize)]
pub struct Parcel {
    /// The program and the crates of its models, with their versions.
    program: Vec<String>,
    text: String,
    folder: PathBuf,
    files: Vec<(PathBuf, Vec<u8>)>,
    /// Model sets that analyses before have found, as JSON.
    found: String,
}

/// Why a parcel cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum ParcelError {
    /// It was packed by another program.
    #[error("the study was sent by {theirs}, and this worker has {ours}; install the same versions on all machines")]
    OtherProgram {
        /// Crates and versions of the sender.
        theirs: String,
        /// Those of the worker.
        ours: String,
    },
    /// It was damaged.
    #[error("the parcel of the study cannot be read: {0}")]
    Damaged(String),
    /// The study has errors.
    #[error("{0}")]
    Found(#[from] Findings),
}

/// The program and the crates of its models, with their versions.
fn program(language: &Language) -> Vec<String> {
    let this = concat!("gearloss ", env!("CARGO_PKG_VERSION")).to_owned();
    let packages = language.registry().packages();
    std::iter::once(this)
        .chain(packages.iter().map(ToString::to_string))
        .collect()
}

impl Parcel {
    /// Packs a study that was read through a recorder, with the model sets that its analyses have found so far.
    pub fn new(study: &Study, read: &Recorder, run: &StudyRun<'_>) -> Self {
        Self {
            program: program(run.language()),
            text: study.text.to_string(),
            folder: study.folder.clone(),
            files: read.files(),
            found: serde_json::json!(run.found_sets()).to_string(),
        }
    }

    /// The parcel as bytes.
    ///
    /// # Errors
    /// [`StorageError::Encode`]: a bug.
    pub fn to_bytes(&self) -> Result<Vec<u8>, StorageError> {
        postcard::to_stdvec(self).map_err(StorageError::Encode)
    }
}

/// A study that was received.
pub struct Worker<'a>(StudyRun<'a>);

impl<'a> Worker<'a> {
    /// Opens a parcel.
    ///
    /// # Errors
    /// If it is damaged or from another program.
    pub fn open(language: &'a Language, parcel: &[u8]) -> Result<Self, ParcelError> {
        let damaged = |error: &dyn ToString| ParcelError::Damaged(error.to_string());
        let parcel: Parcel = postcard::from_bytes(parcel).map_err(|e| damaged(&e))?;
        let ours = program(language);
        if parcel.program != ours {
            let [theirs, ours] = [parcel.program, ours].map(|list| list.join(", "));
            return Err(ParcelError::OtherProgram { theirs, ours });
        }
        let found: FoundSets = serde_json::from_str(&parcel.found).map_err(|e| damaged(&e))?;
        let files = InMemory::new(parcel.files).shared();
        let study = Study::from_text(language, &files, parcel.text, "study", parcel.folder)?;
        Ok(Self(StudyRun::continued(language, &study, found)))
    }

    /// The results of tasks of a stage; `before` are those on which they depend.
    ///
    /// # Errors
    /// As [`compute`].
    pub fn compute(
        &self,
        analysis: &str,
        stage: &Stage,
        before: Results,
        progress: &dyn Progress,
    ) -> Result<Results, Stopped> {
        compute(&self.0, analysis, stage, before, progress)
    }
}

/// The results of tasks of a stage of an analysis; `before` are those on which they depend.
///
/// # Errors
/// As [`StudyRun::run`], and that there are no such tasks.
pub fn compute(
    run: &StudyRun<'_>,
    analysis: &str,
    stage: &Stage,
    before: Results,
    progress: &dyn Progress,
) -> Result<Results, Stopped> {
    let study = run.study_for_analysis();
    let tasks = Own {
        stage,
        before,
        computed: Mutex::default(),
    };
    let planner = Planner::new(run.language(), &study, analysis);
    let engine = Engine::new(&planner, progress);
    match run.run(&engine.with_tasks(Some(&tasks)).with_sink(&DiscardedRows)) {
        Ok(_) | Err(Stopped::Elsewhere) => {}
        Err(stopped) => return Err(stopped),
    }
    let computed = tasks.computed.into_inner().unwrap_or_else(PoisonError::into_inner);
    let place = |number: &usize| (stage.part, stage.stage, *number);
    match stage.tasks.iter().find(|number| !computed.contains_key(&place(number))) {
        None => Ok(computed),
        Some(number) => Err(missing(Task {
            analysis,
            part: stage.part,
            stage: stage.stage,
            number: *number,
        })),
    }
}

/// The tasks that a worker computes.
struct Own<'a> {
    stage: &'a Stage,
    before: Results,
    computed: Mutex<Results>,
}

impl TaskResults for Own<'_> {
    fn is_own(&self, task: Task<'_>) -> bool {
        (task.part, task.stage) == (self.stage.part, self.stage.stage) && self.stage.tasks.contains(&task.number)
    }

    fn is_kept(&self, task: Task<'_>) -> bool {
        self.before.contains_key(&place(task))
    }

    fn completes(&self) -> bool {
        false
    }

    /// The analysis goes on where its last stage was computed here alone.
    fn read(&self, task: Task<'_>) -> Result<Vec<u8>, Stopped> {
        let place = place(task);
        let computed = self.computed();
        let result = self.before.get(&place).or_else(|| computed.get(&place));
        result.cloned().ok_or_else(|| missing(task))
    }

    fn keep(&self, task: Task<'_>, result: &[u8]) -> Result<(), Stopped> {
        self.computed().insert(place(task), result.to_vec());
        Ok(())
    }
}

impl Own<'_> {
    fn computed(&self) -> MutexGuard<'_, Results> {
        self.computed.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
