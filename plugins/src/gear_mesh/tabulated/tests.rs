#![allow(clippy::unwrap_used)]
use std::cell::Cell;
use std::sync::Arc;

use gearloss_framework::loss::{Extent, Notes};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, MeshPart};
use gearloss_framework::registry::{Build, Files, Registry, Slot};
use gearloss_framework::sampling::Sobol;
use serde_json::{Value, json};

use super::table::Point;
use crate::tooth_friction::ehl_mixed::cases::stage;

const RPM: f64 = std::f64::consts::PI / 30.0;

fn path_integral(friction: Value) -> Value {
    json!({ "type": "path_integral", "load_sharing": "ramp", "tooth_friction": friction })
}

fn ehl() -> Value {
    path_integral(json!({ "type": "ehl_mixed" }))
}

fn build(part: &Arc<MeshPart>, model: &Value) -> Result<(Slot<GearMesh>, usize), String> {
    let registry = Registry::linked().unwrap();
    let files = Files::default();
    let mut build = Build::new(&registry, &files);
    let slot = build
        .slot_at::<GearMesh>("meshes.M1.model", part, model)
        .map_err(|fault| format!("{fault}"))?;
    Ok((slot, build.finish().1))
}

/// A stage with a model and its table.
struct Rig {
    part: Arc<MeshPart>,
    of: Slot<GearMesh>,
    table: Slot<GearMesh>,
    cells: usize,
}

/// What a table answers: power, share of the heat, and what it notes.
struct Told {
    watts: f64,
    share: f64,
    extents: Vec<Extent>,
}

impl Rig {
    fn new(number: usize, of: &Value, changes: &Value) -> Self {
        let part = Arc::new(stage(number));
        let mut model = json!({ "type": "tabulated", "of": of });
        for (key, change) in changes.as_object().unwrap() {
            model[key] = change.clone();
        }
        let (table, cells) = build(&part, &model).unwrap();
        Self {
            of: build(&part, of).unwrap().0,
            table,
            cells,
            part,
        }
    }

    fn itself(&self, point: &Point) -> (f64, f64) {
        let lubricant = &self.part.oil.as_ref().unwrap().lubricant;
        let loss = self.of.loss(&point.at(&self.part, lubricant, Notes::MUTED)).unwrap();
        (loss.sum(), loss.first_heat())
    }

    fn told(&self, point: &Point) -> Told {
        let lubricant = &self.part.oil.as_ref().unwrap().lubricant;
        let mut extents = vec![Extent::EMPTY; self.cells];
        let cells = Cell::from_mut(extents.as_mut_slice()).as_slice_of_cells();
        let at = point.at(&self.part, lubricant, Notes::new(cells, self.table.notes));
        let loss = self.table.loss(&at).unwrap();
        Told {
            watts: loss.sum(),
            share: loss.first_heat(),
            extents,
        }
    }

    /// The share of independent points at which the error of the loss exceeds the stated one, with the greatest and the stated, and
    /// the rms of both.
    fn exceeding(&self, known: bool, torques: [f64; 2], speeds: [f64; 2], temperatures: [f64; 2]) -> [f64; 5] {
        let sobol = Sobol::new(7).unwrap();
        let (mut over, mut most, mut squares, mut stated) = (0.0, 0.0_f64, 0.0, [0.0; 2]);
        let count = 3000;
        for i in 0..count {
            let x = sobol.point(5000 + i);
            let spread = |ends: [f64; 2], x: f64| ends[0] * (ends[1] / ends[0]).powf(x);
            let t = temperatures[0] + (temperatures[1] - temperatures[0]) * x[2];
            let half = 20.0 * (x[3] - 0.5);
            let point = Point {
                speed: spread(speeds, x[5]) * RPM,
                torque: spread(torques, x[6]),
                oil: if known { (t - 30.0 * x[4]).max(-20.0) } else { t },
                bodies: known.then_some([t + half, t - half]),
            };
            let told = self.told(&point);
            let notes = &told.extents[self.table.notes.observed..];
            stated = [notes[0].greatest / 100.0, notes[1].greatest / 100.0];
            let error = (told.watts / self.itself(&point).0 - 1.0).abs();
            over += f64::from(u8::from(error > stated[0]));
            most = most.max(error);
            squares += error * error;
        }
        let n = f64::from(count);
        [over / n, most, stated[0], (squares / n).sqrt(), stated[1]]
    }
}

/// Torques up to which the tables of both stages reach by themselves.
fn torques(number: usize) -> [f64; 2] {
    super::torques(&stage(number))
}

#[test]
fn the_stated_error_bounds_that_at_other_points() {
    for number in [1, 2] {
        let rig = Rig::new(number, &ehl(), &json!({}));
        for known in [false, true] {
            let [over, most, stated, rms, stated_rms] =
                rig.exceeding(known, torques(number), [10.0, 20000.0], [-20.0, 140.0]);
            println!(
                "{number} {known} over {over} most {most} stated {stated} rms {rms} stated {stated_rms} {:?}",
                torques(number)
            );
        }
    }
}
