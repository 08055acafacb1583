//! Gears on axes that cross, from their documents: positions, speeds, tooth forces, bearing loads, and what is refused.

use std::fmt::Write as _;

use gearloss_framework::evaluate::{Point, PowerFlow, Solution};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

/// rad/s of 1/min.
const RPM: f64 = std::f64::consts::PI / 30.0;

fn language() -> Language {
    Language::linked().unwrap()
}

/// The bevel stage of ISO 23509 annex F.2: pinion along x, wheel along y.
const BEVEL: &str = "
gearloss: gearbox/1
ports: { input: pinion_shaft, output: wheel_shaft }
shafts:
  pinion_shaft: { axis: { through: [0 mm, 0 mm, 0 mm], direction: [1, 0, 0] } }
  wheel_shaft: { axis: { through: [0 mm, 0 mm, 0 mm], direction: [0, 1, 0] } }
gears:
  pinion: { shaft: pinion_shaft, z: 14, facewidth: 25.4 mm, hand: left }
  wheel: { shaft: wheel_shaft, z: 39, facewidth: 25.4 mm }
bevel_meshes:
  stage:
    gears: [pinion, wheel]
    outer_diameter: 176.893 mm
    spiral_angle: 35 deg
    depth: { wheel_addendum: 0.24737, addendum_angle: 2.1342 deg, dedendum_angle: 6.4934 deg }
bearings:
  P1: { shaft: pinion_shaft, at: 110 mm, axial: both, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }
  P2: { shaft: pinion_shaft, at: 190 mm, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }
  W1: { shaft: wheel_shaft, at: 80 mm, axial: both, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }
  W2: { shaft: wheel_shaft, at: -60 mm, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }
lubricants: { oil: { viscosity: { kv40: 100 mm2/s, kv100: 11 mm2/s } } }
";

fn built(text: &str) -> Transmission {
    let language = language();
    let gearbox = Gearbox::of_text(&language, text, "input.yaml", ".").unwrap();
    gearbox.transmission(&language, &Choice::default()).unwrap()
}

/// The findings of a wrong gearbox as text.
fn findings(text: &str) -> String {
    let language = language();
    let gearbox = match Gearbox::of_text(&language, text, "input.yaml", ".") {
        Ok(gearbox) => gearbox,
        Err(faults) => return format!("{faults:?}"),
    };
    match gearbox.transmission(&language, &Choice::default()) {
        Ok(built) => format!("{:?}", built.warnings),
        Err(faults) => format!("{faults:?}"),
    }
}

/// Solves torque and speed at the first port, and shows the solution.
fn solved<T>(t: &Transmission, torque: f64, speed: f64, show: impl FnOnce(&Solution<'_>) -> T) -> T {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * RPM],
        torques: &[torque],
        flow: PowerFlow::Real,
        // Losses that follow from torques agree with them to this.
        tolerance: Tolerance {
            power: 1e-13,
            ..Tolerance::default()
        },
        inclination: 0.0,
    };
    show(&t.evaluate(&case, &point, &[80.0], &mut scratch))
}

fn close(value: f64, expected: f64, scale: f64) {
    assert!((value - expected).abs() <= scale, "{value} {expected}");
}

#[test]
fn bearing_loads_of_a_bevel_stage() {
    let t = built(BEVEL);
    // Pinion and wheel turn in opposite senses about their directions.
    let ([speed, torque], forces, axial) = solved(&t, -300.0, -1000.0, |s| {
        let output = t.port("output").unwrap();
        (
            [s.speed(t.ports()[output].member) / RPM, s.torque(output)],
            s.radial_forces(),
            (0..4).map(|i| s.load(i).axial).collect::<Vec<_>>(),
        )
    });
    close(speed, 1000.0 * 14.0 / 39.0, 1e-9);
    close(torque, -835.714_285_714_3, 1e-9);
    // Across the wheel shaft the first direction is -x, the second z.
    let expected = [
        [-218.973_117_535_3, -15_501.212_729_264_5],
        [2_203.246_078_291_0, 4_575.890_076_341_1],
        [-6_606.753_855_501_9, 6_825.138_279_824_3],
        [-2_233.509_941_562_4, 4_100.184_373_099_1],
    ];
    for (force, expected) in forces.iter().zip(expected) {
        for (force, expected) in force.unwrap().into_iter().zip(expected) {
            close(force, expected, 1e-12 * 15_501.0);
        }
    }
    close(axial[0], 8_840.263_797_064_3, 1e-9);
    close(axial[2], 1_984.272_960_755_7, 1e-9);
}

