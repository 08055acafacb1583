//! `models`: mechanisms and models that are linked into this program.

use std::path::Path;

use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_report::models::{
    ChecksText, ModelsRecord, mechanism_text, model_text, models_text, rating_text, ratings_list,
};
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
    if args.checks {
        return print_checks(language, args, out);
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
        (Format::Json, ..) => out.json(&ModelsRecord::new(language, mechanism, model))?,
        (Format::Table, None, _) => out.text(&models_text(language))?,
        (Format::Table, Some(mechanism), None) => out.text(&mechanism_text(language, mechanism))?,
        (Format::Table, Some(_), Some(model)) => out.text(&model_text(language, model))?,
    }
    Ok(End::Fine)
}

/// `models --checks`: the check values of a model, of a mechanism or of all, with what this program computes.
fn print_checks(language: &Language, args: &ModelsArgs, out: &mut Out) -> Result<End, Failure> {
    let registry = language.registry();
    let mut text = ChecksText::default();
    let (mechanism, model) = (args.mechanism.as_deref(), args.model.as_deref());
    if mechanism != Some(RATING) {
        let mechanisms = match mechanism {
            Some(name) => std::slice::from_ref(registry.mechanism_named(name).map_err(Findings::from)?),
            None => registry.mechanisms(),
        };
        for mechanism in mechanisms {
            match model {
                Some(name) => text.model(
                    language,
                    registry.model_named(mechanism.key, name).map_err(Findings::from)?,
                ),
                None => registry
                    .models(mechanism.key)
                    .for_each(|entry| text.model(language, entry)),
            }
        }
    }
    if let (Some(RATING), Some(name)) = (mechanism, model) {
        text.rating(language, registry.rating_named(name).map_err(Findings::from)?);
    } else if matches!(mechanism, None | Some(RATING)) {
        registry
            .ratings()
            .iter()
            .for_each(|rating| text.rating(language, rating));
    }
    let (text, hold) = text.finish();
    out.text(&text)?;
    Ok(if hold { End::Fine } else { End::Finding })
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
