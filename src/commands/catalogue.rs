//! `catalogue`: designations of bearings, oils and materials for gearbox files.

use std::path::Path;

use gearloss_framework::document::did_you_mean;
use gearloss_framework::language::{LUBRICANTS, MATERIALS};
use gearloss_framework::registry::Files;
use gearloss_framework::resolve::{CatalogueRow, CatalogueTable, known_start};
use gearloss_studies::distinct::distinct;

use super::read_table;
use crate::args::{CatalogueArg, CatalogueArgs};
use crate::output::{End, Failure, Out, Table};

pub fn run(args: &CatalogueArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let section = match args.of {
        CatalogueArg::Bearings => "bearings",
        CatalogueArg::Oils => LUBRICANTS,
        CatalogueArg::Materials => MATERIALS,
    };
    let file_of_user = args
        .file
        .as_deref()
        .map(|file| own_catalogue(file, section, language))
        .transpose()?;
    let Some(all) = file_of_user.as_ref().or_else(|| language.catalogue(section)) else {
        return Err(Failure::input("no catalogue is linked", "link a crate with catalogues"));
    };
    let text = args.text.as_deref().unwrap_or_default();
    let hits = all.search(text, section == "bearings");
    if hits.rows.is_empty() {
        return Err(nothing(text, all));
    }
    if let Some(about) = &hits.about {
        out.line(format!("{text}: {about}"))?;
    }
    out.text(&table(&hits.rows).render())?;
    Ok(End::Fine)
}

/// A catalogue of a user, or all tables of a folder. Every row must state what a component needs, because a gearbox reads only the rows that it names.
fn own_catalogue(
    file: &Path,
    section: &str,
    language: &gearloss_framework::language::Language,
) -> Result<CatalogueTable, Failure> {
    let name = file.display().to_string();
    if !file.is_dir() {
        return checked(&read_table(file)?, &name, section, language);
    }
    let folder = format!("{}/", name.trim_end_matches('/'));
    let table = CatalogueTable::named(&Files::beside(""), &folder).map_err(|message| Failure::input(message, HELP))?;
    checked_table(table, &name, section, language)
}

/// What a catalogue is.
const HELP: &str =
    "a catalogue has the column `designation` and keys of the section with their units, such as `bore [mm],c0 [N]`";

/// The catalogue in the bytes of a file, with every value checked.
pub(super) fn checked(
    bytes: &[u8],
    file: &str,
    section: &str,
    language: &gearloss_framework::language::Language,
) -> Result<CatalogueTable, Failure> {
    let table = CatalogueTable::from_file(bytes);
    let table = table.map_err(|message| Failure::input(format!("{file}: {message}"), HELP))?;
    checked_table(table, file, section, language)
}

fn checked_table(
    table: CatalogueTable,
    file: &str,
    section: &str,
    language: &gearloss_framework::language::Language,
) -> Result<CatalogueTable, Failure> {
    let mut faults = Vec::new();
    let keys = distinct(
        table
            .0
            .values()
            .flat_map(|row| &row.values)
            .map(|(key, _)| key.as_str()),
    );
    let known = language.keys_of(section);
    let is_known = |key: &&str| known.contains(&key.split('.').next().unwrap_or_default());
    let unknown: Vec<&str> = keys.into_iter().filter(|key| !is_known(key)).collect();
    if let [first, ..] = unknown[..] {
        let names = unknown
            .iter()
            .map(|key| format!("`{key}`"))
            .collect::<Vec<_>>()
            .join(", ");
        let noun = if unknown.len() == 1 { "column" } else { "columns" };
        let close = did_you_mean(first, known.iter().copied());
        let help = close.map_or_else(
            || {
                format!(
                    "delete the {noun}, or rename it to a key of {section}: {}",
                    known.join(", ")
                )
            },
            |close| format!("write `{close}` instead of `{first}`, or delete the column"),
        );
        return Err(Failure::input(
            format!("{file}: {section} have no key for the {noun} {names}"),
            help,
        ));
    }
    for (designation, row) in &table.0 {
        for (key, value) in &row.values {
            if let Err(list) = language.checked(value, &format!("{section}.{designation}.{key}")) {
                faults.extend(
                    list.into_iter()
                        .map(|fault| format!("`{designation}`: {}", fault.message)),
                );
            }
        }
    }
    if faults.is_empty() {
        Ok(table)
    } else {
        Err(Failure::input(format!("{file}: {}", faults.join("; ")), HELP))
    }
}

/// No row has the text.
fn nothing(text: &str, all: &CatalogueTable) -> Failure {
    if let Some(known) = known_start(text, all.0.keys().map(String::as_str)) {
        return Failure::input(
            format!("no designation contains `{text}`: {known}"),
            "omit what is not known, or write its data into the gearbox",
        );
    }
    let help = did_you_mean(text, all.0.keys().map(String::as_str)).map_or_else(
        || {
            "shorten the text, or omit it to list all; other parts state their own data, or come from a CSV under `catalogues` of the gearbox"
                .to_owned()
        },
        |close| format!("there is `{close}`"),
    );
    Failure::input(format!("no designation contains `{text}`"), help)
}

/// Rows with their data, confidence and origin.
fn table(found: &[(String, CatalogueRow)]) -> Table {
    let keys = found.iter().flat_map(|(_, row)| &row.values);
    let keys: Vec<&str> = distinct(keys.map(|(key, _)| key.as_str()));
    let mut head = vec!["designation"];
    head.extend(&keys);
    head.extend(["confidence", "origin"]);
    let mut table = Table::new(&head);
    for (designation, row) in found {
        let mut cells = vec![designation.clone()];
        for key in &keys {
            let value = row
                .values
                .iter()
                .find(|(known, _)| known == key)
                .map(|(_, value)| value);
            cells.push(value.map_or_else(String::new, |v| v.as_str().map_or_else(|| v.to_string(), str::to_owned)));
        }
        cells.extend([row.confidence.clone(), row.basis.clone()]);
        table.row(cells);
    }
    table
}
