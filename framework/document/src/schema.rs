//! The published schema, compiled for the walk. Constructs that the walk cannot check are errors.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::by_type::records_by_type;
use super::publish::STATE_ID;
use super::unit::Unit;

/// The shape of a value.
#[derive(Debug, Clone)]
pub enum Shape {
    /// A number; bounds in the documented unit.
    Number {
        /// Documented unit; a text may use another unit of its dimension.
        unit: &'static Unit,
        /// Minimum.
        least: f64,
        /// Maximum.
        greatest: f64,
        /// A whole number without unit.
        whole: bool,
        /// Whether it may be a text with a unit.
        texts: bool,
    },
    /// A text; one of the list unless the list is empty.
    Text(Vec<String>),
    /// `true` or `false`.
    Bool,
    /// Anything.
    Any,
    /// Known keys.
    Record(Vec<(String, Field)>),
    /// Any ids as keys.
    Ids {
        /// Shape of each value.
        item: Box<Shape>,
        /// True if they may start with a digit.
        digits_first: bool,
    },
    /// Any paths as keys, anything as values.
    Paths,
    /// A list.
    List {
        /// Shape of each item.
        item: Box<Shape>,
        /// Minimum number of items.
        least: usize,
        /// Maximum number of items.
        most: usize,
    },
    /// A record whose `type` determines its keys, or one of some short words.
    Tagged {
        /// Kind, for messages.
        what: String,
        /// Records by `type`.
        variants: Vec<(String, Shape)>,
        /// Allowed words instead of a record.
        short: Vec<String>,
    },
    /// One of several shapes, distinguished by the kind of value.
    Either(Vec<Shape>),
    /// A definition by its name, for nested and recursive shapes.
    Named(String),
}

/// A key of a record.
#[derive(Debug, Clone)]
pub struct Field {
    /// Shape of its value.
    pub shape: Shape,
    /// True when it must be written.
    pub required: bool,
    /// Default in the documented unit.
    pub default: Option<Value>,
    /// Description.
    pub doc: String,
    /// Sections whose entries a text names.
    pub refers_to: Vec<String>,
    /// Names by which users look for the key.
    pub also_called: Vec<String>,
}

/// A construct that the walk cannot check.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {why}")]
pub struct Unsupported {
    /// Place in the schema: mechanism, model and field.
    pub place: String,
    /// Why.
    pub why: String,
}

/// A compiled schema.
#[derive(Debug, Clone)]
pub struct Schema {
    pub(super) root: Shape,
    pub(super) definitions: BTreeMap<String, Shape>,
}

impl Schema {
    /// Compiles a published schema.
    ///
    /// # Errors
    /// Every construct that the walk cannot check.
    pub fn compile(published: &Value) -> Result<Self, Vec<Unsupported>> {
        let mut compiler = Compiler { found: Vec::new() };
        let definitions = published
            .get("definitions")
            .and_then(Value::as_object)
            .into_iter()
            .flatten()
            .map(|(name, schema)| (name.clone(), compiler.shape(schema, name)))
            .collect::<BTreeMap<_, _>>();
        let root = compiler.shape(published, "");
        let schema = Self { root, definitions };
        compiler.dangling(&schema.root, &schema.definitions);
        for shape in schema.definitions.values() {
            compiler.dangling(shape, &schema.definitions);
        }
        if compiler.found.is_empty() {
            Ok(schema)
        } else {
            Err(compiler.found)
        }
    }

    /// A shape with references resolved.
    pub(super) fn follow<'a>(&'a self, mut shape: &'a Shape) -> &'a Shape {
        // Definitions may refer to each other; a chain longer than their number is circular.
        for _ in 0..=self.definitions.len() {
            match shape {
                Shape::Named(name) => match self.definitions.get(name) {
                    Some(next) => shape = next,
                    None => return shape,
                },
                _ => return shape,
            }
        }
        shape
    }

