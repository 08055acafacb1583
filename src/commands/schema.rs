//! `schema`: the JSON Schema of a kind of document.

use gearloss_framework::language::{Kind, Language};
use gearloss_report::check::CheckRecord;
use gearloss_report::models::ModelsRecord;
use gearloss_report::point::PointRecord;
use gearloss_studies::results;

use crate::args::{KindArg, SchemaArgs};
use crate::output::{End, Failure, Out};

pub fn run(args: &SchemaArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let schema = match args.kind {
        KindArg::Gearbox => language.published(Kind::Gearbox),
        KindArg::Study => language.published(Kind::Study),
        KindArg::Eval => language.published(Kind::Eval),
        KindArg::Result => results::schema(),
        KindArg::Point => results::schema_of::<PointRecord>(),
        KindArg::Check => results::schema_of::<CheckRecord>(),
        KindArg::Models => results::schema_of::<ModelsRecord>(),
    };
    out.text(&text_of(&schema)?)?;
    Ok(End::Fine)
}

/// The schema of a kind of document, as a file.
pub fn published(language: &Language, kind: Kind) -> Result<String, Failure> {
    text_of(&language.published(kind))
}

fn text_of(schema: &serde_json::Value) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(schema).map_err(|e| Failure::Input(format!("error: {e}\n")))?;
    Ok(text + "\n")
}
