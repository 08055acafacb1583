//! The planetary example: its stand-in table, its results, and how often its loss models are asked.

use std::fmt::Write as _;
use std::path::Path;

use crate::common::{RPM, language};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Status;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::thermal::{Equilibrium, Outcome};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::points::OilTemperature;
use serde_json::{Value, json};

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/planetary-reducer")
}

fn reducer(language: &Language, changes: &[(&str, Value)]) -> Transmission {
    let gearbox = Gearbox::read(language, &folder().join("gearbox.yaml")).unwrap_or_else(|f| panic!("{}", f.render()));
    let overrides = changes
        .iter()
        .map(|(path, value)| ((*path).to_owned(), value.clone()))
        .collect();
    let choice = Choice {
        overrides,
        ..Choice::default()
    };
    gearbox
        .transmission(language, &choice)
        .unwrap_or_else(|f| panic!("{}", f.render()))
}

/// The balance of a point and what it loses there: by part, in the sum.
fn balanced(t: &Transmission, speed: f64, torque: f64) -> (Equilibrium, Vec<(String, f64)>, f64) {
    let case = t.case("reducing", &["input"], &["output"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * RPM],
        torques: &[torque],
        ..Point::default()
    };
    let warm = OilTemperature::Balance.find(t, &case, &point, &mut scratch);
    let (oil, found) = (warm.oil, warm.balance);
    let solution = t.evaluate(&case, &point, &[oil], &mut scratch);
    assert!(
        matches!(solution.status(), Status::Drive | Status::Dragged),
        "{:?}",
        solution.status()
    );
    let parts = solution.parts().map(|(p, l)| (p.path.clone(), l.watts())).collect();
    (found.unwrap(), parts, solution.loss().unwrap())
}

/// Height of the oil above the middle of a lying drum of 60 mm radius and 50 mm length of which 45 % are free. \[mm\]
fn level(volume: f64) -> f64 {
    let filled = |level: f64| {
        let (r, h): (f64, f64) = (60.0, level + 60.0);
        let area = r * r * ((r - h) / r).acos() - (r - h) * (2.0 * r * h - h * h).sqrt();
        0.45 * 50.0 * area * 1e-3
    };
    let (mut low, mut high) = (-60.0, 60.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if filled(middle) < volume {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The table of the example is made here, by the model `estimate` at levels that belong to the volumes. `UPDATE=1` writes it.
#[test]
fn the_stand_in_table_is_what_the_estimate_says() {
    let language = language();
    let mut csv = "# A stand-in for simulated or measured drag: the model `estimate`, with the height of the oil in a lying drum of 60 mm\n\
                   # radius and 50 mm length of which 45 % are free. Nobody has simulated or measured these figures.\n\
                   speed [rpm],nu [mm2/s],volume [ml],moment [Nm]\n"
        .to_owned();
    let volumes = [60.0, 93.0, 130.0];
    let fixed: Vec<Transmission> = volumes
        .iter()
        .map(|volume| {
            reducer(
                &language,
                &[
                    ("housing.oil.volume", json!(format!("{volume} ml"))),
                    ("housing.oil.level", json!(format!("{} mm", level(*volume)))),
                    ("housing.oil.measured_from", json!("carrier")),
                    (
                        "planetary_sets.stage.model",
                        json!({ "type": "estimate", "planet": { "type": "changenet_2011" } }),
                    ),
                ],
            )
        })
        .collect();
    for speed in [500.0, 1000.0, 2000.0, 3000.0, 4500.0] {
        for nu in [10.0, 30.0, 100.0, 300.0, 1000.0] {
            for (t, volume) in fixed.iter().zip(volumes) {
                let watts = drag_at(t, speed, nu);
                let _ = writeln!(csv, "{speed},{nu},{volume},{:.6}", watts / (speed * RPM));
            }
        }
    }
    let file = folder().join("drag.csv");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&file, &csv).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), csv, "UPDATE=1 writes it");
}

