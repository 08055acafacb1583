//! What an engineer sees in an editor: the language server of VS Code's YAML extension with the published schemas.

pub mod install;
mod language_server;

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use language_server::{Complaint, LanguageServer, Offer, uri};
use serde_json::{Value, json};

/// The longest that the in-house program may take to print its schema.
const PRINTING: Duration = Duration::from_secs(90);

/// A small gearbox without a fault.
const GEARBOX: &str = include_str!("../cases/fine/input.yaml");

/// Its line with a model of the bearings, which the tests change.
const BEARING: &str = "bearing: { type: iso14179_2 }";

/// Its first gear, from the number of teeth on.
const PINION: &str = "z: 20, facewidth: 20 mm";

const STUDY: &str = "gearloss: study/1
gearboxes: { ours: gearbox.yaml }
grids:
  field: { gear: first, torque: { from: 2 Nm, to: 20 Nm, step: 2 Nm }, speed: { from: 1000 rpm, to: 9000 rpm, step: 1000 rpm } }
analyses:
  maps: { type: map, grid: field }
";

fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A running server, or none with the reason on standard error.
fn start(name: &str, schemas: Value) -> Option<LanguageServer> {
    match install::server() {
        Ok(program) => {
            let mut node = Command::new("node");
            node.arg(program).arg("--stdio");
            let settings = json!({
                "validate": true, "hover": true, "completion": true, "schemas": schemas, "schemaStore": { "enable": false },
            });
            let errors = install::target().join(format!("editor/{name}.log"));
            Some(LanguageServer::start(node, settings, &errors))
        }
        Err(reason) => {
            skipped(&format!("no editor is tested ({name}): {reason}"));
            None
        }
    }
}

/// Says past the capture of the test runner, so that everybody sees it, what was not tested.
fn skipped(what: &str) {
    let words = format!("SKIPPED: {what}\n");
    std::io::stderr().write_all(words.as_bytes()).unwrap();
}

/// A text with its first line, as it would stand in a folder of the examples.
fn with_schema(kind: &str, text: &str) -> String {
    format!("# yaml-language-server: $schema=../../schemas/{kind}.schema.json\n{text}")
}

fn beside_the_example() -> PathBuf {
    root("examples/two-speed-ev/own.yaml")
}

/// The small gearbox with one place changed.
fn changed(from: &str, to: &str) -> String {
    assert_eq!(GEARBOX.matches(from).count(), 1, "{from}");
    with_schema("gearbox", &GEARBOX.replace(from, to))
}

/// The small gearbox with another model of its bearings.
fn bearing(to: &str) -> String {
    changed(BEARING, to)
}

fn has(offers: &[Offer], label: &str) -> bool {
    offers.iter().any(|offer| offer.label == label)
}

#[test]
fn an_editor_with_the_committed_schemas() {
    let schemas = json!({ uri(&root("schemas/gearbox.schema.json")): ["*elsewhere.yaml"] });
    let Some(mut server) = start("committed schemas", schemas) else {
        return;
    };
    examples_are_without_complaint(&mut server);
    faults_are_marked_where_they_stand(&mut server);
    faults_of_studies_and_of_eval_are_marked(&mut server);
    models_and_keys_are_offered(&mut server);
    words_are_explained(&mut server);
    a_schema_may_come_from_the_settings(&mut server);
}

/// Every gearbox and study of the examples names its schema in its first line and is without fault for it.
fn examples_are_without_complaint(server: &mut LanguageServer) {
    let mut files = Vec::new();
    for folder in std::fs::read_dir(root("examples")).unwrap() {
        let folder = folder.unwrap().path();
        // The schema of the in-house crate is printed by its own program: the other test.
        if folder.is_dir() && !folder.join("Cargo.toml").is_file() {
            let inside = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
            files.extend(inside.filter(|f| f.extension().is_some_and(|e| e == "yaml")));
        }
    }
    files.sort();
    assert!(files.len() >= 9, "{files:?}");
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let first = text.lines().next().unwrap();
        let schema = first.strip_prefix("# yaml-language-server: $schema=");
        let schema = schema.unwrap_or_else(|| panic!("{}: first line `{first}` names no schema", file.display()));
        assert!(file.with_file_name(schema).is_file(), "{}: no {schema}", file.display());
        let complaints = server.complaints(&file, &text);
        assert!(complaints.is_empty(), "{}: {complaints:#?}", file.display());
    }
}

