//! A solved point: the record and text of `gearloss solve`, losses of the components, and how the temperature was found.

use gearloss_framework::files::SharedSource;
use gearloss_framework::language::Language;
use gearloss_report::html::{losses_of_parts, waterfall};
use gearloss_report::page::Block;
use gearloss_report::picture::Picture;
use gearloss_report::point::{Explained, PointRecord, outside_ranges, point_blocks, ratings_blocks, remarks};
use gearloss_report::schematic::oil_section;
use gearloss_studies::engine::progress::Progress;
use gearloss_studies::points::SolvedPoint;
use serde::Serialize;

use crate::answer::Fault;
use crate::chosen::Chosen;
use crate::convergence::Convergence;
use crate::request::PointOf;

/// A solved point.
#[derive(Debug, Serialize)]
pub struct PointAnswer {
    /// The record of `gearloss solve --format json`.
    pub point: PointRecord,
    /// Text and tables of `gearloss solve`.
    pub blocks: Vec<Block>,
    /// Status of the power flow.
    pub status: &'static str,
    /// Loss. [W]
    pub loss: Option<f64>,
    /// Efficiency.
    pub efficiency: Option<f64>,
    /// Oil temperature; absent without a heat balance. [degC]
    pub oil: Option<f64>,
    /// Losses of the components, the largest first.
    pub losses: Vec<ComponentLoss>,
    /// Losses of the parts of the drawing. [W]
    pub drawing: Vec<(String, f64)>,
    /// From the input to the output power.
    pub waterfall: Option<Picture>,
    /// Cross-section of the housing with its oil; absent if the oil space is not known.
    pub oil_section: Option<String>,
    /// How the temperature was found.
    pub convergence: Convergence,
    /// What a reader has to be careful about.
    pub remarks: Vec<String>,
}

/// Loss of a component.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComponentLoss {
    /// Path.
    pub path: String,
    /// Loss mechanism.
    pub mechanism: String,
    /// Model.
    pub model: String,
    /// Loss; absent if the model has no value. [W]
    pub loss: Option<f64>,
    /// Load-dependent share of it. [W]
    pub load_dependent: Option<f64>,
}

/// Solves a point.
pub fn point(
    language: &Language,
    files: &SharedSource,
    of: &PointOf,
    progress: &dyn Progress,
) -> Result<PointAnswer, Fault> {
    let chosen = Chosen::filled(language, files, &of.gearbox, (&of.model_set, of.oil_volume), progress)?;
    let Chosen {
        gearbox,
        resolved,
        transmission,
    } = &chosen;
    let prepared = chosen.prepare(of)?;
    let mut scratch = transmission.scratch(&prepared.case);
    let solved = prepared.solve(transmission, &mut scratch);
    let (solution, found) = (&solved.solution, &solved.found);
    let record = PointRecord::new(language, (gearbox, resolved, transmission), &prepared, &solved)?;
    let mut blocks = point_blocks(transmission, &prepared, &solved);
    blocks.append(ratings_blocks(&record.ratings));
    let flow = solution.has_flow();
    Ok(PointAnswer {
        blocks: blocks.into_vec(),
        status: solution.status().name(),
        loss: solution.loss(),
        efficiency: solution.efficiency(),
        oil: found.is_sound().then_some(found.oil),
        losses: components(&chosen, &solved),
        drawing: if flow {
            losses_of_parts(transmission, solution)
        } else {
            Vec::new()
        },
        oil_section: solution
            .oil_levels()
            .and_then(|levels| oil_section(transmission, &resolved.value, &levels, solution.pockets())),
        waterfall: flow.then(|| waterfall(set_name(of), solution)).flatten(),
        convergence: Convergence::new(transmission, found),
        remarks: outside_ranges(&solved)
            .lines()
            .map(str::to_owned)
            .chain(remarks(resolved, &record.changed_from_source, &record.evidence))
            .collect(),
        point: record,
    })
}

fn set_name(of: &PointOf) -> &str {
    if of.model_set.is_empty() {
        "models of the gearbox"
    } else {
        &of.model_set
    }
}

fn components(chosen: &Chosen, solved: &SolvedPoint<'_>) -> Vec<ComponentLoss> {
    let solution = &solved.solution;
    let flow = solution.has_flow();
    let parts = solution.parts().map(|(part, loss)| {
        let entry = &chosen.transmission.instances()[part.notes.instance()].entry;
        let dependent = entry.terms.iter().filter(|term| term.load_dependent);
        // The sum of nothing is -0.
        let dependent = 0.0 + dependent.map(|term| loss.term_watts(term.index)).sum::<f64>();
        let known = flow && loss.result.is_ok();
        ComponentLoss {
            path: part.path.clone(),
            mechanism: part.mechanism.to_owned(),
            model: entry.name.to_owned(),
            loss: known.then(|| loss.watts()),
            load_dependent: known.then_some(dependent),
        }
    });
    let mut parts: Vec<ComponentLoss> = parts.collect();
    let size = |part: &ComponentLoss| part.loss.unwrap_or(f64::INFINITY);
    parts.sort_by(|a, b| size(b).total_cmp(&size(a)));
    parts
}

/// Every step of the loss of a component, as text.
pub fn explain(
    language: &Language,
    files: &SharedSource,
    part: &str,
    of: &PointOf,
    progress: &dyn Progress,
) -> Result<String, Fault> {
    let chosen = Chosen::filled(language, files, &of.gearbox, (&of.model_set, of.oil_volume), progress)?;
    let Chosen {
        gearbox,
        resolved,
        transmission,
    } = &chosen;
    let explained = Explained::named(transmission, &component(&chosen, part))?;
    let prepared = chosen.prepare(of)?;
    let mut scratch = transmission.scratch(&prepared.case);
    let solved = prepared.solve(transmission, &mut scratch);
    let ratings = gearbox.ratings(language, resolved, transmission)?;
    Ok(explained.text((gearbox, resolved, transmission), &ratings, &prepared, &solved))
}

/// The component of a part of the drawing: gears have no losses of their own, their mesh has.
fn component(chosen: &Chosen, part: &str) -> String {
    let Some(gear) = part.strip_prefix("gears.") else {
        return part.to_owned();
    };
    let transmission = &chosen.transmission;
    let mut meshes = transmission.mesh_paths();
    let mesh = meshes.find(|path| transmission.gears_of_mesh(path).contains(&gear));
    mesh.map_or_else(|| part.to_owned(), ToString::to_string)
}
