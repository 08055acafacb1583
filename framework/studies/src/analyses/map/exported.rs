//! Solves the further points of a map that tables for other programs need.

use gearloss_fmu::Library;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::transmission::Transmission;

use super::super::{Context, Stopped};
use super::Map;
use super::export::{ExportData, ExportName, Refusal};
use super::plan::Planned;
use super::shown::{LossAt, LossGrid};
use crate::codes;
use crate::points::{Given, Statistics, take_points};

impl ExportData {
    pub(super) fn solve(cx: &Context<'_>, formats: &[ExportName], map: &Map<'_>) -> Result<Self, Stopped> {
        let Some(grid) = map.shown.whole.as_ref().filter(|_| !formats.is_empty()) else {
            return Ok(Self::default());
        };
        let rated = map.built.transmission.rating.map(|rating| rating.torque);
        let further = formats.iter().map(|name| name.format().further_points(grid, rated));
        let no_load = if grid.axes.torques.contains(&0.0) {
            Vec::new()
        } else {
            losses(
                cx,
                map,
                grid.axes.speeds.iter().map(|speed| Given::new(0.0, *speed)).collect(),
            )?
        };
        Ok(Self {
            between: between(cx, map, &[grid.with_no_load(&no_load)], None)?,
            rated,
            further: further
                .map(|list| loss_torques(cx, map, list))
                .collect::<Result<_, _>>()?,
            no_load,
            ratio: ratio(map),
            between_oils: None,
        })
    }

    /// Deviations between the oil temperatures of the maps of one set and gear.
    pub(super) fn solve_between_oils(cx: &Context<'_>, maps: &mut [Map<'_>]) -> Result<(), Stopped> {
        for i in 0..maps.len() {
            let Some(own) = maps[i].oil.given() else { continue };
            let same = |map: &&Map<'_>| map.built.name == maps[i].built.name && map.gear == maps[i].gear;
            let warmer = maps.iter().filter(same).filter_map(|map| Some((map.oil.given()?, map)));
            let next = warmer.filter(|(oil, _)| *oil > own).min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((oil, next)) = next else { continue };
            let complete = |map: &Map<'_>| {
                let grid = map.shown.whole.as_ref()?;
                Some(grid.with_no_load(&map.export.no_load))
            };
            let (Some(cold), Some(warm)) = (complete(&maps[i]), complete(next)) else {
                continue;
            };
            if cold.axes.torques == warm.axes.torques && cold.axes.speeds == warm.axes.speeds {
                let middle = Some(0.5 * (own + oil));
                maps[i].export.between_oils = between(cx, &maps[i], &[cold, warm], middle)?;
            }
        }
        Ok(())
    }
}

/// The libraries of FMUs: that of the own platform, and those of the files.
pub(crate) fn libraries(cx: &Context<'_>, files: &[String], is_needed: bool) -> Result<Vec<Library>, Stopped> {
    let path = format!("{}.fmu_libraries", cx.path());
    if !is_needed {
        return match files {
            [] => Ok(Vec::new()),
            _ => Err(cx.wrong(&path, "no FMU is exported", "write `export: [fmu2]`, or delete it")),
        };
    }
    let mut libraries: Vec<Library> = Library::own().into_iter().collect();
    let mut found = Vec::new();
    for file in files {
        let read = cx.study.read_file(file).map_err(|e| format!("cannot read {file}: {e}"));
        let library = read.and_then(|bytes| {
            cx.keep_input(file, &bytes);
            Library::read(bytes).map_err(|e| format!("{file} {e}"))
        });
        match library {
            Ok(library) => {
                libraries.retain(|own| own.platform != library.platform);
                libraries.push(library);
            }
            Err(reason) => found.push(
                Diagnostic::error(path.clone(), reason)
                    .help("take the library out of the folder `binaries` of an FMU that gearloss wrote on the other platform")
                    .code(codes::ANALYSIS),
            ),
        }
    }
    if !found.is_empty() {
        return Err(cx.found(found));
    }
    if libraries.is_empty() {
        return Err(cx.wrong(
            &format!("{}.export", cx.path()),
            "this program has no library for FMUs, because its own platform loads none",
            "write `fmu_libraries: [FILE]` with a library out of an FMU that gearloss wrote on another platform",
        ));
    }
    libraries.sort_by_key(|library| library.platform);
    Ok(libraries)
}

