//! What is known about the key, value or name at a place.

use std::path::Path;

use gearloss_framework::gearbox::DocumentKind;
use gearloss_framework::registry::{Entry, ShippedCycle, inventory};
use serde::Serialize;

use crate::complete::{shown, summary};
use crate::ids::{Name, SHIPPED_CYCLE, targets};
use crate::outline::{Content, Node};
use crate::place::{Place, Step, follow};
use crate::text::TextRange;
use crate::workspace::{Document, Workspace, named, section};

/// An explanation.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Hover {
    /// Markdown.
    pub text: String,
    /// What it explains.
    pub range: TextRange,
}

/// What is under the cursor.
enum Under {
    Key(std::ops::Range<usize>),
    Value(std::ops::Range<usize>),
}

impl Workspace<'_> {
    /// The explanation of what is at a byte of a document.
    pub fn hover(&self, path: &Path, offset: usize) -> Option<Hover> {
        let document = self.document(path)?;
        let mut steps = Vec::new();
        let under = under(&document.outline, offset, &mut steps)?;
        let (Under::Key(span) | Under::Value(span)) = &under;
        let range = document.lines.range(&document.text, span);
        let root = self.root(document.kind, Some(&document.outline));
        let mut parts = Vec::new();
        if let Under::Value(_) = under {
            parts.extend(self.value(&document, &steps, offset));
        }
        let place = follow(root, &document.outline, &steps);
        let place = place
            .map(|(place, _)| place)
            .or_else(|| self.place_of_path(&document, &steps));
        if let Some(place) = place {
            if let (Under::Value(_), Some(text)) = (&under, text_at(&document.outline, &steps)) {
                let word = place
                    .words()
                    .into_iter()
                    .find(|word| word.word == text && !word.doc.is_empty());
                parts.extend(word.map(|word| format!("`{text}`: {}", word.doc)));
            }
            let name = match steps.last() {
                Some(Step::Key(key)) => key.clone(),
                _ => String::new(),
            };
            parts.push(key_text(&name, &place));
        }
        parts.retain(|part| !part.trim().is_empty());
        (!parts.is_empty()).then(|| Hover {
            text: parts.join("\n\n---\n\n"),
            range,
        })
    }

    /// The place of the value of a resolved path.
    fn place_of_path(&self, document: &Document, steps: &[Step]) -> Option<Place<'_>> {
        let [outer @ .., Step::Key(path)] = steps else {
            return None;
        };
        let root = self.root(document.kind, Some(&document.outline));
        let (place, _) = follow(root, &document.outline, outer)?;
        place
            .has_path_keys()
            .then(|| self.root(DocumentKind::Gearbox, None).along(path))?
    }

    fn value(&self, document: &Document, steps: &[Step], offset: usize) -> Option<String> {
        if let Some(text) = self.model(document, steps) {
            return Some(text);
        }
        let occurrences = self.occurrences(document);
        let here = occurrences
            .iter()
            .find(|occurrence| occurrence.span.start <= offset && offset <= occurrence.span.end);
        match here.map(|occurrence| &occurrence.name) {
            Some(Name::Designation { section, designation }) => self.row(document, section, designation),
            Some(Name::File(file)) => Some(format!("File `{}`", named(&document.path, file).display())),
            Some(Name::Id { id, .. }) => {
                let definitions = self.definitions(document, here?);
                let lines = definitions.iter().filter_map(|(name, site)| {
                    let defining = self.document(&site.path)?;
                    let node = section(&defining.outline, name)?.get(id)?;
                    let file = (defining.path != document.path)
                        .then(|| defining.path.file_name().unwrap_or_default().to_string_lossy());
                    let file = file.map_or_else(String::new, |file| format!(" of {file}"));
                    Some(format!("`{id}` in `{name}`{file}: `{}`", summary(node)))
                });
                let lines: Vec<String> = lines.collect();
                if lines.is_empty() {
                    let set = self
                        .language
                        .registry()
                        .shipped_sets()
                        .iter()
                        .find(|set| set.name == id)?;
                    return Some(format!("Shipped model set `{id}`: {}", set.meaning));
                }
                Some(lines.join("\n\n"))
            }
            None => self.cycle(document, steps),
        }
    }

    /// The model or analysis that a `type` names.
    fn model(&self, document: &Document, steps: &[Step]) -> Option<String> {
        let [outer @ .., Step::Key(key)] = steps else {
            return None;
        };
        if key != "type" {
            return None;
        }
        let name = text_at(&document.outline, steps)?;
        let root = self.root(document.kind, Some(&document.outline));
        let (place, _) = match outer {
            [] => return None,
            [before @ .., last] => {
                let (place, node) = follow(root, &document.outline, before)?;
                (place.child(last, None)?, node)
            }
        };
        let word = place.types().into_iter().find(|word| word.word == name)?;
        let entry = place
            .mechanism()
            .and_then(|key| self.language.registry().model(key, name));
        let mut text = format!("**{name}**: {}", word.doc);
        if let Some(entry) = entry {
            text.push_str(&model_text(entry));
        }
        Some(text)
    }

    fn row(&self, document: &Document, section: &str, designation: &str) -> Option<String> {
        let catalogue = self.catalogue(document, section);
        let stated = catalogue.as_ref().and_then(|table| table.0.get(designation));
        let shipped = self
            .language
            .catalogue(section)
            .and_then(|table| table.0.get(designation));
        let row = stated.or(shipped)?;
        let mut text = format!("**{designation}**, catalogue of {section}\n");
        for (key, value) in &row.values {
            text.push_str(&format!("\n- `{key}`: {}", shown(value)));
        }
        if !row.confidence.is_empty() {
            text.push_str(&format!("\n\nConfidence: {}", row.confidence));
        }
        Some(text)
    }

    fn cycle(&self, document: &Document, steps: &[Step]) -> Option<String> {
        let root = self.root(document.kind, Some(&document.outline));
        let (place, node) = follow(root, &document.outline, steps)?;
        if targets(place.refers) != [SHIPPED_CYCLE] {
            return None;
        }
        let name = node.and_then(Node::text)?;
        let cycle = inventory::iter::<ShippedCycle>
            .into_iter()
            .find(|cycle| cycle.name == name)?;
        Some(format!("Shipped cycle `{name}`: {}", cycle.source))
    }
}

