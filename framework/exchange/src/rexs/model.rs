//! A REXS model as a graph: components with attributes, relations between them, load cases that replace attributes.

use std::collections::BTreeMap;

use gearloss_document::Span;

/// Id of a component.
pub type Id = i64;

/// A model as written in a file. Component types and attribute ids are those of the newest version.
#[derive(Debug, Default)]
pub struct Model {
    pub version: String,
    /// Program that wrote the file, with its version.
    pub application: String,
    pub components: BTreeMap<Id, Component>,
    pub relations: Vec<Relation>,
    pub spectra: Vec<Spectrum>,
}

/// A component, or the attributes of it that a load case replaces.
#[derive(Debug, Clone)]
pub struct Component {
    pub id: Id,
    pub kind: String,
    pub name: String,
    pub attributes: Vec<Attribute>,
    pub span: Span,
}

impl Component {
    pub fn attribute(&self, id: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.id == id)
    }

    /// Type and id, as messages name a component.
    pub fn label(&self) -> String {
        format!("{} {}", self.kind, self.id)
    }
}

#[derive(Debug, Clone)]
pub struct Attribute {
    pub id: String,
    pub unit: String,
    pub value: Value,
    pub span: Span,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number, truth value, reference or text, as written.
    Text(String),
    /// An array.
    List(Vec<String>),
    /// A matrix.
    Rows(Vec<Vec<String>>),
    /// Other values, and arrays and matrices that are too long.
    Other,
}

/// Arrays with more values and matrices with more rows become [`Value::Other`]; the points of a flank are some thousands.
pub const LONGEST_LIST: usize = 20_000;

impl Value {
    /// Rows of a matrix that is written as one list.
    pub fn rows(self, columns: usize) -> Self {
        match self {
            Self::List(cells) if columns > 0 && cells.len() % columns == 0 => {
                Self::Rows(cells.chunks(columns).map(<[String]>::to_vec).collect())
            }
            _ => Self::Other,
        }
    }
}

#[derive(Debug)]
pub struct Relation {
    pub id: Id,
    pub kind: String,
    /// Role and component.
    pub refs: Vec<(String, Id)>,
    pub span: Span,
}

impl Relation {
    /// The component in a role.
    pub fn role(&self, role: &str) -> Option<Id> {
        self.refs.iter().find(|(known, _)| known == role).map(|(_, id)| *id)
    }
}

#[derive(Debug)]
pub struct Spectrum {
    pub cases: Vec<LoadCase>,
}

#[derive(Debug)]
pub struct LoadCase {
    pub id: Id,
    pub components: BTreeMap<Id, Component>,
}