/// One fault, one or two complaints: about what is written, or about the key above that lacks something.
fn check(server: &mut LanguageServer, text: &str, expected: &[(&str, &[&str])]) {
    let complaints = server.complaints(&beside_the_example(), text);
    let fits = |c: &Complaint, (marked, words): &(&str, &[&str])| {
        c.marked == *marked && words.iter().all(|word| c.message.contains(word))
    };
    let all = expected.iter().all(|e| complaints.iter().any(|c| fits(c, e)));
    assert!(
        all && complaints.len() == expected.len(),
        "{expected:?}: {complaints:#?}"
    );
    for complaint in complaints {
        let line = text.lines().nth(complaint.line).unwrap();
        assert!(line.contains(&complaint.marked), "{complaint:?}");
    }
}

fn faults_are_marked_where_they_stand(server: &mut LanguageServer) {
    check(server, &with_schema("gearbox", GEARBOX), &[]);
    let wrong_unit: &[&str] = &["a length with its unit", "`20 mm`", "a bare number in mm"];
    check(
        server,
        &changed(PINION, "z: 20, facewidth: 30 Nm"),
        &[("30 Nm", wrong_unit)],
    );
    check(
        server,
        &changed(PINION, "z: 20, facewidth: true"),
        &[("true", wrong_unit)],
    );
    check(
        server,
        &changed(PINION, "z: 20, face_width: 20 mm"),
        &[("pinion", &["facewidth"]), ("face_width", &["not allowed"])],
    );
    check(
        server,
        &changed(PINION, "z: 20, facewidth: -20"),
        &[("-20", &["below the minimum of 0.1"])],
    );
    check(
        server,
        &changed("pinion: {", "on: {"),
        &[("on", &["starts with a letter", "booleans"])],
    );
    check(server, &changed("seals:", "sealz:"), &[("sealz", &["not allowed"])]);

    // A model: its type, and then its own parameters and no others.
    check(
        server,
        &bearing("bearing: { type: skff }"),
        &[("skff", &["\"skf\"", "\"timken\""])],
    );
    check(
        server,
        &bearing("bearing: { typ: skf }"),
        &[("bearing", &["Missing property \"type\""])],
    );
    check(
        server,
        &bearing("bearing: { type: timken }"),
        &[("bearing", &["Missing property \"g1\""])],
    );
    check(
        server,
        &bearing("bearing: { type: skf, kappa: 3 }"),
        &[("kappa", &["kappa is not allowed"])],
    );
    check(
        server,
        &bearing("bearing: { type: iso14179_2, f0: 100 }"),
        &[("100", &["above the maximum of 50"])],
    );
    check(
        server,
        &bearing("bearing: { type: iso14179_2, f0: 3 mm }"),
        &[("3 mm", &["plain number"])],
    );
    check(
        server,
        &bearing("bearing: skf"),
        &[("skf", &["{ type: NAME }", "`none`"])],
    );
    check(server, &bearing("bearing: none"), &[]);
    // A model in a model.
    let mesh = |text: &str| changed("gear_mesh: { type: iso14179_2 }", text);
    check(
        server,
        &mesh("gear_mesh: { type: even_share, mean_friction: { type: schlenck } }"),
        &[("schlenck", &["\"schlenk\""])],
    );
    check(
        server,
        &mesh("gear_mesh: { type: even_share, mean_friction: { type: schlenk, x: 1 } }"),
        &[("x", &["x is not allowed"])],
    );

    // What a gearbox does not state, the one that it extends does.
    check(
        server,
        &with_schema("gearbox", "gearloss: gearbox/1\nextends: gearbox.yaml\n"),
        &[],
    );
    let alone = server.complaints(&beside_the_example(), &with_schema("gearbox", "gearloss: gearbox/1\n"));
    assert!(alone.iter().any(|c| c.message.contains("shafts")), "{alone:?}");
}

