//! What is shown of a gearbox before and beside its losses: stages, ratios, static safety; and gearboxes of pitch circles alone.

use crate::common::{self, RPM, program::out};
use gearloss_framework::evaluate::Point;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;
use serde_json::Value;

const UNIT: &str = "examples/electric-drive-unit/gearbox.yaml";
const TWO_SPEED: &str = "examples/two-speed-ev/gearbox.yaml";
const SCHEMATIC: &str = "tests/cases/fine_schematic_set/input.yaml";

#[test]
fn check_prints_a_card_and_bearings_with_too_little_safety_at_the_rating() {
    let text = out(&["check", TWO_SPEED]);
    // z1/z2, ratio, a, x1, x2 of the first stage; 83/16 times 101/24 in first gear.
    assert!(
        text.contains("M1     16/83   5.1875   69.000  0.2500  -0.1229"),
        "{text}"
    );
    assert!(text.contains("gear first: input/output 21.8307"), "{text}");
    assert!(text.contains("gear neutral: no fixed ratio"), "{text}");
    let text = out(&["check", UNIT]);
    assert!(
        text.contains("at the rated torque: bearings.B4: static safety S0 = C0/P0 0.92"),
        "{text}"
    );
    assert!(text.contains("is below 1"), "{text}");
}

#[test]
fn derived_geometry_is_there_at_full_precision() {
    let at = ["--gear", "first", "--torque", "10 Nm", "--speed", "8000 rpm"];
    let json = out(&[&["solve", TWO_SPEED, "--format", "json"], &at[..]].concat());
    let value: Value = serde_json::from_str(&json).unwrap();
    let stage = &value["stages"][0];
    let number = |key: &str| stage[key].as_f64().unwrap();
    let of = |key: &str, i: usize| stage[key][i].as_f64().unwrap();
    // d_b = d cos alpha_t and a cos alpha_wt = a_0 cos alpha_t hold to rounding only where nothing was rounded.
    let cos = |key: &str| number(key).to_radians().cos();
    let alpha_t = cos("transverse_pressure_angle_deg");
    for i in 0..2 {
        assert!((of("base_diameter_mm", i) / (of("reference_diameter_mm", i) * alpha_t) - 1.0).abs() < 1e-14);
    }
    let working = number("centre_distance_mm") * cos("working_pressure_angle_deg");
    assert!((working / (number("reference_centre_distance_mm") * alpha_t) - 1.0).abs() < 1e-14);
    let figure = format!("base_diameter_mm: [{}, ", of("base_diameter_mm", 0));
    let explained = out(&[&["explain", TWO_SPEED, "meshes.M1"], &at[..]].concat());
    assert!(explained.contains(&figure), "{figure} is not in\n{explained}");
    let resolved = out(&["check", TWO_SPEED, "--resolved"]);
    assert!(resolved.contains(&format!("#   {figure}")), "{resolved}");
}

#[test]
fn static_safety_follows_from_the_loads_and_too_little_is_noted() {
    let at = |torque: &str| -> Value {
        let text = out(&[
            "solve",
            UNIT,
            "--torque",
            torque,
            "--speed",
            "1000 rpm",
            "--oil-temperature",
            "80 degC",
            "--format",
            "json",
        ]);
        serde_json::from_str(&text).unwrap()
    };
    let below = |value: &Value| -> Vec<String> {
        let notes = value["notes"].as_array().unwrap().iter();
        notes
            .filter(|note| note["name"] == "S0 = C0/P0")
            .map(|note| note["path"].as_str().unwrap().to_owned())
            .collect()
    };
    assert!(below(&at("100 Nm")).is_empty());
    let loaded = at("350 Nm");
    let mut short = Vec::new();
    for support in loaded["supports"].as_array().unwrap() {
        let safety = support["static_safety"].as_f64().unwrap();
        assert!(safety > 0.0, "{support}");
        if safety < 1.0 {
            short.push(support["support"].as_str().unwrap().to_owned());
        }
    }
    assert_eq!(short, below(&loaded));
    assert!(!short.is_empty());
}

#[test]
fn a_set_of_pitch_circles_has_its_ratio_and_efficiency() {
    let language = common::language();
    let text = std::fs::read_to_string(common::file(SCHEMATIC)).unwrap();
    let solve = |text: &str| {
        let gearbox = Gearbox::of_text(&language, text, "input.yaml", ".").unwrap_or_else(|f| panic!("{}", f.render()));
        let t = gearbox.transmission(&language, &Choice::default());
        let t = t.unwrap_or_else(|f| panic!("{}", f.render()));
        let case = t.case("1", &[], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[3000.0 * RPM],
            torques: &[60.0],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
        let output = t.ports()[1].member;
        (3000.0 * RPM / solution.speed(output), solution.efficiency().unwrap())
    };
    // Both meshes keep 0.99 of the rolling power, 3/4 of what goes in: ratio 1 + 72/24, efficiency (1 + 3 0.99^2)/4.
    let (ratio, efficiency) = solve(&text);
    assert!((ratio - 4.0).abs() < 1e-12, "{ratio}");
    assert!(
        (efficiency - (1.0 + 3.0 * 0.99 * 0.99) / 4.0).abs() < 1e-9,
        "{efficiency}"
    );
    // Teeth that no involute pair has: 24 + 24 and 84 - 24 do not give one centre distance.
    let (ratio, efficiency) = solve(&text.replace("z: 72", "z: 84"));
    assert!((ratio - 4.5).abs() < 1e-12, "{ratio}");
    assert!(
        (efficiency - (1.0 + 3.5 * 0.99 * 0.99) / 4.5).abs() < 1e-9,
        "{efficiency}"
    );
}

#[test]
fn gears_may_be_called_by_numbers_everywhere() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("gear_1");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::copy(common::file(SCHEMATIC), folder.join("gearbox.yaml")).unwrap();
    let study = "gearloss: study/1\ngearboxes: { ours: gearbox.yaml }\ngrids:\n  few: { gear: \"1\", torque: [10 Nm, 50 Nm], speed: [1000 \
                 rpm, 3000 rpm] }\nanalyses:\n  map: { type: map, grid: few }\n";
    std::fs::write(folder.join("study.yaml"), study).unwrap();
    let at = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let solved = out(&[
        "solve",
        &at("gearbox.yaml"),
        "--gear",
        "1",
        "--torque",
        "10 Nm",
        "--speed",
        "100 rpm",
    ]);
    assert!(solved.contains("gear 1,"), "{solved}");
    out(&["run", &at("study.yaml"), "-o", &at("results")]);
    let mut table = std::fs::read_to_string(folder.join("results/map.csv")).unwrap();
    table.retain(|c| c != '"');
    assert!(
        table
            .lines()
            .skip(1)
            .all(|line| line.split(',').any(|cell| cell == "1")),
        "{table}"
    );
}
