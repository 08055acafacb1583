//! Electric machines at ports: the unit at points, in cycles and in every analysis, and what is refused.

use serde_json::Value;

use crate::common::study::{Ran, check_texts, number, run_texts};
use crate::drive_unit::{STAGE, per_distance};

const CYCLE: &str = "time [s],vehicle_speed [m/s]\n0,0\n10,10\n20,10\n30,0\n";

/// P = 40 + 0.5 w + 4e-4 w2 + 0.08 T2 + 2e-3 w |T| at fifteen nodes.
fn synthetic() -> String {
    let mut rows = "speed [rpm],torque [Nm],loss [W]\n".to_owned();
    for n in [0.0, 1000.0, 5000.0] {
        for torque in [-100.0_f64, -50.0, 0.0, 50.0, 100.0] {
            let w = n * std::f64::consts::PI / 30.0;
            let loss = 40.0 + 0.5 * w + 4e-4 * w * w + 0.08 * torque * torque + 2e-3 * w * torque.abs();
            rows.push_str(&format!("{n},{torque},{loss}\n"));
        }
    }
    rows
}

/// A study of the stage with a machine, a vehicle with more keys, and analyses.
fn unit(machine: &str, vehicle: &str, rest: &str) -> Ran {
    unit_with_map(machine, &synthetic(), vehicle, rest)
}

/// The same with the text of the file `map.csv`.
fn unit_with_map(machine: &str, map: &str, vehicle: &str, rest: &str) -> Ran {
    let study = format!(
        "gearloss: study/1
gearboxes: {{ box: box.yaml }}
conditions: {{ oil_temperature: 60 degC }}
cycles: {{ three: {{ file: three.csv }} }}
vehicles:
  car:
    mass: 1500 kg
    coast_down: {{ a: 100 N, b: 0 N s/m, c: 0.4 N s2/m2 }}
    tyre_radius: 300 mm
    rotating_mass_factor: 1.05
{vehicle}
{rest}
"
    );
    let gearbox = format!("{STAGE}\nmachines: {{ motor: {machine} }}\n");
    run_texts(
        &study,
        &[("box.yaml", &gearbox), ("three.csv", CYCLE), ("map.csv", map)],
    )
}

const CYCLES: &str = "analyses: { c: { type: cycle, cycles: [three], write: [json, csv] } }";
const REGENERATION: &str = "    regeneration: { torque: 40 Nm, power: 1000 kW }";

fn cycle(machine: &str, vehicle: &str) -> Value {
    let ran = unit(machine, vehicle, CYCLES);
    assert!(ran.succeeded, "{}", ran.text);
    ran.json("c")["cycles"][0].clone()
}

fn close(value: &Value, expected: f64) {
    let value = number(value);
    assert!(
        (value - expected).abs() <= 1e-9 * expected.abs().max(1.0),
        "{value} is not {expected}"
    );
}

/// Five variants of three intervals of a vehicle by hand: F = m k a + a + c v2, the losses one after the other, U = U0 - R I.
#[test]
fn machine_inverter_and_battery_have_the_energies_of_the_hand_calculation() {
    let bare = "{ efficiency: 0.92, contains: [inverter] }";
    let with_inverter = "{ efficiency: 0.92, inverter: { efficiency: 0.98 } }";
    let battery = |law: &str| format!("    battery: {{ energy: 60 kWh, {law}, auxiliaries: 300 W }}");
    let cells = "cells: { over_charge: [{ charge: 0.5, voltage: 360 V, resistance: 0.1 ohm }] }";
    let none = "    regeneration: none";
    let cases = [
        (
            bare,
            REGENERATION,
            "efficiency: 1",
            [16.124_495_741_8, 7.25, 8.874_495_741_82, 676.094_752_26],
        ),
        (
            with_inverter,
            REGENERATION,
            "efficiency: 1",
            [16.436_560_280_8, 7.096_666_666_67, 9.339_893_614_1, 642.405_604_165],
        ),
        (
            with_inverter,
            REGENERATION,
            "efficiency: 0.96",
            [17.121_416_959_1, 6.8128, 10.308_616_959_1, 582.037_340_585],
        ),
        (
            with_inverter,
            REGENERATION,
            cells,
            [16.547_843_396_1, 7.068_905_872_1, 9.478_937_523_97, 632.982_334_236],
        ),
        (
            with_inverter,
            none,
            "efficiency: 0.96",
            [17.555_444_736_9, 0.0, 17.555_444_736_9, 341.774_309_333],
        ),
    ];
    for (machine, regeneration, law, expected) in cases {
        let found = cycle(machine, &format!("{regeneration}\n{}", battery(law)));
        let consumption = &found["consumption"];
        for (key, expected) in [
            "drawn_kwh_per_100_km",
            "recuperated_kwh_per_100_km",
            "consumption_kwh_per_100_km",
            "range_km",
        ]
        .iter()
        .zip(expected)
        {
            close(&consumption[*key], expected);
        }
        // Battery = wheels + every loss + brakes + auxiliaries, over the cycle and in each interval.
        let parts = [
            "wheels",
            "transmission",
            "machine",
            "inverter",
            "brakes",
            "auxiliaries",
            "battery",
        ];
        let parts = parts.map(|part| number(&consumption[format!("{part}_kwh_per_100_km")]));
        close(&consumption["consumption_kwh_per_100_km"], parts.iter().sum());
        assert!(number(&consumption["residual_share"]) < 1e-9);
        assert!(number(&consumption["interval_residual_share"]) < 1e-9);
    }
}

