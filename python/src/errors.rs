//! Errors of documents as an exception of Python.

use std::sync::{Mutex, OnceLock};

use gearloss::api::{Code, Findings as Found, Language, Stopped};
use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::{json, work};

create_exception!(
    gearloss,
    Findings,
    PyValueError,
    "What is wrong with a document or a request. Its text is that of the terminal; `list` has a dict for each finding with code, severity, message, path, places (file, line, column) and help."
);

/// The exception of findings.
pub fn raised(py: Python<'_>, found: &Found) -> PyErr {
    let error = Findings::new_err(found.render().trim_end().to_owned());
    let set = json::to_python(py, found).and_then(|list| error.value(py).setattr("list", list));
    set.err().unwrap_or(error)
}

/// The exception of the findings of several inputs.
fn several(py: Python<'_>, all: &[Found]) -> PyErr {
    let text: String = all.iter().map(Found::render).collect();
    let error = Findings::new_err(text.trim_end().to_owned());
    let lists = all
        .iter()
        .map(|found| json::to_python(py, found)?.bind(py).extract::<Vec<Py<PyAny>>>());
    let set = lists.collect::<PyResult<Vec<_>>>().and_then(|lists| {
        error
            .value(py)
            .setattr("list", lists.into_iter().flatten().collect::<Vec<_>>())
    });
    set.err().unwrap_or(error)
}

/// The exception of a request that is not part of a document.
pub fn wrong(py: Python<'_>, code: Code, message: impl Into<String>, help: &str) -> PyErr {
    let error = gearloss::api::Diagnostic::error("", message).help(help).code(code);
    raised(py, &Found::from(error))
}

/// The exception of an analysis without an outcome.
pub fn stopped(py: Python<'_>, why: Stopped) -> PyErr {
    match why {
        Stopped::Found(found) => raised(py, &found),
        Stopped::Several(all) => several(py, &all),
        Stopped::Interrupted => PyKeyboardInterrupt::new_err("interrupted"),
        other => PyRuntimeError::new_err(format!("the analysis has no outcome: {other:?}")),
    }
}

/// The language of the linked models.
pub fn language(py: Python<'_>) -> PyResult<&'static Language> {
    static LANGUAGE: OnceLock<Result<Language, Found>> = OnceLock::new();
    LANGUAGE
        .get_or_init(Language::linked)
        .as_ref()
        .map_err(|found| raised(py, found))
}

/// Runs a command of the program, such as `["run", "study.yaml", "-o", "results"]`; returns its exit code.
#[pyfunction]
pub fn call(py: Python<'_>, arguments: Vec<String>) -> PyResult<u8> {
    // Its interruption is one for the process.
    static ONE: Mutex<()> = Mutex::new(());
    let Ok(_one) = ONE.try_lock() else {
        return Err(PyRuntimeError::new_err(
            "another thread runs a study; wait for it, or use `Study`",
        ));
    };
    let executable: Option<String> = py.import("sys")?.getattr("executable")?.extract()?;
    if let Some(python) = executable.filter(|python| !python.is_empty()) {
        let program = "import sys; from gearloss import _core; sys.exit(_core.call(sys.argv[1:]))";
        gearloss::started_by([python, "-c".to_owned(), program.to_owned()].map(Into::into));
    }
    let arguments = std::iter::once("gearloss".to_owned()).chain(arguments);
    work::run_until(py, gearloss::interrupt, |_| gearloss::call(arguments.map(Into::into)))
}
