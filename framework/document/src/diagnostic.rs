//! Findings: message, place and help.

use std::borrow::Cow;
use std::sync::Arc;

use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use schemars::JsonSchema;
use serde::Serialize;

use super::code::Code;
use super::codes;
use super::node::Span;
use super::visible::visible;

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The document cannot be used.
    Error,
    /// The document can be used, but should be checked.
    Warning,
}

/// One finding.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}", self.line())]
pub struct Diagnostic {
    /// Severity.
    pub severity: Severity,
    /// Kind of finding, if assigned.
    pub code: Option<Code>,
    /// Path in the document; empty if there is none.
    pub path: String,
    /// Message.
    pub message: String,
    /// Places in the text: the first is the place of the finding, the others give reasons.
    pub spans: Vec<(Span, String)>,
    /// Notes.
    pub notes: Vec<String>,
    /// How to fix it.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error at a path.
    pub fn error(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            code: None,
            path: path.into(),
            message: message.into(),
            spans: Vec::new(),
            notes: Vec::new(),
            help: None,
        }
    }

    /// A warning at a path.
    pub fn warning(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(path, message)
        }
    }

    /// Assigns a kind unless one was assigned.
    pub fn code(mut self, code: Code) -> Self {
        self.code.get_or_insert(code);
        self
    }

    /// The code; [`codes::OTHER`] where neither its author nor a stage has given one.
    pub fn code_or_other(&self) -> Code {
        self.code.unwrap_or(codes::OTHER)
    }

    /// Adds a place in the text.
    pub fn at_span(self, span: Span) -> Self {
        self.label(span, "")
    }

    /// Adds a place in the text with a label.
    pub fn label(mut self, span: Span, label: impl Into<String>) -> Self {
        self.spans.push((span, label.into()));
        self
    }

    /// Adds a note.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Adds the help.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Moves a finding about a path to the change that caused it: the entry `path` of the map `place`.
    pub fn moved(self, place: &str, path: &str) -> Self {
        Self {
            path: format!("{place}.{path}"),
            spans: Vec::new(),
            ..self
        }
    }

    /// The finding as one line: path and message.
    pub fn title(&self) -> String {
        if self.path.is_empty() {
            self.message.clone()
        } else {
            format!("{}: {}", self.path, self.message)
        }
    }

    /// The finding in one line with its help.
    fn line(&self) -> String {
        let title = self.title();
        match &self.help {
            Some(help) => format!("{title} (help: {help})"),
            None => title,
        }
    }
}

/// Gives a code to all findings that have none.
pub fn classify(findings: &mut [Diagnostic], code: Code) {
    for finding in findings {
        finding.code.get_or_insert(code);
    }
}

/// A finding with its places in files, which it keeps without the texts. Serialised it is a finding of `check --format json`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Finding")]
pub struct PlacedDiagnostic {
    /// An error makes the file unusable; a warning should be checked.
    pub severity: Severity,
    /// Code of the finding. docs/errors.md lists the codes with cause and help; new ones may be added.
    #[schemars(with = "String", regex(pattern = "^[EW][0-9]{4}$"))]
    pub code: Code,
    /// Path in the document; empty if there is none.
    pub path: String,
    /// The problem.
    pub message: String,
    /// How to correct it; null if there is no advice.
    pub help: Option<String>,
    /// Additional information.
    pub notes: Vec<String>,
    /// File; null if the finding has no position.
    pub file: Option<String>,
    /// Line, from one.
    #[schemars(range(min = 1))]
    pub line: Option<usize>,
    /// Column in characters, from one.
    #[schemars(range(min = 1))]
    pub column: Option<usize>,
    /// Other positions that explain it.
    pub related: Vec<RelatedPlace>,
}

/// A place that explains a finding.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RelatedPlace {
    /// The place.
    #[serde(flatten)]
    pub place: FilePlace,
    /// What it has to do with the finding.
    pub message: String,
}

/// A place in a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct FilePlace {
    /// File.
    pub file: String,
    /// Line, from one.
    #[schemars(range(min = 1))]
    pub line: usize,
    /// Column in characters, from one.
    #[schemars(range(min = 1))]
    pub column: usize,
}

/// The texts that spans point into, by number.
#[derive(Debug, Clone, Default)]
pub struct Sources(Vec<(Arc<str>, Arc<str>)>);

