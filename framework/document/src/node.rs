//! The tree of a document: values and their places.

use std::collections::HashMap;

use serde_json::Value;

/// A range of bytes in one of the texts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Span {
    /// Number of the text.
    pub source: u16,
    /// First byte.
    pub start: u32,
    /// Byte after the last.
    pub end: u32,
}

impl Span {
    /// The place of values without a text.
    pub const NOWHERE: Self = Self {
        source: u16::MAX,
        start: 0,
        end: 0,
    };
}

/// A value with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Content.
    pub content: Content,
    /// Place.
    pub span: Span,
}

/// Content.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// Nothing.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A plain decimal number; infinite if it is too large.
    Number(f64),
    /// Any other scalar.
    Text {
        /// The text.
        text: String,
        /// True without quotes.
        plain: bool,
    },
    /// A list.
    List(Vec<Node>),
    /// A map in the order of the document.
    Map(Vec<(Key, Node)>),
}

/// A key with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Key {
    /// The key.
    pub name: String,
    /// Place.
    pub span: Span,
}

impl Node {
    /// Kind, for messages.
    pub fn kind(&self) -> &'static str {
        match self.content {
            Content::Null => "nothing",
            Content::Bool(_) => "true or false",
            Content::Number(_) => "a number",
            Content::Text { .. } => "text",
            Content::List(_) => "a list",
            Content::Map(_) => "a map",
        }
    }

    /// The entry of a key.
    pub fn get(&self, name: &str) -> Option<&Node> {
        match &self.content {
            Content::Map(entries) => entries.iter().find(|(key, _)| key.name == name).map(|(_, node)| node),
            _ => None,
        }
    }

    /// The text, if it is one.
    pub fn text(&self) -> Option<&str> {
        match &self.content {
            Content::Text { text, .. } => Some(text),
            _ => None,
        }
    }

    /// Nodes of a JSON value.
    pub fn from_json(value: &Value) -> Self {
        let content = match value {
            Value::Null => Content::Null,
            Value::Bool(b) => Content::Bool(*b),
            Value::Number(n) => Content::Number(n.as_f64().unwrap_or(f64::INFINITY)),
            Value::String(text) => Content::Text {
                text: text.clone(),
                plain: false,
            },
            Value::Array(list) => Content::List(list.iter().map(Self::from_json).collect()),
            Value::Object(map) => Content::Map(
                map.iter()
                    .map(|(name, value)| {
                        (
                            Key {
                                name: name.clone(),
                                span: Span::NOWHERE,
                            },
                            Self::from_json(value),
                        )
                    })
                    .collect(),
            ),
        };
        Self {
            content,
            span: Span::NOWHERE,
        }
    }

    /// The value without places, for a validator of the published schema.
    pub fn to_json(&self) -> Value {
        match &self.content {
            Content::Null => Value::Null,
            Content::Bool(b) => Value::Bool(*b),
            Content::Number(x) if x.fract() == 0.0 && x.abs() < 1e15 => Value::from(*x as i64),
            Content::Number(x) => Value::from(*x),
            Content::Text { text, .. } => Value::from(text.as_str()),
            Content::List(list) => Value::Array(list.iter().map(Self::to_json).collect()),
            Content::Map(map) => Value::Object(
                map.iter()
                    .map(|(key, node)| (key.name.clone(), node.to_json()))
                    .collect(),
            ),
        }
    }

    /// Merges this document into a base: maps key by key; other values replace those of the base.
    pub fn merged_over(self, base: Node) -> Node {
        match (self.content, base.content) {
            (Content::Map(over), Content::Map(mut entries)) => {
                let names = entries.iter().enumerate().map(|(i, (key, _))| (key.name.clone(), i));
                let known: HashMap<String, usize> = names.collect();
                // The keys of a document differ.
                for (key, node) in over {
                    match known.get(&key.name).copied() {
                        Some(i) => {
                            let (_, under) = std::mem::replace(&mut entries[i], (key.clone(), NOTHING));
                            entries[i] = (key, node.merged_over(under));
                        }
                        None => entries.push((key, node)),
                    }
                }
                Node {
                    content: Content::Map(entries),
                    span: self.span,
                }
            }
            (content, _) => Node {
                content,
                span: self.span,
            },
        }
    }
}

const NOTHING: Node = Node {
    content: Content::Null,
    span: Span::NOWHERE,
};