#[test]
fn the_losses_of_machine_and_inverter_are_apart() {
    let battery = "    battery: { energy: 60 kWh, efficiency: 1, auxiliaries: 300 W }";
    let found = cycle(
        "{ efficiency: 0.92, inverter: { efficiency: 0.98 } }",
        &format!("{REGENERATION}\n{battery}"),
    );
    let consumption = &found["consumption"];
    close(
        &consumption["machine_kwh_per_100_km"],
        per_distance(755.266_696_549 + 125.504_258_18 + 480.0),
    );
    close(
        &consumption["inverter_kwh_per_100_km"],
        per_distance(192.670_075_65 + 32.016_392_392_9 + 110.4),
    );
    close(
        &found["machines"][0]["loss_j"],
        10.0 * (755.266_696_549 + 125.504_258_18 + 480.0),
    );
    assert_eq!(found["machines"][0]["machine"], "machines.motor");
}

#[test]
fn a_torque_above_the_envelope_is_limited_and_counted_or_refused() {
    let battery = "    battery: { energy: 60 kWh, efficiency: 1 }";
    let vehicle = format!("{REGENERATION}\n{battery}");
    let machine = |beyond: &str| {
        format!(
            "{{ efficiency: 0.92, contains: [inverter], envelope: {{ peak: {{ torque: 50 Nm, power: 100 kW }}, continuous: {{ torque: 4 Nm, \
             power: 100 kW }}, peak_time: 5 s{beyond} }} }}"
        )
    };
    let limited = cycle(&machine(""), &vehicle);
    let consumption = &limited["consumption"];
    assert_eq!(consumption["machine_limited"], 1);
    // 57.9 Nm are asked for: 8425 W at the wheels, of which 50 Nm supply 50 x 150 x 0.97.
    close(
        &consumption["lacking_kwh_per_100_km"],
        per_distance(8425.0 - 50.0 * 150.0 * 0.97),
    );
    assert!(number(&consumption["interval_residual_share"]) < 1e-9);
    let of_machine = &limited["machines"][0];
    close(&of_machine["longest_above_continuous_s"], 30.0);
    assert_eq!(of_machine["beyond_peak_time"], 1);
    close(&of_machine["beyond_envelope_s"], 0.0);
    let refused = unit(&machine(", beyond: refuse"), &vehicle, CYCLES);
    assert!(!refused.succeeded);
    for words in [
        "machines.motor.envelope",
        "57.9 Nm at 1432 rpm, where it reaches 50.0 Nm",
        "first at 0 s",
        "E0541",
    ] {
        assert!(refused.text.contains(words), "{words}: {}", refused.text);
    }
}

#[test]
fn a_battery_at_its_limit_is_counted() {
    let cells = "cells: { over_charge: [{ charge: 0.2, voltage: 340 V, resistance: 0.2 ohm }, { charge: 0.9, voltage: 380 V, resistance: 0.1 ohm, \
                 charge_resistance: 0.2 ohm }], capacity: 50 Ah, start: 0.5, least_voltage: 355 V, greatest_voltage: 358 V }";
    let vehicle = format!("{REGENERATION}\n    battery: {{ energy: 60 kWh, {cells} }}");
    let refused = unit("{ efficiency: 0.92, contains: [inverter] }", &vehicle, CYCLES);
    assert!(refused.text.contains("least_voltage"), "{}", refused.text);
    let vehicle = vehicle.replace(
        "least_voltage: 355 V, greatest_voltage: 358 V",
        "least_voltage: 339 V, greatest_voltage: 381 V",
    );
    let consumption = cycle("{ efficiency: 0.92, contains: [inverter] }", &vehicle)["consumption"].clone();
    assert!(number(&consumption["interval_residual_share"]) < 1e-9);
    let parts = ["wheels", "transmission", "machine", "brakes", "battery"];
    let sum: f64 = parts
        .map(|part| number(&consumption[format!("{part}_kwh_per_100_km")]))
        .iter()
        .sum();
    close(
        &consumption["consumption_kwh_per_100_km"],
        sum - number(&consumption["shortfall_kwh_per_100_km"]),
    );
}

