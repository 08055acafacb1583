//! Loads of the bearings over cycles for other programs: the same as `solve` gives at the same points.

use std::process::Command;

use serde_json::Value;

use crate::common::study::{Ran, number, of_gearbox, run_texts};

const GEARBOX: &str = "examples/two-speed-ev/gearbox.yaml";
const SPECTRUM: &str = "torque [Nm],speed [rpm],time [s]\n40,4000,1800\n-15,3000,600\n0,0,60\n";
const DRIVE: &str =
    "time [s],torque [Nm],speed [rpm]\n0,10,1000\n1,20,2000\n2,30,3000\n3,20,3500\n4,-10,3000\n5,0,0\n6,0,0\n";

fn ran(more: &str) -> Ran {
    let study = format!(
        "cycles:\n  loads: {{ spectrum: {{ file: loads.csv }} }}\n  drive: {{ file: drive.csv }}\nanalyses:\n  c: {{ type: cycle, gear: first, {more} }}\n"
    );
    run_texts(
        &of_gearbox(GEARBOX, &study),
        &[("loads.csv", SPECTRUM), ("drive.csv", DRIVE)],
    )
}

/// Cells by the names of their columns.
fn rows(text: &str) -> Vec<Vec<(String, String)>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let row = |record: csv::StringRecord| names.iter().cloned().zip(record.iter().map(str::to_owned)).collect();
    reader.records().map(|record| row(record.unwrap())).collect()
}

fn cell<'a>(row: &'a [(String, String)], name: &str) -> &'a str {
    &row.iter().find(|(known, _)| known == name).unwrap().1
}

fn value(row: &[(String, String)], name: &str) -> f64 {
    cell(row, name).parse().unwrap()
}

fn solved(torque: &str, speed: &str) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["solve", GEARBOX, "--gear", "first", "--format", "json"])
        .args([format!("--torque={torque} Nm"), format!("--speed={speed} rpm")])
        .output()
        .unwrap();
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn loads_of_a_spectrum_are_those_of_solve() {
    let ran = ran("cycles: [loads], export: [bearing_loads]");
    let rows = rows(ran.file("c-bearing_loads.csv"));
    // Eight bearings in each of three load cases.
    assert_eq!(rows.len(), 24);
    for (case, torque, speed) in [("1", "40", "4000"), ("2", "-15", "3000")] {
        let solved = solved(torque, speed);
        let mut compared = 0;
        for row in rows.iter().filter(|row| cell(row, "load_case") == case) {
            let loads = solved["supports"].as_array().unwrap();
            let found = loads
                .iter()
                .find(|load| load["support"] == cell(row, "bearing"))
                .unwrap();
            for name in ["radial_n", "axial_n", "tilting_nm"] {
                let (ours, theirs) = (value(row, name), number(&found[name]));
                assert!(
                    (ours - theirs).abs() <= 1e-9 * theirs.abs().max(1.0),
                    "{row:?} {name}: {theirs}"
                );
            }
            let length = value(row, "radial_y_n").hypot(value(row, "radial_z_n"));
            assert!((length - value(row, "radial_n")).abs() < 1e-6, "{row:?}");
            assert_eq!(value(row, "oil_degc"), 100.0);
            compared += 1;
        }
        assert_eq!(compared, 8);
    }
}

#[test]
fn the_forces_on_a_shaft_balance_its_teeth() {
    let ran = ran("cycles: [loads], export: [bearing_loads]");
    let rows = rows(ran.file("c-bearing_loads.csv"));
    let of = |bearing: &str, name: &str| {
        let row = rows
            .iter()
            .find(|row| cell(row, "load_case") == "1" && cell(row, "bearing") == bearing);
        value(row.unwrap(), name)
    };
    // The force of the mate on the pinion of the input shaft turns it back: 40 Nm at a working radius of 69 mm * 16 / 99.
    let tangential = 40.0 / (0.069 * 16.0 / 99.0);
    let sum = ["radial_y_n", "radial_z_n"].map(|name| of("bearings.B1", name) + of("bearings.B2", name));
    let normal = sum[0].hypot(sum[1]);
    let to_mate = [92.0 - 133.4, 69.0 - 124.2_f64];
    let length = to_mate[0].hypot(to_mate[1]);
    // The bearings push the pinion towards its mate against the separating force, and hold it against the tangential one.
    let radial = (sum[0] * to_mate[0] + sum[1] * to_mate[1]) / length;
    assert!(radial > 0.0, "{sum:?}");
    assert!(
        ((normal * normal - radial * radial).sqrt() / tangential - 1.0).abs() < 0.02,
        "{sum:?}"
    );
    assert_eq!(
        (of("bearings.B1", "inner_rpm"), of("bearings.B1", "outer_rpm")),
        (4000.0, 0.0)
    );
}

