//! What the published schema says at a place of a document.

use std::sync::OnceLock;

use gearloss_framework::gearbox::DocumentKind;
use gearloss_framework::language::{Kind, Language};
use serde_json::{Map, Value};

use crate::outline::{Content, Node};

/// The published schemas of gearboxes and studies.
#[derive(Debug, Default)]
pub struct Schemas {
    gearbox: OnceLock<Value>,
    study: OnceLock<Value>,
}

impl Schemas {
    /// The schema of a kind of document.
    pub fn of(&self, language: &Language, kind: DocumentKind) -> &Value {
        match kind {
            DocumentKind::Gearbox => self.gearbox.get_or_init(|| language.published(Kind::Gearbox)),
            DocumentKind::Study => self.study.get_or_init(|| language.published(Kind::Study)),
        }
    }
}

/// A step from a value to one inside of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// A key of a map.
    Key(String),
    /// An entry of a list.
    Index(usize),
}

/// The schemas of a value: alternatives of which one applies.
#[derive(Debug, Clone)]
pub struct Place<'s> {
    root: &'s Value,
    /// The schema as its key states it, with description and default.
    field: &'s Value,
    /// Alternatives without references.
    alternatives: Vec<&'s Map<String, Value>>,
    /// What texts at the place name.
    pub refers: Option<&'s Value>,
    /// The keys of the map are resolved paths.
    path_keys: bool,
}

/// A key that a place accepts.
#[derive(Debug, Clone)]
pub struct Field<'s> {
    /// Name.
    pub name: &'s str,
    /// Its place.
    pub place: Place<'s>,
    /// True when it must be written.
    pub required: bool,
}

/// An allowed word with its description.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Word<'s> {
    /// The word.
    pub word: &'s str,
    /// Description; empty if there is none.
    pub doc: &'s str,
}

fn text<'s>(schema: &'s Map<String, Value>, key: &str) -> Option<&'s str> {
    schema.get(key).and_then(Value::as_str)
}

/// True for a schema that chooses keys by `type`.
fn is_choice(schema: &Map<String, Value>) -> bool {
    let branches = schema.get("allOf").and_then(Value::as_array);
    branches.is_some_and(|list| list.iter().any(|branch| branch.get("then").is_some()))
}

impl<'s> Place<'s> {
    /// The place of a whole document.
    pub fn root(schema: &'s Value, document: Option<&Node>) -> Self {
        Self::new(schema, schema, document, None, false)
    }

    fn new(
        root: &'s Value,
        field: &'s Value,
        node: Option<&Node>,
        inherited: Option<&'s Value>,
        path_keys: bool,
    ) -> Self {
        let mut place = Self {
            root,
            field,
            alternatives: Vec::new(),
            refers: field.get("x-refers-to").or(inherited),
            path_keys: path_keys || field.get("x-keys").and_then(Value::as_str) == Some("path"),
        };
        place.expand(field, node, 0);
        place
    }

    fn expand(&mut self, schema: &'s Value, node: Option<&Node>, depth: usize) {
        let Some(object) = schema.as_object().filter(|_| depth < 16) else {
            return;
        };
        if let Some(refers) = object.get("x-refers-to") {
            self.refers.get_or_insert(refers);
        }
        if let Some(name) = text(object, "$ref").and_then(|name| name.strip_prefix("#/definitions/")) {
            if let Some(target) = self.root.get("definitions").and_then(|all| all.get(name)) {
                self.expand(target, node, depth + 1);
            }
            return;
        }
        if is_choice(object) {
            let stated = node.and_then(|node| node.get("type")).and_then(Node::text);
            let branches = object.get("allOf").and_then(Value::as_array).into_iter().flatten();
            let record = branches
                .filter_map(|branch| branch.get("then")?.as_object())
                .find(|record| {
                    let name = record.get("properties").and_then(|p| p.pointer("/type/const"));
                    stated.is_some() && name.and_then(Value::as_str) == stated
                });
            self.alternatives.push(record.unwrap_or(object));
            return;
        }
        let mut is_leaf = true;
        for key in ["allOf", "oneOf", "anyOf"] {
            for inner in object.get(key).and_then(Value::as_array).into_iter().flatten() {
                is_leaf = false;
                self.expand(inner, node, depth + 1);
            }
        }
        if is_leaf || object.contains_key("properties") {
            self.alternatives.push(object);
        }
    }