#[test]
fn a_map_that_does_not_cover_the_cycle_says_where_and_how_much() {
    let battery = "    battery: { energy: 60 kWh, efficiency: 1 }";
    let short = "speed [rpm],torque [Nm],loss [W]\n0,-60,50\n0,0,10\n0,50,40\n2000,-60,100\n2000,0,20\n2000,50,90\n";
    let machine = "{ map: map.csv, contains: [inverter] }";
    let ran = unit_with_map(machine, short, &format!("{REGENERATION}\n{battery}"), CYCLES);
    assert!(ran.succeeded, "{}", ran.text);
    let farthest = &ran.json("c")["cycles"][0]["machines"][0]["farthest"];
    close(&farthest["torque_beyond_nm"], 57.903_780_068_7 - 50.0);
    // The torque of the first interval is farther outside, by its power, than the speed of the second.
    close(&farthest["speed_beyond_rpm"], 0.0);
    assert!(ran.text.contains("machine motor is outside its map for 66.7 % of the time, farthest at 0 s with 57.9 Nm at 1432 rpm, 7.9 Nm above"), "{}", ran.text);
}

/// All analyses over points have the quantities of the unit, and they are those of `solve`.
#[test]
fn every_analysis_of_points_has_the_unit() {
    let grids = "grids: { g: { torque: [-50 Nm, 50 Nm, 100 Nm], speed: [1000 rpm, 3000 rpm] } }
limits: { dc: { quantity: dc_power, most: 20 kW }, system: { quantity: system_efficiency, least: 0.5 } }
analyses:
  unit: { type: map, grid: g, of: unit, write: [json, csv] }
  machine: { type: map, grid: g, of: machine, write: [json, csv] }
  points: { type: operating_points, points: [{ torque: 50 Nm, speed: 3000 rpm }], by: unit, write: [json, csv] }
  bars: { type: breakdown, torque: 50 Nm, speed: 3000 rpm, by: unit, write: [json] }
  path: { type: sweep, torque: 50 Nm, speed: 3000 rpm, path: meshes.stage.loss_factor, values: [0.9, 1], write: [json, csv, svg] }
  names: { type: sweep, torque: 50 Nm, speed: 3000 rpm, path: bearings.B2.designation, values: ['6204', NU204EC], write: [svg] }
  parts: { type: breakdown, torque: 50 Nm, speed: 3000 rpm, write: [json, csv] }
  other: { type: compare, grid: g, base: own, variants: { worse: { meshes.stage.loss_factor: 2 } }, quantity: system_efficiency, write: [json] }
  bands: { type: uncertainty, grid: g, inputs: [{ path: meshes.stage.loss_factor, from: 0.8, to: 1.2 }], samples: 8, write: [json, csv] }
  effects: { type: sensitivity, grid: g, parameters: [{ path: meshes.stage.loss_factor, from: 0.8, to: 1.2 }], write: [json] }
  warm: { type: temperature_sweep, torque: 50 Nm, speed: 3000 rpm, oil_temperature: [40 degC, 60 degC], by: unit, write: [json] }
  idle: { type: spin_loss, speed: 3000 rpm, by: unit, write: [json] }
";
    let ran = unit(
        "{ map: map.csv, inverter: { efficiency: 0.98 } }",
        "    regeneration: none",
        grids,
    );
    assert!(ran.succeeded, "{}", ran.text);
    let map = ran.json("unit");
    assert_eq!(map["of"], "unit");
    let points = map["maps"][0]["points"].as_array().unwrap().clone();
    let point = points
        .iter()
        .find(|p| number(&p["torque_nm"]) == 50.0 && number(&p["speed_rpm"]) == 3000.0)
        .unwrap();
    let power = 50.0 * 3000.0 * std::f64::consts::PI / 30.0;
    let w = 3000.0 * std::f64::consts::PI / 30.0;
    // Bilinear between 1000 and 5000 rpm at a node of the torque.
    let at = |w: f64| 40.0 + 0.5 * w + 4e-4 * w * w + 0.08 * 2500.0 + 2e-3 * w * 50.0;
    let machine = 0.5 * (at(w / 3.0) + at(w / 0.6));
    let inverter = (power + machine) * (1.0 / 0.98 - 1.0);
    close(&point["unit"]["dc_power_w"], power + machine + inverter);
    close(&point["unit"]["machine_loss_w"], machine);
    close(&point["unit"]["inverter_loss_w"], inverter);
    close(&point["unit"]["unit_loss_w"], 0.03 * power + machine + inverter);
    let efficiency = 0.97 * power / (power + machine + inverter);
    close(&point["unit"]["system_efficiency"], efficiency);
    assert!(ran.text.contains("efficiency of the drive unit"), "{}", ran.text);
    for (analysis, words) in [
        ("unit", "system_efficiency"),
        ("path", "dc_power_w"),
        ("points", "unit_loss_w"),
        ("bands", "unit_loss_w_high"),
    ] {
        assert!(ran.csv(analysis).lines().next().unwrap().contains(words), "{analysis}");
    }
    let listed = ran.json("points")["operating_points"][0].clone();
    assert_eq!(
        listed["shares"],
        serde_json::json!(["gearbox", "machines", "inverters"])
    );
    close(&listed["points"][0]["losses_w"][2], inverter);
    close(&listed["points"][0]["limit_values"]["system"], efficiency);
    // Shares of the unit in the other breakdowns: at a temperature, and without torque.
    let of_unit = |analysis: &str| ran.json(analysis)["breakdowns"][0].clone();
    for analysis in ["bars", "warm", "idle"] {
        assert_eq!(of_unit(analysis)["shares"], listed["shares"], "{analysis}");
    }
    close(&of_unit("warm")["points"][1]["losses_w"][1], machine);
    let at_rest = 0.5
        * [w / 3.0, w / 0.6]
            .map(|w| 40.0 + 0.5 * w + 4e-4 * w * w)
            .iter()
            .sum::<f64>();
    close(&of_unit("idle")["points"][0]["losses_w"][1], at_rest);
    // Power and efficiency of the unit stand beside the bars, whatever divides them.
    for analysis in ["bars", "warm", "parts"] {
        let points = of_unit(analysis)["points"].as_array().unwrap().clone();
        assert_eq!(points[points.len() - 1]["unit"], point["unit"], "{analysis}");
        let header = ran.csv(analysis).lines().next().unwrap().to_owned();
        assert!(
            header.contains("dc_power_w") && header.contains("system_efficiency"),
            "{header}"
        );
    }
    let band = &ran.json("bands")["bands"][0]["points"];
    let band = band.as_array().unwrap().iter();
    let band = band
        .clone()
        .find(|p| number(&p["torque_nm"]) == 50.0 && number(&p["speed_rpm"]) == 3000.0);
    close(&band.unwrap()["dc_power_w"]["nominal"], power + machine + inverter);
    for picture in ["path-unit-loss", "path-system-efficiency", "names-unit"] {
        assert!(ran.draws(picture), "{picture}");
    }
    for words in ["DC power W", "unit loss W", "system efficiency in %"] {
        assert!(ran.text.contains(words), "{words}: {}", ran.text);
    }
    let swept = &ran.json("path")["sweep"][1]["points"];
    assert!(
        swept
            .as_array()
            .unwrap()
            .iter()
            .any(|p| p["unit"]["system_efficiency"] == point["unit"]["system_efficiency"])
    );
    let outputs = ran.json("effects")["sensitivities"].to_string() + &ran.json("effects").to_string();
    assert!(outputs.contains("system_efficiency") && outputs.contains("unit_loss"));
    // While generating, the efficiency is that back to the DC link.
    let back = points.iter().find(|p| number(&p["torque_nm"]) == -50.0).unwrap();
    assert!((0.0..1.0).contains(&number(&back["unit"]["system_efficiency"])));
    assert!(number(&back["unit"]["dc_power_w"]) < 0.0);
}

