//! A model from JSON. Every part is read from its own piece of the text, so that findings have places.

use std::collections::BTreeMap;

use gearloss_document::{Diagnostic, Span};
use serde::Deserialize;
use serde_json::value::RawValue;

use super::coded;
use super::graph::Builder;
use super::model::{Attribute, Component, Id, LONGEST_LIST, LoadCase, Model, Relation, Spectrum, Value};
use crate::codes;

/// Most parts (relations, components, attributes, load cases); a model of 10 MB has about a hundred thousand.
const MOST_PARTS: usize = 2_000_000;

#[derive(Deserialize)]
struct Root<'a> {
    #[serde(borrow)]
    model: &'a RawValue,
}

type Raw<'a> = Option<&'a RawValue>;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ModelPart<'a> {
    version: Option<String>,
    application_id: Option<String>,
    application_version: Option<String>,
    #[serde(borrow)]
    relations: Raw<'a>,
    #[serde(borrow)]
    components: Raw<'a>,
    #[serde(borrow, rename = "load_spectrum")]
    load_spectrum: Raw<'a>,
}

#[derive(Deserialize)]
struct RelationPart<'a> {
    id: Id,
    #[serde(rename = "type", default)]
    kind: String,
    #[serde(borrow)]
    refs: Raw<'a>,
}

#[derive(Deserialize)]
struct RefPart {
    id: Id,
    #[serde(default)]
    role: String,
}

#[derive(Deserialize)]
struct ComponentPart<'a> {
    id: Id,
    #[serde(rename = "type", default)]
    kind: String,
    name: Option<String>,
    #[serde(borrow)]
    attributes: Raw<'a>,
}

/// An encoded array or matrix.
#[derive(Deserialize)]
struct CodedPart {
    code: String,
    value: String,
    /// Of a matrix.
    columns: Option<usize>,
}

#[derive(Deserialize)]
struct SpectrumPart<'a> {
    #[serde(borrow)]
    load_cases: Raw<'a>,
}

#[derive(Deserialize)]
struct CasePart<'a> {
    id: Id,
    #[serde(borrow)]
    components: Raw<'a>,
}

/// The model, with all findings.
pub fn read(text: &str) -> (Model, Vec<Diagnostic>) {
    let mut reader = Reader {
        text,
        builder: Builder::default(),
        parts: 0,
    };
    reader.model();
    if reader.parts > MOST_PARTS {
        let found = Diagnostic::error("", format!("the file has more than {MOST_PARTS} parts"))
            .code(codes::REXS_LIMIT)
            .help("export the model again, without results of calculations");
        return (Model::default(), vec![found]);
    }
    reader.builder.finish()
}

struct Reader<'a> {
    text: &'a str,
    builder: Builder,
    parts: usize,
}

