//! Names in a document: where an id is defined, and where it is used.
//!
//! Which section a text names is stated by the schema itself, with marks at the fields of the framework:
//! - `x-refers-to`: sections whose ids a text may be, such as `shafts` or `thermal.network.nodes`; or one of `file`, `path` (a resolved
//!   path), `component` (the path of one), `catalogue` (a designation), `clearances` (all sections whose entries connect two members),
//!   `shipped_cycle`, `mechanism`. Any other word may be written itself. It applies to the texts of lists and maps, too.
//! - `x-keys: path`: the keys of a map are resolved paths.
//! - `x-defines`: the text is a new id of a section.

use std::ops::Range;

use gearloss_framework::gearbox::DocumentKind;
use serde_json::Value;

use crate::outline::{Content, Node};
use crate::place::{Place, Step};

/// Pseudo sections of `x-refers-to`.
pub const FILE: &str = "file";
/// A resolved path.
pub const PATH: &str = "path";
/// The path of a component.
pub const COMPONENT: &str = "component";
/// A designation of the catalogue of the section.
pub const CATALOGUE: &str = "catalogue";
/// Ids of all sections whose entries connect two members.
pub const CLEARANCES: &str = "clearances";
/// A shipped driving cycle.
pub const SHIPPED_CYCLE: &str = "shipped_cycle";
/// A mechanism.
pub const MECHANISM: &str = "mechanism";

/// What a text names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Name {
    /// An id of one of these sections.
    Id {
        /// Sections, by their path.
        sections: Vec<String>,
        /// The id.
        id: String,
    },
    /// A file, relative to the document.
    File(String),
    /// A designation of the catalogue of a section.
    Designation {
        /// Section.
        section: String,
        /// Designation.
        designation: String,
    },
}

/// A name in a document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Occurrence {
    /// What it names.
    pub name: Name,
    /// Where.
    pub span: Range<usize>,
    /// True where it is defined.
    pub defines: bool,
    /// In a study, the gearboxes that its record names; empty for any.
    pub gearboxes: Vec<String>,
}

/// The words of `x-refers-to`.
pub fn targets(refers: Option<&Value>) -> Vec<&str> {
    match refers {
        Some(Value::String(one)) => vec![one.as_str()],
        Some(Value::Array(list)) => list.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    }
}

/// Sections of a gearbox whose entries connect two members.
pub fn clearances(gearbox: &Place<'_>) -> Vec<String> {
    let fields = gearbox.fields(None);
    let connects = |place: &Place<'_>| {
        let entry = place.child_of_any("*").filter(|_| place.has_ids());
        entry.is_some_and(|entry| entry.fields(None).iter().any(|field| field.name == "between"))
    };
    let found = fields.iter().filter(|field| connects(&field.place));
    found.map(|field| field.name.to_owned()).collect()
}

/// All names of a document.
pub fn occurrences(document: &Node, kind: DocumentKind, root: Place<'_>, gearbox: &Place<'_>) -> Vec<Occurrence> {
    let mut collector = Collector {
        gearbox,
        kind,
        clearances: clearances(gearbox),
        path: Vec::new(),
        owners: Vec::new(),
        found: Vec::new(),
    };
    collector.walk(document, &root);
    collector.found
}

struct Collector<'a, 's> {
    gearbox: &'a Place<'s>,
    kind: DocumentKind,
    clearances: Vec<String>,
    path: Vec<String>,
    owners: Vec<String>,
    found: Vec<Occurrence>,
}

impl Collector<'_, '_> {
    fn add(&mut self, name: Name, span: Range<usize>, defines: bool) {
        self.found.push(Occurrence {
            name,
            span,
            defines,
            gearboxes: self.owners.clone(),
        });
    }

