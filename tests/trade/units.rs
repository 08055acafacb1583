//! Quantities in the units of the trade: read to the right value or refused with a help that is right.

use std::collections::BTreeMap;

use gearloss_document::data::TableForm;
use gearloss_document::data::sheet::{Assigned, Sheet};
use gearloss_framework::document::{Content, Unit, parse_quantity, read_yaml};
use rust_xlsxwriter::Workbook;
use serde_json::Value;

use super::Case;
use crate::common::{self, random_bits};
use crate::measured_formats::builder;

fn unit(symbol: &str) -> &'static Unit {
    Unit::of_symbol(symbol).unwrap()
}

/// The SI value of a text for a key with this documented unit.
fn si(text: &str, due: &str) -> f64 {
    parse_quantity(text, unit(due)).unwrap_or_else(|fault| panic!("{text}: {fault:?}"))
}

fn help(text: &str, due: &str) -> String {
    let fault = parse_quantity(text, unit(due)).unwrap_err();
    fault.help.unwrap_or_default()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs().max(1e-300)
}

/// Greatest difference of the compared losses. [W]
fn greatest_difference(result: &Value) -> f64 {
    let points = result["comparisons"][0]["points"].as_array().unwrap();
    assert!(!points.is_empty());
    let of = |point: &Value| point["difference"].as_f64().unwrap().abs();
    points.iter().map(of).fold(0.0, f64::max)
}

#[test]
fn speeds_in_hertz_are_turns_per_second() {
    let case = Case::new("speed-in-hertz", "right");
    // 10 Nm at 1000 rpm with an efficiency of 0.9: 104.72 W.
    assert!(greatest_difference(&case.result("study.yaml", "c")) < 0.01);
}

#[test]
fn another_unit_in_the_study_than_in_the_file_is_an_error_unless_it_overrides() {
    let case = Case::new("speed-in-hertz", "relabelled");
    let said = case.gearloss(&["run", "relabelled.yaml"]);
    assert_ne!(said.code, Some(0), "{}", said.text);
    assert!(
        said.text
            .contains("in `Hz` according to the file, in `rpm` according to the study"),
        "{}",
        said.text
    );
    assert!(said.text.contains("units_override: true"), "{}", said.text);
    let text = std::fs::read_to_string(case.path("relabelled.yaml")).unwrap();
    case.write(
        "relabelled.yaml",
        text.replace("units: {", "units_override: true, units: {"),
    );
    // 16.67 rpm by the study's own word: 102.97 W less.
    assert!((greatest_difference(&case.result("relabelled.yaml", "c")) - 123.57).abs() < 0.01);
    let said = case.gearloss(&["check", "relabelled.yaml", "--verbose"]);
    let said = [said.text, case.gearloss(&["run", "relabelled.yaml", "--verbose"]).text].concat();
    assert!(
        said.contains("column `n_in` is read in rpm, not in Hz as the file states"),
        "{said}"
    );
    // One file of several has its own word.
    let overridden = "  rig: { file: [{ file: rig.csv, units: { speed: rpm }, units_override: true }], columns: { torque: T, speed: n_in, loss: P } }";
    let text = std::fs::read_to_string(case.path("study.yaml")).unwrap();
    let rig = text.lines().find(|line| line.contains("rig: {")).unwrap();
    case.write("own.yaml", text.replace(rig, overridden));
    assert!((greatest_difference(&case.result("own.yaml", "c")) - 123.57).abs() < 0.01);
    case.write(
        "own.yaml",
        text.replace(rig, &overridden.replace(", units_override: true", "")),
    );
    assert_ne!(case.gearloss(&["check", "own.yaml"]).code, Some(0));
}

#[test]
fn a_row_of_units_with_reciprocal_minutes_is_read_and_other_spellings_do_not_conflict() {
    let case = Case::new("row-of-units", "spellings");
    for spelling in [
        "min-1", "1/min", "U/min", "U/ min", "r/min", "RPM", "rpm", "min^-1", "min⁻¹",
    ] {
        case.write(
            "rig.csv",
            format!("T;n_in;P\nNm;{spelling};W\n10,0;1000;104,72\n12,0;1000;125,66\n"),
        );
        for study in ["study.yaml", "stated.yaml"] {
            assert!(
                greatest_difference(&case.result(study, "c")) < 0.01,
                "{spelling} {study}"
            );
        }
    }
}