#[test]
fn the_geometry_is_that_of_the_standard() {
    let t = built(BEVEL);
    let gears = t.gears();
    close(gears[0].at, 76.493_327_681_3e-3, 1e-12);
    close(gears[1].at, 27.459_143_270_2e-3, 1e-12);
    // Two micrometres above the printed one, whose angles are rounded.
    close(gears[0].diameters[1], 75.326e-3, 1e-6);
    close(gears[1].diameters[1], 178.288e-3, 1e-6);
    let (_, teeth) = t.crossed_meshes().next().unwrap();
    close(teeth.mounting_distance()[0], 76.493_327_681_3e-3, 1e-12);
}

/// A hypoid stage as F.3, with axes turned as a whole. \[rad\]
fn hypoid(turn: &Rotation3<f64>, hand: &str) -> String {
    // The offset of a left-hand pinion is that along the product of its axis with the wheel's.
    let offset = if hand == "left" { 0.015 } else { -0.015 };
    let mut text = String::from("gearloss: gearbox/1\nports: { input: pinion_shaft, output: wheel_shaft }\nshafts:\n");
    let axes = [
        ("pinion_shaft", Vector3::zeros(), Vector3::x()),
        ("wheel_shaft", Vector3::z() * offset, Vector3::y()),
    ];
    for (name, through, direction) in axes {
        let [x, y, z]: [f64; 3] = (turn * through * 1e3).into();
        let [u, v, w]: [f64; 3] = (turn * direction).into();
        writeln!(
            text,
            "  {name}: {{ axis: {{ through: [{x:?} mm, {y:?} mm, {z:?} mm], direction: [{u:?}, {v:?}, {w:?}] }} }}"
        )
        .unwrap();
    }
    write!(
        text,
        "gears:
  pinion: {{ shaft: pinion_shaft, z: 13, facewidth: 31.9 mm, hand: {hand} }}
  wheel: {{ shaft: wheel_shaft, z: 42, facewidth: 30 mm }}
bevel_meshes:
  final:
    gears: [pinion, wheel]
    outer_diameter: 170 mm
    spiral_angle: 49.99814 deg
    cutter: {{ radius: 63.5 mm }}
    depth: {{ wheel_addendum: 0.35, addendum_angle: 1 deg, dedendum_angle: 4 deg }}
    shaft_angle: 90 deg
    offset: 15 mm
bearings:
  P1: {{ shaft: pinion_shaft, at: 110 mm, axial: both, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }}
  P2: {{ shaft: pinion_shaft, at: 190 mm, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }}
  W1: {{ shaft: wheel_shaft, at: 80 mm, axial: both, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }}
  W2: {{ shaft: wheel_shaft, at: -60 mm, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }}
lubricants: {{ oil: {{ viscosity: {{ kv40: 100 mm2/s, kv100: 11 mm2/s }} }} }}
"
    )
    .unwrap();
    text
}

