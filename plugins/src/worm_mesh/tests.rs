//! Worm drives in gearbox files: torques of both directions of power, forces of the teeth, self-locking.

#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;

use gearloss_framework::evaluate::{Point, Solution};
use gearloss_framework::flow::Status;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;
use gearloss_framework::testing::language;
use gearloss_framework::transmission::Transmission;

const RPM: f64 = PI / 30.0;

/// Worm `w` along x, wheel `g` along y at a distance.
fn drive(z: [u32; 2], mesh: &str, distance: f64, rest: &str) -> Result<Transmission, String> {
    let [threads, teeth] = z;
    let text = format!(
        "gearloss: gearbox/1
title: worm
ports: {{ input: w, output: g }}
shafts:
  w: {{ axis: {{ through: [0, 0, 0], direction: [1, 0, 0] }}, bearings: none }}
  g: {{ axis: {{ through: [0 mm, 0 mm, {distance} mm], direction: [0, 1, 0] }}, bearings: none }}
gears:
  thread: {{ shaft: w, z: {threads}, facewidth: 50 mm, hand: right, surface: {{ ra: 0.5 um }} }}
  rim: {{ shaft: g, z: {teeth}, facewidth: 30 mm, surface: {{ ra: 0.5 um }} }}
worm_meshes:
  stage: {{ gears: [thread, rim], {mesh} }}
lubricants: {{ oil: {{ kind: mineral, viscosity: {{ kv40: 220 mm2/s, kv100: 19 mm2/s }} }} }}
housing: {{ oil: {{ lubricant: oil }} }}
thermal: {{ mode: fixed, oil: 70 degC }}
{rest}"
    );
    let gearbox = Gearbox::of_text(language(), &text, "worm.yaml", "").map_err(|f| f.render())?;
    gearbox
        .transmission(language(), &Choice::default())
        .map_err(|f| f.render())
}

fn fva(model: &str) -> Transmission {
    let mesh = format!("module: 4 mm, diameter_factor: 9, lubrication: spray, model: {{ {model} }}");
    drive([2, 41], &mesh, 100.0, "").unwrap()
}

/// The measured small drive: one thread, 60 teeth, 10 mm and 20 mm.
fn small(model: &str) -> Transmission {
    let mesh = format!("module: 0.5 mm, diameter_factor: 20, model: {{ {model} }}");
    drive([1, 60], &mesh, 20.0, "").unwrap()
}

/// Solves with a speed of the worm and a torque at one port, whose power is positive if it drives; the sign of torques is that of power.
fn solved<T>(
    t: &Transmission,
    speed: f64,
    (port, torque): (&str, f64),
    read: impl FnOnce(&Solution<'_>, [f64; 2]) -> T,
) -> T {
    let gear = t.states()[0].name.clone();
    let case = t.case(&gear, &["input"], &[port]).unwrap();
    let mut scratch = t.scratch(&case);
    let at = |torque: f64, scratch: &mut _| {
        let point = Point {
            speeds: &[speed],
            torques: &[torque],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[t.oil_temperature], scratch);
        t.ports()
            .iter()
            .map(|port| solution.speed(port.member))
            .collect::<Vec<f64>>()
    };
    let speeds = at(torque, &mut scratch);
    let number = t.ports().iter().position(|own| own.name == port).unwrap();
    let point = Point {
        speeds: &[speed],
        torques: &[torque * speeds[number].signum()],
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[t.oil_temperature], &mut scratch);
    let torques = [0, 1].map(|i| solution.torque(i) * speeds[i].signum());
    read(&solution, torques)
}

#[track_caller]
fn close(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance * expected.abs(),
        "{value} instead of {expected}"
    );
}

#[test]
fn without_friction_torques_have_the_ratio_of_teeth() {
    let t = fva("type: friction, value: 0");
    for port in ["input", "output"] {
        for torque in [10.0, -10.0] {
            solved(&t, 1500.0 * RPM, (port, torque), |solution, [worm, wheel]| {
                close(-wheel / worm, 20.5, 1e-12);
                assert_eq!(solution.loss(), Some(0.0));
            });
        }
    }
}

/// Efficiencies of DIN 3996 whichever torque is given and in both senses of rotation; the power balance closes.
#[test]
fn both_directions_of_power_have_their_efficiency() {
    let t = fva("type: din_3996");
    for (drives, efficiency) in [("input", 0.83872349), ("output", 0.81113006)] {
        for given in ["input", "output"] {
            for speed in [1500.0, -1500.0] {
                let torque = if given == drives { 12.0 } else { -12.0 };
                solved(&t, speed * RPM, (given, torque), |solution, _| {
                    close(solution.efficiency().unwrap(), efficiency, 1e-7);
                    assert!(solution.residual().unwrap().abs() < 1e-10 * solution.largest_power());
                    let expected = if drives == "input" {
                        Status::Drive
                    } else {
                        Status::Coast
                    };
                    assert_eq!(solution.status(), expected);
                });
            }
        }
    }
}

/// Shigley's example: 1 hp at 1200 1/min, 2 threads, 30 teeth, f 0.03. \[lbf\]
#[test]
fn forces_of_a_textbook() {
    const POUND: f64 = 4.448_221_615;
    let mesh = "module: 4.23333333 mm, worm_diameter: 50.8 mm, pressure_angle: 14.5 deg, model: { type: friction, value: 0.03 }";
    let t = drive([2, 30], mesh, 88.9, "").unwrap();
    solved(
        &t,
        1200.0 * RPM,
        ("input", 745.699_872 / (1200.0 * RPM)),
        |solution, _| {
            let force = solution.tooth_force(0).unwrap().force.map(|f| f / POUND);
            // Along the worm, across it, and towards it.
            close(force[0].abs(), 264.35, 1e-4);
            close(force[1].abs(), 52.521, 1e-4);
            close(force[2].abs(), 69.67, 1e-4);
            // The wheel is above the worm, which is pushed away from it.
            assert!(force[2] < 0.0);
        },
    );
}

