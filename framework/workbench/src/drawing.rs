//! The drawing of a gearbox, and where its parts are described.

use std::collections::BTreeMap;

use gearloss_editor::{FileRange, Workspace};
use gearloss_framework::files::SharedSource;
use gearloss_framework::language::Language;
use gearloss_report::schematic::schematic;
use gearloss_studies::engine::progress::Progress;
use serde::Serialize;

use crate::answer::Fault;
use crate::chosen::Chosen;

/// The drawing of a gearbox.
#[derive(Debug, Serialize)]
pub struct Drawing {
    /// An `<svg>` element; each part is a group with its path in `data-part`.
    pub svg: String,
    /// Where each part is described.
    pub places: BTreeMap<String, FileRange>,
}

/// Draws a gearbox.
pub fn drawing(
    language: &Language,
    workspace: &Workspace<'_>,
    files: &SharedSource,
    gearbox: &str,
    progress: &dyn Progress,
) -> Result<Drawing, Fault> {
    let chosen = Chosen::read(language, files, gearbox, "", progress)?;
    let svg = schematic(&chosen.transmission, &chosen.resolved.value);
    let mut places = BTreeMap::new();
    for part in parts(&svg) {
        if let Some(place) = workspace.place_of(gearbox, part) {
            places.insert(part.to_owned(), place);
        }
    }
    Ok(Drawing { svg, places })
}

/// Paths of the parts of a drawing.
fn parts(svg: &str) -> impl Iterator<Item = &str> {
    svg.split("data-part=\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next())
}
