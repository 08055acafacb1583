//! `schema`: the JSON Schema of a kind of document.

use gearloss_framework::language::Kind;

use super::language;
use crate::args::{KindArg, SchemaArgs};
use crate::output::{End, Failure, Out};

pub fn run(args: &SchemaArgs, out: &mut Out) -> Result<End, Failure> {
    let kind = match args.kind {
        KindArg::Gearbox => Kind::Gearbox,
        KindArg::Study => Kind::Study,
        KindArg::Eval => Kind::Eval,
    };
    let schema = language()?.published(kind);
    let text = serde_json::to_string_pretty(&schema).map_err(|e| Failure::Input(format!("error: {e}\n")))?;
    out.line(text)?;
    Ok(End::Fine)
}
