//! Two machines on one planetary set: speeds by the ratio that a gear keeps, torques and powers by the equation of Willis, the ratio that draws
//! least, and what is not determined.

use serde_json::Value;

use crate::common::RPM;
use crate::common::study::{Ran, number, run_texts};

/// Sun 30, ring 78: w_sun 30 + w_ring 78 = w_carrier 108.
fn gearbox(efficiency: f64, machines: &str, states: &str) -> String {
    format!(
        "gearloss: gearbox/1
ports: {{ ring_machine: ring_shaft, sun_machine: sun_shaft, output: carrier }}
shafts:
  ring_shaft: {{ axis: [0 mm, 0 mm] }}
  sun_shaft: {{ axis: [0 mm, 0 mm] }}
  carrier: {{ axis: [0 mm, 0 mm] }}
  planet: {{ mass: 0.2 kg }}
gears:
  sun: {{ shaft: sun_shaft, z: 30, facewidth: 20 mm }}
  planet_gear: {{ shaft: planet, z: 24, facewidth: 20 mm }}
  ring: {{ shaft: ring_shaft, z: 78, facewidth: 20 mm, kind: ring, tip_diameter: 152 mm }}
meshes:
  sun_planet: {{ gears: [sun, planet_gear], normal_module: 2 mm, centre_distance: 54 mm }}
  planet_ring: {{ gears: [planet_gear, ring], normal_module: 2 mm, centre_distance: 54 mm }}
planetary_sets:
  set: {{ carrier: carrier, planets: [planet], count: 3 }}
gear_states: {{ {states} }}
couplings: {{ lock: {{ kind: dog, between: [sun_shaft, carrier] }} }}
lubricants: {{ oil: {{ viscosity: {{ kv40: 46 mm2/s, kv100: 8 mm2/s }} }} }}
models: {{ gear_mesh: {{ type: efficiency, value: {efficiency} }}, planetary_drag: none, bearing: none }}
machines: {{ {machines} }}
"
    )
}

const SPLIT: &str = "split: { engaged: [], speed_ratio: { port: sun_machine, to: ring_machine, ratio: [0.5, 1, 2] } }";
const EFFICIENT: &str = "ring: { port: ring_machine, efficiency: 0.9, contains: [inverter] }, sun: { port: sun_machine, efficiency: 0.95, contains: \
                         [inverter] }";
/// Losses that depend on speed and torque, so that the best ratio does.
const MAPPED: &str = "ring: { port: ring_machine, map: ring.csv, contains: [inverter] }, sun: { port: sun_machine, map: sun.csv, contains: \
                      [inverter] }";

fn map(iron: f64, copper: f64) -> String {
    let mut rows = "speed [rpm],torque [Nm],loss [W]\n".to_owned();
    for n in (0..=6000).step_by(500) {
        for torque in (-60..=60).step_by(10) {
            let (w, torque) = (f64::from(n) * RPM, f64::from(torque));
            let loss = 10.0 + iron * w * w + copper * torque * torque;
            rows.push_str(&format!("{n},{torque},{loss}\n"));
        }
    }
    rows
}

const CYCLE: &str = "time [s],vehicle_speed [m/s]\n0,0\n10,10\n20,10\n30,2\n40,2\n";

fn ran(gearbox: &str, rest: &str) -> Ran {
    let study = format!(
        "gearloss: study/1
gearboxes: {{ box: box.yaml }}
conditions: {{ oil_temperature: 60 degC, torque_at: output, speed_at: output }}
cycles: {{ own: {{ file: own.csv }} }}
vehicles:
  car:
    mass: 400 kg
    coast_down: {{ a: 100 N, b: 0 N s/m, c: 0.4 N s2/m2 }}
    tyre_radius: 80 mm
    rotating_mass_factor: 1.05
    regeneration: {{ torque: 40 Nm, power: 1000 kW }}
    battery: {{ energy: 10 kWh, efficiency: 0.96, auxiliaries: 100 W }}
{rest}
"
    );
    let (ring, sun) = (map(1.5e-3, 0.02), map(0.2e-3, 0.1));
    run_texts(
        &study,
        &[
            ("box.yaml", gearbox),
            ("own.csv", CYCLE),
            ("ring.csv", &ring),
            ("sun.csv", &sun),
        ],
    )
}

fn close(value: f64, expected: f64) {
    assert!(
        (value - expected).abs() <= 1e-9 * expected.abs().max(1.0),
        "{value} is not {expected}"
    );
}

