//! `fit`: fits a law to a table and prints it with its residuals.

mod oil;
mod stribeck;
mod traction;

use std::path::Path;

use gearloss_framework::document::Diagnostic;
use gearloss_numerics::fit::Estimate;
use gearloss_studies::fit::DragLaw;
use gearloss_studies::fit::columns::{Columns, Quantity};

use super::read_table;
use crate::args::{FitArgs, FitLaw};
use crate::output::{End, Failure, Out, Table, figures, significant};

pub fn run(args: &FitArgs, out: &mut Out) -> Result<End, Failure> {
    match &args.law {
        FitLaw::PowerLaw { table } => power_law(table, out),
        FitLaw::Traction { curves, oil } => traction::run(curves, oil, out),
        FitLaw::Stribeck { curve, rq, exponent } => stribeck::run(curve, rq.as_deref(), *exponent, out),
    }
}

/// `fit power-law`: drag of planets over speed, viscosity and volume.
fn power_law(path: &Path, out: &mut Out) -> Result<End, Failure> {
    let bytes = read_table(path)?;
    let law = DragLaw::of_table(&bytes).map_err(|fault| Diagnostic {
        message: format!("{}: {}", path.display(), fault.message),
        ..fault
    })?;
    let fit = &law.fit;
    out.line(format!("model: {{ type: power_law, {} }}", law.parameters.join(", ")))?;
    out.line(format!(
        "\n{} points, residuals: rms {:.2} %, max {:.2} %",
        law.points.len(),
        100.0 * fit.rms(),
        100.0 * fit.worst()
    ))?;
    let mut head: Vec<&str> = law.axes.iter().map(String::as_str).collect();
    head.extend(["table Nm", "law Nm", "residual %"]);
    let mut printed = Table::new(&head);
    for ((point, answer), residual) in law.points.iter().zip(&fit.residuals) {
        let mut row: Vec<String> = point.iter().map(|x| format!("{x}")).collect();
        row.push(significant(*answer));
        row.push(significant(fit.value(point)));
        row.push(format!("{:.2}", 100.0 * residual));
        printed.row(row);
    }
    out.text(&printed.render())?;
    Ok(End::Fine)
}

fn columns(path: &Path) -> Result<Columns, Failure> {
    Ok(Columns::of_file(&path.display().to_string(), &read_table(path)?)?)
}

/// Prints which columns are not used.
fn print_unused(columns: &Columns, quantities: &[Quantity], out: &mut Out) -> Result<(), Failure> {
    let unused = columns.unused(quantities);
    if !unused.is_empty() {
        out.line(format!("note: not used: {}", unused.join(", ")))?;
    }
    Ok(())
}

/// Parameters with standard deviations and intervals, and notes on active bounds.
fn estimates_table(estimates: &[Estimate]) -> String {
    let mut table = Table::new(&["parameter", "value", "standard deviation", "95 % from", "to"]);
    let dash = || "-".to_owned();
    for estimate in estimates {
        let end = |i: usize| estimate.interval.map_or_else(dash, |ends| significant(ends[i]));
        table.row(vec![
            estimate.name.clone(),
            significant(estimate.value),
            estimate.deviation.map_or_else(dash, |d| figures(d, 3)),
            end(0),
            end(1),
        ]);
    }
    let mut text = table.render();
    for held in estimates.iter().filter(|e| e.held) {
        text.push_str(&format!(
            "note: {} is at its bound, and the points favour a value beyond it: check units and the oil\n",
            held.name
        ));
    }
    text
}