/// Radial and axial loads of all bearings.
fn loads(t: &Transmission, torque: f64, speed: f64) -> Vec<[f64; 2]> {
    solved(t, torque, speed, |s| {
        (0..t.supports().len())
            .map(|i| [s.load(i).radial, s.load(i).axial])
            .collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Loads do not depend on how the gearbox lies, and exchanged hands are the mirror image, which turns the other way.
    #[test]
    fn loads_are_those_of_the_turned_and_of_the_mirrored_gearbox(
        roll in -3.0..3.0_f64, pitch in -1.5..1.5_f64, yaw in -3.0..3.0_f64, drives in any::<bool>(),
    ) {
        let torque = if drives { 250.0 } else { -250.0 };
        let turn = Rotation3::from_euler_angles(roll, pitch, yaw);
        let still = loads(&built(&hypoid(&Rotation3::identity(), "left")), torque, 1200.0);
        let turned = loads(&built(&hypoid(&turn, "left")), torque, 1200.0);
        let mirrored = loads(&built(&hypoid(&turn, "right")), -torque, -1200.0);
        let scale = still.iter().flatten().fold(0.0_f64, |most, load| most.max(*load));
        prop_assert!(scale > 1000.0);
        for ((still, turned), mirrored) in still.iter().zip(&turned).zip(&mirrored) {
            for i in 0..2 {
                prop_assert!((still[i] - turned[i]).abs() < 1e-11 * scale, "{still:?} {turned:?}");
                prop_assert!((still[i] - mirrored[i]).abs() < 1e-11 * scale, "{still:?} {mirrored:?}");
            }
        }
    }
}

/// Checks torques, power and the equilibrium of both shafts at a point of a bevel stage with the bearings of these examples.
fn check_balance(t: &Transmission, torque: f64, speed: f64, share: f64) {
    solved(t, torque, speed, |s| {
        let tooth = s.tooth_force(0).unwrap();
        let (place, moment) = (Vector3::from(tooth.place), Vector3::from(tooth.moment));
        let (on_first, radial) = (Vector3::from(tooth.force), s.radial_forces());
        let power = [0, 1].map(|port| s.torque(port) * s.speed(t.ports()[port].member));
        let input = power[0].max(power[1]);
        close(power[0] + power[1], share * input, 1e-11 * input);
        for (gear, positions) in [[0.11, 0.19], [0.08, -0.06]].into_iter().enumerate() {
            let sense = if gear == 0 { 1.0 } else { -1.0 };
            let axis = t.axes()[t.ports()[gear].member];
            let (origin, [k, e2, e3]) = (Vector3::from(axis.origin), axis.frame.map(Vector3::from));
            let (force, moment) = (on_first * sense, moment * sense);
            let about_axis = k.dot(&((place - origin).cross(&force) + moment));
            let scale = s.torque(gear).abs();
            close(about_axis + s.torque(gear), 0.0, 1e-11 * scale);
            // The first bearing takes the thrust.
            let thrust = force.dot(&k);
            close(s.load(2 * gear).axial, thrust.abs(), 1e-11 * force.norm());
            let (mut sum, mut moments) = (force, (place - origin).cross(&force) + moment + k * s.torque(gear));
            for (bearing, at) in positions.into_iter().enumerate() {
                let [y, z] = radial[2 * gear + bearing].unwrap();
                let along = if bearing == 0 { -thrust } else { 0.0 };
                let reaction = e2 * y + e3 * z + k * along;
                sum += reaction;
                moments += (k * at).cross(&reaction);
            }
            assert!(sum.norm() < 1e-11 * force.norm(), "{sum}");
            assert!(moments.norm() < 1e-11 * scale, "{moments}");
        }
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// With friction in the forces the torques about both axes are those of the power flow, whichever gear drives on whichever flanks, and the
    /// bearings hold the shafts.
    #[test]
    fn forces_with_friction_balance(
        roll in -3.0..3.0_f64, pitch in -1.5..1.5_f64, yaw in -3.0..3.0_f64, left in any::<bool>(),
        drives in any::<bool>(), forwards in any::<bool>(), is_hypoid in any::<bool>(),
    ) {
        let turn = Rotation3::from_euler_angles(roll, pitch, yaw);
        let hand = if left { "left" } else { "right" };
        let text = if is_hypoid {
            hypoid(&turn, hand)
        } else {
            BEVEL.replace("left", hand).replace("35 deg\n", "35 deg\n    offset: 0 mm\n")
        };
        let lossy = text.replace("    offset:", "    model: { type: share, value: 0.03 }\n    offset:");
        let speed = if forwards { 1200.0 } else { -1200.0 };
        let torque = if drives == forwards { 250.0 } else { -250.0 };
        check_balance(&built(&text), torque, speed, 0.0);
        check_balance(&built(&lossy), torque, speed, 0.03);
    }
}

#[test]
fn what_does_not_fit_is_said_with_both_numbers() {
    let with = |from: &str, to: &str| findings(&BEVEL.replace(from, to));
    for (from, to, expected) in [
        (
            "35 deg\n",
            "35 deg\n    shaft_angle: 89 deg\n",
            "89.0000 deg, but 90.0000 deg follows",
        ),
        (
            "35 deg\n",
            "35 deg\n    offset: 1 mm\n",
            "1.0000 mm, but 0.0000 mm follows",
        ),
        (
            "35 deg\n",
            "35 deg\n    mounting_distance: [76.493 mm, 28 mm]\n",
            "28.0000 mm, but 27.4591 mm follows",
        ),
        (
            "35 deg\n",
            "35 deg\n    cutter: { radius: 114.3 mm }\n",
            "the axes intersect",
        ),
        (
            "35 deg\n",
            "35 deg\n    outer_module: 4.5 mm\n",
            "the size of the wheel is stated not once",
        ),
        ("z: 14", "z: 14, at: 70 mm", "70.0000 mm, but 76.4933 mm follows"),
        ("z: 14", "z: 14, profile_shift: 0.1", "`profile_shift` does not apply"),
        ("z: 14", "z: 3", "a bevel gear has at least 5"),
        (", hand: left", "", "`hand` is missing"),
        (
            "z: 39",
            "z: 39, hand: left",
            "the hands of `pinion` and `wheel` do not match",
        ),
        ("[0, 1, 0]", "[2, 0, 0]", "the axes are parallel"),
        ("[0, 1, 0]", "[0, 0, 0]", "the direction has no length"),
        (
            "bevel_meshes:\n  stage:\n    gears: [pinion, wheel]\n    outer_diameter: 176.893 mm\n    spiral_angle: 35 deg\n    depth: { wheel_addendum: 0.24737, addendum_angle: 2.1342 deg, dedendum_angle: 6.4934 deg }",
            "meshes:\n  stage: { gears: [pinion, wheel], normal_module: 4 mm, helix_angle: 35 deg }",
            "the axes are not parallel",
        ),
    ] {
        let found = with(from, to);
        assert!(found.contains(expected), "{from} -> {to}: {found}");
    }
    let text = hypoid(&Rotation3::identity(), "left");
    let unusual = findings(
        &text
            .replace("hand: left", "hand: right")
            .replace("cutter: { radius: 63.5 mm }", "wheel_pitch_angle: 72 deg"),
    );
    assert!(unusual.contains("usually the pinion has the larger one"), "{unusual}");
    let unclosed = findings(&text.replace("cutter: { radius: 63.5 mm }", "calculation_point: mid_face"));
    assert!(
        unclosed.contains("what determines the pitch cones is not stated once"),
        "{unclosed}"
    );
}

/// A worm above its wheel, and a crossed helical pair.
const WORM: &str = "
gearloss: gearbox/1
ports: { input: worm_shaft, output: wheel_shaft }
shafts:
  worm_shaft: { axis: { through: [0 mm, 0 mm, 100 mm], direction: [1, 0, 0] } }
  wheel_shaft: { axis: { through: [0 mm, 0 mm, 0 mm], direction: [0, 1, 0] } }
gears:
  worm: { shaft: worm_shaft, z: 2, facewidth: 60 mm, hand: right }
  wheel: { shaft: wheel_shaft, z: 41, facewidth: 30 mm }
worm_meshes:
  stage: { gears: [worm, wheel], module: 4 mm, diameter_factor: 9, profile_shift: 0 }
bearings:
  P1: { shaft: worm_shaft, at: -80 mm, axial: both, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }
  P2: { shaft: worm_shaft, at: 80 mm, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }
  W1: { shaft: wheel_shaft, at: 40 mm, axial: both, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }
  W2: { shaft: wheel_shaft, at: -40 mm, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }
lubricants: { oil: { viscosity: { kv40: 220 mm2/s, kv100: 25 mm2/s } } }
";

#[test]
fn a_worm_pushes_along_its_axis_what_its_wheel_carries_around() {
    let t = built(WORM);
    let (speed, axial) = solved(&t, 20.0, 1500.0, |s| {
        let output = t.ports()[1].member;
        (
            s.speed(output) / RPM,
            (0..4).map(|i| s.load(i).axial).collect::<Vec<_>>(),
        )
    });
    close(speed.abs(), 1500.0 * 2.0 / 41.0, 1e-9);
    // Thrust of one is the tangential force of the other: 20 N m at 18 mm, and that times the ratio at 82 mm.
    close(axial[0], 20.0 * 20.5 / 0.082, 1e-8);
    close(axial[2], 20.0 / 0.018, 1e-8);
    // With the left hand the wheel turns the other way.
    let left = built(&WORM.replace("right", "left"));
    let reversed = solved(&left, 20.0, 1500.0, |s| s.speed(left.ports()[1].member) / RPM);
    close(reversed, -speed, 1e-9);
    for (from, to, expected) in [
        ("profile_shift: 0 ", "profile_shift: 0.1 ", "but 0.0000 follows"),
        ("[0, 1, 0]", "[0.1, 1, 0]", "axes at 90 deg"),
        (
            "100 mm], d",
            "150 mm], d",
            "12.5000 follows from the distance of the axes",
        ),
        ("diameter_factor: 9, ", "", "the diameter of the worm is missing"),
        ("z: 41", "z: 41, hand: left", "worm and wheel have the same hand"),
        ("z: 2", "z: 2, faces: end", "`faces` does not apply"),
    ] {
        let found = findings(&WORM.replace(from, to));
        assert!(found.contains(expected), "{from} -> {to}: {found}");
    }
    let apart = findings(
        &WORM
            .replace(", profile_shift: 0", "")
            .replace("100 mm], d", "150 mm], d"),
    );
    assert!(apart.contains("worm and wheel fit at 100.0000 mm"), "{apart}");
}

#[test]
fn crossed_helical_gears_need_the_angle_and_distance_of_their_teeth() {
    let text = WORM
        .replace(
            "z: 2, facewidth: 60 mm, hand: right",
            "z: 15, facewidth: 30 mm, hand: right",
        )
        .replace("z: 41, facewidth: 30 mm", "z: 30, facewidth: 30 mm, hand: right")
        .replace("worm_meshes", "crossed_helical_meshes")
        .replace(
            "module: 4 mm, diameter_factor: 9, profile_shift: 0",
            "normal_module: 3 mm, helix_angle: [45 deg, 45 deg]",
        )
        .replace("100 mm], d", "95.459415460183916 mm], d");
    let t = built(&text);
    let speed = solved(&t, 20.0, 1500.0, |s| s.speed(t.ports()[1].member) / RPM);
    close(speed.abs(), 750.0, 1e-9);
    let apart = findings(&text.replace("95.459415460183916", "95.5"));
    assert!(apart.contains("95.4594 mm, but 95.5000 mm follows"), "{apart}");
    let turned = findings(&text.replace("[45 deg, 45 deg]", "[45 deg, 40 deg]"));
    assert!(turned.contains("85.0000 deg, but 90.0000 deg follows"), "{turned}");
}

/// A helical stage along x as usual, and the same with directions stated, along x and turned by 90 degrees about z.
#[test]
fn parallel_axes_in_any_direction_are_the_cylindrical_stage() {
    let text = |axes: [&str; 2]| {
        format!(
            "
gearloss: gearbox/1
ports: {{ input: a, output: b }}
shafts:
  a: {{ axis: {} }}
  b: {{ axis: {} }}
gears:
  first: {{ shaft: a, at: 10 mm, z: 20, facewidth: 20 mm, hand: right }}
  second: {{ shaft: b, at: 10 mm, z: 40, facewidth: 20 mm }}
meshes:
  stage: {{ gears: [first, second], normal_module: 2 mm, helix_angle: 20 deg }}
bearings:
  A1: {{ shaft: a, at: -20 mm, axial: both, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }}
  A2: {{ shaft: a, at: 40 mm, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }}
  B1: {{ shaft: b, at: -20 mm, axial: both, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }}
  B2: {{ shaft: b, at: 40 mm, kind: deep_groove_ball, bore: 30 mm, outside: 62 mm, model: none }}
lubricants: {{ oil: {{ viscosity: {{ kv40: 100 mm2/s, kv100: 11 mm2/s }} }} }}
",
            axes[0], axes[1]
        )
    };
    let usual = loads(&built(&text(["[0 mm, 0 mm]", "[64 mm, 0 mm]"])), 100.0, 1000.0);
    let stated = [
        "{ through: [0 mm, 0 mm, 0 mm], direction: [3, 0, 0] }",
        "{ through: [0 mm, 64 mm, 0 mm], direction: [1, 0, 0] }",
    ];
    assert_eq!(loads(&built(&text(stated)), 100.0, 1000.0), usual);
    let turned = [
        "{ through: [0 mm, 0 mm, 0 mm], direction: [0, 1, 0] }",
        "{ through: [-64 mm, 5 mm, 0 mm], direction: [0, 1, 0] }",
    ];
    let shifted = text(turned)
        .replace("shaft: b, at: 10 mm", "shaft: b, at: 5 mm")
        .replace("shaft: b, at: -20 mm", "shaft: b, at: -25 mm")
        .replace("shaft: b, at: 40 mm", "shaft: b, at: 35 mm");
    for (turned, usual) in loads(&built(&shifted), 100.0, 1000.0).iter().zip(&usual) {
        for i in 0..2 {
            close(turned[i], usual[i], 1e-10 * 1e4);
        }
    }
    let opposite = findings(&text([
        stated[0],
        "{ through: [0 mm, 64 mm, 0 mm], direction: [-1, 0, 0] }",
    ]));
    assert!(opposite.contains("their directions are opposite"), "{opposite}");
}
