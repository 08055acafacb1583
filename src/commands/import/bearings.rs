//! `import bearings`: a catalogue from a maker's table.

use std::path::{Path, PathBuf};

use gearloss_exchange::bearing_table::{self, Options};
use gearloss_framework::document::Sources;
use gearloss_framework::document::data::{Decimal, TableForm};
use gearloss_framework::gearbox::Findings;
use gearloss_studies::needs::{BearingNeeds, bearing_needs};

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
        form: TableForm {
            decimal: args.decimal.map(|decimal| match decimal {
                DecimalArg::Point => Decimal::Point,
                DecimalArg::Comma => Decimal::Comma,
            }),
            sheet: args.sheet.clone(),
            header_line: args.header_line,
            ..TableForm::default()
        },
    };
    let shipped = language.catalogue("bearings");
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
    let imported = bearing_table::import(&bytes, &name, &options, shipped).map_err(Findings::from)?;
    for warning in &imported.warnings {
        Out::error().line(format!("{}\n", Sources::default().render(warning)))?;
    }
    let path = args.output.clone().unwrap_or_else(|| default_output(file));
    let name = path.display().to_string();
    let table = catalogue::checked(imported.text.as_bytes(), &name, "bearings", language)?;
    new::write(&path, &imported.text, out)?;
    for line in &imported.report {
        out.line(line)?;
    }
    for line in model_lines(&bearing_needs(language, &table).map_err(Findings::from)?) {
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

/// For each model of bearing losses, how many bearings it can be used for and what the others lack.
fn model_lines(needs: &[BearingNeeds]) -> Vec<String> {
    let mut lines = vec!["Loss models:".to_owned()];
    for need in needs {
        let all = need.ready + need.lacks.iter().map(|(_, bearings)| bearings.len()).sum::<usize>();
        lines.push(format!(
            "- {}: {} of {all} bearings are complete",
            need.model, need.ready
        ));
        for (reason, bearings) in &need.lacks {
            let names = bearings.iter().take(MOST_NAMES).cloned().collect::<Vec<_>>().join(", ");
            let more = if bearings.len() > MOST_NAMES { ", ..." } else { "" };
            lines.push(format!("  {} without ({names}{more}): {reason}", bearings.len()));
        }
    }
    lines
}

/// Most designations in a line.
const MOST_NAMES: usize = 4;

fn default_output(file: &Path) -> PathBuf {
    let stem = file
        .file_stem()
        .map_or_else(|| "bearings".into(), |stem| stem.to_string_lossy());
    PathBuf::from(format!("{stem}-catalogue.csv"))
}
