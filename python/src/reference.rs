//! Models and schemas.

use gearloss::framework::language::{Kind, LUBRICANTS, MATERIALS};
use gearloss::report::check::CheckRecord;
use gearloss::report::models::ModelsRecord;
use gearloss::report::point::PointRecord;
use gearloss::studies::results::schema_of;
use pyo3::prelude::*;

use crate::errors::{language, wrong};
use crate::json;

/// The linked models with parameters, ranges and evidence, as `gearloss models --format json` lists them.
#[pyfunction]
pub fn models(py: Python<'_>) -> PyResult<Py<PyAny>> {
    json::to_python(py, &ModelsRecord::new(language(py)?, None, None))
}

/// Rows of the shipped catalogue of `bearings`, `oils` or `materials` whose designations contain a text.
#[pyfunction]
pub fn catalogue(py: Python<'_>, of: &str, text: &str) -> PyResult<Py<PyAny>> {
    let section = match of {
        "bearings" => "bearings",
        "oils" => LUBRICANTS,
        "materials" => MATERIALS,
        other => {
            let message = format!("there is no catalogue of `{other}`");
            return Err(wrong(
                py,
                gearloss::framework::codes::UNKNOWN_NAME,
                message,
                "give bearings, oils or materials",
            ));
        }
    };
    let hits = language(py)?
        .catalogue(section)
        .map(|all| all.search(text, section == "bearings"));
    let rows = hits.into_iter().flat_map(|hits| hits.rows);
    let rows = rows.map(|(designation, row)| {
        let mut all = serde_json::Map::from_iter([("designation".to_owned(), designation.into())]);
        all.extend(row.values);
        all.extend([
            ("confidence".to_owned(), row.confidence.into()),
            ("basis".to_owned(), row.basis.into()),
        ]);
        all
    });
    json::to_python(py, &rows.collect::<Vec<_>>())
}

/// The JSON Schema of a kind of document: `gearbox`, `study`, `eval`, `result`, `point`, `check` or `models`.
#[pyfunction]
pub fn schema(py: Python<'_>, kind: &str) -> PyResult<Py<PyAny>> {
    let language = language(py)?;
    match kind {
        "gearbox" => json::to_python(py, &language.published(Kind::Gearbox)),
        "study" => json::to_python(py, &language.published(Kind::Study)),
        "eval" => json::to_python(py, &language.published(Kind::Eval)),
        "result" => json::to_python(py, &gearloss::studies::results::schema()),
        "point" => json::to_python(py, &schema_of::<PointRecord>()),
        "check" => json::to_python(py, &schema_of::<CheckRecord>()),
        "models" => json::to_python(py, &schema_of::<ModelsRecord>()),
        other => Err(wrong(
            py,
            gearloss::framework::codes::UNKNOWN_NAME,
            format!("there is no schema `{other}`"),
            "give one of gearbox, study, eval, result, point, check, models",
        )),
    }
}
