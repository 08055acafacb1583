//! Derivatives of solved points, against differences of whole solves.

use std::process::{Command, Output};

use gearloss_framework::evaluate::{Noting, Point, PowerFlow};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::real::Stencil;
use gearloss_framework::resolve::{Choice, Resolved};
use gearloss_framework::thermal::Step;
use gearloss_framework::transmission::Transmission;
use gearloss_studies::points::{Derivative, Derivatives, Derived, Method, OilTemperature, PreparedPoint, Variable};
use serde_json::{Value, json};

use crate::common::{RPM, file, language};

/// A gearbox with a point of it.
struct Rig {
    language: Language,
    gearbox: Gearbox,
    choice: Choice,
    resolved: Resolved,
    transmission: Transmission,
    prepared: PreparedPoint,
}

impl Rig {
    fn new(example: &str, choice: Choice, gear: &str, torque: f64, rpm: f64, oil: Option<f64>) -> Self {
        let path = format!("examples/{example}/gearbox.yaml");
        Self::of_file(&path, choice, gear, (torque, rpm), oil)
    }

    fn of_file(path: &str, choice: Choice, gear: &str, (torque, rpm): (f64, f64), oil: Option<f64>) -> Self {
        let language = language();
        let gearbox = Gearbox::read(&language, &file(path)).unwrap();
        let resolved = gearbox.resolve(&language, &choice).unwrap();
        let transmission = gearbox.build(&language, &resolved).unwrap();
        let states = transmission.states().iter().map(|state| state.name.as_str());
        let gear = states.max_by_key(|name| *name == gear).unwrap().to_owned();
        let prepared = PreparedPoint {
            case: transmission.case(&gear, &["input"], &["input"]).unwrap(),
            gear,
            speeds: vec![rpm * RPM],
            torques: vec![torque],
            oil: OilTemperature::from_conditions(&transmission, oil),
            flow: PowerFlow::Real,
        };
        Self {
            language,
            gearbox,
            choice,
            resolved,
            transmission,
            prepared,
        }
    }

    fn over(&self, variable: &str) -> Derivatives {
        self.try_over(variable).unwrap()
    }

    fn try_over(&self, variable: &str) -> Result<Derivatives, String> {
        let derived = Derived {
            language: &self.language,
            gearbox: &self.gearbox,
            choice: &self.choice,
            resolved: &self.resolved,
            transmission: &self.transmission,
            prepared: &self.prepared,
        };
        derived
            .over(&Variable::from(variable))
            .map_err(|findings| findings.render())
    }

    /// Loss, efficiency, oil temperature and the losses of all parts with a relative change of a given quantity.
    fn changed(&self, variable: &str, change: f64) -> Vec<f64> {
        let (mut speeds, mut torques) = (self.prepared.speeds.clone(), self.prepared.torques.clone());
        let mut oil = self.prepared.oil;
        match (variable, &mut oil) {
            ("torque:input", _) => torques[0] *= 1.0 + change,
            ("speed:input", _) => speeds[0] *= 1.0 + change,
            (_, OilTemperature::Fixed(oil)) => *oil *= 1.0 + change,
            _ => panic!("{variable}"),
        }
        let point = Point {
            speeds: &speeds,
            torques: &torques,
            flow: self.prepared.flow,
            tolerance: Tolerance {
                power: 1e-13,
                ..Tolerance::default()
            },
            inclination: 0.0,
        };
        let (t, case) = (&self.transmission, &self.prepared.case);
        let mut scratch = t.scratch(case);
        let found = oil.find(t, case, &point, &mut scratch);
        assert!(found.is_sound());
        let mut temperature = found.oil;
        if let Some(balance) = &found.balance {
            // The search ends at a residual of 1e-10 of the loss; a secant step continues it.
            let root = balance.stable[0].step;
            let away = |step: &Step| (step.temperature - root.temperature).abs();
            let others = balance.history.iter().filter(|step| away(step) > 1e-3);
            let other = others.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap();
            let slope = (other.residual() - root.residual()) / (other.temperature - root.temperature);
            temperature -= root.residual() / slope;
        }
        t.try_point(case, &point, &[temperature], &mut scratch, Noting::Muted)
            .unwrap();
        let solution = t.evaluate(case, &point, &[temperature], &mut scratch);
        let mut results = vec![solution.loss().unwrap(), solution.efficiency().unwrap(), temperature];
        results.extend(solution.watts());
        results
    }

