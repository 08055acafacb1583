#![allow(clippy::unwrap_used)]
//! Entries as a study writes them: the walk turns them into SI.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Deserialize;

use super::*;
use gearloss_framework::document::{Schema, publish, read_yaml, walk};
use gearloss_framework::motor::{MotorEntry, RotorShare};

#[derive(Debug, Deserialize, JsonSchema)]
struct Document {
    cycle: CycleEntry,
    vehicle: Option<VehicleEntry>,
    motor: Option<MotorEntry>,
}

fn read(text: &str) -> Result<Document, Vec<String>> {
    let schema = SchemaSettings::draft07()
        .into_generator()
        .into_root_schema_for::<Document>();
    let schema = Schema::compile(&publish(schema.to_value())).unwrap();
    let read = read_yaml(0, text);
    assert!(read.findings.is_empty(), "{:?}", read.findings);
    let walked = walk(&read.node, &schema);
    if walked.findings.is_empty() {
        Ok(serde_json::from_value(walked.value).unwrap())
    } else {
        Err(walked.findings.iter().map(ToString::to_string).collect())
    }
}

#[test]
fn a_study_states_cycle_vehicle_and_motor_with_units() {
    let document = read(
        "
cycle: { shipped: wltc_class3b, repeat: 2, start: 1 min }
vehicle:
  mass: 1.9 t
  coast_down: { a: 165 N, b: 0.1 N/(km/h), c: 0.32 N s2/m2 }
  tyre_radius: 335.7 mm
  regeneration: { torque: 350, power: 190 kW }
motor: { map: map.csv, rotor: rotor, stator: stator }
",
    )
    .unwrap();
    let CycleEntry::Shipped(cycle) = document.cycle else {
        panic!("{:?}", document.cycle)
    };
    assert_eq!(
        (cycle.shipped.as_str(), cycle.repeat, cycle.start),
        ("wltc_class3b", 2, Some(60.0))
    );
    let car = document.vehicle.unwrap().vehicle("vehicle").unwrap();
    assert_eq!(
        (car.mass, car.tyre_radius, car.rotating_mass_factor),
        (1900.0, 0.3357, 1.04)
    );
    let limits = car.regeneration.unwrap();
    assert_eq!((limits.torque, limits.power, limits.fade_speed), (350.0, 190e3, 2.0));
    let RoadLoad::CoastDown(road) = car.road_load else {
        panic!("{car:?}")
    };
    assert!((road.b - 0.36).abs() < 1e-12);
    let motor = document.motor.unwrap();
    assert_eq!(
        (motor.port.as_str(), motor.rotor_share),
        ("input", RotorShare::One(0.2))
    );
}

#[test]
fn the_other_forms_are_read() {
    let document = read(
        "
cycle:
  file: drive.csv
  columns: { time: t, torque: M, speed: n_in }
  temperatures: { sump: T_oil }
  gap: 10
  most_speed_change: 3000 rpm/s
vehicle:
  mass: 1847 kg
  drag_area: 0.51 m2
  rolling_resistance: 0.0085
  tyre_radius: 335.7
  regeneration: none
motor: { map: map.csv, rotor: rotor, stator: stator, rotor_share: [{ speed: 0, share: 0.1 }, { speed: 30 rpm, share: 0.3 }] }
",
    )
    .unwrap();
    let CycleEntry::File(cycle) = document.cycle else {
        panic!("{:?}", document.cycle)
    };
    assert_eq!(
        (cycle.gap, cycle.most_acceleration, cycle.port.as_str()),
        (Some(10.0), 12.0, "input")
    );
    assert!((cycle.most_speed_change.unwrap() - 100.0 * std::f64::consts::PI).abs() < 1e-9);
    let car = document.vehicle.unwrap().vehicle("vehicle").unwrap();
    assert_eq!(car.regeneration, None);
    let share = document.motor.unwrap().rotor_share;
    assert!((share.share_at(0.5 * std::f64::consts::PI).unwrap() - 0.2).abs() < 1e-12);
    let document = read("cycle: { spectrum: [{ torque: 1 Nm, speed: 30 rpm, share: 1 }] }").unwrap();
    let CycleEntry::Spectrum(entry) = document.cycle else {
        panic!("{:?}", document.cycle)
    };
    let Spectrum::Loads(loads) = entry.spectrum else {
        panic!("a file")
    };
    assert!((loads[0].speed - std::f64::consts::PI).abs() < 1e-12);
    assert_eq!(entry.duration, 3600.0);
    let document = read("cycle: { spectrum: { file: loads.csv } }").unwrap();
    assert!(matches!(document.cycle, CycleEntry::Spectrum(_)));
}

#[test]
fn keys_that_mean_nothing_are_refused() {
    let found = read("cycle: { shipped: nycc, gap: 3 s }").unwrap_err();
    assert!(found[0].starts_with("cycle.gap"), "{found:?}");
}
