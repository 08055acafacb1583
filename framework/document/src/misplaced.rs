//! Finds where an unknown key belongs: under another name, below a neighbour, at the entry that a neighbour names, at another model, or elsewhere
//! in the document.

use super::diagnostic::{did_you_mean, distance};
use super::schema::{Field, Schema, Shape};

/// Maximum depth of the search for a key.
const DEPTH: usize = 4;
/// Maximum number of equally near places that are named.
const PLACES: usize = 3;
/// Levels of a path that is nearer than a similar key, such as `grid.torque`.
const NEAR: usize = 2;

/// Other names of keys that count only in the record itself, because keys of any record could be called so.
const OF_ANY_RECORD: [&str; 4] = ["type", "name", "width", "temperature"];

/// Help for an unknown key.
#[derive(Default)]
pub(super) struct Help {
    /// The keys of the record that may have been meant.
    pub meant: Vec<String>,
    /// Text of the help; absent if nothing is known.
    pub words: Option<String>,
}

impl Help {
    fn new(meant: &[&str], words: String) -> Self {
        Self {
            meant: meant.iter().map(|&name| name.to_owned()).collect(),
            words: Some(words),
        }
    }

    fn of_key(name: &str) -> Self {
        Self::new(&[name], format!("write `{name}`"))
    }
}

/// Where else a key may be.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Elsewhere {
    /// Nowhere: the record is the document itself.
    No,
    /// Anywhere in the document.
    Yes,
    /// At records of another `type`, unless a section of the document has it.
    OtherType,
}

/// Finds the intended key. `open` are the keys of the record that are not written yet.
pub(super) fn help(
    schema: &Schema,
    fields: &[(String, Field)],
    open: &[&str],
    key: &str,
    elsewhere: Elsewhere,
) -> Help {
    let close = did_you_mean(key, open.iter().copied());
    // `facewdith` is a typing error; `module` is the last word of `normal_module`, not a misspelt `model`.
    if let Some(close) = close.filter(|close| distance(key, close) == 1) {
        return Help::of_key(close);
    }
    let is_open = |name: &str| open.contains(&name);
    let is_called = |field: &Field| field.also_called.iter().any(|other| other == key);
    let renamed = fields.iter().filter(|(name, field)| is_open(name) && is_called(field));
    let renamed: Vec<&str> = renamed.map(|(name, _)| name.as_str()).collect();
    if !renamed.is_empty() {
        let written: Vec<String> = renamed.iter().map(|name| format!("`{name}`")).collect();
        return Help::new(&renamed, format!("write {}", written.join(" or ")));
    }
    let has_word = |name: &&&str| name.split('_').any(|word| word == key);
    if let Some(name) = open.iter().find(has_word) {
        return Help::of_key(name);
    }
    let (below_ids, nested): (Vec<String>, Vec<String>) = places(schema, fields, key)
        .into_iter()
        .partition(|path| path.contains('*'));
    let nested = nearest(&nested);
    if nested.first().is_some_and(|path| levels(path) <= NEAR) {
        return in_nested(&nested);
    }
    if let Some(close) = close {
        return Help::of_key(close);
    }
    if let Some(help) = at_named_entry(schema, fields, open, key) {
        return help;
    }
    let mut all = below_ids;
    if elsewhere != Elsewhere::No
        && let Shape::Record(fields) = schema.follow(&schema.root)
    {
        if elsewhere == Elsewhere::Yes && fields.iter().any(|(name, _)| name == key) {
            return Help::new(
                &[],
                format!("`{key}:` is a top-level key: write it without indentation"),
            );
        }
        all = places(schema, fields, key);
    }
    if elsewhere == Elsewhere::OtherType {
        all.retain(|path| !path.contains('*') && levels(path) <= NEAR);
        if all.is_empty() {
            return Help::default();
        }
    }
    let all = nearest(&all);
    match (nested.first(), all.first()) {
        (None, None) => Help::default(),
        (Some(nested_one), one) if one.is_none_or(|one| levels(one) >= levels(nested_one)) => in_nested(&nested),
        _ => {
            let written: Vec<String> = all.iter().map(|path| format!("`{path}`")).collect();
            Help::new(&[], moved(key, &all, &written.join(" or ")))
        }
    }
}

/// Where a key is at other places, by its name or by another one.
fn moved(key: &str, paths: &[&str], written: &str) -> String {
    if paths.iter().all(|path| last(path) == key) {
        format!("`{key}` is a key at {written}: move it there")
    } else {
        format!("write {written} instead")
    }
}

/// A key of records below the one in which it is written.
fn in_nested(paths: &[&str]) -> Help {
    let written = |path: &&str| {
        let mut names = path.rsplit('.');
        let innermost = format!("{}: ...", names.next().unwrap_or_default());
        let written = names.fold(innermost, |inner, name| match name.strip_suffix("[]") {
            Some(list) => format!("{list}: [{{ {inner} }}]"),
            None => format!("{name}: {{ {inner} }}"),
        });
        format!("`{written}`")
    };
    let written: Vec<String> = paths.iter().map(written).collect();
    // Otherwise the record that contains it would also be reported as missing.
    let outermost = |path: &&str| path.split(['.', '[']).next().unwrap_or_default().to_owned();
    Help {
        meant: paths.iter().map(outermost).collect(),
        words: Some(format!("it belongs to a nested record: write {}", written.join(" or "))),
    }
}