/// Speed of the other port over that of the reference port, if there are two.
fn ratio(map: &Map<'_>) -> Option<f64> {
    speed_ratio(&map.built.transmission, &map.gear)
}

/// Speed of the other port over that of the reference port in a gear, if there are two ports and both turn.
pub(crate) fn speed_ratio(t: &Transmission, gear: &str) -> Option<f64> {
    let reference = &t.ports()[t.reference_port()];
    let [other] = t
        .ports()
        .iter()
        .filter(|port| port.name != reference.name)
        .collect::<Vec<_>>()[..]
    else {
        return None;
    };
    let state = t.state(gear).ok()?;
    let torques: &[&str] = if t.torques_needed(state) == 0 {
        &[]
    } else {
        &[&reference.name]
    };
    let case = t.case(gear, &[&reference.name], torques).ok()?;
    let speeds = t.speeds(&case, &[1.0]);
    let ratio = speeds[other.member] / speeds[reference.member];
    (ratio.is_finite() && ratio != 0.0).then_some(ratio)
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

/// Losses at points of a map's gear, in order.
fn losses(cx: &Context<'_>, map: &Map<'_>, list: Vec<Given>) -> Result<Vec<LossAt>, Stopped> {
    let mut losses = Vec::new();
    if list.is_empty() {
        return Ok(losses);
    }
    let points = cx.listed(&map.built.transmission, &map.gear, list);
    cx.solve_pieces(&map.built, &points, &take_points, &mut |piece| {
        losses.extend(piece.points().map(LossAt::from));
        Ok(())
    })?;
    Ok(losses)
}

/// Loss torques at points of a map's gear, in order; absent if there is none. \[Nm\]
fn loss_torques(cx: &Context<'_>, map: &Map<'_>, list: Vec<Given>) -> Result<Vec<Option<f64>>, Stopped> {
    Ok(losses(cx, map, list)?
        .into_iter()
        .map(|loss| loss.loss_torque)
        .collect())
}

/// Deviation of linear interpolation from the loss torque midway between the points of grids with equal axes, and near zero torque, at an
/// oil temperature.
fn between(
    cx: &Context<'_>,
    map: &Map<'_>,
    grids: &[LossGrid],
    oil: Option<f64>,
) -> Result<Option<(f64, f64)>, Stopped> {
    let Some(axes) = grids.first().map(|grid| &grid.axes) else {
        return Ok(None);
    };
    let (mut list, mut means) = (Vec::new(), Vec::new());
    for i in 0..axes.torques.len().saturating_sub(1) {
        let [low, high] = [axes.torques[i], axes.torques[i + 1]];
        // The loss torque bends near zero torque.
        let beside_zero = [(low, 0.125), (high, 0.875)];
        let beside_zero = beside_zero.into_iter().filter(|(torque, _)| *torque == 0.0);
        let shares: Vec<f64> = beside_zero.map(|(_, share)| share).chain([0.5]).collect();
        for k in 0..axes.speeds.len().saturating_sub(1) {
            // The mean over all corners at one torque.
            let at = |torque: usize| {
                let all = grids
                    .iter()
                    .flat_map(|grid| [k, k + 1].map(|speed| grid.loss_torque(torque, speed)));
                Some(all.sum::<Option<f64>>()? / (2 * grids.len()) as f64)
            };
            let Some((first, last)) = at(i).zip(at(i + 1)) else {
                continue;
            };
            for share in &shares {
                list.push(Given {
                    torque: low + share * (high - low),
                    speed: 0.5 * (axes.speeds[k] + axes.speeds[k + 1]),
                    oil,
                });
                means.push(first + share * (last - first));
            }
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