/// Source, evidence and stated ranges of a model.
fn model_text(entry: &Entry) -> String {
    let mut text = format!("\n\nSource: {}", entry.source);
    for graded in entry.evidence {
        let of = if graded.key.is_empty() {
            "formula".to_owned()
        } else {
            format!("default of `{}`", graded.key)
        };
        text.push_str(&format!(
            "\n\nEvidence of the {of}: {} ({})",
            graded.grade.name(),
            graded.because
        ));
    }
    text.push_str(&format!("\n\nExample: `{}`", entry.example));
    text
}

/// Description, unit, default, range and words of a key.
fn key_text(name: &str, place: &Place<'_>) -> String {
    let mut text = if name.is_empty() {
        String::new()
    } else {
        format!("**{name}**: ")
    };
    text.push_str(place.doc());
    let mut facts = Vec::new();
    let unit = place.unit();
    let shown_unit = unit
        .filter(|unit| *unit != "-")
        .map_or_else(String::new, |unit| format!(" {unit}"));
    if unit.is_some() {
        facts.push(format!("Unit: {}", unit.unwrap_or_default()));
    }
    if let Some(default) = place.default() {
        facts.push(format!("Default: {}{shown_unit}", shown(default)));
    }
    match place.range() {
        (Some(least), Some(greatest)) => facts.push(format!("Range: {least} to {greatest}{shown_unit}")),
        (Some(least), None) => facts.push(format!("Minimum: {least}{shown_unit}")),
        (None, Some(greatest)) => facts.push(format!("Maximum: {greatest}{shown_unit}")),
        (None, None) => {}
    }
    let words: Vec<String> = place.words().iter().map(|word| format!("`{}`", word.word)).collect();
    if !words.is_empty() {
        facts.push(format!("Values: {}", words.join(", ")));
    }
    let types: Vec<String> = place.types().iter().map(|word| format!("`{}`", word.word)).collect();
    if !types.is_empty() {
        facts.push(format!("Types: {}", types.join(", ")));
    }
    for fact in facts {
        text.push_str("\n\n");
        text.push_str(&fact);
    }
    text
}

fn text_at<'n>(document: &'n Node, steps: &[Step]) -> Option<&'n str> {
    let node = steps
        .iter()
        .try_fold(document, |node, step| match (step, &node.content) {
            (Step::Key(key), _) => node.get(key),
            (Step::Index(index), Content::List(items)) => items.get(*index),
            _ => None,
        });
    node.and_then(Node::text)
}

fn under(node: &Node, offset: usize, steps: &mut Vec<Step>) -> Option<Under> {
    let touches = |span: &std::ops::Range<usize>| span.start <= offset && offset <= span.end && !span.is_empty();
    match &node.content {
        Content::Empty => None,
        Content::Scalar { .. } => touches(&node.span).then(|| Under::Value(node.span.clone())),
        Content::List(items) => {
            for (i, item) in items.iter().enumerate() {
                steps.push(Step::Index(i));
                if let Some(found) = under(item, offset, steps) {
                    return Some(found);
                }
                steps.pop();
            }
            None
        }
        Content::Map { entries, .. } => {
            for entry in entries {
                steps.push(Step::Key(entry.key.clone()));
                if touches(&entry.span) {
                    return Some(Under::Key(entry.span.clone()));
                }
                if let Some(found) = under(&entry.value, offset, steps) {
                    return Some(found);
                }
                steps.pop();
            }
            None
        }
    }
}
