//! Results as columns: arrays of NumPy, and the Arrow stream that data frames read.

use gearloss::studies::table;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};

use crate::arrow;

/// A column with its unit and meaning.
#[pyclass(frozen)]
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

/// Numbers belong to NumPy; of texts each row has the place of its text, or none.
enum Cells {
    Numbers(Py<PyArray1<f64>>),
    Texts {
        kinds: Vec<String>,
        codes: Vec<Option<u32>>,
    },
}

impl Column {
    /// A column of numbers, which become an array without a copy.
    pub fn numbers(py: Python<'_>, name: String, unit: &str, meaning: String, values: Vec<f64>) -> PyResult<Py<Self>> {
        let numbers = PyArray1::from_vec(py, values);
        // Views, data frames and streams share them.
        numbers.readwrite().make_nonwriteable();
        Self::new(py, name, unit, meaning, Cells::Numbers(numbers.unbind()))
    }

    /// A column of texts.
    pub fn texts<'t>(
        py: Python<'_>,
        name: &str,
        meaning: &str,
        texts: impl Iterator<Item = Option<&'t str>>,
    ) -> PyResult<Py<Self>> {
        let mut kinds: Vec<String> = Vec::new();
        let code = |text: &str, kinds: &mut Vec<String>| {
            let known = kinds.iter().rposition(|kind| kind == text);
            known.unwrap_or_else(|| {
                kinds.push(text.to_owned());
                kinds.len() - 1
            })
        };
        let codes = texts.map(|text| text.and_then(|text| u32::try_from(code(text, &mut kinds)).ok()));
        let codes = codes.collect();
        Self::new(
            py,
            name.to_owned(),
            "",
            meaning.to_owned(),
            Cells::Texts { kinds, codes },
        )
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
    /// The numbers as an array, or the texts as a list with `None` for gaps.
    #[getter]
    fn values(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        match &self.cells {
            Cells::Numbers(numbers) => Ok(numbers.clone_ref(py).into_any()),
            Cells::Texts { kinds, codes } => {
                let texts = codes.iter().map(|code| code.map(|code| kinds[code as usize].as_str()));
                Ok(PyList::new(py, texts.collect::<Vec<_>>())?.into_any().unbind())
            }
        }
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        match &self.cells {
            Cells::Numbers(numbers) => numbers.bind(py).len(),
            Cells::Texts { codes, .. } => Ok(codes.len()),
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
#[pyclass(frozen)]
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
                let numbers = std::sync::Arc::unwrap_or_clone(numbers);
                Column::numbers(py, column.name, &column.unit, column.meaning.into_owned(), numbers)
            }
            table::Values::Texts(texts) => {
                let rows = (0..texts.codes().len()).map(|row| texts.get(row));
                Column::texts(py, &column.name, &column.meaning, rows)
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
                Cells::Numbers(numbers) => arrow::Cells::numbers(numbers.bind(py)),
                Cells::Texts { kinds, codes } => {
                    arrow::Cells::texts(codes.iter().map(|code| code.map(|code| kinds[code as usize].as_str())))
                }
            };
            (column.name.clone(), column.unit.clone(), cells)
        });
        arrow::stream(py, columns.collect(), self.__len__(py)?)
    }
}
