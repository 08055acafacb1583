//! Points of a map over a grid.

use std::sync::Arc;

use gearloss_framework::gearbox::Gearbox;
use serde_json::Value;

use super::super::common::axes::grid_axes;
use super::super::{Planner, Run, Stopped};
use super::axes::Axes;
use super::best;
use super::entry::MapEntry;
use crate::points::{Field, Given};
use crate::study::{BEST, Envelope, Grid, SpeedAxis, TorqueAxis};

/// The points of one map over a grid.
pub struct Planned<'a> {
    pub bound: Vec<(String, Value)>,
    pub axes: Axes,
    /// Maps that differ only in their points share a transmission.
    pub run: Run<'a>,
    /// All gears of a map in the best gear of each point; otherwise none.
    pub gears: Vec<Run<'a>>,
}

/// One map for each gear, each set and each combination of bound values.
pub fn on_grid<'a>(
    cx: &Planner<'a>,
    entry: &MapEntry,
    grid_name: &str,
    gearbox: &'a Gearbox,
) -> Result<Vec<Planned<'a>>, Stopped> {
    let grid = cx.study.grid(&cx.path(), grid_name)?;
    let path = format!("grids.{grid_name}");
    let combinations = grid.combinations().map_err(|bound| {
        let message = format!("`{bound}` has no list of values");
        cx.wrong(&format!("{path}.bind"), message, "write for example `[60 ml, 90 ml]`")
    })?;
    if let Some(Err(reason)) = grid.envelope.as_ref().map(Envelope::check) {
        let help = "give equal numbers of torques and speeds, with ascending speeds";
        return Err(cx.wrong(&format!("{path}.envelope"), reason, help));
    }
    let mut maps = Vec::new();
    for bound in combinations {
        let change = |(changed, value): &(String, Value)| (changed.clone(), value.clone(), format!("{path}.bind"));
        let changes: Vec<_> = bound.iter().map(change).collect();
        for built in cx.built_with(gearbox, &entry.model_sets, &changes)? {
            let t = &built.transmission;
            let (torques, speeds) = grid_axes(cx, grid_name, grid, t)?;
            let axes = Axes {
                torques,
                speeds,
                shares: [
                    t.rating
                        .filter(|_| matches!(grid.speed, SpeedAxis::Rated(_)))
                        .map(|r| r.speed),
                    t.rating
                        .filter(|_| matches!(grid.torque, TorqueAxis::Rated(_)))
                        .map(|r| r.torque),
                ],
            };
            let field = below(grid, &axes);
            if field.is_empty() {
                let path = format!("{path}.envelope");
                return Err(cx.wrong(
                    &path,
                    "no point of the grid is below the envelope",
                    "correct one of them",
                ));
            }
            for gear in grid.gear.selected(t) {
                if gear == BEST {
                    let at = format!("{path}.gear");
                    if let Some(name) = entry.export.first() {
                        let format = name.format().name();
                        let message = format!("a `{format}` table has one gear, but the grid has `gear: best`");
                        return Err(cx.wrong(&at, message, "name the gears of the grid"));
                    }
                    let gears = best::runs(cx, &at, &built, &field)?;
                    maps.push(Planned {
                        bound: bound.clone(),
                        axes: axes.clone(),
                        run: gears[0].clone(),
                        gears,
                    });
                    continue;
                }
                maps.push(Planned {
                    bound: bound.clone(),
                    axes: axes.clone(),
                    run: Run::new(cx, &built, cx.field(t, &gear, field.clone()))?,
                    gears: Vec::new(),
                });
            }
        }
    }
    Ok(maps)
}

/// The points of a grid, below the envelope if there is one.
fn below(grid: &Grid, axes: &Axes) -> Field {
    let (torques, speeds) = (axes.torques.clone(), axes.speeds.clone());
    let whole = Field::Grid { torques, speeds };
    let Some(envelope) = &grid.envelope else {
        return whole;
    };
    let held = |place: &u32| {
        let Given { torque, speed, .. } = whole.given_point(*place as usize);
        envelope.holds(torque, speed)
    };
    let count = u32::try_from(whole.len()).unwrap_or(u32::MAX);
    let places: Arc<[u32]> = (0..count).filter(held).collect();
    if places.len() == whole.len() {
        return whole;
    }
    Field::Part {
        torques: axes.torques.clone(),
        speeds: axes.speeds.clone(),
        places,
    }
}