    /// The shape at a path of the document if there is one. In a tagged record, `type` selects the variant.
    pub fn shape_at(&self, path: &str, tag: impl Fn(&str) -> Option<String>) -> Option<&Shape> {
        let mut shape = self.follow(&self.root);
        let mut so_far = String::new();
        for key in path.split('.') {
            shape = match shape {
                Shape::Record(fields) => &fields.iter().find(|(name, _)| name == key)?.1.shape,
                Shape::Ids { item, .. } => item,
                Shape::List { item, .. } => {
                    key.parse::<usize>().ok()?;
                    item
                }
                Shape::Tagged { variants, .. } => {
                    let name = tag(&so_far)?;
                    let (_, record) = variants.iter().find(|(variant, _)| *variant == name)?;
                    match record {
                        Shape::Record(fields) => &fields.iter().find(|(name, _)| name == key)?.1.shape,
                        _ => return None,
                    }
                }
                Shape::Either(shapes) => shapes.iter().map(|s| self.follow(s)).find_map(|s| match s {
                    Shape::Record(fields) => fields.iter().find(|(name, _)| name == key).map(|(_, f)| &f.shape),
                    Shape::List { item, .. } if key.parse::<usize>().is_ok() => Some(item.as_ref()),
                    _ => None,
                })?,
                Shape::Any | Shape::Paths => &Shape::Any,
                _ => return None,
            };
            shape = self.follow(shape);
            if !so_far.is_empty() {
                so_far.push('.');
            }
            so_far.push_str(key);
        }
        Some(shape)
    }
}

/// The type of a value: that of a number which may be written with a unit is a pair.
fn name_of_type(kind: &Value) -> Option<&str> {
    match kind {
        Value::String(kind) => Some(kind),
        Value::Array(kinds) if kinds.len() == 2 && kinds[0] == "number" && kinds[1] == "string" => Some("number"),
        _ => None,
    }
}

struct Compiler {
    found: Vec<Unsupported>,
}

impl Compiler {
    fn refuse(&mut self, place: &str, why: impl Into<String>) -> Shape {
        self.found.push(Unsupported {
            place: place.to_owned(),
            why: why.into(),
        });
        Shape::Any
    }

    fn shape(&mut self, schema: &Value, place: &str) -> Shape {
        let object = match schema {
            Value::Bool(true) => return Shape::Any,
            Value::Object(object) => object,
            _ => return self.refuse(place, "not a schema"),
        };
        // Numbers and booleans first, because most schemas are one.
        let is_combined = object
            .keys()
            .any(|key| ["$ref", "allOf", "anyOf", "oneOf"].contains(&key.as_str()));
        match object.get("type").and_then(name_of_type) {
            _ if is_combined => {}
            Some("number") => return self.number(object, place, false),
            Some("integer") => return self.number(object, place, true),
            Some("boolean") => return Shape::Bool,
            _ => {}
        }
        if let Some(name) = object.get("$ref").and_then(Value::as_str) {
            return match name.strip_prefix("#/definitions/") {
                Some(name) => Shape::Named(name.to_owned()),
                None => self.refuse(place, format!("a reference to `{name}`")),
            };
        }
        let records = records_by_type(schema);
        if !records.is_empty() {
            return self.tagged(object, records, place);
        }
        if let Some(all) = object.get("allOf").and_then(Value::as_array) {
            return match all.as_slice() {
                [only] if !object.contains_key("type") => self.shape(only, place),
                _ => self.refuse(place, "several schemas at once"),
            };
        }
        if let Some(one_of) = object.get("oneOf").and_then(Value::as_array) {
            return self.one_of(one_of, place);
        }
        if let Some(any_of) = object.get("anyOf").and_then(Value::as_array) {
            let shapes = any_of.iter().map(|s| self.shape(s, place)).collect();
            return Shape::Either(shapes);
        }
        if let Some(word) = object.get("const").and_then(Value::as_str) {
            return Shape::Text(vec![word.to_owned()]);
        }
        let kind = match object.get("type") {
            Some(kind) => match name_of_type(kind) {
                Some(name) => name,
                None => return self.refuse(place, format!("type {kind}")),
            },
            None if object
                .keys()
                .all(|k| ["description", "default", "title"].contains(&k.as_str())) =>
            {
                return Shape::Any;
            }
            None if object.contains_key("enum") => "string",
            None => return self.refuse(place, "no type"),
        };
        match kind {
            "string" => Shape::Text(words(object.get("enum"))),
            "array" => {
                let count = |key: &str| object.get(key).and_then(Value::as_u64).map(|n| n as usize);
                let item = match object.get("items") {
                    Some(items) => self.shape(items, place),
                    None => self.refuse(place, "a list without items"),
                };
                Shape::List {
                    item: Box::new(item),
                    least: count("minItems").unwrap_or(0),
                    most: count("maxItems").unwrap_or(usize::MAX),
                }
            }
            "object" => self.object(object, place),
            other => self.refuse(place, format!("type `{other}`")),
        }
    }