    /// Compares all derivatives over a given quantity with differences; returns them. The deviation is relative to the derivative or to
    /// the quantity itself over the variable, whichever is larger.
    fn compare(&self, variable: &str, tolerance: f64) -> Derivatives {
        let found = self.over(variable);
        let value = match (variable, self.prepared.oil) {
            ("torque:input", _) => self.prepared.torques[0],
            ("speed:input", _) => self.prepared.speeds[0] / RPM,
            (_, OilTemperature::Fixed(oil)) => oil,
            _ => panic!("{variable}"),
        };
        let here = self.changed(variable, 0.0);
        let stencil = |step: f64| Stencil::new(step, |change| Ok::<_, ()>(self.changed(variable, change))).unwrap();
        let [wide, narrow] = [2e-3, 1e-3].map(stencil);
        let mut names = vec!["loss", "efficiency", "oil_temperature"];
        names.extend(self.transmission.parts().iter().map(|part| part.path.as_str()));
        let mut compared = 0;
        for (k, name) in names.iter().enumerate() {
            let Some(derivative) = found.derivatives.iter().find(|derivative| derivative.of == *name) else {
                assert_eq!(*name, "oil_temperature");
                continue;
            };
            let [wide, narrow] = [&wide, &narrow].map(|stencil| stencil.slope(|results| results[k]) / value);
            let scale = narrow.abs() + (here[k] / value).abs();
            assert!(
                (wide - narrow).abs() <= tolerance * scale,
                "{variable}, {name}: differences are {wide} and {narrow}"
            );
            let exact = derivative.value.unwrap();
            assert!(
                (exact - narrow).abs() <= tolerance * scale,
                "{variable}, {name}: {exact} against {narrow}"
            );
            assert!(
                derivative.error.unwrap() <= tolerance * scale,
                "{variable}, {name}: {derivative:?}"
            );
            compared += 1;
        }
        assert!(compared > 3);
        found
    }
}

fn fixed(choice: Choice) -> Choice {
    choice.with("thermal.mode", "fixed")
}

#[test]
fn derivatives_of_the_two_speed_example_agree_with_differences_of_solves() {
    for set in ["joint", "iso14179_2"] {
        for (torque, rpm) in [(20.0, 6000.0), (-12.0, 2500.0)] {
            let rig = Rig::new("two-speed-ev", Choice::of_set(set), "first", torque, rpm, Some(80.0));
            for variable in ["torque:input", "speed:input", "oil_temperature"] {
                rig.compare(variable, 1e-8);
            }
        }
    }
}

/// Loops of bearings contain the friction of these meshes. Solves find it by secants there, to some 1e-11, which differences of solves divide by
/// their step.
#[test]
fn derivatives_of_meshes_on_axes_that_cross_agree_with_differences_of_solves() {
    for (file, torque, rpm) in [
        ("framework/workbench/src/form/layouts/bevel-helical.yaml", 45.0, 1500.0),
        ("framework/workbench/src/form/layouts/bevel-helical.yaml", -30.0, 1200.0),
        ("framework/workbench/src/form/layouts/axle.yaml", 150.0, 1500.0),
        ("examples/worm-drive/gearbox.yaml", 15.0, 1450.0),
        ("tests/results/crossed_helical.yaml", 20.0, 1500.0),
    ] {
        let rig = Rig::of_file(file, Choice::default(), "", (torque, rpm), Some(75.0));
        for variable in ["torque:input", "speed:input", "oil_temperature"] {
            rig.compare(variable, 2e-7);
        }
    }
}

