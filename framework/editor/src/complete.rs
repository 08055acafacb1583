//! Completion: the keys and values that are possible at the cursor.

use std::collections::BTreeMap;
use std::path::Path;

use gearloss_document::{Unit, number_length};
use gearloss_framework::gearbox::DocumentKind;
use gearloss_framework::language::{LUBRICANTS, MATERIALS};
use gearloss_framework::registry::{Files, ShippedCycle, inventory};
use gearloss_framework::resolve::{CatalogueRow, CatalogueTable};
use serde::Serialize;
use serde_json::Value;

use crate::cursor::{Cursor, Typed, cursor};
use crate::ids::{self, CATALOGUE, CLEARANCES, COMPONENT, FILE, MECHANISM, PATH, SHIPPED_CYCLE, owners, targets};
use crate::outline::{Content, Node};
use crate::place::{Field, Place, Step, follow};
use crate::text::TextRange;
use crate::workspace::{Document, Workspace, named, section};

/// Maximum length of a catalogue of the user. \[byte\]
const LONGEST_CATALOGUE: u64 = 4 << 20;

/// What a suggestion is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Suggested {
    /// A key.
    Key,
    /// A word of a fixed list, `true`, `false`.
    Word,
    /// A unit.
    Unit,
    /// An id of the document.
    Id,
    /// A model or analysis.
    Model,
    /// A row of a catalogue.
    Designation,
    /// A file.
    File,
}

/// A suggestion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Completion {
    /// Shown text, which also is what the typed word is compared with.
    pub label: String,
    /// What it is.
    pub kind: Suggested,
    /// In one line: unit, data of a catalogue, where an id is from.
    pub detail: String,
    /// Description.
    pub documentation: String,
    /// Text that replaces the range.
    pub insert: String,
    /// Replaced range.
    pub range: TextRange,
    /// True for a key that must be written.
    pub required: bool,
}

impl Workspace<'_> {
    /// Suggestions at a byte of a document, the best first.
    pub fn completion(&self, path: &Path, offset: usize) -> Vec<Completion> {
        let Some(document) = self.document(path) else {
            return Vec::new();
        };
        let Some(cursor) = cursor(&document.text, offset) else {
            return Vec::new();
        };
        let mut completer = Completer {
            workspace: self,
            range: document.lines.range(&document.text, &cursor.word),
            document: &document,
            cursor: &cursor,
            found: Vec::new(),
        };
        completer.complete();
        completer.found
    }
}

struct Completer<'a, 'l> {
    workspace: &'a Workspace<'l>,
    document: &'a Document,
    cursor: &'a Cursor,
    range: TextRange,
    found: Vec<Completion>,
}

impl Completer<'_, '_> {
    fn complete(&mut self) {
        let cursor = self.cursor;
        let root = self.workspace.root(self.document.kind, Some(&cursor.document));
        let outside = cursor.steps.is_empty();
        if outside && cursor.document.get("gearloss").is_none() {
            for (kind, doc) in [("gearbox/1", "A gearbox."), ("study/1", "Analyses of gearboxes.")] {
                self.push(&format!("gearloss: {kind}"), Suggested::Key, "", doc, None);
            }
        }
        let Some((place, node)) = follow(root, &cursor.document, &cursor.steps) else {
            self.below_path();
            return;
        };
        match cursor.typed {
            Typed::Key => self.keys(&place, node),
            Typed::Value => self.values(&place),
            Typed::Either => {
                if place.is_map() {
                    self.keys(&place, None);
                }
                self.values(&place);
            }
        }
    }

    fn push(&mut self, label: &str, kind: Suggested, detail: &str, doc: &str, insert: Option<String>) {
        let blank = self.cursor.blank;
        let insert = insert.unwrap_or_else(|| label.to_owned());
        self.found.push(Completion {
            label: label.to_owned(),
            kind,
            detail: detail.to_owned(),
            documentation: doc.to_owned(),
            insert: format!("{blank}{insert}"),
            range: self.range.clone(),
            required: false,
        });
    }

    fn keys(&mut self, place: &Place<'_>, node: Option<&Node>) {
        if place.has_path_keys() {
            self.paths(true);
            return;
        }
        let written =
            |name: &str| node.is_some_and(|node| node.entries().iter().any(|entry| entry.colon && entry.key == name));
        let mut fields: Vec<Field<'_>> = place.fields(node);
        // A key that is already written is only suggested where the cursor is on it.
        fields.retain(|field| !written(field.name));
        fields.sort_by_key(|field| !field.required);
        for field in fields {
            let insert = self.key_text(&field);
            let detail = detail_of(&field.place, field.required);
            self.push(field.name, Suggested::Key, &detail, field.place.doc(), Some(insert));
            if let Some(last) = self.found.last_mut() {
                last.required = field.required;
            }
        }
        if place.has_ids() && self.cursor.steps == [Step::Key("catalogues".to_owned())] {
            let language = self.workspace.language;
            let sections = language
                .sections()
                .map(|(section, _)| section)
                .chain([LUBRICANTS, MATERIALS]);
            for section in sections.filter(|section| language.catalogue(section).is_some()) {
                if !written(section) {
                    self.push(
                        section,
                        Suggested::Key,
                        "catalogue of the section",
                        "",
                        Some(format!("{section}: ")),
                    );
                }
            }
        }
    }

