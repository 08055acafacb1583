//! Tables of documents with a cursor: what is suggested there.

use std::path::Path;

use super::common::{accepted, complete, cursor, in_memory, labels};

/// The start of a gearbox with things to name.
const HEAD: &str = "gearloss: gearbox/1
ports: { input: drive, output: wheel }
shafts:
  drive: { axis: [0 mm, 0 mm] }
  wheel: { axis: [0 mm, 90 mm] }
gears:
  G1: { shaft: drive, z: 20 }
  G2: { shaft: wheel, z: 40 }
couplings:
  K1: { between: [drive, wheel] }
lubricants:
  sump: { designation: ISO VG 100 PAO }
thermal: { network: { nodes: { oil: {}, case: {} } } }
gear_states: { first: [K1], 2nd: [] }
model_sets: { joint: {} }
";

fn suggested(rest: &str) -> Vec<String> {
    let items = complete(&format!("{HEAD}{rest}"));
    labels(&items).into_iter().map(str::to_owned).collect()
}

/// Text at a cursor, what must be among the suggestions, and what must not.
#[test]
fn keys_and_values_are_suggested_in_whole_and_in_broken_documents() {
    for (rest, present, absent) in [
        // Keys: required ones first, not those that are written.
        (
            "bearings:\n  B1:\n    |",
            "shaft designation lubricant loss_factor",
            "type K1",
        ),
        ("bearings:\n  B1: { shaft: drive, | }", "designation at", "shaft"),
        ("bearings:\n  B1: { shaft: drive, desi|", "designation", "shaft"),
        ("bearings:\n  B1:\n    sha|\n    at: 3 mm\n", "shaft", "at"),
        (
            "bearings:\n  B1:\n    shaft: drive\n    |\nseals:\n",
            "at designation",
            "shaft",
        ),
        ("|", "bearings meshes", "shafts"),
        ("bear|", "bearings", "shafts"),
        // Values: ids of sections.
        ("bearings:\n  B1:\n    shaft: |", "drive wheel", "G1"),
        ("bearings:\n  B1:\n    shaft:|", "drive wheel", "G1"),
        ("bearings:\n  B1: { shaft: |", "drive wheel", "G1"),
        ("bearings:\n  B1: { shaft: | }\nseals:\n  S: {}\n", "drive wheel", "G1"),
        ("bearings:\n  B1: { outer: | }", "drive G1", "K1"),
        ("meshes:\n  M: { gears: [G1, |] }", "G1 G2", "drive"),
        ("meshes:\n  M: { gears: [G1, |", "G1 G2", "drive"),
        ("meshes:\n  M:\n    gears:\n      - |", "G1 G2", "drive"),
        ("housing: { oil: { lubricant: | } }", "sump", "drive"),
        ("clutches:\n  C: { between: [drive, |] }", "drive housing", "K1"),
        ("wheels: [|]", "input output", "drive"),
        ("torque_shares:\n  - member: |", "drive G1", "input"),
        // Words, booleans, units.
        ("bearings:\n  B1: { kind: | }", "deep_groove_ball", "drive"),
        ("thermal: { mode: | }", "", "true"),
        ("rating: { torque: 20 | }", "Nm kNm", "mm"),
        ("rating: { torque: 20|", "Nm", "mm"),
        ("rating:\n  speed: 20 r|", "rpm rad/s", "mm"),
        // Catalogue.
        ("bearings:\n  B1: { designation: | }", "6205", "drive"),
        ("lubricants:\n  other: { designation: ISO | }", "", "drive"),
        // Models and their parameters.
        ("models: { bearing: { type: | } }", "skf harris", "type drive"),
        ("models: { bearing: { type: |", "skf harris", "type drive"),
        ("models:\n  bearing: |", "skf none", "drive"),
        ("models:\n  bearing:\n    type: sk|", "skf harris", "drive"),
        ("bearings:\n  B1:\n    model: { type: constant, | }", "value", "type"),
        // Resolved paths.
        ("extends: base.yaml\nset: { bear| }", "bearings shafts", "drive"),
        ("extends: base.yaml\nset:\n  shafts.|", "drive wheel *", "shafts"),
        ("extends: base.yaml\nset:\n  shafts.drive.|", "mass axis", "drive"),
        (
            "extends: base.yaml\nset: { bearings.B1.kind: | }",
            "deep_groove_ball",
            "",
        ),
        ("assumed:\n  - paths: [gears.|]", "G1 G2", "drive"),
        // Nothing in comments.
        ("# |", "", "bearings"),
        ("bearings: # |", "", "shaft"),
    ] {
        let found = suggested(rest);
        let has = |word: &str| found.iter().any(|known| known == word);
        for word in present.split_whitespace() {
            assert!(has(word), "`{word}` is missing at\n{rest}\n{found:?}");
        }
        for word in absent.split_whitespace() {
            assert!(!has(word), "`{word}` is suggested at\n{rest}\n{found:?}");
        }
    }
}

#[test]
fn required_keys_come_first_with_unit_and_description() {
    let items = complete(&format!("{HEAD}bearings:\n  B1:\n    |"));
    assert!(
        items[0].required && !items[items.len() - 1].required,
        "{:?}",
        labels(&items)
    );
    let at = items.iter().find(|item| item.label == "at").unwrap();
    assert!(
        at.detail.contains("mm") && at.documentation.contains("Position"),
        "{at:?}"
    );
}

