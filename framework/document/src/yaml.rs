//! From text to nodes by the events of a YAML parser.
//!
//! Anchors, aliases, tags and second documents are rejected with specific messages. Numbers are plain decimals: `no`, `0x10`, `1_000`,
//! `010` and `16:83` are texts.

use std::collections::HashMap;

use granit_parser::{Event, Parser, ScalarStyle};

use super::codes;
use super::diagnostic::Diagnostic;
use super::node::{Content, Key, Node, Span};
use super::quantity::number_length;
use crate::files::LONGEST_TEXT;

/// Maximum nesting depth of a document.
const DEEPEST: usize = 40;

/// Result of reading.
#[derive(Debug, Clone)]
pub struct Read {
    /// The tree, incomplete after errors.
    pub node: Node,
    /// Errors in the text.
    pub findings: Vec<Diagnostic>,
}

/// Reads a YAML text; `source` is its number for spans. Errors are returned as findings.
pub fn read_yaml(source: u16, text: &str) -> Read {
    if text.len() as u64 > LONGEST_TEXT {
        let span = Span {
            source,
            start: 0,
            end: 0,
        };
        let error = Diagnostic::error("", format!("the text has {} MB", text.len() >> 20));
        let help = "a description has some kilobytes: move measured data to CSV files";
        return Read {
            node: Node {
                content: Content::Null,
                span,
            },
            findings: vec![error.at_span(span).help(help).code(codes::UNREADABLE)],
        };
    }
    let mut reader = Reader {
        events: Parser::new_from_str(text),
        source,
        text,
        findings: Vec::new(),
    };
    let node = reader.document().unwrap_or(Node {
        content: Content::Null,
        span: Span {
            source,
            start: 0,
            end: 0,
        },
    });
    Read {
        node,
        findings: reader
            .findings
            .into_iter()
            .map(|finding| finding.code(codes::SYNTAX))
            .collect(),
    }
}

struct Reader<'a> {
    events: Parser<'a, granit_parser::StrInput<'a>>,
    source: u16,
    text: &'a str,
    findings: Vec<Diagnostic>,
}

/// The text cannot be read further; the findings contain the reason.
struct Broken;

impl<'a> Reader<'a> {
    fn next(&mut self) -> Result<(Event<'a>, Span), Broken> {
        match self.events.next() {
            Some(Ok((event, span))) => {
                let range = span.byte_range().unwrap_or(0..0);
                Ok((event, self.span(range.start, range.end)))
            }
            Some(Err(error)) => {
                let at = error.marker().byte_offset().unwrap_or(self.text.len());
                let span = self.span(at, at);
                let tabs = self
                    .text
                    .lines()
                    .any(|line| line.trim_start_matches(' ').starts_with('\t'));
                let help = if tabs {
                    "indent with spaces; YAML does not allow tabs"
                } else if error.info().starts_with("mapping values are not allowed") {
                    "put a text that contains a colon in quotes; otherwise check the indentation of this line and the one before it"
                } else {
                    "check this place and the text before it: a bracket, brace, quote or colon is missing, or the indentation is wrong"
                };
                let finding = Diagnostic::error("", format!("this is not valid YAML: {}", error.info()))
                    .at_span(span)
                    .help(help);
                self.findings.push(finding);
                Err(Broken)
            }
            None => Ok((Event::StreamEnd, self.span(self.text.len(), self.text.len()))),
        }
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span {
            source: self.source,
            start: start as u32,
            end: end as u32,
        }
    }

    fn report(&mut self, span: Span, message: &str, help: &str) {
        self.findings
            .push(Diagnostic::error("", message).at_span(span).help(help));
    }

    fn document(&mut self) -> Result<Node, Broken> {
        let mut first = None;
        loop {
            let (event, span) = self.next()?;
            match event {
                Event::StreamEnd => break,
                Event::StreamStart | Event::DocumentStart(..) | Event::DocumentEnd => {}
                _ if first.is_some() => {
                    self.report(
                        span,
                        "a second document in one file",
                        "write one document per file, without `---`",
                    );
                    break;
                }
                event => first = Some(self.node(event, span, 0)?),
            }
        }
        if first.is_none() {
            self.report(
                self.span(0, 0),
                "the document is empty",
                "start with `gearloss: gearbox/1` or `gearloss: study/1`",
            );
        }
        first.ok_or(Broken)
    }

