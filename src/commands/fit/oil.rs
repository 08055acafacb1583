//! The oil of the fit: from a gearbox, or from the command line.

use std::path::Path;

use gearloss_framework::codes;
use gearloss_framework::description::LubricantEntry;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::resolve::Choice;

use crate::args::OilArgs;
use crate::output::Failure;

/// The oil of the arguments.
pub fn oil(args: &OilArgs) -> Result<Lubricant, Failure> {
    let language = super::super::language()?;
    let gearbox = match (&args.gearbox, &args.oil) {
        (Some(file), _) => Gearbox::read(language, file)?,
        (None, text) => {
            // The entry is checked and completed like an entry of a gearbox; the remainder is a minimal gearbox.
            let entry = text.as_deref().unwrap_or_default().trim();
            let text = format!(
                "gearloss: gearbox/1\nports: {{ input: shaft }}\nshafts: {{ shaft: {{ axis: [0, 0] }} }}\nlubricants:\n  oil:\n    {entry}\n"
            );
            Gearbox::of_text(language, &text, "--oil", Path::new(""))?
        }
    };
    let resolved = gearbox.resolve(language, &Choice::default())?;
    let oils = resolved.value["lubricants"].as_object();
    let names: Vec<&str> = oils.into_iter().flatten().map(|(id, _)| id.as_str()).collect();
    let id = match (&args.lubricant, &names[..]) {
        (Some(id), _) if names.contains(&id.as_str()) => id.as_str(),
        (None, [only]) => only,
        (Some(id), _) => {
            return Err(Failure::input(
                format!("no lubricant `{id}`"),
                format!("write --lubricant with one of {}", names.join(", ")),
            ));
        }
        (None, _) => {
            return Err(Failure::input(
                format!("{} lubricants", names.len()),
                format!("add --lubricant with one of {}", names.join(", ")),
            ));
        }
    };
    let path = format!("lubricants.{id}");
    let failed = |fault: Diagnostic| Failure::from(gearbox.findings(vec![fault]));
    let entry: LubricantEntry = serde_json::from_value(resolved.value["lubricants"][id].clone())
        .map_err(|e| failed(Diagnostic::error(path.as_str(), e.to_string())))?;
    Lubricant::new(&entry).map_err(|(key, message, help)| {
        failed(
            Diagnostic::error(format!("{path}.{key}"), message)
                .help(help)
                .code(codes::LUBRICANT),
        )
    })
}