#[test]
fn intervals_of_a_cycle_are_load_cases_or_sorted_into_classes() {
    let each = ran("cycles: [drive], load_classes: 0, export: [bearing_loads]");
    let each = rows(each.file("c-bearing_loads.csv"));
    assert_eq!(each.len(), 6 * 8);
    let classes = ran("cycles: [drive], load_classes: 2, export: [bearing_loads]");
    assert!(
        classes.text.contains("% from those of the intervals"),
        "{}",
        classes.text
    );
    let classes = rows(classes.file("c-bearing_loads.csv"));
    assert!(classes.len() < each.len());
    let time = |rows: &[Vec<(String, String)>]| rows.iter().map(|row| value(row, "duration_s")).sum::<f64>();
    assert!((time(&each) - time(&classes)).abs() < 1e-9);
    let fine = ran("cycles: [drive], load_classes: 1000, export: [bearing_loads]");
    assert!(fine.text.contains("at most 0.00 %"), "{}", fine.text);
}

#[test]
fn rexs_has_the_same_loads() {
    let ran = ran("cycles: [loads, drive], export: [bearing_loads, rexs_loads]");
    let csv = rows(ran.file("c-bearing_loads.csv"));
    let set = cell(&csv[0], "model_set").to_owned();
    let text = ran.file(&format!("c-{set}-bearing_loads.rexs"));
    let document = roxmltree::Document::parse(text).unwrap();
    let spectra: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name("load_spectrum"))
        .collect();
    assert_eq!(spectra.len(), 2);
    let components = document.descendants().filter(|node| node.has_tag_name("load_case"));
    let bearings: Vec<_> = components
        .flat_map(|case| {
            case.children()
                .filter(|node| node.attribute("type") == Some("rolling_bearing_with_catalog_geometry"))
        })
        .collect();
    assert_eq!(bearings.len(), csv.len());
    for (node, row) in bearings.iter().zip(&csv) {
        for (id, column, factor) in [
            ("force_acting_on_inner_component_v", "radial_y_n", 1.0),
            ("force_acting_on_inner_component_w", "radial_z_n", 1.0),
            ("axial_force", "axial_n", 1e-3),
            ("speed_inner_ring", "inner_rpm", 1.0),
            ("temperature_lubricant", "oil_degc", 1.0),
        ] {
            let attribute = node.children().find(|child| child.attribute("id") == Some(id));
            let text: Option<f64> = attribute.map(|child| child.text().unwrap().parse().unwrap());
            let expected = Some(cell(row, column)).filter(|cell| !cell.is_empty());
            let expected = expected.map(|cell| cell.parse::<f64>().unwrap() * factor);
            let difference = text.zip(expected).map(|(a, b)| (a - b).abs() / b.abs().max(1.0));
            assert_eq!(
                (text.is_some(), difference.is_none_or(|x| x < 1e-9)),
                (expected.is_some(), true),
                "{id} {row:?}"
            );
        }
    }
}

#[test]
fn classes_without_an_export_of_loads_are_refused() {
    let ran = ran("cycles: [drive], load_classes: 5");
    assert!(ran.text.contains("no export has load cases"), "{}", ran.text);
}

