//! `import bearings`: a catalogue from a maker's table.

use std::path::{Path, PathBuf};

use gearloss_exchange::bearing_table::{self, Options};
use gearloss_framework::document::Sources;
use gearloss_framework::document::data::Decimal;
use gearloss_framework::files::{LONGEST_DATA, read_bytes};
use gearloss_framework::gearbox::Findings;

use super::super::{catalogue, new};
use crate::args::{DecimalArg, ImportFrom};
use crate::output::{End, Failure, Out};

pub fn run(from: &ImportFrom, out: &mut Out) -> Result<End, Failure> {
    let ImportFrom::Bearings {
        file,
        columns,
        kind,
        decimal,
        sheet,
        output,
    } = from
    else {
        return Err(Failure::input("bug: another import was called", "report this"));
    };
    let bytes = read_bytes(file, LONGEST_DATA)
        .map_err(|e| Failure::input(format!("cannot read {}: {e}", file.display()), "check the file name"))?;
    let language = super::super::language()?;
    let options = Options {
        columns: columns.clone(),
        kind: kind.clone(),
        decimal: decimal.map(|decimal| match decimal {
            DecimalArg::Point => Decimal::Point,
            DecimalArg::Comma => Decimal::Comma,
        }),
        sheet: sheet.clone(),
    };
    let shipped = language.catalogue("bearings");
    let known = |designation: &str| {
        let row = shipped?.0.get(designation)?;
        let size = |key: &str| {
            let (_, value) = row.values.iter().find(|(own, _)| own == key)?;
            value.as_str()?.split_once(' ')?.0.parse::<f64>().ok()
        };
        Some([size("bore")?, size("outside")?])
    };
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
    let imported = bearing_table::import(&bytes, &name, &options, &known).map_err(Findings::from)?;
    for warning in &imported.warnings {
        Out::error().line(format!("{}\n", Sources::default().render(warning)))?;
    }
    let path = output.clone().unwrap_or_else(|| default_output(file));
    catalogue::checked(&imported.text, &path.display().to_string(), "bearings", language)?;
    if path.exists() {
        return Err(Failure::input(
            format!("{} exists and is not overwritten", path.display()),
            "choose another file with -o",
        ));
    }
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
