//! A model from XML.

use std::collections::BTreeMap;

use gearloss_document::{Diagnostic, Span};
use roxmltree::{Document, Node, ParsingOptions};

use super::coded;
use super::graph::Builder;
use super::model::{Attribute, Component, Id, LONGEST_LIST, LoadCase, Model, Relation, Spectrum, Value};
use crate::codes;

/// Most elements and texts; a model of 10 MB has about a million.
const MOST_NODES: u32 = 4_000_000;
/// Most XML attributes of the file, and of one element. The parser compares each with all before it in its element.
const MOST_ATTRIBUTES: usize = 4_000_000;
const MOST_OF_ONE: usize = 256;
/// Most declarations of namespaces, which the parser copies for every element below.
const MOST_NAMESPACES: usize = 64;

/// The model, with all findings.
pub fn read(text: &str) -> (Model, Vec<Diagnostic>) {
    let mut builder = Builder::default();
    if let Err(finding) = within_limits(text) {
        return (Model::default(), vec![finding]);
    }
    let options = ParsingOptions {
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let document = match Document::parse_with_options(text, options) {
        Ok(document) => document,
        Err(fault) => return (Model::default(), vec![syntax(text, &fault)]),
    };
    let root = document.root_element();
    if root.tag_name().name() != "model" {
        let found = Diagnostic::error(
            "",
            format!(
                "the first element is `{}`, not `model`",
                shortened(root.tag_name().name())
            ),
        )
        .code(codes::REXS_FILE)
        .at_span(start_of(root))
        .help("give a REXS model");
        return (Model::default(), vec![found]);
    }
    builder.model.version = text_of(root, "version");
    builder.set_application(&[text_of(root, "applicationId"), text_of(root, "applicationVersion")]);
    for part in elements(root) {
        match part.tag_name().name() {
            "relations" => elements(part).for_each(|node| relation(&mut builder, node)),
            "components" => {
                for node in elements(part) {
                    if let Some(component) = component(&mut builder, node) {
                        builder.add(component);
                    }
                }
            }
            "load_spectrum" => spectrum(&mut builder, part),
            _ => {}
        }
    }
    builder.finish()
}

/// Limits that the parser does not have: what takes it much time or memory.
fn within_limits(text: &str) -> Result<(), Diagnostic> {
    let (mut all, mut of_one) = (0, 0);
    for byte in text.bytes() {
        match byte {
            b'<' => of_one = 0,
            b'=' => {
                all += 1;
                of_one += 1;
            }
            _ => {}
        }
        if of_one > MOST_OF_ONE || all > MOST_ATTRIBUTES {
            return Err(limit("the file has too many XML attributes"));
        }
    }
    if text.matches("xmlns").nth(MOST_NAMESPACES).is_some() {
        return Err(limit("the file declares too many XML namespaces"));
    }
    Ok(())
}

fn limit(message: &str) -> Diagnostic {
    Diagnostic::error("", message)
        .code(codes::REXS_LIMIT)
        .help("export the model again, without results of calculations")
}

fn syntax(text: &str, fault: &roxmltree::Error) -> Diagnostic {
    match fault {
        roxmltree::Error::NodesLimitReached => return limit("the file has too many elements"),
        roxmltree::Error::DtdDetected => {
            return Diagnostic::error("", "the file has a document type declaration, which is not read")
                .code(codes::REXS_FILE)
                .help("delete the lines of `<!DOCTYPE ...>`");
        }
        _ => {}
    }
    let place = fault.pos();
    let before: usize = text
        .split_inclusive('\n')
        .take(place.row.saturating_sub(1) as usize)
        .map(str::len)
        .sum();
    let within = text.get(before..).unwrap_or_default();
    let column = within
        .char_indices()
        .nth(place.col.saturating_sub(1) as usize)
        .map_or(within.len(), |(at, _)| at);
    let at = (before + column).min(text.len());
    Diagnostic::error("", format!("the XML is wrong: {}", shortened(&fault.to_string())))
        .code(codes::REXS_FILE)
        .at_span(span(at, at))
        .help("export the file again; it may be incomplete")
}

/// Names in a broken file can be of any length.
fn shortened(text: &str) -> String {
    text.chars().take(200).collect()
}

fn span(start: usize, end: usize) -> Span {
    Span {
        source: 0,
        start: start as u32,
        end: end as u32,
    }
}

/// The start tag of an element: its content may have many lines.
fn start_of(node: Node<'_, '_>) -> Span {
    let range = node.range();
    let text = &node.document().input_text()[range.clone()];
    let end = text.find('>').map_or(range.end, |at| range.start + at + 1);
    span(range.start, end)
}

fn elements<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(Node::is_element)
}