impl Sources {
    /// Adds a text with its printed name; returns its number.
    pub fn add(&mut self, name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> u16 {
        self.0.push((name.into(), text.into()));
        (self.0.len() - 1) as u16
    }

    /// Name and text of a number.
    pub fn get(&self, source: u16) -> Option<(&str, &str)> {
        self.0.get(source as usize).map(|(name, text)| (&**name, &**text))
    }

    /// Name, line and column (from one, in characters) of a span's start.
    pub fn locate(&self, span: Span) -> Option<(&str, usize, usize)> {
        let (name, text) = self.get(span.source)?;
        let before = text.get(..(span.start as usize).min(text.len()))?;
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        Some((name, line, column))
    }

    /// A finding with its places as file, line and column, to be serialised.
    pub fn placed(&self, finding: &Diagnostic) -> PlacedDiagnostic {
        let place = |span: Span| {
            self.locate(span).map(|(file, line, column)| FilePlace {
                file: file.to_owned(),
                line,
                column,
            })
        };
        let first = finding.spans.first().and_then(|(span, _)| place(*span));
        let related = finding.spans.iter().skip(1);
        PlacedDiagnostic {
            severity: finding.severity,
            code: finding.code_or_other(),
            path: finding.path.clone(),
            message: finding.message.clone(),
            help: finding.help.clone(),
            notes: finding.notes.clone(),
            file: first.as_ref().map(|place| place.file.clone()),
            line: first.as_ref().map(|place| place.line),
            column: first.as_ref().map(|place| place.column),
            related: related
                .filter_map(|(span, label)| {
                    Some(RelatedPlace {
                        place: place(*span)?,
                        message: label.clone(),
                    })
                })
                .collect(),
        }
    }

    /// A finding with an excerpt of its text, without colours; hidden characters of documents are shown as escapes.
    pub fn render(&self, finding: &Diagnostic) -> String {
        let level = match finding.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = finding.title();
        let title = visible(&title);
        let labels: Vec<Cow<'_, str>> = finding.spans.iter().map(|(_, label)| visible(label)).collect();
        let notes: Vec<Cow<'_, str>> = finding.notes.iter().map(|note| visible(note)).collect();
        let help = finding.help.as_deref().map(visible);
        let mut group = level
            .primary_title(title.as_ref())
            .id(finding.code_or_other().id())
            .elements(std::iter::empty::<annotate_snippets::Padding>());
        let mut by_source: Vec<(u16, Vec<(bool, &Span, &str)>)> = Vec::new();
        for (i, (span, _)) in finding.spans.iter().enumerate() {
            let entry = (i == 0, span, labels[i].as_ref());
            match by_source.iter_mut().find(|(source, _)| *source == span.source) {
                Some((_, list)) => list.push(entry),
                None => by_source.push((span.source, vec![entry])),
            }
        }
        let mut excerpts = Vec::new();
        let mut origins = Vec::new();
        for (source, spans) in &by_source {
            let Some((name, text)) = self.get(*source) else {
                continue;
            };
            if spans.iter().any(|(_, span, _)| is_in_a_long_line(text, **span)) {
                let places = spans.iter().filter_map(|(_, span, _)| self.locate(**span));
                origins.extend(places.map(|(name, line, column)| (visible(name), line, column)));
            } else {
                excerpts.push((visible(name), text, visible(text), spans));
            }
        }
        for (name, line, column) in &origins {
            group = group.element(Origin::path(name.as_ref()).line(*line).char_column(*column));
        }
        for (name, text, shown, spans) in &excerpts {
            let mut snippet = Snippet::source(shown.as_ref()).path(name.as_ref()).fold(true);
            for (primary, span, label) in *spans {
                let range = clip(text, **span);
                let range = match shown {
                    Cow::Borrowed(_) => range,
                    Cow::Owned(_) => shown_at(text, range.start)..shown_at(text, range.end),
                };
                let kind = if *primary {
                    AnnotationKind::Primary
                } else {
                    AnnotationKind::Context
                };
                let annotation = kind.span(range);
                snippet = snippet.annotation(if label.is_empty() {
                    annotation
                } else {
                    annotation.label(*label)
                });
            }
            group = group.element(snippet);
        }
        for note in &notes {
            group = group.element(Level::NOTE.message(note.as_ref()));
        }
        if let Some(help) = &help {
            group = group.element(Level::HELP.message(help.as_ref()));
        }
        Renderer::plain().render(&[group])
    }
}

/// Longest line of which an excerpt is shown, as files of programs may have a single one. \[byte\]
const LONGEST_LINE: usize = 10_000;

fn is_in_a_long_line(text: &str, span: Span) -> bool {
    let at = clip(text, span).start;
    let before = text[..at]
        .bytes()
        .rev()
        .take(LONGEST_LINE)
        .take_while(|byte| *byte != b'\n');
    let after = text[at..].bytes().take(LONGEST_LINE).take_while(|byte| *byte != b'\n');
    before.count() + after.count() >= LONGEST_LINE
}

/// Where a place of a text is after its hidden characters have become escapes.
fn shown_at(text: &str, at: usize) -> usize {
    let (before, after) = text.split_at(at);
    // The two characters of a line end belong together.
    let before = if after.starts_with('\n') {
        before.strip_suffix('\r').unwrap_or(before)
    } else {
        before
    };
    visible(before).len()
}

/// A range of the text at character boundaries, at least one character if there is one.
fn clip(text: &str, span: Span) -> std::ops::Range<usize> {
    let floor = |mut at: usize| {
        at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let start = floor(span.start as usize);
    let end = floor(span.end as usize).max(start);
    // A span over several lines is shown by its first line.
    let line = text[start..end].find('\n').map_or(end, |newline| start + newline);
    start..line.max(start)
}

/// The candidate that was probably meant: one letter differs, or it is the only candidate with the word as a part (`pitch` in
/// `pitch_point`), or at most a third of its letters differ.
pub fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let candidates: Vec<&'a str> = candidates.into_iter().collect();
    let misspelt = misspelt(word, &candidates);
    let one_letter = misspelt.filter(|(away, _)| *away <= 1);
    let close = one_letter.or_else(|| abbreviated(word, &candidates).map(|candidate| (0, candidate)));
    close.or(misspelt).map(|(_, candidate)| candidate)
}

/// The only candidate with the word between its underscores.
fn abbreviated<'a>(word: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let word = word.to_lowercase();
    let has_part = |candidate: &&&str| candidate.to_lowercase().split('_').any(|part| part == word);
    let mut found = candidates.iter().filter(has_part);
    // Parts of one or two letters are too common.
    let first = found.next().filter(|_| word.chars().count() > 2)?;
    found.all(|other| other == first).then_some(first)
}

