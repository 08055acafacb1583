//! Materials of gears in the form: a template has none, so that all gears are of steel.

use std::ops::Range;

use gearloss_editor::outline::Node;

use super::fields::{Field, FieldKind, at};

/// The field of a gear.
pub(super) fn field(gear: &str) -> Field {
    Field {
        path: format!("gears.{gear}.material"),
        label: format!("Material of {gear}"),
        kind: FieldKind::Material,
        value: String::new(),
        help: "of the catalogue; steel if not stated".to_owned(),
        choices: &[],
        example: Some("POM"),
    }
}

/// The change that writes a material before the first key of its gear.
pub(super) fn change(text: &str, document: &Node, path: &str, material: &str) -> Option<(Range<usize>, String)> {
    let gear = at(document, path.strip_suffix(".material")?)?;
    let first = gear.entries().first()?.span.start;
    let line = text[..first].rfind('\n').map_or(0, |end| end + 1);
    let indentation = &text[line..first];
    let is_block = indentation.chars().all(char::is_whitespace);
    let after = if is_block {
        format!("\n{indentation}")
    } else {
        ", ".to_owned()
    };
    Some((first..first, format!("material: {material}{after}")))
}
