//! Tasks of a study for engines that distribute them.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use gearloss::studies::distributed::{Collected, Parcel, ParcelError, Results, Stage, Worker};
use gearloss::studies::tasks::StorageError;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{language, raised, stopped};
use crate::study::{Interruptible, Outcome, Study};
use crate::work;

/// A stage in Python: its part, its number, the numbers of its tasks.
type PyStage = (usize, usize, Vec<usize>);

fn failed(error: &StorageError) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

fn bytes_of(results: &Results) -> PyResult<Vec<u8>> {
    let bytes = postcard::to_stdvec(results);
    bytes.map_err(|error| failed(&StorageError::Encode(error)))
}

fn results_from(bytes: &[u8]) -> PyResult<Results> {
    postcard::from_bytes(bytes)
        .map_err(|error| PyValueError::new_err(format!("these are no results of tasks: {error}")))
}

/// The process that leads: what the workers of a study have computed.
#[pyclass(frozen)]
pub struct Distribution {
    study: Py<Study>,
    collected: Collected,
}

#[pymethods]
impl Distribution {
    #[new]
    fn new(study: Py<Study>) -> Self {
        Self {
            study,
            collected: Collected::default(),
        }
    }

    /// The tasks of an analysis that are next; none if it needs no further results.
    fn missing(&self, py: Python<'_>, analysis: &str) -> PyResult<Vec<PyStage>> {
        let study = self.study.get();
        let listed = work::run(py, |stop| {
            self.collected.missing(&study.run, analysis, &Interruptible(stop))
        })?;
        let stages = listed.map_err(|why| stopped(py, why))?;
        Ok(stages
            .into_iter()
            .map(|stage| (stage.part, stage.stage, stage.tasks))
            .collect())
    }

    /// The study with everything that it has read, for [`compute`].
    fn parcel<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let study = self.study.get();
        let parcel = Parcel::new(&study.checked, &study.read, &study.run).to_bytes();
        Ok(PyBytes::new(py, &parcel.map_err(|error| failed(&error))?))
    }

    /// The results on which the tasks of a stage depend.
    fn before<'py>(&self, py: Python<'py>, analysis: &str, part: usize, stage: usize) -> PyResult<Bound<'py, PyBytes>> {
        let before = self.collected.before(analysis, part, stage);
        Ok(PyBytes::new(py, &bytes_of(&before)?))
    }

    /// Adds what [`compute`] returned.
    fn add(&self, analysis: &str, results: &[u8]) -> PyResult<()> {
        self.collected.add(analysis, results_from(results)?);
        Ok(())
    }

    /// The outcome of an analysis. What has no result is computed here.
    fn outcome(&self, py: Python<'_>, analysis: &str) -> PyResult<Outcome> {
        let study = self.study.get();
        let outcome = work::run(py, |stop| {
            self.collected.outcome(&study.run, analysis, &Interruptible(stop))
        })?;
        Ok(Outcome(outcome.map_err(|why| stopped(py, why))?.into()))
    }

    /// Writes results and report as `gearloss run` does; returns its exit code.
    fn write(&self, py: Python<'_>, folder: Option<PathBuf>, force: bool) -> PyResult<u8> {
        let study = self.study.get();
        let language = language(py)?;
        work::run_until(py, gearloss::interrupt, |_| {
            gearloss::write_results(&study.checked, language, &self.collected, folder.as_deref(), force)
        })
    }
}

/// A worker that has opened a parcel; the last one is kept, because chunks of one study follow each other.
type Opened = (Vec<u8>, Arc<Worker<'static>>);

/// The results of tasks on one thread, for [`Distribution::add`].
#[pyfunction]
pub fn compute<'py>(
    py: Python<'py>,
    parcel: &[u8],
    analysis: &str,
    stage: PyStage,
    before: &[u8],
) -> PyResult<Bound<'py, PyBytes>> {
    static LAST: Mutex<Option<Opened>> = Mutex::new(None);
    let language = language(py)?;
    let before = results_from(before)?;
    let (part, number, tasks) = stage;
    let stage = Stage {
        part,
        stage: number,
        tasks,
    };
    // Engines run a task for each core.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let alone = alone.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let results = work::run(py, |stop| {
        alone.install(|| {
            let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
            let worker = match &*last {
                Some((of, worker)) if of == parcel => Arc::clone(worker),
                _ => {
                    let worker = Arc::new(Worker::open(language, parcel)?);
                    *last = Some((parcel.to_vec(), Arc::clone(&worker)));
                    worker
                }
            };
            drop(last);
            Ok(worker.compute(analysis, &stage, before, &Interruptible(stop)))
        })
    })?;
    let results = results.map_err(|error: ParcelError| match error {
        ParcelError::Found(found) => raised(py, &found),
        other => PyRuntimeError::new_err(other.to_string()),
    })?;
    let results = results.map_err(|why| stopped(py, why))?;
    Ok(PyBytes::new(py, &bytes_of(&results)?))
}
