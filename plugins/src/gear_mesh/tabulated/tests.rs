#![allow(clippy::unwrap_used)]
use std::cell::Cell;
use std::sync::Arc;

use gearloss_framework::loss::{Extent, Notes, Seen};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, MeshPart};
use gearloss_framework::registry::{Build, Files, Registry, Slot};
use gearloss_numerics::sampling::Sobol;
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

/// Result of a table: power, heat share, and its notes.
struct Interpolated {
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

    fn direct(&self, point: &Point) -> (f64, f64) {
        let lubricant = &self.part.oil.as_ref().unwrap().lubricant;
        let loss = self
            .of
            .loss(&point.context(&self.part, lubricant, Notes::MUTED))
            .unwrap();
        (loss.sum(), loss.first_heat())
    }

    fn interpolated(&self, point: &Point) -> Interpolated {
        let lubricant = &self.part.oil.as_ref().unwrap().lubricant;
        let cells = vec![Cell::new(Seen::NOTHING); self.cells];
        let at = point.context(&self.part, lubricant, Notes::new(&cells, self.table.notes));
        let loss = self.table.loss(&at).unwrap();
        Interpolated {
            watts: loss.sum(),
            share: loss.first_heat(),
            extents: cells.iter().map(|seen| seen.get().extent()).collect(),
        }
    }

    /// The share of independent points at which the loss error exceeds the stated one, with the maximum and the stated error, and
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
            let interpolated = self.interpolated(&point);
            let notes = &interpolated.extents[self.table.notes.observed()..];
            stated = [notes[0].greatest / 100.0, notes[1].greatest / 100.0];
            let error = (interpolated.watts / self.direct(&point).0 - 1.0).abs();
            over += f64::from(u8::from(error > stated[0]));
            most = most.max(error);
            squares += error * error;
        }
        let n = f64::from(count);
        [over / n, most, stated[0], (squares / n).sqrt(), stated[1]]
    }
}

/// Default maximum torques of the tables of both stages.
fn torques(number: usize) -> [f64; 2] {
    super::torques(&stage(number))
}

fn point(torque: f64, rpm: f64, oil: f64) -> Point {
    Point {
        speed: rpm * RPM,
        torque,
        oil,
        bodies: None,
    }
}

#[test]
fn the_stated_error_bounds_all_but_one_in_a_hundred_other_points() {
    for number in [1, 2] {
        let rig = Rig::new(number, &ehl(), &json!({}));
        for known in [false, true] {
            let [over, most, stated, rms, stated_rms] =
                rig.exceeding(known, torques(number), [10.0, 20000.0], [-20.0, 140.0]);
            assert!(
                over < 0.01,
                "{over} of the points err more than {stated}, at most {most}"
            );
            assert!(most < 2.0 * stated && stated < 0.03, "{most} {stated}");
            assert!(rms < stated_rms && stated_rms < 0.0075, "{rms} {stated_rms}");
        }
    }
}

#[test]
fn over_what_a_drive_uses_the_error_is_a_third() {
    let changes =
        json!({ "speeds": [20.0 * RPM, 12000.0 * RPM], "torques": [1.0, 300.0], "temperatures": [0.0, 120.0] });
    let rig = Rig::new(1, &ehl(), &changes);
    let [over, most, stated, rms, _] = rig.exceeding(false, [1.0, 300.0], [20.0, 12000.0], [0.0, 120.0]);
    assert!(
        over < 0.01 && most < 0.0125 && stated < 0.01 && rms < 0.0015,
        "{over} {most} {stated} {rms}"
    );
}

#[test]
fn more_nodes_leave_less() {
    let rms = |nodes: [u32; 3]| {
        let rig = Rig::new(2, &ehl(), &json!({ "nodes": nodes }));
        rig.exceeding(false, torques(2), [10.0, 20000.0], [-20.0, 140.0])[3]
    };
    let [few, usual, many] = [[6, 6, 6], [8, 8, 6], [14, 12, 9]].map(rms);
    assert!(few > 2.0 * usual && usual > 3.0 * many, "{few} {usual} {many}");
}

#[test]
fn constant_friction_is_met_to_rounding() {
    let rig = Rig::new(
        1,
        &path_integral(json!({ "type": "constant", "value": 0.05 })),
        &json!({}),
    );
    for (torque, rpm, oil) in [(1.0, 11.0, -19.0), (33.0, 3210.0, 61.0), (286.0, 19990.0, 139.0)] {
        let point = point(torque, rpm, oil);
        let (interpolated, (watts, share)) = (rig.interpolated(&point), rig.direct(&point));
        assert!((interpolated.watts / watts - 1.0).abs() < 1e-12 && (interpolated.share - share).abs() < 1e-12);
        // The maximum error is rounding as well.
        assert!(interpolated.extents[rig.table.notes.observed()].greatest < 1e-10);
    }
}

