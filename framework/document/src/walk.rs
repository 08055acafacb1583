//! The walk over a document: collects every unknown key, missing key, wrong kind, wrong dimension, value out of range and unknown `type`;
//! fills in defaults; converts quantities to SI.

use std::collections::HashSet;

use serde_json::{Map, Value};

use super::code::Code;
use super::codes;
use super::diagnostic::{Diagnostic, did_you_mean};
use super::misplaced::{self, Elsewhere};
use super::node::{Content, Key, Node};
use super::places::{Place, Places};
use super::quantity::{number_length, parse_quantity};
use super::schema::{Field, Schema, Shape};
use super::unit::{Dimension, Unit};

/// A walked document.
#[derive(Debug, Clone)]
pub struct Walked {
    /// The value in SI with defaults; complete only without findings.
    pub value: Value,
    /// Message.
    pub findings: Vec<Diagnostic>,
    /// Place of each path.
    pub places: Places,
}

/// Walks a document.
pub fn walk(node: &Node, schema: &Schema) -> Walked {
    let mut walker = Walker {
        schema,
        findings: Vec::new(),
        places: Places::default(),
        path: String::new(),
    };
    let value = walker.value(node, &schema.root).unwrap_or(Value::Null);
    Walked {
        value,
        findings: found(walker.findings),
        places: walker.places,
    }
}

/// Walks a value as if it were at a path of a document. A tagged record on the way has the keys of all its variants.
pub fn walk_at(node: &Node, schema: &Schema, path: &str) -> Walked {
    let mut walker = Walker {
        schema,
        findings: Vec::new(),
        places: Places::default(),
        path: path.to_owned(),
    };
    let shapes = walker.shapes_at(path);
    let value = match shapes.as_slice() {
        [] => {
            let error = Diagnostic::error(path, "there is no such path in the document");
            walker
                .findings
                .push(error.help("`gearloss check --resolved` prints every path"));
            None
        }
        [first, rest @ ..] => {
            let value = walker.value(node, first);
            // The same key may have another meaning in another variant: one match is sufficient.
            for shape in rest {
                if walker.findings.is_empty() {
                    break;
                }
                let mut other = Walker {
                    schema,
                    findings: Vec::new(),
                    places: Places::default(),
                    path: path.to_owned(),
                };
                if let (Some(value), true) = (other.value(node, shape), other.findings.is_empty()) {
                    return Walked {
                        value,
                        findings: Vec::new(),
                        places: other.places,
                    };
                }
            }
            value
        }
    };
    Walked {
        value: value.unwrap_or(Value::Null),
        findings: found(walker.findings),
        places: walker.places,
    }
}

/// Walks a value at a path with a known shape.
pub fn walk_shape<'a>(node: &Node, schema: &'a Schema, shape: &'a Shape, path: &str) -> Walked {
    let mut walker = Walker {
        schema,
        findings: Vec::new(),
        places: Places::default(),
        path: path.to_owned(),
    };
    let value = walker.value(node, shape).unwrap_or(Value::Null);
    Walked {
        value,
        findings: found(walker.findings),
        places: walker.places,
    }
}

/// Findings of a walk; the default code is [`codes::WRONG_TYPE`].
fn found(list: Vec<Diagnostic>) -> Vec<Diagnostic> {
    list.into_iter()
        .map(|finding| finding.code(codes::WRONG_TYPE))
        .collect()
}

/// Name of the `type` of a record, with all possible types.
type Tag<'a> = (&'a str, &'a [(String, Shape)]);

/// A number and a quantity with its unit that are separated only by a comma: both halves, and the place of the second one.
fn split_number(pair: &[Node]) -> Option<(String, &str, &Node)> {
    let [first, second] = pair else { return None };
    let (Content::Number(whole), Some(text)) = (&first.content, second.text()) else {
        return None;
    };
    let touch = first.span.source == second.span.source && first.span.end + 1 == second.span.start;
    (touch && text.starts_with(|c: char| c.is_ascii_digit())).then(|| (tidy(*whole), text, second))
}

