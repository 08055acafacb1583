//! Load sharing of planets from position errors of their pins: limits, losses, bearing loads, findings.

use std::path::{Path, PathBuf};

use crate::common::{RPM, language};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::{PlanetShares, Transmission};
use serde_json::{Value, json};

const PINS: &str = "planetary_sets.stage.pins";

fn example(language: &Language, changes: &[(&str, Value)]) -> Result<Transmission, Vec<Diagnostic>> {
    of_text(language, &std::fs::read_to_string(file()).unwrap(), changes)
}

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/planet-pins/gearbox.yaml")
}

/// The example with other keys instead of `pins`.
fn without_pins(language: &Language, keys: &str) -> Transmission {
    let text = std::fs::read_to_string(file()).unwrap();
    let (before, rest) = text.split_once("    pins:\n").unwrap();
    let (_, after) = rest.split_once("\ncouplings:").unwrap();
    of_text(language, &format!("{before}{keys}\ncouplings:{after}"), &[]).unwrap()
}

fn of_text(language: &Language, text: &str, changes: &[(&str, Value)]) -> Result<Transmission, Vec<Diagnostic>> {
    let folder = file();
    let folder = folder.parent().unwrap().to_str().unwrap();
    let gearbox =
        Gearbox::of_text(language, text, "gearbox.yaml", folder).unwrap_or_else(|found| panic!("{}", found.render()));
    let overrides = changes.iter().map(|(path, value)| ((*path).to_owned(), value.clone()));
    let choice = Choice {
        overrides: overrides.collect(),
        ..Choice::default()
    };
    gearbox.transmission(language, &choice).map_err(|found| found.list)
}

struct Found {
    loss: f64,
    residual: f64,
    parts: Vec<(String, f64)>,
    shares: Vec<PlanetShares>,
    /// Radial load and the part of it that turns, and the radial load on the most loaded planet, by bearing.
    loads: Vec<(String, [f64; 2], Option<f64>)>,
}

impl Found {
    fn load(&self, bearing: &str) -> &(String, [f64; 2], Option<f64>) {
        self.loads.iter().find(|load| load.0 == bearing).unwrap()
    }

    fn part(&self, path: &str) -> f64 {
        self.parts.iter().find(|part| part.0 == path).unwrap().1
    }
}

fn at(t: &Transmission, torque: f64) -> Found {
    with_flow(t, torque, PowerFlow::Real)
}

fn with_flow(t: &Transmission, torque: f64, flow: PowerFlow) -> Found {
    let case = t.case("reducing", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[1800.0 * RPM],
        torques: &[torque],
        flow,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[70.0], &mut scratch);
    let loads = t.supports().iter().enumerate().map(|(i, path)| {
        let radial = [solution.load(i).radial, solution.turning_load(i)];
        (path.clone(), radial, solution.most_loaded(i).map(|load| load.radial))
    });
    Found {
        loss: solution.loss().unwrap(),
        // An ideal flow has none.
        residual: solution.residual().unwrap_or(f64::NAN),
        parts: solution
            .parts()
            .map(|(part, loss)| (part.path.clone(), loss.watts()))
            .collect(),
        shares: solution.planet_shares(),
        loads: loads.collect(),
    }
}

fn close(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} {expected}");
}

fn is(found: &Diagnostic, code: &str) -> bool {
    found.code_or_other().to_string() == code
}

fn errors(list: &[f64]) -> Value {
    json!(list.iter().map(|error| format!("{error} um")).collect::<Vec<_>>())
}

#[test]
fn equal_errors_are_no_errors() {
    let language = language();
    let equal = example(&language, &[(&format!("{PINS}.errors"), errors(&[7.0; 4]))]).unwrap();
    let none = without_pins(&language, "");
    for torque in [150.0, -40.0, 0.0] {
        let [equal, none] = [&equal, &none].map(|t| at(t, torque));
        assert_eq!(equal.parts, none.parts);
        assert!(equal.shares.is_empty());
    }
}