#[test]
fn efficiencies_may_be_in_percent() {
    let case = Case::new("efficiency-in-percent", "right");
    let point = ["--torque", "1000 Nm", "--speed", "12 rpm", "--format", "json"];
    let of = |file: &str| -> f64 {
        let said = case.gearloss(&[&["solve", file][..], &point].concat());
        assert_eq!(said.code, Some(0), "{}", said.text);
        let result: Value = serde_json::from_str(&said.text).unwrap();
        result["efficiency"].as_f64().unwrap()
    };
    assert!(close(of("percent.yaml"), 0.955));
    assert!((of("two-stages.yaml") - 0.955 * 0.9808).abs() < 1e-9);
    let said = case.gearloss(&["check", "bare.yaml"]);
    assert!(
        said.text.contains("95.5 is out of range") && said.text.contains("write 0 to 1"),
        "{}",
        said.text
    );
    assert_eq!(si("95.5 %", "-").to_bits(), 0.955_f64.to_bits());
}

#[test]
fn whole_numbers_have_no_percent() {
    let case = Case::new("efficiency-in-percent", "whole");
    let text = std::fs::read_to_string(case.path("percent.yaml")).unwrap();
    case.write("teeth.yaml", text.replace("z: 20", "z: 2000 %"));
    let said = case.gearloss(&["check", "teeth.yaml"]);
    assert!(
        said.code != Some(0) && said.text.contains("a percentage where none is due"),
        "{}",
        said.text
    );
}

#[test]
fn us_units_have_their_values() {
    for (text, due, value) in [
        // NIST SP 811, Appendix B.
        ("60 lbf ft", "Nm", 81.34907689988402),
        ("60 ft lbf", "Nm", 81.34907689988402),
        ("60 lb-ft", "Nm", 81.34907689988402),
        ("60 ft-lbs", "Nm", 81.34907689988402),
        ("100 in lbf", "Nm", 11.298482902761668),
        ("10 hp", "W", 7456.998715822702),
        ("10 PS", "W", 7354.9875),
        ("2 ft", "mm", 0.6096),
        ("10 ft2", "m2", 0.9290304),
        ("10 in2", "mm2", 0.0064516),
        ("50 psi", "bar", 344737.86465841805),
        ("100 lb", "kg", 45.359237),
        ("5 gal/min", "l/min", 5.0 * 3.785411784e-3 / 60.0),
        ("1 gpm", "l/min", 3.785411784e-3 / 60.0),
        ("60 mph", "km/h", 26.8224),
        ("1000 BTU/h", "W", 293.0710701722222),
        ("16 uin", "um", 16.0 * 2.54e-8),
        ("140 degF", "degC", 60.0),
        ("140 F", "degC", 60.0),
        ("10 knots", "m/s", 5.144444444444445),
        ("1 BTU/(h ft2 degF)", "W/(m2 K)", 5.678263341113488),
        // Others of the trade.
        ("10 N.m", "Nm", 10.0),
        ("2 kN.m", "Nm", 2000.0),
        ("1.75 krpm", "rpm", 1750.0 * std::f64::consts::PI / 30.0),
        ("58.3 rps", "rpm", 58.3 * 2.0 * std::f64::consts::PI),
        ("400 nm", "um", 400e-9),
        ("46 St", "mm2/s", 46e-4),
        ("870 g/l", "kg/m3", 870.0),
        ("20 kW/(m2 K)", "W/(m2 K)", 20e3),
        ("2 W/(cm2 K)", "W/(m2 K)", 2e4),
        ("3 daNm", "Nm", 30.0),
        ("3 MNm", "Nm", 3e6),
        ("3 MW", "W", 3e6),
        ("50 gon", "deg", std::f64::consts::FRAC_PI_4),
        ("353.15 K", "degC", 80.0),
    ] {
        let found = si(text, due);
        assert!((found - value).abs() <= 2e-12 * value.abs(), "{text}: {found} {value}");
    }
}

