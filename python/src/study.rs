//! Studies and their outcomes.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use gearloss::api::{self, Progress, Silent, Steps, StudyRun};
use gearloss::document::files::Recorder;
use gearloss::report::page::Page;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::{language, raised, stopped};
use crate::json;
use crate::table::Table;
use crate::work;

/// A checked study.
#[pyclass(frozen)]
pub struct Study {
    pub checked: api::Study,
    pub run: StudyRun<'static>,
    /// The files that it has read so far.
    pub read: Arc<Recorder>,
}

impl Study {
    fn new(
        py: Python<'_>,
        source: api::SharedSource,
        read: impl FnOnce(&'static api::Language, &api::SharedSource) -> Result<api::Study, api::Findings>,
    ) -> PyResult<Self> {
        let language = language(py)?;
        let recorder = Arc::new(Recorder::new(source));
        let files: api::SharedSource = recorder.clone();
        let study = read(language, &files)
            .and_then(|study| study.check(language).map(|()| study))
            .map_err(|found| raised(py, &found))?;
        Ok(Self {
            run: StudyRun::new(language, &study),
            checked: study,
            read: recorder,
        })
    }
}

/// Files in memory, and those of the disk.
#[derive(Debug)]
struct InMemoryFirst(api::InMemory);

impl api::FileSource for InMemoryFirst {
    fn read(&self, path: &Path, longest: u64) -> io::Result<Vec<u8>> {
        match self.0.read(path, longest) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => api::Disk.read(path, longest),
            read => read,
        }
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<String>> {
        self.0.list(folder).or_else(|_| api::Disk.list(folder))
    }
}

/// Ends an analysis when it is asked to.
pub struct Interruptible<'a>(pub &'a AtomicBool);

impl Progress for Interruptible<'_> {
    fn begin(&self, _: &str, _: usize) -> Box<dyn Steps + '_> {
        Box::new(Silent)
    }

    fn should_continue(&self) -> bool {
        !self.0.load(Ordering::Relaxed)
    }
}

/// How far an analysis is, for a function of Python.
#[derive(Default)]
struct Stand {
    label: Mutex<String>,
    count: AtomicUsize,
    done: AtomicUsize,
}

impl Stand {
    /// Tells it, if it has changed.
    fn tell(&self, py: Python<'_>, function: &Py<PyAny>, told: &AtomicUsize) -> PyResult<()> {
        let (count, done) = (self.count.load(Ordering::Relaxed), self.done.load(Ordering::Relaxed));
        if count == 0 || told.swap(done, Ordering::Relaxed) == done {
            return Ok(());
        }
        let label = self.label.lock().unwrap_or_else(PoisonError::into_inner).clone();
        function.call1(py, (label, done.min(count), count)).map(drop)
    }
}

/// Keeps how far an analysis is, and ends it when it is asked to.
struct Watched<'a> {
    stop: &'a AtomicBool,
    stand: &'a Stand,
}

impl Progress for Watched<'_> {
    fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_> {
        label.clone_into(&mut self.stand.label.lock().unwrap_or_else(PoisonError::into_inner));
        self.stand.count.store(count, Ordering::Relaxed);
        self.stand.done.store(0, Ordering::Relaxed);
        Box::new(Stepping(self.stand))
    }

    fn should_continue(&self) -> bool {
        !self.stop.load(Ordering::Relaxed)
    }
}

struct Stepping<'a>(&'a Stand);

impl Steps for Stepping<'_> {
    fn advance(&self, count: usize) {
        self.0.done.fetch_add(count, Ordering::Relaxed);
    }
}

#[pymethods]
impl Study {
    /// Reads a file and its gearboxes, and checks every name that its analyses use.
    #[staticmethod]
    fn read(py: Python<'_>, file: PathBuf) -> PyResult<Self> {
        Self::new(py, api::Disk::shared(), |language, files| {
            api::Study::read_from(language, files, &file)
        })
    }

