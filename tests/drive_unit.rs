//! The drive unit as a system: consumption with all its parts, values that move together, and the ratio that uses least.

use serde_json::Value;

use crate::common::study::{Ran, number, run_texts};

/// One stage with ratio 9 whose only loss is a constant efficiency.
pub const STAGE: &str = r#"
gearloss: gearbox/1
ports: { input: fast, output: slow }
shafts: { fast: { axis: [0 mm, 0 mm] }, slow: { axis: [100 mm, 0 mm] } }
gears:
  pinion: { shaft: fast, at: 30 mm, z: 20, facewidth: 20 mm }
  wheel: { shaft: slow, at: 30 mm, z: 180, facewidth: 20 mm }
meshes: { stage: { gears: [pinion, wheel], normal_module: 1 mm, centre_distance: 100 mm } }
bearings:
  B1: { shaft: fast, at: 0 mm, designation: "6204", axial: both }
  B2: { shaft: fast, at: 60 mm, designation: "6204" }
  B3: { shaft: slow, at: 0 mm, designation: "6204", axial: both }
  B4: { shaft: slow, at: 60 mm, designation: "6204" }
lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }
models: { gear_mesh: { type: efficiency, value: 0.97 }, bearing: none }
"#;

/// The vehicle of the three intervals, and its cycle: 0 to 10 m/s, 10 m/s, 10 to 0 m/s, 10 s each.
fn three_intervals(more: &str) -> Value {
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
    motor_map: map.csv
{more}
analyses: {{ c: {{ type: cycle, cycles: [three], write: [json, csv] }} }}
"
    );
    // The losses of a constant efficiency are linear in torque and speed, so that a map of four corners is exact.
    let map = |efficiency: f64| {
        let mut rows = "speed [rpm],torque [Nm],loss [W]\n".to_owned();
        for (speed, torque) in [0.0, 6000.0]
            .into_iter()
            .flat_map(|speed| [-100.0, 0.0, 100.0].map(|torque| (speed, torque)))
        {
            let power = torque * speed * std::f64::consts::PI / 30.0;
            let loss = if power < 0.0 {
                -power * (1.0 - efficiency)
            } else {
                power * (1.0 / efficiency - 1.0)
            };
            rows.push_str(&format!("{speed},{torque},{}\n", loss.abs()));
        }
        rows
    };
    let efficiency = if more.contains("# with inverter") {
        0.92 * 0.98
    } else {
        0.92
    };
    let files = [
        ("box.yaml", STAGE.to_owned()),
        (
            "three.csv",
            "time [s],vehicle_speed [m/s]\n0,0\n10,10\n20,10\n30,0\n".to_owned(),
        ),
        ("map.csv", map(efficiency)),
    ];
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let ran = run_texts(&study, &files);
    assert!(ran.succeeded, "{}", ran.text);
    ran.json("c")["cycles"][0]["consumption"].clone()
}

const REGENERATION: &str = "    regeneration: { torque: 40 Nm, power: 1000 kW }";

/// Energies of three intervals, by hand: F = m k a + a + c v2, the losses one after the other.
#[test]
fn three_intervals_have_the_energies_of_the_hand_calculation() {
    let ideal = "    battery: { energy: 60 kWh, efficiency: 1, auxiliaries: 300 W }";
    let lossy = "    battery: { energy: 60 kWh, efficiency: 0.96, auxiliaries: 300 W }";
    let cases = [
        (
            format!("{REGENERATION}\n{ideal}"),
            [16.124_495_741_8, 7.25, 8.874_495_741_82, 676.094_752_26],
        ),
        (
            format!("{REGENERATION}\n{ideal} # with inverter"),
            [16.436_560_280_8, 7.096_666_666_67, 9.339_893_614_1, 642.405_604_165],
        ),
        (
            format!("{REGENERATION}\n{lossy} # with inverter"),
            [17.121_416_959_1, 6.8128, 10.308_616_959_1, 582.037_340_585],
        ),
        (
            format!("    regeneration: none\n{lossy} # with inverter"),
            [17.555_444_736_9, 0.0, 17.555_444_736_9, 341.774_309_333],
        ),
    ];
    for (vehicle, expected) in cases {
        let found = three_intervals(&vehicle);
        let keys = [
            "drawn_kwh_per_100_km",
            "recuperated_kwh_per_100_km",
            "consumption_kwh_per_100_km",
            "range_km",
        ];
        for (key, expected) in keys.iter().zip(expected) {
            let value = number(&found[*key]);
            assert!(
                (value - expected).abs() <= 1e-9 * expected.abs().max(1.0),
                "{key}: {value} is not {expected}"
            );
        }
        let parts = ["wheels", "transmission", "machine", "brakes", "auxiliaries", "battery"];
        let sum: f64 = parts
            .iter()
            .map(|part| number(&found[format!("{part}_kwh_per_100_km")]))
            .sum();
        let consumption = number(&found["consumption_kwh_per_100_km"]);
        assert!((sum - consumption).abs() < 1e-9 * consumption, "{sum} {consumption}");
        assert!(number(&found["residual_share"]) < 1e-9);
    }
}