#[test]
fn what_is_counted_twice_or_unknown_is_refused() {
    let cases = [
        (
            "{ map: map.csv, contains: [inverter], inverter: { efficiency: 0.98 } }",
            "would be counted twice",
        ),
        ("{ map: map.csv, efficiency: 0.9 }", "both `map` and `efficiency`"),
        ("{ contains: [inverter] }", "the losses of the machine are not stated"),
        (
            "{ map: map.csv, inverter: {} }",
            "the losses of the inverter are not stated",
        ),
        (
            "{ map: map.csv, voltage: 400 V, inverter: { bridge: { channel_resistance: 3 mohm, frequency: 10 kHz, energy_on: 12 mJ, energy_off: \
             16 mJ, at_current: 450 A, at_voltage: 400 V } } }",
            "a map over torque and speed alone has no current",
        ),
        ("{ map: map.csv, contains: [inverter], rotor: nowhere }", "nowhere"),
        ("{ map: map.csv, contains: [inverter], port: shaft }", "port"),
        (
            "{ map: map.csv, contains: [inverter], freewheel: [{ speed: 0 rpm, loss: 0 W }] }",
            "belongs to `idle: \"off\"`",
        ),
        (
            "{ map: map.csv, contains: [inverter], envelope: { peak: { torque: 10 Nm, power: 1 kW }, continuous: { torque: 20 Nm, power: 1 kW } } }",
            "above that of the peak",
        ),
    ];
    for (machine, words) in cases {
        let ran = unit(
            machine,
            "    regeneration: none",
            "analyses: { s: { type: map, grid: g } }\ngrids: { g: { torque: 10 Nm, speed: 1000 rpm } }",
        );
        assert!(!ran.succeeded && ran.text.contains(words), "{machine}: {}", ran.text);
    }
    let battery = "    regeneration: none\n    battery: { energy: 60 kWh, efficiency: 0.9, cells: { over_charge: [{ charge: 0.5, voltage: 360 V, resistance: 0.1 ohm }] } }";
    let ran = unit("{ efficiency: 0.92, contains: [inverter] }", battery, CYCLES);
    assert!(
        ran.text.contains("E0540") && ran.text.contains("count the losses twice"),
        "{}",
        ran.text
    );
    let twice = "    regeneration: none\n    battery: { energy: 60 kWh, efficiency: 0.9 }\n    motor_map: map.csv";
    let ran = unit("{ efficiency: 0.92, contains: [inverter] }", twice, CYCLES);
    assert!(
        ran.text
            .contains("the gearbox has a machine: its losses would be counted twice"),
        "{}",
        ran.text
    );
}

