//! Components without data that nothing needs: programs export parts that their user began and never filled in.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::model::{Component, Id, Model, Relation, Value};

/// Removes empty components, and shafts without a position, unless a component with data needs them. What was removed, as a line of the
/// report.
pub fn leave_out(model: &mut Model) -> Option<String> {
    let mut dropped = candidates(model);
    if dropped.is_empty() {
        return None;
    }
    keep_needed(model, &mut dropped);
    let names: Vec<String> = model
        .components
        .values()
        .filter(|component| dropped.contains(&component.id))
        .map(Component::label)
        .collect();
    model.components.retain(|id, _| !dropped.contains(id));
    model
        .relations
        .retain(|relation| !relation.refs.iter().any(|(_, id)| dropped.contains(id)));
    let shown = names.iter().take(MOST_NAMES).cloned().collect::<Vec<_>>().join(", ");
    let more = if names.len() > MOST_NAMES { ", ..." } else { "" };
    (!names.is_empty()).then(|| format!("left out, because they have no data and nothing needs them: {shown}{more}"))
}

/// Most names in the line.
const MOST_NAMES: usize = 20;

/// Kinds that say nothing by being there. Groups, such as stages, have no attributes of their own.
const KINDS: [&str; 5] = ["shaft", "shaft_section", "material", "lubricant", "side_plate"];

/// Components without data.
fn candidates(model: &Model) -> BTreeSet<Id> {
    let joins: BTreeSet<Id> = model
        .relations
        .iter()
        .filter(|relation| relation.kind == "side")
        .filter_map(|relation| relation.role("assembly"))
        .collect();
    let of_cases: BTreeSet<Id> = model
        .spectra
        .iter()
        .flat_map(|spectrum| &spectrum.cases)
        .flat_map(|case| case.components.values())
        .filter(|component| !component.attributes.is_empty())
        .map(|component| component.id)
        .collect();
    let lacks_data = |component: &Component| {
        let is_coupling = joins.contains(&component.id) && !component.kind.contains("bearing");
        let is_empty = component.attributes.is_empty() && (KINDS.contains(&component.kind.as_str()) || is_coupling);
        is_empty || component.kind == "shaft" && component.attribute("support_vector").is_none()
    };
    let all = model.components.values();
    all.filter(|component| lacks_data(component) && !of_cases.contains(&component.id))
        .map(|component| component.id)
        .collect()
}

/// Removes from the candidates what components with data need, and what those need in turn.
fn keep_needed(model: &Model, dropped: &mut BTreeSet<Id>) {
    let mut relations_of: BTreeMap<Id, Vec<&Relation>> = BTreeMap::new();
    for relation in &model.relations {
        for (_, id) in relation.refs.iter().filter(|(_, id)| dropped.contains(id)) {
            relations_of.entry(*id).or_default().push(relation);
        }
    }
    let mut next: VecDeque<&Relation> = relations_of.values().flatten().copied().collect();
    let positions = model
        .components
        .values()
        .filter(|component| !dropped.contains(&component.id));
    let references: Vec<Id> = positions.filter_map(reference).collect();
    let mut needed: Vec<Id> = references.into_iter().filter(|id| dropped.contains(id)).collect();
    loop {
        let mut also = Vec::new();
        for id in needed.drain(..) {
            if dropped.remove(&id) {
                next.extend(relations_of.get(&id).into_iter().flatten());
                also.extend(model.components.get(&id).and_then(reference));
            }
        }
        needed.extend(also);
        match next.pop_front() {
            Some(relation) => needed.extend(needed_by(relation, dropped)),
            None if needed.is_empty() => return,
            None => {}
        }
    }
}

/// The component whose coordinates another one states.
fn reference(component: &Component) -> Option<Id> {
    match &component.attribute("reference_component_for_position")?.value {
        Value::Text(text) => text.parse().ok(),
        _ => None,
    }
}

/// The candidates that a relation needs, as far as the others are left out.
fn needed_by(relation: &Relation, dropped: &BTreeSet<Id>) -> Vec<Id> {
    let is_dropped = |role: &str| relation.role(role).is_some_and(|id| dropped.contains(&id));
    let has_data = |role: &str| relation.role(role).is_some_and(|id| !dropped.contains(&id));
    let in_role = |roles: &[&str]| -> Vec<Id> {
        let ids = roles.iter().filter_map(|role| relation.role(role));
        ids.filter(|id| dropped.contains(id)).collect()
    };
    match relation.kind.as_str() {
        "assembly" | "ordered_assembly" if has_data("part") => in_role(&["assembly"]),
        "reference" | "ordered_reference" if has_data("origin") => in_role(&["referenced"]),
        "assembly" | "ordered_assembly" | "reference" | "ordered_reference" => Vec::new(),
        // A coupling joins what has data; one to a part that is left out joins nothing.
        "side" if is_dropped("assembly") => {
            let ends = ["inner_part", "outer_part"];
            let joins_nothing = ends.iter().any(|role| is_dropped(role)) || !ends.iter().any(|role| has_data(role));
            if joins_nothing {
                Vec::new()
            } else {
                in_role(&["assembly"])
            }
        }
        _ if relation.refs.iter().any(|(_, id)| !dropped.contains(id)) => {
            let ids = relation.refs.iter().map(|(_, id)| *id);
            ids.filter(|id| dropped.contains(id)).collect()
        }
        _ => Vec::new(),
    }
}