/// Component, attribute, unit and type of its value in version 1.7 of REXS (`rexs_schema_1.7.xml` of the FVA, Apache-2.0): each attribute is
/// mapped to the component there.
const REXS_1_7: [(&str, &str, Option<&str>, &str); 9] = [
    ("gear_unit", "gear_shift_index", None, "integer"),
    ("gear_unit", "operating_time", Some("h"), "floating_point"),
    ("gear_unit", "operating_time_fraction", Some("%"), "floating_point"),
    (
        "rolling_bearing_with_catalog_geometry",
        "axial_force",
        Some("kN"),
        "floating_point",
    ),
    (
        "rolling_bearing_with_catalog_geometry",
        "force_acting_on_inner_component_v",
        Some("N"),
        "floating_point",
    ),
    (
        "rolling_bearing_with_catalog_geometry",
        "force_acting_on_inner_component_w",
        Some("N"),
        "floating_point",
    ),
    (
        "rolling_bearing_with_catalog_geometry",
        "speed_inner_ring",
        Some("1 / min"),
        "floating_point",
    ),
    (
        "rolling_bearing_with_catalog_geometry",
        "speed_outer_ring",
        Some("1 / min"),
        "floating_point",
    ),
    (
        "rolling_bearing_with_catalog_geometry",
        "temperature_lubricant",
        Some("C"),
        "floating_point",
    ),
];

/// Elements, ids, units and values are those of the schema, and the importer says what the model is.
#[test]
fn rexs_has_the_ids_units_and_values_of_version_1_7() {
    let ran = ran("cycles: [loads, drive], export: [bearing_loads, rexs_loads]");
    let csv = rows(ran.file("c-bearing_loads.csv"));
    let set = cell(&csv[0], "model_set").to_owned();
    let text = ran.file(&format!("c-{set}-bearing_loads.rexs"));
    let document = roxmltree::Document::parse(text).unwrap();
    let model = document.root_element();
    assert_eq!(
        (model.tag_name().name(), model.attribute("version")),
        ("model", Some("1.7"))
    );
    let children: Vec<&str> = model
        .children()
        .filter(roxmltree::Node::is_element)
        .map(|node| node.tag_name().name())
        .collect();
    assert_eq!(children, ["relations", "components", "load_spectrum", "load_spectrum"]);
    let of = |node: roxmltree::Node<'_, '_>| {
        let [id, kind] = ["id", "type"].map(|name| node.attribute(name).unwrap().to_owned());
        assert!(id.parse::<u32>().unwrap() > 0);
        (id, kind)
    };
    let components = model.children().find(|node| node.has_tag_name("components")).unwrap();
    let known: Vec<(String, String)> = components
        .children()
        .filter(roxmltree::Node::is_element)
        .map(of)
        .collect();
    let mut ids: Vec<&String> = known.iter().map(|(id, _)| id).collect();
    ids.dedup();
    assert_eq!(ids.len(), 9);
    let mut seen = std::collections::BTreeSet::new();
    for case in document.descendants().filter(|node| node.has_tag_name("load_case")) {
        for component in case.children().filter(roxmltree::Node::is_element) {
            let bearing = of(component);
            assert!(known.contains(&bearing), "{bearing:?}");
            for attribute in component.children().filter(roxmltree::Node::is_element) {
                let key = (
                    bearing.1.as_str(),
                    attribute.attribute("id").unwrap(),
                    attribute.attribute("unit"),
                );
                let schema = REXS_1_7.iter().find(|(kind, id, unit, _)| (*kind, *id, *unit) == key);
                let (.., value) = schema.unwrap_or_else(|| panic!("{key:?}"));
                let text = attribute.text().unwrap();
                assert!(text.parse::<f64>().unwrap().is_finite());
                assert!(*value != "integer" || text.parse::<i64>().is_ok(), "{key:?} {text}");
                seen.insert(key.1.to_owned());
            }
        }
    }
    assert_eq!(seen.len(), REXS_1_7.len());
    let findings =
        gearloss_exchange::rexs::import(text.as_bytes(), "loads.rexs", &crate::common::language()).unwrap_err();
    let told = findings.render();
    assert!(told.contains("the model has no gears"), "{told}");
    assert!(
        told.contains("it has loads of 8 bearings in") && told.contains("no gears, shafts, positions and relations"),
        "{told}"
    );
}