/// W over 10 s on 200 m, in kWh/100 km.
pub fn per_distance(watts: f64) -> f64 {
    watts * 10.0 / 200.0 / 36.0
}

#[test]
fn every_part_of_the_consumption_is_that_of_the_hand_calculation() {
    let battery = "    battery: { energy: 60 kWh, efficiency: 1, auxiliaries: 300 W }";
    let found = three_intervals(&format!("{REGENERATION}\n{battery}"));
    for (part, watts) in [
        ("wheels", 8425.0 + 1400.0 - 7325.0),
        ("transmission", 260.567_010_309 + 43.298_969_072_2 + 185.567_010_309),
        ("machine", 755.266_696_549 + 125.504_258_18 + 480.0),
        ("brakes", 1_139.432_989_69),
        ("auxiliaries", 900.0),
        ("battery", 0.0),
    ] {
        let value = number(&found[format!("{part}_kwh_per_100_km")]);
        assert!(
            (value - per_distance(watts)).abs() < 1e-9,
            "{part}: {value} is not {}",
            per_distance(watts)
        );
    }
    let electric = 8_685.567_010_31 + 755.266_696_549 + 1_443.298_969_07 + 125.504_258_18;
    let efficiency = number(&found["system_efficiency"]);
    assert!((efficiency - 9825.0 / electric).abs() < 1e-9, "{efficiency}");
    // 5220 W into the battery of 7325 W at the wheels.
    let share = number(&found["recuperated_share"]);
    assert!((share - (6000.0 - 480.0 - 300.0) / 7325.0).abs() < 1e-9, "{share}");
}

/// A fixed efficiency of the vehicle has the same energies.
#[test]
fn a_fixed_efficiency_of_the_vehicle_closes_as_well() {
    let battery = "    efficiency: 0.97\n    battery: { energy: 60 kWh, efficiency: 1, auxiliaries: 300 W }";
    let found = three_intervals(&format!("{REGENERATION}\n{battery}"));
    let consumption = number(&found["consumption_kwh_per_100_km"]);
    assert!((consumption - 8.874_495_741_82).abs() < 1e-9, "{consumption}");
    let brakes = number(&found["brakes_kwh_per_100_km"]);
    assert!((brakes - per_distance(1_139.432_989_69)).abs() < 1e-9, "{brakes}");
    assert!(number(&found["residual_share"]) < 1e-9);
}

/// The drive unit over the WLTC from 40 degC, and analyses.
fn unit(conditions: &str, limits: &str, analyses: &str) -> Ran {
    let study = format!(
        "gearloss: study/1
gearboxes: {{ unit: examples/electric-drive-unit/gearbox.yaml }}
{conditions}
cycles: {{ wltc: {{ shipped: wltc_class3b }} }}
vehicles:
  car:
    mass: 1928 kg
    coast_down: {{ a: 165.34 N, b: 0.46767 N s/m, c: 0.32052 N s2/m2 }}
    tyre_radius: 335.7 mm
    regeneration: {{ torque: 350 Nm, power: 190 kW }}
    battery: {{ energy: 60 kWh, efficiency: 0.96, auxiliaries: 300 W }}
{limits}
analyses:
{analyses}
"
    );
    let root = env!("CARGO_MANIFEST_DIR");
    run_texts(&study.replace("examples/", &format!("{root}/examples/")), &[])
}