    /// Description; that of the key has precedence over that of the type.
    pub fn doc(&self) -> &'s str {
        let described = self.field.get("description").and_then(Value::as_str);
        let other = self.alternatives.iter().find_map(|schema| text(schema, "description"));
        described.or(other).unwrap_or_default()
    }

    /// Default, in the documented unit; that of a record is those of its keys, and an empty list says nothing.
    pub fn default(&self) -> Option<&'s Value> {
        let empty = |default: &&Value| default.is_object() || default.as_array().is_some_and(Vec::is_empty);
        self.field.get("default").filter(|default| !empty(default))
    }

    fn strings(&self, key: &str) -> Option<&'s str> {
        self.alternatives.iter().find_map(|schema| text(schema, key))
    }

    /// Documented unit of a number, or of the numbers of a list.
    pub fn unit(&self) -> Option<&'s str> {
        let of_items = || {
            let items = self.alternatives.iter().find_map(|schema| schema.get("items"))?;
            items.get("x-unit").and_then(Value::as_str)
        };
        self.strings("x-unit").or_else(of_items)
    }

    /// Minimum and maximum of a number, in the documented unit.
    pub fn range(&self) -> (Option<f64>, Option<f64>) {
        let bound = |key: &str| {
            let of_value = self.alternatives.iter().find_map(|schema| schema.get(key));
            let items = self
                .alternatives
                .iter()
                .find_map(|schema| schema.get("items")?.get(key));
            of_value.or(items).and_then(Value::as_f64)
        };
        (bound("minimum"), bound("maximum"))
    }

    fn has_type(&self, name: &str) -> bool {
        self.alternatives.iter().any(|schema| match schema.get("type") {
            Some(Value::String(title)) => title == name,
            Some(Value::Array(list)) => list.iter().any(|title| title == name),
            _ => false,
        })
    }

    /// True if `true` and `false` may be here.
    pub fn is_boolean(&self) -> bool {
        self.has_type("boolean")
    }

    /// True if only a map may be here.
    pub fn is_map_only(&self) -> bool {
        !self.alternatives.is_empty()
            && self.alternatives.iter().all(|schema| {
                schema.get("type").and_then(Value::as_str) == Some("object") && !is_choice(schema) && !is_model(schema)
            })
    }

    /// True if a list may be here.
    pub fn is_list(&self) -> bool {
        self.has_type("array")
    }

    /// True if a text may be here, not only a list of them.
    pub fn is_text(&self) -> bool {
        self.has_type("string")
    }

    /// True if a map may be here.
    pub fn is_map(&self) -> bool {
        self.has_type("object")
    }

    /// True if the keys are resolved paths.
    pub fn has_path_keys(&self) -> bool {
        self.path_keys && self.alternatives.iter().any(|schema| accepts_anything(schema))
    }

    /// True if the keys are ids that the document chooses.
    pub fn has_ids(&self) -> bool {
        !self.path_keys
            && self
                .alternatives
                .iter()
                .any(|schema| schema.contains_key("propertyNames"))
    }

    /// True if an id may begin with a digit.
    pub fn digits_first(&self) -> bool {
        self.alternatives.iter().any(|schema| {
            let pattern = schema.get("propertyNames").and_then(|names| names.get("pattern"));
            pattern
                .and_then(Value::as_str)
                .is_some_and(|pattern| pattern.contains(")$)[A-Za-z0-9]"))
        })
    }

    /// The section whose ids the text defines.
    pub fn defines(&self) -> Option<&'s str> {
        self.field.get("x-defines").and_then(Value::as_str)
    }

    /// The mechanism of a model.
    pub fn mechanism(&self) -> Option<&'s str> {
        let mut schema = self.field;
        for _ in 0..4 {
            if let Some(key) = schema.get("x-mechanism").and_then(Value::as_str) {
                return Some(key);
            }
            let reference = schema.get("$ref").or_else(|| schema.pointer("/allOf/0/$ref"));
            let name = reference?.as_str()?.strip_prefix("#/definitions/")?;
            schema = self.root.get("definitions")?.get(name)?;
        }
        None
    }

    /// The keys that may be written; of several alternatives those with the most keys of the node.
    pub fn fields(&self, node: Option<&Node>) -> Vec<Field<'s>> {
        let written = node.map(Node::entries).unwrap_or_default();
        let records = self.alternatives.iter().filter_map(|schema| {
            let fields = schema.get("properties")?.as_object()?;
            let known = written
                .iter()
                .filter(|entry| entry.colon && fields.contains_key(&entry.key))
                .count();
            Some((known, *schema, fields))
        });
        let records: Vec<_> = records.collect();
        let most = records.iter().map(|(known, ..)| *known).max().unwrap_or_default();
        let mut all: Vec<Field<'s>> = Vec::new();
        for (_, schema, fields) in records.into_iter().filter(|(known, ..)| *known == most) {
            let extends = written.iter().any(|entry| entry.key == "extends");
            let otherwise = schema
                .get("else")
                .filter(|_| !extends)
                .and_then(|schema| schema.get("required"));
            let required = [schema.get("required"), otherwise];
            let required = |name: &str| {
                let lists = required.iter().flatten().filter_map(|list| list.as_array());
                lists.flatten().any(|known| known == name)
            };
            for (name, schema) in fields {
                if all.iter().all(|field| field.name != name) {
                    let value = node.and_then(|node| node.get(name));
                    all.push(Field {
                        name,
                        place: Self::new(self.root, schema, value, None, false),
                        required: required(name),
                    });
                }
            }
        }
        all
    }

    /// Allowed words.
    pub fn words(&self) -> Vec<Word<'s>> {
        let mut words = Vec::new();
        let mut add = |word: Option<&'s str>, doc: &'s str| {
            if let Some(word) = word
                && words.iter().all(|known: &Word<'s>| known.word != word)
            {
                words.push(Word { word, doc });
            }
        };
        for schema in &self.alternatives {
            let doc = text(schema, "description").unwrap_or_default();
            add(text(schema, "const"), doc);
            for word in schema.get("enum").and_then(Value::as_array).into_iter().flatten() {
                add(word.as_str(), if schema.contains_key("x-mechanism") { "" } else { doc });
            }
        }
        words
    }

    /// The types of a record whose keys depend on its `type`, with their descriptions.
    pub fn types(&self) -> Vec<Word<'s>> {
        let mut words = Vec::new();
        for schema in self.alternatives.iter().filter(|schema| is_choice(schema)) {
            let list = schema
                .get("properties")
                .and_then(|fields| fields.pointer("/type/oneOf")?.as_array());
            for variant in list.into_iter().flatten() {
                let word = variant.get("const").and_then(Value::as_str);
                let doc = variant.get("description").and_then(Value::as_str);
                words.extend(word.map(|word| Word {
                    word,
                    doc: doc.unwrap_or_default(),
                }));
            }
        }
        words
    }

    /// The place of a value inside; `node` is the value as written there.
    pub fn child(&self, step: &Step, node: Option<&Node>) -> Option<Self> {
        let mut found: Option<Self> = None;
        for schema in &self.alternatives {
            let next = match step {
                Step::Key(key) => {
                    let described = schema.get("properties").and_then(|fields| fields.get(key));
                    if let Some(described) = described {
                        Some(Self::new(self.root, described, node, None, false))
                    } else {
                        let any = schema.get("additionalProperties").filter(|any| any.is_object());
                        any.map(|any| Self::new(self.root, any, node, self.refers, self.path_keys))
                    }
                }
                Step::Index(_) => {
                    let items = schema.get("items");
                    items.map(|items| Self::new(self.root, items, node, self.refers, self.path_keys))
                }
            };
            match (&mut found, next) {
                (Some(found), Some(next)) => found.alternatives.extend(next.alternatives),
                (None, next) => found = next,
                _ => {}
            }
        }
        found
    }

    /// Places of values inside for a resolved path: `*` and ids are any id, and models have the keys of all types.
    pub fn along(&self, path: &str) -> Option<Self> {
        let mut place = self.clone();
        for key in path.split('.') {
            place = place.child_of_any(key)?;
        }
        Some(place)
    }

    /// As [`Place::child`], with the keys of all types of a model.
    pub fn child_of_any(&self, key: &str) -> Option<Self> {
        let step = key
            .parse::<usize>()
            .ok()
            .filter(|_| self.is_list())
            .map_or_else(|| Step::Key(key.to_owned()), Step::Index);
        if let Some(child) = self.child(&step, None) {
            return Some(child);
        }
        self.any_type().child(&step, None)
    }

    /// The place with the records of all types as alternatives.
    pub fn any_type(&self) -> Self {
        let mut place = self.clone();
        place.alternatives = Vec::new();
        for schema in &self.alternatives {
            let branches = schema.get("allOf").and_then(Value::as_array).into_iter().flatten();
            let records: Vec<_> = branches.filter_map(|branch| branch.get("then")?.as_object()).collect();
            if records.is_empty() {
                place.alternatives.push(schema);
            } else {
                place.alternatives.extend(records);
            }
        }
        place
    }
}

fn is_model(schema: &Map<String, Value>) -> bool {
    schema
        .get("properties")
        .and_then(|fields| fields.pointer("/type/const"))
        .is_some()
}

fn accepts_anything(schema: &Map<String, Value>) -> bool {
    match schema.get("additionalProperties") {
        Some(Value::Bool(true)) => true,
        Some(Value::Object(inner)) => inner.is_empty(),
        _ => false,
    }
}

/// The value and the place at the end of steps; `None` where the schema knows no such place.
pub fn follow<'s, 'n>(root: Place<'s>, document: &'n Node, steps: &[Step]) -> Option<(Place<'s>, Option<&'n Node>)> {
    let (mut place, mut node) = (root, Some(document));
    for step in steps {
        node = node.and_then(|node| match (step, &node.content) {
            (Step::Key(key), _) => node.get(key),
            (Step::Index(index), Content::List(items)) => items.get(*index),
            _ => None,
        });
        place = place.child(step, node)?;
    }
    Some((place, node))
}
