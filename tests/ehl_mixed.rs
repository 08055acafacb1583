//! Friction of contacts that warm themselves, in a whole gearbox: the oil's rheology reaches the meshes, and losses follow duty.

use crate::common::{RPM, file, language, two_speed_with};
use gearloss_framework::description::LubricantEntry;
use gearloss_framework::evaluate::Point;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::lubricant::roelands::Roelands;
use gearloss_framework::mechanism::Mechanism;
use gearloss_framework::mechanism::gear_mesh::GearMesh;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use serde_json::{Value, json};

fn mesh(friction: Value) -> Value {
    json!({ "type": "path_integral", "load_sharing": "ramp", "tooth_friction": friction })
}

fn built(language: &Language, overrides: &[(&str, Value)]) -> Transmission {
    two_speed_with(language, Some("joint"), overrides)
}

/// Loss of the meshes. \[W\]
fn meshes(t: &Transmission, torque: f64, rpm: f64, oil: f64) -> f64 {
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[rpm * RPM],
        torques: &[torque],
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[oil], &mut scratch);
    assert!(solution.is_complete());
    let of_meshes = solution.parts().filter(|(part, _)| part.mechanism == GearMesh::KEY);
    of_meshes.map(|(_, loss)| loss.watts()).sum()
}

#[test]
fn the_rheology_of_the_oil_reaches_the_meshes() {
    let language = language();
    let beside = json!({ "type": "ehl_mixed", "tau0": "6 MPa", "z": 0.58, "limiting_slope": 0.06, "mu_b": 0.11, "shear_modulus": "0.3 GPa" });
    let written = built(&language, &[("meshes.*.model", mesh(beside))]);
    let rheology =
        json!({ "tau0": "6 MPa", "z": 0.58, "limiting_slope": 0.06, "mu_b": 0.11, "shear_modulus": "0.3 GPa" });
    let of_oil = built(
        &language,
        &[
            ("lubricants.*.rheology", rheology),
            ("meshes.*.model", mesh(json!({ "type": "ehl_mixed" }))),
        ],
    );
    for (torque, rpm, oil) in [(50.0, 3000.0, 60.0), (-20.0, 9000.0, 100.0), (100.0, 500.0, 20.0)] {
        assert_eq!(meshes(&written, torque, rpm, oil), meshes(&of_oil, torque, rpm, oil));
    }
}

/// The film takes a stated pressure-viscosity coefficient, and the exponent `z` is left to the viscosity inside it.
#[test]
fn a_stated_pressure_viscosity_makes_the_film() {
    let language = language();
    let law = json!({ "type": "ehl_mixed", "thermal": false, "tau0": "5 MPa", "z": 0.6, "limiting_slope": 0.055, "mu_b": 0.13 });
    let loss = |more: &[(&str, Value)]| {
        let model = [("meshes.*.model", mesh(law.clone()))];
        meshes(&built(&language, &[&model, more].concat()), 50.0, 3000.0, 60.0)
    };
    let stated = |value: f64| loss(&[("lubricants.sump.pressure_viscosity.value", value.into())]);
    let gearbox = Gearbox::read(&language, &file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let resolved = gearbox.resolve(&language, &Choice::default()).unwrap();
    let oil: LubricantEntry = serde_json::from_value(resolved.value["lubricants"]["sump"].clone()).unwrap();
    let of_z = Roelands::coefficient(0.6, Lubricant::new(&oil).unwrap().eta(60.0)) * 1e9;
    assert!((stated(of_z) / loss(&[]) - 1.0).abs() < 1e-9);
    assert!(stated(2.0 * of_z) < 0.99 * stated(of_z));
}

#[test]
fn drive_and_coast_lose_alike_and_nothing_is_lost_without_torque_or_speed() {
    let language = language();
    let law = json!({ "type": "ehl_mixed", "tau0": "5 MPa", "limiting_slope": 0.055, "mu_b": 0.13 });
    let t = built(&language, &[("meshes.*.model", mesh(law))]);
    assert_eq!(meshes(&t, 50.0, 0.0, 60.0), 0.0);
    let (drive, coast) = (meshes(&t, 50.0, 3000.0, 60.0), meshes(&t, -50.0, 3000.0, 60.0));
    // The second mesh carries what the first has left, or has lost already.
    assert!((drive / coast - 1.0).abs() < 0.05, "{drive} {coast}");
    // What is left without torque is the drag of what lies behind the meshes.
    let small = meshes(&t, 1e-3, 3000.0, 60.0);
    assert!(small < 0.01 * drive, "{small} {drive}");
}
