//! `import openfoam-forces`: a table from results of OpenFOAM.

use std::path::Path;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::files::LONGEST_TEXT;
use gearloss_studies::fit::openfoam::{Axis, Frame, Mean, Runs, history};

use super::super::new;
use super::super::point::quantity;
use crate::args::OpenfoamArgs;
use crate::output::{End, Failure, Out, Table, significant};

pub fn run(args: &OpenfoamArgs, out: &mut Out) -> Result<End, Failure> {
    let runs = &args.runs;
    if !(args.factor.is_finite() && args.factor > 0.0) {
        return Err(Failure::input(
            format!("--factor {}", args.factor),
            "give a positive number",
        ));
    }
    let from = quantity("--from", &args.from, "s")?;
    let to = args
        .to
        .as_deref()
        .map_or(Ok(f64::INFINITY), |to| quantity("--to", to, "s"))?;
    let window = [from, to];
    let axis = [Axis::X, Axis::Y, Axis::Z][args.axis as usize];
    let frame = if args.local_axes { Frame::Local } else { Frame::Global };
    let text = super::super::read_file(runs, LONGEST_TEXT, "check the file name")?;
    let in_list = |fault: Diagnostic| Diagnostic {
        message: format!("{}: {}", runs.display(), fault.message),
        ..fault
    };
    let list = Runs::from_text(&text).map_err(in_list)?;
    let beside = runs.parent().unwrap_or(Path::new(""));
    let mut means = Vec::new();
    for run in list.runs() {
        let folder = beside.join(&run.folder);
        let failed = |fault: &dyn std::fmt::Display, help: &str| {
            Failure::input(
                format!("{}, line {}: {}: {fault}", runs.display(), run.line, folder.display()),
                help,
            )
        };
        let samples = history(&folder, frame).map_err(|fault| failed(&fault, &fault.help))?;
        let mean = Mean::over_time(&samples, axis, window).map_err(|fault| failed(&fault, fault.help()))?;
        means.push(mean.times(args.factor));
    }
    let means = list.opposing(means, axis).map_err(in_list)?;
    let table = list.table(&means, axis, window).map_err(in_list)?;
    let mut printed = Table::new(&["folder", "samples", "until s", "pressure Nm", "viscous Nm", "spread Nm"]);
    for (run, mean) in list.runs().iter().zip(&means) {
        printed.row(vec![
            run.folder.clone(),
            mean.samples.to_string(),
            significant(mean.until),
            significant(mean.pressure),
            significant(mean.viscous),
            significant(mean.spread),
        ]);
    }
    out.text(&printed.render())?;
    new::write(&args.output, &table, out)?;
    Ok(End::Fine)
}
