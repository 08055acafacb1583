//! Losses and temperatures that are known from a calculation by hand.

use serde_json::Value;

use super::{Case, Said};

/// Fails unless both agree to a relative tolerance.
fn close(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value / expected - 1.0).abs() < tolerance,
        "{value} where {expected} is right"
    );
}

/// The number behind a label in a printed text.
fn number_after(said: &Said, label: &str) -> f64 {
    let (_, rest) = said
        .text
        .split_once(label)
        .unwrap_or_else(|| panic!("no `{label}`\n{}", said.text));
    let number = rest.split_whitespace().next().unwrap().trim_end_matches([',', ';']);
    number.parse().unwrap_or_else(|_| panic!("`{number}` after `{label}`"))
}

/// A solved point as its record.
pub(super) fn solved(case: &Case, gearbox: &str, torque: &str, speed: &str) -> Value {
    let said = case.gearloss(&[
        "solve", gearbox, "--torque", torque, "--speed", speed, "--format", "json",
    ]);
    assert_eq!(said.code, Some(0), "{}", said.text);
    // Warnings are printed after the record.
    let mut records = serde_json::Deserializer::from_str(&said.text).into_iter();
    records.next().unwrap().unwrap_or_else(|e| panic!("{e}\n{}", said.text))
}

/// The torque at a port of a solved point. \[Nm\]
fn torque_at(point: &Value, port: &str) -> f64 {
    let ports = point["ports"].as_array().unwrap();
    let found = ports.iter().find(|p| p["port"] == port).unwrap();
    found["torque_nm"].as_f64().unwrap()
}

/// Consumption of a vehicle at a constant torque of its motor, 1000 rpm and 10 m/s. \[kWh/100 km\]
fn consumption(purpose: &str, torque: f64, map: Option<&str>) -> f64 {
    let case = Case::new("motor-map-through-zero-torque", purpose);
    let rows = [0, 10, 20].map(|time| format!("{time},{torque},1000,10\n")).concat();
    case.write(
        "cycle.csv",
        format!("time [s],torque [Nm],speed [rpm],vehicle_speed [m/s]\n{rows}"),
    );
    if let Some(map) = map {
        case.write("map.csv", map);
    }
    let result = case.result("study.yaml", "cycle");
    result["cycles"][0]["consumption"]["consumption_kwh_per_100_km"]
        .as_f64()
        .unwrap()
}

/// The consumption of 20 s at an electric power over 200 m. \[kWh/100 km\]
fn drawn(power: f64) -> f64 {
    power * 20.0 / 3.6e6 / 0.2 * 100.0
}

/// A loss of 100 W and 10 W/Nm, symmetric about 0 Nm: 110 W at 1 Nm in either direction.
#[test]
fn the_loss_of_a_motor_is_continuous_through_zero_torque() {
    let shaft = 1000.0 * std::f64::consts::PI / 30.0;
    let short = "speed [rpm],torque [Nm],loss [W]\n0,-100,1100\n0,0,100\n0,100,1100\n5000,-100,1100\n5000,0,100\n5000,100,1100\n";
    for (name, map) in [("whole", None), ("short", Some(short))] {
        close(
            consumption(&format!("{name}-drive"), 1.0, map),
            drawn(110.0 + shaft),
            1e-9,
        );
        close(
            consumption(&format!("{name}-coast"), -1.0, map),
            drawn(110.0 - shaft),
            1e-9,
        );
    }
}

/// ISO 6336-2 by hand: 680.843 MPa = Z_H Z_E sqrt(F_t/(d b) (u + 1)/u / eps_alpha). At a whole overlap ratio the lines of contact have a
/// constant length, so that both load sharings are the same distribution.
#[test]
fn the_line_load_of_helical_teeth_is_that_of_iso_6336() {
    let case = Case::new("helical-line-load", "pressure");
    let text = std::fs::read_to_string(case.path("contact.json")).unwrap();
    for sharing in ["uniform", "contact_lines"] {
        case.write("contact.json", text.replace("uniform", sharing));
        let said = case.gearloss(&["eval", "rating/flank_contact", "--input", "contact.json"]);
        assert_eq!(said.code, Some(0), "{}", said.text);
        close(number_after(&said, "p_HC = "), 680.843, 2e-6);
    }
}