/// The candidate with the fewest edits, and their number.
fn misspelt<'a>(word: &str, candidates: &[&'a str]) -> Option<(usize, &'a str)> {
    candidates
        .iter()
        .copied()
        .filter_map(|candidate| {
            let length = word.chars().count().max(candidate.chars().count());
            if length > 64 {
                return None;
            }
            let away = distance(word, candidate);
            (away * 3 <= length + 1 && away < length && !is_another_thing(word, candidate)).then_some((away, candidate))
        })
        .min_by_key(|(away, _)| *away)
}

/// Whether two names that look alike are those of different things: their numbers differ (`utf8` and `utf16`), or one has a whole word more
/// (`needle_roller` and `needle_roller_thrust`).
fn is_another_thing(word: &str, candidate: &str) -> bool {
    let words = |name: &'_ str| -> Vec<String> {
        let parts = name.split(|c: char| !c.is_alphanumeric());
        parts.filter(|part| !part.is_empty()).map(str::to_lowercase).collect()
    };
    let (wanted, other) = (words(word), words(candidate));
    let has_all =
        |few: &[String], many: &[String]| few.len() < many.len() && few.iter().all(|part| many.contains(part));
    numbers(word) != numbers(candidate) || has_all(&wanted, &other) || has_all(&other, &wanted)
}

/// The groups of digits of a name. A letter that looks like a digit counts as one beside a digit: `62O5`.
fn numbers(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let is_digit = |i: Option<usize>| i.and_then(|i| letters.get(i)).is_some_and(char::is_ascii_digit);
    let digits = letters.iter().enumerate().map(|(i, letter)| match letter {
        'o' | 'O' if is_digit(i.checked_sub(1)) && is_digit(Some(i + 1)) => '0',
        'l' | 'I' if is_digit(i.checked_sub(1)) && is_digit(Some(i + 1)) => '1',
        letter if letter.is_ascii_digit() => *letter,
        _ => ' ',
    });
    let digits: String = digits.collect();
    digits.split_whitespace().map(str::to_owned).collect()
}