#[test]
fn an_ideal_set_has_the_powers_of_the_hand_calculation() {
    let points = |gear: &str| {
        format!(
            "  p: {{ type: operating_points, gear: {gear}, points: [{{ torque: -108 Nm, speed: 1000 rpm }}], write: [json] }}"
        )
    };
    for ratio in [0.5, 1.0, 2.0] {
        let ran = ran(
            &gearbox(1.0, EFFICIENT, SPLIT),
            &format!("analyses:\n{}", points(&format!("split {ratio}"))),
        );
        assert!(ran.succeeded, "{}", ran.text);
        let unit = &ran.json("p")["operating_points"][0]["points"][0]["unit"];
        let carrier = 1000.0 * RPM;
        let ring = 108.0 * carrier / (30.0 * ratio + 78.0);
        // Torques are as the numbers of teeth.
        let [of_ring, of_sun] = [78.0 * ring, 30.0 * ratio * ring];
        close(of_ring + of_sun, 108.0 * carrier);
        close(number(&unit["dc_power_w"]), of_ring / 0.9 + of_sun / 0.95);
        close(
            number(&unit["machine_loss_w"]),
            of_ring * (1.0 / 0.9 - 1.0) + of_sun * (1.0 / 0.95 - 1.0),
        );
        close(
            number(&unit["system_efficiency"]),
            108.0 * carrier / (of_ring / 0.9 + of_sun / 0.95),
        );
    }
}

/// Powers by gear, torque and speed.
fn drawn(ran: &Ran, analysis: &str) -> Vec<(String, [f64; 2], f64)> {
    let maps = ran.json(analysis)["maps"].as_array().unwrap().clone();
    let of_map = |map: &Value| {
        let gear = map["gear"].as_str().unwrap().to_owned();
        let points = map["points"].as_array().unwrap().clone();
        let of_point = move |p: Value| {
            let at = ["torque_nm", "speed_rpm"].map(|key| number(&p[key]));
            (gear.clone(), at, number(&p["unit"]["dc_power_w"]))
        };
        points.into_iter().map(of_point).collect::<Vec<_>>()
    };
    maps.iter().flat_map(of_map).collect()
}

#[test]
fn the_best_ratio_of_a_map_draws_least() {
    let grid = |gear: &str| format!("gear: {gear}, torque: [-100 Nm, -20 Nm, 60 Nm], speed: [300 rpm, 2500 rpm]");
    let rest = format!(
        "grids: {{ each: {{ {} }}, best: {{ {} }} }}
analyses:
  each: {{ type: map, grid: each, of: unit, write: [json] }}
  best: {{ type: map, grid: best, of: unit, write: [json] }}",
        grid("[split 0.5, split 1, split 2]"),
        grid("best")
    );
    let ran = ran(&gearbox(0.99, MAPPED, SPLIT), &rest);
    assert!(ran.succeeded, "{}", ran.text);
    let each = drawn(&ran, "each");
    assert_eq!(each.len(), 18);
    for (_, at, power) in drawn(&ran, "best") {
        let least = each
            .iter()
            .filter(|(_, other, _)| *other == at)
            .map(|(.., power)| *power);
        assert_eq!(power, least.fold(f64::INFINITY, f64::min), "{at:?}");
    }
    let gears = ran.json("best")["maps"][0]["best_gears"]["gears"]
        .as_array()
        .unwrap()
        .clone();
    assert!(
        gears.iter().filter(|gear| number(&gear["points"]) > 0.0).count() > 1,
        "{gears:?}"
    );
}

#[test]
fn a_cycle_in_the_best_ratio_closes_its_balance_and_draws_least() {
    let cycle = |name: &str, gear: &str| {
        format!("  {name}: {{ type: cycle, cycles: [own], gear: {gear}, write: [json, csv] }}")
    };
    let gears = ["split 0.5", "split 1", "split 2"];
    let mut rest = "analyses:\n".to_owned() + &cycle("best", "{ choose: best, shift_energy: 0 J }") + "\n";
    for (i, gear) in gears.iter().enumerate() {
        rest += &(cycle(&format!("g{i}"), gear) + "\n");
    }
    let ran = ran(&gearbox(0.99, MAPPED, SPLIT), &rest);
    assert!(ran.succeeded, "{}", ran.text);
    let of = |analysis: &str| ran.json(analysis)["cycles"][0].clone();
    for analysis in ["best", "g0", "g1", "g2"] {
        let consumption = &of(analysis)["consumption"];
        assert!(number(&consumption["residual_share"]) < 1e-9, "{consumption}");
        assert!(number(&consumption["interval_residual_share"]) < 1e-9, "{consumption}");
        assert_eq!(of(analysis)["machines"].as_array().unwrap().len(), 2);
    }
    let drawn = |analysis: &str| {
        let machines = of(analysis)["machines"].as_array().unwrap().clone();
        let of_machine = |m: &Value| {
            ["shaft_j", "loss_j", "inverter_j"]
                .map(|key| number(&m[key]))
                .iter()
                .sum::<f64>()
        };
        machines.iter().map(of_machine).sum::<f64>()
    };
    let best = drawn("best");
    for analysis in ["g0", "g1", "g2"] {
        assert!(
            best <= drawn(analysis) * (1.0 + 1e-12),
            "{analysis}: {best} {}",
            drawn(analysis)
        );
    }
}

