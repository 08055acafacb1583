//! The two-speed example in first gear under the set `joint`, against the independent program in NumPy of `benches/peers`.
//!
//! The losses are frozen as `joint_loop.py`, the same without NumPy, found them on 2026-11-27 (method `passes`, points and changed inputs of `check.py`) with
//! 32 Gauss points on each smooth piece of the path of contact in place of its three (`constants.GAUSS`), so that they have no error
//! of quadrature: 24 points give the same to 1e-9. `check.py` compares
//! with the three points that the scripts are timed with, and so only to what these miss.

use std::path::Path;
use std::process::Command;

use crate::common::file;

/// Torque (Nm), speed (rpm), oil temperature (degC) and loss (W) with the inputs of the example.
const PLAIN: [[f64; 4]; 18] = [
    [0.02, 22.0, 100.0, 1.737854452e-03],
    [0.02, 1000.0, 100.0, 3.592498438e-01],
    [0.02, 10000.0, 100.0, 1.597381772e+01],
    [0.02, 22000.0, 100.0, 6.355573491e+01],
    [0.5, 22.0, 100.0, 9.128051745e-03],
    [0.5, 1000.0, 100.0, 8.023349070e-01],
    [0.5, 10000.0, 100.0, 2.480401484e+01],
    [0.5, 22000.0, 100.0, 8.912595841e+01],
    [10.0, 22.0, 100.0, 4.067913681e-01],
    [10.0, 1000.0, 100.0, 1.611546336e+01],
    [10.0, 10000.0, 100.0, 1.660642419e+02],
    [10.0, 22000.0, 100.0, 4.056587046e+02],
    [20.0, 22.0, 100.0, 1.014461088e+00],
    [20.0, 1000.0, 100.0, 3.935218090e+01],
    [20.0, 10000.0, 100.0, 3.614077627e+02],
    [20.0, 22000.0, 100.0, 8.172389800e+02],
    [3.3, 14000.0, 40.0, 1.598363678e+02],
    [7.0, 700.0, 40.0, 1.191144056e+01],
];
/// The same with the inputs of [`CHANGES`].
const VARIED: [[f64; 4]; 4] = [
    [0.5, 500.0, 100.0, 3.187270550e-01],
    [5.0, 8000.0, 100.0, 8.466691761e+01],
    [20.0, 22000.0, 100.0, 1.359599908e+03],
    [10.0, 3000.0, 40.0, 1.290795468e+02],
];

/// What `check.py` changes, in the words of the program.
const CHANGES: [&str; 9] = [
    "lubricants.sump.viscosity.factor=0.5",
    "gears.*.surface.rq=0.9 um",
    "bearings.*.radial_factor=1.7",
    "bearings.B1.model.mu_bl=0.08",
    "bearings.B2.model.mu_bl=0.08",
    "bearings.B3.model.mu_bl=0.08",
    "bearings.B4.model.mu_bl=0.08",
    "bearings.B5.model.mu_bl=0.08",
    "bearings.B6.model.mu_bl=0.08",
];

/// The program integrates with seven points, which leaves 2e-7 of the loss here.
const WITHIN: f64 = 1e-6;

/// Loss that the program finds. \[W\]
fn loss(gearbox: &Path, [torque, speed, temperature]: [f64; 3], changes: &[&str]) -> f64 {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearloss"));
    command.args([
        "solve",
        gearbox.to_str().unwrap(),
        "--models",
        "joint",
        "--gear",
        "first",
        "--format",
        "json",
    ]);
    command.args(["--torque", &format!("{torque} Nm"), "--speed", &format!("{speed} rpm")]);
    command.args(["--oil-temperature", &format!("{temperature} degC")]);
    for change in changes {
        command.args(["--set", change]);
    }
    let done = command.output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let point: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    point["loss_w"].as_f64().unwrap()
}

#[test]
fn losses_are_those_of_an_independent_program() {
    let folder = std::env::temp_dir().join(format!("gearloss-peers-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    // The set stands in the study; a gearbox may have it as well.
    let study = std::fs::read_to_string(file("examples/two-speed-ev/study.yaml")).unwrap();
    let from = study.find("\nmodel_sets:").unwrap();
    let to = study.find("\nmeasurements:").unwrap();
    let gearbox = std::fs::read_to_string(file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let path = folder.join("gearbox.yaml");
    std::fs::write(&path, gearbox + &study[from..to] + "\n").unwrap();
    let sets: [(&[[f64; 4]], &[&str]); 2] = [(&PLAIN, &[]), (&VARIED, &CHANGES)];
    for (points, changes) in sets {
        for [torque, speed, temperature, expected] in points {
            let computed = loss(&path, [*torque, *speed, *temperature], changes);
            assert!(
                (computed / expected - 1.0).abs() <= WITHIN,
                "{torque} Nm, {speed} rpm, {temperature} degC: {computed} W, NumPy {expected} W"
            );
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
