//! `import bearings`: a catalogue from a maker's table.

use std::path::{Path, PathBuf};

use gearloss_exchange::bearing_table::{self, Options};
use gearloss_framework::document::Sources;
use gearloss_framework::document::data::Decimal;
use gearloss_framework::gearbox::Findings;

use super::super::{catalogue, new};
use crate::args::{BearingsArgs, DecimalArg};
use crate::output::{End, Failure, Out};

pub fn run(args: &BearingsArgs, out: &mut Out) -> Result<End, Failure> {
    let file = &args.file;
    let bytes = super::super::read_table(file)?;
    let language = super::super::language()?;
    let options = Options {
        columns: args.columns.clone(),
        kind: args.kind.clone(),
        decimal: args.decimal.map(|decimal| match decimal {
            DecimalArg::Point => Decimal::Point,
            DecimalArg::Comma => Decimal::Comma,
        }),
        sheet: args.sheet.clone(),
        header_line: args.header_line,
    };
    let shipped = language.catalogue("bearings");
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
    let imported = bearing_table::import(&bytes, &name, &options, shipped).map_err(Findings::from)?;
    for warning in &imported.warnings {
        Out::error().line(format!("{}\n", Sources::default().render(warning)))?;
    }
    let path = args.output.clone().unwrap_or_else(|| default_output(file));
    catalogue::checked(
        imported.text.as_bytes(),
        &path.display().to_string(),
        "bearings",
        language,
    )?;
    new::write(&path, &imported.text, out)?;
    for line in &imported.report {
        out.line(line)?;
    }
    out.line(format!(
        "{} bearings; in a gearbox: `catalogues: {{ bearings: {} }}`",
        imported.rows,
        path.display()
    ))?;
    let word = new::word(&path);
    new::print_next(&[format!("catalogue bearings --file {word}")], out)?;
    Ok(End::Fine)
}

fn default_output(file: &Path) -> PathBuf {
    let stem = file
        .file_stem()
        .map_or_else(|| "bearings".into(), |stem| stem.to_string_lossy());
    PathBuf::from(format!("{stem}-catalogue.csv"))
}