#[test]
fn a_point_and_a_cycle_in_us_units_are_those_in_metric_units() {
    let case = Case::new("us-units", "point");
    let point = |torque: &str, speed: &str| {
        let said = case.gearloss(&[
            "solve",
            "gearbox.yaml",
            "--torque",
            torque,
            "--speed",
            speed,
            "--format",
            "json",
        ]);
        assert_eq!(said.code, Some(0), "{}", said.text);
        said.text
    };
    let us: Value = serde_json::from_str(&point("60 lbf ft", "1750 RPM")).unwrap();
    let metric: Value = serde_json::from_str(&point("81.34907689988402 Nm", "1750 U/min")).unwrap();
    assert_eq!(us["loss_w"], metric["loss_w"]);
    assert!(
        (us["loss_w"].as_f64().unwrap() - 0.1 * 81.349 * 1750.0 * std::f64::consts::PI / 30.0).abs() < 0.01,
        "{us}"
    );
    // The same drive in m/s.
    let of = |study: &str| {
        let result = case.result(study, "c");
        let mut cycle = result["cycles"][0].clone();
        cycle
            .as_object_mut()
            .unwrap()
            .retain(|key, _| key != "file" && key != "notes");
        assert!(cycle.as_object().unwrap().len() > 3, "{result}");
        cycle
    };
    let us = of("mph.yaml");
    case.write("mph.csv", "t [s],v [m/s]\n0,0\n1,4.4704\n2,8.9408\n");
    assert_eq!(us, of("mph.yaml"));
}

#[test]
fn help_never_repeats_the_number_with_another_unit() {
    for (text, due) in [
        ("1.75 krmp", "rpm"),
        ("1.75 KRPM", "rpm"),
        ("47 mmm", "mm"),
        ("46 cst", "mm2/s"),
        ("600 degN", "degC"),
        ("600 degR", "degC"),
        ("15 Grad", "deg"),
        ("15 grad", "deg"),
        ("58.3 1/s", "rpm"),
        ("220 SUS", "mm2/s"),
        ("220 SSU", "mm2/s"),
        ("25 cps", "mPa s"),
        ("17 ton", "kg"),
        ("100 lb", "N"),
        ("39.7 mPa s", "mm2/s"),
        ("3 nm", "Nm"),
        ("0.35 mm", "-"),
        ("12 xyz", "-"),
    ] {
        let (number, _) = text.split_once(' ').unwrap();
        let help = help(text, due);
        assert!(!help.contains(number), "{text}: {help}");
        assert!(!help.is_empty());
    }
    assert!(help("15 Grad", "deg").contains("`deg` in German and `gon` elsewhere"));
    assert!(help("220 SUS", "mm2/s").contains("ASTM D2161"));
    assert!(help("58.3 1/s", "rpm").contains("`Hz` for turns"));
    assert!(help("100 lb", "N").contains("`lbf`"));
    assert!(help("39.7 mPa s", "mm2/s").contains("`eta40`"));
}

#[test]
fn oils_are_stated_by_their_dynamic_viscosity_and_density() {
    let case = Case::new("dynamic-viscosity", "right");
    let said = case.gearloss(&["check", "gearbox.yaml"]);
    assert!(
        said.code != Some(0) && said.text.contains("divide a dynamic viscosity by the density"),
        "{}",
        said.text
    );
    // 0.039694 Pa s at 862.9 kg/m3 are 46.0 mm2/s.
    for file in ["eta.yaml", "points.yaml"] {
        let language = common::language();
        let text = std::fs::read_to_string(case.path(file)).unwrap();
        let walked = language.walk_gearbox(&read_yaml(0, &text).node);
        assert!(walked.findings.is_empty(), "{:?}", walked.findings);
        let entry = serde_json::from_value(walked.value["lubricants"]["oil"].clone()).unwrap();
        let oil = gearloss_framework::lubricant::Lubricant::new(&entry).unwrap();
        assert!(
            (oil.oil_at(40.0).nu - 0.039694 / 862.9).abs() < 1e-14,
            "{}",
            oil.oil_at(40.0).nu
        );
        assert!((1e6 * oil.oil_at(40.0).nu - 46.0).abs() < 0.001);
        assert!((oil.eta(100.0) - 6.075e-3).abs() < 1e-12);
        let said = case.gearloss(&["check", file]);
        assert_eq!(said.code, Some(0), "{}", said.text);
        // Without its density the oil is not known.
        case.write(
            "without.yaml",
            text.replace("density: { value: 862.9 kg/m3, at: 40 degC }, ", ""),
        );
        let said = case.gearloss(&["check", "without.yaml"]);
        assert!(
            said.code != Some(0) && said.text.contains("without the density"),
            "{}",
            said.text
        );
    }
    let text = std::fs::read_to_string(case.path("eta.yaml")).unwrap();
    case.write(
        "both.yaml",
        text.replace("eta40: 39.694 mPa s", "eta40: 39.694 mPa s, kv40: 46 mm2/s"),
    );
    let said = case.gearloss(&["check", "both.yaml"]);
    assert!(
        said.code != Some(0) && said.text.contains("`kv40` and `eta40` are both stated"),
        "{}",
        said.text
    );
}

