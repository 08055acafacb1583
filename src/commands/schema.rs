//! `schema`: the JSON Schema of a kind of document.

use gearloss_framework::language::{Kind, Language};

use crate::args::{KindArg, SchemaArgs};
use crate::output::{End, Failure, Out};

/// Schemas of the other outputs of the program.
const POINT: &str = include_str!("../../schemas/point.schema.json");
const CHECK: &str = include_str!("../../schemas/check.schema.json");
const MODELS: &str = include_str!("../../schemas/models.schema.json");

pub fn run(args: &SchemaArgs, out: &mut Out) -> Result<End, Failure> {
    let kind = match args.kind {
        KindArg::Gearbox => Kind::Gearbox,
        KindArg::Study => Kind::Study,
        KindArg::Eval => Kind::Eval,
        KindArg::Result => return written(&results()?, out),
        KindArg::Point => return written(POINT, out),
        KindArg::Check => return written(CHECK, out),
        KindArg::Models => return written(MODELS, out),
    };
    out.text(&published(super::language()?, kind)?)?;
    Ok(End::Fine)
}

/// The schema of a kind of document, as a file.
pub fn published(language: &Language, kind: Kind) -> Result<String, Failure> {
    text_of(&language.published(kind))
}

/// The schema of results, as a file.
pub fn results() -> Result<String, Failure> {
    text_of(&gearloss_studies::results::schema())
}

fn text_of(schema: &serde_json::Value) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(schema).map_err(|e| Failure::Input(format!("error: {e}\n")))?;
    Ok(text + "\n")
}

fn written(schema: &str, out: &mut Out) -> Result<End, Failure> {
    out.text(schema)?;
    Ok(End::Fine)
}