#[test]
fn beyond_its_ends_and_at_rest_the_model_itself_answers() {
    let rig = Rig::new(1, &ehl(), &json!({}));
    for (torque, rpm, oil) in [
        (0.1, 3000.0, 60.0),
        (500.0, 3000.0, 60.0),
        (50.0, 2.0, 60.0),
        (50.0, 3000.0, 160.0),
    ] {
        let point = point(torque, rpm, oil);
        let interpolated = rig.interpolated(&point);
        assert_eq!((interpolated.watts, interpolated.share), rig.direct(&point));
        // The exceeded range is noted by position, and the model's own observations are shown.
        let [place, left] = [0, 1].map(|i| interpolated.extents[rig.table.notes.limits() + i]);
        assert_eq!((place.outside, left.seen), (1, 0));
        assert!(
            interpolated.extents[rig.of.notes.observed()..]
                .iter()
                .any(|e| e.seen > 0)
        );
    }
    assert_eq!(rig.interpolated(&point(0.0, 3000.0, 60.0)).watts, 0.0);
    assert_eq!(rig.interpolated(&point(50.0, 0.0, 60.0)).watts, 0.0);
}

#[test]
fn both_senses_lose_the_same() {
    let rig = Rig::new(1, &ehl(), &json!({}));
    let [forward, backward] = [3000.0, -3000.0].map(|rpm| rig.interpolated(&point(50.0, rpm, 60.0)).watts);
    assert_eq!(forward.to_bits(), backward.to_bits());
}

#[test]
fn any_number_of_threads_reads_the_same_bits() {
    let points: Vec<Point> = (1..40)
        .map(|i| point(7.0 * f64::from(i), 400.0 * f64::from(i), 3.0 * f64::from(i)))
        .collect();
    let read = |rig: &Rig| {
        points
            .iter()
            .map(|p| rig.interpolated(p).watts.to_bits())
            .collect::<Vec<_>>()
    };
    let rig = Rig::new(2, &ehl(), &json!({}));
    let one = read(&rig);
    assert_eq!(one, read(&rig));
    let other = Rig::new(2, &ehl(), &json!({}));
    // All of them need the table at the same time.
    std::thread::scope(|scope| {
        let started: Vec<_> = (0..4).map(|_| scope.spawn(|| read(&other))).collect();
        for thread in started {
            assert_eq!(one, thread.join().unwrap());
        }
    });
}

#[test]
fn loss_rises_with_speed_torque_and_falls_nowhere_below_zero() {
    let rig = Rig::new(1, &ehl(), &json!({}));
    let sweep = |f: &dyn Fn(f64) -> Point| -> Vec<f64> {
        (0..400)
            .map(|i| rig.interpolated(&f(f64::from(i) / 399.0)).watts)
            .collect()
    };
    for t in [-20.0, 20.0, 60.0, 100.0, 140.0] {
        for x in [0.02, 0.3, 0.7, 0.98] {
            let torque = |x: f64| 0.29 * 985.0_f64.powf(x);
            let speed = |x: f64| 10.01 * 1990.0_f64.powf(x);
            for watts in [
                sweep(&|y| point(torque(y), speed(x), t)),
                sweep(&|y| point(torque(x), speed(y), t)),
            ] {
                assert!(watts[0] > 0.0 && watts.windows(2).all(|w| w[1] > w[0]), "{t} {x}");
            }
        }
    }
}

#[test]
fn bodies_that_are_known_count_where_the_model_looks_at_them() {
    let with = |bodies: f64| Point {
        bodies: Some([bodies; 2]),
        ..point(100.0, 4000.0, 60.0)
    };
    let rig = Rig::new(1, &ehl(), &json!({}));
    let [cold, hot] = [60.0, 100.0].map(|t| (rig.interpolated(&with(t)).watts, rig.direct(&with(t)).0));
    assert!(hot.1 > 1.2 * cold.1);
    for (interpolated, itself) in [cold, hot] {
        assert!((interpolated / itself - 1.0).abs() < 0.01, "{interpolated} {itself}");
    }
    // Friction that depends on the oil alone uses the table over the oil, to the bit.
    let rig = Rig::new(
        1,
        &path_integral(json!({ "type": "xu", "roughness": "composite_rms" })),
        &json!({}),
    );
    let plain = rig.interpolated(&point(100.0, 4000.0, 60.0)).watts;
    assert_eq!(plain.to_bits(), rig.interpolated(&with(100.0)).watts.to_bits());
    assert!((plain / rig.direct(&with(100.0)).0 - 1.0).abs() < 0.01);
}