/// Edit distance, with a swap of neighbours as one edit (optimal string alignment).
pub fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.to_lowercase().chars().collect(), b.to_lowercase().chars().collect());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            rows[i][j] = if i == 0 {
                j
            } else if j == 0 {
                i
            } else {
                let change = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                let mut best = change.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
                if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                    best = best.min(rows[i - 2][j - 2] + 1);
                }
                best
            };
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Fifty findings in a file of one line of megabytes would take seconds and print megabytes.
    #[test]
    fn a_place_in_a_very_long_line_has_no_excerpt() {
        let mut sources = Sources::default();
        let source = sources.add("model.rexsj", format!("{{\"a\": \"{}\"}}", "x".repeat(LONGEST_LINE)));
        let span = Span {
            source,
            start: 6,
            end: 9,
        };
        let text = sources.render(&Diagnostic::error("", "wrong").at_span(span).help("correct it"));
        assert!(
            text.contains("model.rexsj:1:7") && text.contains("help: correct it"),
            "{text}"
        );
        assert!(text.len() < 200, "{text}");
    }

    #[test]
    fn a_misspelt_word_finds_its_neighbour() {
        assert_eq!(did_you_mean("palmgrem", ["coulomb", "palmgren"]), Some("palmgren"));
        assert_eq!(did_you_mean("facewdith", ["facewidth", "face"]), Some("facewidth"));
        assert_eq!(did_you_mean("xyz", ["facewidth"]), None);
    }

    #[test]
    fn names_of_other_things_are_no_misspellings() {
        assert_eq!(did_you_mean("utf16", ["utf8", "latin1"]), None);
        assert_eq!(did_you_mean("kv50", ["kv40", "kv100"]), None);
        assert_eq!(did_you_mean("B3", ["B1", "B2"]), None);
        assert_eq!(
            did_you_mean("needle_roller", ["needle_cage", "needle_roller_thrust"]),
            None
        );
        assert_eq!(did_you_mean("62O5", ["6208", "6205"]), Some("6205"));
        assert_eq!(did_you_mean("utf_8", ["utf8", "latin1"]), Some("utf8"));
        assert_eq!(did_you_mean("law14197_2", ["law14179_1", "law14179_2"]), None);
    }

    #[test]
    fn a_part_of_one_word_finds_it() {
        assert_eq!(did_you_mean("pitch", ["path", "pitch_point"]), Some("pitch_point"));
        assert_eq!(did_you_mean("gear", ["gears", "gear_mesh"]), Some("gears"));
        assert_eq!(did_you_mean("pitch", ["pitch_point", "pitch_speed"]), None);
        assert_eq!(did_you_mean("in", ["torque_in"]), None);
    }

    /// No part of a finding reaches a terminal as it is in the document, and the caret is below the place.
    #[test]
    fn hidden_characters_of_a_document_are_escapes_in_a_finding() {
        let text = "a: \u{202e}\u{9b}x\r\nb: \u{200b}30 Nm\n";
        let mut sources = Sources::default();
        let source = sources.add("gear\u{1b}.yaml", text);
        let start = text.find("30").unwrap() as u32;
        let span = Span {
            source,
            start,
            end: start + 5,
        };
        let finding = Diagnostic::error("b\u{202e}", "a torque \u{1b}[31m")
            .label(span, "here \u{2066}")
            .note("note \u{7}")
            .help("write \u{200b}");
        let shown = sources.render(&finding);
        assert_eq!(visible(&shown), shown);
        for part in [
            r"b\u{202e}: a torque \u{1b}[31m",
            r"gear\u{1b}.yaml:2:12",
            r"b: \u{200b}30 Nm",
            r"here \u{2066}",
            r"note \u{7}",
            r"write \u{200b}",
        ] {
            assert!(shown.contains(part), "{part}: {shown}");
        }
        let lines: Vec<&str> = shown.lines().collect();
        let excerpt = lines.iter().position(|line| line.contains("30 Nm")).unwrap();
        assert_eq!(
            lines[excerpt].find("30 Nm"),
            lines[excerpt + 1].find("^^^^^"),
            "{shown}"
        );
    }

    #[test]
    fn a_finding_prints_file_line_column_and_caret() {
        let mut sources = Sources::default();
        let source = sources.add("gear.yaml", "a: 1\nb: 30 Nm\n");
        let finding = Diagnostic::error("b", "a torque")
            .at_span(Span {
                source,
                start: 8,
                end: 13,
            })
            .help("write `30 mm`");
        let text = sources.render(&finding);
        assert!(
            text.contains("error[E0000]: b: a torque") && text.contains("gear.yaml:2:4") && text.contains("^^^^^"),
            "{text}"
        );
        assert!(text.contains("help: write `30 mm`"), "{text}");
        assert_eq!(
            sources
                .locate(Span {
                    source,
                    start: 8,
                    end: 13
                })
                .unwrap(),
            ("gear.yaml", 2, 4)
        );
    }
}