#[test]
fn implausible_oils_are_findings_on_both_sides() {
    let case = Case::new("us-units", "oils");
    let text = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    let stated = "kv40: 46 mm2/s, kv100: 8 mm2/s";
    for (oil, is_plausible) in [
        (stated, true),
        ("kv40: 46000 mm2/s, kv100: 800 mm2/s", false),
        ("kv40: 46 mm2/s, kv100: 45 mm2/s", false),
        ("kv40: 46 mm2/s, kv100: 2.5 mm2/s", false),
        ("kv40: 0.6 mm2/s, kv100: 0.3 mm2/s, law: astm_d341_low", false),
        ("kv40: 680 mm2/s, kv100: 36 mm2/s", true),
        ("kv40: 3200 mm2/s, kv100: 220 mm2/s", true),
        ("kv40: 5 mm2/s, kv100: 1.7 mm2/s, law: astm_d341_low", true),
        ("kv40: 10 mm2/s, kv100: 2.7 mm2/s", true),
        ("kv40: 220 mm2/s, kv100: 41 mm2/s", true),
    ] {
        case.write("oil.yaml", text.replace(stated, oil));
        let said = case.gearloss(&["check", "oil.yaml"]);
        assert_eq!(said.code, Some(0), "{oil}: {}", said.text);
        let is_warned =
            said.text.contains("lubricants.oil.viscosity") && said.text.contains("check the numbers and their units");
        assert_eq!(!is_warned, is_plausible, "{oil}: {}", said.text);
    }
    case.write(
        "oil.yaml",
        text.replace(stated, "kv40: 46000 mm2/s, kv100: 800 mm2/s")
            + "\nplausibility: { greatest_kv40: 50000 mm2/s }\n",
    );
    let said = case.gearloss(&["check", "oil.yaml"]);
    assert!(!said.text.contains("check the numbers"), "{}", said.text);
}

#[test]
fn cells_of_a_map_equal_listed_values_to_the_bit() {
    let case = Case::new("grid-in-rpm", "map");
    let study = std::fs::read_to_string(case.path("study.yaml")).unwrap();
    for (speed, torque) in [("000 rpm", "Nm"), (" Hz", "N mm"), ("00 U/min", "lbf in")] {
        case.write("study.yaml", study.replace("000 rpm", speed).replace("Nm", torque));
        let said = case.gearloss(&["run", "study.yaml", "-o", "results"]);
        assert_eq!(said.code, Some(0), "{}", said.text);
        let of = |name: &str| std::fs::read_to_string(case.path(&format!("results/{name}.csv"))).unwrap();
        assert_eq!(of("steps"), of("listed"), "{speed} {torque}");
    }
}

#[test]
fn measured_numbers_beyond_those_of_documents_are_refused() {
    let case = Case::new("speed-in-hertz", "limits");
    for (row, column) in [
        ("1e308;16,7;104", "`T`"),
        ("10;1e308;104", "`n_in`"),
        ("10;2e4;104", ""),
        ("10;16,7;-1e12", "`P`"),
    ] {
        case.write("rig.csv", format!("T [Nm];n_in [Hz];P [W]\n{row}\n"));
        let said = case.gearloss(&["check", "study.yaml"]);
        assert_ne!(said.code, Some(0), "{}", said.text);
        assert!(
            said.text.contains(column) && said.text.contains("unrealistically large"),
            "{}",
            said.text
        );
    }
}

// Random quantities.

/// A generator of numbers from a seed.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        random_bits(&mut self.0)
    }

    fn below(&mut self, most: usize) -> usize {
        (self.bits() % most as u64) as usize
    }

    fn pick<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> &'a T {
        list[self.below(list.len())]
    }
}

/// What a part of a unit is worth, typed a second time: symbols without and with SI prefixes.
struct Kind {
    bare: &'static [(&'static str, f64)],
    si: &'static [(&'static str, f64)],
}

