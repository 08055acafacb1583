//! `explain`: every step of the loss of one component, in the symbols and units of the source.

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::document::did_you_mean;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::transmission::Transmission;
use gearloss_report::point::{
    explain_heat_path, explain_part, explain_ratings, heading, locking_text, temperature_text,
};

use super::point::prepare;
use super::{set, warn};
use crate::args::ExplainArgs;
use crate::output::{End, Failure, Out, significant};

pub fn run(args: &ExplainArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let gearbox = Gearbox::read(language, &args.gearbox)?;
    let resolved = set::resolve(language, &gearbox, &args.choice)?;
    let transmission = gearbox.build(language, &resolved)?;
    warn(&gearbox, &transmission)?;
    let ways = ways_of(&transmission, &args.component);
    let chosen = match parts_of(&transmission, &args.component) {
        Err(_) if !ways.is_empty() => Vec::new(),
        chosen => chosen?,
    };
    let prepared = prepare(&args.point, &gearbox, &transmission)?;
    let mut scratch = transmission.scratch(&prepared.case);
    let solved = prepared.solve(&transmission, &mut scratch);
    let (solution, found) = (&solved.solution, &solved.found);
    let at = format!("oil {} degC", significant(found.oil));
    out.text(&heading(&transmission, solution, &prepared, &at))?;
    if let Some(locking) = &solved.locking {
        out.line(locking_text(locking))?;
    }
    if found.outcome().is_some() {
        out.line(temperature_text(&transmission, found))?;
    }
    let ratings = gearbox.ratings(language, &resolved, &transmission)?;
    let changed = changed_from_source(&transmission, &resolved);
    for way in ways {
        let surface = found.balance.as_ref().and_then(|b| b.surface).unwrap_or(found.oil);
        let text = explain_heat_path(&transmission, &gearbox, &resolved, way, (found.oil, surface));
        out.text(&text)?;
    }
    for part in chosen {
        out.text(&explain_part(
            &transmission,
            &gearbox,
            &resolved,
            solution,
            part,
            &changed,
        ))?;
        out.text(&explain_ratings(&transmission, &ratings, solution, part))?;
    }
    Ok(End::Fine)
}

/// Heat paths by path, by name, or all below `thermal`.
fn ways_of(transmission: &Transmission, name: &str) -> Vec<usize> {
    let fits =
        |path: &str| path == name || path.starts_with(&format!("{name}.")) || path.split('.').nth(2) == Some(name);
    let ways = transmission.housing().ways().iter().enumerate();
    ways.filter(|(_, way)| fits(&way.path)).map(|(i, _)| i).collect()
}

/// Component paths that match a path, an id, or the start of a path.
fn parts_of(transmission: &Transmission, name: &str) -> Result<Vec<usize>, Failure> {
    let fits =
        |path: &str| path == name || path.starts_with(&format!("{name}.")) || path.split('.').nth(1) == Some(name);
    let found: Vec<usize> = (0..transmission.parts().len())
        .filter(|i| fits(&transmission.parts()[*i].path))
        .collect();
    if !found.is_empty() {
        return Ok(found);
    }
    let paths: Vec<&str> = transmission.parts().iter().map(|p| p.path.as_str()).collect();
    let ids: Vec<&str> = paths.iter().filter_map(|p| p.split('.').nth(1)).collect();
    let help = match did_you_mean(name, paths.iter().chain(&ids).copied()) {
        Some(close) => format!("write {close}"),
        None => format!("write one of {}", paths.join(", ")),
    };
    Err(Failure::input(format!("there is no component `{name}`"), help))
}
