//! `run`: the analyses of a study; tables on the terminal, CSV and JSON in files.

mod console;
mod folder;
mod manifest;
mod result_files;
mod runner;
mod shard;
mod shard_tasks;
mod table;
mod task_file;
mod template;
mod write;

pub(super) use shard::gather;
pub(super) use template::Template;
pub(super) use write::{CONTENT, REPORT, page};

use self::console::Shown;
use self::folder::Held;
use self::runner::Run;

use std::path::{Path, PathBuf};
use std::time::Instant;

use gearloss_framework::language::Language;
use gearloss_report::html::measurements;
use gearloss_report::text::with_printed_units;
use gearloss_studies::checked_study::Reported;
use gearloss_studies::distinct::distinct;
use gearloss_studies::study::{Cautions, Study};
use gearloss_studies::tasks::TaskResults;

use super::browser;
use crate::args::{ResultArgs, RunArgs};
use crate::interrupt;
use crate::output::{End, Failure, Out};

pub fn run(args: &RunArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let study = read(language, &args.study)?;
    match args.shard {
        Some(shard) => shard::run(language, &study, shard, args, out),
        None => all(language, &study, None, &args.results, out),
    }
}

/// A study, checked.
pub(super) fn read(language: &Language, file: &Path) -> Result<Study, Failure> {
    let study = Study::read(language, file)?;
    study.check(language)?;
    Ok(study)
}

/// Runs all analyses and writes the report; uses the results of tasks that other processes have computed.
pub(crate) fn all(
    language: &Language,
    study: &Study,
    tasks: Option<&dyn TaskResults>,
    args: &ResultArgs,
    out: &mut Out,
) -> Result<End, Failure> {
    let folder = args.output.clone().unwrap_or_else(|| study.folder.join("results"));
    if let Some(wrong) = args.deny.iter().find(|what| *what != "extrapolation") {
        return Err(Failure::input(
            format!("--deny {wrong}: `run` accepts only `extrapolation`"),
            "write --deny extrapolation, or `check --deny GRADE` for evidence",
        ));
    }
    let template = args.template.as_deref().map(Template::read).transpose()?;
    let names: Vec<&str> = study.entry.analyses.ids().collect();
    let shown = Shown::new(args.shown);
    let held = claim(&folder, &names, args.force, shown, out)?;
    let runner = Run::new(language, study, folder, tasks, shown);
    head(language, study, shown, out)?;
    let width = Shown::width(&names);
    // Errors in files of points are printed once, not by every analysis that uses them.
    let mut reported = Reported::default();
    let wrong_data = study.data_findings();
    if let Some(findings) = &wrong_data {
        reported.add(findings);
        Out::error().text(&findings.render())?;
    }
    interrupt::listen();
    let (mut failed, mut done_so_far, mut finished) = (0, 0, None);
    let answers = |name: &str| study.entry.answered_by.iter().any(|analysis| analysis == name);
    for (name, analysis) in study.entry.analyses.iter() {
        let start = Instant::now();
        match runner.attempt(name, analysis, out) {
            Ok(()) => {
                let result = runner.in_section(|section| section.result_of_several());
                shown.headline((width, name), &result.unwrap_or_default(), answers(name), start, out)?;
            }
            Err(failure) => {
                let Some(text) = failure.text() else {
                    runner.report.borrow_mut().sections.pop();
                    finished = Some(done_so_far);
                    break;
                };
                // Finished analyses are kept.
                failed += 1;
                write::remove(&runner, name);
                shown.headline((width, name), "failed", answers(name), start, out)?;
                runner.report.borrow_mut().fail(text);
                if let Some(text) = unreported(&reported, failure) {
                    Out::error().text(&text)?;
                }
            }
        }
        done_so_far += 1;
    }
    shown.limits(width, &runner.broken.borrow(), out)?;
    if failed == 0 && finished.is_none() {
        for name in runner.limits_never_known(|_| true) {
            out.line(format!("note: no analysis knows the quantity of the limit `{name}`"))?;
        }
    }
    shown.outside(width, runner.report.borrow().stated_ranges(), out)?;
    write::report(&runner, template.as_ref())?;
    held.finish();
    let report = runner.files.folder.join(write::REPORT);
    shown.report(&report, out)?;
    // The results are there even if nothing can open them.
    if args.shown.open
        && let Some(text) = browser::open(&report).err().and_then(|failure| failure.text())
    {
        Out::error().text(&text)?;
    }
    if let Some(finished) = finished {
        let all = study.entry.analyses.len();
        Out::error().line(format!("{finished} of {all} analyses are finished and kept"))?;
        return Err(Failure::Interrupted);
    }
    if failed == 0 && !args.deny.is_empty() && runner.left.get() > 0 {
        out.line(format!(
            "error (--deny extrapolation): {} quantities outside their stated ranges",
            runner.left.get()
        ))?;
        return Ok(End::Finding);
    }
    let errors = runner.limits_not_kept();
    if failed == 0 && !errors.is_empty() {
        out.line(format!(
            "error: limits with `severity: error` are not kept: {}",
            errors.join(", ")
        ))?;
        return Ok(End::Finding);
    }
    if failed == 0 && wrong_data.is_some() {
        return Err(Failure::Input(
            "error: an unused measurement cannot be read, see above\n".to_owned(),
        ));
    }
    if failed == 0 {
        Ok(End::Fine)
    } else {
        Err(Failure::Input(format!(
            "error: {failed} of {} analyses failed\n",
            study.entry.analyses.len()
        )))
    }
}

