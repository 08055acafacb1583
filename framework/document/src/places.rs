//! Where each path of a walked document was written.

use std::collections::BTreeMap;

use super::diagnostic::Diagnostic;
use super::node::Span;

/// Where a path was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The value.
    pub value: Span,
    /// The key before it; the value itself in a list.
    pub key: Span,
}

/// Places of everything written, by path. What is absent came from a default.
#[derive(Debug, Clone, Default)]
pub struct Places(pub(super) BTreeMap<String, Place>);

impl Places {
    /// Where a path was written, if it was.
    pub fn get(&self, path: &str) -> Option<Place> {
        self.0.get(path).copied()
    }

    /// True when the path was written in the document.
    pub fn is_written(&self, path: &str) -> bool {
        self.0.contains_key(path)
    }

    /// The place of a path or of its nearest written ancestor.
    pub fn locate(&self, path: &str) -> Option<Span> {
        if let Some(place) = self.0.get(path) {
            return Some(place.value);
        }
        let mut end = path.len();
        while let Some(dot) = path[..end].rfind('.') {
            end = dot;
            if let Some(place) = self.0.get(&path[..end]) {
                return Some(place.key);
            }
        }
        None
    }

    /// Gives a finding without a place the place of its path.
    pub fn place(&self, finding: Diagnostic) -> Diagnostic {
        match self.locate(&finding.path) {
            Some(span) if finding.spans.is_empty() => finding.at(span),
            _ => finding,
        }
    }
}