const RIDE: &str = "cycles: [wltc], start: 40 degC, ambient: 23 degC";

#[test]
fn the_ratio_with_less_loss_in_the_gearbox_uses_more_energy() {
    let variables = "variables: { ratio_2: { paths: [gears.P2.z, gears.W2.z], values: [[24, 83], [36, 71]] } }";
    let analyses = format!(
        "  frugal: {{ type: optimise, {RIDE}, {variables}, minimise: [{{ quantity: consumption, of: wltc }}] }}
  default: {{ type: optimise, {RIDE}, {variables} }}
  lossy: {{ type: optimise, {RIDE}, {variables}, minimise: [wltc] }}"
    );
    let ran = unit("", "", &analyses);
    assert!(ran.succeeded, "{}", ran.text);
    let [frugal, default, lossy] = ["frugal", "default", "lossy"].map(|name| ran.json(name));
    let gain = &lossy["gains"][0];
    for (value, expected) in [(&gain["present_w"], 177.2), (&gain["best_w"], 143.2)] {
        assert!((number(value) - expected).abs() < 0.1, "{value} is not {expected}");
    }
    let consumption = &gain["consumption"];
    let net = |of: &Value| number(&of["consumption_kwh_per_100_km"]);
    assert!(
        net(&consumption["best"]) - net(&consumption["present"]) > 0.15,
        "{consumption}"
    );
    let machine = |of: &Value| number(&of["machine_kwh_per_100_km"]);
    // 956 kJ over 23.27 km are 1.14 kWh/100 km, 1205 kJ 1.44.
    assert!((machine(&consumption["present"]) - 1.141).abs() < 2e-3, "{consumption}");
    assert!((machine(&consumption["best"]) - 1.439).abs() < 2e-3, "{consumption}");
    for outcome in [&frugal, &default] {
        assert_eq!(outcome["variables"][0]["best"], "24/83");
        assert_eq!(outcome["objectives"][0]["quantity"], "consumption");
    }
    assert_eq!(lossy["variables"][0]["best"], "36/71");
    for outcome in [&frugal, &lossy] {
        let disagreement = &outcome["disagreements"][0];
        assert_eq!(disagreement["least_loss"]["values"][0], "36/71");
        assert_eq!(disagreement["least_consumption"]["values"][0], "24/83");
    }
    assert!(
        ran.text.contains("the least loss is not the least consumption"),
        "{}",
        ran.text
    );
    assert!(
        number(&consumption["present"]["residual_share"]) < 1e-9,
        "{consumption}"
    );
}

/// The ratios of a grid with a formula, and of a search with pairs: the same losses to the bit, the same optimum, and the same ratio left
/// out.
#[test]
fn a_grid_and_a_search_over_eight_ratios_have_the_same_optimum() {
    let teeth = [22, 24, 26, 28, 30, 32, 34, 36];
    let pairs: Vec<String> = teeth.iter().map(|z| format!("[{z}, {}]", 107 - z)).collect();
    let singles: Vec<String> = teeth.iter().map(ToString::to_string).collect();
    let sweep = format!(
        "  grid: {{ type: sweep, path: gears.P2.z, values: [{}], drive: {{ {RIDE} }} }}",
        singles.join(", ")
    );
    let search = format!(
        "  best: {{ type: optimise, {RIDE}, variables: {{ ratio_2: {{ paths: [gears.P2.z, gears.W2.z], values: [{}, [40, 80]] }} }} }}",
        pairs.join(", ")
    );
    let swept = unit(
        "conditions: { follows: { gears.W2.z: \"107 - gears.P2.z\" } }",
        "",
        &sweep,
    );
    let searched = unit("", "limits: { far: { quantity: range, least: 400 km } }", &search);
    assert!(
        swept.succeeded && searched.succeeded,
        "{} {}",
        swept.text,
        searched.text
    );
    let (grid, best) = (swept.json("grid"), searched.json("best"));
    let values = grid["cycles"].as_array().unwrap();
    assert_eq!(values.len(), 8);
    let net = |value: &&Value| number(&value["consumption"]["consumption_kwh_per_100_km"]);
    let least = values.iter().min_by(|a, b| net(a).total_cmp(&net(b))).unwrap();
    let z = number(&least["value"]);
    assert_eq!(best["variables"][0]["best"], format!("{z}/{}", 107.0 - z));
    assert_eq!(number(&best["objectives"][0]["best"]), net(&least));
    assert_eq!(best["exhaustive"], true);
    // Teeth that do not fit the centre distance are counted with their reason.
    assert_eq!(number(&best["failed"]), 1.0);
    let reason = best["failures"][0]["reason"].as_str().unwrap();
    assert!(reason.contains("centre distance"), "{reason}");
    assert_eq!(best["limits"][0]["unit"], "km");
    assert!(number(&best["limits"][0]["best"]) > 400.0);
}