/// Title and question of a study, and what its gearboxes and conditions give cause to say.
fn head(language: &Language, study: &Study, shown: Shown, out: &mut Out) -> Result<(), Failure> {
    if shown.has_headlines() {
        let texts = [&study.entry.title, &study.entry.question];
        for text in texts.into_iter().flatten() {
            out.line(with_printed_units(text))?;
        }
        for line in measurements(study) {
            out.line(line)?;
        }
        overridden(study, out)?;
    }
    let Cautions { warnings, notes } = study.cautions(language);
    // Gearboxes that extend the same file have its warnings in common.
    let rendered = warnings
        .iter()
        .flat_map(|findings| findings.list.iter().map(|warning| findings.sources.render(warning)));
    for warning in distinct(rendered) {
        Out::error().line(format!("{warning}\n"))?;
    }
    for note in notes.iter().filter(|_| shown.has_headlines()) {
        Out::error().line(format!("note: {note}"))?;
    }
    Ok(())
}

/// The text of a failure without what was reported before the analyses.
fn unreported(reported: &Reported, failure: Failure) -> Option<String> {
    match failure {
        Failure::Found(findings) => Some(reported.new_findings(findings)?.render()),
        other => other.text(),
    }
}

/// Notes that the conditions replace a temperature of a gearbox.
fn overridden(study: &Study, out: &mut Out) -> Result<(), Failure> {
    let Some(oil) = study.entry.conditions.oil_temperature else {
        return Ok(());
    };
    for (name, gearbox) in &study.gearboxes {
        let thermal = &gearbox.value["thermal"];
        let used = thermal["oil"].as_f64().filter(|used| (used - oil).abs() > 1e-9);
        let words = match (used, thermal["mode"].as_str()) {
            (_, Some("balance")) => "the heat balance of".to_owned(),
            (Some(used), _) if gearbox.places.is_written("thermal.oil") => format!("{used} °C of"),
            _ => continue,
        };
        out.line(format!(
            "note: `conditions.oil_temperature`, {oil} °C, replaces {words} gearbox `{name}`"
        ))?;
    }
    Ok(())
}

/// Claims the result folder before computation. A folder with other files than earlier results needs `--force`; earlier results are
/// replaced with a note. Results are files of the formats of this program, and files of any format with the name of an analysis
/// before a dot or a hyphen: those of exports in other crates.
fn claim(folder: &Path, analyses: &[&str], force: bool, shown: Shown, out: &mut Out) -> Result<Held, Failure> {
    let files: Vec<PathBuf> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .collect();
    let formats = [
        "csv",
        "json",
        "svg",
        "html",
        "content",
        "parquet",
        "xlsx",
        "vtlm",
        "m",
        "mo",
        "yaml",
        folder::PART,
    ];
    let written = |file: &PathBuf| {
        let format = file.extension().and_then(|format| format.to_str());
        let name = file.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let is_named = |analysis: &&str| {
            name.strip_prefix(analysis)
                .is_some_and(|rest| rest.starts_with(['.', '-']))
        };
        format.is_some_and(|format| formats.contains(&format))
            || analyses.iter().any(is_named)
            || file.ends_with(folder::MARK)
    };
    // Every run leaves a report, or the lock file of an unfinished run; a folder without them belongs to the user.
    let is_one = |file: &PathBuf| file.ends_with(write::REPORT) || file.ends_with(folder::MARK);
    let replace = !files.is_empty() && !force;
    if replace && !(files.iter().any(is_one) && files.iter().all(written)) {
        return Err(Failure::input(
            format!("{} contains files that are not results of a study", folder.display()),
            "choose another folder with -o, or use --force",
        ));
    }
    let (held, broken_off) = Held::take(folder)?;
    if !shown.has_headlines() {
        return Ok(held);
    }
    if broken_off {
        out.line(format!(
            "an earlier run into {} was interrupted; its files are replaced",
            folder.display()
        ))?;
    } else if replace {
        out.line(format!("replacing the results in {}", folder.display()))?;
    }
    Ok(held)
}
