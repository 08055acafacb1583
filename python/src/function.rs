//! Functions of Python as laws: the model `function`.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use gearloss::framework::function::{Function, FunctionSource};
use gearloss::framework::loss::Undefined;
use gearloss::framework::registry::inventory;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use serde_json::Value;

/// A function that takes the number of points and an array of each quantity, and returns an array.
struct PyFunction {
    name: String,
    function: Py<PyAny>,
    quantities: Vec<String>,
    /// Whether arrays are passed on to the user's function.
    vectorised: bool,
}

/// All functions by name.
fn known() -> MutexGuard<'static, BTreeMap<String, Arc<PyFunction>>> {
    static KNOWN: Mutex<BTreeMap<String, Arc<PyFunction>>> = Mutex::new(BTreeMap::new());
    KNOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

inventory::submit! {
    FunctionSource {
        find: |name| Some(Arc::clone(known().get(name)?) as Arc<dyn Function>),
        names: || known().keys().cloned().collect(),
    }
}

impl Function for PyFunction {
    fn quantities(&self) -> &[String] {
        &self.quantities
    }

    /// A thread waits here for the interpreter.
    fn evaluate(&self, inputs: &[Vec<f64>], results: &mut [f64]) -> Result<(), Undefined> {
        let called = Python::attach(|py| -> PyResult<()> {
            let count = results.len().into_pyobject(py)?.into_any();
            let arrays = inputs.iter().map(|list| PyArray1::from_slice(py, list).into_any());
            let arguments = PyTuple::new(py, std::iter::once(count).chain(arrays).collect::<Vec<_>>())?;
            let returned: PyReadonlyArray1<'_, f64> = self.function.bind(py).call1(arguments)?.extract()?;
            results.copy_from_slice(returned.as_slice()?);
            Ok(())
        });
        called.map_err(|error| Undefined::new(format!("result of the function `{}` ({error})", self.name), f64::NAN))
    }
}

/// Adds a function under a name, or replaces it; transmissions that were built before keep the old one.
#[pyfunction]
pub fn add_function(name: String, function: Py<PyAny>, quantities: Vec<String>, vectorised: bool) {
    let added = PyFunction {
        name: name.clone(),
        function,
        quantities,
        vectorised,
    };
    // What is replaced is dropped after the lock is gone, because that may run code of Python.
    let replaced = known().insert(name, Arc::new(added));
    drop(replaced);
}

/// The first function in a resolved description that takes one point at a time.
pub fn one_by_one(value: &Value) -> Option<String> {
    match value {
        Value::Array(list) => list.iter().find_map(one_by_one),
        Value::Object(map) => {
            let name = map.get("name").and_then(Value::as_str);
            let name = name.filter(|_| map.get("type").is_some_and(|kind| kind == "function"));
            let slow = name.filter(|name| known().get(*name).is_some_and(|function| !function.vectorised));
            slow.map(str::to_owned).or_else(|| map.values().find_map(one_by_one))
        }
        _ => None,
    }
}
