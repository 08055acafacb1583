//! Results as columns: arrays of NumPy, and the Arrow stream that data frames read.

use std::sync::Arc;

use gearloss::studies::table;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList, PyType};

use crate::arrow;

/// A column with its unit and meaning.
#[pyclass(frozen, module = "gearloss._core")]
pub struct Column {
    /// Name.
    #[pyo3(get)]
    name: String,
    /// Unit; `-` for a number without one, empty for texts.
    #[pyo3(get)]
    unit: String,
    /// Meaning.
    #[pyo3(get)]
    meaning: String,
    cells: Cells,
}

/// Numbers belong to NumPy.
enum Cells {
    Numbers(Py<PyArray1<f64>>),
    Texts(Arc<table::Texts>),
}

impl Cells {
    fn numbers(py: Python<'_>, values: Vec<f64>) -> Self {
        let numbers = PyArray1::from_vec(py, values);
        // Views, data frames and streams share them.
        numbers.readwrite().make_nonwriteable();
        Self::Numbers(numbers.unbind())
    }

    fn texts<'t>(texts: impl Iterator<Item = Option<&'t str>>) -> Self {
        let mut cells = table::Texts::default();
        for text in texts {
            cells.push(text.unwrap_or_default());
        }
        Self::Texts(Arc::new(cells))
    }
}

impl Column {
    /// A column of numbers, which become an array without a copy.
    pub fn numbers(py: Python<'_>, name: String, unit: &str, meaning: String, values: Vec<f64>) -> PyResult<Py<Self>> {
        Self::new(py, name, unit, meaning, Cells::numbers(py, values))
    }

    /// A column of texts.
    pub fn texts<'t>(
        py: Python<'_>,
        name: &str,
        meaning: &str,
        texts: impl Iterator<Item = Option<&'t str>>,
    ) -> PyResult<Py<Self>> {
        Self::new(py, name.to_owned(), "", meaning.to_owned(), Cells::texts(texts))
    }

    fn new(py: Python<'_>, name: String, unit: &str, meaning: String, cells: Cells) -> PyResult<Py<Self>> {
        let unit = unit.to_owned();
        Py::new(
            py,
            Self {
                name,
                unit,
                meaning,
                cells,
            },
        )
    }
}

#[pymethods]
impl Column {
    /// A column of an array of numbers, or of a list of texts with `None` for gaps.
    #[new]
    fn from_values(name: String, unit: String, meaning: String, values: &Bound<'_, PyAny>) -> PyResult<Self> {
        let cells = if let Ok(numbers) = values.extract::<PyReadonlyArray1<'_, f64>>() {
            Cells::numbers(values.py(), numbers.as_array().to_vec())
        } else {
            let texts: Vec<Option<String>> = values.extract()?;
            Cells::texts(texts.iter().map(Option::as_deref))
        };
        Ok(Self {
            name,
            unit,
            meaning,
            cells,
        })
    }

    /// What a pickled column is made of again.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyType>, (String, String, String, Py<PyAny>))> {
        let own = slf.get();
        let values = own.values(slf.py())?;
        let made_of = (own.name.clone(), own.unit.clone(), own.meaning.clone(), values);
        Ok((slf.get_type(), made_of))
    }

    /// The numbers as an array, or the texts as a list with `None` for gaps.
    #[getter]
    fn values(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        match &self.cells {
            Cells::Numbers(numbers) => Ok(numbers.clone_ref(py).into_any()),
            Cells::Texts(texts) => {
                let texts: Vec<Option<&str>> = texts.iter().collect();
                Ok(PyList::new(py, texts)?.into_any().unbind())
            }
        }
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        match &self.cells {
            Cells::Numbers(numbers) => numbers.bind(py).len(),
            Cells::Texts(texts) => Ok(texts.codes().len()),
        }
    }

    fn __repr__(&self) -> String {
        format!(
            "Column('{}', unit='{}', meaning='{}')",
            self.name, self.unit, self.meaning
        )
    }
}

/// A table of results.
#[pyclass(frozen, module = "gearloss._core")]
pub struct Table {
    /// Name.
    #[pyo3(get)]
    name: String,
    columns: Vec<Py<Column>>,
}

impl Table {
    pub fn new(name: &str, columns: Vec<Py<Column>>) -> Self {
        Self {
            name: name.to_owned(),
            columns,
        }
    }

    /// A table of an outcome; numbers that nothing else uses are moved.
    pub fn from_outcome(py: Python<'_>, table: table::Table) -> PyResult<Self> {
        let columns = table.columns.into_iter().map(|column| match column.values {
            table::Values::Numbers(numbers) => {
                let numbers = Arc::unwrap_or_clone(numbers);
                Column::numbers(py, column.name, &column.unit, column.meaning.into_owned(), numbers)
            }
            table::Values::Texts(texts) => {
                Column::new(py, column.name, "", column.meaning.into_owned(), Cells::Texts(texts))
            }
        });
        Ok(Self {
            name: table.name,
            columns: columns.collect::<PyResult<_>>()?,
        })
    }
}

#[pymethods]
impl Table {
    /// A table of columns of one length.
    #[new]
    fn from_columns(name: String, columns: Vec<Py<Column>>) -> Self {
        Self { name, columns }
    }

    /// What a pickled table is made of again.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, (String, Vec<Py<Column>>)) {
        let own = slf.get();
        (slf.get_type(), (own.name.clone(), own.columns(slf.py())))
    }

    /// The columns in their order.
    #[getter]
    fn columns(&self, py: Python<'_>) -> Vec<Py<Column>> {
        self.columns.iter().map(|column| column.clone_ref(py)).collect()
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.columns.first().map_or(Ok(0), |column| column.get().__len__(py))
    }

    /// The table as a stream of Arrow with one batch, whose numbers are those of the arrays.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // The types are fixed; a consumer casts what it asked for.
        drop(requested_schema);
        let columns = self.columns.iter().map(|column| {
            let column = column.get();
            let cells = match &column.cells {
                Cells::Numbers(numbers) => arrow::numbers(numbers.bind(py))?,
                Cells::Texts(texts) => arrow::Cells::texts(texts.iter()),
            };
            Ok((column.name.clone(), column.unit.clone(), cells))
        });
        arrow::stream(py, columns.collect::<PyResult<_>>()?, self.__len__(py)?)
    }
}
