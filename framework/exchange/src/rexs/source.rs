//! Reads values of a model with their units; remembers which were used, and collects what is to be said about them.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use gearloss_document::{Diagnostic, Severity};

use super::aliases::newest_value;
use super::model::{Attribute, Component, Id, Model, Relation, Value};
use super::units::{Quantity, converted, known};
use crate::codes;

/// Largest value that is read; rigid couplings have stiffnesses of 1e23. Larger ones would give sums that are no numbers.
const LARGEST: f64 = 1e30;
/// Largest coordinate. \[mm\]
const FARTHEST: f64 = 1e6;

/// Most findings that are shown.
const MOST_FINDINGS: usize = 20;

/// A model that is read, with findings and the lines of the report.
#[derive(Debug)]
pub struct Source<'a> {
    pub model: &'a Model,
    /// Components by type.
    kinds: BTreeMap<&'a str, Vec<&'a Component>>,
    /// Relations by type.
    relations: BTreeMap<&'a str, Vec<&'a Relation>>,
    used: RefCell<BTreeSet<(Id, String)>>,
    found: RefCell<Vec<Diagnostic>>,
    /// What was ignored or replaced, and why.
    pub notes: RefCell<Vec<String>>,
    /// What was assumed.
    pub assumptions: RefCell<Vec<String>>,
    /// What losses need and the model does not have.
    pub missing: RefCell<Vec<String>>,
}

/// Appends a line unless it is there already.
fn add(lines: &RefCell<Vec<String>>, line: String) {
    let mut lines = lines.borrow_mut();
    if !lines.contains(&line) {
        lines.push(line);
    }
}

impl<'a> Source<'a> {
    pub fn new(model: &'a Model) -> Self {
        let mut relations: BTreeMap<&str, Vec<&Relation>> = BTreeMap::new();
        for relation in &model.relations {
            relations.entry(&relation.kind).or_default().push(relation);
        }
        let mut kinds: BTreeMap<&str, Vec<&Component>> = BTreeMap::new();
        for component in model.components.values() {
            kinds.entry(&component.kind).or_default().push(component);
        }
        Self {
            model,
            kinds,
            relations,
            used: RefCell::default(),
            found: RefCell::default(),
            notes: RefCell::default(),
            assumptions: RefCell::default(),
            missing: RefCell::default(),
        }
    }

    pub fn note(&self, line: impl Into<String>) {
        add(&self.notes, line.into());
    }

    pub fn assume(&self, line: impl Into<String>) {
        add(&self.assumptions, line.into());
    }

    pub fn missing(&self, line: impl Into<String>) {
        add(&self.missing, line.into());
    }

    pub fn report(&self, finding: Diagnostic) {
        self.found.borrow_mut().push(finding);
    }

    /// An error about a component.
    pub fn error(&self, component: &Component, code: gearloss_document::Code, message: &str, help: &str) {
        let message = format!("{}: {message}", component.label());
        self.report(
            Diagnostic::error("", message)
                .code(code)
                .at_span(component.span)
                .help(help),
        );
    }

    pub fn has_errors(&self) -> bool {
        self.found
            .borrow()
            .iter()
            .any(|finding| finding.severity == Severity::Error)
    }

    /// The findings: the first of them, if there are many.
    pub fn findings(&self) -> Vec<Diagnostic> {
        let mut found = self.found.take();
        let more = found.len().saturating_sub(MOST_FINDINGS);
        found.truncate(MOST_FINDINGS);
        if let (1.., Some(last)) = (more, found.last_mut()) {
            last.notes.push(format!("and {}", counted(more, "more finding")));
        }
        found
    }

