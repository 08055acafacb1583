//! Answers in the form of the protocol.

use serde_json::{Value, json};

use crate::complete::{Completion, Suggested};
use crate::hover::Hover;
use crate::navigate::Edit;
use crate::symbols::Symbol;
use crate::text::{Encoding, Position, TextRange};

fn position(place: &Position, encoding: Encoding) -> Value {
    json!({ "line": place.line, "character": place.column(encoding) })
}

/// A range.
pub fn range(range: &TextRange, encoding: Encoding) -> Value {
    json!({ "start": position(&range.start, encoding), "end": position(&range.end, encoding) })
}

/// Suggestions in their order.
pub fn completions(items: &[Completion], encoding: Encoding) -> Value {
    let shown = |(i, item): (usize, &Completion)| {
        // Kinds of the protocol.
        let kind = match item.kind {
            Suggested::Key => 10,
            Suggested::Word => 20,
            Suggested::Unit => 11,
            Suggested::Id => 18,
            Suggested::Model => 7,
            Suggested::Designation => 12,
            Suggested::File => 17,
        };
        let filter = if item.kind == Suggested::Unit {
            &item.insert
        } else {
            &item.label
        };
        json!({
            "label": item.label,
            "kind": kind,
            "detail": item.detail,
            "documentation": item.documentation,
            "sortText": format!("{i:04}"),
            "filterText": filter,
            "insertTextMode": 1,
            "textEdit": { "range": range(&item.range, encoding), "newText": item.insert },
        })
    };
    let items: Vec<Value> = items.iter().enumerate().map(shown).collect();
    json!({ "isIncomplete": false, "items": items })
}

/// An explanation.
pub fn hover(hover: &Hover, encoding: Encoding) -> Value {
    json!({
        "contents": { "kind": "markdown", "value": hover.text },
        "range": range(&hover.range, encoding),
    })
}

/// Edits of a file.
pub fn edits(edits: &[Edit], encoding: Encoding) -> Value {
    let edit = |edit: &Edit| json!({ "range": range(&edit.range, encoding), "newText": edit.insert });
    edits.iter().map(edit).collect()
}

/// Sections and ids.
pub fn symbols(list: &[Symbol], encoding: Encoding) -> Value {
    let symbol = |symbol: &Symbol| {
        json!({
            "name": symbol.name,
            "detail": symbol.detail,
            // An object for an id, a namespace for what holds others, a property for the rest.
            "kind": if symbol.is_id { 19 } else if symbol.children.is_empty() { 7 } else { 3 },
            "range": range(&symbol.range, encoding),
            "selectionRange": range(&symbol.key, encoding),
            "children": symbols(&symbol.children, encoding),
        })
    };
    list.iter().map(symbol).collect()
}
