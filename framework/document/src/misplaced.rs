//! Finds where an unknown key belongs: below a neighbour, under a longer name, at another model, or elsewhere in the document.

use super::diagnostic::{did_you_mean, distance};
use super::schema::{Field, Schema, Shape};

/// Maximum depth of the search for a key.
const DEPTH: usize = 4;

/// Help for an unknown key.
pub(super) struct Help {
    /// The key of the record that was probably meant.
    pub meant: Option<String>,
    /// Text of the help; absent if nothing is known.
    pub words: Option<String>,
}

/// Finds the intended key. `open` are the keys of the record that are not written yet; `inside` is true unless the record is the document
/// itself.
pub(super) fn help(schema: &Schema, fields: &[(String, Field)], open: &[&str], key: &str, inside: bool) -> Help {
    let meant = |name: &str| Help {
        meant: Some(name.to_owned()),
        words: Some(format!("write `{name}`")),
    };
    let words = |words: String| Help {
        meant: None,
        words: Some(words),
    };
    let close = did_you_mean(key, open.iter().copied());
    // `facewdith` is a typing error; `module` is the last word of `normal_module`, not a misspelt `model`.
    if let Some(close) = close.filter(|close| distance(key, close) == 1) {
        return meant(close);
    }
    let has_word = |name: &&&str| name.split('_').any(|word| word == key);
    if let Some(name) = open.iter().find(has_word) {
        return meant(name);
    }
    let mut below = Vec::new();
    for (name, field) in fields {
        search(schema, &field.shape, key, name, DEPTH, &mut below);
    }
    if let Some(path) = below.iter().find(|path| !path.contains('*')) {
        let written = path
            .rsplit('.')
            .skip(1)
            .fold(format!("{key}: ..."), |inner, name| format!("{name}: {{ {inner} }}"));
        return Help {
            // Otherwise the record that contains it would also be reported as missing.
            meant: path.split('.').next().map(str::to_owned),
            words: Some(format!("it belongs to a nested record: write `{written}`")),
        };
    }
    if let Some(close) = close {
        return meant(close);
    }
    if inside {
        let mut all = Vec::new();
        if let Shape::Record(fields) = schema.follow(&schema.root) {
            if fields.iter().any(|(name, _)| name == key) {
                return words(format!("`{key}:` is a top-level key: write it without indentation"));
            }
            for (name, field) in fields {
                search(schema, &field.shape, key, name, DEPTH, &mut all);
            }
        }
        below = all;
    }
    if let Some(path) = below.first() {
        return words(format!("`{key}` is a key at `{path}`: move it there"));
    }
    Help {
        meant: None,
        words: None,
    }
}

/// Paths of a key in records below a shape, except models, whose keys depend on their `type`.
fn search(schema: &Schema, shape: &Shape, key: &str, path: &str, depth: usize, found: &mut Vec<String>) {
    if depth == 0 {
        return;
    }
    match schema.follow(shape) {
        Shape::Record(fields) => {
            for (name, field) in fields {
                let inner = format!("{path}.{name}");
                if name == key && !found.contains(&inner) {
                    found.push(inner);
                } else {
                    search(schema, &field.shape, key, &inner, depth - 1, found);
                }
            }
        }
        Shape::Ids { item, .. } => search(schema, item, key, &format!("{path}.*"), depth - 1, found),
        Shape::Either(shapes) => {
            for shape in shapes {
                search(schema, shape, key, path, depth - 1, found);
            }
        }
        _ => {}
    }
}
