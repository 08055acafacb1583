//! Maps in the best gear of each point: every gear is solved at every point, then each point in the gear that draws least.

use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::machine::{Machine, MachineState, Reached};
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::{Built, Engine, Planner, Run, Stopped};
use crate::analyses::cycle::Criterion;
use crate::codes;
use crate::points::{Field, Numbered, PointResult, Points};

/// The gears of a map in the best gear of each point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BestGears {
    /// What is compared.
    pub criterion: Criterion,
    /// Each gear with its share, in the order of the gearbox.
    pub gears: Vec<PointsInGear>,
}

/// Points in a gear.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PointsInGear {
    /// The gear.
    pub gear: String,
    /// Number of points. [-]
    pub points: usize,
    /// Share of the points. [-]
    pub share: f64,
}

/// One run for each gear that connects the ports and turns the given one in the direction of the first. `path` is the place of the gear.
pub fn runs<'a>(cx: &Planner<'a>, path: &str, built: &Arc<Built<'a>>, field: &Field) -> Result<Vec<Run<'a>>, Stopped> {
    let t = &built.transmission;
    let reference = &t.ports()[t.reference_port()];
    let (mut runs, mut first) = (Vec::new(), 0.0);
    for state in t.states() {
        let points = cx.field(t, &state.name, field.clone());
        if points.speed_at.first() == Some(&reference.name) || points.torque_at.first() == Some(&reference.name) {
            let message = format!(
                "torque or speed is given at `{}`, so that the gears of a point do not drive the same load",
                reference.name
            );
            let help = "write `conditions: { torque_at: output, speed_at: output }`, or name the gears of the map";
            return Err(cx.wrong_as(codes::GEAR_CHOICE, path, message, help));
        }
        let Ok(case) = points.case(t) else { continue };
        let ratio = t.speeds(&case, &vec![1.0; case.speed_ports.len()])[reference.member];
        if !ratio.is_finite() || ratio == 0.0 || ratio * first < 0.0 {
            continue;
        }
        if runs.is_empty() {
            first = ratio;
        }
        runs.push(Run::of_gear(cx, built, points)?);
    }
    if runs.is_empty() {
        let error = Diagnostic::error(path, "no gear of the gearbox connects the ports");
        let help = "describe such a state under `gear_states`, or name the gears of the map";
        return Err(cx.found(vec![error.help(help).code(codes::GEAR_CHOICE)]));
    }
    let points: Vec<&Points> = runs.iter().map(|run| &run.points).collect();
    cx.add_machine_demand(built, &points);
    Ok(runs)
}

/// The runs with the points at which each gear draws least. `machine` is a stated one at the reference port.
pub fn chosen<'a>(engine: &Engine<'_>, runs: &[Run<'a>], machine: Option<&Machine>) -> Result<Vec<Run<'a>>, Stopped> {
    let mut least: Vec<([f64; 2], usize)> = Vec::new();
    for (gear, run) in runs.iter().enumerate() {
        least.resize(run.points.field.len(), ([f64::INFINITY; 2], 0));
        let t = &run.built.transmission;
        let make = |points: &mut Numbered<'_>| -> Vec<(usize, [f64; 2])> {
            let cost = |point: &PointResult| cost(t, machine, point);
            points.iter().map(|(number, point)| (*number, cost(point))).collect()
        };
        engine.solve_pieces(run, &make, &mut |piece| {
            drop(piece.map(|costs| {
                for (number, cost) in costs {
                    if cost < least[number].0 {
                        least[number] = (cost, gear);
                    }
                }
            }));
            Ok(())
        })?;
    }
    let own = |(gear, run): (usize, &Run<'a>)| {
        let field = &run.points.field;
        let numbers = (0..field.len()).filter(|number| least[*number].1 == gear);
        let places: Vec<u32> = numbers.map(|number| field.place(number) as u32).collect();
        let [torques, speeds] = field.axes()?;
        (!places.is_empty()).then(|| Run {
            points: Points {
                field: Field::Part {
                    torques: torques.to_vec(),
                    speeds: speeds.to_vec(),
                    places: places.into(),
                },
                ..run.points.clone()
            },
            ..run.clone()
        })
    };
    Ok(runs.iter().enumerate().filter_map(own).collect())
}

/// The gears of a map.
pub fn gears(runs: &[Run<'_>], has_machine: bool) -> BestGears {
    let total: usize = runs.iter().map(|run| run.points.field.len()).sum();
    let of = |run: &Run<'_>| PointsInGear {
        gear: run.points.gear.clone(),
        points: run.points.field.len(),
        share: run.points.field.len() as f64 / total as f64,
    };
    BestGears {
        criterion: if has_machine {
            Criterion::MachinePower
        } else {
            Criterion::GearboxLoss
        },
        gears: runs.iter().map(of).collect(),
    }
}

/// How far a point is outside the map of its machines, and their power, or the loss of the gearbox; infinite without a solution. The least in
/// this order is the best. \[-, W\]
fn cost(t: &Transmission, machine: Option<&Machine>, point: &PointResult) -> [f64; 2] {
    let Some(loss) = point.loss.filter(|loss| loss.is_finite()) else {
        return [f64::INFINITY; 2];
    };
    if let Some(machine) = machine {
        let (power, speed) = (loss - point.torque * point.torque_speed, point.reference_speed);
        let torque = if speed == 0.0 { 0.0 } else { power / speed };
        let temperatures = [point.oil.unwrap_or(f64::NAN)];
        let state = t.machine_at(machine, speed, torque, &temperatures);
        let outside = machine.map().map_or(0.0, |map| map.excess(speed, torque));
        return [outside, power + state.machine + state.inverter];
    }
    if point.machines.is_empty() {
        return [0.0, loss];
    }
    let is_beyond = |state: &MachineState| state.outside || state.reached == Reached::Beyond;
    let beyond = point.machines.iter().filter(|state| is_beyond(state)).count();
    [beyond as f64, point.machines.iter().map(MachineState::electric).sum()]
}