    fn number(&mut self, object: &Map<String, Value>, place: &str, whole: bool) -> Shape {
        let Some(unit) = object.get("x-unit").and_then(Value::as_str).and_then(Unit::of_symbol) else {
            return self.refuse(place, "its doc comment does not end in a [unit]");
        };
        for key in ["exclusiveMinimum", "exclusiveMaximum", "multipleOf"] {
            if object.contains_key(key) {
                return self.refuse(place, format!("`{key}` is not checked: use `range(min, max)`"));
            }
        }
        let bound = |key: &str, none: f64| object.get(key).and_then(Value::as_f64).unwrap_or(none);
        Shape::Number {
            unit,
            least: bound("minimum", f64::NEG_INFINITY),
            greatest: bound("maximum", f64::INFINITY),
            whole,
            texts: object.get("type").is_some_and(Value::is_array),
        }
    }

    fn object(&mut self, object: &Map<String, Value>, place: &str) -> Shape {
        match object.get("additionalProperties") {
            None | Some(Value::Bool(false)) => {}
            Some(Value::Bool(true)) => return Shape::Paths,
            Some(Value::Object(inner)) if inner.is_empty() => return Shape::Paths,
            Some(inner) => {
                let pattern = object.get("propertyNames").and_then(|names| names.get("pattern"));
                return Shape::Ids {
                    item: Box::new(self.shape(inner, &join(place, "*"))),
                    digits_first: pattern.and_then(Value::as_str) == Some(STATE_ID),
                };
            }
        }
        // Keys that are required unless the document extends another.
        let otherwise = object.get("else").and_then(|schema| schema.get("required"));
        let required = [words(object.get("required")), words(otherwise)].concat();
        let fields = object
            .get("properties")
            .and_then(Value::as_object)
            .into_iter()
            .flatten()
            .map(|(name, schema)| {
                let field = Field {
                    shape: self.shape(schema, &join(place, name)),
                    required: required.contains(name),
                    default: schema.get("default").cloned(),
                    doc: schema
                        .get("description")
                        .and_then(Value::as_str)
                        .unwrap_or_default()
                        .to_owned(),
                    refers_to: one_or_several(schema.get("x-refers-to")),
                    also_called: words(schema.get("x-also-called")),
                };
                (name.clone(), field)
            })
            .collect();
        Shape::Record(fields)
    }

    fn tagged(&mut self, object: &Map<String, Value>, records: Vec<(&str, &Value)>, place: &str) -> Shape {
        let variants = records
            .into_iter()
            .map(|(name, record)| (name.to_owned(), self.shape(record, &join(place, name))))
            .collect();
        let mut short = Vec::new();
        for other in object.get("oneOf").and_then(Value::as_array).into_iter().flatten() {
            match other.get("const").and_then(Value::as_str) {
                Some(word) => short.push(word.to_owned()),
                None if other.get("allOf").is_some() => {}
                None => return self.refuse(place, "a mixture of kinds"),
            }
        }
        let mechanism = object.get("x-mechanism").and_then(Value::as_str);
        Shape::Tagged {
            what: mechanism.map_or_else(|| "analysis".to_owned(), |key| format!("{key} model")),
            variants,
            short,
        }
    }

    fn one_of(&mut self, variants: &[Value], place: &str) -> Shape {
        let mut short = Vec::new();
        let mut other = Vec::new();
        for variant in variants {
            if let Some(word) = variant.get("const").and_then(Value::as_str) {
                short.push(word.to_owned());
            } else if let Some(list) = variant.get("enum") {
                short.extend(words(Some(list)));
            } else {
                other.push(self.shape(variant, place));
            }
        }
        match (short.is_empty(), other.is_empty()) {
            (_, true) => Shape::Text(short),
            (true, false) => Shape::Either(other),
            _ => self.refuse(place, "a mixture of kinds"),
        }
    }

    fn dangling(&mut self, shape: &Shape, definitions: &BTreeMap<String, Shape>) {
        match shape {
            Shape::Named(name) if !definitions.contains_key(name) => {
                self.refuse(name, "no such definition");
            }
            Shape::Record(fields) => fields.iter().for_each(|(_, f)| self.dangling(&f.shape, definitions)),
            Shape::Ids { item, .. } | Shape::List { item, .. } => self.dangling(item, definitions),
            Shape::Tagged { variants, .. } => variants.iter().for_each(|(_, s)| self.dangling(s, definitions)),
            Shape::Either(shapes) => shapes.iter().for_each(|s| self.dangling(s, definitions)),
            _ => {}
        }
    }
}

fn join(place: &str, key: &str) -> String {
    if place.is_empty() {
        key.to_owned()
    } else {
        format!("{place}.{key}")
    }
}

/// A text or a list of texts.
fn one_or_several(value: Option<&Value>) -> Vec<String> {
    match value.and_then(Value::as_str) {
        Some(one) => vec![one.to_owned()],
        None => words(value),
    }
}

fn words(value: Option<&Value>) -> Vec<String> {
    value
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .map(str::to_owned)
        .collect()
}
