//! `eval`: one model without a gearbox.

use std::path::Path;

use gearloss_framework::eval;
use gearloss_framework::files::LONGEST_TEXT;
use gearloss_framework::gearbox::Findings;
use gearloss_report::eval::{eval_json, eval_text};

use crate::args::{EvalArgs, Format};
use crate::output::{End, Failure, Out};

pub fn run(args: &EvalArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let (mechanism, entry) = eval::named(language, &args.model).map_err(Findings::from)?;
    let (text, folder) = match &args.input {
        Some(file) => (
            super::read_file(file, LONGEST_TEXT, "check the file name")?,
            file.parent().map(Path::to_path_buf).unwrap_or_default(),
        ),
        None => Default::default(),
    };
    let source = args.input.as_deref().unwrap_or(Path::new("")).display().to_string();
    let evaluated = eval::evaluate_input(language, &args.model, &source, &text, &folder)?;
    if !evaluated.total.is_finite() {
        return Err(Failure::input(
            format!("{source}: {} has no finite result at these values", args.model),
            "give quantities of realistic size",
        ));
    }
    if args.format == Format::Json {
        let value = eval_json(mechanism, entry, &evaluated, language.registry().packages());
        out.line(serde_json::to_string_pretty(&value).unwrap_or_default())?;
    } else {
        out.text(&eval_text(mechanism, entry, &evaluated))?;
    }
    Ok(End::Fine)
}
