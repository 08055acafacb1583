//! One operating point.

use gearloss::api::{OilTemperature, PowerFlow};
use gearloss::framework::thermal::Outcome;
use gearloss::report::point::{Explained, PointRecord, point_text, ratings_text};
use gearloss::studies::points::{PreparedPoint, SolvedPoint};
use gearloss::studies::ratings::{RatedComponent, rated};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{language, raised, wrong};
use crate::gearbox::Transmission;
use crate::json;
use crate::quantity::unit;

/// A point as it is asked for: torques in Nm and speeds in rpm by port, the oil temperature in degC.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Request<'py> {
    gear: Option<String>,
    torque: Bound<'py, PyDict>,
    speed: Bound<'py, PyDict>,
    oil_temperature: Option<f64>,
    ideal: bool,
}

/// The gear state that is asked for, or the only one.
pub fn gear_of(py: Python<'_>, t: &Transmission, gear: Option<String>) -> PyResult<String> {
    let states = t.built.states();
    match (gear, states) {
        (Some(gear), _) => Ok(gear),
        (None, [only]) => Ok(only.name.clone()),
        (None, states) => {
            let names: Vec<&str> = states.iter().map(|state| state.name.as_str()).collect();
            Err(wrong(
                py,
                gearloss::framework::codes::GIVEN,
                "no gear is given",
                &format!("give `gear` as one of {}", names.join(", ")),
            ))
        }
    }
}

/// Oil temperature of a request: given, or as the gearbox states it.
pub fn oil_of(py: Python<'_>, t: &Transmission, given: Option<f64>) -> PyResult<OilTemperature> {
    if let Some(given) = given
        && !(-60.0..=250.0).contains(&given)
    {
        let message = format!("{given} degC is not a valid oil temperature");
        return Err(wrong(
            py,
            gearloss::document::codes::OUT_OF_BOUNDS,
            message,
            "give a temperature from -60 to 250 degC",
        ));
    }
    Ok(OilTemperature::from_conditions(&t.built, given))
}

/// Real flow, or ideal flow.
pub fn flow(ideal: bool) -> PowerFlow {
    if ideal { PowerFlow::Ideal } else { PowerFlow::Real }
}

/// Port and value of each entry.
fn by_port(given: &Bound<'_, PyDict>) -> PyResult<Vec<(String, f64)>> {
    given
        .iter()
        .map(|(port, value)| Ok((port.extract()?, value.extract()?)))
        .collect()
}

/// The point of a request.
pub fn prepared(py: Python<'_>, t: &Transmission, request: Request<'_>) -> PyResult<PreparedPoint> {
    let gear = gear_of(py, t, request.gear)?;
    let (torques, speeds) = (by_port(&request.torque)?, by_port(&request.speed)?);
    let finite = torques.iter().chain(&speeds).find(|(_, value)| !value.is_finite());
    if let Some((port, value)) = finite {
        return Err(wrong(
            py,
            gearloss::document::codes::OUT_OF_BOUNDS,
            format!("{value} at port `{port}` is not finite"),
            "give a number",
        ));
    }
    let names = |list: &[(String, f64)]| list.iter().map(|port| port.0.clone()).collect::<Vec<String>>();
    let (torque_at, speed_at) = (names(&torques), names(&speeds));
    let strs = |list: &[String]| list.iter().map(String::as_str).collect::<Vec<&str>>().join(", ");
    let state = t.built.state(&gear).map_err(|error| raised(py, &error.into()))?;
    let needed = t.built.torques_needed(state);
    if torques.len() < needed {
        let ports: Vec<&str> = t.built.ports().iter().map(|port| port.name.as_str()).collect();
        let message = format!("gear `{gear}` needs {needed} given torque, not {}", torques.len());
        let help = format!(
            "give `torque` at one of {}; it is given at: {}",
            ports.join(", "),
            strs(&torque_at)
        );
        return Err(wrong(py, gearloss::framework::codes::GIVEN, message, &help));
    }
    if speeds.is_empty() {
        return Err(wrong(
            py,
            gearloss::framework::codes::GIVEN,
            "no speed is given",
            "give `speed`, in rpm, or a dict of ports",
        ));
    }
    let torque_ports: Vec<&str> = torque_at.iter().map(String::as_str).collect();
    let speed_ports: Vec<&str> = speed_at.iter().map(String::as_str).collect();
    let case = t.built.case(&gear, &speed_ports, &torque_ports);
    Ok(PreparedPoint {
        case: case.map_err(|list| raised(py, &list.into()))?,
        gear,
        speeds: speeds.iter().map(|port| unit("rpm").to_si(port.1)).collect(),
        torques: torques.iter().map(|port| port.1).collect(),
        oil: oil_of(py, t, request.oil_temperature)?,
        flow: flow(request.ideal),
    })
}