const PREFIXES: [(&str, f64); 12] = [
    ("p", 1e-12),
    ("n", 1e-9),
    ("u", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("d", 1e-1),
    ("da", 1e1),
    ("h", 1e2),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
    ("T", 1e12),
];

const RPM: f64 = std::f64::consts::PI / 30.0;
const LENGTH: Kind = Kind {
    bare: &[("in", 0.0254), ("ft", 0.3048), ("mi", 1609.344)],
    si: &[("m", 1.0)],
};
const FORCE: Kind = Kind {
    bare: &[("lbf", 4.4482216152605), ("kgf", 9.80665)],
    si: &[("N", 1.0)],
};
const POUNDS: Kind = Kind {
    bare: &[
        ("lbf", 4.4482216152605),
        ("lb", 4.4482216152605),
        ("lbs", 4.4482216152605),
    ],
    si: &[],
};
const FEET: Kind = Kind {
    bare: &[("in", 0.0254), ("ft", 0.3048)],
    si: &[],
};
const TIME: Kind = Kind {
    bare: &[("min", 60.0), ("h", 3600.0), ("sec", 1.0)],
    si: &[("s", 1.0)],
};
const MASS: Kind = Kind {
    bare: &[("t", 1e3), ("lb", 0.45359237)],
    si: &[("g", 1e-3)],
};
const VOLUME: Kind = Kind {
    bare: &[("gal", 3.785411784e-3), ("cc", 1e-6)],
    si: &[("l", 1e-3), ("L", 1e-3)],
};
const ANGLE: Kind = Kind {
    bare: &[
        ("deg", RPM / 6.0),
        ("gon", RPM / 200.0 * 30.0),
        ("rad", 1.0),
        ("mrad", 1e-3),
    ],
    si: &[],
};
const TURNS: Kind = Kind {
    bare: &[
        ("rpm", RPM),
        ("RPM", RPM),
        ("krpm", 1e3 * RPM),
        ("1/min", RPM),
        ("min-1", RPM),
        ("U/min", RPM),
        ("r/min", RPM),
        ("rps", 60.0 * RPM),
    ],
    si: &[("Hz", 60.0 * RPM)],
};
const POWER: Kind = Kind {
    bare: &[("hp", 745.6998715822702), ("PS", 735.49875)],
    si: &[("W", 1.0)],
};
const ENERGY: Kind = Kind {
    bare: &[("BTU", 1055.05585262)],
    si: &[("J", 1.0)],
};
const PRESSURE: Kind = Kind {
    bare: &[("psi", 6894.757293168361)],
    si: &[("Pa", 1.0), ("bar", 1e5)],
};
const STOKES: Kind = Kind {
    bare: &[],
    si: &[("St", 1e-4)],
};
const POISE: Kind = Kind {
    bare: &[],
    si: &[("P", 0.1)],
};
const KELVIN: Kind = Kind {
    bare: &[("K", 1.0), ("degC", 1.0), ("degF", 5.0 / 9.0)],
    si: &[],
};
const KELVIN_ALONE: Kind = Kind {
    bare: &[("K", 1.0)],
    si: &[],
};
const SPEED: Kind = Kind {
    bare: &[("mph", 0.44704), ("knots", 1852.0 / 3600.0)],
    si: &[],
};
const PERCENT: Kind = Kind {
    bare: &[("%", 0.01)],
    si: &[],
};

/// A part of a compound: symbols in a power, text, or a sign of multiplication.
enum Part {
    Of(&'static Kind, i32),
    Text(&'static str),
    Times,
}
use Part::{Of, Text, Times};

/// Compounds by documented unit.
const COMPOUNDS: &[(&str, &[Part])] = &[
    ("-", &[Of(&PERCENT, 1)]),
    ("mm", &[Of(&LENGTH, 1)]),
    ("mm2", &[Of(&LENGTH, 2)]),
    ("l", &[Of(&LENGTH, 3)]),
    ("l", &[Of(&VOLUME, 1)]),
    ("deg", &[Of(&ANGLE, 1)]),
    ("rpm", &[Of(&TURNS, 1)]),
    ("rpm", &[Of(&ANGLE, 1), Text("/"), Of(&TIME, -1)]),
    ("m/s", &[Of(&LENGTH, 1), Text("/"), Of(&TIME, -1)]),
    ("m/s", &[Of(&SPEED, 1)]),
    ("Nm", &[Of(&FORCE, 1), Times, Of(&LENGTH, 1)]),
    ("Nm", &[Of(&POUNDS, 1), Times, Of(&FEET, 1)]),
    ("Nm", &[Of(&FEET, 1), Times, Of(&POUNDS, 1)]),
    ("N", &[Of(&FORCE, 1)]),
    ("N/mm", &[Of(&FORCE, 1), Text("/"), Of(&LENGTH, -1)]),
    (
        "Nm/rad",
        &[Of(&FORCE, 1), Times, Of(&LENGTH, 1), Text("/"), Of(&ANGLE, -1)],
    ),
    ("W", &[Of(&POWER, 1)]),
    ("W", &[Of(&ENERGY, 1), Text("/"), Of(&TIME, -1)]),
    ("J", &[Of(&ENERGY, 1)]),
    ("J", &[Of(&POWER, 1), Times, Of(&TIME, 1)]),
    ("kg", &[Of(&MASS, 1)]),
    ("kg/m3", &[Of(&MASS, 1), Text("/"), Of(&LENGTH, -3)]),
    ("kg/m3", &[Of(&MASS, 1), Text("/"), Of(&VOLUME, -1)]),
    ("mm2/s", &[Of(&LENGTH, 2), Text("/"), Of(&TIME, -1)]),
    ("mm2/s", &[Of(&STOKES, 1)]),
    ("mPa s", &[Of(&PRESSURE, 1), Times, Of(&TIME, 1)]),
    ("mPa s", &[Of(&POISE, 1)]),
    ("MPa", &[Of(&PRESSURE, 1)]),
    ("MPa", &[Of(&FORCE, 1), Text("/"), Of(&LENGTH, -2)]),
    ("1/GPa", &[Text("1/"), Of(&PRESSURE, -1)]),
    ("s", &[Of(&TIME, 1)]),
    ("K", &[Of(&KELVIN_ALONE, 1)]),
    ("1/K", &[Text("1/"), Of(&KELVIN, -1)]),
    ("m/s2", &[Of(&LENGTH, 1), Text("/"), Of(&TIME, -2)]),
    ("rpm/s", &[Of(&TURNS, 1), Text("/"), Of(&TIME, -1)]),
    (
        "N s/m",
        &[Of(&FORCE, 1), Times, Of(&TIME, 1), Text("/"), Of(&LENGTH, -1)],
    ),
    (
        "N s2/m2",
        &[Of(&FORCE, 1), Times, Of(&TIME, 2), Text("/"), Of(&LENGTH, -2)],
    ),
    ("l/min", &[Of(&VOLUME, 1), Text("/"), Of(&TIME, -1)]),
    ("kg/s", &[Of(&MASS, 1), Text("/"), Of(&TIME, -1)]),
    (
        "W/(m2 K)",
        &[
            Of(&POWER, 1),
            Text("/("),
            Of(&LENGTH, -2),
            Times,
            Of(&KELVIN, -1),
            Text(")"),
        ],
    ),
    (
        "W/(m K)",
        &[
            Of(&POWER, 1),
            Text("/("),
            Of(&LENGTH, -1),
            Times,
            Of(&KELVIN, -1),
            Text(")"),
        ],
    ),
    ("W/K", &[Of(&POWER, 1), Text("/"), Of(&KELVIN, -1)]),
    ("K/W", &[Of(&KELVIN, 1), Text("/"), Of(&POWER, -1)]),
    ("J/K", &[Of(&ENERGY, 1), Text("/"), Of(&KELVIN, -1)]),
    (
        "J/(kg K)",
        &[
            Of(&ENERGY, 1),
            Text("/("),
            Of(&MASS, -1),
            Times,
            Of(&KELVIN, -1),
            Text(")"),
        ],
    ),
];

/// Units with an offset: spelling, SI value of a number.
const TEMPERATURES: [(&str, f64, f64); 6] = [
    ("degC", 1.0, 0.0),
    ("°C", 1.0, 0.0),
    ("C", 1.0, 0.0),
    ("degF", 5.0 / 9.0, -160.0 / 9.0),
    ("F", 5.0 / 9.0, -160.0 / 9.0),
    ("K", 1.0, -273.15),
];

/// Documented unit, spelling, and the SI values of one and zero.
fn random_unit(random: &mut Random) -> (&'static str, String, f64, f64) {
    let which = random.below(COMPOUNDS.len() + 1);
    let Some((due, parts)) = COMPOUNDS.get(which) else {
        let (text, factor, offset) = TEMPERATURES[random.below(TEMPERATURES.len())];
        return ("degC", text.to_owned(), factor, offset);
    };
    let (mut text, mut factor) = (String::new(), 1.0);
    for part in *parts {
        match part {
            Text("/") => text.push_str(random.pick(&["/", "/", " / ", "/ "])),
            Text(symbol) => text.push_str(symbol),
            Times => text.push_str(random.pick(&[" ", "·", "*", " · ", "-", ".", "⋅"])),
            Of(kind, power) => {
                let all = kind.bare.len() + kind.si.len();
                let which = random.below(all);
                let (symbol, value) = *kind
                    .bare
                    .get(which)
                    .unwrap_or_else(|| &kind.si[which - kind.bare.len()]);
                let is_si = which >= kind.bare.len();
                let (prefix, scale) = if is_si && random.below(2) == 0 {
                    PREFIXES[random.below(PREFIXES.len())]
                } else {
                    ("", 1.0)
                };
                let prefix = if prefix == "u" {
                    random.pick(&["u", "µ", "μ"])
                } else {
                    prefix
                };
                let symbol = match symbol {
                    "deg" | "degC" | "degF" if random.below(2) == 0 => symbol.replace("deg", "°"),
                    "min-1" => random.pick(&["min-1", "min^-1", "min⁻¹"]).to_owned(),
                    _ => symbol.to_owned(),
                };
                text.push_str(prefix);
                text.push_str(&symbol);
                text.push_str(match power.abs() {
                    2 => random.pick(&["2", "²", "^2"]),
                    3 => random.pick(&["3", "³", "^3"]),
                    _ => "",
                });
                factor *= (value * scale).powi(*power);
            }
        }
    }
    (due, text, factor, 0.0)
}

fn random_number(random: &mut Random) -> f64 {
    let digits = (random.bits() % 100_000) as f64 - 50_000.0;
    digits / [1.0, 10.0, 1000.0][random.below(3)]
}

/// The same value, or an error: `None`. Products of factors may round otherwise.
fn assert_same(what: &str, found: Option<f64>, expected: f64, refused: &mut usize) {
    match found {
        Some(found) => assert!(
            (found - expected).abs()
                <= 1e-11 * expected.abs().max(1e-12 * expected.abs())
                    + 1e-10 * f64::from(u8::from(what.contains("degC"))),
            "{what}: {found} instead of {expected}"
        ),
        None => *refused += 1,
    }
}

/// The number of a column in a file, in SI.
fn in_table(bytes: &[u8], due: &'static str) -> Option<f64> {
    let wanted = [("x", due)];
    let sheet = Sheet::open(bytes, &TableForm::default(), &wanted, Assigned::default()).ok()?;
    sheet.number(0, 0).ok()?
}

fn workbook(unit: &str, number: f64) -> Vec<u8> {
    let mut book = Workbook::new();
    let sheet = book.add_worksheet();
    sheet.write(0, 0, format!("x [{unit}]")).unwrap();
    sheet.write(1, 0, number).unwrap();
    book.save_to_buffer().unwrap()
}

#[test]
fn a_quantity_has_the_same_value_in_every_format_or_is_an_error() {
    let mut random = Random(53);
    let (mut refused, mut count) = (BTreeMap::new(), 0);
    let cases = std::env::var("UNIT_CASES")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(4000);
    for i in 0..cases {
        let (due, spelling, factor, offset) = random_unit(&mut random);
        let number = random_number(&mut random);
        let expected = number * factor + offset;
        let what = format!("{number} {spelling} ({due})");
        count += 1;
        let mut same = |format: &'static str, found: Option<f64>| {
            assert_same(
                &format!("{format}: {what}"),
                found,
                expected,
                refused.entry(format).or_default(),
            );
        };
        let text = format!("{number} {spelling}");
        same("text", parse_quantity(&text, unit(due)).ok());
        let node = read_yaml(0, &format!("x: {text}\n")).node;
        let yaml = match &node.content {
            Content::Map(entries) => match &entries[0].1.content {
                Content::Text { text, .. } => parse_quantity(text, unit(due)).ok(),
                _ => None,
            },
            _ => None,
        };
        same("YAML", yaml);
        same("CSV", in_table(format!("x [{spelling}]\n{number}\n").as_bytes(), due));
        same(
            "row of units",
            in_table(format!("x,y\n{spelling},s\n{number},1\n").as_bytes(), due),
        );
        same(
            "MDF",
            in_table(&builder::simple(&[("x", &spelling)], &[vec![number]]), due),
        );
        if i % 10 == 0 {
            same("xlsx", in_table(&workbook(&spelling, number), due));
        }
    }
    // The units are known, so refusals are rare: large numbers, and parentheses at the end of a cell.
    for (format, refused) in refused {
        assert!(refused * 5 <= count, "{format}: {refused} of {count} are refused");
    }
}

#[test]
fn the_command_line_reads_random_quantities() {
    let case = Case::new("us-units", "random");
    let mut random = Random(7);
    let mut done = 0;
    while done < 12 {
        let (due, spelling, factor, _) = random_unit(&mut random);
        let number = 0.001 + random_number(&mut random).abs();
        let expected = number * factor;
        if !["rpm", "Nm"].contains(&due) || !(1e-3..1e4).contains(&expected) {
            continue;
        }
        done += 1;
        let text = format!("{number} {spelling}");
        let (torque, speed) = if due == "Nm" {
            (text.as_str(), "100 rad/s")
        } else {
            ("100 Nm", text.as_str())
        };
        let said = case.gearloss(&[
            "solve",
            "gearbox.yaml",
            "--torque",
            torque,
            "--speed",
            speed,
            "--format",
            "json",
        ]);
        assert_eq!(said.code, Some(0), "{text}: {}", said.text);
        let result: Value = serde_json::from_str(&said.text).unwrap();
        let loss = result["loss_w"].as_f64().unwrap();
        assert!((loss - 0.1 * 100.0 * expected).abs() <= 1e-6 * loss, "{text}: {loss}");
    }
}

#[test]
fn misspelt_units_never_become_others() {
    let mut random = Random(11);
    for _ in 0..4000 {
        let (due, spelling, ..) = random_unit(&mut random);
        let mut characters: Vec<char> = spelling.chars().collect();
        let at = random.below(characters.len());
        match random.below(4) {
            0 => {
                characters.remove(at);
            }
            1 => characters.insert(at, characters[at]),
            2 if at + 1 < characters.len() => characters.swap(at, at + 1),
            _ => characters[at] = if characters[at].is_lowercase() { 'Q' } else { 'q' },
        }
        let wrong: String = characters.into_iter().collect();
        let text = format!("7319 {wrong}");
        if let Err(fault) = parse_quantity(&text, unit(due)) {
            let help = fault.help.unwrap_or_default();
            let is_spacing = help == format!("write `7319 {}`", wrong.trim());
            // Without a unit the number itself is right in the documented unit.
            assert!(
                is_spacing || wrong.is_empty() || !help.contains("7319"),
                "{text}: {help}"
            );
        }
    }
}

#[test]
fn the_published_pattern_is_what_is_read() {
    let mut random = Random(3);
    let mut validators = BTreeMap::new();
    let (mut matched, mut unmatched) = (0, 0);
    for _ in 0..6000 {
        let (due, mut spelling, ..) = random_unit(&mut random);
        if random.below(2) == 0 {
            let mut characters: Vec<char> = spelling.chars().collect();
            let at = random.below(characters.len());
            let other = *random.pick(&[
                &'m', &' ', &'2', &'²', &'^', &'-', &'·', &'/', &'k', &'(', &')', &'°', &'µ', &'g',
            ]);
            match random.below(3) {
                0 => characters[at] = other,
                1 => characters.insert(at, other),
                _ => {
                    characters.remove(at);
                }
            }
            spelling = characters.into_iter().collect();
        }
        let validator = validators.entry(due).or_insert_with(|| {
            jsonschema::validator_for(&serde_json::json!({ "type": "string", "pattern": unit(due).pattern() })).unwrap()
        });
        let text = format!("1.5 {spelling}");
        let read = parse_quantity(&text, unit(due)).is_ok();
        assert_eq!(validator.is_valid(&Value::from(text.as_str())), read, "{text} as {due}");
        if read {
            matched += 1;
        } else {
            unmatched += 1;
        }
    }
    assert!(matched > 3000 && unmatched > 1000, "{matched} {unmatched}");
}

#[test]
fn the_page_of_units_states_their_values() {
    let page = std::fs::read_to_string(common::file("docs/units.md")).unwrap();
    // Rows of the tables are: spellings, value in a documented unit.
    let rows: Vec<(Vec<&str>, &str)> = page
        .lines()
        .filter_map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
            let [spellings, value] = cells[..] else { return None };
            let spellings = spellings.split('`').skip(1).step_by(2).collect::<Vec<_>>();
            let value = value.strip_prefix("= ")?;
            (!spellings.is_empty()).then_some((spellings, value))
        })
        .collect();
    assert!(rows.len() > 25, "{}", rows.len());
    for (spellings, value) in rows {
        let (number, symbol) = value.split_once(' ').unwrap();
        let due = Unit::of_symbol(symbol).unwrap_or_else(|| panic!("{value}"));
        let expected = due.to_si(number.replace(' ', "").parse().unwrap());
        for spelling in spellings {
            let one = si(&format!("1 {spelling}"), symbol);
            assert!(
                (one - expected).abs() <= 1e-6 * expected.abs(),
                "{spelling} = {value}: {one} {expected}"
            );
        }
    }
    // Every usual unit is listed.
    for symbol in Unit::all_symbols().filter(|symbol| *symbol != "-") {
        assert!(page.contains(&format!("`{symbol}`")), "`{symbol}` is not on the page");
    }
}
