//! The outline of a document for an editor: sections, and the ids in them.

use std::path::Path;

use serde::Serialize;

use crate::complete::summary;
use crate::outline::{Content, Entry, Node};
use crate::place::{Place, Step};
use crate::text::TextRange;
use crate::workspace::{Document, Workspace};

/// A section or an id.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Symbol {
    /// Key.
    pub name: String,
    /// Its value in one line, if it is an id.
    pub detail: String,
    /// True for an id that the document chooses.
    pub is_id: bool,
    /// Key and value.
    pub range: TextRange,
    /// Key.
    pub key: TextRange,
    /// Ids and keys inside.
    pub children: Vec<Symbol>,
}

impl Workspace<'_> {
    /// Sections and ids of a document.
    pub fn symbols(&self, path: &Path) -> Vec<Symbol> {
        let Some(document) = self.document(path) else {
            return Vec::new();
        };
        let root = self.root(document.kind, Some(&document.outline));
        symbols(&document, &document.outline, &root, 0)
    }
}

fn symbols(document: &Document, node: &Node, place: &Place<'_>, depth: usize) -> Vec<Symbol> {
    let symbol = |entry: &Entry| {
        let is_id = place.has_ids();
        let inner = place.child(&Step::Key(entry.key.clone()), Some(&entry.value));
        let is_map = matches!(entry.value.content, Content::Map { .. });
        let children = match inner {
            Some(inner) if is_map && depth < 3 && (inner.has_ids() || !is_id) => {
                symbols(document, &entry.value, &inner, depth + 1)
            }
            _ => Vec::new(),
        };
        let end = entry.value.span.end.max(entry.span.end);
        Symbol {
            name: entry.key.clone(),
            detail: if is_id || !is_map {
                summary(&entry.value)
            } else {
                String::new()
            },
            is_id,
            range: document.lines.range(&document.text, &(entry.span.start..end)),
            key: document.lines.range(&document.text, &entry.span),
            children,
        }
    };
    node.entries()
        .iter()
        .filter(|entry| entry.colon && !entry.key.is_empty())
        .map(symbol)
        .collect()
}