#[test]
fn a_map_that_does_not_cover_names_the_machine_and_the_place() {
    let short = "ring: { port: ring_machine, map: ring.csv, contains: [inverter] }, sun: { port: sun_machine, map: short.csv, contains: [inverter] }";
    let study = "gearloss: study/1
gearboxes: { box: box.yaml }
conditions: { oil_temperature: 60 degC, torque_at: ring_machine, speed_at: ring_machine }
cycles: { own: { file: own.csv } }
vehicles: { car: { mass: 400 kg, coast_down: { a: 100 N, b: 0 N s/m, c: 0.4 N s2/m2 }, tyre_radius: 80 mm, rotating_mass_factor: 1.05, regeneration: none } }
grids: { g: { gear: split 2, torque: [20 Nm], speed: [100 rpm, 1000 rpm, 2000 rpm] } }
analyses:
  c: { type: cycle, cycles: [own], gear: split 2, write: [json] }
  m: { type: map, grid: g, of: unit, write: [json] }
";
    let ring = map(1.5e-3, 0.02);
    let covered = "speed [rpm],torque [Nm],loss [W]\n0,-60,50\n0,0,10\n0,60,40\n500,-60,100\n500,0,20\n500,60,90\n";
    let files = [
        ("box.yaml", gearbox(1.0, short, SPLIT)),
        ("own.csv", CYCLE.to_owned()),
        ("ring.csv", ring),
        ("short.csv", covered.to_owned()),
    ];
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let ran = run_texts(study, &files);
    assert!(ran.succeeded, "{}", ran.text);
    let farthest = &ran.json("c")["cycles"][0]["machines"][1]["farthest"];
    // Farthest by the power of the excess: while the car accelerates, at 5 m/s; the sun turns at 2 x 108/138 of the carrier.
    let sun = 2.0 * 108.0 / 138.0 * 5.0 / 0.08 / RPM;
    close(number(&farthest["speed_rpm"]), sun);
    close(number(&farthest["speed_beyond_rpm"]), sun - 500.0);
    assert!(ran.text.contains("machine sun is outside its map for"), "{}", ran.text);
    // In the map torque and speed are those of the ring.
    let outside = &ran.json("m")["maps"][0]["outside_maps"];
    assert_eq!(outside.as_array().unwrap().len(), 1, "{outside}");
    assert_eq!(
        (outside[0]["machine"].as_str(), number(&outside[0]["points"])),
        (Some("machines.sun"), 2.0)
    );
    close(number(&outside[0]["speed_beyond_rpm"]), 3500.0);
    close(number(&outside[0]["torque_nm"]), 20.0 * 30.0 / 78.0);
}

#[test]
fn what_is_not_determined_is_refused() {
    let point = "analyses: { p: { type: operating_points, points: [{ torque: -108 Nm, speed: 1000 rpm }] } }";
    let cases = [
        // Two speeds are free.
        (
            EFFICIENT,
            "free: []",
            "E0306",
            "speed_ratio: { port: sun_machine, to: ring_machine, ratio: 1 }",
        ),
        (
            EFFICIENT,
            "locked: [lock]",
            "E0306",
            "nothing states how the machines share the torque",
        ),
        // The set turns as one.
        (
            EFFICIENT,
            "locked: { engaged: [lock], speed_ratio: { port: sun_machine, to: ring_machine, ratio: 2 } }",
            "E0304",
            "the speeds of `sun_machine` and `ring_machine` already follow from each other in `locked`",
        ),
        (
            EFFICIENT,
            "split: { engaged: [], speed_ratio: { port: sun_machine, to: sun_machine, ratio: 2 } }",
            "E0304",
            "`sun_machine` and `sun_machine` are one shaft",
        ),
        (
            EFFICIENT,
            "split: { engaged: [], speed_ratio: { port: sun_machine, to: ring_machine, ratio: [2, 2] } }",
            "E0304",
            "`split 2` exists twice",
        ),
        (
            EFFICIENT,
            "split: { engaged: [], speed_ratio: { port: sun_motor, to: ring_machine, ratio: 2 } }",
            "E0203",
            "no port is called `sun_motor`",
        ),
        (
            "ring: { port: ring_machine, efficiency: 0.9, contains: [inverter] }, sun: { port: ring_machine, efficiency: 0.95, contains: [inverter] }",
            SPLIT,
            "E0345",
            "`machines.ring` is already at port `ring_machine`",
        ),
        (
            "sun: { port: engine, efficiency: 0.95, contains: [inverter] }",
            SPLIT,
            "E0203",
            "no port is called `engine`",
        ),
    ];
    for (machines, states, code, words) in cases {
        let ran = ran(&gearbox(1.0, machines, states), point);
        assert!(
            !ran.succeeded && ran.text.contains(code) && ran.text.contains(words),
            "{code} {words}\n{}",
            ran.text
        );
    }
}
