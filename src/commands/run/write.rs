//! Files of results.

use std::fs;
use std::io::{self, Write as _};

use gearloss_framework::document::visible_json;
use gearloss_report::Figure;
use gearloss_report::html::{self, Frame};
use gearloss_report::xlsx;
use gearloss_studies::analyses::{Outcome, Planner};
use gearloss_studies::table::Table;
use serde_json::Value;

use super::result_files::Place;
use super::runner::{Run, Runner};
use super::template::Template;
use crate::output::Failure;

/// Writes an outcome as JSON.
pub fn outcome(runner: &Runner<'_>, outcome: &dyn Outcome) -> Result<(), Failure> {
    let (place, mut file) = Place::new(&runner.run.files, &format!("{}.json", runner.name))?;
    let written = outcome.write_json(&mut file).map_err(std::io::Error::from);
    let written = written.and_then(|()| file.write_all(b"\n")).and_then(|()| file.flush());
    Ok(place.done(written)?)
}

/// Writes the tables of an outcome as a workbook.
pub fn workbook(run: &Run<'_>, name: &str, tables: &[Table]) -> Result<(), Failure> {
    let book = run.in_section(|section| xlsx::workbook(section, tables));
    let Some(book) = book else { return Ok(()) };
    let bytes = book.map_err(|error| Failure::input(error, "write Parquet, or use a coarser grid"))?;
    keep(run, &format!("{name}.xlsx"), Ok(bytes))
}

/// Name of the report.
pub const REPORT: &str = "report.html";

/// Name of its content, of which `gearloss report` makes it again.
pub const CONTENT: &str = "report.content";

/// Writes the page and its content into the folder of the results.
pub fn report(run: &Run<'_>, template: Option<&Template>) -> Result<(), Failure> {
    let study = run.analyses.study_for_analysis();
    let mut report = run.report.borrow_mut();
    report.complete(&Planner::new(run.language, &study, "report"))?;
    let frame = Frame::new(run.study, run.language, env!("CARGO_PKG_VERSION"));
    let content = serde_json::to_value(report.content(&frame));
    let content =
        content.map_err(|fault| Failure::input(format!("the report cannot be encoded: {fault}"), "report this"))?;
    keep(
        run,
        CONTENT,
        Ok(visible_json(&content.to_string()).into_owned().into_bytes()),
    )?;
    keep(run, REPORT, Ok(page(content, template)?))
}

/// The page of this content.
pub fn page(content: Value, template: Option<&Template>) -> Result<Vec<u8>, Failure> {
    match template {
        Some(template) => template.fill(&content),
        None => Ok(html::page(content)?.into_bytes()),
    }
}

/// Removes files of an earlier run of an analysis, which could be mistaken for current results. Files of this run are kept: an analysis may
/// fail in part.
pub fn remove(runner: &Run<'_>, name: &str) {
    for kind in ["csv", "json", "parquet", "xlsx"] {
        let file = format!("{name}.{kind}");
        if !runner.files.has(&file) {
            let _ = fs::remove_file(runner.files.folder.join(file));
        }
    }
}

/// Writes a figure as SVG.
pub fn picture(run: &Run<'_>, name: &str, figure: &Figure) -> Result<(), Failure> {
    // A product precedes its set with a slash.
    let file = format!("{}.svg", name.replace('/', "-"));
    keep(
        run,
        &file,
        figure.svg().map(String::into_bytes).map_err(io::Error::other),
    )
}

/// Writes a result file completely, or reports an error.
pub fn keep(runner: &Run<'_>, file: &str, bytes: io::Result<Vec<u8>>) -> Result<(), Failure> {
    let (place, mut to) = Place::new(&runner.files, file)?;
    let written = bytes.and_then(|bytes| to.write_all(&bytes).and_then(|()| to.flush()));
    Ok(place.done(written)?)
}