impl<'a> Reader<'a> {
    fn model(&mut self) {
        let root = match serde_json::from_str::<Root<'a>>(self.text) {
            Ok(root) => root,
            Err(fault) => return self.wrong("the file", self.text, &fault),
        };
        let Some(model) = self.part::<ModelPart<'a>>("`model`", root.model) else {
            return;
        };
        self.builder.model.version = model.version.unwrap_or_default();
        self.builder.set_application(&[
            model.application_id.unwrap_or_default(),
            model.application_version.unwrap_or_default(),
        ]);
        for raw in self.list("`relations`", model.relations) {
            self.relation(raw);
        }
        for raw in self.list("`components`", model.components) {
            if let Some(component) = self.component(raw) {
                self.builder.add(component);
            }
        }
        // One spectrum as an object, or several as a list.
        if let Some(raw) = model.load_spectrum {
            let all = if raw.get().starts_with('[') {
                self.list("`load_spectrum`", Some(raw))
            } else {
                vec![raw]
            };
            for raw in all {
                self.spectrum(raw);
            }
        }
    }

    fn relation(&mut self, raw: &'a RawValue) {
        let Some(part) = self.part::<RelationPart<'a>>("a relation", raw) else {
            return;
        };
        let mut refs = Vec::new();
        for raw in self.list("`refs`", part.refs) {
            if let Some(part) = self.part::<RefPart>("a reference", raw) {
                refs.push((part.role, part.id));
            }
        }
        self.builder.model.relations.push(Relation {
            id: part.id,
            kind: part.kind,
            refs,
            span: self.span(raw.get()),
        });
    }

    fn component(&mut self, raw: &'a RawValue) -> Option<Component> {
        let part = self.part::<ComponentPart<'a>>("a component", raw)?;
        let mut attributes = Vec::new();
        for raw in self.list("`attributes`", part.attributes) {
            attributes.extend(self.attribute(raw));
        }
        Some(Component {
            id: part.id,
            kind: part.kind,
            name: part.name.unwrap_or_default(),
            attributes,
            span: self.span(raw.get()),
        })
    }

    /// An attribute has its id, its unit, and its value under the name of its type.
    fn attribute(&mut self, raw: &'a RawValue) -> Option<Attribute> {
        let keys = self.part::<BTreeMap<String, &'a RawValue>>("an attribute", raw)?;
        let word = |key: &str| {
            keys.get(key)
                .and_then(|raw| serde_json::from_str::<String>(raw.get()).ok())
        };
        let value = keys
            .iter()
            .find(|(key, _)| *key != "id" && *key != "unit")
            .map_or(Value::Text(String::new()), |(_, raw)| value(raw.get()));
        Some(Attribute {
            id: word("id").unwrap_or_default(),
            unit: word("unit").unwrap_or_default().trim().to_owned(),
            value,
            span: self.span(raw.get()),
        })
    }

    fn spectrum(&mut self, raw: &'a RawValue) {
        let Some(part) = self.part::<SpectrumPart<'a>>("a load spectrum", raw) else {
            return;
        };
        let mut cases = Vec::new();
        for raw in self.list("`load_cases`", part.load_cases) {
            let Some(part) = self.part::<CasePart<'a>>("a load case", raw) else {
                continue;
            };
            let mut components = BTreeMap::new();
            for raw in self.list("`components`", part.components) {
                if let Some(component) = self.component(raw) {
                    let component = self.builder.renamed(component);
                    components.insert(component.id, component);
                }
            }
            cases.push(LoadCase {
                id: part.id,
                components,
            });
        }
        self.builder.model.spectra.push(Spectrum { cases });
    }

    fn part<T: Deserialize<'a>>(&mut self, what: &str, raw: &'a RawValue) -> Option<T> {
        self.parts += 1;
        if self.parts > MOST_PARTS {
            return None;
        }
        match serde_json::from_str(raw.get()) {
            Ok(part) => Some(part),
            Err(fault) => {
                self.wrong(what, raw.get(), &fault);
                None
            }
        }
    }

    fn list(&mut self, what: &str, raw: Raw<'a>) -> Vec<&'a RawValue> {
        let list = raw.and_then(|raw| self.part::<Option<Vec<&'a RawValue>>>(what, raw));
        list.flatten().unwrap_or_default()
    }

    fn wrong(&mut self, what: &str, piece: &str, fault: &serde_json::Error) {
        let start = self.offset(piece);
        let lines = piece.split_inclusive('\n');
        let before: usize = lines.take(fault.line().saturating_sub(1)).map(str::len).sum();
        let mut at = (start + before + fault.column().saturating_sub(1)).min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        let message = fault.to_string();
        let message = message.split(" at line ").next().unwrap_or_default();
        let message: String = message.chars().take(200).collect();
        self.builder.report(
            Diagnostic::error("", format!("{what} cannot be read: {message}"))
                .code(codes::REXS_FILE)
                .at_span(Span {
                    source: 0,
                    start: at as u32,
                    end: at as u32,
                })
                .help("export the file again; it may be incomplete"),
        );
    }

    /// Where a piece of the text begins in it.
    fn offset(&self, piece: &str) -> usize {
        (piece.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    /// The first line of a piece: the rest may be long.
    fn span(&self, piece: &str) -> Span {
        let start = self.offset(piece);
        let first = piece.lines().next().unwrap_or_default();
        Span {
            source: 0,
            start: start as u32,
            end: (start + first.len()) as u32,
        }
    }
}

/// A value: text, numbers as written, or a list of them.
fn value(raw: &str) -> Value {
    let scalar = |raw: &str| -> Option<String> {
        match raw.bytes().next()? {
            b'"' => serde_json::from_str::<String>(raw)
                .ok()
                .map(|text| text.trim().to_owned()),
            b'[' | b'{' => None,
            _ => Some(raw.to_owned()),
        }
    };
    if raw.starts_with('{') {
        let part = serde_json::from_str::<CodedPart>(raw);
        return part.map_or(Value::Other, |part| match part.columns {
            Some(columns) => coded::matrix(&part.code, &part.value, columns),
            None => coded::array(&part.code, &part.value),
        });
    }
    if !raw.starts_with('[') {
        return scalar(raw).map_or(Value::Other, Value::Text);
    }
    let parts = |raw: &str| -> Option<Vec<String>> {
        let cells = serde_json::from_str::<Vec<&RawValue>>(raw).ok();
        let cells = cells.filter(|cells| cells.len() <= LONGEST_LIST)?;
        cells.iter().map(|cell| scalar(cell.get())).collect()
    };
    if let Some(cells) = parts(raw) {
        return Value::List(cells);
    }
    let rows = serde_json::from_str::<Vec<&RawValue>>(raw).ok();
    let rows = rows.filter(|rows| rows.len() <= LONGEST_LIST);
    let rows = rows.and_then(|rows| rows.iter().map(|row| parts(row.get())).collect());
    rows.map_or(Value::Other, Value::Rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoded_arrays_are_lists() {
        let list = Value::List(vec!["1".to_owned(), "-2".to_owned()]);
        assert_eq!(value(r#"{ "code": "int32", "value": "AQAAAP7///8=" }"#), list);
        assert_eq!(value(r#"{ "other": 1 }"#), Value::Other);
    }
}