#[test]
fn the_unit_of_a_gearbox_without_a_machine_is_refused() {
    let study = "gearloss: study/1
gearboxes: { box: box.yaml }
grids: { g: { torque: 10 Nm, speed: 1000 rpm } }
analyses: { m: { type: map, grid: g, of: unit } }
";
    let ran = run_texts(study, &[("box.yaml", STAGE)]);
    assert!(
        ran.text.contains("E0542") && ran.text.contains("analyses.m.of"),
        "{}",
        ran.text
    );
    let limited = study.replace(
        "analyses: { m: { type: map, grid: g, of: unit } }",
        "analyses: { m: { type: map, grid: g } }\nlimits: { l: { quantity: unit_loss, most: 1 kW } }",
    );
    let ran = run_texts(&limited, &[("box.yaml", STAGE)]);
    assert!(
        ran.text.contains("E0542") && ran.text.contains("limits.l"),
        "{}",
        ran.text
    );
}

#[test]
fn bearings_of_the_rotor_are_counted_once() {
    let study = "gearloss: study/1
gearboxes: { box: box.yaml }
grids: { g: { torque: 10 Nm, speed: 1000 rpm } }
analyses: { m: { type: map, grid: g } }
";
    let lossy = STAGE.replace("bearing: none", "bearing: { type: skf }");
    let gearbox = format!("{lossy}\nmachines: {{ motor: {{ map: map.csv, contains: [inverter, bearings] }} }}\n");
    let map = synthetic();
    let ran = run_texts(study, &[("box.yaml", &gearbox), ("map.csv", &map)]);
    assert!(
        ran.text
            .contains("the map contains the bearings of the rotor, and `bearings.B1` on its shaft has a loss as well"),
        "{}",
        ran.text
    );
    // Those of the other shaft are not the rotor's.
    assert!(!ran.text.contains("bearings.B3"), "{}", ran.text);
}

/// A study of the stage with points measured at a factor of 1.1 on the loss of its mesh.
fn rows_together(analysis: &str) -> Ran {
    let mut measured = "torque [Nm],speed [rpm],loss [W]\n".to_owned();
    for (torque, speed) in [(10.0, 1000.0), (20.0, 2000.0), (40.0, 1500.0), (30.0, 500.0)] {
        let power = torque * speed * std::f64::consts::PI / 30.0;
        measured.push_str(&format!("{torque},{speed},{}\n", 1.1 * 0.03 * power));
    }
    let study = format!(
        "gearloss: study/1
gearboxes: {{ box: box.yaml }}
conditions: {{ oil_temperature: 60 degC }}
measurements: {{ rig: {{ file: rig.csv, stated_as: standard, accuracies: {{ loss: {{ percent_of_reading: 1 }} }} }} }}
grids: {{ g: {{ torque: 10 Nm, speed: 1000 rpm }} }}
analyses:
  a: {analysis}
"
    );
    run_texts(&study, &[("box.yaml", STAGE), ("rig.csv", &measured)])
}

#[test]
fn paths_move_together_along_rows_in_bands_and_fits() {
    let rows =
        "paths: [meshes.stage.loss_factor, lubricants.oil.viscosity.kv40], values: [[0.5, 30 mm2/s], [1.5, 60 mm2/s]]";
    let ran = rows_together(&format!(
        "{{ type: uncertainty, grid: g, inputs: [{{ {rows} }}], samples: 16, write: [json] }}"
    ));
    assert!(ran.succeeded, "{}", ran.text);
    let band = &ran.json("a")["bands"][0];
    assert_eq!(
        band["inputs"][0]["paths"],
        serde_json::json!(["meshes.stage.loss_factor", "lubricants.oil.viscosity.kv40"])
    );
    let loss = &band["points"][0]["loss_w"];
    let (nominal, low) = (number(&loss["nominal"]), number(&loss["band"][0]));
    assert!(low > 0.5 * nominal && low < 0.6 * nominal, "{loss}");
    // Numbers of teeth take the nearest row: all samples can be built.
    let teeth = "paths: [gears.pinion.z, gears.wheel.z], values: [[20, 180], [25, 175], [30, 170]]";
    let ran = rows_together(&format!(
        "{{ type: uncertainty, grid: g, inputs: [{{ {teeth} }}], samples: 16, write: [json] }}"
    ));
    assert!(ran.succeeded, "{}", ran.text);
    assert_eq!(ran.json("a")["bands"][0]["failed"], 0);
    let fit = |rows: &str| {
        rows_together(&format!(
            "{{ type: identify, data: rig, residuals: [loss], parameters: {{ lot: {{ {rows} }} }}, write: [json] }}"
        ))
    };
    let ran = fit(rows);
    assert!(ran.succeeded, "{}", ran.text);
    let found = ran.json("a").to_string();
    let parameter = &ran.json("a")["identifications"][0]["parameters"][0];
    assert!((number(&parameter["value"]) - 1.1).abs() < 1e-6, "{found}");
    for (rows, words) in [
        ("paths: [meshes.stage.loss_factor]", "there is only one path"),
        (
            "paths: [meshes.stage.loss_factor, lubricants.oil.viscosity.kv40], values: [[0.5, 30 mm2/s]]",
            "two rows of values are needed",
        ),
        (
            "paths: [meshes.stage.loss_factor, lubricants.oil.viscosity.kv40], values: [[0.5, 30 mm2/s], [0.5, 60 mm2/s]]",
            "do not increase",
        ),
        (
            "paths: [meshes.stage.loss_factor, lubricants.oil.viscosity.kv40], values: [[0.5, 30 mm2/s], [1.5]]",
            "a list of 2 values is needed",
        ),
        (
            "path: meshes.stage.loss_factor, paths: [meshes.stage.loss_factor, lubricants.oil.viscosity.kv40]",
            "both `path` and `paths`",
        ),
        ("from: 1, to: 2", "no path is stated"),
    ] {
        let ran = fit(rows);
        assert!(!ran.succeeded && ran.text.contains(words), "{rows}: {}", ran.text);
    }
}