#[test]
fn combinations_that_cannot_be_built_are_left_out_with_their_reason() {
    let sweep = |values: &str| {
        format!(
            "  ratios: {{ type: sweep, paths: [gears.P2.z, gears.W2.z], values: {values}, torque: 60 Nm, speed: 6000 rpm,
    second: {{ path: thermal.oil, values: [40 degC, 60 degC] }} }}"
        )
    };
    let fixed = "conditions: { set: { thermal.mode: fixed } }";
    let ran = unit(fixed, "", &sweep("[[24, 83], [40, 80], [30, 77]]"));
    assert!(ran.succeeded, "{}", ran.text);
    let outcome = ran.json("ratios");
    assert_eq!(outcome["sweep"].as_array().unwrap().len(), 4);
    let left_out = outcome["left_out"].as_array().unwrap();
    assert_eq!(left_out.len(), 2);
    assert!(
        left_out[0]["values"].as_str().unwrap().contains("40/80"),
        "{left_out:?}"
    );
    assert!(
        ran.text.contains("left out: gears.P2.z, gears.W2.z 40/80"),
        "{}",
        ran.text
    );
    let none = unit(fixed, "", &sweep("[[40, 80], [41, 80]]"));
    assert!(
        !none.succeeded && none.text.contains("centre distance"),
        "{}",
        none.text
    );
}

/// Four roughnesses that follow one are the same as a pattern: over a grid with uncertain inputs, and in a fit.
#[test]
fn followers_move_with_uncertain_inputs() {
    let analyses = |path: &str| {
        format!(
            "  bands: {{ type: uncertainty, grid: g, inputs: [{{ path: \"{path}\", from: 0.1 um, to: 0.3 um }}], samples: 8 }}"
        )
    };
    let grid = "grids: { g: { torque: 60 Nm, speed: 6000 rpm } }";
    let follows = "conditions: { oil_temperature: 40 degC, follows: { gears.W1.surface.rq: gears.P1.surface.rq, gears.P2.surface.rq: gears.P1.surface.rq, \
                   gears.W2.surface.rq: gears.P1.surface.rq } }";
    let together = unit(
        "conditions: { oil_temperature: 40 degC }",
        grid,
        &analyses("gears.*.surface.rq"),
    );
    let following = unit(follows, grid, &analyses("gears.P1.surface.rq"));
    assert!(
        together.succeeded && following.succeeded,
        "{} {}",
        together.text,
        following.text
    );
    let band = |ran: &Ran| -> Vec<f64> {
        let point = ran.json("bands")["bands"][0]["points"][0]["loss_w"]["band"].clone();
        point.as_array().unwrap().iter().map(number).collect()
    };
    let (a, b) = (band(&together), band(&following));
    assert!(a[2] > a[0] * 1.001, "{a:?}");
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() < 1e-9 * a, "{a} {b}");
    }
}

