//! `eval`: one model without a gearbox.

use std::path::Path;

use gearloss_framework::eval;
use gearloss_framework::files::LONGEST_TEXT;
use gearloss_framework::gearbox::Findings;
use gearloss_report::eval::{eval_json, eval_text, rated_json, rated_text};

use crate::args::{EvalArgs, Format};
use crate::output::{End, Failure, Out};

pub fn run(args: &EvalArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let (text, folder) = match &args.input {
        Some(file) => (
            super::read_file(file, LONGEST_TEXT, "check the file name")?,
            file.parent().map(Path::to_path_buf).unwrap_or_default(),
        ),
        None => Default::default(),
    };
    let source = args.input.as_deref().unwrap_or(Path::new("")).display().to_string();
    if let Some(name) = args.model.strip_prefix("rating/") {
        let plugin = language.registry().rating_named(name).map_err(Findings::from)?;
        let rated = eval::rate_input(language, plugin, &source, &text, &folder)?;
        if args.format == Format::Json {
            let value = rated_json(plugin, &rated, language.registry().packages());
            out.json(&value)?;
        } else {
            out.text(&rated_text(plugin, &rated))?;
        }
        return Ok(End::Fine);
    }
    let (mechanism, entry) = eval::named(language, &args.model).map_err(Findings::from)?;
    let evaluated = eval::evaluate_input(language, &args.model, &source, &text, &folder)?;
    if !evaluated.total.is_finite() {
        return Err(Failure::input(
            format!("{source}: {} has no finite result at these values", args.model),
            "give quantities of realistic size",
        ));
    }
    if args.format == Format::Json {
        let value = eval_json(mechanism, entry, &evaluated, language.registry().packages());
        out.json(&value)?;
    } else {
        out.text(&eval_text(mechanism, entry, &evaluated))?;
    }
    Ok(End::Fine)
}