/// Key of the unit in which all of `from`, `to` and `step` are written: numbers add up to what is written in this unit alone. The walk adds
/// it; no document has it.
const UNIT_OF_STEPS: &str = "unit of steps";

fn unit_of_steps<'a>(entries: &'a [(Key, Node)], fields: &[(String, Field)]) -> Option<&'a str> {
    let are_steps = fields.len() == 3
        && ["from", "to", "step"]
            .iter()
            .all(|key| fields.iter().any(|(name, _)| name == key));
    let mut units = entries.iter().map(|(_, node)| {
        let text = node.text()?;
        Some(text[number_length(text)..].trim())
    });
    let first = units.next().filter(|_| are_steps)??;
    units
        .all(|unit| unit.is_some_and(|unit| Unit::is_same(unit, first)))
        .then_some(first)
}

struct Walker<'a> {
    schema: &'a Schema,
    findings: Vec<Diagnostic>,
    places: Places,
    path: String,
}

/// Words that many YAML readers convert into booleans.
fn is_boolean_trap(text: &str) -> bool {
    ["y", "n", "yes", "no", "on", "off", "true", "false"].contains(&text.to_ascii_lowercase().as_str())
}

fn is_id(text: &str, digits_first: bool) -> bool {
    let mut letters = text.chars();
    letters
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || (digits_first && c.is_ascii_digit()))
        && letters.all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !is_boolean_trap(text)
        && !["null"].contains(&text.to_ascii_lowercase().as_str())
}

impl<'a> Walker<'a> {
    fn report(&mut self, node: &Node, message: impl Into<String>, help: impl Into<String>) {
        let finding = Diagnostic::error(self.path.clone(), message)
            .at_span(node.span)
            .help(help);
        self.findings.push(finding);
    }

    /// The finding that was just reported has this code.
    fn last_is(&mut self, code: Code) {
        if let Some(last) = self.findings.last_mut() {
            last.code = Some(code);
        }
    }

    fn within<T>(&mut self, key: &str, walk: impl FnOnce(&mut Self) -> T) -> T {
        let length = self.path.len();
        if length > 0 {
            self.path.push('.');
        }
        self.path.push_str(key);
        let result = walk(self);
        self.path.truncate(length);
        result
    }

    fn value(&mut self, node: &Node, shape: &'a Shape) -> Option<Value> {
        match self.schema.follow(shape) {
            Shape::Number {
                unit,
                least,
                greatest,
                whole,
                texts,
            } => {
                let percent = matches!(&node.content, Content::Text { text, .. } if text.trim_end().ends_with('%'));
                if percent && !texts {
                    self.report(node, "a percentage where none is due", "write a number without a unit");
                    self.last_is(codes::WRONG_UNIT);
                    return None;
                }
                self.number(node, unit, *least, *greatest, *whole)
            }
            Shape::Text(words) => self.text(node, words),
            Shape::Bool => self.boolean(node),
            Shape::Any => Some(node.to_json()),
            Shape::Record(fields) => self.record(node, fields, None),
            Shape::Ids { item, digits_first } => self.ids(node, item, *digits_first),
            Shape::Paths => match &node.content {
                Content::Map(entries) => {
                    for (key, node) in entries {
                        let place = Place {
                            value: node.span,
                            key: key.span,
                        };
                        self.within(&key.name, |w| w.places.0.insert(w.path.clone(), place));
                    }
                    Some(node.to_json())
                }
                _ => self.wrong(node, "a map from paths to values"),
            },
            Shape::List { item, least, most } => self.list(node, item, *least, *most),
            Shape::Tagged { what, variants, short } => self.tagged(node, what, variants, short),
            Shape::Either(shapes) => self.either(node, shapes),
            Shape::Named(name) => {
                self.report(node, format!("bug: no definition `{name}`"), "report this");
                None
            }
        }
    }

