//! Places of the paths of a walked document.

use std::collections::BTreeMap;

use super::diagnostic::Diagnostic;
use super::node::Span;

/// Place of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The value.
    pub value: Span,
    /// The key before it; the value itself in a list.
    pub key: Span,
}

/// Places of all written values by path. Absent paths have defaults.
#[derive(Debug, Clone, Default)]
pub struct Places(pub(super) BTreeMap<String, Place>);

impl Places {
    /// The place of a path if it was written.
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

    /// Adds the place of its path to a finding without a place.
    pub fn place(&self, finding: Diagnostic) -> Diagnostic {
        match self.locate(&finding.path) {
            Some(span) if finding.spans.is_empty() => finding.at_span(span),
            _ => finding,
        }
    }
}
