//! Chains and belts, differentials in corners, joints: kinematics, torques, losses, bearing loads, batches, derivatives.

use crate::common::{RPM, language};
use gearloss_framework::evaluate::{GivenQuantity, Point};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::real::LANES;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;
use proptest::prelude::*;
use serde_json::json;

const OIL: &str = "lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }\n";

fn built(text: &str) -> Transmission {
    built_with(text, &[])
}

fn built_with(text: &str, overrides: &[(&str, serde_json::Value)]) -> Transmission {
    let language = language();
    let choice = Choice {
        overrides: overrides
            .iter()
            .map(|(path, value)| ((*path).to_owned(), value.clone()))
            .collect(),
        ..Choice::default()
    };
    let gearbox = Gearbox::of_text(&language, text, "input.yaml", ".").unwrap();
    gearbox.transmission(&language, &choice).unwrap()
}

/// Codes of the findings of a description that cannot be built.
fn refused(text: &str) -> Vec<String> {
    let language = language();
    let gearbox = Gearbox::of_text(&language, text, "input.yaml", ".").unwrap();
    let found = gearbox.transmission(&language, &Choice::default()).err().unwrap();
    found
        .list
        .iter()
        .map(|finding| finding.code_or_other().id().to_owned())
        .collect()
}

struct Solved {
    speeds: Vec<f64>,
    torques: Vec<f64>,
    loss: f64,
    /// Radial loads of the supports. \[N\]
    radial: Vec<f64>,
    parts: Vec<(String, f64)>,
}

/// Speeds in rpm and torques at the ports for given ones, in state `gear`.
fn solve(t: &Transmission, gear: &str, speeds: &[(&str, f64)], torques: &[(&str, f64)]) -> Solved {
    let names = |list: &[(&str, f64)]| list.iter().map(|(name, _)| (*name).to_owned()).collect::<Vec<_>>();
    let (speed_at, torque_at) = (names(speeds), names(torques));
    let [speed_at, torque_at] = [&speed_at, &torque_at].map(|list| list.iter().map(String::as_str).collect::<Vec<_>>());
    let case = t.case(gear, &speed_at, &torque_at).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &speeds.iter().map(|(_, n)| n * RPM).collect::<Vec<_>>(),
        torques: &torques.iter().map(|(_, torque)| *torque).collect::<Vec<_>>(),
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    let largest = solution.largest_power().max(1e-300);
    assert!(
        solution.residual().unwrap().abs() <= 1e-12 * largest,
        "{:?}",
        solution.residual()
    );
    let balance = solution.member_torques();
    let most = balance
        .iter()
        .map(|m| m.ports.abs().max(m.meshes.abs()))
        .fold(1e-300, f64::max);
    assert!(balance.iter().all(|member| member.residual().abs() <= 1e-11 * most));
    // Side by side the numbers are the same.
    if !torques.is_empty() {
        let mut rows = t.batch_scratch(&case);
        let mut row = t.batch(&case, &point, &[80.0], &mut rows);
        let block = row.solve(&[torques[0].1; LANES]);
        if !block.is_alone(0) {
            let together: Vec<f64> = block.watts().iter().map(|watts| watts[0]).collect();
            assert_eq!(together, solution.watts());
        }
    }
    Solved {
        speeds: t.ports().iter().map(|p| solution.speed(p.member) / RPM).collect(),
        torques: (0..t.ports().len()).map(|p| solution.torque(p)).collect(),
        loss: solution.loss().unwrap(),
        radial: (0..t.supports().len()).map(|s| solution.load(s).radial).collect(),
        parts: solution
            .parts()
            .map(|(part, loss)| (part.path.clone(), loss.watts()))
            .collect(),
    }
}

fn close(got: f64, expected: f64, relative: f64) {
    assert!(
        (got - expected).abs() <= relative * expected.abs(),
        "{got} is not {expected}"
    );
}