/// One planet with an error e: 1 + (n - 1)/n k e/f with fixed members, 1 + (n - 3)/n k e/f with a floating one; the lever of both
/// is found with two torques.
#[test]
fn closed_shares_of_one_error() {
    let language = language();
    let own = [(&*format!("{PINS}.errors"), errors(&[10.0, 0.0, 0.0, 0.0]))];
    let floating = example(&language, &own).unwrap();
    let held = example(&language, &[own[0].clone(), (&format!("{PINS}.floating"), json!([]))]).unwrap();
    // Towards the error the planet carries less: the torque has the other sense.
    let excess = |t: &Transmission, torque: f64| {
        let residual = at(t, torque).residual;
        assert!(residual.abs() < 1e-9, "{residual}");
        let found = with_flow(t, torque, PowerFlow::Ideal);
        let shares = &found.shares[0];
        close(shares.shares.iter().sum(), 4.0, 1e-12);
        shares.shares[0] - 1.0
    };
    for torque in [-150.0, 150.0] {
        assert!(excess(&held, torque) * torque < 0.0);
        close(excess(&held, torque) / excess(&floating, torque), 3.0, 1e-6);
    }
    let moved = at(&floating, -150.0).shares[0].displacements.clone();
    assert_eq!(moved.len(), 1);
    assert!(
        moved[0].0 == "sun_shaft" && moved[0].1 > 1e-6 && moved[0].1 < 2e-5,
        "{moved:?}"
    );
}

/// With stated stiffness the excess follows from hand calculation: F_t = T/(n r), P = 2 F_t, equal working angles of 20 deg, so
/// 1/k = 1/k_pin + (1/k_1 + 1/k_2)/(4 cos^2 20 deg).
#[test]
fn shares_by_hand_with_stated_stiffness() {
    let language = language();
    let changes = [
        (&*format!("{PINS}.errors"), errors(&[10.0, 0.0, 0.0, 0.0])),
        (&format!("{PINS}.floating"), json!([])),
        (
            &format!("{PINS}.meshes"),
            json!([{ "mesh": "sun_planet", "stiffness": "400 N/um" }, { "mesh": "planet_ring", "stiffness": "500 N/um" }]),
        ),
    ];
    let t = example(&language, &changes).unwrap();
    let cos = 20.0_f64.to_radians().cos();
    let stiffness = 1.0 / (1.0 / 300e6 + (1.0 / 400e6 + 1.0 / 500e6) / (4.0 * cos * cos));
    let pin = 2.0 * 150.0 / (4.0 * 0.024);
    let shares = with_flow(&t, -150.0, PowerFlow::Ideal).shares;
    close(shares[0].k_gamma(), 1.0 + 0.75 * stiffness * 10e-6 / pin, 1e-9);
}

/// The same loads stated and calculated have the same losses, and the same forces on carrier and planets.
#[test]
fn stated_and_calculated_loads_agree() {
    let language = language();
    let calculated = example(
        &language,
        &[
            (&format!("{PINS}.errors"), errors(&[-10.0, 0.0, 0.0, 0.0])),
            (&format!("{PINS}.floating"), json!([])),
        ],
    )
    .unwrap();
    // With losses both meshes have slightly different mean forces, and the calculated shares differ between them.
    let found = with_flow(&calculated, 150.0, PowerFlow::Ideal);
    let k_gamma = found.shares[0].k_gamma();
    assert!(k_gamma > 1.1);
    let stated = without_pins(&language, &format!("    load_sharing: {k_gamma}\n"));
    let stated = with_flow(&stated, 150.0, PowerFlow::Ideal);
    close(found.loss, stated.loss, 1e-9);
    close(found.part("bearings.pin"), stated.part("bearings.pin"), 1e-9);
    for bearing in ["bearings.C1", "bearings.C2"] {
        close(found.load(bearing).1[1], stated.load(bearing).1[1], 1e-9);
        assert!(found.load(bearing).1[1] > 100.0);
    }
    close(
        found.load("bearings.pin").2.unwrap(),
        stated.load("bearings.pin").2.unwrap(),
        1e-9,
    );
}