fn faults_of_studies_and_of_eval_are_marked(server: &mut LanguageServer) {
    let study = |from: &str, to: &str| {
        assert!(STUDY.contains(from));
        with_schema("study", &STUDY.replace(from, to))
    };
    check(server, &study("type: map", "type: map"), &[]);
    check(server, &study("type: map", "type: mapp"), &[("mapp", &["\"map\""])]);
    check(
        server,
        &study("grid: field", "gird: field"),
        &[("gird", &["gird is not allowed"])],
    );
    check(
        server,
        &study("to: 20 Nm", "to: 20 mm"),
        &[("20 mm", &["a torque with its unit"])],
    );
    // The mechanism stands in the command and not in the file; the part tells an editor which one it is.
    let eval = |model: &str| with_schema("eval", &format!("model: {model}\npart: {{ designation: \"6205\" }}\n"));
    check(server, &eval("{ type: skf, edition: \"2013\" }"), &[]);
    check(
        server,
        &eval("{ type: skf, editionn: \"2013\" }"),
        &[("editionn", &["not allowed"])],
    );
    // Several mechanisms have a model of this name: any may be meant.
    let model_alone = with_schema("eval", "model: { type: iso14179_2 }\n");
    check(server, &model_alone, &[]);
}

fn models_and_keys_are_offered(server: &mut LanguageServer) {
    let mut offers = |text: &str| server.offers(&beside_the_example(), text);
    let in_component = |model: &str| {
        changed(
            "designation: \"6205\", axial: both",
            &format!("designation: \"6205\", model: {model}"),
        )
    };
    for text in [
        bearing("bearing: { type: |}"),
        bearing("bearing:\n    type: |"),
        bearing("bearing:\n    type: s|"),
        in_component("{ type: |}"),
        in_component("{ type: i| }"),
    ] {
        let types = offers(&text);
        for (name, word) in [
            ("skf", "SKF"),
            ("timken", "Timken"),
            ("iso14179_2", "14179-2"),
            ("formula", "formula"),
            ("none", "No loss"),
        ] {
            let offer = types.iter().find(|o| o.label == name);
            assert!(
                offer.is_some_and(|o| o.meaning.contains(word)),
                "{name}: {types:#?}\n{text}"
            );
        }
        assert!(!has(&types, "schlenk") && types.len() == 13, "{types:#?}");
    }
    for text in [
        bearing("bearing:\n    type: skf\n    |"),
        bearing("bearing: { type: skf, e| }"),
    ] {
        let keys = offers(&text);
        assert!(has(&keys, "edition") && has(&keys, "mu_bl"), "{keys:#?}");
        for of_another in ["f0", "g1", "file", "value"] {
            assert!(!has(&keys, of_another), "{of_another}: {keys:#?}");
        }
    }
    let keys = offers(&changed(PINION, "z: 20, f|"));
    let facewidth = keys.iter().find(|o| o.label == "facewidth").unwrap();
    assert!(facewidth.meaning.contains("[mm]"), "{facewidth:?}");
    assert!(!has(&keys, "z") && !has(&keys, "designation"), "{keys:#?}");
    let sections = offers(&changed("seals:", "|\nseals:"));
    assert!(has(&sections, "thermal") && !has(&sections, "gears"), "{sections:#?}");
    let analyses = offers(&with_schema("study", &STUDY.replace("type: map", "type: |")));
    assert!(has(&analyses, "tournament") && has(&analyses, "map"), "{analyses:#?}");
    let analysis = offers(&with_schema(
        "study",
        &STUDY.replace("{ type: map, grid: field }", "\n    type: map\n    |"),
    ));
    assert!(has(&analysis, "grid") && !has(&analysis, "cycle"), "{analysis:#?}");
}

fn words_are_explained(server: &mut LanguageServer) {
    let mut hover = |text: &str| server.hover(&beside_the_example(), text);
    for text in [
        changed(PINION, "z: 20, face|width: 20 mm"),
        changed(PINION, "z: 20, facewidth: 2|0 mm"),
    ] {
        let shown = hover(&text);
        assert!(shown.contains("Face width. [mm]"), "{shown}");
    }
    for text in [
        "bearing: { type: s|kf }",
        "bearing: { ty|pe: skf }",
        "bea|ring: { type: skf }",
    ] {
        let shown = hover(&bearing(text));
        assert!(shown.contains("SKF catalogue"), "{text}: {shown}");
    }
    let shown = hover(&bearing("bearing: { type: harris, contact_a|ngle: 20 deg }"));
    assert!(shown.contains("Contact angle") && shown.contains("[deg]"), "{shown}");
    let shown = hover(&with_schema("study", &STUDY.replace("type: map", "type: m|ap")));
    assert!(shown.contains("over a grid"), "{shown}");
}