    /// A key with its colon and, for a map of a block, the indentation of its first line.
    fn key_text(&self, field: &Field<'_>) -> String {
        let name = field.name;
        if self.cursor.has_colon {
            return name.to_owned();
        }
        if !self.cursor.flow && field.place.is_map_only() {
            return format!("{name}:\n{}", " ".repeat(self.cursor.indent + 2));
        }
        format!("{name}: ")
    }

    fn values(&mut self, place: &Place<'_>) {
        let cursor = self.cursor;
        let types = place.types();
        // The `type` of a record is a word of the choice around it.
        if cursor.steps.last() == Some(&Step::Key("type".to_owned())) {
            let root = self.workspace.root(self.document.kind, None);
            let outer = &cursor.steps[..cursor.steps.len() - 1];
            if let Some((outer, _)) = follow_choice(root, &cursor.document, outer) {
                for word in outer.types() {
                    let detail = self.model_detail(&outer, word.word);
                    self.push(word.word, Suggested::Model, &detail, word.doc, None);
                }
                if !self.found.is_empty() {
                    return;
                }
            }
        }
        for word in types {
            let detail = self.model_detail(place, word.word);
            let insert = format!("{{ type: {} }}", word.word);
            self.push(word.word, Suggested::Model, &detail, word.doc, Some(insert));
        }
        for word in place.words() {
            self.push(word.word, Suggested::Word, "", word.doc, None);
        }
        if place.is_boolean() {
            let default = place.default().and_then(Value::as_bool);
            for value in [true, false] {
                let detail = if default == Some(value) { "default" } else { "" };
                self.push(&value.to_string(), Suggested::Word, detail, "", None);
            }
        }
        self.units(place);
        if !place.is_list() || place.is_text() {
            return self.names(place);
        }
        // One entry of a list, in its brackets.
        let Some(item) = place.child(&Step::Index(0), None) else {
            return;
        };
        let before = self.found.len();
        for word in item.words() {
            self.push(word.word, Suggested::Word, "", word.doc, None);
        }
        self.names(&item);
        for proposal in self.found.iter_mut().skip(before) {
            proposal.insert = format!("{}[{}]", self.cursor.blank, proposal.insert.trim_start());
        }
    }

    fn model_detail(&self, place: &Place<'_>, name: &str) -> String {
        let entry = place
            .mechanism()
            .and_then(|mechanism| self.workspace.language.registry().model(mechanism, name));
        entry.map_or_else(String::new, |entry| entry.source.to_owned())
    }

    /// Units behind a number.
    fn units(&mut self, place: &Place<'_>) {
        let Some(unit) = place.unit().and_then(Unit::of_symbol) else {
            return;
        };
        let before = self.cursor.before.as_str();
        let length = number_length(before);
        if length == 0 || before.get(length..).is_none_or(|rest| rest.starts_with(['.', ','])) {
            return;
        }
        let from = self.cursor.word.start + length;
        let range = self
            .document
            .lines
            .range(&self.document.text, &(from..self.cursor.word.end));
        let symbols =
            std::iter::once(unit.symbol).chain(Unit::symbols(unit.dimension).filter(|symbol| *symbol != unit.symbol));
        for symbol in symbols.filter(|symbol| *symbol != "-") {
            let detail = if symbol == unit.symbol { "documented unit" } else { "" };
            self.found.push(Completion {
                label: symbol.to_owned(),
                kind: Suggested::Unit,
                detail: detail.to_owned(),
                documentation: String::new(),
                insert: format!(" {symbol}"),
                range: range.clone(),
                required: false,
            });
        }
    }