/// A shaft on three bearings: with a stiffness that follows from a load the reactions are those of the same number typed, and less even than
/// with rigid ones; a bearing that resists to tilting takes a moment and changes all reactions.
#[test]
fn a_shaft_on_three_bearings_reacts_to_their_stiffness() {
    let text = std::fs::read_to_string(crate::common::file("tests/cases/fine_oil_from_volume/input.yaml")).unwrap();
    let loads = |middle: &str| -> Result<(Vec<f64>, Option<f64>), String> {
        let shaft = "  shaft_in:  { axis: [0 mm, 0 mm], sections: [{ from: 0 mm, to: 120 mm, outer: 25 mm }] }\n";
        let third =
            format!("bearings:\n  third: {{ shaft: shaft_in, at: 120 mm, designation: \"6205\" }}\n  {middle}\n");
        let text = text
            .replace("  shaft_in:  { axis: [0 mm, 0 mm] }\n", shaft)
            .replace(
                "  right_in:  { shaft: shaft_in,  at: 60 mm, designation: \"6205\" }\n",
                "",
            )
            .replace("bearings:\n", &third);
        let (language, files) = (crate::common::language(), gearloss::api::InMemory::default().shared());
        let path = std::path::Path::new("");
        let gearbox = gearloss::api::Gearbox::from_text(&language, &files, &text, "three.yaml", path);
        let gearbox = gearbox.map_err(|found| found.render())?;
        let t = gearbox.transmission(&language, &gearloss::api::Choice::default());
        let t = t.map_err(|found| found.render())?;
        let case = t.case(&t.states()[0].name, &[], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = gearloss_framework::evaluate::Point {
            speeds: &[100.0],
            torques: &[40.0],
            ..Default::default()
        };
        let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
        let paths = ["bearings.left_in", "bearings.right_in", "bearings.third"];
        let radial = |path: &str| {
            let part = t.parts().iter().position(|part| part.path == path).unwrap();
            let readings = solution.readings(part);
            readings.iter().find(|reading| reading.name == "radial").unwrap().value
        };
        let stiffness = t.stiffnesses().next().map(|(_, known)| known.value);
        Ok((paths.iter().map(|path| radial(path)).collect(), stiffness))
    };
    let bearing = |keys: &str| format!("right_in: {{ shaft: shaft_in, at: 60 mm, designation: \"6205\"{keys} }}");
    let (rigid, none) = loads(&bearing("")).unwrap();
    assert_eq!(none, None);
    let (soft, stiffness) = loads(&bearing(", radial_stiffness: { at_load: 500 N }")).unwrap();
    let typed = stiffness.unwrap() * 1e-3;
    let (same, _) = loads(&bearing(&format!(", radial_stiffness: {typed} N/mm"))).unwrap();
    for (soft, same) in soft.iter().zip(&same) {
        assert!((soft / same - 1.0).abs() < 1e-12, "{soft} {same}");
    }
    assert!(
        soft[1] < 0.999 * rigid[1],
        "the middle bearing yields: {soft:?} {rigid:?}"
    );
    let (softer, _) = loads(&bearing(", radial_stiffness: { at_load: 50 N }")).unwrap();
    assert!(softer[1] < soft[1]);
    let rollers =
        |keys: &str| format!("right_in: {{ shaft: shaft_in, at: 60 mm, designation: \"NU205\", model: none{keys} }}");
    let (yielding, _) = loads(&rollers("")).unwrap();
    let (tilting, stiffness) = loads(&rollers(", tilting_stiffness: { at_load: 500 N }")).unwrap();
    let typed = stiffness.unwrap();
    let (same, _) = loads(&rollers(&format!(", tilting_stiffness: {typed} Nm/rad"))).unwrap();
    for (tilting, same) in tilting.iter().zip(&same) {
        assert!((tilting / same - 1.0).abs() < 1e-12, "{tilting} {same}");
    }
    assert!(
        (tilting[2] / yielding[2] - 1.0).abs() > 1e-3,
        "{tilting:?} {yielding:?}"
    );
    for key in ["radial_stiffness", "tilting_stiffness"] {
        let refused = loads(&format!(
            "right_in: {{ shaft: shaft_in, at: 60 mm, kind: spherical_roller, bore: 25 mm, outside: 52 mm, model: none, {key}: {{ at_load: 500 N }} }}"
        ));
        let message = refused.unwrap_err();
        assert!(
            message.contains("E0315") && message.contains("this kind of bearing") && message.contains(key),
            "{message}"
        );
    }
}