    fn wrong(&mut self, node: &Node, wanted: &str) -> Option<Value> {
        let help = if wanted.starts_with("a map") {
            "write keys and values: `{ key: value }`, or one on each line below, indented".to_owned()
        } else {
            format!("write {wanted}")
        };
        self.expected(node, wanted, help)
    }

    /// A value of another kind than expected.
    fn expected(&mut self, node: &Node, wanted: &str, help: String) -> Option<Value> {
        if matches!(node.content, Content::Null) {
            let message = format!("has no value; expected {wanted}");
            self.report(node, message, "write a value, or omit the key");
        } else {
            self.report(node, format!("expected {wanted}, found {}", node.kind()), help);
        }
        None
    }

    fn number(&mut self, node: &Node, unit: &'static Unit, least: f64, greatest: f64, whole: bool) -> Option<Value> {
        let (shown, si) = match &node.content {
            Content::Number(x) => (*x, unit.to_si(*x)),
            Content::Text { text, plain } => match parse_quantity(text, unit) {
                Ok(si) => (unit.from_si(si), si),
                Err(fault) => {
                    if *plain && is_boolean_trap(text) {
                        return self.wrong(node, "a number");
                    }
                    self.report(
                        node,
                        fault.message,
                        fault.help.unwrap_or_else(|| "write a smaller number".to_owned()),
                    );
                    self.last_is(codes::WRONG_UNIT);
                    return None;
                }
            },
            _ => {
                let wanted = if unit.dimension == Dimension::None {
                    "a number".to_owned()
                } else {
                    format!("{} such as `20 {}`", unit.dimension.with_article(), unit.symbol)
                };
                return self.wrong(node, &wanted);
            }
        };
        if !shown.is_finite() {
            self.report(node, "the number is too large", "write a number of realistic size");
            self.last_is(codes::OUT_OF_BOUNDS);
            return None;
        }
        // A text is compared after a round-trip conversion: allow for rounding.
        let slack = if matches!(node.content, Content::Text { .. }) {
            1e-12 * shown.abs()
        } else {
            0.0
        };
        if shown < least - slack || shown > greatest + slack {
            let unit_name = if unit.dimension == Dimension::None {
                String::new()
            } else {
                format!(" {}", unit.symbol)
            };
            let range = match (least.is_finite(), greatest.is_finite()) {
                (true, true) => format!("{} to {}{unit_name}", tidy(least), tidy(greatest)),
                (true, false) => format!("{}{unit_name} or more", tidy(least)),
                _ => format!("{}{unit_name} or less", tidy(greatest)),
            };
            self.report(
                node,
                format!("{}{unit_name} is out of range", tidy(shown)),
                format!("write {range}"),
            );
            self.last_is(codes::OUT_OF_BOUNDS);
            return None;
        }
        if whole {
            if shown.fract() != 0.0 {
                self.report(
                    node,
                    format!("{} is not a whole number", tidy(shown)),
                    "write a whole number",
                );
                return None;
            }
            return Some(Value::from(shown as i64));
        }
        Some(Value::from(si))
    }

    fn text(&mut self, node: &Node, words: &[String]) -> Option<Value> {
        let text = match &node.content {
            Content::Text { text, plain } => {
                if *plain && is_boolean_trap(text) {
                    let help = if words.contains(text) {
                        format!("write `\"{text}\"` (in quotes)")
                    } else {
                        "choose another name, or write it in quotes".to_owned()
                    };
                    self.report(node, format!("many YAML readers treat `{text}` as a boolean"), help);
                    return None;
                }
                text
            }
            Content::Bool(_) => {
                self.report(node, "is true or false, not text", "choose another value");
                return None;
            }
            Content::Number(x) if words.is_empty() => {
                self.report(
                    node,
                    "is a number, not text",
                    format!("write it in quotes: \"{}\"", tidy(*x)),
                );
                return None;
            }
            _ => return self.wrong(node, "text"),
        };
        if !words.is_empty() && !words.contains(text) {
            let close = match words {
                [only] => Some(only.clone()),
                _ => did_you_mean(text, words.iter().map(String::as_str)).map(str::to_owned),
            };
            let finding = Diagnostic::error(self.path.clone(), format!("`{text}` is not an allowed value"))
                .at_span(node.span)
                .note(format!("allowed values: {}", words.join(", ")))
                .help(close.map_or_else(|| "write one of them".to_owned(), |close| format!("write `{close}`")));
            self.findings.push(finding.code(codes::UNKNOWN_TYPE));
            return None;
        }
        Some(Value::from(text.as_str()))
    }

