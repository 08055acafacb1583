//! Energy of a vehicle over cycles: consumption, recuperation, range.

use serde_json::Value;

use crate::common::study::{Ran, number, of_gearbox, run_texts};

const VEHICLE: &str = "
  car:
    mass: 1600 kg
    drag_area: 0.6 m2
    rolling_resistance: 0.01
    tyre_radius: 330 mm
    regeneration: { torque: 300 Nm, power: 100 kW }
";

/// A cycle of a vehicle with the drive unit at 40 degC, and more keys of the vehicle.
fn ridden(vehicle: &str, speeds: &str, more: &str) -> Ran {
    let study = format!(
        "cycles: {{ own: {{ file: own.csv }} }}\nvehicles:{VEHICLE}{vehicle}\nanalyses:\n  c: {{ type: cycle, cycles: [own], write: [json] }}\n{more}"
    );
    let gearbox = "examples/electric-drive-unit/gearbox-40.yaml";
    let map = "speed [rpm],torque [Nm],loss [W]\n0,0,1000\n0,400,1000\n20000,0,1000\n20000,400,1000\n";
    run_texts(&of_gearbox(gearbox, &study), &[("own.csv", speeds), ("map.csv", map)])
}

#[test]
fn consumption_is_the_energy_of_shaft_motor_and_auxiliaries_through_the_battery() {
    let steady = "time [s],vehicle_speed [m/s]\n0,20\n50,20\n100,20\n";
    let battery = "    battery: { energy: 50 kWh, efficiency: 0.8, auxiliaries: 500 W }\n    motor_map: map.csv\n";
    let ran = ridden(battery, steady, "");
    let duty = ran.json("c")["cycles"][0].clone();
    let consumption = &duty["consumption"];
    let input = number(&duty["energy"]["input_j"]);
    // 100 s at 20 m/s are 2 km; a constant loss of 1 kW in the motor.
    let drawn = (input + 1.5e3 * 100.0) / 0.8;
    let near = |value: &Value, expected: f64| {
        let value = number(value);
        assert!((value / expected - 1.0).abs() < 1e-9, "{value} is not {expected}");
    };
    near(&consumption["drawn_kwh_per_100_km"], drawn / 3.6e6 * 50.0);
    near(&consumption["consumption_kwh_per_100_km"], drawn / 3.6e6 * 50.0);
    assert_eq!(number(&consumption["recuperated_kwh_per_100_km"]), 0.0);
    assert_eq!(consumption["includes_motor"], true);
    near(&consumption["range_km"], 50.0 * 3.6e6 / drawn * 2.0);
    let without = (input - number(&duty["energy"]["loss_j"]) + 1.5e3 * 100.0) / 0.8;
    near(
        &consumption["range_lost_in_transmission_km"],
        50.0 * 3.6e6 * 2.0 * (1.0 / without - 1.0 / drawn),
    );
}

#[test]
fn recuperation_is_apart_and_charges_with_its_own_efficiency() {
    let braking = "time [s],vehicle_speed [m/s]\n0,20\n10,20\n20,15\n";
    let battery = "    battery: { energy: 50 kWh, efficiency: 0.8, charge_efficiency: 0.5 }\n";
    let duty = ridden(battery, braking, "").json("c")["cycles"][0].clone();
    let series = ridden(battery, braking, "").csv("c");
    let rows: Vec<Vec<&str>> = series.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|known| *known == name).unwrap();
    let cell = |row: usize, name: &str| rows[row][column(name)].parse::<f64>().unwrap();
    let shaft = |row: usize| {
        cell(row, "torque_nm") * cell(row, "speed_rpm") * std::f64::consts::PI / 30.0 * cell(row, "duration_s")
    };
    let distance: f64 = (1..=2)
        .map(|row| cell(row, "vehicle_speed_m_s") * cell(row, "duration_s"))
        .sum();
    let per = |joule: f64| joule / distance / 36.0;
    let consumption = &duty["consumption"];
    assert!(shaft(1) > 0.0 && shaft(2) < 0.0);
    for (value, expected) in [
        (&consumption["drawn_kwh_per_100_km"], per(shaft(1) / 0.8)),
        (&consumption["recuperated_kwh_per_100_km"], per(-shaft(2) * 0.5)),
    ] {
        assert!(
            (number(value) / expected - 1.0).abs() < 1e-9,
            "{value} is not {expected}"
        );
    }
    assert_eq!(consumption["includes_motor"], false);
    // More comes back than was drawn: no range.
    assert!(consumption["range_km"].is_null() == (number(&consumption["consumption_kwh_per_100_km"]) <= 0.0));
}

#[test]
fn a_motor_map_needs_a_battery_and_no_second_motor() {
    let speeds = "time [s],vehicle_speed [m/s]\n0,20\n50,20\n100,20\n";
    let alone = ridden("    motor_map: map.csv\n", speeds, "");
    assert!(
        alone.text.contains("a motor without a battery changes no result"),
        "{}",
        alone.text
    );
    let missing = ridden(
        "    battery: { energy: 50 kWh, efficiency: 0.8 }\n    motor_map: none.csv\n",
        speeds,
        "",
    );
    assert!(
        missing.text.contains("vehicles.car.motor_map: cannot read none.csv"),
        "{}",
        missing.text
    );
}