#[test]
fn a_designation_shows_its_data() {
    let items = complete(&format!("{HEAD}bearings:\n  B1: {{ designation: | }}"));
    let row = items.iter().find(|item| item.label == "6205").unwrap();
    assert!(row.detail.contains("bore 25 mm"), "{row:?}");
    // Without quotes it would be a number.
    assert_eq!(row.insert, "\"6205\"");
    let oils = complete(&format!("{HEAD}lubricants:\n  other: {{ designation: | }}"));
    assert!(labels(&oils).contains(&"ISO VG 100 PAO"), "{:?}", labels(&oils));
}

#[test]
fn an_accepted_suggestion_is_valid_text() {
    for (text, label, after) in [
        ("bearings:\n  B1:\n    sh|", "shaft", "bearings:\n  B1:\n    shaft: "),
        ("hous|", "housing", "housing:\n  "),
        ("rating: { torque: 20| }", "Nm", "rating: { torque: 20 Nm }"),
        ("rating: { torque: 20 k| }", "kNm", "rating: { torque: 20 kNm }"),
        ("models:\n  bearing:|", "skf", "models:\n  bearing: { type: skf }"),
        (
            "models:\n  bearing: { type:| }",
            "skf",
            "models:\n  bearing: { type: skf }",
        ),
        (
            "bearings:\n  B1:\n    sh|: drive",
            "shaft",
            "bearings:\n  B1:\n    shaft: drive",
        ),
        (
            "shafts:\n  a: {}\nwheels: |\nports: { input: a }",
            "input",
            "shafts:\n  a: {}\nwheels: [input]\nports: { input: a }",
        ),
        (
            "ports: { input: a }\nwheels:|",
            "input",
            "ports: { input: a }\nwheels: [input]",
        ),
        ("set:\n  housing.oil.vol|", "volume", "set:\n  housing.oil.volume: "),
    ] {
        assert_eq!(accepted(text, label), after, "{text}");
    }
}

const STUDY: &str = "gearloss: study/1
gearboxes: { ev: gearbox.yaml }
grids: { small: { torque: 1 Nm, speed: 1 rpm } }
measurements: { rig: { file: rig.csv } }
cycles: { town: { shipped: nycc } }
vehicles: { car: {} }
parameters: { ra: {} }
";

#[test]
fn a_study_names_its_own_things_and_those_of_its_gearboxes() {
    for (rest, present, absent) in [
        ("analyses:\n  a: { type: | }", "map cycle", "type"),
        ("analyses:\n  a: { type: map, grid: | }", "small", "ev"),
        ("analyses:\n  a: { type: map, gearbox: | }", "ev", "small"),
        ("analyses:\n  a: { type: map, write: | }", "csv json", "ev"),
        ("analyses:\n  a: { type: map, write: [csv, |] }", "csv json", "ev"),
        ("analyses:\n  a: { type: map, model_sets: [|] }", "joint own", "small"),
        ("analyses:\n  a: { type: map, g| }", "grid gearbox", "type"),
        ("analyses:\n  a:\n    type: balance\n    gear: |", "first 2nd", "K1"),
        ("analyses:\n  a: { type: cycle, cycles: [|] }", "town", "nycc"),
        ("analyses:\n  a: { type: cycle, vehicle: | }", "car", "town"),
        ("cycles: { other: { shipped: | } }", "nycc udds", "town"),
        ("analyses:\n  a: { type: operating_points, data: | }", "rig", "small"),
        ("analyses:\n  a: { type: contact_path, mesh: | }", "", "small"),
        ("analyses:\n  a: { type: sweep, path: lubricants.| }", "sump", "small"),
        ("conditions: { torque_at: | }", "input output", "drive"),
        ("conditions:\n  set:\n    lubricants.sump.|", "designation", "sump"),
        ("answered_by: [|]\nanalyses: { losses: {} }", "losses", "small"),
        ("gearboxes: { second: | }", "gearbox.yaml rig.csv", "ev"),
    ] {
        let (text, at) = cursor(&format!("{STUDY}{rest}"));
        let mut workspace = in_memory(&[("f/gearbox.yaml", HEAD), ("f/study.yaml", &text)]);
        workspace.know("f/rig.csv");
        workspace.know("f/gearbox.yaml");
        let items = workspace.completion(Path::new("f/study.yaml"), at);
        let found = labels(&items);
        for word in present.split_whitespace() {
            assert!(found.contains(&word), "`{word}` is missing at\n{rest}\n{found:?}");
        }
        for word in absent.split_whitespace() {
            assert!(!found.contains(&word), "`{word}` is suggested at\n{rest}\n{found:?}");
        }
    }
}

#[test]
fn an_empty_document_may_become_either_kind() {
    let items = complete("|");
    assert!(labels(&items).contains(&"gearloss: gearbox/1") && labels(&items).contains(&"gearloss: study/1"));
}

#[test]
fn a_catalogue_of_the_user_is_suggested_and_explained() {
    let (text, at) = cursor("catalogues: { bearings: own.csv }\nbearings: { B1: { designation: | } }\n");
    let table = "designation,kind,bore [mm],outside [mm]\nOWN 7,deep_groove_ball,25,52\n";
    let workspace = in_memory(&[("f/a.yaml", &text), ("f/own.csv", table)]);
    let items = workspace.completion(Path::new("f/a.yaml"), at);
    let row = items.iter().find(|item| item.label == "OWN 7").unwrap();
    assert!(row.detail.contains("outside 52 mm"), "{row:?}");
    let written = text.replace("designation: ", "designation: OWN 7");
    let workspace = in_memory(&[("f/a.yaml", &written), ("f/own.csv", table)]);
    let hover = workspace.hover(Path::new("f/a.yaml"), at + 1).unwrap();
    assert!(hover.text.contains("`outside`: 52 mm"), "{hover:?}");
}
