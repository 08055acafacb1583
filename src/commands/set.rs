//! `--set PATH=VALUE`: overrides from the arguments, with their positions in errors.

use gearloss_framework::codes;
use gearloss_framework::document::{Diagnostic, Sources, Span, read_yaml};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{Choice, OWN_MODELS, Resolved, lookup, matches};

use crate::args::ChoiceArgs;

/// Name of an option in errors.
const OPTION: &str = "--set";

/// Resolves a gearbox with the models and overrides of the arguments.
///
/// # Errors
/// All errors of reading the overrides and of resolving; errors caused by an override point at its path or value.
pub fn resolve(language: &Language, gearbox: &Gearbox, args: &ChoiceArgs) -> Result<Resolved, Findings> {
    let choice = choice(args)?;
    gearbox.resolve(language, &choice).map_err(|findings| {
        let without = Choice {
            overrides: Vec::new(),
            ..choice.clone()
        };
        let plain = gearbox.resolve(language, &without).ok();
        point_at_options(language, plain.as_ref(), &args.set, findings)
    })
}

/// Models and overrides of the arguments.
///
/// # Errors
/// If an option has no `=`, or a value is not YAML.
pub fn choice(args: &ChoiceArgs) -> Result<Choice, Findings> {
    let mut overrides = Vec::new();
    for text in &args.set {
        let mut sources = Sources::default();
        let source = sources.add(OPTION, text.as_str());
        let found = |list: Vec<Diagnostic>, sources: Sources| Findings { list, sources };
        let Some((path, value)) = text.split_once('=') else {
            let error = Diagnostic::error("", "an override without `=`")
                .at_span(span(source, 0, text.len()))
                .help("write `--set PATH=VALUE`")
                .code(codes::CHOICE);
            return Err(found(vec![error], sources));
        };
        // Positions of findings are relative to the first character of the value.
        let start = text.len() - value.trim_start().len();
        let read = read_yaml(source, value.trim());
        if !read.findings.is_empty() {
            let moved = |mut finding: Diagnostic| {
                for (place, _) in &mut finding.spans {
                    *place = span(source, place.start as usize + start, place.end as usize + start);
                }
                finding
            };
            return Err(found(read.findings.into_iter().map(moved).collect(), sources));
        }
        overrides.push((path.trim().to_owned(), read.node.to_json()));
    }
    Ok(Choice {
        set: args.models.clone().filter(|set| set != OWN_MODELS),
        overrides,
        ..Choice::default()
    })
}

fn span(source: u16, start: usize, end: usize) -> Span {
    Span {
        source,
        start: start as u32,
        end: end as u32,
    }
}

/// Moves findings at the path of an option into that option: to the first key that matches nothing in the document without overrides,
/// otherwise to the value.
fn point_at_options(
    language: &Language,
    plain: Option<&Resolved>,
    options: &[String],
    mut findings: Findings,
) -> Findings {
    for finding in &mut findings.list {
        // The last of several options for one path applies.
        let option = options.iter().rev().find_map(|text| {
            let (path, value) = text.split_once('=')?;
            reaches(path.trim(), &finding.path).then_some((text, path, value))
        });
        let Some((text, path, value)) = option else { continue };
        let source = findings.sources.add(OPTION, text.as_str());
        let place = match plain.and_then(|plain| failing_key(language, plain, path)) {
            Some((start, end)) => span(source, start, end),
            None => span(source, text.len() - value.trim_start().len(), text.trim_end().len()),
        };
        finding.spans.insert(0, (place, String::new()));
    }
    findings
}

/// Shows the text of an option as the place of findings.
pub fn at_option(option: &str, text: &str, mut findings: Findings) -> Findings {
    let source = findings.sources.add(option, text);
    for finding in &mut findings.list {
        finding.spans.insert(0, (span(source, 0, text.len()), String::new()));
    }
    findings
}

/// Whether a finding at a path concerns the override of a pattern: at a match or below it.
fn reaches(pattern: &str, path: &str) -> bool {
    let mut keys = path.split('.');
    pattern
        .split('.')
        .all(|key| keys.next().is_some_and(|part| key == "*" || part == key))
}

/// Position in a pattern of the first key that matches nothing.
fn failing_key(language: &Language, plain: &Resolved, pattern: &str) -> Option<(usize, usize)> {
    let mut start = 0;
    for key in pattern.split('.') {
        let end = start + key.len();
        let prefix = pattern[..end].trim();
        // The last key may be absent if the schema allows it.
        let known = |path: &String| {
            let last = end == pattern.len();
            (last || lookup(&plain.value, path).is_some()) && language.has_place(&plain.value, path)
        };
        if !matches(&plain.value, prefix).iter().any(known) {
            let lead = key.len() - key.trim_start().len();
            return Some((start + lead, start + lead + key.trim().len()));
        }
        start = end + 1;
    }
    None
}