/// Moments of inertia are the factor that follows from them.
#[test]
fn moments_of_inertia_are_a_factor_of_the_mass() {
    let ran = |more: &str| {
        let study = format!(
            "gearloss: study/1
gearboxes: {{ box: box.yaml }}
conditions: {{ oil_temperature: 60 degC }}
cycles: {{ three: {{ file: three.csv }} }}
vehicles:
  car: {{ mass: 1500 kg, coast_down: {{ a: 100 N, b: 0 N s/m, c: 0.4 N s2/m2 }}, tyre_radius: 300 mm, regeneration: none, {more} }}
analyses: {{ c: {{ type: cycle, cycles: [three], write: [json] }} }}
"
        );
        let cycle = "time [s],vehicle_speed [m/s]\n0,0\n10,10\n20,10\n30,0\n";
        run_texts(&study, &[("box.yaml", STAGE), ("three.csv", cycle)])
    };
    // k = 1 + (3.6 + 0.04 * 81 + 0.16 * 1) / (1500 * 0.09)
    let factor = 1.0 + 7.0 / 135.0;
    let inertia = ran("inertia: { wheels: 3.6 kg m2, rotor: 400 kg cm2, shafts: { slow: { inertia: 0.16 kg m2 } } }");
    let fixed = ran(&format!("rotating_mass_factor: {factor}"));
    let loss = |ran: &Ran| number(&ran.json("c")["cycles"][0]["mean_loss_w"]);
    let (a, b) = (loss(&inertia), loss(&fixed));
    assert!((a - b).abs() < 1e-9 * b, "{a} {b}");
    let unknown = ran("inertia: { wheels: 3.6 kg m2, rotor: 0 kg m2, shafts: { layshaft: { inertia: 1 kg m2 } } }");
    assert!(
        !unknown.succeeded && unknown.text.contains("layshaft"),
        "{}",
        unknown.text
    );
    let both = ran("rotating_mass_factor: 1.04, inertia: { wheels: 3.6 kg m2, rotor: 0 kg m2 }");
    assert!(
        !both.succeeded && both.text.contains("both `rotating_mass_factor` and `inertia`"),
        "{}",
        both.text
    );
}

/// What the keys refuse, each with its place.
#[test]
fn contradictions_are_refused() {
    let variables = |more: &str| format!("  best: {{ type: optimise, {RIDE}, variables: {{ v: {{ {more} }} }} }}");
    let sweep = |more: &str| format!("  best: {{ type: sweep, path: gears.P2.z, values: [24], {more} }}");
    for (conditions, analyses, message) in [
        (
            "conditions: { follows: { gears.W2.z: \"107 - gears.P9.z\" } }",
            sweep("torque: 1 Nm, speed: 1 rpm"),
            "P9",
        ),
        (
            "conditions: { follows: { gears.W2.z: \"107 - \" } }",
            sweep("torque: 1 Nm, speed: 1 rpm"),
            "ends too early",
        ),
        (
            "conditions: { follows: { gears.W2.z: \"107.5 - gears.P2.z\" } }",
            sweep("torque: 1 Nm, speed: 1 rpm"),
            "83.5",
        ),
        (
            "conditions: { follows: { gears.P2.z: \"107 - gears.W2.z\" } }",
            sweep("torque: 1 Nm, speed: 1 rpm"),
            "has no value of its own",
        ),
        ("", sweep("torque: 1 Nm"), "neither points nor cycles"),
        (
            "",
            sweep(&format!("torque: 1 Nm, drive: {{ {RIDE} }}")),
            "points and cycles are stated",
        ),
        ("", variables("paths: [gears.P2.z, gears.W2.z]"), "need `values`"),
        (
            "",
            variables("paths: [gears.P2.z, gears.W2.z], values: [[24, 83], 30]"),
            "a list of 2 values",
        ),
        (
            "",
            variables("path: gears.P2.z, paths: [gears.P2.z, gears.W2.z], values: [[24, 83], [30, 77]]"),
            "both `path` and `paths`",
        ),
        ("", variables("values: [24, 30]"), "no path is stated"),
    ] {
        let ran = unit(conditions, "", &analyses);
        assert!(!ran.succeeded && ran.text.contains(message), "{message}: {}", ran.text);
    }
}
