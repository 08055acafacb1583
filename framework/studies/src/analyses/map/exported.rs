//! Solves the further points of a map that tables for other programs need.

use gearloss_framework::machine::Machine;

use super::super::common::units::speed_ratio;
use super::super::{Engine, Planner, Stopped};
use super::Map;
use super::export::{ExportData, ExportName, MachineAtSpeeds, Refusal};
use super::map_of::MapOf;
use super::plan::Planned;
use super::shown::{LossAt, LossGrid};
use crate::codes;
use crate::points::{Given, OilTemperature, Statistics, take_points};

impl ExportData {
    pub(super) fn solve(engine: &Engine<'_>, formats: &[ExportName], map: &Map<'_>) -> Result<Self, Stopped> {
        let Some(grid) = map.shown.whole.as_ref().filter(|_| !formats.is_empty()) else {
            return Ok(Self::default());
        };
        let rated = map.run.built.transmission.rating.map(|rating| rating.torque);
        let further = formats.iter().map(|name| name.format().further_points(grid, rated));
        let no_load = if grid.axes.torques.contains(&0.0) {
            Vec::new()
        } else {
            losses(
                engine,
                map,
                grid.axes.speeds.iter().map(|speed| Given::new(0.0, *speed)).collect(),
            )?
        };
        Ok(Self {
            between: between(engine, map, &[grid.with_no_load(&no_load)], None)?,
            rated,
            further: further
                .map(|list| loss_torques(engine, map, list))
                .collect::<Result<_, _>>()?,
            no_load,
            ratio: speed_ratio(&map.run.built.transmission, &map.run.points.gear),
            machines: machines(map, &grid.axes.speeds),
            between_oils: None,
        })
    }

    /// Deviations between the oil temperatures of the maps of one set and gear.
    pub(super) fn solve_between_oils(engine: &Engine<'_>, maps: &mut [Map<'_>]) -> Result<(), Stopped> {
        for i in 0..maps.len() {
            let Some(cooler) = maps[i].oil.given() else { continue };
            let same = |map: &&Map<'_>| {
                (&map.run.built.name, &map.run.points.gear) == (&maps[i].run.built.name, &maps[i].run.points.gear)
            };
            let warmer = maps.iter().filter(same).filter_map(|map| Some((map.oil.given()?, map)));
            let next = warmer
                .filter(|(oil, _)| *oil > cooler)
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((oil, next)) = next else { continue };
            let complete = |map: &Map<'_>| {
                let grid = map.shown.whole.as_ref()?;
                Some(grid.with_no_load(&map.export.no_load))
            };
            let (Some(cold), Some(warm)) = (complete(&maps[i]), complete(next)) else {
                continue;
            };
            if cold.axes.torques == warm.axes.torques && cold.axes.speeds == warm.axes.speeds {
                let middle = Some(0.5 * (cooler + oil));
                maps[i].export.between_oils = between(engine, &maps[i], &[cold, warm], middle)?;
            }
        }
        Ok(())
    }
}