    /// Ids, designations, files and other names.
    fn names(&mut self, place: &Place<'_>) {
        let workspace = self.workspace;
        let gearbox = workspace.root(DocumentKind::Gearbox, None);
        let targets = targets(place.refers);
        for target in targets {
            match target {
                FILE => self.files(),
                PATH | COMPONENT => self.paths(false),
                CATALOGUE => self.designations(),
                SHIPPED_CYCLE => {
                    for cycle in inventory::iter::<ShippedCycle> {
                        self.push(cycle.name, Suggested::Id, "shipped cycle", cycle.source, None);
                    }
                }
                MECHANISM => {
                    for mechanism in workspace.language.registry().mechanisms() {
                        self.push(mechanism.key, Suggested::Word, "mechanism", mechanism.meaning, None);
                    }
                }
                CLEARANCES => {
                    for section in ids::clearances(&gearbox) {
                        self.ids(&section);
                    }
                }
                word => {
                    let study = workspace.root(DocumentKind::Study, None);
                    let is_section = [&gearbox, &study]
                        .iter()
                        .any(|root| root.along(word).is_some_and(|p| p.has_ids()));
                    if is_section {
                        self.ids(word);
                    } else {
                        self.push(word, Suggested::Word, "", "", None);
                    }
                }
            }
        }
    }

    /// The gearboxes that the record around the cursor names.
    fn owners(&self) -> Vec<String> {
        let mut names = Vec::new();
        let root = self.workspace.root(self.document.kind, Some(&self.cursor.document));
        for length in (0..=self.cursor.steps.len()).rev() {
            if let Some((place, Some(node))) = follow(root.clone(), &self.cursor.document, &self.cursor.steps[..length])
            {
                names.extend(owners(node, &place));
            }
        }
        names
    }

    /// The outlines in which ids are looked up, with the name that is shown for those of other files.
    fn scopes(&self) -> Vec<(String, Node)> {
        let owners = if self.document.kind == DocumentKind::Study {
            self.owners()
        } else {
            Vec::new()
        };
        let mut all = vec![(String::new(), self.cursor.document.clone())];
        for document in self.workspace.scopes(self.document, &owners).into_iter().flatten() {
            if document.path != self.document.path {
                let name = document
                    .path
                    .file_name()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned();
                all.push((name, document.outline));
            }
        }
        all
    }

    fn ids(&mut self, name: &str) {
        let mark = |text: &str| text.chars().any(|c| ('\u{e000}'..='\u{e0ff}').contains(&c));
        for (file, outline) in self.scopes() {
            let entries = section(&outline, name).map(Node::entries).unwrap_or_default();
            for entry in entries {
                if mark(&entry.key) || !entry.colon || self.found.iter().any(|proposal| proposal.label == entry.key) {
                    continue;
                }
                let from = if file.is_empty() {
                    name.to_owned()
                } else {
                    format!("{name} of {file}")
                };
                self.push(&entry.key, Suggested::Id, &from, &summary(&entry.value), None);
            }
        }
        if name == "model_sets" {
            for set in self.workspace.language.registry().shipped_sets() {
                self.push(set.name, Suggested::Id, "shipped model set", set.meaning, None);
            }
            if self.document.kind == DocumentKind::Study {
                self.push("own", Suggested::Id, "models of the gearbox", "", None);
            }
        }
    }

    fn files(&mut self) {
        let folder = self.document.path.parent().unwrap_or(Path::new("")).to_owned();
        let names: Vec<String> = self
            .workspace
            .known_files()
            .filter(|file| **file != self.document.path)
            .filter_map(|file| file.strip_prefix(&folder).ok())
            .map(|file| file.to_string_lossy().replace('\\', "/"))
            .collect();
        for name in names {
            self.push(&name, Suggested::File, "", "", None);
        }
    }

    fn designations(&mut self) {
        let Some(Step::Key(section)) = self.cursor.steps.first() else {
            return;
        };
        let section = section.clone();
        let mut rows: BTreeMap<String, CatalogueRow> = BTreeMap::new();
        if let Some(table) = self.workspace.catalogue(self.document, &section) {
            rows.extend(table.0);
        }
        let shipped = self.workspace.language.catalogue(&section);
        let shipped = shipped.into_iter().flat_map(|table| table.0.iter());
        for (designation, row) in shipped {
            rows.entry(designation.clone()).or_insert_with(|| row.clone());
        }
        for (designation, row) in rows {
            let quotes = !self.cursor.quoted && designation.chars().all(|c| c.is_ascii_digit() || c == '.');
            let insert = if quotes {
                format!("\"{designation}\"")
            } else {
                designation.clone()
            };
            self.push(
                &designation,
                Suggested::Designation,
                &row_text(&row),
                &format!("confidence: {}", row.confidence),
                Some(insert),
            );
        }
    }