#[test]
fn derivatives_through_the_heat_balance_agree_with_differences_of_balances() {
    // Between the nodes of the drag table, where its slope is not smooth.
    let rig = Rig::new("planetary-reducer", Choice::default(), "reducing", 20.0, 2700.0, None);
    for variable in ["torque:input", "speed:input"] {
        let found = rig.compare(variable, 1e-8);
        let warming = found
            .derivatives
            .iter()
            .find(|derivative| derivative.of == "oil_temperature")
            .unwrap();
        assert!(
            warming.value.unwrap() > 0.0 && warming.unit.starts_with("K/"),
            "{warming:?}"
        );
    }
    let given = Rig::new(
        "planetary-reducer",
        Choice::default(),
        "reducing",
        20.0,
        2700.0,
        Some(60.0),
    );
    for variable in ["torque:input", "speed:input", "oil_temperature"] {
        given.compare(variable, 1e-8);
    }
}

#[test]
fn a_model_that_iterates_along_the_path_is_differentiated_by_differences() {
    let rig = Rig::new(
        "electric-drive-unit",
        fixed(Choice::default()),
        "drive",
        100.0,
        6000.0,
        Some(40.0),
    );
    let found = rig.over("torque:input");
    assert_eq!(found.method, Method::Differences);
    assert!(
        found.models.iter().any(|path| path.contains("tooth_friction")),
        "{:?}",
        found.models
    );
    let simple = fixed(Choice::default()).with(
        "meshes.*.model.tooth_friction",
        serde_json::json!({ "type": "benedict_kelley" }),
    );
    let rig = Rig::new("electric-drive-unit", simple, "", 100.0, 6000.0, Some(40.0));
    for variable in ["torque:input", "speed:input", "oil_temperature"] {
        rig.compare(variable, 1e-8);
    }
}

/// A preload that the balanced temperature changes: its root is continued by one step of Newton.
#[test]
fn a_preload_has_the_derivatives_of_its_root() {
    let preload = json!({ "closing": 20e-6, "housing": { "material": "cast_iron" } });
    let choice = Choice::default().with("bearings.B1.preload", preload);
    let rig = Rig::new("industrial-reducer", choice.clone(), "", 290.0, 1480.0, None);
    for variable in ["torque:input", "speed:input"] {
        rig.compare(variable, 1e-7);
    }
    let rig = Rig::new("industrial-reducer", choice, "", 290.0, 1480.0, Some(70.0));
    for variable in ["torque:input", "oil_temperature"] {
        rig.compare(variable, 1e-7);
    }
}

#[test]
fn only_the_models_that_depend_on_the_variable_are_named() {
    let rig = Rig::new(
        "two-speed-ev",
        Choice::of_set("joint"),
        "first",
        20.0,
        6000.0,
        Some(80.0),
    );
    let torque = rig.over("torque:input");
    assert_eq!(
        (torque.method, &torque.models[..]),
        (Method::Exact, &[][..]),
        "{torque:?}"
    );
    let speed = rig.over("speed:input");
    assert!(
        speed.models.iter().any(|path| path.starts_with("seals.D1")),
        "{:?}",
        speed.models
    );
    let of = |path: &str| {
        torque
            .derivatives
            .iter()
            .find(|derivative| derivative.of == path)
            .unwrap()
    };
    assert_eq!(of("seals.D1").value, Some(0.0));
    assert_eq!(
        (of("loss").unit.as_str(), of("efficiency").unit.as_str()),
        ("W/Nm", "1/Nm")
    );
}

#[test]
fn derivatives_over_a_path_are_those_of_an_equal_given_quantity() {
    // The stated oil temperature is used, so that its path is the oil temperature.
    let rig = Rig::new("two-speed-ev", Choice::of_set("joint"), "first", 20.0, 6000.0, None);
    let (path, given) = (rig.over("thermal.oil"), rig.over("oil_temperature"));
    assert_eq!(path.method, Method::Differences);
    for (path, given) in path.derivatives.iter().zip(&given.derivatives) {
        assert_eq!((&path.of, &path.unit), (&given.of, &given.unit));
        let (found_value, wanted) = (path.value.unwrap(), given.value.unwrap());
        assert!(
            (found_value - wanted).abs() <= 10.0 * path.error.unwrap() + 1e-8 * wanted.abs(),
            "{path:?} {given:?}"
        );
    }
}

