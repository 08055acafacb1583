//! `check`: reads, resolves and builds; reports all errors.

use std::collections::BTreeSet;
use std::path::Path;

use gearloss_framework::document::read_yaml;
use gearloss_framework::files::{Disk, LONGEST_TEXT, read_text};
use gearloss_framework::gearbox::{DocumentKind, Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::registry::Evidence;
use gearloss_report::check::{CheckRecord, FileRecord, checked_text, resolved_text, torque_orders_text};
use gearloss_studies::analyses::Stopped;
use gearloss_studies::checked::CheckedGearbox;
use gearloss_studies::checked_study::{CheckedStudy, built_again};
use gearloss_studies::corpus::{Corpus, Set};
use gearloss_studies::engine::progress::{Progress, Silent, Steps};

use super::set;
use crate::args::{CheckArgs, ChoiceArgs, Format};
use crate::interrupt;
use crate::output::{End, Failure, Out};

pub fn run(args: &CheckArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let deny = args.deny.as_deref().map(Evidence::of_name).transpose()?;
    if args.format == Format::Json {
        return print_json(language, args, deny, out);
    }
    let mut wrong = String::new();
    let mut shown = BTreeSet::new();
    let mut end = End::Fine;
    for file in &args.files {
        if file.is_dir() {
            belongs_to_gearboxes(args, file)?;
            match Corpus::read(language, &Disk::shared(), file) {
                Ok(corpus) => out.text(&corpus_text(&corpus, file))?,
                Err(list) => list
                    .iter()
                    .for_each(|findings| wrong.push_str(&findings.render_new(&mut shown))),
            }
            continue;
        }
        if is_study(file) {
            belongs_to_gearboxes(args, file)?;
            let looked = CheckedStudy::read(language, &Disk::shared(), file, &UntilInterrupted);
            for findings in &looked.warnings {
                for warning in &findings.list {
                    out.text(&format!("{}\n\n", findings.sources.render(warning)))?;
                }
            }
            if looked.refused.is_empty() {
                out.line(format!("{}: fine", file.display()))?;
            }
            for (analysis, work) in looked.plans.iter().filter(|_| args.plan) {
                for part in work {
                    out.line(format!("  {analysis}: {part}"))?;
                }
            }
            if args.plan && looked.refused.is_empty() {
                for (analysis, samples) in built_again(language, &Disk::shared(), file) {
                    for sample in samples {
                        out.line(format!("  {analysis}: {sample}"))?;
                    }
                }
            }
            for note in &looked.notes {
                out.line(format!("  note: {note}"))?;
            }
            for stopped in looked.refused {
                let failure = Failure::from(stopped);
                match failure.text() {
                    Some(text) => wrong.push_str(&text),
                    None => return Err(failure),
                }
            }
            continue;
        }
        match gearbox(language, file, args) {
            Ok((text, weakest)) => {
                out.text(&text)?;
                if deny.is_some_and(|deny| weakest.is_some_and(|w| w >= deny)) {
                    end = End::Finding;
                    out.line(format!(
                        "  error (--deny {}): a result depends on evidence of this grade or lower",
                        args.deny.as_deref().unwrap_or_default()
                    ))?;
                }
            }
            Err(findings) => wrong.push_str(&findings.render_new(&mut shown)),
        }
    }
    if wrong.is_empty() {
        Ok(end)
    } else {
        Err(Failure::Input(wrong))
    }
}

/// Prints one document for all files. Errors appear in the document and in the exit code, not on standard error.
fn print_json(language: &Language, args: &CheckArgs, deny: Option<Evidence>, out: &mut Out) -> Result<End, Failure> {
    let mut end = End::Fine;
    let mut wrong = false;
    let mut files = Vec::new();
    for file in &args.files {
        let name = file.display().to_string();
        let record = if file.is_dir() {
            belongs_to_gearboxes(args, file)?;
            FileRecord::of_corpus(name, Corpus::read(language, &Disk::shared(), file))
        } else if is_study(file) {
            belongs_to_gearboxes(args, file)?;
            let study = CheckedStudy::read(language, &Disk::shared(), file, &UntilInterrupted);
            if study
                .refused
                .iter()
                .any(|stopped| matches!(stopped, Stopped::Interrupted))
            {
                return Err(Failure::Interrupted);
            }
            FileRecord::of_study(name, study)
        } else {
            FileRecord::of_gearbox(name, checked(language, file, &args.choice), args.resolved, deny)
        };
        if record.is_denied() {
            end = End::Finding;
        }
        wrong |= !record.fine;
        files.push(record);
    }
    out.json(&CheckRecord::new(language, files))?;
    if wrong {
        Err(Failure::Input(String::new()))
    } else {
        Ok(end)
    }
}

/// Rejects options that do not apply to a study.
fn belongs_to_gearboxes(args: &CheckArgs, file: &Path) -> Result<(), Failure> {
    let given = [
        ("--set", !args.choice.set.is_empty()),
        ("--models", args.choice.models.is_some()),
        ("--resolved", args.resolved),
        ("--deny", args.deny.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::input(
            if file.is_dir() {
                format!("{option} does not apply to {}, which is a folder", file.display())
            } else {
                format!("{option} does not apply to {}, which is a study", file.display())
            },
            format!("use {option} with a gearbox, or check without it"),
        )),
        None => Ok(()),
    }
}

/// One line for each set.
fn corpus_text(corpus: &Corpus, folder: &Path) -> String {
    let line = |set: &Set| {
        let rows = set
            .rows
            .map_or_else(|| "no data".to_owned(), |rows| format!("{rows} rows"));
        let judges = match &set.source.needs {
            Some(needs) => format!("needs: {needs}"),
            None => "judges models".to_owned(),
        };
        format!("  {}: {}, {rows}, {judges}\n", set.name, set.source.kind.words())
    };
    let lines: String = corpus.sets.iter().map(line).collect();
    let count = corpus.sets.len();
    let sets = if count == 1 { "set" } else { "sets" };
    format!("{}: fine, {count} {sets}\n{lines}", folder.display())
}

/// No progress, until Ctrl-C.
pub(super) struct UntilInterrupted;

impl Progress for UntilInterrupted {
    fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_> {
        Silent.begin(label, count)
    }

    fn should_continue(&self) -> bool {
        !interrupt::pressed()
    }
}

fn is_study(file: &Path) -> bool {
    let text = read_text(file, LONGEST_TEXT).unwrap_or_default();
    let node = read_yaml(0, &text).node;
    let stated = node.get("gearloss").and_then(|n| n.text());
    DocumentKind::of(stated, |key| node.get(key).is_some()) == DocumentKind::Study
}

/// A gearbox, read with all its model sets, resolved and built.
fn checked(language: &Language, file: &Path, choice: &ChoiceArgs) -> Result<CheckedGearbox, Findings> {
    let gearbox = Gearbox::read(language, file)?;
    gearbox.check_sets(language)?;
    let resolved = set::resolve(language, &gearbox, choice)?;
    CheckedGearbox::new(language, gearbox, resolved)
}

fn gearbox(language: &Language, file: &Path, args: &CheckArgs) -> Result<(String, Option<Evidence>), Findings> {
    let checked = checked(language, file, &args.choice)?;
    let name = file.display().to_string();
    let text = if args.resolved {
        resolved_text(language, &name, &checked)?
    } else {
        let orders = if args.plan {
            torque_orders_text(&checked)
        } else {
            String::new()
        };
        checked_text(&name, &checked) + &orders
    };
    Ok((text, checked.lowest_evidence()))
}
