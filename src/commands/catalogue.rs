//! `catalogue`: designations of bearings and oils for gearbox files.

use gearloss_framework::language::LUBRICANTS;
use gearloss_framework::resolve::without_suffix;

use crate::args::{CatalogueArg, CatalogueArgs};
use crate::output::{End, Failure, Out, Table};
use gearloss_studies::distinct::distinct;

pub fn run(args: &CatalogueArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let section = match args.of {
        CatalogueArg::Bearings => "bearings",
        CatalogueArg::Oils => LUBRICANTS,
    };
    let rows = || language.catalogue(section).into_iter().flat_map(|table| &table.0);
    let wanted = args.text.as_deref().unwrap_or_default().to_lowercase();
    let found: Vec<_> = rows()
        .filter(|(designation, _)| designation.to_lowercase().contains(&wanted))
        .collect();
    if found.is_empty() {
        let text = args.text.as_deref().unwrap_or_default();
        let help = match without_suffix(text, rows().map(|(designation, _)| designation.as_str())) {
            Some((base, _)) => format!("there is `{base}`, without the suffix"),
            None => "shorten the text, or omit it to list all; other parts state their own data, or come from a CSV under `catalogues` of \
                     the gearbox"
                .to_owned(),
        };
        return Err(Failure::input(format!("no designation contains `{text}`"), help));
    }
    let keys = found.iter().flat_map(|(_, row)| &row.values);
    let keys: Vec<&str> = distinct(keys.map(|(key, _)| key.as_str()));
    let mut head = vec!["designation"];
    head.extend(&keys);
    head.push("confidence");
    let mut table = Table::new(&head);
    for (designation, row) in found {
        let mut cells = vec![designation.clone()];
        for key in &keys {
            let value = row.values.iter().find(|(own, _)| own == key).map(|(_, value)| value);
            cells.push(value.map_or_else(String::new, |v| v.as_str().map_or_else(|| v.to_string(), str::to_owned)));
        }
        cells.push(row.confidence.clone());
        table.row(cells);
    }
    out.text(&table.render())?;
    Ok(End::Fine)
}
