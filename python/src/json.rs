//! Documents between Python and JSON.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use serde_json::Value;

/// A record as dicts and lists.
pub fn to_python(py: Python<'_>, record: &(impl Serialize + ?Sized)) -> PyResult<Py<PyAny>> {
    let text = serde_json::to_string(record).map_err(|error| PyValueError::new_err(error.to_string()))?;
    read(py, &text)
}

/// A JSON text as dicts and lists.
pub fn read(py: Python<'_>, text: &str) -> PyResult<Py<PyAny>> {
    Ok(py.import("json")?.call_method1("loads", (text,))?.unbind())
}

/// Dicts, lists, numbers, also those of NumPy, and texts as JSON.
pub fn from_python(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let py = value.py();
    let options = PyDict::new(py);
    // Numbers of NumPy are no numbers for `json`.
    options.set_item("default", py.get_type::<pyo3::types::PyFloat>())?;
    options.set_item("allow_nan", false)?;
    let text: String = py
        .import("json")?
        .call_method("dumps", (value,), Some(&options))?
        .extract()?;
    serde_json::from_str(&text).map_err(|error| PyValueError::new_err(error.to_string()))
}
