//! `check`: reads, resolves and builds, and says everything that is wrong.

mod json;

use gearloss_framework::analysis::evidence;
use gearloss_framework::document::{Sources, read_yaml};
use gearloss_framework::files::{LONGEST_TEXT, read_text};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::registry::Evidence;
use gearloss_framework::study::Study;

use super::set;
use crate::args::{CheckArgs, ChoiceArgs, Format};
use crate::output::{End, Failure, Out};

pub fn run(args: &CheckArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let deny = match &args.deny {
        Some(name) => Some(grade(name)?),
        None => None,
    };
    if args.format == Format::Json {
        return json::run(language, args, deny, out);
    }
    let mut wrong = String::new();
    let mut end = End::Fine;
    for file in &args.files {
        let result = if is_study(file) {
            Study::read(language, file)
                .and_then(|study| study.check(language))
                .map(|()| format!("{}: fine\n", file.display()))
        } else {
            gearbox(language, file, &args.choice, args.resolved).map(|(text, weakest)| {
                if deny.is_some_and(|deny| weakest.is_some_and(|w| w >= deny)) {
                    end = End::Finding;
                    return text + &format!("  denied: {}\n", args.deny.as_deref().unwrap_or_default());
                }
                text
            })
        };
        match result {
            Ok(text) => out.text(&text)?,
            Err(findings) => wrong.push_str(&findings.render()),
        }
    }
    if wrong.is_empty() {
        Ok(end)
    } else {
        Err(Failure::Input(wrong))
    }
}

/// The grade of a name.
pub fn grade(name: &str) -> Result<Evidence, Failure> {
    Evidence::of_name(name).ok_or_else(|| {
        Failure::input(
            format!("no grade of evidence is called `{name}`"),
            "write several_sources, derived, one_source, user, recalled, reconstructed, disputed or assumed",
        )
    })
}

fn is_study(file: &std::path::Path) -> bool {
    let text = read_text(file, LONGEST_TEXT).unwrap_or_default();
    let node = read_yaml(0, &text).node;
    node.get("gearloss")
        .and_then(|n| n.text())
        .is_some_and(|kind| kind.starts_with("study"))
}

fn gearbox(
    language: &Language,
    file: &std::path::Path,
    choice: &ChoiceArgs,
    print: bool,
) -> Result<(String, Option<Evidence>), Findings> {
    let gearbox = Gearbox::read(language, file)?;
    let resolved = set::resolve(language, &gearbox, choice)?;
    let transmission = gearbox.build(language, &resolved)?;
    let known = evidence(&transmission, &resolved, &|path| gearbox.places.is_written(path));
    let weakest = known.first().map(|w| w.grade);
    let mut text = String::new();
    for warning in &transmission.warnings {
        text.push_str(&gearbox.sources.render(warning));
        text.push_str("\n\n");
    }
    if print {
        match serde_saphyr::to_string(&resolved.value) {
            Ok(yaml) => text.push_str(&yaml),
            Err(e) => {
                let error = gearloss_framework::document::Diagnostic::error("", format!("cannot write YAML: {e}"));
                return Err(Findings {
                    list: vec![error],
                    sources: Sources::default(),
                });
            }
        }
        return Ok((text, weakest));
    }
    let states: Vec<&str> = transmission.states().iter().map(|s| s.name.as_str()).collect();
    text.push_str(&format!(
        "{}: fine; {} parts, gear states: {}\n",
        file.display(),
        transmission.parts().len(),
        states.join(", ")
    ));
    for line in resolved.unreached.iter().chain(&resolved.without) {
        text.push_str(&format!("  note: {line}\n"));
    }
    if let Some(weak) = known.first() {
        text.push_str(&format!(
            "  weakest evidence: {} ({}: {})\n",
            weak.grade.name(),
            weak.what,
            weak.because
        ));
    }
    Ok((text, weakest))
}