/// Drag of the set at a viscosity of the oil, by the temperature that the oil has then. \[W\]
fn drag_at(t: &Transmission, speed: f64, nu: f64) -> f64 {
    let part = t.parts().iter().position(|p| p.path == "planetary_sets.stage").unwrap();
    let case = t.case("reducing", &["input"], &["output"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * RPM],
        torques: &[0.0],
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    // The viscosity of 220 mm2/s at 40 degC and 26 at 100 degC, after ASTM D341.
    let w = |nu: f64| (nu + 0.7).log10().log10();
    let (low, high) = (313.15_f64.log10(), 373.15_f64.log10());
    let share = (w(nu) - w(220.0)) / (w(26.0) - w(220.0));
    let kelvin = 10.0_f64.powf(low + share * (high - low));
    let solution = t.evaluate(&case, &point, &[kelvin - 273.15], &mut scratch);
    solution.watts()[part]
}

/// Evaluations of the loss models on the way to each of the twelve temperatures, and those temperatures.
const TESTS: &str = "
3000 rpm -16 Nm 130 ml: 53.7 degC, 72.7 W, 20 evaluations
3000 rpm 0 Nm 130 ml: 50.2 degC, 65.3 W, 20 evaluations
3000 rpm -16 Nm 93 ml: 53.2 degC, 71.6 W, 20 evaluations
3000 rpm 0 Nm 93 ml: 49.7 degC, 64.2 W, 20 evaluations
3000 rpm -16 Nm 60 ml: 52.7 degC, 70.6 W, 20 evaluations
3000 rpm 0 Nm 60 ml: 49.3 degC, 63.2 W, 20 evaluations
1000 rpm -16 Nm 130 ml: 31.2 degC, 24.3 W, 20 evaluations
1000 rpm 0 Nm 130 ml: 29.7 degC, 21.0 W, 20 evaluations
1000 rpm -16 Nm 93 ml: 31.1 degC, 24.1 W, 20 evaluations
1000 rpm 0 Nm 93 ml: 29.6 degC, 20.8 W, 20 evaluations
1000 rpm -16 Nm 60 ml: 31.1 degC, 23.9 W, 20 evaluations
1000 rpm 0 Nm 60 ml: 29.5 degC, 20.6 W, 20 evaluations
";

#[test]
fn twelve_tests_balance_in_few_evaluations() {
    let language = language();
    let mut seen = "\n".to_owned();
    for speed in [3000.0, 1000.0] {
        for volume in [130.0, 93.0, 60.0] {
            let t = reducer(&language, &[("housing.oil.volume", json!(format!("{volume} ml")))]);
            for torque in [-16.0, 0.0] {
                let (found, parts, loss) = balanced(&t, speed, torque);
                assert_eq!(found.outcome, Outcome::Converged);
                let root = found.stable[0];
                assert!(root.step.residual().abs() <= 1e-9 * root.step.loss);
                // What is evaluated at the temperature is what was balanced, and the surface is as warm as the oil.
                assert!((loss / root.step.loss - 1.0).abs() < 1e-12);
                assert!((found.surface.unwrap() - root.temperature).abs() < 1e-12);
                assert!((found.ways.iter().sum::<f64>() / loss - 1.0).abs() < 1e-9);
                assert!((parts.iter().map(|p| p.1).sum::<f64>() / loss - 1.0).abs() < 1e-12);
                let _ = writeln!(
                    seen,
                    "{speed} rpm {torque} Nm {volume} ml: {:.1} degC, {:.1} W, {} evaluations",
                    root.temperature,
                    loss,
                    found.evaluations()
                );
            }
        }
    }
    assert_eq!(seen, TESTS);
}

#[test]
fn temperature_follows_speed_load_oil_and_surroundings() {
    let language = language();
    let oil = |changes: &[(&str, Value)], speed: f64, torque: f64| {
        let (found, ..) = balanced(&reducer(&language, changes), speed, torque);
        found
            .oil()
            .unwrap_or_else(|| panic!("{changes:?}: {:?}", found.outcome))
    };
    let usual = oil(&[], 3000.0, -16.0);
    assert!(oil(&[], 1000.0, -16.0) < usual && oil(&[], 3000.0, 0.0) < usual);
    assert!(oil(&[("housing.oil.volume", json!("60 ml"))], 3000.0, -16.0) < usual);
    // Warmer surroundings warm the oil by less, because thinner oil loses less.
    let warmer = oil(&[("thermal.ambient", json!("30 degC"))], 3000.0, -16.0) - usual;
    assert!(warmer > 1.0 && warmer < 10.0, "{warmer}");
    // A source into the surface, and a resistance on the way to it, warm the oil.
    let motor = json!({ "motor": { "heat": 20.0, "into": "surface" } });
    assert!(oil(&[("thermal.sources", motor)], 3000.0, -16.0) > usual + 5.0);
    assert!(oil(&[("thermal.oil_to_surface", json!("0.1 K/W"))], 3000.0, -16.0) > usual + 1.0);
    // At rest nothing is lost.
    let t = reducer(&language, &[]);
    let case = t.case("reducing", &["input"], &["output"]).unwrap();
    let point = Point {
        speeds: &[0.0],
        torques: &[0.0],
        ..Point::default()
    };
    let found = t.equilibrium(&case, &point, &mut t.scratch(&case));
    assert_eq!((found.outcome, found.oil()), (Outcome::Converged, Some(20.0)));
}

#[test]
fn probing_leaves_no_notes() {
    let language = language();
    let t = reducer(&language, &[]);
    let case = t.case("reducing", &["input"], &["output"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[3000.0 * RPM],
        torques: &[-16.0],
        ..Point::default()
    };
    t.equilibrium(&case, &point, &mut scratch);
    assert!(
        scratch.totals.iter().all(|e| e.seen == 0),
        "a constant way has nothing to note"
    );
}