    fn walk(&mut self, node: &Node, place: &Place<'_>) {
        match &node.content {
            Content::Empty => {}
            Content::Scalar { text, .. } => self.text(text, node.inner(), place),
            Content::List(items) => {
                for (i, item) in items.iter().enumerate() {
                    let Some(inner) = place.child(&Step::Index(i), Some(item)) else {
                        continue;
                    };
                    self.path.push(i.to_string());
                    self.walk(item, &inner);
                    self.path.pop();
                }
            }
            Content::Map { entries, .. } => {
                let before = self.owners.clone();
                if self.kind == DocumentKind::Study {
                    self.owners.extend(owners(node, place));
                }
                for entry in entries {
                    if place.has_path_keys() {
                        self.resolved_path(&entry.key, inner_of(&entry.key, &entry.span));
                        continue;
                    }
                    if place.has_ids() && entry.colon {
                        let name = Name::Id {
                            sections: vec![self.path.join(".")],
                            id: entry.key.clone(),
                        };
                        self.add(name, inner_of(&entry.key, &entry.span), true);
                    }
                    let step = Step::Key(entry.key.clone());
                    let Some(inner) = place.child(&step, Some(&entry.value)) else {
                        continue;
                    };
                    self.path.push(entry.key.clone());
                    self.walk(&entry.value, &inner);
                    self.path.pop();
                }
                self.owners = before;
            }
        }
    }

    fn text(&mut self, text: &str, span: Range<usize>, place: &Place<'_>) {
        if let Some(section) = place.defines() {
            let name = Name::Id {
                sections: vec![section.to_owned()],
                id: text.to_owned(),
            };
            return self.add(name, span, true);
        }
        let targets = targets(place.refers);
        if targets.is_empty() || text.is_empty() || span.len() != text.len() {
            return;
        }
        if targets.contains(&FILE) {
            return self.add(Name::File(text.to_owned()), span, false);
        }
        if targets.contains(&CATALOGUE) {
            let section = self.path.first().cloned().unwrap_or_default();
            let designation = text.to_owned();
            return self.add(Name::Designation { section, designation }, span, false);
        }
        if targets.iter().any(|target| [PATH, COMPONENT].contains(target)) && text.contains('.') {
            return self.resolved_path(text, span);
        }
        let known = |target: &&str| ![PATH, COMPONENT, SHIPPED_CYCLE, MECHANISM].contains(target);
        let mut sections: Vec<String> = Vec::new();
        for target in targets.iter().copied().filter(known) {
            if target == CLEARANCES {
                sections.extend(self.clearances.iter().cloned());
            } else {
                sections.push(target.to_owned());
            }
        }
        if sections.is_empty() {
            return;
        }
        // `PRODUCT/SET` selects another gearbox.
        if sections == ["model_sets"]
            && let Some((product, set)) = text.split_once('/')
        {
            let name = Name::Id {
                sections: vec!["gearboxes".to_owned()],
                id: product.to_owned(),
            };
            self.add(name, span.start..span.start + product.len(), false);
            let owners = std::mem::replace(&mut self.owners, vec![product.to_owned()]);
            let id = set.to_owned();
            self.add(
                Name::Id { sections, id },
                span.start + product.len() + 1..span.end,
                false,
            );
            self.owners = owners;
            return;
        }
        let id = text.to_owned();
        self.add(Name::Id { sections, id }, span, false);
    }

    /// The ids in a resolved path of a gearbox.
    fn resolved_path(&mut self, path: &str, span: Range<usize>) {
        if path.len() != span.len() {
            return;
        }
        let mut place = self.gearbox.clone();
        let mut at = span.start;
        let mut section: Vec<&str> = Vec::new();
        for key in path.split('.') {
            if place.has_ids() && key != "*" && !key.is_empty() {
                let name = Name::Id {
                    sections: vec![section.join(".")],
                    id: key.to_owned(),
                };
                self.add(name, at..at + key.len(), false);
            }
            at += key.len() + 1;
            section.push(key);
            let Some(next) = place.child_of_any(key) else {
                return;
            };
            place = next;
        }
    }
}

/// The gearboxes that a record of a study names.
pub fn owners(node: &Node, place: &Place<'_>) -> Vec<String> {
    let mut names = Vec::new();
    for entry in node.entries() {
        let names_gearbox = |text: &str| {
            let step = Step::Key(entry.key.clone());
            let inner = place.child(&step, Some(&entry.value));
            inner
                .filter(|inner| targets(inner.refers) == ["gearboxes"])
                .map(|_| text.to_owned())
        };
        names.extend(entry.value.text().and_then(names_gearbox));
    }
    names
}

/// The place of a key without quotes.
fn inner_of(key: &str, span: &Range<usize>) -> Range<usize> {
    if span.len() == key.len() + 2 {
        span.start + 1..span.end - 1
    } else {
        span.clone()
    }
}