    fn boolean(&mut self, node: &Node) -> Option<Value> {
        match &node.content {
            Content::Bool(b) => Some(Value::Bool(*b)),
            Content::Text { text, .. } if is_boolean_trap(text) => {
                let good = ["y", "yes", "on", "true"].contains(&text.to_ascii_lowercase().as_str());
                self.report(
                    node,
                    format!("`{text}` is text, which is not allowed here"),
                    format!("write {good}"),
                );
                None
            }
            _ => self.wrong(node, "`true` or `false`"),
        }
    }

    fn list(&mut self, node: &Node, item: &'a Shape, least: usize, most: usize) -> Option<Value> {
        let Content::List(list) = &node.content else {
            let written = match &node.content {
                Content::Number(x) => tidy(*x),
                Content::Text { text, .. } => text.clone(),
                _ => "...".to_owned(),
            };
            let entries = vec![written; least.clamp(1, 8)].join(", ");
            return self.expected(node, "a list in brackets", format!("write `[{entries}]`"));
        };
        if let Some((whole, text, rest)) = list.windows(2).find_map(split_number) {
            self.report(
                rest,
                "a decimal comma splits the number before it",
                format!("write `{whole}.{text}`, or a space after the comma if these are two values"),
            );
            return None;
        }
        if list.len() < least || list.len() > most {
            let commas = list.len() > most
                && list.windows(2).any(|pair| {
                    matches!(pair[0].content, Content::Number(_))
                        && pair[1]
                            .text()
                            .is_some_and(|t| t.starts_with(|c: char| c.is_ascii_digit()))
                });
            let help = if commas {
                "a decimal comma splits a number: write a decimal point".to_owned()
            } else if least == most {
                format!("write {least} entries")
            } else {
                format!("write at least {least} entries")
            };
            let noun = if list.len() == 1 { "entry" } else { "entries" };
            self.report(node, format!("has {} {noun}", list.len()), help);
            return None;
        }
        let before = self.findings.len();
        let values: Vec<Value> = list
            .iter()
            .enumerate()
            .filter_map(|(i, node)| {
                self.within(&i.to_string(), |w| {
                    w.places.0.insert(
                        w.path.clone(),
                        Place {
                            value: node.span,
                            key: node.span,
                        },
                    );
                    w.value(node, item)
                })
            })
            .collect();
        (self.findings.len() == before).then_some(Value::Array(values))
    }

    fn ids(&mut self, node: &Node, item: &'a Shape, digits_first: bool) -> Option<Value> {
        let Content::Map(entries) = &node.content else {
            return match &node.content {
                Content::List(list)
                    if !list.is_empty() && list.iter().all(|item| matches!(&item.content, Content::Map(_))) =>
                {
                    self.expected(
                        node,
                        "a map",
                        "write `NAME: ...` for each entry, without `-` in front".to_owned(),
                    )
                }
                Content::Text { text, .. } if matches!(self.schema.follow(item), Shape::Text(_)) => {
                    self.expected(node, "a map", format!("give it a name: `{{ NAME: {text} }}`"))
                }
                _ => self.wrong(node, "a map"),
            };
        };
        let mut map = Map::new();
        for (key, node) in entries {
            if key.name == "set" && self.is_change(node) {
                continue;
            }
            self.within(&key.name, |w| {
                if !is_id(&key.name, digits_first) {
                    let (message, help) = if is_boolean_trap(&key.name) {
                        (
                            format!("many YAML readers treat `{}` as a boolean", key.name),
                            "choose another name",
                        )
                    } else if digits_first {
                        (
                            format!("`{}` is not a valid name of a gear", key.name),
                            "write letters, digits and _",
                        )
                    } else {
                        (
                            format!("`{}` is not a valid id", key.name),
                            "start with a letter, followed by letters, digits and _",
                        )
                    };
                    w.findings
                        .push(Diagnostic::error(w.path.clone(), message).at_span(key.span).help(help));
                    w.last_is(codes::WRONG_NAME);
                }
                w.places.0.insert(
                    w.path.clone(),
                    Place {
                        value: node.span,
                        key: key.span,
                    },
                );
                if let Some(value) = w.value(node, item) {
                    map.insert(key.name.clone(), value);
                }
            });
        }
        Some(Value::Object(map))
    }

