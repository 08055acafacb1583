//! Results of tasks in the folders of shards.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use gearloss_studies::analyses::Stopped;
use gearloss_studies::engine::head::fnv1a_64;
use gearloss_studies::study::Study;
use gearloss_studies::tasks::{StorageError, Task, TaskResults};

use super::folder::cannot_write;
use super::task_file::{Place, TaskFile};
use crate::output::Failure;
use crate::shard::Shard;

/// Results of shards, and the folder of the computing shard.
pub struct ShardTasks {
    /// The computing shard; absent for a merge.
    shard: Option<Shard>,
    /// Its folder.
    folder: PathBuf,
    analyses: BTreeMap<String, Mutex<Files>>,
}

/// The files of one analysis.
#[derive(Default)]
struct Files {
    /// The file of the computing shard, if it exists.
    ours: Option<TaskFile>,
    others: Vec<TaskFile>,
    /// Number of results from earlier runs.
    before: usize,
    computed: usize,
}

/// The file of the tasks of an analysis.
fn file(folder: &Path, analysis: &str) -> PathBuf {
    folder.join(format!("{analysis}.tasks"))
}

impl ShardTasks {
    /// The tasks of a shard, which continues in its folder; other shards have other folders.
    pub fn of_shard(study: &Study, shard: Shard, folder: &Path, others: &[PathBuf]) -> Result<Self, Failure> {
        let tasks = Self {
            shard: Some(shard),
            folder: folder.to_owned(),
            ..Self::of_merge(study, others)?
        };
        for (analysis, files) in &tasks.analyses {
            let path = file(folder, analysis);
            if path.symlink_metadata().is_ok() {
                let file = TaskFile::reopen(&path).map_err(|e| cannot_write(&path, e))?;
                let mut files = locked(files);
                files.before = file.len();
                files.ours = Some(file);
            }
        }
        Ok(tasks)
    }

    /// The tasks of all shards, for a merge.
    pub fn of_merge(study: &Study, folders: &[PathBuf]) -> Result<Self, Failure> {
        let files = |analysis: &str| -> Result<Mutex<Files>, Failure> {
            let files = folders.iter().map(|folder| file(folder, analysis));
            // A shard without tasks of an analysis has no file for it.
            let files = files.filter(|path| path.is_file());
            let read = |path: PathBuf| TaskFile::read_only(&path).map_err(|e| cannot_write(&path, e));
            Ok(Mutex::new(Files {
                others: files.map(read).collect::<Result<_, _>>()?,
                ..Files::default()
            }))
        };
        let analyses = study.entry.analyses.ids();
        Ok(Self {
            shard: None,
            folder: PathBuf::new(),
            analyses: analyses
                .map(|name| Ok((name.to_owned(), files(name)?)))
                .collect::<Result<_, Failure>>()?,
        })
    }

    /// Number of complete results in a folder.
    pub fn count(study: &Study, folder: &Path) -> usize {
        let files = study.entry.analyses.ids().map(|name| file(folder, name));
        files
            .filter_map(|path| TaskFile::read_only(&path).ok())
            .map(|file| file.len())
            .sum()
    }

    /// Number of computed results, and of results from earlier runs.
    pub fn counts(&self) -> (usize, usize) {
        let all = self.analyses.values().map(|files| {
            let files = locked(files);
            (files.computed, files.before)
        });
        all.fold((0, 0), |sum, counts| (sum.0 + counts.0, sum.1 + counts.1))
    }

    fn files(&self, task: Task<'_>) -> Option<MutexGuard<'_, Files>> {
        self.analyses.get(task.analysis).map(locked)
    }
}

/// Where a task lies in the file of its analysis: part, stage and number.
fn place(task: Task<'_>) -> Place {
    [task.part, task.stage, task.number]
}

fn locked(files: &Mutex<Files>) -> MutexGuard<'_, Files> {
    files.lock().unwrap_or_else(PoisonError::into_inner)
}

impl TaskResults for ShardTasks {
    /// Tasks are assigned to the shards in turn, those of each stage from another shard on.
    fn is_own(&self, task: Task<'_>) -> bool {
        self.shard.is_none_or(|shard| {
            let first = fnv1a_64(task.analysis.as_bytes()).wrapping_add((task.part + task.stage) as u64);
            let dealt = (first % shard.of as u64) as usize + task.number;
            dealt % shard.of + 1 == shard.number
        })
    }

    fn is_kept(&self, task: Task<'_>) -> bool {
        self.files(task).is_some_and(|files| {
            let mut all = files.ours.iter().chain(&files.others);
            all.any(|file| file.holds(place(task)))
        })
    }

    fn completes(&self) -> bool {
        self.shard.is_none()
    }

    fn read(&self, task: Task<'_>) -> Result<Vec<u8>, Stopped> {
        let wanted = place(task);
        let result = self.files(task).map(|mut files| {
            let Files { ours: mine, others, .. } = &mut *files;
            let mut all = mine.iter_mut().chain(others);
            all.find(|file| file.holds(wanted)).map(|file| file.read(wanted))
        });
        let result = result
            .flatten()
            .unwrap_or_else(|| Err(std::io::ErrorKind::NotFound.into()));
        let analysis = || task.analysis.to_owned();
        Ok(result.map_err(|error| StorageError::Read {
            analysis: analysis(),
            error,
        })?)
    }

    fn keep(&self, task: Task<'_>, result: &[u8]) -> Result<(), Stopped> {
        let Some(mut files) = self.files(task) else {
            return Ok(());
        };
        let path = file(&self.folder, task.analysis);
        if files.ours.is_none() {
            files.ours = Some(TaskFile::reopen(&path).map_err(|e| cannot_write(&path, e))?);
        }
        let kept = files.ours.as_mut().map(|file| file.append(place(task), result));
        kept.transpose().map_err(|e| cannot_write(&path, e))?;
        files.computed += 1;
        Ok(())
    }
}
