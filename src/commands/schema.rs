//! `schema`: the JSON Schema of a kind of document.

use gearloss_framework::language::Kind;
use gearloss_framework::language::Language;

use crate::args::{KindArg, SchemaArgs};
use crate::output::{End, Failure, Out};

/// Documents that the program writes have no language to be published from; their schemas are kept by hand.
const RESULT: &str = include_str!("../../schemas/result.schema.json");
const POINT: &str = include_str!("../../schemas/point.schema.json");

pub fn run(args: &SchemaArgs, out: &mut Out) -> Result<End, Failure> {
    let kind = match args.kind {
        KindArg::Gearbox => Kind::Gearbox,
        KindArg::Study => Kind::Study,
        KindArg::Eval => Kind::Eval,
        KindArg::Result => return written(RESULT, out),
        KindArg::Point => return written(POINT, out),
    };
    let schema = Language::linked()?.published(kind);
    let text = serde_json::to_string_pretty(&schema).map_err(|e| Failure::Input(format!("error: {e}\n")))?;
    out.line(text)?;
    Ok(End::Fine)
}

fn written(schema: &str, out: &mut Out) -> Result<End, Failure> {
    out.text(schema)?;
    Ok(End::Fine)
}