    /// The next key of a resolved path.
    fn paths(&mut self, as_key: bool) {
        let workspace = self.workspace;
        let before = self.cursor.before.clone();
        let (head, _) = before.rsplit_once('.').map_or(("", ""), |(head, tail)| (head, tail));
        let root = workspace.root(DocumentKind::Gearbox, None);
        let place = if head.is_empty() { Some(root) } else { root.along(head) };
        let Some(place) = place else { return };
        let from = self.cursor.word.start + if head.is_empty() { 0 } else { head.len() + 1 };
        let end = self.cursor.word.start + before.len();
        self.range = self.document.lines.range(&self.document.text, &(from..end.max(from)));
        if place.has_ids() {
            self.ids(head);
            self.push("*", Suggested::Word, "every one", "", None);
        }
        for field in place.any_type().fields(None) {
            let leaf = !(field.place.is_map() || field.place.has_ids());
            let insert = if leaf && as_key && !self.cursor.has_colon {
                format!("{}: ", field.name)
            } else {
                field.name.to_owned()
            };
            let detail = detail_of(&field.place, false);
            self.push(field.name, Suggested::Key, &detail, field.place.doc(), Some(insert));
        }
    }

    /// Values of a resolved path as key: `set: { bearings.B1.kind: | }`.
    fn below_path(&mut self) {
        let cursor = self.cursor;
        let root = self.workspace.root(self.document.kind, Some(&cursor.document));
        let [outer @ .., Step::Key(path)] = cursor.steps.as_slice() else {
            return;
        };
        let paths = follow(root, &cursor.document, outer).is_some_and(|(place, _)| place.has_path_keys());
        let gearbox = self.workspace.root(DocumentKind::Gearbox, None);
        if let Some(place) = gearbox.along(path).filter(|_| paths) {
            self.values(&place);
        }
    }
}

impl Workspace<'_> {
    /// The catalogue of a section that a gearbox names itself.
    pub(crate) fn catalogue(&self, document: &Document, name: &str) -> Option<CatalogueTable> {
        self.chain(&document.path).iter().find_map(|opened| {
            let file = section(&opened.outline, &format!("catalogues.{name}"))?.text()?;
            if file.ends_with('/') {
                let folder = opened.path.parent().unwrap_or(Path::new(""));
                return CatalogueTable::named(&Files::from_source(self.files(), folder), file).ok();
            }
            let bytes = self.files().read(&named(&opened.path, file), LONGEST_CATALOGUE).ok()?;
            CatalogueTable::from_file(&bytes).ok()
        })
    }
}

/// As [`follow`], where the last value is taken without its `type`: the choice itself.
fn follow_choice<'s, 'n>(root: Place<'s>, document: &'n Node, steps: &[Step]) -> Option<(Place<'s>, Option<&'n Node>)> {
    let [outer @ .., last] = steps else {
        return Some((root, Some(document)));
    };
    let (place, node) = follow(root, document, outer)?;
    Some((place.child(last, None)?, node))
}

/// Unit, default and whether a key must be written, in one line.
pub(crate) fn detail_of(place: &Place<'_>, required: bool) -> String {
    let mut parts = Vec::new();
    if let Some(unit) = place.unit().filter(|unit| *unit != "-") {
        parts.push(unit.to_owned());
    }
    if required {
        parts.push("required".to_owned());
    } else if let Some(default) = place.default() {
        parts.push(format!("default {}", shown(default)));
    }
    parts.join(", ")
}

/// A default as one writes it.
pub(crate) fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => number
            .as_f64()
            .map_or_else(|| number.to_string(), |number| number.to_string()),
        other => other.to_string(),
    }
}

/// The data of a row of a catalogue in one line.
pub(crate) fn row_text(row: &CatalogueRow) -> String {
    let cell = |(key, value): &(String, Value)| format!("{key} {}", shown(value));
    row.values.iter().map(cell).collect::<Vec<_>>().join(", ")
}

/// A value in one line, shortened.
pub(crate) fn summary(node: &Node) -> String {
    fn write(node: &Node, text: &mut String) {
        if text.len() > 160 {
            return;
        }
        match &node.content {
            Content::Empty => {}
            Content::Scalar { text: part, .. } => text.push_str(part),
            Content::List(items) => {
                text.push('[');
                for (i, item) in items.iter().enumerate() {
                    text.push_str(if i > 0 { ", " } else { "" });
                    write(item, text);
                }
                text.push(']');
            }
            Content::Map { entries, .. } => {
                text.push_str("{ ");
                for (i, entry) in entries.iter().enumerate() {
                    text.push_str(if i > 0 { ", " } else { "" });
                    text.push_str(&entry.key);
                    text.push_str(": ");
                    write(&entry.value, text);
                }
                text.push_str(" }");
            }
        }
    }
    let mut text = String::new();
    write(node, &mut text);
    if text.chars().count() > 120 {
        text = text.chars().take(117).collect::<String>() + "...";
    }
    text
}
