//! A gearbox, and a transmission with its models.

use std::path::PathBuf;
use std::sync::Arc;

use gearloss::api;
use gearloss::framework::resolve::OWN_MODELS;
use gearloss::studies::points::evidence;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use serde_json::json;

use crate::errors::{language, raised};
use crate::json;
use crate::point::{Request, Solution, prepared};
use crate::points::{self, Given};
use crate::table::Table;

/// A checked description.
#[pyclass(frozen)]
pub struct Gearbox(pub Arc<api::Gearbox>);

#[pymethods]
impl Gearbox {
    /// Reads a file and the files that it extends.
    #[staticmethod]
    pub fn read(py: Python<'_>, file: PathBuf) -> PyResult<Self> {
        let language = language(py)?;
        let read = py.detach(|| api::Gearbox::read(language, &file));
        Ok(Self(Arc::new(read.map_err(|found| raised(py, &found))?)))
    }

    /// Reads a text, in YAML or JSON; `folder` contains the files that it names.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: &str, name: &str, folder: PathBuf) -> PyResult<Self> {
        let read = api::Gearbox::of_text(language(py)?, text, name, folder);
        Ok(Self(Arc::new(read.map_err(|found| raised(py, &found))?)))
    }

    /// Reads a document of dicts and lists.
    #[staticmethod]
    fn from_document(py: Python<'_>, document: &Bound<'_, PyAny>, folder: PathBuf) -> PyResult<Self> {
        let text = format!("{:#}", json::from_python(document)?);
        Self::from_text(py, &text, "document", folder)
    }

    /// Title; `None` without one.
    #[getter]
    fn title(&self) -> Option<&str> {
        self.0.value["title"].as_str()
    }

    /// Builds a transmission: name of a model set, and overrides of resolved paths.
    fn transmission(
        &self,
        py: Python<'_>,
        models: Option<&str>,
        overrides: Vec<(String, Bound<'_, PyAny>)>,
    ) -> PyResult<Transmission> {
        let mut choice = models
            .filter(|set| *set != OWN_MODELS)
            .map_or_else(api::Choice::default, api::Choice::of_set);
        for (path, value) in overrides {
            choice = choice.with(path, json::from_python(&value)?);
        }
        let language = language(py)?;
        let gearbox = Arc::clone(&self.0);
        let built = py.detach(move || {
            let resolved = gearbox.resolve(language, &choice)?;
            let built = gearbox.build(language, &resolved)?;
            Ok(Transmission {
                gearbox,
                choice,
                resolved,
                built,
            })
        });
        built.map_err(|found: api::Findings| raised(py, &found))
    }
}

/// A gearbox with its models, ready to be solved.
#[pyclass(frozen)]
pub struct Transmission {
    pub gearbox: Arc<api::Gearbox>,
    pub choice: api::Choice,
    pub resolved: api::Resolved,
    pub built: api::Transmission,
}

#[pymethods]
impl Transmission {
    /// Names of the gear states.
    #[getter]
    fn gears(&self) -> Vec<&str> {
        self.built.states().iter().map(|state| state.name.as_str()).collect()
    }

    /// Names of the ports; the first is the reference port.
    #[getter]
    fn ports(&self) -> Vec<&str> {
        let reference = self.built.reference_port();
        let ports = self.built.ports();
        let others = ports.iter().enumerate().filter(|(i, _)| *i != reference);
        std::iter::once(&ports[reference])
            .chain(others.map(|(_, port)| port))
            .map(|port| port.name.as_str())
            .collect()
    }

    /// Paths of the components.
    #[getter]
    fn parts(&self) -> Vec<&str> {
        self.built.parts().iter().map(|part| part.path.as_str()).collect()
    }

    /// The resolved description: every value, in SI units as the program keeps them.
    fn resolved(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        json::to_python(py, &self.resolved.value)
    }

    /// Formulas, defaults and data that the results depend on, the lowest grade of evidence first.
    fn evidence(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let is_written = |path: &str| self.gearbox.places.is_written(path);
        json::to_python(py, &json!(evidence(&self.built, &self.resolved, &is_written)))
    }

    /// Warnings about the description.
    fn warnings(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let list = self.built.warnings.clone();
        json::to_python(py, &self.gearbox.findings(list))
    }

    /// Solves one operating point.
    fn solve(slf: Py<Self>, py: Python<'_>, request: Request<'_>) -> PyResult<Solution> {
        Solution::new(py, slf, request)
    }

    /// The text of `gearloss explain` for a component.
    fn explain(&self, py: Python<'_>, part: &str, request: Request<'_>) -> PyResult<String> {
        crate::point::explain(py, self, part, request)
    }

    /// Derivatives of a point over variables.
    fn derivatives(&self, py: Python<'_>, over: Vec<String>, request: Request<'_>) -> PyResult<Py<PyAny>> {
        let prepared = prepared(py, self, request)?;
        let derived = api::Derived {
            language: language(py)?,
            gearbox: &self.gearbox,
            choice: &self.choice,
            resolved: &self.resolved,
            transmission: &self.built,
            prepared: &prepared,
        };
        let all = py.detach(|| {
            let variables = over.iter().map(|text| api::Variable::from(text.as_str()));
            variables
                .map(|variable| derived.over(&variable))
                .collect::<Result<Vec<_>, _>>()
        });
        json::to_python(py, &all.map_err(|found| raised(py, &found))?)
    }

    /// Solves the points of a list: torques in Nm, speeds in rpm, oil temperatures in degC.
    fn points(
        &self,
        py: Python<'_>,
        torque: PyReadonlyArray1<'_, f64>,
        speed: PyReadonlyArray1<'_, f64>,
        oil_temperature: Option<PyReadonlyArray1<'_, f64>>,
        given: Given,
    ) -> PyResult<Table> {
        let field = points::list(py, torque, speed, oil_temperature)?;
        points::solve(py, self, field, None, given)
    }

    /// Solves every torque in Nm at every speed in rpm; speeds vary fastest.
    fn map(
        &self,
        py: Python<'_>,
        torque: PyReadonlyArray1<'_, f64>,
        speed: PyReadonlyArray1<'_, f64>,
        oil_temperature: Option<f64>,
        given: Given,
    ) -> PyResult<Table> {
        let field = points::grid(py, torque, speed)?;
        points::solve(py, self, field, oil_temperature, given)
    }
}
