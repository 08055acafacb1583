//! A planetary differential whose wheels turn nearly alike: what its friction takes goes over continuously into that of equal speeds.

use crate::common::{RPM, language};
use gearloss_framework::evaluate::Point;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::real::LANES;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;

/// A carrier that drives sun and ring, each a wheel; planets on needle bearings, and the sun supported in the carrier.
fn built(friction: &str, locked_below: &str) -> Transmission {
    let text = format!(
        "
gearloss: gearbox/1
{locked_below}
ports: {{ input: carrier, left: sun_shaft, right: ring_shaft }}
shafts:
  sun_shaft: {{ axis: [0 mm, 0 mm] }}
  carrier: {{ axis: [0 mm, 0 mm] }}
  ring_shaft: {{ axis: [0 mm, 0 mm] }}
  planet: {{ mass: 0.2 kg }}
gears:
  sun: {{ shaft: sun_shaft, z: 24, facewidth: 20 mm }}
  planet_gear: {{ shaft: planet, z: 24, facewidth: 20 mm }}
  ring: {{ shaft: ring_shaft, z: 72, facewidth: 20 mm, kind: ring, tip_diameter: 140.8 mm }}
meshes:
  sun_planet: {{ gears: [sun, planet_gear], normal_module: 2 mm, centre_distance: 48 mm }}
  planet_ring: {{ gears: [planet_gear, ring], normal_module: 2 mm, centre_distance: 48 mm }}
planetary_sets:
  set: {{ carrier: carrier, count: 3, planets: [planet] }}
bearings:
  pin: {{ shaft: planet, outer: carrier, at: 0 mm, kind: needle_cage, bore: 20 mm, outside: 25 mm, width: 18 mm }}
lubricants: {{ oil: {{ viscosity: {{ kv40: 46 mm2/s, kv100: 8 mm2/s }} }} }}
models:
  gear_mesh: {friction}
  bearing: {{ type: iso14179_2 }}
"
    );
    let language = language();
    let gearbox = Gearbox::of_text(&language, &text, "input.yaml", ".").unwrap();
    gearbox.transmission(&language, &Choice::default()).unwrap()
}

/// Torque of the left wheel over that of the carrier, where the left wheel turns faster than 1000 rpm by a share and the carrier has 400 Nm.
fn split(t: &Transmission, apart: f64) -> f64 {
    let case = t.case("only", &["input", "left"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let speeds = [1000.0 * RPM, 1000.0 * RPM * (1.0 + apart)];
    let point = Point {
        speeds: &speeds,
        torques: &[400.0],
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    assert!(solution.residual().unwrap().abs() <= 1e-12 * solution.largest_power());
    // The same to the bit side by side.
    let left = -solution.torque(1) / 400.0;
    let watts: Vec<f64> = solution.watts().to_vec();
    let mut rows = t.batch_scratch(&case);
    let mut row = t.batch(&case, &point, &[80.0], &mut rows);
    let block = row.solve(&[400.0; LANES]);
    if !block.is_alone(0) {
        let together: Vec<f64> = block.watts().iter().map(|watts| watts[0]).collect();
        assert_eq!(together, watts, "{apart}");
    }
    left
}

const LAWS: [&str; 6] = [
    "{ type: iso14179_2 }",
    "{ type: iso14179_1 }",
    "{ type: efficiency, value: 0.98 }",
    "{ type: wimmer, mean_friction: { type: michaelis } }",
    "{ type: path_integral, tooth_friction: { type: xu } }",
    "{ type: path_integral, tooth_friction: { type: iso_tc60 } }",
];

#[test]
fn the_split_of_torque_goes_over_continuously_from_equal_speeds() {
    for law in LAWS {
        let t = built(law, "");
        let equal = split(&t, 0.0);
        // The sun has a quarter of the torque of the carrier, as its teeth have of both.
        assert!((equal - 0.25).abs() < 1e-12, "{law}: {equal}");
        for sense in [1.0, -1.0] {
            let mut before = equal;
            let full = (split(&t, sense * 1e-3) - equal).abs();
            for step in 0..=96 {
                // Twelve steps from decade to decade, from 1e-11 on.
                let apart = sense * 10.0_f64.powf(f64::from(step) / 12.0 - 11.0);
                let now = split(&t, apart);
                let least = 1e-3 * (now - equal).abs();
                // A twelfth of a decade is 17.5 % of what is reached: in proportion, and nowhere a jump.
                assert!(
                    (now - before).abs() < 0.2 * full,
                    "{law}: {before} then {now} at {apart}, {full} in all"
                );
                // The faster wheel has ever less of the torque, until its friction falls with speed.
                assert!(
                    sense * (before - now) > -least || apart.abs() > 1e-3,
                    "{law}: {before} then {now} at {apart}"
                );
                before = now;
            }
            let next_to_nothing = split(&t, sense * 1e-9);
            assert!((next_to_nothing - equal).abs() < 1e-6, "{law}: {next_to_nothing}");
        }
    }
}

#[test]
fn above_its_relative_speed_nothing_is_held_and_without_it_the_split_jumps() {
    for law in LAWS {
        let (with, without) = (built(law, ""), built(law, "locked_below: 0"));
        for apart in [1.01e-3, 0.02, -0.3] {
            assert_eq!(
                split(&with, apart).to_bits(),
                split(&without, apart).to_bits(),
                "{law} {apart}"
            );
        }
        let jump = (split(&without, 1e-9) - split(&without, 0.0)).abs();
        assert!(jump > 1e-3, "{law}: {jump}");
        // Even there friction has its bound.
        assert!(jump < 0.25, "{law}: {jump}");
    }
}

#[test]
fn gears_that_creep_against_the_housing_keep_their_friction() {
    let t = built("{ type: efficiency, value: 0.98 }", "");
    let case = t.case("only", &["input", "left"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let mut share = |rpm: f64| {
        // The carrier rests: a fixed train of sun, planet and ring.
        let speeds = [0.0, rpm * RPM];
        let point = Point {
            speeds: &speeds,
            torques: &[400.0],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
        solution.torque(1)
    };
    assert!((share(1e-6) / share(1e-3) - 1.0).abs() < 0.05);
}