#[test]
fn a_kink_is_reported_with_both_sides() {
    let law = serde_json::json!({ "type": "formula", "formula": "0.1 + 0.01*max(0, temperature - 80)" });
    let choice = Choice::of_set("joint")
        .with("seals.D1.model", law)
        .with("thermal.oil", 80.0);
    let rig = Rig::new("two-speed-ev", choice, "first", 20.0, 6000.0, None);
    let found = rig.over("thermal.oil");
    let of = |path: &str| -> &Derivative {
        found
            .derivatives
            .iter()
            .find(|derivative| derivative.of == path)
            .unwrap()
    };
    let seal = of("seals.D1");
    assert_eq!((seal.value, seal.error), (None, None));
    let [below, above] = seal.kink.unwrap();
    // 0.01 Nm/K at the speed of the input.
    let wanted = 0.01 * 6000.0 * RPM;
    assert!(
        below.abs() < 1e-6 && (above - wanted).abs() < 1e-6,
        "{below} {above} {wanted}"
    );
    assert!(of("loss").kink.is_some() && of("seals.D2").kink.is_none());
}

#[test]
fn derivatives_with_loads_of_planets_by_their_pins_agree_with_differences() {
    let rig = Rig::new("planet-pins", Choice::default(), "reducing", 100.0, 1800.0, Some(70.0));
    for variable in ["torque:input", "speed:input"] {
        rig.compare(variable, 1e-6);
    }
}

#[test]
fn what_is_not_given_or_does_not_exist_is_an_error_with_help() {
    let rig = Rig::new("planetary-reducer", Choice::default(), "reducing", 20.0, 3000.0, None);
    for (variable, words) in [
        ("torque:inptu", ["no port `inptu`", "torque:input"]),
        ("torque:output", ["not given", "torque:input"]),
        ("oil_temperature", ["heat balance", "give the oil temperature"]),
        ("bearings.I1.bor", ["bor", "help"]),
        ("bearings.I1.designation", ["not a number", "help"]),
        ("gears.*.facewidth_typo", ["facewidth_typo", "help"]),
    ] {
        let text = rig.try_over(variable).unwrap_err();
        assert!(words.iter().all(|word| text.contains(word)), "{variable}: {text}");
    }
}

fn solve(arguments: &[&str]) -> Output {
    let point = ["--gear", "first", "--torque", "20 Nm", "--speed", "6000 rpm"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearloss"));
    command.arg("solve").arg(file("examples/two-speed-ev/gearbox.yaml"));
    command.args(point).args(arguments).output().unwrap()
}

#[test]
fn the_program_prints_derivatives_as_text_and_as_json() {
    let asked = [
        "--derivative",
        "torque:input",
        "--derivative",
        "lubricants.sump.viscosity.vi",
        "--derivative",
        "lubricants.sump.viscosity.kv100",
    ];
    let text = String::from_utf8(solve(&asked).stdout).unwrap();
    for words in [
        "over torque:input",
        "W/Nm",
        "exact",
        "over lubricants.sump.viscosity.vi",
        "differences",
        // The viscosity of the example is at the end of a row of the table of ASTM D2270.
        "kink or jump",
    ] {
        assert!(text.contains(words), "{words}:\n{text}");
    }
    let output = solve(&[&asked[..], &["--format", "json"]].concat());
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    let schema: Value = serde_json::from_slice(
        &Command::new(env!("CARGO_BIN_EXE_gearloss"))
            .args(["schema", "point"])
            .output()
            .unwrap()
            .stdout,
    )
    .unwrap();
    assert!(jsonschema::is_valid(&schema, &value), "{value:#}");
    assert_eq!(value["derivatives"][0]["method"], "exact");
    assert_eq!(value["derivatives"][1]["method"], "differences");
    assert!(value["derivatives"][0]["derivatives"][0]["value"].as_f64().unwrap() > 0.0);
}

#[test]
fn an_error_points_into_the_option() {
    for (variable, words) in [("torque:wheel", "there is no port `wheel`"), ("bearings.B9.bore", "B9")] {
        let output = solve(&["--derivative", variable]);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(
            text.contains("--derivative") && text.contains(words) && text.contains("help"),
            "{text}"
        );
    }
}