/// Two parallel shafts with a chain between them, each on two bearings at the same distance from the chain.
fn chain(z: [u32; 2], further: &str) -> String {
    format!(
        "
gearloss: gearbox/1
ports: {{ input: a, output: b }}
shafts:
  a: {{ axis: [0 mm, 0 mm] }}
  b: {{ axis: [240 mm, 180 mm] }}
chains:
  drive:
    wheels: [{{ shaft: a, at: 50 mm, z: {} }}, {{ shaft: b, at: 50 mm, z: {} }}]
    pitch: 12.7 mm
    pin_diameter: 4.45 mm
{further}
bearings:
  A1: {{ shaft: a, at: 0 mm, designation: \"6208\", axial: both, model: none }}
  A2: {{ shaft: a, at: 100 mm, designation: \"6208\", model: none }}
  B1: {{ shaft: b, at: 0 mm, designation: \"6208\", axial: both, model: none }}
  B2: {{ shaft: b, at: 100 mm, designation: \"6208\", model: none }}
{OIL}",
        z[0], z[1]
    )
}

const SPICER: &str = "    model: { type: spicer, friction: 0.09 }";

#[test]
fn an_open_chain_turns_both_wheels_the_same_way_and_loses_what_the_law_says() {
    let t = built(&chain([20, 50], SPICER));
    let s = solve(&t, "only", &[("input", 1000.0)], &[("input", 60.0)]);
    close(s.speeds[1], 400.0, 1e-12);
    // P = z1 w1 mu rho (pi/2) F (1/z1 + 1/z2) with the tension 2 pi T/(z1 p).
    let w = 1000.0 * RPM;
    let pull = std::f64::consts::TAU * 60.0 / (20.0 * 12.7e-3);
    let loss = 20.0 * w * 0.09 * 2.225e-3 * 0.5 * std::f64::consts::PI * pull * (1.0 / 20.0 + 1.0 / 50.0);
    close(s.loss, loss, 1e-12);
    close(s.torques[1] * s.speeds[1], -(60.0 * w - loss) / RPM, 1e-12);
}

#[test]
fn the_chain_loses_the_same_whichever_wheel_drives_and_turns() {
    let t = built(&chain([20, 50], SPICER));
    let base = solve(&t, "only", &[("input", 1000.0)], &[("input", 60.0)]).loss;
    close(
        solve(&t, "only", &[("input", -1000.0)], &[("input", -60.0)]).loss,
        base,
        1e-12,
    );
    // The second wheel drives with the same tension of the chain.
    let back = solve(&t, "only", &[("output", 400.0)], &[("output", 150.0)]);
    close(back.loss, base, 1e-12);
    assert!(back.torques[0] < 0.0 && back.torques[0].abs() < 60.0);
}

#[test]
fn the_strands_load_the_bearings() {
    // Equal wheels: both strands pull along the line of centres, whichever is taut.
    let t = built(&chain([30, 30], "    slack_tension: 200 N\n    model: none"));
    let pull = std::f64::consts::TAU * 60.0 / (30.0 * 12.7e-3);
    for torque in [60.0, -60.0] {
        let s = solve(&t, "only", &[("input", 1000.0)], &[("input", torque)]);
        for radial in s.radial {
            close(radial, 0.5 * (pull + 2.0 * 200.0), 1e-12);
        }
    }
    // Different wheels: the vector sum of both strands, which leave the wheels at the points of contact of their common tangents.
    let t = built(&chain([20, 50], "    slack_tension: 200 N\n    model: none"));
    let radius = |z: f64| z * 12.7e-3 / std::f64::consts::TAU;
    let (r1, r2, a) = (radius(20.0), radius(50.0), 0.3);
    let cos = (r1 - r2) / a;
    let sin = (1.0_f64 - cos * cos).sqrt();
    let pull = 60.0 / r1;
    // In the frame of the line of centres and the perpendicular: tensions of 200 N + pull and of 200 N.
    let (taut, slack) = ([sin, cos], [sin, -cos]);
    let sum = [0, 1].map(|i| (200.0 + pull) * taut[i] + 200.0 * slack[i]);
    let expected = 0.5 * sum[0].hypot(sum[1]);
    for torque in [60.0, -60.0] {
        let s = solve(&t, "only", &[("input", 1000.0)], &[("input", torque)]);
        for radial in s.radial {
            close(radial, expected, 1e-12);
        }
    }
}

#[test]
fn the_centrifugal_force_loads_the_joints_and_no_bearing() {
    let text = chain([30, 30], &format!("    links: 78\n    mass: 0.6 kg\n{SPICER}"));
    let t = built(&text);
    let s = solve(&t, "only", &[("input", 3000.0)], &[("input", 0.0)]);
    assert!(s.radial.iter().all(|radial| *radial < 1e-9), "{:?}", s.radial);
    let v = 3000.0 * RPM * 30.0 * 12.7e-3 / std::f64::consts::TAU;
    let tension = 0.6 / (78.0 * 12.7e-3) * v * v;
    let loss = 2.0 * 3000.0 * RPM * 0.09 * 2.225e-3 * 0.5 * std::f64::consts::PI * tension * 2.0;
    close(s.loss, loss, 1e-9);
}

#[test]
fn faulty_chains_are_refused() {
    // 304.5 mm and 30 teeth need 77.95 links.
    let chain = |further: &str| chain([30, 30], further).replace("180 mm", "187.4 mm");
    assert_eq!(refused(&chain("    links: 77")), ["E0332"]);
    assert!(built(&chain("    links: 78")).warnings.is_empty());
    let loose = built(&chain("    links: 84")).warnings;
    assert!(loose.iter().any(|finding| finding.code_or_other().id() == "W0332"));
    assert_eq!(refused(&chain("    centre_distance: 301 mm")), ["E0332"]);
    assert_eq!(refused(&chain("    ratio: 2")), ["E0332"]);
    assert_eq!(refused(&chain("    mass: 1 kg")), ["E0332"]);
    assert_eq!(
        refused(&chain("").replace("at: 50 mm, z: 30 }]", "at: 60 mm, z: 30 }]")),
        ["E0332"]
    );
    assert_eq!(
        refused(&chain("").replace("240 mm, 187.4 mm", "60 mm, 60 mm")),
        ["E0332"]
    );
    assert_eq!(
        refused(&chain("").replace("{ shaft: b, at: 50 mm", "{ shaft: a, at: 50 mm")),
        ["E0332"]
    );
    assert_eq!(refused(&chain("").replace("    pitch: 12.7 mm\n", "")), ["E0332"]);
}

const VARIATOR: &str = "
gearloss: gearbox/1
ports: { input: a, output: b }
shafts:
  a: { axis: [0 mm, 0 mm], bearings: none }
  b: { axis: [170 mm, 0 mm], bearings: none }
chains:
  belt:
    kind: variable_belt
    wheels: [{ shaft: a }, { shaft: b }]
    ratio: 1
    ratios: { low: 2.4, high: 0.45 }
    model: { type: formula, formula: \"50 + 0.02 * torque * abs(speed) * 0.10472 * (1 + 0.1 * abs(ratio - 1))\" }
gear_states: { low: [], mid: [], high: [] }
lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }
";

#[test]
fn a_variable_belt_has_a_ratio_in_each_gear_and_a_map_over_it() {
    let t = built(VARIATOR);
    for (gear, ratio) in [("low", 2.4), ("mid", 1.0), ("high", 0.45)] {
        let s = solve(&t, gear, &[("input", 2000.0)], &[("input", 100.0)]);
        close(s.speeds[1], 2000.0 / ratio, 1e-12);
        let loss = 50.0 + 0.02 * 100.0 * 2000.0 * 0.10472 * (1.0 + 0.1 * (ratio - 1.0_f64).abs());
        close(s.loss, loss, 1e-12);
    }
    // Single points bind the ratio.
    let t = built_with(VARIATOR, &[("chains.belt.ratio", json!(1.7))]);
    close(
        solve(&t, "mid", &[("input", 1700.0)], &[("input", 100.0)]).speeds[1],
        1000.0,
        1e-12,
    );
    assert_eq!(refused(&VARIATOR.replace("    ratio: 1\n", "")), ["E0332"]);
    assert_eq!(refused(&VARIATOR.replace("high: 0.45", "hihg: 0.45")), ["E0203"]);
    assert_eq!(
        refused(&VARIATOR.replace("    ratio: 1\n", "    ratio: 1\n    links: 80\n")),
        ["E0332"]
    );
}

/// A differential whose case is the input.
fn axle(further: &str, top: &str) -> String {
    format!(
        "
gearloss: gearbox/1
{top}
ports: {{ input: cage, left: left_half, right: right_half }}
shafts:
  cage: {{ axis: [0 mm, 0 mm], bearings: none }}
  left_half: {{ axis: [0 mm, 0 mm], bearings: none }}
  right_half: {{ axis: [0 mm, 0 mm], bearings: none }}
differentials:
  axle:
    case: cage
    left: left_half
    right: right_half
    gears: {{ side: {{ z: 16, radius: 30 mm, washer_radius: 28 mm }}, pinion: {{ z: 10, seat_radius: 16 mm, pin_radius: 8 mm }} }}
{further}
{OIL}"
    )
}

const BEVEL: &str = "    model: { type: bevel_gears, friction: 0.08, mesh_efficiency: 1 }";
/// Speed of a case whose sides are 10 rad/s apart if they differ by a tenth.
const HUNDRED: f64 = 100.0 / RPM;

#[test]
fn in_a_corner_the_slow_side_gets_more_torque() {
    for (difference, slow, fast) in [(0.1, 2, 1), (-0.1, 1, 2)] {
        let t = built(&axle(&format!("    speed_difference: {difference}\n{BEVEL}"), ""));
        for sense in [1.0, -1.0] {
            let s = solve(&t, "only", &[("input", sense * HUNDRED)], &[("input", sense * 1000.0)]);
            close(s.speeds[fast] - s.speeds[slow], sense * 10.0 / RPM, 1e-9);
            close(s.torques[slow], sense * -535.13560538, 1e-10);
            close(s.torques[fast], sense * -464.86439462, 1e-10);
            close(s.loss, 351.35605377, 1e-10);
        }
        // While the wheels drive the case, the faster side carries more.
        let s = solve(&t, "only", &[("input", HUNDRED)], &[("input", -1000.0)]);
        close(s.torques[fast], 535.13560538, 1e-10);
        close(s.loss, 351.35605377, 1e-10);
    }
}

#[test]
fn straight_ahead_nothing_is_lost() {
    let t = built(&axle(
        &format!("    locking: {{ type: constant, value: 40 Nm }}\n{BEVEL}"),
        "",
    ));
    let s = solve(&t, "only", &[("input", HUNDRED)], &[("input", 1000.0)]);
    assert_eq!((s.loss, s.torques[1], s.torques[2]), (0.0, -500.0, -500.0));
}

#[test]
fn a_lock_adds_its_moment_without_torque() {
    let locking = "    locking: { type: constant, value: 40 Nm }\n    speed_difference: 0.1\n";
    let t = built(&axle(locking, ""));
    let s = solve(&t, "only", &[("input", HUNDRED)], &[("input", 1000.0)]);
    close(s.torques[2] - s.torques[1], -80.0, 1e-12);
    close(s.loss, 400.0, 1e-12);
    assert_eq!(s.parts, [("differentials.axle.locking".to_owned(), s.loss)]);
    let t = built(&axle(&format!("{locking}{BEVEL}"), ""));
    let s = solve(&t, "only", &[("input", HUNDRED)], &[("input", 1000.0)]);
    close(s.torques[2], -575.13560538, 1e-10);
    close(s.loss, 751.35605377, 1e-10);
    // Without torque only the lock acts: one wheel drives the other.
    let s = solve(&t, "only", &[("input", HUNDRED)], &[("input", 0.0)]);
    close(s.torques[1], 40.0, 1e-12);
    close(s.torques[2], -40.0, 1e-12);
}

#[test]
fn points_may_prescribe_both_sides() {
    // Case 1000 rpm, left 1040 rpm, 300 Nm, a loss of 5 % from side to side: the published case of a differential with friction.
    let t = built(&axle("    model: { type: bias, ratio: 1.0526315789473684 }", ""));
    let s = solve(&t, "only", &[("input", 1000.0), ("left", 1040.0)], &[("input", 300.0)]);
    close(s.speeds[2], 960.0, 1e-12);
    close(s.torques[1], -146.153846, 1e-8);
    close(s.torques[2], -153.846154, 1e-8);
    close(s.loss, 32.2214631, 1e-8);
}

/// With a stated loss of each mesh the bias is the closed form; with a law of friction it depends on the torque.
#[test]
fn the_gears_of_a_differential_are_bevel_meshes() {
    let in_corner = |model: &str| {
        axle(
            &format!(
                "    speed_difference: 0.1
    model: {model}"
            ),
            "",
        )
    };
    let loss = |text: &str, torque: f64| solve(&built(text), "only", &[("input", HUNDRED)], &[("input", torque)]).loss;
    let with_teeth = |mesh: &str| {
        in_corner(&format!("{{ type: bevel_meshes, friction: 0.08, mesh: {mesh} }}")).replace(
            "pin_radius: 8 mm }",
            "pin_radius: 8 mm }, teeth: { pinions: 2, facewidth: 14 mm, ra: 0.8 um }",
        )
    };
    let closed = in_corner("{ type: bevel_gears, friction: 0.08, mesh_efficiency: 0.9604 }");
    close(
        loss(&with_teeth("{ type: efficiency, value: 0.98 }"), 1000.0),
        loss(&closed, 1000.0),
        1e-12,
    );
    let law = with_teeth("{ type: path_integral, tooth_friction: { type: xu } }");
    let [light, heavy] = [100.0, 1000.0].map(|torque| loss(&law, torque) / torque);
    let without = loss(&with_teeth("{ type: efficiency, value: 1 }"), 1000.0) / 1000.0;
    assert!(
        light > without && heavy > without && (light / heavy - 1.0).abs() > 1e-3,
        "{light} {heavy} {without}"
    );
    let without_teeth = in_corner("{ type: bevel_meshes, friction: 0.08, mesh: { type: efficiency, value: 1 } }");
    assert_eq!(refused(&without_teeth).len(), 1);
}

#[test]
fn the_wheels_of_an_axle_in_a_corner_are_one_port_with_their_power() {
    let top = "wheels: [left, right]\nwheel_speeds: [1.05, 0.95]";
    let t = built(&axle(BEVEL, top));
    let s = solve(&t, "only", &[("input", HUNDRED)], &[("input", 1000.0)]);
    close(s.speeds[1], HUNDRED, 1e-12);
    close(s.loss, 351.35605377, 1e-10);
    close(s.torques[1], -(1.05 * 464.86439462 + 0.95 * 535.13560538), 1e-10);
    assert_eq!(refused(&axle(BEVEL, "wheel_speeds: [1.05, 0.95]")), ["E0333"]);
    assert_eq!(
        refused(&axle(BEVEL, "wheels: [left, right]\nwheel_speeds: [1.05, 0.95, 1]")),
        ["E0333"]
    );
    let twice = axle(&format!("    speed_difference: 0.1\n{BEVEL}"), "wheels: [left, right]");
    assert_eq!(refused(&twice), ["E0333"]);
    assert_eq!(
        refused(&axle("    equal_speeds: false\n    speed_difference: 0.1", "")),
        ["E0333"]
    );
}

#[test]
fn an_engaged_lock_holds_both_sides_at_one_speed() {
    let lock = "gear_states: { open: [], locked: [lock] }\ncouplings: { lock: { kind: dog, between: [left_half, right_half], model: none } }";
    let t = built(&axle(&format!("    speed_difference: 0.1\n{BEVEL}"), lock));
    close(
        solve(&t, "open", &[("input", HUNDRED)], &[("input", 1000.0)]).loss,
        351.35605377,
        1e-10,
    );
    let s = solve(
        &t,
        "locked",
        &[("input", HUNDRED)],
        &[("input", 1000.0), ("left", -900.0)],
    );
    assert_eq!(s.loss, 0.0);
    close(s.torques[2], -100.0, 1e-12);
}

#[test]
fn without_a_model_a_differential_is_no_part() {
    let t = built(&axle("", ""));
    assert!(t.parts().is_empty());
    let s = solve(
        &t,
        "only",
        &[("input", HUNDRED), ("left", 1.1 * HUNDRED)],
        &[("input", 1000.0)],
    );
    assert_eq!((s.loss, s.torques[1]), (0.0, s.torques[2]));
}

const JOINTS: &str = "
gearloss: gearbox/1
ports: { input: a, output: c }
shafts:
  a: { axis: [0 mm, 0 mm], bearings: none }
  b: { axis: [0 mm, 0 mm], bearings: none }
  c: { axis: [0 mm, 0 mm], bearings: none }
joints:
  first: { between: [a, b], kind: cardan, angle: 10 deg, model: { type: cross, friction: 0.1, trunnion_radius: 8 mm, arm: 30 mm } }
  second: { between: [b, c], kind: constant_velocity, angle: 10 deg, model: { type: formula, formula: \"torque * abs(speed) * 0.10471975511965977 * 0.001 * angle\" } }
lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }
";

#[test]
fn joints_lose_a_share_that_depends_on_their_angle() {
    let t = built(JOINTS);
    let s = solve(&t, "only", &[("input", 1000.0)], &[("input", 100.0)]);
    close(s.speeds[1], 1000.0, 1e-15);
    close(s.torques[1], -100.0 * (1.0 - 0.005971541175) * 0.99, 1e-9);
    assert_eq!(
        refused(&JOINTS.replace("between: [a, b]", "between: [a, a]"))[0],
        "E0334"
    );
}

#[test]
fn derivatives_are_those_of_differences() {
    let texts = [
        (chain([20, 50], SPICER), 1000.0),
        (
            axle(
                &format!("    speed_difference: 0.1\n    locking: {{ type: constant, value: 40 Nm }}\n{BEVEL}"),
                "",
            ),
            800.0,
        ),
        (JOINTS.to_owned(), 1000.0),
    ];
    for (text, speed) in texts {
        let t = built(&text);
        let case = t.case("only", &[], &["input"]).unwrap();
        let at = |speed: f64, torque: f64| {
            let mut scratch = t.scratch(&case);
            let (speeds, torques) = ([speed * RPM], [torque]);
            let point = Point {
                speeds: &speeds,
                torques: &torques,
                ..Point::default()
            };
            t.evaluate(&case, &point, &[80.0], &mut scratch).loss().unwrap()
        };
        let mut scratch = t.scratch(&case);
        let (speeds, torques) = ([speed * RPM], [200.0]);
        let point = Point {
            speeds: &speeds,
            torques: &torques,
            ..Point::default()
        };
        let over_torque = t
            .slopes(&case, &point, 80.0, false, GivenQuantity::Torque(0), &mut scratch)
            .unwrap();
        close(
            over_torque.loss.value,
            (at(speed, 201.0) - at(speed, 199.0)) / 2.0,
            1e-6,
        );
        let over_speed = t
            .slopes(&case, &point, 80.0, false, GivenQuantity::Speed(0), &mut scratch)
            .unwrap();
        let step = (at(speed + 1.0, 200.0) - at(speed - 1.0, 200.0)) / (2.0 * RPM);
        close(over_speed.loss.value, step, 1e-6);
    }
}

#[test]
fn other_numbers_in_place_are_those_of_a_new_build() {
    let language = language();
    let text = axle(&format!("    speed_difference: 0.1\n{BEVEL}"), "");
    let gearbox = Gearbox::of_text(&language, &text, "input.yaml", ".").unwrap();
    let variants = Variants::new(&language, &gearbox, Choice::default());
    for (difference, friction) in [(0.05, 0.08), (0.02, 0.1), (-0.1, 0.05)] {
        let changes = [
            ("differentials.axle.speed_difference", json!(difference)),
            ("differentials.axle.model.friction", json!(friction)),
        ];
        let overrides: Vec<_> = changes
            .iter()
            .map(|(path, value)| ((*path).to_owned(), value.clone()))
            .collect();
        let again = variants.build(&overrides).unwrap();
        let new = built_with(&text, &changes);
        let [again, new] = [&again, &new].map(|t| solve(t, "only", &[("input", 500.0)], &[("input", 700.0)]).loss);
        assert_eq!(again.to_bits(), new.to_bits());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Powers and torques balance for any chain, difference and torque; `solve` checks it.
    #[test]
    fn chains_and_differentials_balance(
        z1 in 15_u32..60, z2 in 15_u32..60, torque in -500.0..500.0_f64, speed in -3000.0..3000.0_f64,
        slack in 0.0..500.0_f64, difference in -1.5..1.5_f64, lock in 0.0..100.0_f64,
    ) {
        let t = built(&chain([z1, z2], &format!("    slack_tension: {slack} N\n{SPICER}")));
        let s = solve(&t, "only", &[("input", speed)], &[("input", torque)]);
        prop_assert!(s.loss >= 0.0);
        let t = built(&axle(
            &format!("    speed_difference: {difference}\n    locking: {{ type: constant, value: {lock} Nm }}\n{BEVEL}"), ""));
        let s = solve(&t, "only", &[("input", speed)], &[("input", torque)]);
        prop_assert!(s.loss >= 0.0);
    }
}
