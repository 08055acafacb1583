//! Solves the further points of a map that tables for other programs need.

use super::super::{Context, Stopped};
use super::Map;
use super::export::{ExportData, ExportName, Refusal};
use super::plan::Planned;
use super::shown::LossGrid;
use crate::points::{Given, Statistics, take_points};

impl ExportData {
    pub(super) fn solve(cx: &Context<'_>, formats: &[ExportName], map: &Map<'_>) -> Result<Self, Stopped> {
        let Some(grid) = map.shown.whole.as_ref().filter(|_| !formats.is_empty()) else {
            return Ok(Self::default());
        };
        let rated = map.built.transmission.rating.map(|rating| rating.torque);
        let further = formats.iter().map(|name| name.format().further_points(grid, rated));
        Ok(Self {
            between: between(cx, map, grid)?,
            rated,
            further: further
                .map(|list| loss_torques(cx, map, list))
                .collect::<Result<_, _>>()?,
        })
    }
}

/// Rejects unsuitable grids before computation.
pub(super) fn check(cx: &Context<'_>, formats: &[ExportName], planned: &[Planned<'_>]) -> Result<(), Stopped> {
    let path = format!("{}.export", cx.path());
    let conditions = &cx.study.entry.conditions;
    for name in formats {
        for plan in planned {
            let t = &plan.built.transmission;
            let reference = &t.ports()[t.reference_port()].name;
            if [&conditions.torque_at, &conditions.speed_at] != [reference, reference] {
                let message = format!("a table for another program needs torque and speed at `{reference}`");
                let help = format!("write `torque_at: {reference}` and `speed_at: {reference}` under `conditions`");
                return Err(cx.wrong(&path, message, &help));
            }
            let rising = |list: &[f64]| list.windows(2).all(|w| w[0] < w[1]);
            let fits = if rising(&plan.axes.torques) && rising(&plan.axes.speeds) {
                name.format().fits(&plan.axes)
            } else {
                Err(Refusal::new(
                    "a table for another program needs ascending torques and speeds",
                    "sort the axes of the grid",
                ))
            };
            fits.map_err(|refusal| cx.wrong(&path, refusal.message, &refusal.help))?;
        }
    }
    Ok(())
}

/// Loss torques at points of a map's gear, in order; absent if there is none. \[Nm\]
fn loss_torques(cx: &Context<'_>, map: &Map<'_>, list: Vec<Given>) -> Result<Vec<Option<f64>>, Stopped> {
    let mut losses = Vec::new();
    if list.is_empty() {
        return Ok(losses);
    }
    let points = cx.listed(&map.built.transmission, &map.gear, list);
    cx.solve_pieces(&map.built, &points, &take_points, &mut |piece| {
        losses.extend(piece.points().map(|p| p.loss_torque));
        Ok(())
    })?;
    Ok(losses)
}

/// Deviation of linear interpolation from the loss torque midway between the points of a table.
fn between(cx: &Context<'_>, map: &Map<'_>, grid: &LossGrid) -> Result<Option<(f64, f64)>, Stopped> {
    let axes = &grid.axes;
    let (mut list, mut means) = (Vec::new(), Vec::new());
    for i in 0..axes.torques.len().saturating_sub(1) {
        for k in 0..axes.speeds.len().saturating_sub(1) {
            let corners = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(a, b)| grid.loss_torque(i + a, k + b));
            let sum: Option<f64> = corners.into_iter().sum();
            let Some(sum) = sum else { continue };
            list.push(Given {
                torque: 0.5 * (axes.torques[i] + axes.torques[i + 1]),
                speed: 0.5 * (axes.speeds[k] + axes.speeds[k + 1]),
                oil: None,
            });
            means.push(0.25 * sum);
        }
    }
    let losses = loss_torques(cx, map, list)?;
    let gaps = means
        .into_iter()
        .zip(losses)
        .filter_map(|(mean, loss)| Some(mean - loss?));
    let gaps = Statistics::from_values(gaps);
    Ok(gaps.map(|g| (g.greatest.abs().max(g.least.abs()), g.rms)))
}
