//! Sweeps of oils as tables and pictures.

use gearloss_report::Figure;
use gearloss_report::plot::{Line, Stroke};
use gearloss_studies::study::FluidSweepEntry;

use super::super::Runner;
use super::super::write::picture;
use super::Sweep;
use crate::output::{Failure, Out, Table, significant};
use gearloss_studies::analyses::duties::Duties;

pub fn show(name: &str, s: &Sweep<'_>, duties: &Duties<'_>, out: &mut Out) -> Result<(), Failure> {
    out.line(format!(
        "{name}: mean loss in W over {}, models {}",
        s.swept.name(),
        s.built.name
    ))?;
    let mut titles = vec!["cycle".to_owned()];
    let listed = || s.fluids.iter().filter(|f| !f.refined);
    titles.extend(listed().map(|f| {
        let mark = if s.swept.is_beyond(f.value) { "*" } else { "" };
        format!("{}{mark}", significant(f.value))
    }));
    let mut table = Table::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
    for (k, read) in duties.list.iter().enumerate() {
        let mut row = vec![read.name.clone()];
        row.extend(listed().map(|f| format!("{:.2}", f.losses[k].0)));
        table.row(row);
    }
    out.text(&table.render())?;
    if listed().any(|f| s.swept.is_beyond(f.value)) {
        out.line("  * below 2 mm2/s the viscosity index is not defined; its law from 2 mm2/s on is continued")?;
    }
    for (read, least) in duties.list.iter().zip(&s.least) {
        let end = if least.at_end { ", at the end of the range" } else { "" };
        out.line(format!(
            "  {}: least at {} with {:.2} W{end}; within 1 % from {} to {}",
            read.name,
            significant(least.value),
            least.loss,
            significant(least.flat[0]),
            significant(least.flat[1])
        ))?;
    }
    out.line("")?;
    Ok(())
}

/// Mean loss over the property, whole and relative to the least of each duty.
pub fn pictures(
    runner: &Runner<'_>,
    name: &str,
    entry: &FluidSweepEntry,
    all: &[Sweep<'_>],
    duties: &Duties<'_>,
) -> Result<(), Failure> {
    let x = all.first().map_or_else(String::new, |s| s.swept.name());
    let lines = |relative: bool| -> Vec<Line> {
        let mut lines = Vec::new();
        for s in all {
            for (k, read) in duties.list.iter().enumerate() {
                let scale = if relative { 100.0 / s.least[k].loss } else { 1.0 };
                let points = s.fluids.iter().map(|f| (f.value, scale * f.losses[k].0));
                lines.push(Line {
                    name: format!("{} {}", s.built.name, read.name),
                    points: points.filter(|(_, y)| y.is_finite()).map(Some).collect(),
                    stroke: Stroke::Marked,
                });
            }
        }
        lines
    };
    for (file, y, relative) in [
        ("loss", "mean loss in W", false),
        ("relative", "mean loss in % of the least", true),
    ] {
        let figure = Figure::Lines {
            title: format!("{name}: {y}"),
            x: x.clone(),
            y: y.to_owned(),
            lines: lines(relative),
        };
        picture(runner, &format!("{name}-{file}"), figure, &entry.write)?;
    }
    Ok(())
}
