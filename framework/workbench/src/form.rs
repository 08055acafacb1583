//! New documents: forms of gearboxes, and studies. A form writes the template of a layout with the values that were typed: after that the text is what counts.

mod bearings;
mod fields;
mod followed;
mod layouts;
mod materials;
mod ratios;
mod study;
mod written;

pub use fields::{Field, FieldKind, Group};
pub use layouts::{LAYOUTS, Layout};
pub use ratios::{Ratio, ratios};
pub use study::NewStudy;
pub use written::{Written, written};

use serde::Serialize;

/// A layout with its form.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Form {
    /// Name of the layout.
    pub name: &'static str,
    /// What it is.
    pub about: &'static str,
    /// Fields in their order.
    pub groups: Vec<Group>,
}

/// The forms of all layouts.
pub fn forms() -> Vec<Form> {
    let forms = LAYOUTS.iter().map(|layout| Form {
        name: layout.name,
        about: layout.about,
        groups: fields::groups(layout),
    });
    forms.collect()
}
