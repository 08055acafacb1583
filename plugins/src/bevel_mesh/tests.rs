//! Bevel and hypoid meshes in a gearbox: losses in the power flow, flanks, batches.
#![allow(clippy::unwrap_used)]

use gearloss_framework::evaluate::{Point, PowerFlow, Solution};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::real::Points as _;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;

const RPM: f64 = std::f64::consts::PI / 30.0;

/// The hypoid example F.3 of ISO 23509, which drives on its drive flanks with positive torque and speed. `MODEL` is its loss model.
const HYPOID: &str = "
gearloss: gearbox/1
ports: { input: pinion_shaft, output: wheel_shaft }
shafts:
  pinion_shaft: { axis: { through: [0 mm, 0 mm, 0 mm], direction: [-1, 0, 0] } }
  wheel_shaft: { axis: { through: [0 mm, 0 mm, 15 mm], direction: [0, 1, 0] } }
gears:
  pinion: { shaft: pinion_shaft, z: 13, facewidth: 31.9 mm, hand: left, faces: end }
  wheel: { shaft: wheel_shaft, z: 42, facewidth: 30 mm, faces: start }
bevel_meshes:
  final:
    gears: [pinion, wheel]
    outer_diameter: 170 mm
    spiral_angle: 49.99814 deg
    cutter: { radius: 63.5 mm }
    depth: { wheel_addendum: 0.35, addendum_angle: 1 deg, dedendum_angle: 4 deg }
    model: MODEL
surface: { ra: 0.4 um }
bearings:
  P1: { shaft: pinion_shaft, at: -190 mm, designation: '6210', axial: both, model: none }
  P2: { shaft: pinion_shaft, at: -105 mm, designation: '6210', model: none }
  W1: { shaft: wheel_shaft, at: -45 mm, designation: '6210', axial: both, model: none }
  W2: { shaft: wheel_shaft, at: 85 mm, designation: '6210', model: none }
lubricants: { oil: { viscosity: { kv40: 100 mm2/s, kv100: 11 mm2/s } } }
";

const CONSTANT: &str = "{ type: path_integral, tooth_friction: { type: constant, value: 0.05 } }";

fn built(text: &str) -> Transmission {
    let language = Language::linked().unwrap();
    let gearbox = Gearbox::of_text(&language, text, "input.yaml", ".").unwrap();
    gearbox.transmission(&language, &Choice::default()).unwrap()
}

fn hypoid(model: &str) -> Transmission {
    built(&HYPOID.replace("MODEL", model))
}

fn point<'a>(speed: &'a [f64; 1], torque: &'a [f64; 1]) -> Point<'a> {
    Point {
        speeds: speed,
        torques: torque,
        flow: PowerFlow::Real,
        tolerance: Tolerance::default(),
        inclination: 0.0,
    }
}

/// Solves torque in Nm and speed in rpm at the pinion, with the oil at 80 degC.
fn solved<T>(t: &Transmission, torque: f64, speed: f64, show: impl FnOnce(&Solution<'_>) -> T) -> T {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    show(&t.evaluate(&case, &point(&[speed * RPM], &[torque]), &[80.0], &mut scratch))
}

fn loss(s: &Solution<'_>) -> f64 {
    s.parts().map(|(_, part)| part.watts()).sum()
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value / expected - 1.0).abs() < tolerance, "{value} {expected}");
}

/// Drive and coast, forwards and backwards: the flank follows from the torque, the driving gear from the power.
#[test]
fn four_quadrants_of_a_hypoid_mesh() {
    let t = hypoid(CONSTANT);
    let input = 250.0 * 1200.0 * RPM;
    // Efficiency with constant friction on the drive flanks.
    let drive = solved(&t, 250.0, 1200.0, |s| {
        assert!(s.bevel_mesh_at(0).unwrap().drive_flank == 1.0);
        loss(s)
    });
    close(drive, input * (1.0 - 0.978_195_24), 1e-6);
    let coast = solved(&t, -250.0, -1200.0, |s| {
        assert!(s.bevel_mesh_at(0).unwrap().drive_flank == 0.0);
        loss(s)
    });
    // The loss factor of the coast flanks is 0.494836, that of the drive flanks 0.463247.
    assert!(coast > drive && coast < 1.1 * drive, "{coast} {drive}");
    // The wheel drives: the torque of the pinion is what is left, on the drive flanks backwards, on the coast flanks forwards.
    for (torque, speed, flank, factor) in [(250.0, -1200.0, 1.0, 0.463_247), (-250.0, 1200.0, 0.0, 0.494_836)] {
        let lost = solved(&t, torque, speed, |s| {
            let at = s.bevel_mesh_at(0).unwrap();
            assert!(at.drive_flank == flank && at.first_drives == 0.0);
            loss(s)
        });
        // Output of the pinion with the arm of the driven gear less friction: P = F_n mu S w with T = F_n (a - mu A).
        assert!(lost > 0.05 * factor * input && lost < 0.06 * factor * input, "{lost}");
    }
}