/// Without a first line, the settings say which files have which schema.
fn a_schema_may_come_from_the_settings(server: &mut LanguageServer) {
    let file = install::target().join("editor/elsewhere.yaml");
    assert!(server.complaints(&file, GEARBOX).is_empty());
    let complaints = server.complaints(&file, &GEARBOX.replace("facewidth", "face_width"));
    assert!(complaints.iter().any(|c| c.marked == "face_width"), "{complaints:#?}");
    let other = install::target().join("editor/other.yml");
    assert!(
        server.complaints(&other, "face_width: 3\n").is_empty(),
        "no schema, no complaint"
    );
}

/// The schema that the in-house program prints makes its section and models known.
#[test]
fn an_editor_with_the_schema_of_the_in_house_program() {
    let Some(mut server) = start("in-house schema", json!({})) else {
        return;
    };
    let folder = install::target().join("editor/in-house");
    std::fs::create_dir_all(&folder).unwrap();
    let schema = folder.join("gearbox.schema.json");
    let program = install::target().join(format!("debug/in-house-plugin{}", std::env::consts::EXE_SUFFIX));
    if !program.is_file() {
        skipped("the in-house program is not built; `cargo test --workspace` builds it");
        return;
    }
    let mut program = Command::new(program);
    program
        .args(["schema", "gearbox"])
        .stdout(File::create(&schema).unwrap());
    assert!(install::within(PRINTING, program).unwrap().success());

    let file = folder.join("gearbox.yaml");
    let text = std::fs::read_to_string(root("examples/in-house-plugin/gearbox.yaml")).unwrap();
    assert!(text.starts_with("# yaml-language-server: $schema=gearbox.schema.json"));
    let complaints = server.complaints(&file, &text);
    assert!(complaints.is_empty(), "{complaints:#?}");

    let small = |more: &str| format!("# yaml-language-server: $schema=gearbox.schema.json\n{GEARBOX}{more}\n");
    let lock = |model: &str| {
        small(&format!(
            "parking_locks:\n  lock:\n    shaft: shaft_out\n    model: {model}"
        ))
    };
    assert!(has(&server.offers(&file, &small("|")), "parking_locks"));
    let types = server.offers(&file, &lock("{ type: |}"));
    let pawl = types.iter().find(|o| o.label == "pawl");
    assert!(pawl.is_some_and(|o| !o.meaning.is_empty()), "{types:#?}");
    assert!(!has(&types, "skf"), "{types:#?}");
    assert!(has(
        &server.offers(&file, &lock("\n      type: pawl\n      |")),
        "force"
    ));
    let shown = server.hover(&file, &lock("{ type: pawl, for|ce: 0.5 N }"));
    assert!(shown.contains("[N]"), "{shown}");
    let shown = server.hover(&file, &lock("{ type: pa|wl }"));
    assert!(shown.contains(&pawl.unwrap().meaning), "{shown}");
    let complaints = server.complaints(&file, &lock("{ type: pawl, force: 3 mm }"));
    assert!(
        complaints
            .iter()
            .any(|c| c.marked == "3 mm" && c.message.contains("a force with its unit")),
        "{complaints:#?}"
    );

    // What is known of an own model is known of it in the schema: meaning, unit, range, default.
    let schema: Value = serde_json::from_str(&std::fs::read_to_string(schema).unwrap()).unwrap();
    let force = schema["definitions"]["parking_lock_model"]["oneOf"][0]["allOf"]
        .as_array()
        .unwrap()
        .iter()
        .find(|branch| branch["if"]["properties"]["type"]["const"] == "pawl")
        .map(|branch| &branch["then"]["properties"]["force"])
        .unwrap();
    for key in ["description", "minimum", "maximum", "default"] {
        assert!(!force[key].is_null(), "{key}: {force}");
    }
    assert_eq!(force["x-unit"], "N");
}
