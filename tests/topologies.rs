//! Other gearboxes than the example, from their documents: a differential, a planetary set, parallel paths.

use crate::common::{self, RPM, built, language};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Status;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;

/// Speeds and torques of all ports, status, efficiency.
fn solve(
    t: &Transmission,
    gear: &str,
    speeds: &[(&str, f64)],
    torques: &[(&str, f64)],
) -> (Vec<f64>, Vec<f64>, Status, Option<f64>) {
    let names = |list: &[(&str, f64)]| list.iter().map(|s| s.0.to_owned()).collect::<Vec<_>>();
    let (speed_names, torque_names) = (names(speeds), names(torques));
    let case = t
        .case(
            gear,
            &speed_names.iter().map(String::as_str).collect::<Vec<_>>(),
            &torque_names.iter().map(String::as_str).collect::<Vec<_>>(),
        )
        .unwrap();
    let mut scratch = t.scratch(&case);
    let speeds: Vec<f64> = speeds.iter().map(|s| s.1 * RPM).collect();
    let torques: Vec<f64> = torques.iter().map(|s| s.1).collect();
    let point = Point {
        speeds: &speeds,
        torques: &torques,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    assert!(solution.residual().unwrap().abs() <= 1e-12 * solution.largest_power().max(1e-300));
    (
        t.ports().iter().map(|p| solution.speed(p.member) / RPM).collect(),
        (0..t.ports().len()).map(|p| solution.torque(p)).collect(),
        solution.status(),
        solution.efficiency(),
    )
}

const DIFFERENTIAL: &str = "
gearloss: gearbox/1
ports: { input: drive, left: left_half, right: right_half }
shafts:
  drive: { axis: [0 mm, 0 mm], bearings: none }
  cage: { axis: [100 mm, 0 mm], bearings: none }
  left_half: { axis: [100 mm, 0 mm] }
  right_half: { axis: [100 mm, 0 mm] }
gears:
  pinion: { shaft: drive, at: 30 mm, z: 20, facewidth: 20 mm }
  crown: { shaft: cage, at: 30 mm, z: 80, facewidth: 20 mm }
meshes:
  final_drive: { gears: [pinion, crown], normal_module: 2 mm, model: { type: iso14179_2 } }
differentials:
  axle: { case: cage, left: left_half, right: right_half }
lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }
";

#[test]
fn a_differential_turns_both_sides_equally_unless_stated_otherwise() {
    let language = language();
    let t = built(&language, DIFFERENTIAL);
    let (speeds, torques, status, efficiency) = solve(&t, "only", &[("input", 4000.0)], &[("input", 50.0)]);
    assert!((speeds[1] + 1000.0).abs() < 1e-9 && (speeds[2] + 1000.0).abs() < 1e-9);
    assert!((torques[1] - torques[2]).abs() < 1e-9 && status == Status::Drive);
    assert!(efficiency.unwrap() > 0.97);
    // Prescribing one side lets the other follow: the sum of both is twice the cage.
    let (speeds, torques, ..) = solve(&t, "only", &[("input", 4000.0), ("left", -1040.0)], &[("input", 50.0)]);
    assert!((speeds[2] + 960.0).abs() < 1e-9 && (torques[1] - torques[2]).abs() < 1e-9);
}

/// Both wheels as one port, in place of those of a gearbox.
fn straight(language: &Language, text: &str) -> Transmission {
    let choice = Choice {
        overrides: vec![("wheels".to_owned(), serde_json::json!(["left", "right"]))],
        ..Choice::default()
    };
    let gearbox = Gearbox::of_text(language, text, "input.yaml", ".").unwrap();
    gearbox.transmission(language, &choice).unwrap()
}

/// Torque at the wheels for 50 Nm at the input, which the same torque at the wheels gives back.
fn driven_straight(t: &Transmission) -> f64 {
    assert_eq!(
        t.ports().iter().map(|p| p.name.as_str()).collect::<Vec<_>>(),
        ["input", "wheels"]
    );
    let (speeds, torques, status, efficiency) = solve(t, "only", &[("input", 4000.0)], &[("input", 50.0)]);
    assert_eq!(status, Status::Drive);
    // `solve` has found that powers and losses balance.
    assert!((-torques[1] * speeds[1] / (50.0 * 4000.0) / efficiency.unwrap() - 1.0).abs() < 1e-12);
    // The same state from the wheels.
    let (back, input, ..) = solve(t, "only", &[("wheels", speeds[1])], &[("wheels", torques[1])]);
    assert!(
        (back[0] - 4000.0).abs() < 1e-9 && (input[0] - 50.0).abs() < 1e-7,
        "{back:?} {input:?}"
    );
    torques[1]
}

#[test]
fn wheels_of_a_differential_are_one_port_with_the_sum_of_their_torques() {
    let language = language();
    let apart = built(&language, DIFFERENTIAL);
    let (_, torques, ..) = solve(&apart, "only", &[("input", 4000.0)], &[("input", 50.0)]);
    let sum = driven_straight(&straight(&language, DIFFERENTIAL));
    assert!(
        (sum / (torques[1] + torques[2]) - 1.0).abs() < 1e-12,
        "{sum} {torques:?}"
    );
}