#[test]
fn without_friction_torques_have_the_ideal_ratio() {
    let t = hypoid("{ type: path_integral, tooth_friction: { type: constant, value: 0 } }");
    solved(&t, 250.0, 1200.0, |s| {
        assert!(loss(s) == 0.0);
        close(s.efficiency().unwrap(), 1.0, 1e-12);
    });
}

/// Power in is power out plus loss.
#[test]
fn power_balances_with_any_law() {
    for model in [
        CONSTANT,
        "{ type: path_integral, tooth_friction: { type: xu } }",
        "{ type: mean_friction, mean_friction: { type: schlenk } }",
        "{ type: mean_friction, load_sharing: contact_lines, mean_friction: { type: michaelis } }",
        "{ type: efficiency, value: 0.975 }",
    ] {
        let t = hypoid(model);
        for (torque, speed) in [(20.0, 500.0), (250.0, 4500.0), (-120.0, 1500.0), (120.0, -1500.0)] {
            solved(&t, torque, speed, |s| {
                let [input, output] = [s.input_power().unwrap(), s.output_power().unwrap()];
                assert!(
                    (input - output - loss(s)).abs() < 1e-11 * input,
                    "{model} {torque} {speed}"
                );
                assert!(loss(s) > 0.0 && loss(s) < 0.1 * input, "{model} {}", loss(s) / input);
            });
        }
    }
}

/// Xu is half of Schlenk or less on a hypoid pair; both fall with viscosity from rough contacts and with speed.
#[test]
fn friction_laws_follow_speed_and_load() {
    let share = |model: &str, torque: f64, speed: f64| {
        solved(&hypoid(model), torque, speed, |s| loss(s) / s.input_power().unwrap())
    };
    let schlenk = "{ type: mean_friction, mean_friction: { type: schlenk } }";
    let xu = "{ type: path_integral, tooth_friction: { type: xu } }";
    assert!(share(schlenk, 250.0, 1200.0) > share(schlenk, 250.0, 4000.0));
    assert!(share(schlenk, 250.0, 1200.0) > share(schlenk, 120.0, 1200.0));
    let ratio = share(xu, 250.0, 1200.0) / share(schlenk, 250.0, 1200.0);
    assert!(ratio > 0.3 && ratio < 0.7, "{ratio}");
}

/// Several points solved together have the bits of each alone, in drive and in coast.
#[test]
fn batches_have_the_bits_of_single_points() {
    let t = hypoid("{ type: path_integral, tooth_friction: { type: xu } }");
    let case = t.case("only", &["input"], &["input"]).unwrap();
    for sign in [1.0, -1.0] {
        let torques: Vec<f64> = (0..7).map(|i| sign * (10.0 + 35.0 * f64::from(i))).collect();
        let (speeds, given) = ([1500.0 * RPM], [torques[0]]);
        let mut scratch = t.batch_scratch(&case);
        let first = point(&speeds, &given);
        let mut batch = t.batch(&case, &first, &[80.0], &mut scratch);
        let together: Vec<f64> = {
            let block = batch.solve(&torques);
            assert!((0..torques.len()).all(|i| !block.is_alone(i)));
            (0..torques.len()).map(|i| block.losses().at_point(i)).collect()
        };
        for (torque, together) in torques.iter().zip(together) {
            let alone = solved(&t, *torque, 1500.0, loss);
            assert_eq!(alone.to_bits(), together.to_bits(), "{torque}");
        }
    }
}
