//! Documents as trees that need not make sense, and their text.

use gearloss_framework::document::{Content, Node, read_yaml};

use super::random::Random;

/// A document, or a part of one.
#[derive(Debug, Clone, PartialEq)]
pub enum Tree {
    /// What is neither list nor map, as written; in quotes where it would be a number without.
    Scalar(String),
    List(Vec<Tree>),
    /// In order; a key may stand twice.
    Map(Vec<(String, Tree)>),
}

/// Where a part stands: which child, from the top down.
pub type Way = Vec<usize>;

impl Tree {
    pub fn read(text: &str) -> Self {
        let read = read_yaml(0, text);
        assert!(read.findings.is_empty(), "{:?}\n{text}", read.findings);
        Self::from_node(&read.node)
    }

    fn from_node(node: &Node) -> Self {
        match &node.content {
            Content::Null => Self::Scalar(String::new()),
            Content::Bool(is) => Self::Scalar(is.to_string()),
            Content::Number(x) => Self::Scalar(x.to_string()),
            Content::Text { text, .. } if text.parse::<f64>().is_ok() => Self::Scalar(format!("\"{text}\"")),
            Content::Text { text, .. } => Self::Scalar(text.clone()),
            Content::List(list) => Self::List(list.iter().map(Self::from_node).collect()),
            Content::Map(map) => Self::Map(
                map.iter()
                    .map(|(key, node)| (key.name.clone(), Self::from_node(node)))
                    .collect(),
            ),
        }
    }

    pub fn get(&self, key: &str) -> Option<&Self> {
        match self {
            Self::Map(map) => map.iter().find(|(known, _)| known == key).map(|(_, tree)| tree),
            _ => None,
        }
    }

    pub fn set(&mut self, key: &str, tree: Self) {
        if let Self::Map(map) = self {
            map.retain(|(known, _)| known != key);
            map.push((key.to_owned(), tree));
        }
    }

    pub fn len(&self) -> usize {
        match self {
            Self::Scalar(_) => 0,
            Self::List(list) => list.len(),
            Self::Map(map) => map.len(),
        }
    }

    pub fn child(&self, place: usize) -> Option<&Self> {
        match self {
            Self::Scalar(_) => None,
            Self::List(list) => list.get(place),
            Self::Map(map) => map.get(place).map(|(_, tree)| tree),
        }
    }

    fn child_mut(&mut self, place: usize) -> Option<&mut Self> {
        match self {
            Self::Scalar(_) => None,
            Self::List(list) => list.get_mut(place),
            Self::Map(map) => map.get_mut(place).map(|(_, tree)| tree),
        }
    }

    pub fn subtree(&self, way: &[usize]) -> Option<&Self> {
        way.iter().try_fold(self, |tree, place| tree.child(*place))
    }

    pub fn at_mut(&mut self, way: &[usize]) -> Option<&mut Self> {
        way.iter().try_fold(self, |tree, place| tree.child_mut(*place))
    }

    /// Key of what stands at a way; empty in a list.
    pub fn key(&self, way: &[usize]) -> &str {
        let Some((last, above)) = way.split_last() else {
            return "";
        };
        match self.subtree(above) {
            Some(Self::Map(map)) => map.get(*last).map_or("", |(key, _)| key),
            _ => "",
        }
    }

    /// Ways to everything below, and to the whole.
    pub fn ways(&self) -> Vec<Way> {
        let mut all = Vec::new();
        self.collect(&mut Vec::new(), &mut all);
        all
    }

    fn collect(&self, way: &mut Way, all: &mut Vec<Way>) {
        all.push(way.clone());
        for place in 0..self.len() {
            way.push(place);
            if let Some(child) = self.child(place) {
                child.collect(way, all);
            }
            way.pop();
        }
    }

    /// The text, in block style where that is chosen and in flow style within.
    pub fn text(&self, random: &mut Random) -> String {
        let mut text = String::new();
        match self {
            Self::Map(map) => {
                for (key, tree) in map {
                    text.push_str(&scalar(key));
                    text.push(':');
                    tree.block(2, random, &mut text);
                }
            }
            other => {
                other.flow(&mut text);
                text.push('\n');
            }
        }
        text
    }

    /// What follows a colon.
    fn block(&self, indent: usize, random: &mut Random, text: &mut String) {
        match self {
            Self::Map(map) if !map.is_empty() && indent < 8 && !random.once_in(4) => {
                text.push('\n');
                for (key, tree) in map {
                    text.push_str(&" ".repeat(indent));
                    text.push_str(&scalar(key));
                    text.push(':');
                    tree.block(indent + 2, random, text);
                }
            }
            other => {
                text.push(' ');
                other.flow(text);
                text.push('\n');
            }
        }
    }

    fn flow(&self, text: &mut String) {
        match self {
            Self::Scalar(written) => text.push_str(&scalar(written)),
            Self::List(list) => {
                text.push('[');
                for (i, tree) in list.iter().enumerate() {
                    text.push_str(if i > 0 { ", " } else { "" });
                    tree.flow(text);
                }
                text.push(']');
            }
            Self::Map(map) => {
                text.push_str("{ ");
                for (i, (key, tree)) in map.iter().enumerate() {
                    text.push_str(if i > 0 { ", " } else { "" });
                    text.push_str(&scalar(key));
                    text.push_str(": ");
                    tree.flow(text);
                }
                text.push_str(" }");
            }
        }
    }
}

/// A scalar as YAML reads it back: with quotes where it would be something else without.
fn scalar(text: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || " ._+-/%^*()<>=~".contains(c);
    let is_plain = text.chars().all(plain)
        && text.starts_with(|c: char| c.is_alphanumeric() || c == '.' || c == '-' && text.len() > 1)
        && !text.starts_with("- ")
        && !text.starts_with("--")
        && !text.ends_with(' ');
    let is_quoted = text.starts_with('"') && serde_json::from_str::<String>(text).is_ok();
    if is_plain || is_quoted || text.is_empty() {
        text.to_owned()
    } else {
        serde_json::to_string(text).unwrap_or_default()
    }
}