#[test]
fn wheels_on_one_rigid_axle_share_the_torque_equally() {
    let language = language();
    // Both halves turn with the cage: nothing in the gearbox says how they share.
    let locked = DIFFERENTIAL
        .replace("differentials:\n  axle: { case: cage, left: left_half, right: right_half }\n", "")
        .replace(
            "lubricants:",
            "couplings:\n  l: { kind: dog, between: [cage, left_half], model: none }\n  r: { kind: dog, between: [cage, right_half], model: none }\n\
             gear_states: { only: [l, r] }\nlubricants:",
        );
    let t = straight(&language, &locked);
    let sum = driven_straight(&t);
    let case = t.case("only", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[4000.0 * RPM],
        torques: &[50.0],
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    let halves = solution.member_torques();
    let of = |name: &str| halves[t.members().iter().position(|m| m == name).unwrap()].ports;
    assert!(
        (of("left_half") / (0.5 * sum) - 1.0).abs() < 1e-12 && (of("right_half") / (0.5 * sum) - 1.0).abs() < 1e-12
    );
}

#[test]
fn wheels_of_a_spur_differential_turn_straight_and_share_by_its_teeth() {
    let language = language();
    let text = std::fs::read_to_string(common::file("tests/wheels/spur_differential.yaml")).unwrap();
    let t = straight(&language, &text);
    let sum = driven_straight(&t);
    // Ratio 4, one efficiency of 0.99 that carries torque, the seal of one wheel.
    assert!(sum.abs() < 0.99 * 200.0 && sum.abs() > 0.985 * 200.0, "{sum}");
    let apart = built(&language, &text);
    let (speeds, torques, ..) = solve(
        &apart,
        "only",
        &[("left", -1000.0), ("right", -1000.0)],
        &[("input", 50.0)],
    );
    assert!((speeds[0] - 4000.0).abs() < 1e-9 && ((torques[1] + torques[2]) / sum - 1.0).abs() < 1e-12);
}

const PLANETARY: &str = "
gearloss: gearbox/1
ports: { input: sun_shaft, output: carrier }
shafts:
  sun_shaft: { axis: [0 mm, 0 mm] }
  carrier: { axis: [0 mm, 0 mm] }
  ring_shaft: { axis: [0 mm, 0 mm] }
  planet: { mass: 0.2 kg }
gears:
  sun: { shaft: sun_shaft, z: 24, facewidth: 20 mm }
  planet_gear: { shaft: planet, z: 24, facewidth: 20 mm }
  ring: { shaft: ring_shaft, z: 72, facewidth: 20 mm, kind: ring, tip_diameter: 140.8 mm }
meshes:
  sun_planet: { gears: [sun, planet_gear], normal_module: 2 mm, centre_distance: 48 mm }
  planet_ring: { gears: [planet_gear, ring], normal_module: 2 mm, centre_distance: 48 mm }
planetary_sets:
  set: { carrier: carrier, count: 3, planets: [planet] }
bearings:
  pin: { shaft: planet, outer: carrier, at: 0 mm, kind: needle_cage, bore: 20 mm, outside: 25 mm, width: 18 mm }
couplings:
  brake: { kind: dog, between: [ring_shaft, housing] }
  lock: { kind: dog, between: [sun_shaft, carrier] }
gear_states: { low: [brake], direct: { engaged: [lock] } }
lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }
models:
  gear_mesh: { type: iso14179_2 }
  bearing: { type: iso14179_2 }
";

#[test]
fn a_planetary_set_is_kinematics_rolling_power_and_planet_bearings() {
    let language = language();
    let t = built(&language, PLANETARY);
    let (speeds, torques, status, efficiency) = solve(&t, "low", &[("input", 3000.0)], &[("input", 60.0)]);
    assert!((speeds[1] - 750.0).abs() < 1e-9 && status == Status::Drive);
    let efficiency = efficiency.unwrap();
    assert!((-torques[1] / (4.0 * 60.0) - efficiency).abs() < 1e-12);
    assert!(efficiency > 0.95 && efficiency < 0.999, "{efficiency}");
    // Locked up, nothing rolls and nothing is lost but what turns against the housing.
    let (_, _, _, direct) = solve(&t, "direct", &[("input", 3000.0)], &[("input", 60.0)]);
    assert!((direct.unwrap() - 1.0).abs() < 1e-12);
}

#[test]
fn the_planet_bearing_carries_both_meshes_and_the_centrifugal_force() {
    let language = language();
    let t = built(&language, PLANETARY);
    let case = t.case("low", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[3000.0 * RPM],
        torques: &[60.0],
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    // Spur gears at the reference distance: twice the tangential force across, the mass of the planet outwards.
    let tangential: f64 = 60.0 / 3.0 / 0.024;
    let centrifugal = 0.2 * 0.048 * (750.0 * RPM).powi(2);
    let expected = (2.0 * tangential).hypot(centrifugal);
    assert!(
        (solution.load(0).radial / expected - 1.0).abs() < 1e-9,
        "{} {expected}",
        solution.load(0).radial
    );
}

#[test]
fn a_port_given_twice_is_refused() {
    let language = language();
    let t = built(&language, PLANETARY);
    for (speeds, torques) in [
        (vec!["input", "input"], vec!["input"]),
        (vec!["input"], vec!["input", "input"]),
    ] {
        let faults = t.case("low", &speeds, &torques).err().unwrap();
        assert!(faults.iter().any(|f| f.message.contains("stated twice")), "{faults:?}");
    }
}

#[test]
fn parallel_paths_share_as_stated_in_every_state_that_closes_them() {
    let language = language();
    let text = std::fs::read_to_string(common::file("tests/cases/redundant_loop/input.yaml")).unwrap();
    let shares = "torque_shares: [{ member: shaft_in, meshes: [stage, stage_2], parts: [0.7, 0.3] }]\n";
    let t = built(&language, &(text + shares));
    let case = t.case("only", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[300.0],
        torques: &[10.0],
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    assert!((solution.mesh_torque(0).abs() - 7.0).abs() < 1e-9 && (solution.mesh_torque(1).abs() - 3.0).abs() < 1e-9);
}
