//! Loss tables for other programs, one file for each gear state.
//!
//! A format implements [`ExportFormat`](gearloss_studies::analyses::map::ExportFormat) and registers itself with
//! [`register_export!`](gearloss_studies::register_export), in any crate.

pub mod bearing_loads;
mod fmu;
mod lossy_gear;
mod mat;
mod matlab;
mod modelica;
pub mod network;
mod rexs_loads;
mod slabs;
mod vecto;

use crate::codes;
use gearloss_framework::document::Diagnostic;
use gearloss_studies::analyses::map::{ExportMap, MapOfSet, MapOutcome};

use crate::page::Page;

/// Adds the requested files, with a line for each; stops at the first error.
pub fn add(outcome: &MapOutcome, page: &mut Page) {
    for (format, export) in outcome.exports.iter().enumerate() {
        for (i, map) in outcome.maps.iter().enumerate() {
            let Some(grid) = &map.shown.whole else { continue };
            let same = |m: &&MapOfSet| m.model_set == map.model_set && m.gear == map.gear;
            let exported = ExportMap {
                outcome,
                map,
                grid,
                siblings: outcome.maps.iter().filter(same).collect(),
                number: outcome.maps[..i].iter().filter(same).count() + 1,
                further: map.export.further.get(format).map_or(&[], Vec::as_slice),
            };
            match export.format().file(&exported) {
                Ok(None) => {}
                Ok(Some(file)) => {
                    let missed = missed(&export.format().covered(&exported));
                    page.line(format!(
                        "{}: {}: {}{missed}",
                        outcome.head.analysis, file.name, file.about
                    ));
                    page.file(file.name, file.bytes);
                    for file in export.format().further_files(&exported) {
                        page.line(format!("{}: {}: {}", outcome.head.analysis, file.name, file.about));
                        page.file(file.name, file.bytes);
                    }
                }
                Err(refusal) => {
                    let path = format!("analyses.{}.export", outcome.head.analysis);
                    return page.fault(
                        Diagnostic::error(path, refusal.message)
                            .help(refusal.help)
                            .code(codes::EXPORT),
                    );
                }
            }
        }
    }
}

/// The interpolation error of some maps, as the end of a sentence.
fn missed(maps: &[&MapOfSet]) -> String {
    let all = maps
        .iter()
        .flat_map(|map| [map.export.between, map.export.between_oils]);
    let both = all.flatten().reduce(|a, b| (a.0.max(b.0), a.1.max(b.1)));
    let of_gearbox = maps.iter().all(|map| map.of.is_gearbox());
    let (what, unit) = if of_gearbox {
        ("loss torque", "Nm")
    } else {
        ("loss", "W")
    };
    both.map_or_else(String::new, |(worst, rms)| {
        format!(
            "; interpolation error of the {what} between grid points: at most {worst:.4} {unit}, {rms:.4} {unit} rms"
        )
    })
}