    /// All components of a type, by id.
    pub fn components(&self, kind: &str) -> impl Iterator<Item = &'a Component> + use<'a, '_> {
        self.kinds.get(kind).into_iter().flatten().copied()
    }

    pub fn component(&self, id: Id) -> Option<&'a Component> {
        self.model.components.get(&id)
    }

    /// All relations of a type.
    pub fn relations(&self, kind: &str) -> impl Iterator<Item = &'a Relation> + use<'a, '_> {
        self.relations.get(kind).into_iter().flatten().copied()
    }

    /// The attribute, marked as used.
    fn attribute<'c>(&self, component: &'c Component, id: &str) -> Option<&'c Attribute> {
        let attribute = component.attribute(id)?;
        self.used.borrow_mut().insert((component.id, id.to_owned()));
        Some(attribute)
    }

    fn value_error(&self, component: &Component, attribute: &Attribute, what: &str, help: &str) {
        let message = format!("{}: {} {what}", component.label(), attribute.id);
        self.report(
            Diagnostic::error("", message)
                .code(codes::REXS_VALUE)
                .at_span(attribute.span)
                .help(help),
        );
    }

    /// A number in the unit of gearbox files; `None` if it is not stated or wrong, which is reported.
    pub fn number(&self, component: &Component, id: &str, quantity: Quantity) -> Option<f64> {
        let attribute = self.attribute(component, id)?;
        let Value::Text(text) = &attribute.value else {
            self.value_error(component, attribute, "is not a single number", "write one number");
            return None;
        };
        if text.is_empty() {
            return None;
        }
        self.parsed(component, attribute, text, quantity)
    }

    fn parsed(&self, component: &Component, attribute: &Attribute, text: &str, quantity: Quantity) -> Option<f64> {
        let Some(value) = text.parse::<f64>().ok().filter(|value| value.abs() <= LARGEST) else {
            let shown: String = text.chars().take(40).collect();
            self.value_error(
                component,
                attribute,
                &format!("is `{shown}`, not a number"),
                "write a number with a decimal point",
            );
            return None;
        };
        let converted = converted(value, &attribute.unit, quantity).filter(|value| value.is_finite());
        if converted.is_none() {
            let unit: String = attribute.unit.chars().take(40).collect();
            self.value_error(
                component,
                attribute,
                &format!("has the unit `{unit}`, which is not one of {}", known(quantity)),
                "convert the value to a known unit",
            );
        }
        converted
    }

    /// A number that must be stated; zero if it is not, which is reported.
    pub fn needed(&self, component: &Component, id: &str, quantity: Quantity) -> f64 {
        if component
            .attribute(id)
            .is_some_and(|attribute| attribute.value != Value::Text(String::new()))
        {
            return self.number(component, id, quantity).unwrap_or_default();
        }
        self.error(
            component,
            codes::REXS_VALUE,
            &format!("{id} is missing"),
            "state it in the program that exported the model, and export it again",
        );
        0.0
    }

    /// A number above zero.
    pub fn positive(&self, component: &Component, id: &str, quantity: Quantity) -> Option<f64> {
        self.number(component, id, quantity).filter(|value| *value > 0.0)
    }

    /// Several numbers; `None` if there are none or one is wrong, which is reported.
    pub fn numbers(&self, component: &Component, id: &str, quantity: Quantity) -> Option<Vec<f64>> {
        let attribute = self.attribute(component, id)?;
        let Value::List(cells) = &attribute.value else {
            self.value_error(component, attribute, "is not an array", "write an array of numbers");
            return None;
        };
        cells
            .iter()
            .map(|cell| self.parsed(component, attribute, cell, quantity))
            .collect()
    }

    /// Points, each with three coordinates, in the order u, v, w; `None` if there are none or one is wrong, which is reported. \[mm\]
    pub fn points(&self, component: &Component, id: &str) -> Option<Vec<[f64; 3]>> {
        let attribute = self.attribute(component, id)?;
        let point = |cells: &Vec<String>| {
            let numbers = cells
                .iter()
                .map(|cell| self.parsed(component, attribute, cell, Quantity::Length));
            <[f64; 3]>::try_from(numbers.collect::<Option<Vec<f64>>>()?).ok()
        };
        match &attribute.value {
            Value::Rows(rows) => rows.iter().map(point).collect(),
            _ => None,
        }
    }

    /// Three numbers.
    pub fn vector(&self, component: &Component, id: &str) -> Option<[f64; 3]> {
        let attribute = self.attribute(component, id)?;
        if matches!(&attribute.value, Value::Text(text) if text == "true" || text == "false") {
            self.value_error(
                component,
                attribute,
                "is a truth value and not a vector",
                "the program that exported the JSON file lost its vectors and texts: export the model as XML",
            );
            return None;
        }
        let numbers = self.numbers(component, id, Quantity::Length)?;
        let vector = <[f64; 3]>::try_from(numbers).ok();
        let vector = vector.filter(|vector| vector.iter().all(|x| x.abs() <= FARTHEST));
        if vector.is_none() {
            self.value_error(
                component,
                attribute,
                "does not have three numbers of at most a kilometre",
                "write three numbers",
            );
        }
        vector
    }

    /// An integer, also where it is written as `17.0`.
    pub fn integer(&self, component: &Component, id: &str) -> Option<i64> {
        let value = self.number(component, id, Quantity::Number)?;
        if value.fract() == 0.0 && value.abs() < 1e15 {
            return Some(value as i64);
        }
        let attribute = component.attribute(id)?;
        self.value_error(
            component,
            attribute,
            &format!("is {value}, not an integer"),
            "write an integer",
        );
        None
    }

    /// A text that is not empty.
    pub fn text<'c>(&self, component: &'c Component, id: &str) -> Option<&'c str> {
        match &self.attribute(component, id)?.value {
            Value::Text(text) if !text.is_empty() => Some(text),
            _ => None,
        }
    }

    /// A value of an enumeration in the newest spelling.
    pub fn word(&self, component: &Component, id: &str) -> Option<String> {
        self.text(component, id).map(newest_value)
    }

    pub fn flag(&self, component: &Component, id: &str) -> Option<bool> {
        match self.text(component, id)? {
            "true" | "1" => Some(true),
            "false" | "0" => Some(false),
            _ => {
                let attribute = component.attribute(id)?;
                self.value_error(component, attribute, "is neither true nor false", "write true or false");
                None
            }
        }
    }

    /// Truth values: a list, or one.
    pub fn flags(&self, component: &Component, id: &str) -> Option<Vec<bool>> {
        match &self.attribute(component, id)?.value {
            Value::Text(text) if !text.is_empty() => Some(vec![text == "true"]),
            Value::List(cells) => Some(cells.iter().map(|cell| cell == "true").collect()),
            _ => None,
        }
    }

    /// How many values were used.
    pub fn taken(&self) -> usize {
        self.used.borrow().len()
    }

    /// The attributes that were not used, counted by id; those of `ignored` components do not count.
    pub fn unused(&self, ignored: &BTreeSet<Id>) -> BTreeMap<String, usize> {
        let used = self.used.borrow();
        let mut unused = BTreeMap::new();
        for component in self.model.components.values() {
            // Everything is placed relative to the gear unit, whose own position has no meaning.
            let is_origin =
                |id: &str| component.kind == "gear_unit" && (id.ends_with("_vector") || id.starts_with("reference_c"));
            for attribute in &component.attributes {
                if !is_origin(&attribute.id)
                    && !ignored.contains(&component.id)
                    && !used.contains(&(component.id, attribute.id.clone()))
                {
                    *unused.entry(attribute.id.clone()).or_default() += 1;
                }
            }
        }
        unused
    }
}

/// A count with its noun.
pub fn counted(count: usize, noun: &str) -> String {
    if count == 1 {
        format!("1 {noun}")
    } else {
        format!("{count} {noun}s")
    }
}