/// A gear with an efficiency of 0.85 and a ratio of two; in reverse the losses have the same sign.
#[test]
fn an_efficiency_holds_in_drive_in_coast_and_in_reverse() {
    let case = Case::new("constant-efficiency", "directions");
    for (torque, speed, output, loss) in [
        ("10 Nm", "1000 rpm", 17.0, 157.0796),
        ("-10 Nm", "1000 rpm", 23.529_41, 184.7996),
        ("-10 Nm", "-1000 rpm", 17.0, 157.0796),
        ("10 Nm", "-1000 rpm", 23.529_41, 184.7996),
    ] {
        let point = solved(&case, "gearbox.yaml", torque, speed);
        close(torque_at(&point, "output").abs(), output, 1e-6);
        close(point["loss_w"].as_f64().unwrap(), loss, 1e-6);
    }
    // At standstill any torque between those of drive and coast is in balance; the one without friction is shown.
    let still = solved(&case, "gearbox.yaml", "10 Nm", "0 rpm");
    assert_eq!(still["status"], "standstill");
    assert!((17.0..=23.53).contains(&torque_at(&still, "output")), "{still}");
}

/// 4 % of 14.908 kW leave through 20 W/K; 95 degC belong to 1500 W, which are 4 % of 37.5 kW.
#[test]
fn an_overheating_gearbox_has_the_temperature_and_the_limit_of_its_balance() {
    let case = Case::new("overheating", "balance");
    let said = case.gearloss(&["solve", "gearbox.yaml", "--torque", "81.349 Nm", "--speed", "1750 rpm"]);
    let oil = 20.0 + 0.04 * 81.349 * 1750.0 * std::f64::consts::PI / 30.0 / 20.0;
    close(number_after(&said, "oil "), oil, 1e-4);
    let said = case.gearloss(&["run", "study.yaml", "-o", "results"]);
    assert!(said.text.contains("95 °C at 205 Nm"), "{}", said.text);
    let csv = std::fs::read_to_string(case.path("results/lim.csv")).unwrap();
    let row: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
    close(
        row[3].parse().unwrap(),
        37_500.0 / (1750.0 * std::f64::consts::PI / 30.0),
        1e-6,
    );
}

#[test]
fn a_limit_that_is_not_reached_is_said_in_words() {
    let case = Case::new("overheating", "words");
    let study = std::fs::read_to_string(case.path("study.yaml")).unwrap();
    case.write("study.yaml", study.replace("[95 degC]", "[95 degC, 250 degC]"));
    let said = case.gearloss(&["run", "study.yaml", "-o", "results", "--verbose"]);
    assert!(
        said.text
            .contains("95 °C at 205 Nm; 250 °C is not reached in the range of torques"),
        "{}",
        said.text
    );
    assert!(!said.text.contains("not_reached"), "{}", said.text);
}

/// A strain wave gear 80:1 from its data sheet: 0.029 + 0.099 Nm of friction at the motor and 75 % in the teeth.
#[test]
fn a_strain_wave_gear_as_a_pair_has_the_friction_of_its_data_sheet() {
    let case = Case::new("strain-wave-as-pair", "point");
    let point = solved(&case, "gearbox.yaml", "1.128 Nm", "3500 rpm");
    close(torque_at(&point, "output").abs(), 60.0, 1e-9);
    close(point["efficiency"].as_f64().unwrap(), 60.0 / 80.0 / 1.128, 1e-9);
    let speed = 3500.0 * std::f64::consts::PI / 30.0;
    close(point["loss_w"].as_f64().unwrap(), (0.128 + 0.25) * speed, 1e-9);
}

#[test]
fn thrust_that_a_bearing_cannot_carry_is_reported() {
    let case = Case::new("unsuited-bearings", "thrust");
    let said = case.gearloss(&["check", "gearbox.yaml"]);
    assert_eq!(said.code, Some(0), "{}", said.text);
    for words in [
        "warning[W0307]: bearings.A1.axial: `NU208EC` carries no thrust, but `axial: both` assigns thrust to it",
        "help: write `axial: none` here and assign the thrust to a bearing that carries it",
        "warning[W0307]: bearings.B1.axial: `32008X` carries thrust in one direction, but `axial: both` assigns both to it",
        "warning[W0307]: bearings.B2.spring_preload: `needle_cage` carries no thrust, but a spring loads it axially",
    ] {
        assert!(said.text.contains(words), "{words}\n{}", said.text);
    }
    // The help, followed to the letter, leads to no such finding.
    let text = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    let text = text
        .replace("designation: NU208EC, axial: both", "designation: NU208EC, axial: none")
        .replace("designation: \"6208\" }", "designation: \"6208\", axial: both }")
        .replace("32008X, axial: both", "32008X, axial: left")
        .replace(", spring_preload: 100 N", "");
    case.write("gearbox.yaml", text);
    let said = case.gearloss(&["check", "gearbox.yaml"]);
    assert!(!said.text.contains("W0307"), "{}", said.text);
}

