//! Efficiency over speed of one transmission with several model sets, and with less oil. Points run in parallel, with one scratch for each
//! thread; evaluating a point allocates nothing.
//!
//! `cargo run --example compare_models`
#![allow(clippy::print_stdout, reason = "an example shows its numbers")]

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use gearloss::framework::evaluate::Point;
use gearloss::framework::gearbox::Gearbox;
use gearloss::framework::language::Language;
use gearloss::framework::resolve::Choice;
use gearloss::framework::transmission::{Case, Transmission};
use rayon::prelude::*;
use serde_json::json;

const GEARBOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/two-speed-ev/gearbox.yaml");
/// rad/s per 1/min.
const RPM: f64 = PI / 30.0;
/// Input torque. \[Nm\]
const TORQUE: f64 = 10.0;

fn main() -> Result<(), Box<dyn Error>> {
    let language = Language::linked()?;
    let gearbox = Gearbox::read(&language, Path::new(GEARBOX))?;
    // An override is a path of the resolved description, in which `*` matches one key, and a value as written there.
    let harris = json!({ "type": "harris" });
    let variants = [
        ("iso14179_2", Choice::of_set("iso14179_2")),
        ("joint", Choice::of_set("joint")),
        (
            "joint, 10 mm less oil",
            Choice::of_set("joint").with("housing.oil.level_offset", "-10 mm"),
        ),
        (
            "joint, harris bearings",
            Choice::of_set("joint").with("bearings.*.model", harris),
        ),
    ];
    let speeds: Vec<f64> = (1..=10).map(|k| 2000.0 * f64::from(k)).collect();

    let mut columns = Vec::new();
    for (_, choice) in &variants {
        // Once: resolves names, builds models and computes everything that does not depend on the point.
        let transmission = gearbox.transmission(&language, choice)?;
        let case = transmission
            .case("first", &[], &["input"])
            .map_err(|list| gearbox.findings(list))?;
        columns.push(efficiencies(&transmission, &case, &speeds));
    }

    println!("efficiency in %, first gear, {TORQUE} Nm");
    print!("{:>6}", "rpm");
    for (name, _) in &variants {
        print!("{name:>24}");
    }
    println!();
    for (row, rpm) in speeds.iter().enumerate() {
        print!("{rpm:>6}");
        for column in &columns {
            match column[row] {
                Some(efficiency) => print!("{:>24.3}", 100.0 * efficiency),
                None => print!("{:>24}", "-"),
            }
        }
        println!();
    }
    Ok(())
}

/// Efficiencies at input speeds in 1/min; absent if a loss has no value or there is no output power.
fn efficiencies(transmission: &Transmission, case: &Case, rpm: &[f64]) -> Vec<Option<f64>> {
    let oil = [transmission.oil_temperature];
    rpm.par_iter()
        .map_init(
            || transmission.scratch(case),
            |scratch, rpm| {
                let point = Point {
                    speeds: &[rpm * RPM],
                    torques: &[TORQUE],
                    ..Point::default()
                };
                transmission.evaluate(case, &point, &oil, scratch).efficiency()
            },
        )
        .collect()
}
