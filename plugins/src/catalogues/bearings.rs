//! Every row of the catalogues of bearings against rules that rows of neighbours and other kinds confirm.
#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};

use gearloss_framework::registry::Files;
use gearloss_framework::resolve::{basic_designation, read_designation};
use gearloss_framework::testing::language;

use crate::printed::{Printed, Row};

/// The shipped rows: of one maker, and typical ones.
fn catalogues() -> [Printed; 2] {
    [
        Printed::read(include_str!("../../catalogues/bearings.csv")),
        Printed::read(include_str!("../../catalogues/bearings-typical.csv")),
    ]
}

fn for_each(mut check: impl FnMut(&Row<'_>)) {
    for catalogue in catalogues() {
        catalogue.rows().for_each(|row| check(&row));
    }
}

/// Bore, outside diameter and width. \[mm\]
fn sizes(row: &Row<'_>) -> [f64; 3] {
    ["bore [mm]", "outside [mm]", "width [mm]"].map(|column| row.number(column))
}

/// True for inch bearings and those with designations of ISO 355, whose numbers are not those of a series.
fn is_without_series(row: &Row<'_>) -> bool {
    ["H", "HM", "L", "LM", "M", "T", "other"].contains(&row.text("series"))
}

#[test]
fn there_are_at_least_1350_designations_without_variants_by_suffix() {
    let mut all = BTreeSet::new();
    for_each(|row| assert!(all.insert(row.text("designation"))));
    assert!(all.len() >= 1350, "{}", all.len());
    // Two rows are not one bearing with and without a suffix: neither leads to the other, or their designs are catalogued apart.
    for name in &all {
        let others = all.iter().copied().filter(|other| other != name);
        if let Some(read) = read_designation(name, others) {
            let is_design = |written: &str| ["EC", "B", "E", "A"].contains(&written);
            assert!(
                read.suffixes.iter().all(|suffix| is_design(&suffix.written)),
                "{name}: {read:?}"
            );
        }
    }
}

/// A digit that is changed, omitted or doubled, and a separator in its place: another known bearing, the same one, or none.
#[test]
fn near_misses_never_lead_to_another_size() {
    let all: Vec<String> = language().catalogue("bearings").unwrap().0.keys().cloned().collect();
    let known = || all.iter().map(String::as_str);
    // Groups of digits, which a stroke or letters separate.
    let digits = |text: &str| {
        let groups = text.split(|c: char| !c.is_ascii_digit());
        groups
            .filter(|group| !group.is_empty())
            .map(str::to_owned)
            .collect::<Vec<String>>()
    };
    let mut read = 0;
    for designation in known() {
        for (place, letter) in designation.char_indices() {
            let (before, after) = (&designation[..place], &designation[place + 1..]);
            let next = match letter.to_digit(10) {
                Some(digit) => char::from_digit((digit + 1) % 10, 10).unwrap(),
                None => letter,
            };
            for written in [
                format!("{before}{next}{after}"),
                format!("{before}{after}"),
                format!("{before}{letter}{letter}{after}"),
                format!("{before}/{letter}{after}"),
            ] {
                let Some(found) = read_designation(&written, known()) else {
                    continue;
                };
                read += 1;
                let [base, changed] = [digits(found.base), digits(&written)];
                assert_eq!(base, changed, "{written}: {}", found.base);
            }
        }
    }
    assert!(read > 1000, "{read}");
}

#[test]
fn designations_state_kind_and_bore() {
    for_each(|row| {
        let designation = row.text("designation");
        let digits = designation.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        let digits = digits.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        if is_without_series(row) {
            assert_eq!(basic_designation(designation), None, "{designation}");
            return;
        }
        let bore = match digits.split_once('/') {
            Some((_, bore)) => bore.parse().unwrap(),
            None if digits.len() == 3 && designation == digits => digits[2..].parse().unwrap(),
            None => match &digits[digits.len() - 2..] {
                "00" => 10.0,
                "01" => 12.0,
                "02" => 15.0,
                "03" => 17.0,
                code => 5.0 * code.parse::<f64>().unwrap(),
            },
        };
        assert_eq!(row.number("bore [mm]"), bore, "{designation}");
        if let Some(basic) = basic_designation(designation) {
            assert_eq!(basic.kind, row.text("kind"), "{designation}");
            assert_eq!(basic.bore, Some(bore), "{designation}");
            assert_eq!(
                basic.series.as_deref().map(|series| series.trim_end_matches(" X")),
                Some(row.text("series").trim_end_matches(" X")),
                "{designation}"
            );
        } else {
            assert_eq!(designation.len(), 3, "{designation}");
        }
    });
}

/// Dimension series of ISO 15: width series and diameter series. Tapered roller bearings have widths of ISO 355.
fn dimension_series(row: &Row<'_>) -> Option<(&'static str, &'static str)> {
    let series = row.text("series");
    let letters = series.trim_end_matches(['A', 'B', 'C', 'D', 'E', 'X', ' ']);
    Some(match (row.text("kind"), letters) {
        ("tapered_roller", "302" | "322" | "332") => ("", "2"),
        ("tapered_roller", "303" | "313" | "323") => ("", "3"),
        ("tapered_roller", "320" | "330") => ("", "0"),
        ("tapered_roller", "331") => ("", "1"),
        ("tapered_roller", "329") => ("", "9"),
        ("deep_groove_ball", "160") => ("0", "0"),
        ("deep_groove_ball", "60") | ("cylindrical_roller", "10") => ("1", "0"),
        ("deep_groove_ball", "618") => ("1", "8"),
        ("deep_groove_ball", "619") => ("1", "9"),
        ("deep_groove_ball", "62")
        | ("angular_contact_ball", "72")
        | ("cylindrical_roller", "2")
        | ("self_aligning_ball", "12") => ("0", "2"),
        ("deep_groove_ball", "63")
        | ("angular_contact_ball", "73")
        | ("cylindrical_roller", "3")
        | ("self_aligning_ball", "13")
        | ("spherical_roller", "213")
        | ("four_point_contact_ball", "QJ3") => ("0", "3"),
        ("deep_groove_ball", "64") | ("cylindrical_roller", "4") => ("0", "4"),
        ("self_aligning_ball" | "cylindrical_roller", "22") | ("spherical_roller", "222") => ("2", "2"),
        ("self_aligning_ball" | "cylindrical_roller", "23") | ("spherical_roller", "223") => ("2", "3"),
        ("angular_contact_ball_double_row", "32") | ("spherical_roller", "232") => ("3", "2"),
        ("angular_contact_ball_double_row", "33") => ("3", "3"),
        ("spherical_roller", "230") => ("3", "0"),
        ("spherical_roller", "231") => ("3", "1"),
        ("spherical_roller", "239") => ("3", "9"),
        ("spherical_roller", "240") => ("4", "0"),
        ("spherical_roller", "241") => ("4", "1"),
        _ => return None,
    })
}

#[test]
fn a_dimension_series_has_one_outside_diameter_and_one_width_for_a_bore() {
    let mut outside: BTreeMap<(&str, String), (f64, &str)> = BTreeMap::new();
    let mut width: BTreeMap<(&str, &str, String), (f64, &str)> = BTreeMap::new();
    let mut shared = 0;
    for_each(|row| {
        let designation = row.text("designation");
        let Some((width_series, diameter_series)) = dimension_series(row) else {
            assert!(is_without_series(row) || ["thrust_ball", "spherical_roller_thrust"].contains(&row.text("kind")));
            return;
        };
        let [d, big_d, b] = sizes(row);
        let known = outside
            .entry((diameter_series, d.to_string()))
            .or_insert((big_d, designation));
        assert_eq!(known.0, big_d, "{designation} and {}", known.1);
        shared += usize::from(known.1 != designation);
        // Two self-aligning ball bearings are wider than their series.
        if !width_series.is_empty() && !["1224", "1226"].contains(&designation) {
            let key = (width_series, diameter_series, d.to_string());
            let known = width.entry(key).or_insert((b, designation));
            assert_eq!(known.0, b, "{designation} and {}", known.1);
        }
    });
    assert!(shared > 700, "{shared} rows confirm others");
}

#[test]
fn ratings_are_in_the_range_of_their_kind() {
    for_each(|row| {
        let [c, c0] = ["c [N]", "c0 [N]"].map(|column| row.number(column));
        let [d, big_d, b] = sizes(row);
        // C0/C, and C over the section (D - d) B in N/mm2.
        let (ratio, area) = match row.text("kind") {
            "deep_groove_ball" => (0.33..1.65, 19.0..75.0),
            "angular_contact_ball" => (0.45..1.0, 30.0..60.0),
            "four_point_contact_ball" => (0.7..1.2, 50.0..90.0),
            "angular_contact_ball_double_row" => (0.6..1.0, 25.0..45.0),
            "self_aligning_ball" => (0.2..0.45, 20.0..36.0),
            "cylindrical_roller" => (0.75..1.7, 40.0..105.0),
            "tapered_roller" => (0.75..2.3, 38.0..142.0),
            "spherical_roller" => (0.95..2.2, 65.0..132.0),
            "thrust_ball" => (1.3..5.3, 30.0..106.0),
            "spherical_roller_thrust" => (2.6..5.0, 90.0..155.0),
            other => panic!("{other}"),
        };
        assert!(
            ratio.contains(&(c0 / c)),
            "{}: C0/C {}",
            row.text("designation"),
            c0 / c
        );
        let section = c / ((big_d - d) * b);
        assert!(area.contains(&section), "{}: {section} N/mm2", row.text("designation"));
    });
}

/// Larger bores of a series whose rating is less than that of the one before: means over different makers, or another internal design.
const DECREASES: [&str; 20] = [
    "NU1017", "16013", "16028", "61807", "61912", "62/22", "2205", "2214", "23944", "23956", "24076", "29460E",
    "29464E", "30236", "32034X", "33015", "33110", "51113", "51114", "51152",
];
/// The same, by more than 5 %.
const LARGE_DECREASES: [&str; 3] = ["61912", "32034X", "51209"];

#[test]
fn ratings_and_sizes_of_a_series_grow_with_the_bore() {
    let mut series: BTreeMap<[String; 4], Vec<([f64; 5], &str)>> = BTreeMap::new();
    for_each(|row| {
        let designation = row.text("designation");
        if is_without_series(row) {
            return;
        }
        let letters: String = designation.chars().take_while(char::is_ascii_alphabetic).collect();
        let design = if designation.ends_with("EC") { "EC" } else { "" };
        let [d, big_d, b] = sizes(row);
        let values = [d, big_d, b, row.number("c [N]"), row.number("c0 [N]")];
        let key = [row.text("kind"), row.text("series"), &letters, design].map(str::to_owned);
        series.entry(key).or_default().push((values, designation));
    });
    let mut decreases = BTreeSet::new();
    let mut large = BTreeSet::new();
    for rows in series.values_mut() {
        rows.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        for [(small, _), (great, name)] in rows.array_windows::<2>() {
            assert!(
                great[0] > small[0] && great[1] > small[1] && great[2] >= small[2],
                "{name}"
            );
            let least = (great[3] / small[3]).min(great[4] / small[4]);
            if least < 1.0 {
                decreases.insert(*name);
            }
            if least < 0.95 {
                large.insert(*name);
            }
        }
    }
    let expected: BTreeSet<&str> = DECREASES.into_iter().chain(["51209"]).collect();
    assert_eq!(decreases, expected);
    assert_eq!(large, LARGE_DECREASES.into_iter().collect());
}

/// Axial factors follow from the contact angle: e = 1.5 tan(alpha), and Y and Y0 are factors of cot(alpha) (ISO 281, ISO 76).
#[test]
fn axial_factors_belong_together() {
    let mut without = Vec::new();
    for_each(|row| {
        let designation = row.text("designation");
        let values = ["e [-]", "y [-]", "y0 [-]"].map(|column| row.cell(column));
        let stated = match (row.text("kind"), row.text("series")) {
            ("angular_contact_ball", _) => Some([1.14, 0.57, 0.26]),
            ("angular_contact_ball_double_row", "32 A" | "33 A") => Some([0.8, 1.24, 0.66]),
            ("angular_contact_ball_double_row", "33 D") => Some([1.34, 0.81, 0.44]),
            _ => None,
        };
        if let Some(stated) = stated {
            assert_eq!(values, stated.map(Some), "{designation}");
            return;
        }
        let (of_y, of_y0) = match row.text("kind") {
            "tapered_roller" => (0.4, 0.22),
            "spherical_roller" => (0.67, 0.44),
            _ => {
                assert_eq!(values, [None; 3], "{designation}");
                return;
            }
        };
        let [Some(e), Some(y), Some(y0)] = values else {
            without.push(designation);
            return;
        };
        assert!((0.15..0.9).contains(&e), "{designation}: e {e}");
        // Rows of one maker have one decimal.
        let tolerance = if y == (10.0 * y).round() / 10.0 { 0.05 } else { 0.006 };
        assert!(
            (y * e / (1.5 * of_y) - 1.0).abs() < tolerance,
            "{designation}: e {e}, Y {y}"
        );
        assert!(
            (y0 * e / (1.5 * of_y0) - 1.0).abs() < 2.5 * tolerance,
            "{designation}: e {e}, Y0 {y0}"
        );
    });
    assert_eq!(without.len(), 16, "{without:?}");
}

/// f0 of radial contact ball bearings according to ISO 76, by D_w cos(alpha)/D_pw in steps of 0.01; recalled.
const F0: [f64; 41] = [
    14.7, 14.9, 15.1, 15.3, 15.5, 15.7, 15.9, 16.1, 16.3, 16.5, 16.4, 16.1, 15.9, 15.6, 15.4, 15.2, 14.9, 14.7, 14.4,
    14.2, 14.0, 13.7, 13.5, 13.2, 13.0, 12.8, 12.5, 12.3, 12.1, 11.8, 11.6, 11.4, 11.2, 10.9, 10.7, 10.5, 10.3, 10.0,
    9.8, 9.6, 9.4,
];

/// f0 for balls of 0.3 (D - d) on the mean diameter.
fn calculation_factor(row: &Row<'_>) -> f64 {
    let [d, big_d, _] = sizes(row);
    let place = 100.0 * 0.3 * (big_d - d) / (0.5 * (d + big_d));
    let below = place.floor();
    let [low, high] = [F0[below as usize], F0[below as usize + 1]];
    low + (place - below) * (high - low)
}

#[test]
fn estimates_follow_their_rules_and_are_as_near_as_stated() {
    let [of_maker, typical] = catalogues();
    let mut deviations = Vec::new();
    let mut factors: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for row in of_maker.rows().filter(|row| row.text("kind") == "deep_groove_ball") {
        deviations.push(calculation_factor(&row) - row.number("calculation_factor [-]"));
        let counts = factors.entry(row.text("series")).or_default();
        *counts.entry(row.text("minimum_load_factor [-]")).or_default() += 1;
    }
    let square: f64 = deviations.iter().map(|x| x * x).sum();
    let standard = (square / deviations.len() as f64).sqrt();
    let greatest = deviations.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(
        (0.7..0.75).contains(&standard) && (2.4..2.5).contains(&greatest),
        "{standard} {greatest}"
    );
    let usual = |series: &str| *factors[series].iter().max_by_key(|(_, count)| **count).unwrap().0;
    for row in typical.rows() {
        let estimated: Vec<&str> = row.text("estimated").split_whitespace().collect();
        let f0 = row.cell("calculation_factor [-]");
        assert_eq!(f0.is_some(), row.text("kind") == "deep_groove_ball");
        assert_eq!(f0.is_some(), estimated.contains(&"calculation_factor"));
        if let Some(f0) = f0 {
            assert!(
                (f0 - calculation_factor(&row)).abs() < 0.0501,
                "{}",
                row.text("designation")
            );
        }
        let k_r = row.text("minimum_load_factor [-]");
        assert_eq!(!k_r.is_empty(), estimated.contains(&"minimum_load_factor"));
        assert!(
            k_r.is_empty() || k_r == usual(row.text("series")),
            "{}",
            row.text("designation")
        );
    }
}

#[test]
fn typical_ratings_state_their_evidence_and_no_maker() {
    let [_, typical] = catalogues();
    for row in typical.rows() {
        let basis = row.text("basis");
        let numbers: Vec<f64> = basis
            .split(' ')
            .filter_map(|word| word.trim_end_matches(';').parse().ok())
            .collect();
        let [makers, c, c0] = numbers[..] else {
            panic!("{basis}")
        };
        assert_eq!(
            basis,
            format!("typical of {makers} makers; max/min: C {c:.2}; C0 {c0:.2}")
        );
        assert!(
            (2.0..=5.0).contains(&makers) && (1.0..2.0).contains(&c) && (1.0..2.0).contains(&c0),
            "{basis}"
        );
        let expected = if c.max(c0) <= 1.2 { "high" } else { "disputed" };
        assert_eq!(row.text("confidence"), expected, "{}", row.text("designation"));
        // Three digits: they are means.
        for column in ["c [N]", "c0 [N]"] {
            let digits = row.text(column).trim_end_matches('0');
            assert!(digits.len() <= 3, "{}: {digits}", row.text("designation"));
        }
    }
}

/// A typical row and a row of one maker do not differ by more than makers do.
#[test]
fn every_row_is_read_and_accepted() {
    assert_eq!(language().faults_of_catalogues(), [""; 0]);
}

/// What each model of losses can calculate, and that it names the key or series that is missing for the others.
#[test]
fn models_name_what_they_lack_of_a_row() {
    let table = language().catalogue("bearings").unwrap();
    let registry = language().registry();
    let mechanism = registry.mechanism("bearing").unwrap();
    let mut ready: BTreeMap<&str, usize> = BTreeMap::new();
    let models = ["skf", "iso14179_1", "iso14179_2", "harris", "schaeffler"].map(|name| {
        let entry = registry.model("bearing", name).unwrap();
        (name, language().example_of(entry).unwrap().0)
    });
    for (designation, row) in &table.0 {
        let mut part = serde_json::Map::new();
        for (key, value) in &row.values {
            let value = language().checked(value, &format!("bearings.own.{key}")).unwrap();
            part.insert(key.clone(), value);
        }
        let part = serde_json::Value::Object(part);
        for (name, model) in &models {
            match (mechanism.eval)(registry, &Files::default(), model, &part, &serde_json::Map::new()) {
                Ok(_) => *ready.entry(name).or_default() += 1,
                Err(error) => {
                    let help = error.help.unwrap_or_default();
                    assert!(help.contains('`'), "{name}: {designation}: {help}");
                }
            }
        }
    }
    // Without e and Y: the makers' tables of 16 inch bearings have none.
    assert_eq!(ready["skf"], table.0.len() - 16);
}
