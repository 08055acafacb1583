//! A part of a study for distributed computation: `run --shard K/N`, and `merge`.

use std::fs;
use std::path::{Path, PathBuf};

use gearloss_framework::language::Language;
use gearloss_studies::analyses::{Planner, Stopped};
use gearloss_studies::study::Study;
use gearloss_studies::table::DiscardedRows;

use super::console::Shown;
use super::manifest::{MANIFEST, Manifest};
use super::runner::Run;
use super::shard_tasks::ShardTasks;
use crate::args::RunArgs;
use crate::interrupt;
use crate::output::{End, Failure, Out};
use crate::shard::Shard;

/// Computes the tasks of a shard; continues an interrupted run.
pub fn run(language: &Language, study: &Study, shard: Shard, args: &RunArgs, out: &mut Out) -> Result<End, Failure> {
    let beside = study.folder.join("shards");
    let folder_of_shard = || beside.join(format!("{}-of-{}", shard.number, shard.of));
    let folder = args.results.output.clone().unwrap_or_else(folder_of_shard);
    let manifest = Manifest::for_shard(language, study, shard);
    let held = manifest.claim(&folder)?;
    // Finished results of other shards allow later stages.
    let mut others = if args.results.output.is_none() {
        folders(&beside)
    } else {
        Vec::new()
    };
    others.retain(|other| *other != folder && manifest.is_of_splitting(other));
    interrupt::listen();
    let tasks = ShardTasks::of_shard(study, shard, &folder, &others)?;
    let run = Run::new(language, study, folder.clone(), Some(&tasks), Shown::Nothing);
    let failed = compute(&run);
    // The same command continues an interrupted run.
    held.finish();
    let (computed, before) = tasks.counts();
    let words = format!(
        "shard {shard}: {} tasks in {}, {before} of them from an earlier run",
        computed + before,
        folder.display()
    );
    match failed {
        Err(fault) => {
            Out::error().line(words)?;
            return Err(fault);
        }
        Ok(failed) => {
            manifest.finish(&folder, computed + before)?;
            out.line(words)?;
            if failed > 0 {
                out.line(format!(
                    "{failed} analyses failed; `gearloss merge` runs them again and reports why"
                ))?;
            }
        }
    }
    Ok(End::Fine)
}

/// Computes the shard's tasks of all analyses; returns the number of failed analyses.
fn compute(run: &Run<'_>) -> Result<usize, Failure> {
    let mut failed = 0;
    for (name, analysis) in run.study.entry.analyses.iter() {
        let study = run.analyses.study_for_analysis();
        // It depends on an analysis whose results are incomplete.
        if study.pending(analysis).is_some() {
            continue;
        }
        let planner = Planner::new(run.language, &study, name);
        match run.analyses.run(&run.engine(&planner).with_sink(&DiscardedRows)) {
            Err(Stopped::Found(findings)) => {
                Out::error().text(&findings.render())?;
                failed += 1;
            }
            Ok(_) | Err(Stopped::Elsewhere) => {}
            Err(stopped) => return Err(stopped.into()),
        }
    }
    Ok(failed)
}

/// Results of all shards of a study, if none is missing; without `folders` those in `shards` next to the study.
pub fn gather(language: &Language, study: &Study, named: &[PathBuf], file: &Path) -> Result<ShardTasks, Failure> {
    let folders = if named.is_empty() {
        beside(study)?
    } else {
        named.to_vec()
    };
    let manifest = Manifest::for_shard(language, study, Shard { number: 0, of: 0 });
    let mut first: Option<(usize, &Path)> = None;
    let mut finished = Vec::new();
    for folder in &folders {
        let (shard, results) = manifest.suits(folder)?;
        let (count, of_first) = *first.get_or_insert((shard.of, folder));
        if shard.of != count {
            return Err(Failure::input(
                format!(
                    "{} belongs to {count} shards, {} to {}",
                    of_first.display(),
                    folder.display(),
                    shard.of
                ),
                "give folders of shards with the same N",
            ));
        }
        if results.is_some_and(|results| ShardTasks::count(study, folder) >= results) {
            finished.push(shard.number);
        }
    }
    let of = first.map_or(1, |(of, _)| of);
    let missing: Vec<String> = (1..=of)
        .filter(|number| !finished.contains(number))
        .map(|number| format!("{number}/{of}"))
        .collect();
    if missing.is_empty() {
        return ShardTasks::of_merge(study, &folders);
    }
    Err(Failure::input(
        format!("missing or unfinished: shard {}", missing.join(", ")),
        format!(
            "run `gearloss run {} --shard {}`{}, then merge",
            file.display(),
            missing[0],
            if missing.len() > 1 { " and so on" } else { "" }
        ),
    ))
}

/// The folders of shards next to a study.
fn beside(study: &Study) -> Result<Vec<PathBuf>, Failure> {
    let folder = study.folder.join("shards");
    let found = folders(&folder);
    if found.is_empty() {
        return Err(Failure::input(
            format!("{} contains no shard", folder.display()),
            "give the folders of the shards, or run `gearloss run STUDY --shard K/N` first",
        ));
    }
    Ok(found)
}

/// Folders of shards in a folder.
fn folders(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> = entries
        .map(|e| e.path())
        .filter(|f| f.join(MANIFEST).is_file())
        .collect();
    found.sort();
    found
}