fn text_of(node: Node<'_, '_>, name: &str) -> String {
    node.attribute(name).unwrap_or_default().trim().to_owned()
}

fn id_of(builder: &mut Builder, node: Node<'_, '_>) -> Option<Id> {
    let written = node.attribute("id").unwrap_or_default();
    let id = written.trim().parse().ok();
    if id.is_none() {
        let what = node.tag_name().name().to_owned();
        builder.bad_id(&what, written, start_of(node));
    }
    id
}

fn relation(builder: &mut Builder, node: Node<'_, '_>) {
    if node.tag_name().name() != "relation" {
        return;
    }
    let Some(id) = id_of(builder, node) else {
        return;
    };
    let mut refs = Vec::new();
    for part in elements(node).filter(|part| part.tag_name().name() == "ref") {
        if let Some(id) = id_of(builder, part) {
            refs.push((text_of(part, "role"), id));
        }
    }
    builder.model.relations.push(Relation {
        id,
        kind: text_of(node, "type"),
        refs,
        span: start_of(node),
    });
}

fn component(builder: &mut Builder, node: Node<'_, '_>) -> Option<Component> {
    if node.tag_name().name() != "component" {
        return None;
    }
    let id = id_of(builder, node)?;
    let attributes = elements(node)
        .filter(|part| part.tag_name().name() == "attribute")
        .map(|part| Attribute {
            id: text_of(part, "id"),
            unit: text_of(part, "unit"),
            value: value(part),
            span: start_of(part),
        })
        .collect();
    Some(Component {
        id,
        kind: text_of(node, "type"),
        name: text_of(node, "name"),
        attributes,
        span: start_of(node),
    })
}

fn value(node: Node<'_, '_>) -> Value {
    let Some(content) = elements(node).next() else {
        return Value::Text(node.text().unwrap_or_default().trim().to_owned());
    };
    let text = content.text().unwrap_or_default();
    match (content.tag_name().name(), content.attribute("code")) {
        ("array", Some(code)) => coded::array(code, text),
        ("array", None) => cells(content).map_or(Value::Other, Value::List),
        ("matrix", Some(code)) => coded::matrix(code, text, text_of(content, "columns").parse().unwrap_or(0)),
        ("matrix", None) => {
            let rows: Option<Vec<Vec<String>>> = elements(content).take(LONGEST_LIST + 1).map(cells).collect();
            rows.filter(|rows| rows.len() <= LONGEST_LIST)
                .map_or(Value::Other, Value::Rows)
        }
        _ => Value::Other,
    }
}

/// The texts of an array, or of a row; `None` if it is too long.
fn cells(node: Node<'_, '_>) -> Option<Vec<String>> {
    let cells: Vec<String> = elements(node)
        .take(LONGEST_LIST + 1)
        .map(|cell| cell.text().unwrap_or_default().trim().to_owned())
        .collect();
    (cells.len() <= LONGEST_LIST).then_some(cells)
}

fn spectrum(builder: &mut Builder, node: Node<'_, '_>) {
    let mut cases = Vec::new();
    for part in elements(node).filter(|part| part.tag_name().name() == "load_case") {
        let Some(id) = id_of(builder, part) else {
            continue;
        };
        let mut components = BTreeMap::new();
        for node in elements(part) {
            if let Some(component) = component(builder, node) {
                let component = builder.renamed(component);
                components.insert(component.id, component);
            }
        }
        cases.push(LoadCase { id, components });
    }
    builder.model.spectra.push(Spectrum { cases });
}
