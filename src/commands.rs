//! The commands, one file each.

pub mod check;
pub mod eval;
pub mod explain;
pub mod fit;
pub mod import;
pub mod merge;
pub mod models;
mod needs;
mod network;
pub mod new;
mod point;
pub mod run;
pub mod schema;
pub mod solve;

use std::sync::OnceLock;

use gearloss_framework::document::{Sources, read_yaml};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;

use crate::args::ChoiceArgs;
use crate::output::{Failure, Out};

/// The language of everything that is linked into the program, put together once however many commands it runs.
fn language() -> Result<&'static Language, Failure> {
    static LINKED: OnceLock<Language> = OnceLock::new();
    if LINKED.get().is_none() {
        // Of two threads that come here at once the first one's stays.
        let _ = LINKED.set(Language::linked()?);
    }
    let bug = || Failure::input("bug: the language was put together and is not there", "report this");
    LINKED.get().ok_or_else(bug)
}

/// Models and overrides from the arguments.
fn choice(args: &ChoiceArgs) -> Result<Choice, Failure> {
    let mut overrides = Vec::new();
    for text in &args.set {
        let Some((path, value)) = text.split_once('=') else {
            return Err(Failure::input(
                format!("--set {text}: no `=`"),
                "write --set PATH=VALUE",
            ));
        };
        let mut sources = Sources::default();
        let source = sources.add(format!("--set {path}"), value);
        let read = read_yaml(source, value.trim());
        if !read.findings.is_empty() {
            return Err(Findings {
                list: read.findings,
                sources,
            }
            .into());
        }
        overrides.push((path.trim().to_owned(), read.node.to_json()));
    }
    Ok(Choice {
        set: args.models.clone(),
        overrides,
        ..Choice::default()
    })
}

/// Prints what was noticed while building, to standard error.
fn warn(gearbox: &Gearbox, transmission: &Transmission) -> Result<(), Failure> {
    for warning in &transmission.warnings {
        Out::error().line(format!("{}\n", gearbox.sources.render(warning)))?;
    }
    Ok(())
}