/// Study and gearbox of three intervals of the stage with a thermal network, whose coolant the inverter may heat.
fn network(inverter: &str, more: &str) -> [String; 2] {
    let study = format!(
        "gearloss: study/1
gearboxes: {{ box: box.yaml }}
cycles: {{ three: {{ file: three.csv, repeat: 20 }} }}
vehicles:
  car:
    mass: 1500 kg
    coast_down: {{ a: 100 N, b: 0 N s/m, c: 0.4 N s2/m2 }}
    tyre_radius: 300 mm
    rotating_mass_factor: 1.05
{REGENERATION}
    battery: {{ energy: 60 kWh, efficiency: 0.96, auxiliaries: 300 W }}
analyses: {{ c: {{ type: cycle, cycles: [three], start: 20 degC, step: 2 s, write: [json]{more} }} }}
"
    );
    let gearbox = format!(
        "{STAGE}
machines: {{ motor: {{ efficiency: 0.92, rotor: rotor, stator: windings, inverter: {{ efficiency: 0.98{inverter} }} }} }}
thermal:
  mode: network
  ambient: 20 degC
  network:
    nodes:
      casing: {{ heat_capacity: 20000 J/K, gears: [pinion, wheel] }}
      sump: {{ heat_capacity: 3000 J/K, oil: true }}
      rotor: {{ heat_capacity: 2000 J/K }}
      windings: {{ heat_capacity: 8000 J/K }}
      coolant: {{ heat_capacity: 1500 J/K }}
    links:
      air: {{ between: [casing, ambient], conductance: 10 W/K }}
      oil: {{ between: [casing, sump], conductance: 50 W/K }}
      gap: {{ between: [rotor, windings], conductance: 5 W/K }}
      seat: {{ between: [windings, casing], conductance: 80 W/K }}
      plate: {{ between: [coolant, ambient], conductance: 40 W/K }}
"
    );
    [study, gearbox]
}

fn in_a_network(inverter: &str) -> Value {
    let [study, gearbox] = network(inverter, "");
    let ran = run_texts(&study, &[("box.yaml", &gearbox), ("three.csv", CYCLE)]);
    assert!(ran.succeeded, "{}", ran.text);
    ran.json("c")["cycles"][0].clone()
}

/// An FMU of the network has no heat of an inverter: `check` says so before anything runs.
#[test]
fn a_network_with_the_heat_of_an_inverter_is_not_exported() {
    for (inverter, is_refused) in [(", node: coolant", true), ("", false)] {
        let [study, gearbox] = network(inverter, ", export: [fmu3]");
        let found = check_texts(&study, &[("box.yaml", &gearbox), ("three.csv", CYCLE)]);
        let says = [
            "analyses.c.export",
            "`machines.motor` heats a node",
            "delete `inverter.node`",
        ];
        assert!(says.iter().all(|words| found.contains(words) == is_refused), "{found}");
    }
}

/// The heat of an inverter enters its node once: the balance closes with it, and what the battery supplies does not change.
#[test]
fn an_inverter_heats_its_node_and_is_counted_once() {
    let (without, with) = (in_a_network(""), in_a_network(", node: coolant"));
    let inverter = number(&with["machines"][0]["inverter_j"]);
    assert!(inverter > 1e4, "{inverter}");
    let heat = |duty: &Value, key: &str| number(&duty["heat"][key]);
    for duty in [&without, &with] {
        assert!(heat(duty, "residual_share") < 1e-9, "{}", duty["heat"]);
        let consumption = &duty["consumption"];
        assert!(number(&consumption["residual_share"]) < 1e-9, "{consumption}");
        assert!(number(&consumption["interval_residual_share"]) < 1e-9, "{consumption}");
        // Losses of gearbox and machine are heat in both; those of the inverter only with a node.
        let own = number(&duty["energy"]["loss_j"]) + number(&duty["machines"][0]["loss_j"]);
        let expected = own + if duty == &with { inverter } else { 0.0 };
        assert!((heat(duty, "came_j") / expected - 1.0).abs() < 1e-9, "{}", duty["heat"]);
    }
    assert_eq!(with["consumption"], without["consumption"]);
    let coolant = |duty: &Value| {
        let nodes = duty["nodes"].as_array().unwrap();
        let node = nodes.iter().find(|node| node["node"] == "coolant").unwrap();
        number(&node["greatest_degc"])
    };
    assert!(
        (coolant(&without) - 20.0).abs() < 1e-9 && coolant(&with) > 21.0,
        "{}",
        with["nodes"]
    );
}

