//! A section of the report for the page.

use gearloss_report::html::Section;
use gearloss_report::picture::Picture;
use serde::Serialize;
use serde_json::{Value, json};

/// A section with its pictures.
#[derive(Serialize)]
struct WithPictures<'a> {
    #[serde(flatten)]
    section: &'a Section,
    pictures: &'a [Picture],
}

/// A section with its pictures as JSON.
pub fn section_json(section: &Section) -> Value {
    json!(WithPictures {
        section,
        pictures: &section.pictures,
    })
}