    /// Reports changes to a base file inside a section, because `set` is a top-level key; returns whether there are any.
    fn is_change(&mut self, node: &Node) -> bool {
        let schema = self.schema;
        let of_document = |fields: &[(String, Field)]| {
            fields
                .iter()
                .any(|(name, field)| name == "set" && matches!(schema.follow(&field.shape), Shape::Paths))
        };
        let Shape::Record(fields) = schema.follow(&schema.root) else {
            return false;
        };
        let Content::Map(changes) = &node.content else {
            return false;
        };
        if self.path.is_empty() || self.path.contains('.') || !of_document(fields) {
            return false;
        }
        // An entry may also have the name `set`; its keys are not paths.
        let Some((first, _)) = changes.first().filter(|(key, _)| key.name.contains('.')) else {
            return false;
        };
        let first = first.name.as_str();
        let whole = if first.starts_with(&format!("{}.", self.path)) {
            first.to_owned()
        } else {
            format!("{}.{first}", self.path)
        };
        let help = format!("write it without indentation, with full paths: `set: {{ {whole}: ... }}`");
        let error = Diagnostic::error(format!("{}.set", self.path), "`set` is a top-level key");
        self.findings.push(error.at_span(node.span).help(help));
        true
    }

    fn tagged(&mut self, node: &Node, what: &str, variants: &'a [(String, Shape)], short: &[String]) -> Option<Value> {
        let names = || variants.iter().map(|(name, _)| name.as_str());
        match &node.content {
            Content::Text { text, .. } if short.contains(text) => Some(Value::from(text.as_str())),
            Content::Text { text, .. } => {
                if names().any(|name| name == text) {
                    self.report(
                        node,
                        format!("`{text}` is text, which is not allowed here"),
                        format!("write {{ type: {text} }}"),
                    );
                } else {
                    self.unknown_type(node, what, text, &names().collect::<Vec<_>>());
                }
                None
            }
            Content::Map(_) => match node.get("type") {
                None => {
                    let finding = Diagnostic::error(self.path.clone(), format!("a {what} needs a `type`"))
                        .at_span(node.span)
                        .note(format!("linked: {}", names().collect::<Vec<_>>().join(", ")))
                        .help("`model:` replaces the complete default: add its `type`");
                    self.findings.push(finding.code(codes::MISSING_KEY));
                    None
                }
                Some(tag) => match tag.text() {
                    Some(name) => {
                        if let Some((_, Shape::Record(fields))) = variants.iter().find(|(variant, _)| variant == name) {
                            self.record(node, fields, Some((name, variants)))
                        } else {
                            self.unknown_type(tag, what, name, &names().collect::<Vec<_>>());
                            None
                        }
                    }
                    None => self.within("type", |w| w.wrong(tag, "the name of a model")),
                },
            },
            _ => self.wrong(
                node,
                &format!(
                    "a {what}, such as {{ type: ... }}{}",
                    if short.is_empty() { "" } else { " or none" }
                ),
            ),
        }
    }