#[test]
fn the_node_of_an_inverter_must_exist() {
    let machine = "{ efficiency: 0.92, inverter: { efficiency: 0.98, node: coolnt } }";
    let ran = unit(machine, REGENERATION, CYCLES);
    assert!(!ran.succeeded);
    assert!(
        ran.text.contains("machines.motor.inverter.node") && ran.text.contains("coolnt"),
        "{}",
        ran.text
    );
}

/// `check` compares what points demand of a machine with its map and its envelope: at the port of the torque, and through the gears without
/// their losses.
#[test]
fn points_beyond_a_map_or_an_envelope_are_found_before_anything_is_solved() {
    let found = |conditions: &str, grid: &str, machine: &str, analysis: &str| {
        let study = format!(
            "gearloss: study/1
gearboxes: {{ box: box.yaml }}
conditions: {{ oil_temperature: 60 degC{conditions} }}
grids: {{ g: {{ {grid} }} }}
analyses: {{ m: {{ {analysis}, grid: g }} }}
"
        );
        let gearbox = format!("{STAGE}\nmachines: {{ motor: {{ map: map.csv, contains: [inverter]{machine} }} }}\n");
        check_texts(&study, &[("box.yaml", &gearbox), ("map.csv", &synthetic())])
    };
    let map = "type: map";
    // The map reaches 100 Nm and 5000 rpm.
    let beyond = found(
        "",
        "torque: [50 Nm, 100 Nm, 130 Nm], speed: [3000 rpm, 5000 rpm, 6000 rpm]",
        "",
        map,
    );
    let says = [
        "W0543",
        "analyses.m",
        "`machines.motor` is outside its map at 5 points, farthest with 130.0 Nm at 6000 rpm, 30.0 Nm above its largest torque there, 1000 rpm above its largest speed",
    ];
    assert!(says.iter().all(|words| beyond.contains(words)), "{beyond}");
    assert!(
        !beyond.contains("envelope at") && !beyond.contains("without the losses"),
        "{beyond}"
    );
    let inside = found("", "torque: [-100 Nm, 100 Nm], speed: [0 rpm, 5000 rpm]", "", map);
    assert_eq!(inside, "");
    // 10 kW at 3000 rpm are 31.83 Nm.
    let envelope = ", envelope: { peak: { torque: 60 Nm, power: 10 kW } }";
    let limited = found(
        "",
        "torque: [-40 Nm, 20 Nm, 40 Nm], speed: [1000 rpm, 3000 rpm]",
        envelope,
        map,
    );
    let says = "`machines.motor` is beyond its envelope at 2 points, farthest with -40.0 Nm at 3000 rpm, 8.2 Nm above its largest torque there";
    assert!(
        limited.contains(says) && !limited.contains("outside its map"),
        "{limited}"
    );
    // 1080 Nm at the output are 120 Nm at the machine by the ratio of 9, whatever the teeth lose.
    let output = ", torque_at: output, speed_at: output";
    let through = found(output, "torque: [-1080 Nm, -450 Nm], speed: [300 rpm]", "", map);
    let says = [
        "`machines.motor` is outside its map at 1 point, farthest with -120.0 Nm at -2700 rpm, 20.0 Nm above",
        "without the losses of the gearbox",
    ];
    assert!(says.iter().all(|words| through.contains(words)), "{through}");
    // Any analysis of points.
    let other = found(
        "",
        "torque: [130 Nm], speed: [3000 rpm]",
        "",
        "type: uncertainty, samples: 8, inputs: [{ path: meshes.stage.loss_factor, from: 0.8, to: 1.2 }]",
    );
    assert!(other.contains("is outside its map at 1 point"), "{other}");
    // A machine that turns with its inverter off needs no map.
    let idle = ", idle: \"off\", freewheel: [{ speed: 0 rpm, loss: 0 W }, { speed: 9000 rpm, loss: 90 W }]";
    assert_eq!(found("", "torque: [0 Nm], speed: [6000 rpm]", idle, map), "");
}

