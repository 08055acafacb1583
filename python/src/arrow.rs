//! Columns as a stream of Arrow in a capsule of Python; numbers stay where NumPy has them.

#![allow(unsafe_code)]

mod c_data;

use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

pub use c_data::Cells;
use c_data::Stream;

/// Numbers of NumPy, which stay where they are. References to arrays that are dropped without the interpreter are released by it later.
pub fn numbers(numbers: &Bound<'_, PyArray1<f64>>) -> PyResult<Cells> {
    let length = numbers.len()?;
    let first = numbers.data().cast_const();
    // SAFETY: the array is one-dimensional, contiguous and not writeable, and the reference keeps it.
    Ok(unsafe { Cells::numbers(Box::new(numbers.clone().unbind()), first, length) })
}

/// A stream of columns with their names and units, in a capsule.
pub fn stream(py: Python<'_>, columns: Vec<(String, String, Cells)>, rows: usize) -> PyResult<Bound<'_, PyCapsule>> {
    let stream = Stream::new(columns, rows).map_err(PyValueError::new_err)?;
    // A consumer moves the stream out and leaves it without `release`.
    PyCapsule::new_with_value_and_destructor(py, stream, c"arrow_array_stream", |mut stream: Stream, _| {
        stream.release();
    })
}