/// Lifting and lowering a load with a drive that locks itself: T_2 d_1/d_2 tan(rho + gamma) and T_2 d_1/d_2 tan(rho - gamma) at the worm,
/// both in the sense of rotation.
#[test]
fn a_self_locking_drive_is_driven_both_ways() {
    let t = small("type: friction, value: 0.12, at_rest: 0.18");
    solved(&t, 10.0 * RPM, ("output", -18.84e-3), |solution, [worm, _]| {
        close(worm, 1.1231e-3, 1e-4);
        assert_eq!(solution.status(), Status::Drive);
        assert_eq!(solution.locked_worms().count(), 0);
    });
    solved(&t, 10.0 * RPM, ("output", 18.84e-3), |solution, [worm, wheel]| {
        close(worm, 0.4849e-3, 2e-4);
        assert!(wheel > 0.0);
        assert_eq!(solution.status(), Status::Dragged);
        assert_eq!(solution.locked_worms().collect::<Vec<_>>(), ["worm_meshes.stage"]);
        assert!(solution.residual().unwrap().abs() < 1e-10 * solution.largest_power());
    });
    // A brake at the worm cannot hold a motion that the wheel does not cause.
    solved(&t, 10.0 * RPM, ("input", -1e-3), |solution, _| {
        assert_eq!(solution.status(), Status::SelfLocking);
    });
    let (path, _, rest) = t.worms().next().unwrap();
    let rest = rest.unwrap();
    assert_eq!(path, "worm_meshes.stage");
    assert!(rest.efficiency[0] < 0.45 && rest.efficiency[1] < 0.0);
}

/// A loss of most of the power is found from either side.
#[test]
fn a_poor_drive_converges() {
    let t = small("type: friction, value: 0.25");
    let efficiency = solved(&t, 100.0 * RPM, ("input", 1e-3), |s, _| s.efficiency().unwrap());
    assert!(efficiency < 0.2);
    solved(&t, 100.0 * RPM, ("output", -18.84e-3), |solution, _| {
        close(solution.efficiency().unwrap(), efficiency, 1e-9);
        assert!(solution.passes() <= 4, "{}", solution.passes());
    });
}

#[test]
fn losses_count_once() {
    let mesh = "module: 4 mm, diameter_factor: 9, model: { type: din_3996, idle_loss: true, seals: 2, bearing_loss: adjusted }";
    assert!(drive([2, 41], mesh, 100.0, "").is_ok());
    let seals = "seals: { s: { shaft: w, diameter: 30 mm, kind: radial_lip, model: { type: linke } } }";
    let found = drive([2, 41], mesh, 100.0, seals).err().unwrap();
    assert!(
        found.contains("`idle_loss` adds a loss that the gearbox also describes"),
        "{found}"
    );
}

#[test]
fn what_the_standard_does_not_know_is_said() {
    let concave = "module: 4 mm, diameter_factor: 9, profile: zc, model: { type: din_3996 }";
    let found = drive([2, 41], concave, 100.0, "").err().unwrap();
    assert!(found.contains("profile ZC is not known for edition 1998"), "{found}");
    let both = "module: 4 mm, diameter_factor: 9, worm_diameter: 36 mm";
    let found = drive([2, 41], both, 100.0, "").err().unwrap();
    assert!(found.contains("the diameter of the worm is stated twice"), "{found}");
}

/// The lift of the examples: it holds its load at rest, and needs the motor both ways when it moves slowly.
#[test]
fn the_lift_of_the_examples_holds_its_load() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/worm-drive/gearbox.yaml");
    let gearbox = Gearbox::read(language(), &file).unwrap_or_else(|f| panic!("{}", f.render()));
    let t = gearbox
        .transmission(language(), &Choice::default())
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let rest = t.worms().next().unwrap().2.unwrap();
    assert!(rest.efficiency[0] < 0.45, "{rest:?}");
    for (speed, locks, status) in [(1450.0, false, Status::Coast), (10.0, true, Status::Dragged)] {
        solved(&t, speed * RPM, ("output", -350.0), |s, _| {
            assert_eq!(s.status(), Status::Drive);
        });
        solved(&t, speed * RPM, ("output", 350.0), |s, [worm, _]| {
            assert_eq!((s.status(), s.locked_worms().count() == 1), (status, locks));
            assert_eq!(worm > 0.0, locks);
            assert!(s.residual().unwrap().abs() < 1e-9 * s.largest_power());
        });
    }
}

/// The friction of AGMA, untuned, at 10 1/min of the measured small drive: 1.831 mN m to lift and 0.954 mN m to lower, within 10 %.
#[test]
fn the_measured_drive() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../corpus/worm_drive_60/gearbox.yaml");
    let gearbox = Gearbox::read(language(), &file).unwrap_or_else(|f| panic!("{}", f.render()));
    let t = gearbox
        .transmission(language(), &Choice::default())
        .unwrap_or_else(|f| panic!("{}", f.render()));
    for (torque, measured) in [(-18.84e-3, 1.831e-3), (18.84e-3, 0.9535e-3)] {
        solved(&t, 10.0 * RPM, ("output", torque), |_, [worm, _]| {
            close(worm, measured, 0.1);
        });
    }
}