    fn unknown_type(&mut self, node: &Node, what: &str, name: &str, names: &[&str]) {
        let finding = Diagnostic::error(self.path.clone(), format!("there is no {what} `{name}`"))
            .at_span(node.span)
            .note(format!("linked: {}", names.join(", ")))
            .help(match did_you_mean(name, names.iter().copied()) {
                Some(close) => format!("write `{close}`"),
                None => "choose one of them; `gearloss models` describes them".to_owned(),
            });
        self.findings.push(finding.code(codes::UNKNOWN_TYPE));
    }

    fn either(&mut self, node: &Node, shapes: &'a [Shape]) -> Option<Value> {
        let schema = self.schema;
        let fits = |shape: &&'a Shape| match (schema.follow(shape), &node.content) {
            (Shape::Number { .. }, Content::Number(_) | Content::Text { .. })
            | (Shape::List { .. }, Content::List(_))
            | (Shape::Record(_) | Shape::Ids { .. } | Shape::Paths | Shape::Tagged { .. }, Content::Map(_))
            | (Shape::Bool, Content::Bool(_))
            | (Shape::Any, _) => true,
            (Shape::Text(words), Content::Text { text, .. }) => words.is_empty() || words.contains(text),
            _ => false,
        };
        let text_first = shapes
            .iter()
            .filter(|s| matches!(schema.follow(s), Shape::Text(_)))
            .find(fits);
        // The first record with the most known keys.
        let known = |shape: &&'a Shape| match (schema.follow(shape), &node.content) {
            (Shape::Record(fields), Content::Map(entries)) => {
                let is_known = |name: &str| fields.iter().any(|(field, _)| field == name);
                entries.iter().filter(|(key, _)| is_known(&key.name)).count()
            }
            _ => 0,
        };
        if let (Content::Map(entries), true) = (
            &node.content,
            shapes.iter().any(|s| matches!(schema.follow(s), Shape::List { .. })),
        ) && let [(key, list)] = entries.as_slice()
            && matches!(list.content, Content::List(_))
            && !shapes.iter().any(|s| known(&s) > 0)
        {
            let list_name = self.path.rsplit('.').next().unwrap_or_default();
            let finding = Diagnostic::error(
                format!("{}.{}", self.path, key.name),
                format!("unknown key `{}`", key.name),
            )
            .at_span(key.span)
            .help(format!(
                "write the list itself: `{list_name}: [...]`, without `{}`",
                key.name
            ));
            self.findings.push(finding.code(codes::UNKNOWN_KEY));
            return None;
        }
        if let Some(shape) = text_first.or_else(|| shapes.iter().filter(fits).rev().max_by_key(known)) {
            self.value(node, shape)
        } else {
            let mut kinds: Vec<String> = shapes
                .iter()
                .map(|s| match schema.follow(s) {
                    Shape::Number { .. } => "a quantity".to_owned(),
                    Shape::List { .. } => "a list".to_owned(),
                    Shape::Bool => "true or false".to_owned(),
                    Shape::Text(words) if words.is_empty() => "text".to_owned(),
                    Shape::Text(words) => format!("`{}`", words.join("` or `")),
                    _ => "a map".to_owned(),
                })
                .collect();
            kinds.dedup();
            let kinds = kinds.join(" or ");
            match self.with_its_key(node, shapes) {
                Some(written) => self.expected(node, &kinds, format!("write `{written}`")),
                None => self.wrong(node, &kinds),
            }
        }
    }

    /// A text below the key of the alternative that begins with one: a file or a name.
    fn with_its_key(&self, node: &Node, shapes: &[Shape]) -> Option<String> {
        let Content::Text { text, .. } = &node.content else {
            return None;
        };
        let is_file = text.contains('.');
        shapes.iter().find_map(|shape| match self.schema.follow(shape) {
            Shape::Record(fields) => {
                let (key, field) = fields.first()?;
                let takes_file = field.refers_to.iter().any(|section| section == "file");
                let is_key = matches!(self.schema.follow(&field.shape), Shape::Text(words) if words.is_empty())
                    && takes_file == is_file;
                is_key.then(|| format!("{{ {key}: {text} }}"))
            }
            _ => None,
        })
    }

    fn record(&mut self, node: &Node, fields: &'a [(String, Field)], tag: Option<Tag<'_>>) -> Option<Value> {
        let Content::Map(entries) = &node.content else {
            return self.wrong(node, "a map of keys");
        };
        let mut map = Map::new();
        let mut behind = None;
        let mut meant: Vec<String> = Vec::new();
        let written: HashSet<&str> = entries.iter().map(|(key, _)| key.name.as_str()).collect();
        let names = fields.iter().map(|(name, _)| name.as_str());
        let open: Vec<&str> = names.filter(|name| !written.contains(name)).collect();
        for (key, node) in entries {
            if !fields.iter().any(|(name, _)| *name == key.name) {
                meant.extend(self.unknown_key((key, node), (fields, tag), &open, behind));
            }
            behind = if let Content::Number(x) = node.content {
                Some(x)
            } else {
                None
            };
        }
        for (name, field) in fields {
            let entry = entries.iter().find(|(key, _)| key.name == *name);
            let value = match entry {
                Some((key, node)) => self.within(name, |w| {
                    w.places.0.insert(
                        w.path.clone(),
                        Place {
                            value: node.span,
                            key: key.span,
                        },
                    );
                    if let (Some((tag, _)), "type") = (tag, name.as_str()) {
                        return Some(Value::from(tag));
                    }
                    if let Some(help) = w.name_instead(node, field) {
                        return w.expected(node, "a name", help);
                    }
                    w.value(node, &field.shape)
                }),
                None => match &field.default {
                    Some(default) => {
                        let places = std::mem::take(&mut self.places);
                        let before = self.findings.len();
                        let value = self.within(name, |w| w.value(&Node::from_json(default), &field.shape));
                        self.places = places;
                        for finding in &mut self.findings[before..] {
                            finding.message = format!("the default of `{name}`: {}", finding.message);
                            finding.help = Some(
                                "correct the default: it is in SI, the range in the unit of the parameter's doc comment"
                                    .to_owned(),
                            );
                        }
                        value
                    }
                    // A misspelt key is reported once.
                    None if field.required && meant.contains(name) => None,
                    None if field.required => {
                        let first_sentence = field.doc.split(". ").next().unwrap_or_default().trim_end_matches('.');
                        let help = match self.schema.follow(&field.shape) {
                            Shape::Text(words) if words.len() == 1 => format!("add `{name}: {}`", words[0]),
                            _ => format!("add `{name}:` ({first_sentence})"),
                        };
                        let finding = Diagnostic::error(self.path.clone(), format!("`{name}` is missing"))
                            .at_span(node.span)
                            .help(help);
                        self.findings.push(finding.code(codes::MISSING_KEY));
                        None
                    }
                    None => None,
                },
            };
            if let Some(value) = value {
                map.insert(name.clone(), value);
            }
        }
        if let Some(unit) = unit_of_steps(entries, fields) {
            map.insert(UNIT_OF_STEPS.to_owned(), Value::from(unit));
        }
        Some(Value::Object(map))
    }

    /// Help for a map or a list where the name of an entry of a section is expected.
    fn name_instead(&self, node: &Node, field: &Field) -> Option<String> {
        let schema = self.schema;
        let Shape::Record(sections) = schema.follow(&schema.root) else {
            return None;
        };
        let is_section = |section: &&String| sections.iter().any(|(name, _)| name == *section);
        let section = field.refers_to.iter().find(is_section)?;
        if !matches!(schema.follow(&field.shape), Shape::Text(_)) {
            return None;
        }
        match &node.content {
            Content::Map(_) => Some(format!("define it under `{section}` and write its name here")),
            Content::List(list) => {
                let names: Vec<String> = list
                    .iter()
                    .filter_map(Node::text)
                    .map(|name| format!("`{name}`"))
                    .collect();
                (!names.is_empty()).then(|| format!("write one name: {}", names.join(" or ")))
            }
            _ => None,
        }
    }

    fn unknown_key(
        &mut self,
        (key, node): (&Key, &Node),
        (fields, tag): (&[(String, Field)], Option<Tag<'_>>),
        open: &[&str],
        behind: Option<f64>,
    ) -> Vec<String> {
        let comma = behind
            .filter(|_| matches!(node.content, Content::Null) && key.name.starts_with(|c: char| c.is_ascii_digit()));
        let path = if self.path.is_empty() {
            key.name.clone()
        } else {
            format!("{}.{}", self.path, key.name)
        };
        let mut meant = Vec::new();
        let finding = if let Some(before) = comma {
            Diagnostic::error(path, "a decimal comma splits the number before it").help(format!(
                "write `{}.{}`",
                tidy(before),
                key.name
            ))
        } else {
            let names = || fields.iter().map(|(name, _)| name.as_str());
            let error = Diagnostic::error(path, format!("unknown key `{}`", key.name));
            // The key may belong to a model of another `type`.
            let of_others = tag.map(|(variant, variants)| {
                let has =
                    |shape: &Shape| matches!(shape, Shape::Record(f) if f.iter().any(|(name, _)| *name == key.name));
                let others = variants.iter().filter(|(name, shape)| name != variant && has(shape));
                let others: Vec<&str> = others.map(|(name, _)| name.as_str()).collect();
                (variant, others)
            });
            let elsewhere = match &of_others {
                _ if self.path.is_empty() => Elsewhere::No,
                Some((_, others)) if !others.is_empty() => Elsewhere::OtherType,
                _ => Elsewhere::Yes,
            };
            let help = misplaced::help(self.schema, fields, open, &key.name, elsewhere);
            meant = help.meant;
            match (help.words, of_others) {
                (Some(words), _) => error.help(words),
                (None, Some((variant, others))) if !others.is_empty() => error
                    .note(format!(
                        "keys of `{variant}`: {}",
                        names().collect::<Vec<_>>().join(", ")
                    ))
                    .help(format!(
                        "`{}` is a key of {}: choose another `type`, or a key of `{variant}`",
                        key.name,
                        others.join(", ")
                    )),
                _ => error
                    .note(format!("known keys: {}", names().collect::<Vec<_>>().join(", ")))
                    .help("choose one of these keys, or remove it"),
            }
        };
        self.findings.push(finding.at_span(key.span).code(codes::UNKNOWN_KEY));
        meant
    }

    /// All possible shapes of a path; several if it contains tagged records.
    fn shapes_at(&self, path: &str) -> Vec<&'a Shape> {
        let schema = self.schema;
        let mut shapes = vec![schema.follow(&schema.root)];
        for key in path.split('.') {
            let mut next = Vec::new();
            let mut open = shapes;
            while let Some(shape) = open.pop() {
                match shape {
                    Shape::Record(fields) => {
                        next.extend(
                            fields
                                .iter()
                                .filter(|(name, _)| name == key)
                                .map(|(_, f)| schema.follow(&f.shape)),
                        );
                    }
                    Shape::Ids { item, .. } => next.push(schema.follow(item)),
                    Shape::List { item, .. } if key.parse::<usize>().is_ok() => next.push(schema.follow(item)),
                    Shape::Tagged { variants, .. } => open.extend(variants.iter().map(|(_, s)| schema.follow(s))),
                    Shape::Either(several) => open.extend(several.iter().map(|s| schema.follow(s))),
                    Shape::Any | Shape::Paths => next.push(&Shape::Any),
                    _ => {}
                }
            }
            shapes = next;
        }
        shapes
    }
}

/// A number without rounding errors of conversions, with a power of ten if it has many digits.
fn tidy(x: f64) -> String {
    let rounded: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    if x != 0.0 && !(1e-9..1e15).contains(&x.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}