/// Rejects unsuitable grids before computation.
pub(super) fn check(
    cx: &Planner<'_>,
    (formats, of): (&[ExportName], MapOf),
    planned: &[Planned<'_>],
) -> Result<(), Stopped> {
    let path = format!("{}.export", cx.path());
    let conditions = &cx.study.entry.conditions;
    for name in formats {
        if let Err(refusal) = name.format().takes(of) {
            return Err(cx.wrong_as(codes::NO_MACHINE, &path, refusal.message, &refusal.help));
        }
        if let Some(bound) = not_an_axis(planned).filter(|_| name.format().joins_temperatures()) {
            let message = format!(
                "a `{}` table has torque, speed and oil temperature as axes, but the maps of the grid differ in `{bound}`",
                name.format().name()
            );
            let help = "bind one value of it, and write a grid and a map for each other value";
            return Err(cx.wrong(&path, message, help));
        }
        for plan in planned {
            let t = &plan.run.built.transmission;
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

/// A bound path besides the oil temperature in which maps of one set and gear differ, such as the voltage of a machine.
fn not_an_axis<'p>(planned: &'p [Planned<'_>]) -> Option<&'p str> {
    let of = |plan: &'p Planned<'_>| (&plan.run.built.name, &plan.run.points.gear, plan.run.points.oil);
    let pairs = planned.iter().enumerate();
    let mut pairs = pairs.flat_map(|(i, plan)| planned[..i].iter().map(move |other| (other, plan)));
    pairs.find_map(|(one, other)| {
        let mut bound = one.bound.iter().zip(&other.bound);
        let (differs, _) = bound.find(|(a, b)| a.1 != b.1 && !a.0.starts_with("thermal."))?;
        (of(one) == of(other)).then_some(differs.0.as_str())
    })
}

/// The machines of a map that shows them, over speeds of the reference port. \[rad/s\]
fn machines(map: &Map<'_>, speeds: &[f64]) -> Vec<MachineAtSpeeds> {
    if map.of.is_gearbox() {
        return Vec::new();
    }
    let t = &map.run.built.transmission;
    let machines = t.active_machines(map.run.points.oil == OilTemperature::Network);
    let at_speeds = |machine: &Machine| MachineAtSpeeds {
        at_reference: machine.port == t.reference_port(),
        freewheels: machine.freewheels(),
        most: machine
            .envelope()
            .map(|envelope| speeds.iter().map(|speed| envelope.most(*speed)).collect()),
    };
    machines.map(at_speeds).collect()
}

/// Losses at points of a map's gear, in order.
fn losses(engine: &Engine<'_>, map: &Map<'_>, list: Vec<Given>) -> Result<Vec<LossAt>, Stopped> {
    let mut losses = Vec::new();
    if list.is_empty() {
        return Ok(losses);
    }
    engine.solve_pieces(&map.run.with_list(list), &take_points, &mut |piece| {
        losses.extend(piece.points().map(|point| LossAt::new(map.of, point)));
        Ok(())
    })?;
    Ok(losses)
}

/// Loss torques at points of a map's gear, in order; absent if there is none. \[Nm\]
fn loss_torques(engine: &Engine<'_>, map: &Map<'_>, list: Vec<Given>) -> Result<Vec<Option<f64>>, Stopped> {
    Ok(losses(engine, map, list)?
        .into_iter()
        .map(|loss| loss.loss_torque)
        .collect())
}

/// Deviation of linear interpolation from the loss torque midway between the points of grids with equal axes, and near zero torque, at an
/// oil temperature.
fn between(
    engine: &Engine<'_>,
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
            let speed = 0.5 * (axes.speeds[k] + axes.speeds[k + 1]);
            for read in interpolated(map.of) {
                // The mean over all corners at one torque.
                let at = |torque: usize| {
                    let corners = grids
                        .iter()
                        .flat_map(|grid| [k, k + 1].map(|speed| grid.loss(torque, speed)));
                    let all = corners.map(|corner| read(corner?, speed));
                    Some(all.sum::<Option<f64>>()? / (2 * grids.len()) as f64)
                };
                let Some((first, last)) = at(i).zip(at(i + 1)) else {
                    continue;
                };
                for share in &shares {
                    list.push(Given {
                        torque: low + share * (high - low),
                        speed,
                        oil,
                    });
                    means.push(first + share * (last - first));
                }
            }
        }
    }
    let of_point = |loss: &LossAt| match map.of {
        MapOf::Gearbox => loss.loss_torque,
        MapOf::Unit | MapOf::Machine => loss.unit.map(|unit| unit.loss),
    };
    let losses = losses(engine, map, list)?;
    let gaps = means
        .into_iter()
        .zip(&losses)
        .filter_map(|(mean, loss)| Some(mean - of_point(loss)?));
    let gaps = Statistics::from_values(gaps);
    Ok(gaps.map(|g| (g.greatest.abs().max(g.least.abs()), g.rms)))
}

/// A quantity that tables interpolate, at a corner of a cell and the speed in its middle. \[rad/s\]
type Interpolated = fn(&LossAt, f64) -> Option<f64>;

/// What tables interpolate: the loss torque; of a drive unit its loss, or the loss torque of the gearbox with the losses of the machines.
fn interpolated(of: MapOf) -> &'static [Interpolated] {
    fn loss_torque(loss: &LossAt, _: f64) -> Option<f64> {
        loss.loss_torque
    }
    fn whole(loss: &LossAt, _: f64) -> Option<f64> {
        Some(loss.unit?.loss)
    }
    fn in_parts(loss: &LossAt, speed: f64) -> Option<f64> {
        let unit = loss.unit?;
        Some(unit.gearbox_torque? * speed.abs() + unit.point.machine_loss_w + unit.point.inverter_loss_w)
    }
    match of {
        MapOf::Gearbox => &[loss_torque],
        MapOf::Unit => &[whole, in_parts],
        MapOf::Machine => &[whole],
    }
}
