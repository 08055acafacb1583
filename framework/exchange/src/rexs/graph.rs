//! Puts the parts of a file together and checks that they refer to each other.

use std::collections::{BTreeMap, BTreeSet};

use gearloss_document::{Diagnostic, Span};

use super::aliases::{newest_attribute, newest_component};
use super::model::{Component, Id, Model, Value};
use crate::codes;

/// Most findings that are kept: a broken file may have one in every line.
const MOST_FINDINGS: usize = 50;

/// A model that grows, with the findings so far.
#[derive(Debug, Default)]
pub struct Builder {
    pub model: Model,
    found: Vec<Diagnostic>,
}

impl Builder {
    /// Name and version of the program that wrote the file.
    pub fn set_application(&mut self, words: &[String; 2]) {
        words.join(" ").trim().clone_into(&mut self.model.application);
    }

    /// Adds a component.
    pub fn add(&mut self, component: Component) {
        let component = self.renamed(component);
        if let Some(first) = self.model.components.get(&component.id) {
            let found = Diagnostic::error(
                "",
                format!("{}: the id {} occurs twice", component.label(), component.id),
            )
            .code(codes::REXS_MODEL)
            .at_span(component.span)
            .label(first.span, "first here")
            .help("give one of the components another id, in the relations too");
            self.report(found);
            return;
        }
        self.model.components.insert(component.id, component);
    }

    /// A component with the newest names; an attribute may occur twice with the same value.
    pub fn renamed(&mut self, mut component: Component) -> Component {
        let kind = newest_component(&component.kind).to_owned();
        component.kind = kind;
        let mut seen: BTreeMap<String, Value> = BTreeMap::new();
        let mut twice = None;
        for attribute in &mut component.attributes {
            let id = newest_attribute(&component.kind, &attribute.id).to_owned();
            attribute.id = id;
            match seen.get(&attribute.id) {
                Some(first) if *first != attribute.value => {
                    twice.get_or_insert((attribute.id.clone(), attribute.span));
                }
                Some(_) => {}
                None => {
                    seen.insert(attribute.id.clone(), attribute.value.clone());
                }
            }
        }
        if let Some((id, span)) = twice {
            let found = Diagnostic::error("", format!("{}: the attribute {id} has two values", component.label()))
                .code(codes::REXS_MODEL)
                .at_span(span)
                .help("delete one of them");
            self.report(found);
        }
        component
    }

    pub fn report(&mut self, finding: Diagnostic) {
        if self.found.len() < MOST_FINDINGS {
            self.found.push(finding);
        }
    }

    pub fn bad_id(&mut self, what: &str, written: &str, span: Span) {
        let written: String = written.chars().take(40).collect();
        let found = Diagnostic::error("", format!("{what}: the id `{written}` is not an integer"))
            .code(codes::REXS_FILE)
            .at_span(span)
            .help("write the number of the component or relation");
        self.report(found);
    }

    /// The model, and the findings with those of relations to components that are missing.
    pub fn finish(mut self) -> (Model, Vec<Diagnostic>) {
        let relations = std::mem::take(&mut self.model.relations);
        let mut ids: BTreeSet<Id> = BTreeSet::new();
        for relation in &relations {
            let label = format!("relation {} ({})", relation.id, relation.kind);
            if !ids.insert(relation.id) {
                let found = Diagnostic::error("", format!("{label}: the id {} occurs twice", relation.id));
                self.report(
                    found
                        .code(codes::REXS_MODEL)
                        .at_span(relation.span)
                        .help("give one of the relations another id"),
                );
            }
            for (role, id) in &relation.refs {
                if !self.model.components.contains_key(id) {
                    let found =
                        Diagnostic::error("", format!("{label}: there is no component {id} for the role `{role}`"));
                    self.report(
                        found
                            .code(codes::REXS_MODEL)
                            .at_span(relation.span)
                            .help("add the component, or delete the relation"),
                    );
                }
            }
        }
        self.model.relations = relations;
        (self.model, self.found)
    }
}
