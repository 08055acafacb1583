//! Where the cursor is: the way from the document to it, and whether a key or a value is typed there.

use std::ops::Range;

use crate::outline::{Content, Node, read};
use crate::place::Step;

/// What is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Typed {
    /// A key of a map.
    Key,
    /// A value.
    Value,
    /// A word alone on its line, below a key or behind a hyphen: a key of a map, or a value.
    Either,
}

/// The cursor in a document.
#[derive(Debug, Clone)]
pub struct Cursor {
    /// The outline of the text with the cursor.
    pub document: Node,
    /// The way to the map of a key, or to the value.
    pub steps: Vec<Step>,
    /// What is typed.
    pub typed: Typed,
    /// The word under the cursor, in bytes of the text without the cursor.
    pub word: Range<usize>,
    /// The part of the word before the cursor.
    pub before: String,
    /// True inside of braces or brackets.
    pub flow: bool,
    /// The blank that is missing directly after a colon; otherwise empty.
    pub blank: &'static str,
    /// True if the key under the cursor has its colon.
    pub has_colon: bool,
    /// Columns before the key or value on its line.
    pub indent: usize,
    /// True in quotes.
    pub quoted: bool,
}

struct Found {
    steps: Vec<Step>,
    typed: Typed,
    span: Range<usize>,
    flow: bool,
    has_colon: bool,
    quoted: bool,
}

/// The cursor at a byte of a text; `None` in a comment.
pub fn cursor(text: &str, offset: usize) -> Option<Cursor> {
    let offset = crate::text::floor(text, offset);
    let mark = ('\u{e000}'..='\u{e0ff}').find(|mark| !text.contains(*mark))?;
    let mut marked = String::with_capacity(text.len() + mark.len_utf8());
    marked.push_str(text.get(..offset)?);
    marked.push(mark);
    marked.push_str(text.get(offset..)?);
    let document = read(&marked, Some(mark));
    let mut steps = Vec::new();
    let found = find(&document, mark, &mut steps, false)?;
    let written = marked.get(found.span.clone())?;
    let at = written.find(mark)?;
    let before = written.get(..at)?.to_owned();
    let start = found.span.start;
    let word = start..(start + written.len() - mark.len_utf8()).max(start);
    let line_start = text.get(..start)?.rfind(['\n', '\r']).map_or(0, |end| end + 1);
    let line = text.get(line_start..start)?;
    let blank = if found.typed == Typed::Value && line.ends_with(':') {
        " "
    } else {
        ""
    };
    let alone = !found.flow && !found.quoted && line.trim_matches([' ', '\t', '-']).is_empty();
    let typed = if found.typed == Typed::Value && alone {
        Typed::Either
    } else {
        found.typed
    };
    Some(Cursor {
        steps: found.steps,
        typed,
        before,
        word,
        flow: found.flow,
        blank,
        has_colon: found.has_colon,
        indent: start - line_start,
        quoted: found.quoted,
        document,
    })
}

fn find(node: &Node, mark: char, steps: &mut Vec<Step>, in_flow: bool) -> Option<Found> {
    match &node.content {
        Content::Empty => None,
        Content::Scalar { text, quoted } => text.contains(mark).then(|| Found {
            steps: steps.clone(),
            typed: Typed::Value,
            span: node.inner(),
            flow: in_flow,
            has_colon: false,
            quoted: *quoted,
        }),
        Content::List(items) => items.iter().enumerate().find_map(|(i, item)| {
            steps.push(Step::Index(i));
            let found = find(item, mark, steps, in_flow);
            steps.pop();
            found
        }),
        Content::Map { entries, flow } => entries.iter().find_map(|entry| {
            if entry.key.contains(mark) {
                return Some(Found {
                    steps: steps.clone(),
                    typed: Typed::Key,
                    span: entry.span.clone(),
                    flow: *flow,
                    has_colon: entry.colon,
                    quoted: false,
                });
            }
            steps.push(Step::Key(entry.key.clone()));
            let found = find(&entry.value, mark, steps, in_flow || *flow);
            steps.pop();
            found
        }),
    }
}