/// A solved point.
#[pyclass(frozen)]
pub struct Solution {
    transmission: Py<Transmission>,
    prepared: PreparedPoint,
    /// Sum of all losses in W; `None` if it has no value.
    #[pyo3(get)]
    loss: Option<f64>,
    /// Output power over input power.
    #[pyo3(get)]
    efficiency: Option<f64>,
    /// Oil temperature in degC; `None` if it has no value.
    #[pyo3(get)]
    oil_temperature: Option<f64>,
    /// Outcome of the heat balance or the thermal network; `None` if the temperature is given.
    #[pyo3(get)]
    balance: Option<&'static str>,
    /// State of the transmission, such as `drive`.
    #[pyo3(get)]
    status: &'static str,
    /// Power out of the DC link in W; `None` without machines.
    #[pyo3(get)]
    dc_power: Option<f64>,
    /// Losses of the machines in W, with what their maps contain; `None` without machines.
    #[pyo3(get)]
    machine_loss: Option<f64>,
    /// Losses of inverters that are described apart in W; `None` without machines.
    #[pyo3(get)]
    inverter_loss: Option<f64>,
    /// Losses of gearbox, machines and inverters in W; `None` without machines.
    #[pyo3(get)]
    unit_loss: Option<f64>,
    /// Power at the other ports over the power of the DC link; `None` without machines.
    #[pyo3(get)]
    system_efficiency: Option<f64>,
    watts: Vec<f64>,
}

impl Solution {
    pub fn new(py: Python<'_>, transmission: Py<Transmission>, request: Request<'_>) -> PyResult<Self> {
        let t = transmission.get();
        let prepared = prepared(py, t, request)?;
        let mut scratch = t.built.scratch(&prepared.case);
        let solved = prepared.solve(&t.built, &mut scratch);
        let (solution, found, unit) = (&solved.solution, &solved.found, solved.unit());
        let sound = found.is_sound() && solution.has_flow();
        let point = Self {
            loss: solution.loss().filter(|_| sound),
            efficiency: solution.efficiency().filter(|_| sound),
            oil_temperature: Some(found.oil).filter(|_| found.is_sound()),
            balance: found.outcome().map(Outcome::name),
            status: solution.status().name(),
            dc_power: unit.map(|unit| unit.dc_power_w),
            machine_loss: unit.map(|unit| unit.machine_loss_w),
            inverter_loss: unit.map(|unit| unit.inverter_loss_w),
            unit_loss: unit.map(|unit| unit.unit_loss_w),
            system_efficiency: unit.and_then(|unit| unit.system_efficiency),
            watts: solution
                .parts()
                .map(|(_, loss)| loss.watts())
                .filter(|_| sound)
                .collect(),
            transmission: transmission.clone_ref(py),
            prepared,
        };
        Ok(point)
    }
}

#[pymethods]
impl Solution {
    /// Loss of each component in W, by path; empty if the point has no value.
    #[getter]
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let parts = PyDict::new(py);
        let t = self.transmission.get();
        for (part, watts) in t.built.parts().iter().zip(&self.watts) {
            parts.set_item(&part.path, watts)?;
        }
        Ok(parts)
    }

    /// Ratings of the components: lives, safeties, films, temperatures.
    #[getter]
    fn ratings(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let t = self.transmission.get();
        let mut scratch = t.built.scratch(&self.prepared.case);
        let solved = self.prepared.solve(&t.built, &mut scratch);
        json::to_python(py, &rated_of(py, t, &solved)?)
    }

    /// Everything that `gearloss solve --format json` states.
    fn to_dict(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let t = self.transmission.get();
        let mut scratch = t.built.scratch(&self.prepared.case);
        let solved = self.prepared.solve(&t.built, &mut scratch);
        let record = PointRecord::new(
            language(py)?,
            (&t.gearbox, &t.resolved, &t.built),
            &self.prepared,
            &solved,
        );
        let record = record.map_err(|findings| raised(py, &findings))?;
        json::to_python(py, &record)
    }

    /// The tables of `gearloss solve`.
    fn text(&self, py: Python<'_>) -> PyResult<String> {
        let t = self.transmission.get();
        let mut scratch = t.built.scratch(&self.prepared.case);
        let solved = self.prepared.solve(&t.built, &mut scratch);
        Ok(point_text(&t.built, &self.prepared, &solved) + &ratings_text(&rated_of(py, t, &solved)?))
    }

    fn __repr__(&self) -> String {
        let number = |x: Option<f64>| x.map_or_else(|| "None".to_owned(), |x| x.to_string());
        format!(
            "Solution(loss={}, efficiency={}, oil_temperature={}, status='{}')",
            number(self.loss),
            number(self.efficiency),
            number(self.oil_temperature),
            self.status
        )
    }
}

fn rated_of(py: Python<'_>, t: &Transmission, solved: &SolvedPoint<'_>) -> PyResult<Vec<RatedComponent>> {
    let ratings = t.gearbox.ratings(language(py)?, &t.resolved, &t.built);
    let ratings = ratings.map_err(|findings| raised(py, &findings))?;
    Ok(rated(&ratings, &t.built, &solved.solution))
}

/// Every step of the loss of a component.
pub fn explain(py: Python<'_>, t: &Transmission, part: &str, request: Request<'_>) -> PyResult<String> {
    let explained = Explained::named(&t.built, part).map_err(|error| {
        let error = error.code(gearloss::framework::codes::UNKNOWN_NAME);
        raised(py, &error.into())
    })?;
    let prepared = prepared(py, t, request)?;
    let mut scratch = t.built.scratch(&prepared.case);
    let solved = prepared.solve(&t.built, &mut scratch);
    let ratings = t.gearbox.ratings(language(py)?, &t.resolved, &t.built);
    let ratings = ratings.map_err(|findings| raised(py, &findings))?;
    Ok(explained.text((&t.gearbox, &t.resolved, &t.built), &ratings, &prepared, &solved))
}