#[test]
fn heat_passes_between_bodies_that_differ() {
    for number in [1, 2] {
        let rig = Rig::new(number, &ehl(), &json!({}));
        let sobol = Sobol::new(4).unwrap();
        let (mut over, mut moved) = (0, 0);
        for i in 0..500 {
            let x = sobol.point(1000 + i);
            let half = 20.0 * (x[0] - 0.5);
            let mean = 140.0 * x[1];
            let point = Point {
                bodies: Some([mean + half, mean - half]),
                ..point(2.0 * 140.0_f64.powf(x[2]), 20.0 * 900.0_f64.powf(x[3]), mean)
            };
            let (interpolated, (_, share)) = (rig.interpolated(&point), rig.direct(&point));
            let stated = interpolated.extents[rig.table.notes.observed() + 2].greatest;
            assert!(stated < 0.05, "{stated}");
            over += u32::from((interpolated.share - share).abs() > stated);
            moved += u32::from((share - 0.5).abs() > 0.4);
        }
        assert!(over <= 5 && moved > 100, "{over} {moved}");
    }
}

#[test]
fn ranges_that_the_model_leaves_at_a_node_are_noted() {
    let rig = Rig::new(1, &ehl(), &json!({}));
    let left = |t: f64| rig.interpolated(&point(30.0, 3000.0, t)).extents[rig.table.notes.limits() + 1];
    // The film law applies from 20 degC on.
    assert_eq!((left(70.0).outside, left(-10.0).outside), (0, 1));
}

#[test]
fn without_an_oil_of_its_own_a_mesh_asks_the_model_itself() {
    let part = Arc::new(stage(1).with_oil(None));
    let of = path_integral(json!({ "type": "xu", "roughness": "composite_rms" }));
    let (table, _) = build(&part, &json!({ "type": "tabulated", "of": of })).unwrap();
    let (itself, _) = build(&part, &of).unwrap();
    let at = GearMeshAt::usual(&part, Notes::MUTED);
    assert_eq!(table.loss(&at).unwrap().sum(), itself.loss(&at).unwrap().sum());
}

#[test]
fn what_makes_no_table_is_refused() {
    let part = Arc::new(stage(1));
    let fault = |changes: Value| {
        let mut model = json!({ "type": "tabulated", "of": ehl() });
        for (key, change) in changes.as_object().unwrap() {
            model[key] = change.clone();
        }
        build(&part, &model).err().unwrap()
    };
    assert!(fault(json!({ "of": { "type": "efficiency", "value": 0.99 } })).contains("as fast"));
    assert!(fault(json!({ "of": "none" })).contains("as fast"));
    assert!(fault(json!({ "speeds": [100.0, 100.0] })).contains("`speeds` does not increase"));
    assert!(fault(json!({ "temperatures": [100.0, 0.0] })).contains("`temperatures` does not increase"));
}

#[test]
fn a_model_without_a_value_at_a_node_is_reported() {
    let part = Arc::new(stage(1));
    let formula = json!({ "type": "formula", "formula": "sqrt(temperature)" });
    let (table, _) = build(&part, &json!({ "type": "tabulated", "of": path_integral(formula) })).unwrap();
    let lubricant = &part.oil.as_ref().unwrap().lubricant;
    let fault = table.loss(&point(50.0, 3000.0, 60.0).context(&part, lubricant, Notes::MUTED));
    assert!(fault.unwrap_err().what.contains("narrow"));
}

#[test]
fn what_a_table_cannot_follow_is_stated() {
    // Rolling friction depends on the oil, a table over bodies does not.
    let rolling = json!({ "type": "path_integral", "load_sharing": "ramp", "rolling_friction": "goksem_hargreaves",
        "tooth_friction": { "type": "ehl_mixed" } });
    let rms = |of: &Value, bodies| {
        let rig = Rig::new(1, of, &json!({}));
        let interpolated = rig.interpolated(&Point {
            bodies,
            ..point(100.0, 4000.0, 60.0)
        });
        interpolated.extents[rig.table.notes.observed() + 1].greatest
    };
    assert!(rms(&rolling, None) < 1.5 && rms(&rolling, Some([80.0, 70.0])) > 10.0);
    // Friction that is cut off at zero has a kink that no spline reproduces.
    assert!(rms(&path_integral(json!({ "type": "benedict_kelley" })), None) > 10.0);
}
