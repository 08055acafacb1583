//! `models`: mechanisms and models that are linked into this program.

use std::path::Path;

use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_report::models::{mechanism_text, model_text, models_json, models_text, rating_text, ratings_list};
use gearloss_studies::needs::needs;

use crate::args::{Format, ModelsArgs};
use crate::output::{End, Failure, Out, Table};

/// Word that lists ratings instead of the models of a mechanism.
const RATING: &str = "rating";

pub fn run(args: &ModelsArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    if let Some(file) = &args.needs {
        return print_needs(language, file, args.mechanism.as_deref(), out);
    }
    let registry = language.registry();
    if args.mechanism.as_deref() == Some(RATING) && args.format == Format::Table {
        let text = match &args.model {
            None => ratings_list(language),
            Some(name) => rating_text(language, registry.rating_named(name).map_err(Findings::from)?),
        };
        out.text(&text)?;
        return Ok(End::Fine);
    }
    let mechanism = args.mechanism.as_ref().map(|name| registry.mechanism_named(name));
    let mechanism = mechanism.transpose().map_err(Findings::from)?;
    let model = mechanism
        .zip(args.model.as_ref())
        .map(|(mechanism, name)| registry.model_named(mechanism.key, name));
    let model = model.transpose().map_err(Findings::from)?;
    match (args.format, mechanism, model) {
        (Format::Json, ..) => {
            let value = models_json(language, mechanism, model);
            out.json(&value)?;
        }
        (Format::Table, None, _) => out.text(&models_text(language))?,
        (Format::Table, Some(mechanism), None) => out.text(&mechanism_text(language, mechanism))?,
        (Format::Table, Some(_), Some(model)) => out.text(&model_text(language, model))?,
    }
    Ok(End::Fine)
}

/// `models --needs`: the inputs of each model, and their origin in a gearbox.
fn print_needs(language: &Language, file: &Path, only: Option<&str>, out: &mut Out) -> Result<End, Failure> {
    let gearbox = Gearbox::read(language, file)?;
    let mut table = Table::new(&["mechanism", "model", "input", "in this gearbox"]);
    for need in needs(language, &gearbox, only)? {
        table.row(vec![
            need.mechanism.to_owned(),
            need.model.to_owned(),
            need.input,
            need.origin,
        ]);
    }
    out.text(&table.render())?;
    out.line("\ngiven: written; assumed: written and listed under `assumed`; derived: from a catalogue; default: not written")?;
    Ok(End::Fine)
}