/// A key of the entries that a key of the record names: `torque` of a grid, which a map names by `grid`.
fn at_named_entry(schema: &Schema, fields: &[(String, Field)], open: &[&str], key: &str) -> Option<Help> {
    let Shape::Record(sections) = schema.follow(&schema.root) else {
        return None;
    };
    let is_key_of =
        |item: &Shape| matches!(schema.follow(item), Shape::Record(keys) if keys.iter().any(|(name, _)| name == key));
    let has_key = |section: &&String| {
        let field = sections
            .iter()
            .find(|(name, _)| name == *section)
            .map(|(_, field)| field);
        field.is_some_and(|field| matches!(schema.follow(&field.shape), Shape::Ids { item, .. } if is_key_of(item)))
    };
    fields.iter().find_map(|(name, field)| {
        let section = field.refers_to.iter().find(has_key)?;
        let path = format!("`{section}.*.{key}`");
        Some(if open.contains(&name.as_str()) {
            let words =
                format!("`{key}` is a key at {path}: write it there, and `{name}:` with the name of that entry here");
            Help::new(&[name], words)
        } else {
            Help::new(&[], format!("`{key}` is a key at {path}: move it there"))
        })
    })
}

/// Paths of a key below the keys of a record.
fn places(schema: &Schema, fields: &[(String, Field)], key: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (name, field) in fields {
        search(schema, &field.shape, key, name, DEPTH, &mut found);
    }
    found
}

fn levels(path: &str) -> usize {
    path.split('.').count()
}

fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// The paths with the fewest levels; none if so many are equally near that they tell nothing, as for `model`.
fn nearest(paths: &[String]) -> Vec<&str> {
    let fewest = paths.iter().map(|path| levels(path)).min();
    let mut near: Vec<&str> = paths.iter().map(String::as_str).collect();
    near.retain(|path| Some(levels(path)) == fewest);
    if near.len() > PLACES {
        near.clear();
    }
    near
}

/// Paths of a key in records and lists below a shape, except models, whose keys depend on their `type`.
fn search(schema: &Schema, shape: &Shape, key: &str, path: &str, depth: usize, found: &mut Vec<String>) {
    if depth == 0 {
        return;
    }
    match schema.follow(shape) {
        Shape::Record(fields) => {
            for (name, field) in fields {
                let inner = format!("{path}.{name}");
                let is_other_name = !OF_ANY_RECORD.contains(&key) && field.also_called.iter().any(|other| other == key);
                if name != key && !is_other_name {
                    search(schema, &field.shape, key, &inner, depth - 1, found);
                } else if !found.contains(&inner) {
                    found.push(inner);
                }
            }
        }
        Shape::Ids { item, .. } => search(schema, item, key, &format!("{path}.*"), depth - 1, found),
        Shape::List { item, .. } => search(schema, item, key, &format!("{path}[]"), depth - 1, found),
        Shape::Either(shapes) => {
            for shape in shapes {
                search(schema, shape, key, path, depth - 1, found);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use serde_json::{Value, json};

    use crate::schema::Schema;
    use crate::walk::walk;
    use crate::yaml::read_yaml;

    /// A study in which a map names a grid, and the key of a grid is also far below the map.
    fn study() -> Value {
        let text = || json!({ "type": "string" });
        let record =
            |properties: Value| json!({ "type": "object", "additionalProperties": false, "properties": properties });
        let drift = record(json!({ "drift": record(json!({ "torque": text(), "oil": text() })) }));
        let map = record(json!({
            "grid": { "type": "string", "x-refers-to": "grids" },
            "points": record(json!({ "steady": drift })),
            "list": { "type": "array", "items": record(json!({ "power": text() })) },
            "near": record(json!({ "width": text() })),
            "other": record(json!({ "width": text() })),
            "designation": { "type": "string", "x-also-called": ["type"] },
        }));
        record(json!({
            "conditions": record(json!({ "oil": text() })),
            "grids": { "type": "object", "additionalProperties": record(json!({ "torque": text() })) },
            "map": map,
        }))
    }

    fn help(text: &str) -> String {
        let schema = Schema::compile(&study()).unwrap();
        let walked = walk(&read_yaml(0, text).node, &schema);
        walked.findings[0].help.clone().unwrap()
    }

    #[test]
    fn the_nearest_place_of_a_key_is_named() {
        assert_eq!(
            help("map: { torque: a }"),
            "`torque` is a key at `grids.*.torque`: write it there, and `grid:` with the name of that entry here"
        );
        assert_eq!(
            help("map: { grid: a, torque: a }"),
            "`torque` is a key at `grids.*.torque`: move it there"
        );
        assert_eq!(
            help("map: { oil: a }"),
            "`oil` is a key at `conditions.oil`: move it there"
        );
        assert_eq!(
            help("map: { power: a }"),
            "it belongs to a nested record: write `list: [{ power: ... }]`"
        );
        assert_eq!(help("map: { type: a }"), "write `designation`");
        assert_eq!(
            help("conditions: { type: a }"),
            "choose one of these keys, or remove it"
        );
    }

    #[test]
    fn equally_near_places_are_all_named() {
        assert_eq!(
            help("map: { width: a }"),
            "it belongs to a nested record: write `near: { width: ... }` or `other: { width: ... }`"
        );
    }
}