/// Model sets are solved at the same points, which count once.
#[test]
fn points_beyond_a_map_count_once_for_all_model_sets() {
    let study = "gearloss: study/1
gearboxes: { box: box.yaml }
conditions: { oil_temperature: 60 degC }
model_sets: { a: { set: { meshes.stage.loss_factor: 1 } }, b: { set: { meshes.stage.loss_factor: 2 } } }
grids: { g: { torque: [50 Nm, 100 Nm, 130 Nm], speed: [3000 rpm, 5000 rpm, 6000 rpm] } }
analyses: { m: { type: map, model_sets: [a, b], grid: g } }
";
    let gearbox = format!("{STAGE}\nmachines: {{ motor: {{ map: map.csv, contains: [inverter] }} }}\n");
    let found = check_texts(study, &[("box.yaml", &gearbox), ("map.csv", &synthetic())]);
    assert!(found.contains("is outside its map at 5 points"), "{found}");
    assert_eq!(found.matches("W0543").count(), 1, "{found}");
}

/// A belt with the ratios 4 and 1 to the same output.
const TWO_SPEEDS: &str = "
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
    ratios: { low: 4, high: 1 }
    model: { type: formula, formula: \"50 + 0.002 * torque * abs(speed)\" }
gear_states: { low: [], high: [] }
lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }
machines: { motor: { map: map.csv, contains: [inverter] } }
";

/// Where a gear is chosen at each point, the point is beyond the map if it is in every gear.
#[test]
fn a_point_is_beyond_a_map_if_it_is_in_every_gear() {
    let found = |gear: &str, torque: &str, speed: &str| {
        let study = format!(
            "gearloss: study/1
gearboxes: {{ box: box.yaml }}
conditions: {{ oil_temperature: 60 degC, torque_at: output, speed_at: output }}
grids: {{ g: {{ gear: {gear}, torque: [{torque}], speed: [{speed}] }} }}
analyses: {{ m: {{ type: map, grid: g }} }}
"
        );
        check_texts(&study, &[("box.yaml", TWO_SPEEDS), ("map.csv", &synthetic())])
    };
    // 200 Nm are too much in the high gear, 2000 rpm too fast in the low one.
    for (torque, speed, beyond) in [("-200 Nm", "500 rpm", "high"), ("-40 Nm", "2000 rpm", "low")] {
        let alone = found(beyond, torque, speed);
        assert!(alone.contains("is outside its map at 1 point"), "{alone}");
        let best = found("best", torque, speed);
        assert!(!best.contains("outside its map"), "{best}");
    }
    // In the low gear 125 Nm at 2000 rpm, in the high one 500 Nm at 500 rpm.
    let both = found("best", "-500 Nm", "500 rpm");
    let says = "`machines.motor` is outside its map at 1 point, farthest with 125.0 Nm at 2000 rpm, 25.0 Nm above its largest torque there";
    assert!(both.contains(says), "{both}");
    assert_eq!(both.matches("W0543").count(), 1, "{both}");
}

/// Where the oil reaches a temperature the unit is known as well.
#[test]
fn a_thermal_limit_states_the_unit() {
    let study = "gearloss: study/1
gearboxes: { box: box.yaml }
analyses:
  limit: { type: thermal_limit, temperature: [60 degC], torque: { from: 1 Nm, to: 41 Nm, step: 10 Nm }, speed: [3000 rpm], write: [json, csv] }
  settled: { type: balance, torque: 20 Nm, speed: 3000 rpm, write: [json, csv] }
";
    let gearbox = format!(
        "{STAGE}
machines: {{ motor: {{ efficiency: 0.92, inverter: {{ efficiency: 0.98 }} }} }}
thermal:
  mode: balance
  ambient: 20 degC
  heat_dissipation: {{ air: {{ type: constant, alpha: 20 W/(m2 K), area: 2000 cm2 }} }}
"
    );
    let ran = run_texts(study, &[("box.yaml", &gearbox)]);
    assert!(ran.succeeded, "{}", ran.text);
    let limit = ran.json("limit")["thermal_limits"][0]["limits"][0].clone();
    // 4 W/K take 160 W, 3 % of the power of the shaft.
    let torque = number(&limit["torque_nm"]);
    let power = torque * 3000.0 * std::f64::consts::PI / 30.0;
    assert!((0.03 * power / 160.0 - 1.0).abs() < 1e-3, "{limit}");
    close(&limit["unit"]["dc_power_w"], power / 0.92 / 0.98);
    close(&limit["unit"]["system_efficiency"], 0.97 * 0.92 * 0.98);
    assert!(ran.csv("limit").lines().next().unwrap().contains("system_efficiency"));
    assert!(ran.text.contains("DC power W"), "{}", ran.text);
    let settled = ran.json("settled")["balances"][0].clone();
    let power = 20.0 * 3000.0 * std::f64::consts::PI / 30.0;
    close(&settled["unit"]["dc_power_w"], power / 0.92 / 0.98);
    close(&settled["unit"]["system_efficiency"], 0.97 * 0.92 * 0.98);
    assert!(
        ran.csv("settled-unit")
            .starts_with("model_set,oil_temperature_degc,dc_power_w")
    );
    assert!(ran.text.contains("drive unit: DC power 6968.9 W"), "{}", ran.text);
}