/// Four planets, one with the excess x over the mean and the others with less: the pins push the carrier across with (4/3) x times the mean
/// force of a pin; the floating sun takes it away.
#[test]
fn the_carrier_carries_the_difference() {
    let language = language();
    let one = [(&*format!("{PINS}.errors"), errors(&[-10.0, 0.0, 0.0, 0.0]))];
    let held = at(
        &example(&language, &[one[0].clone(), (&format!("{PINS}.floating"), json!([]))]).unwrap(),
        150.0,
    );
    let excess = held.shares[0].shares[0] - 1.0;
    let pin = 2.0 * 150.0 / (4.0 * 0.024);
    // Statics: the set at 0 mm, bearings at 40 and 90 mm.
    close(
        held.load("bearings.C1").1[1],
        4.0 / 3.0 * excess * pin * 90.0 / 50.0,
        0.02,
    );
    close(
        held.load("bearings.C2").1[1],
        4.0 / 3.0 * excess * pin * 40.0 / 50.0,
        0.02,
    );
    let [all, turning] = held.load("bearings.C1").1;
    assert!(all >= turning);
    let floating = at(&example(&language, &one).unwrap(), 150.0);
    assert!(
        floating.load("bearings.C1").1[1] == 0.0,
        "{:?}",
        floating.load("bearings.C1")
    );
    assert!(floating.load("bearings.I1").1[1] == 0.0);
}

#[test]
fn faults_have_codes_and_places() {
    let language = language();
    for (changes, code, path) in [
        (
            vec![("errors", errors(&[1.0, 2.0, 3.0]))],
            "E0376",
            "planetary_sets.stage.pins.errors",
        ),
        (
            vec![("clearances", errors(&[1.0; 5]))],
            "E0376",
            "planetary_sets.stage.pins.clearances",
        ),
        (
            vec![("floating.0.shaft", json!("input"))],
            "E0203",
            "planetary_sets.stage.pins.floating.0.shaft",
        ),
        (
            vec![("meshes", json!([{ "mesh": "other", "stiffness": "1 N/um" }]))],
            "E0203",
            "planetary_sets.stage.pins.meshes.0.mesh",
        ),
    ] {
        let changes: Vec<(String, Value)> = changes
            .into_iter()
            .map(|(key, value)| (format!("{PINS}.{key}"), value))
            .collect();
        let changes: Vec<(&str, Value)> = changes.iter().map(|(key, value)| (&**key, value.clone())).collect();
        let found = example(&language, &changes).err().unwrap();
        assert!(
            found.iter().any(|fault| is(fault, code) && fault.path == path),
            "{path} {found:#?}"
        );
    }
    let found = example(&language, &[("planetary_sets.stage.load_sharing", json!(1.2))])
        .err()
        .unwrap();
    assert!(found.iter().any(|fault| is(fault, "E0376")), "{found:#?}");
    let unstated = without_pins(&language, "");
    assert!(
        unstated.warnings.iter().any(|warning| is(warning, "W0376")),
        "{:#?}",
        unstated.warnings
    );
    let own = example(&language, &[]).unwrap();
    assert!(own.warnings.iter().all(|warning| !is(warning, "W0376")));
}

/// The teeth of planets are as stiff as their material: a softer one evens out the errors of the pins, the modulus of the mesh changes nothing.
#[test]
fn teeth_are_as_stiff_as_their_material() {
    let language = language();
    let of = |material: &str| {
        let text = std::fs::read_to_string(file()).unwrap();
        let named = text.replace("z: 30, facewidth: 30 mm }", "z: 30, facewidth: 30 mm, material: own }");
        let text =
            format!("{named}\nmaterials: {{ own: {{ kind: bronze, elastic_modulus: {material}, poisson: 0.3 }} }}\n");
        at(&of_text(&language, &text, &[]).unwrap(), 150.0).shares[0]
            .shares
            .clone()
    };
    let without = at(&example(&language, &[]).unwrap(), 150.0).shares[0].shares.clone();
    assert_eq!(of("206 GPa"), without);
    let greatest = |shares: &[f64]| shares.iter().copied().fold(0.0, f64::max);
    assert!(greatest(&of("50 GPa")) < greatest(&without) - 0.01);
}