    /// Reads a text, in YAML or JSON; `folder` contains the files that it names.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: String, name: &str, folder: PathBuf) -> PyResult<Self> {
        Self::new(py, api::Disk::shared(), |language, files| {
            api::Study::from_text(language, files, text, name, folder)
        })
    }

    /// Reads a document of dicts and lists; `folder` contains the files that it names, except for `files`, which are in memory.
    #[staticmethod]
    fn from_document(
        py: Python<'_>,
        document: &Bound<'_, PyAny>,
        folder: PathBuf,
        files: BTreeMap<PathBuf, String>,
    ) -> PyResult<Self> {
        let text = format!("{:#}", json::from_python(document)?);
        let files = files.into_iter().map(|(name, text)| (folder.join(name), text));
        let source = Arc::new(InMemoryFirst(api::InMemory::new(files)));
        Self::new(py, source, |language, files| {
            api::Study::from_text(language, files, text, "document", folder)
        })
    }

    /// Title; `None` without one.
    #[getter]
    fn title(&self) -> Option<&str> {
        self.checked.entry.title.as_deref()
    }

    /// Names of the analyses, in their order.
    #[getter]
    fn analyses(&self) -> Vec<&str> {
        self.checked.entry.analyses.ids().collect()
    }

    /// Whether other analyses may use a model set that the analysis finds.
    fn finds_models(&self, name: &str) -> bool {
        let analysis = self.checked.entry.analyses.get(name);
        analysis.is_some_and(|analysis| analysis.then().is_some())
    }

    /// Runs an analysis. Those whose model sets it uses must have run before. `progress` is called with what is being done, how many steps
    /// of it are done, and how many there are.
    #[pyo3(signature = (name, progress=None))]
    fn analysis(&self, py: Python<'_>, name: &str, progress: Option<Py<PyAny>>) -> PyResult<Outcome> {
        let (stand, told) = (Stand::default(), AtomicUsize::new(usize::MAX));
        let watch = |py: Python<'_>| {
            progress
                .as_ref()
                .map_or(Ok(()), |function| stand.tell(py, function, &told))
        };
        let run = |stop: &AtomicBool| self.run.analysis_with(name, &Watched { stop, stand: &stand });
        let outcome = work::run_watched(py, watch, || {}, run)?;
        Ok(Outcome(outcome.map_err(|why| stopped(py, why))?.into()))
    }
}

/// The outcome of an analysis.
#[pyclass(frozen)]
pub struct Outcome(pub Arc<dyn api::Outcome>);

#[pymethods]
impl Outcome {
    /// Name of the analysis.
    #[getter]
    fn name(&self) -> &str {
        &self.0.head().analysis
    }

    /// The result in one sentence; `None` if there is none.
    #[getter]
    fn headline(&self) -> Option<String> {
        Page::from_outcome(&*self.0).headline
    }

    /// Numbers that a reader remembers: dicts with label, value, unit and detail.
    #[getter]
    fn key_figures(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        json::to_python(py, &Page::from_outcome(&*self.0).key_figures)
    }

    /// Limits that are not kept, what else limits the result, and quantities outside the stated ranges of their models.
    #[getter]
    fn careful(&self) -> Vec<String> {
        let page = Page::from_outcome(&*self.0);
        let limits = page.limits.into_iter();
        limits.chain(page.careful).chain(page.outside).collect()
    }

    /// Why parts of the outcome are missing.
    #[getter]
    fn failures(&self) -> Vec<String> {
        self.0.failures().iter().map(api::Findings::render).collect()
    }

    /// Its tables; the first has the name of the analysis.
    #[getter]
    fn tables(&self, py: Python<'_>) -> PyResult<Vec<Table>> {
        self.0
            .tables()
            .into_iter()
            .map(|table| Table::from_outcome(py, table))
            .collect()
    }

    /// Names of its figures.
    #[getter]
    fn figures(&self) -> Vec<String> {
        let page = Page::from_outcome(&*self.0);
        page.figures.into_iter().map(|figure| figure.name).collect()
    }

    /// A figure as SVG.
    fn svg(&self, name: &str) -> PyResult<Option<String>> {
        let page = Page::from_outcome(&*self.0);
        let figure = page.figures.into_iter().find(|figure| figure.name == name);
        let svg = figure.map(|figure| figure.figure.svg()).transpose();
        svg.map_err(|error| PyRuntimeError::new_err(format!("{name}: {error}")))
    }

    /// The record of the JSON file that `gearloss run` writes.
    fn to_dict(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let mut text = Vec::new();
        let written = self.0.write_json(&mut text);
        written.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        json::read(py, &String::from_utf8_lossy(&text))
    }
}
