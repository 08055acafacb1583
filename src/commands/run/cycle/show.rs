//! Driven duties as tables.

use gearloss_studies::analysis::notes;
use gearloss_studies::duty::Duty;

use super::super::Runner;
use super::outcome::Outcome;
use crate::output::{Failure, Out, Table, significant};

pub fn show(runner: &Runner<'_>, name: &str, o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    let total = &o.driven.total;
    let loss = o.loss();
    out.line(format!(
        "{name}: {}, {} s, models {}: mean loss {} W, {} kJ",
        o.read.name,
        significant(o.duration()),
        o.built.name,
        significant(o.mean(loss)),
        significant(1e-3 * loss),
    ))?;
    if let Some(about) = &o.read.about {
        out.line(format!("  {about}"))?;
    }
    if let Duty::Trace(trace) = &o.read.duty {
        for note in &trace.notes {
            out.line(format!("  note: {note}"))?;
        }
    }
    if let Some(reference) = o.reference {
        let source = reference.source.as_deref().unwrap_or("reference");
        let ratio = 100.0 * (o.mean(loss) / reference.loss - 1.0);
        out.line(format!(
            "  {source}: {} W; the calculation is {ratio:+.1} % from it",
            significant(reference.loss)
        ))?;
    }
    let mut table = Table::new(&["loss", "mean W", "kJ", "share %"]);
    for (share, joule) in o.names.iter().zip(o.by_share()) {
        table.row(vec![
            share.clone(),
            format!("{:.2}", o.mean(joule)),
            format!("{:.2}", 1e-3 * joule),
            format!("{:.1}", if loss > 0.0 { 100.0 * joule / loss } else { 0.0 }),
        ]);
    }
    out.text(&table.render())?;
    if let Some(bands) = &o.bands {
        out.text(&bands.lines(o))?;
    }
    out.line(format!(
        "  energy in {} kJ, out {} kJ, left {:.1e} of the input",
        significant(1e-3 * total.input),
        significant(1e-3 * total.output),
        o.flow_residual()
    ))?;
    if o.driven.brakes > 0.0 {
        out.line(format!("  brakes take {} kJ", significant(1e-3 * o.driven.brakes)))?;
    }
    if o.is_thermal() {
        heat(o, out)?;
    }
    if total.beyond_map {
        out.line("  note: a motor was beyond its map; the loss at its edge counts")?;
    }
    out.line(format!(
        "  {} intervals, {} steps, {} evaluations",
        o.driven.stretches.len(),
        o.driven.steps[0],
        o.driven.evaluations
    ))?;
    runner.outside(&notes(&o.built.transmission, &o.driven.seen), out);
    out.line("")?;
    Ok(())
}

/// Heat and temperatures.
fn heat(o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    let total = &o.driven.total;
    let Some(network) = o.built.transmission.network() else {
        return Ok(());
    };
    let kj = |joule: f64| format!("{} kJ", significant(1e-3 * joule));
    let mut parts = vec![format!("losses {}", kj(o.loss()))];
    if !total.motors.is_empty() {
        parts.push(format!("motors {}", kj(o.motors())));
    }
    if total.sources != 0.0 {
        parts.push(format!("sources {}", kj(total.sources)));
    }
    let mut ways = vec![format!("stored {}", kj(total.stored))];
    for (node, joule) in total
        .held
        .iter()
        .enumerate()
        .filter(|(node, joule)| network.is_held(*node) || **joule != 0.0)
    {
        ways.push(format!("{} {}", network.names()[node], kj(*joule)));
    }
    for (path, joule) in network.exchangers().zip(&total.exchangers) {
        let id = path.rsplit('.').next().unwrap_or(path);
        ways.push(format!("{id} {}", kj(*joule)));
    }
    if total.flows.abs() > 1e-9 * total.came().abs() {
        ways.push(format!("carried away {}", kj(total.flows)));
    }
    out.line(format!(
        "  heat: {} = {}, left {:.1e}",
        parts.join(" + "),
        ways.join(" + "),
        o.heat_residual()
    ))?;
    let courses = o.courses();
    let measured = courses.iter().any(|c| c.rms.is_some());
    let mut head = vec!["node", "start degC", "end", "least", "greatest", "mean"];
    if measured {
        head.push("rms to measured K");
    }
    let mut table = Table::new(&head);
    for (name, c) in o.nodes.iter().zip(&courses) {
        let mut row = vec![name.clone()];
        row.extend([c.start, c.end, c.least, c.greatest, c.mean].map(|t| format!("{t:.2}")));
        if measured {
            row.push(c.rms.map_or_else(String::new, |(rms, _)| format!("{rms:.2}")));
        }
        table.row(row);
    }
    Ok(out.text(&table.render())?)
}