#[test]
fn a_thrust_bearing_takes_no_radial_load() {
    let case = Case::new("unsuited-bearings", "radial");
    let text = std::fs::read_to_string(case.path("thrust.yaml")).unwrap();
    // The two radial bearings carry the radial load as if they were alone.
    let load = |text: &str| -> Vec<f64> {
        // Without losses, which would take a part of the torque.
        case.write("gearbox.yaml", text.replace("{ type: iso14179_2 }", "none"));
        let point = solved(&case, "gearbox.yaml", "50 Nm", "1500 rpm");
        let bearings = point["supports"].as_array().unwrap();
        bearings.iter().map(|b| b["radial_n"].as_f64().unwrap()).collect()
    };
    let with = load(&text);
    let alone = load(
        &text
            .lines()
            .filter(|line| !line.starts_with("  T:"))
            .collect::<Vec<_>>()
            .join("\n"),
    );
    assert_eq!(with[..2], alone[..]);
    assert_eq!(with[2], 0.0);
    // Alone beside one radial bearing it supports nothing, which is an error.
    case.write(
        "gearbox.yaml",
        text.lines()
            .filter(|line| !line.starts_with("  A2:"))
            .collect::<Vec<_>>()
            .join("\n"),
    );
    let said = case.gearloss(&["check", "gearbox.yaml"]);
    assert_eq!(said.code, Some(2), "{}", said.text);
    assert!(
        said.text.contains("`a` can tilt or move on its bearings"),
        "{}",
        said.text
    );
    assert!(
        said.text.contains("thrust bearings carry no radial load: bearings.T"),
        "{}",
        said.text
    );
    // Without thrust it has no load at all.
    case.write(
        "gearbox.yaml",
        text.replace(", axial: right, spring_preload: 500 N", ""),
    );
    let said = case.gearloss(&["check", "gearbox.yaml"]);
    assert!(
        said.text
            .contains("`thrust_ball` carries thrust only, but no thrust is assigned to it: it has no load"),
        "{}",
        said.text
    );
}

/// The default diameter of a ball is used under an oil jet only.
#[test]
fn the_lowest_evidence_is_that_of_what_is_used() {
    let case = Case::new("fmu-start-values", "evidence");
    let point = ["solve", "gearbox.yaml", "--torque", "10 Nm", "--speed", "1000 rpm"];
    let said = case.gearloss(&point);
    assert!(said.text.contains("lowest evidence grade: "), "{}", said.text);
    assert!(!said.text.contains("skf.ball"), "{}", said.text);
    let text = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    case.write(
        "gearbox.yaml",
        text.replace("designation:", "lubrication: jet, designation:"),
    );
    let said = case.gearloss(&point);
    assert!(said.text.contains("skf.ball"), "{}", said.text);
}

#[test]
fn a_comparison_over_cycles_shows_the_consumption() {
    let case = Case::new("motor-map-through-zero-torque", "compare");
    case.write(
        "compare.yaml",
        "gearloss: study/1\n\
         gearboxes: { car: gearbox.yaml }\n\
         cycles: { own: { file: cycle.csv, port: input } }\n\
         vehicles: { car: { mass: 1500 kg, drag_area: 0.6 m2, rolling_resistance: 0.01, tyre_radius: 320 mm, regeneration: none, \
         battery: { energy: 50 kWh, efficiency: 1 }, motor_map: map.csv } }\n\
         analyses: { savings: { type: compare, drive: { cycles: [own], vehicle: car }, base: own, write: [json], \
         variants: { lossy: { meshes.stage.model.value: 0.98 } } } }\n",
    );
    let said = case.gearloss(&["run", "compare.yaml", "-o", "results", "--verbose"]);
    assert_eq!(said.code, Some(0), "{}", said.text);
    let result: Value = serde_json::from_slice(&std::fs::read(case.path("results/savings.json")).unwrap()).unwrap();
    let difference = result["comparisons"][0]["consumption_difference_kwh_per_100_km"]
        .as_f64()
        .unwrap();
    let words = format!("minus own: {difference:+.4} kWh/100 km");
    assert!(said.text.contains(&words), "{words}\n{}", said.text);
}
