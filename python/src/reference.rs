//! Models and schemas.

use gearloss::framework::language::Kind;
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