    fn node(&mut self, event: Event<'a>, span: Span, depth: usize) -> Result<Node, Broken> {
        if depth > DEEPEST {
            self.report(span, "nested too deeply", "a description needs at most a dozen levels");
            return Err(Broken);
        }
        match event {
            Event::Scalar(text, style, anchor, tag) => {
                self.refuse(span, anchor, tag.is_some());
                let content = if style == ScalarStyle::Plain {
                    plain(&text)
                } else {
                    Content::Text {
                        text: text.into_owned(),
                        plain: false,
                    }
                };
                Ok(Node { content, span })
            }
            Event::SequenceStart(_, anchor, tag) => {
                self.refuse(span, anchor, tag.is_some());
                let mut list = Vec::new();
                loop {
                    let (event, inner) = self.next()?;
                    if matches!(event, Event::SequenceEnd) {
                        let span = Span {
                            end: inner.end.max(span.end),
                            ..span
                        };
                        return Ok(Node {
                            content: Content::List(list),
                            span,
                        });
                    }
                    list.push(self.node(event, inner, depth + 1)?);
                }
            }
            Event::MappingStart(_, anchor, tag) => {
                self.refuse(span, anchor, tag.is_some());
                self.map(span, depth)
            }
            Event::Alias(_) => {
                self.report(
                    span,
                    "an alias",
                    "write the value itself; `extends:` reuses complete descriptions",
                );
                Ok(Node {
                    content: Content::Null,
                    span,
                })
            }
            _ => Ok(Node {
                content: Content::Null,
                span,
            }),
        }
    }

    fn map(&mut self, span: Span, depth: usize) -> Result<Node, Broken> {
        let mut entries: Vec<(Key, Node)> = Vec::new();
        let mut first: HashMap<String, Span> = HashMap::new();
        loop {
            let (event, key_span) = self.next()?;
            let name = match event {
                Event::MappingEnd => {
                    let span = Span {
                        end: key_span.end.max(span.end),
                        ..span
                    };
                    return Ok(Node {
                        content: Content::Map(entries),
                        span,
                    });
                }
                Event::Scalar(text, _, anchor, tag) => {
                    self.refuse(key_span, anchor, tag.is_some());
                    Some(text.into_owned())
                }
                event => {
                    self.node(event, key_span, depth + 1)?;
                    self.report(key_span, "a key that is not text", "write a plain key");
                    None
                }
            };
            let (event, value_span) = self.next()?;
            let value = self.node(event, value_span, depth + 1)?;
            let Some(name) = name else { continue };
            if let Some(first) = first.get(&name).copied() {
                self.findings.push(
                    Diagnostic::error("", format!("the key `{name}` occurs twice"))
                        .at_span(key_span)
                        .code(codes::DUPLICATE_KEY)
                        .label(first, "first occurrence")
                        .help("rename one of them or merge them"),
                );
            } else {
                first.insert(name.clone(), key_span);
                entries.push((Key { name, span: key_span }, value));
            }
        }
    }

    fn refuse(&mut self, span: Span, anchor: usize, tag: bool) {
        if anchor != 0 {
            self.report(
                span,
                "an anchor",
                "write the value where it is used; `extends:` reuses complete descriptions",
            );
        }
        if tag {
            self.report(span, "a tag", "delete the tag; the kind of each value is known");
        }
    }
}

/// Null, booleans and plain decimal numbers; all else is a text.
fn plain(text: &str) -> Content {
    match text {
        "" | "~" | "null" | "Null" | "NULL" => return Content::Null,
        "true" | "True" | "TRUE" => return Content::Bool(true),
        "false" | "False" | "FALSE" => return Content::Bool(false),
        _ => {}
    }
    let digits = text.trim_start_matches(['+', '-']);
    let leading_zero = digits.len() > 1 && digits.starts_with('0') && digits.as_bytes()[1].is_ascii_digit();
    if number_length(text) == text.len()
        && !leading_zero
        && let Ok(number) = text.parse()
    {
        return Content::Number(number);
    }
    Content::Text {
        text: text.to_owned(),
        plain: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_decimals_are_numbers() {
        for text in ["1", "-2.5", "1e3", ".5", "5.", "0.1", "0"] {
            assert!(matches!(plain(text), Content::Number(_)), "{text}");
        }
        for text in [
            "no", "0x10", "1_000", "010", "16:83", "0o17", "1,25", "inf", ".nan", "on",
        ] {
            assert!(matches!(plain(text), Content::Text { plain: true, .. }), "{text}");
        }
    }

    #[test]
    fn what_a_document_must_not_have_is_named() {
        for (text, word) in [
            ("a: &x 1", "anchor"),
            ("a: !!str 1", "tag"),
            ("a: 1\na: 2", "occurs twice"),
            ("a: 1\n---\nb: 2", "second document"),
            ("", "empty"),
            ("a: [1, 2", "not valid YAML"),
            ("? [a, b]\n: 1", "key that is not text"),
        ] {
            let read = read_yaml(0, text);
            assert!(
                read.findings.iter().any(|f| f.message.contains(word)),
                "{text}: {:?}",
                read.findings
            );
        }
        let deep = "[".repeat(500) + &"]".repeat(500);
        assert!(!read_yaml(0, &deep).findings.is_empty());
    }

    #[test]
    fn spans_point_at_what_was_written() {
        let text = "a:\n  b: 30 mm\n";
        let read = read_yaml(0, text);
        let node = read.node.get("a").and_then(|a| a.get("b"));
        let span = node.map_or(Span::NOWHERE, |n| n.span);
        assert_eq!(&text[span.start as usize..span.end as usize], "30 mm");
    }
}
