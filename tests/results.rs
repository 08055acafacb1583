//! Every file of results follows the published schemas, and the formats of a map hold the same numbers.

use crate::common;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use gearloss_framework::document::{read_yaml, records_by_type};
use jsonschema::Validator;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use serde_json::{Map, Value, json};

/// The examples, and a study of every analysis with every variant.
const STUDIES: [&str; 5] = [
    "examples/two-speed-ev/study.yaml",
    "examples/two-products/study.yaml",
    "examples/planetary-reducer/study.yaml",
    "tests/results/study.yaml",
    "tests/results/gear_choice.yaml",
];

/// Records of rare results, which no study here has: a minimum at a kink, whose contents are tested with the models that make it,
/// a duty that breaks off, and a duty and points that leave the map of a machine.
const RARE: [&str; 4] = ["KinkOfModel", "BrokenOff", "OutsideMap", "MachineOutside"];

/// Objects whose keys are the user's, or a model's.
const OPEN: [&str; 7] = [
    "bound",
    "set",
    "terms_w",
    "value",
    "model",
    "limit_values",
    "load_sharing",
];

/// Keys that some records have and others have not.
const OPTIONAL: [&str; 38] = [
    "means",
    "source",
    "planets",
    "elastic_modulus_gpa",
    "reduced_modulus_gpa",
    "material",
    "outside_maps",
    "mesh_load",
    "of",
    "unit",
    "machines",
    "dc_power_w",
    "unit_loss_w",
    "system_efficiency",
    "gears_used",
    "best_gears",
    "best_gear",
    "crossed_stages",
    "lengthwise_sliding_m_s",
    "data",
    "oil_network",
    "preloads",
    "turned_at",
    "file",
    "derivatives",
    "study_limits",
    "limit_values",
    "model_error",
    "band_w",
    "loss_difference_band_w",
    "difference_band_w",
    "fitted",
    "inclination_deg",
    "window",
    "correction",
    "corrections",
    "corrected",
    "corrected_difference",
];

/// One file of results with the type of its analysis.
struct Written {
    file: PathBuf,
    analysis: String,
    value: Value,
}

static WRITTEN: LazyLock<Vec<Written>> = LazyLock::new(|| STUDIES.into_iter().flat_map(written).collect());

/// What a study writes, one file for each analysis.
fn written(study: &'static str) -> Vec<Written> {
    let folder = &common::study_run(study).folder;
    let text = std::fs::read_to_string(common::file(study)).unwrap();
    let analyses = read_yaml(0, &text).node.to_json()["analyses"].clone();
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let count = files.filter(|file| file.extension().is_some_and(|kind| kind == "json"));
    assert_eq!(count.count(), analyses.as_object().unwrap().len(), "{study}");
    let read = |(name, entry): (&String, &Value)| {
        let file = folder.join(format!("{name}.json"));
        Written {
            analysis: entry["type"].as_str().unwrap().to_owned(),
            value: serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap(),
            file,
        }
    };
    analyses.as_object().unwrap().iter().map(read).collect()
}

/// Operating points that show every branch: fixed, balanced, without balance, without a value, at rest, locking itself.
fn points() -> Vec<Value> {
    let car = ["examples/two-speed-ev/gearbox.yaml", "--speed", "8000 rpm"];
    let reducer = ["examples/planetary-reducer/gearbox.yaml", "--speed", "4000 rpm"];
    let solve = |[gearbox, speed, value]: [&str; 3], more: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
            .current_dir(common::file("."))
            .args(["solve", gearbox, "--torque", "3 Nm", "--format", "json", speed, value])
            .args(more)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        serde_json::from_str(&text).unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)))
    };
    let unit = ["examples/electric-drive-unit/gearbox.yaml", "--speed", "4000 rpm"];
    let planets = ["examples/planet-pins/gearbox.yaml", "--speed", "1800 rpm"];
    vec![
        solve(unit, &[]),
        solve(planets, &[]),
        solve(
            unit,
            &["--set", "bearings.B0.model={ type: formula, formula: \"sqrt(-1)\" }"],
        ),
        solve(car, &["--gear", "first"]),
        solve(car, &["--gear", "second", "--models", "joint"]),
        // The path lies at a kink.
        solve(
            car,
            &[
                "--gear",
                "first",
                "--derivative",
                "torque:input",
                "--derivative",
                "lubricants.sump.viscosity.kv100",
            ],
        ),
        solve(
            car,
            &[
                "--gear",
                "first",
                "--set",
                "meshes.*.model.coefficients.load_exponent=0.25",
            ],
        ),
        solve(["tests/results/self_locking.yaml", "--speed", "-3000 rpm"], &[]),
        solve(["tests/results/oil_network.yaml", "--speed", "3000 rpm"], &[]),
        solve(["tests/results/crossed_axes.yaml", "--speed", "1500 rpm"], &[]),
        solve(["tests/results/window.yaml", "--speed", "3000 rpm"], &[]),
        solve(
            ["tests/trade/preloaded-bearings/gearbox.yaml", "--speed", "1500 rpm"],
            &[],
        ),
        solve([car[0], "--speed", "0 rpm"], &["--gear", "first"]),
        solve(
            car,
            &[
                "--gear",
                "first",
                "--set",
                "seals.D1.model={ type: formula, formula: \"sqrt(-1)\" }",
            ],
        ),
        solve(reducer, &[]),
        solve(reducer, &["--set", "thermal.heat_dissipation.casing.alpha=1 W/(m2 K)"]),
        solve(
            reducer,
            &["--set", "seals.input.model={ type: formula, formula: \"sqrt(-1)\" }"],
        ),
    ]
}

/// The committed schema, which is that of the program (`schema.rs`).
fn schema(kind: &str) -> Value {
    let committed = common::file(&format!("schemas/{kind}.schema.json"));
    serde_json::from_str(&std::fs::read_to_string(committed).unwrap()).unwrap()
}

fn validator(kind: &str) -> Validator {
    jsonschema::draft7::new(&schema(kind)).unwrap()
}

fn follows(validator: &Validator, value: &Value, what: &str) {
    let errors: Vec<String> = validator
        .iter_errors(value)
        .map(|e| format!("{}: {e:.300}", e.instance_path()))
        .collect();
    assert!(errors.is_empty(), "{what}: {errors:#?}");
}

#[test]
fn every_file_follows_the_schema() {
    let validator = validator("result");
    for w in WRITTEN.iter() {
        follows(&validator, &w.value, &w.file.display().to_string());
    }
}

#[test]
fn every_solved_point_follows_the_schema() {
    let validator = validator("point");
    for (i, value) in points().iter().enumerate() {
        follows(&validator, value, &format!("point {i}"));
    }
}

/// An analysis that comes later has no file here until it is written into the study, and then no schema.
#[test]
fn every_analysis_of_the_study_schema_occurs() {
    let study = schema("study");
    let known: BTreeSet<&str> = records_by_type(&study["definitions"]["Analysis"])
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    let seen: BTreeSet<&str> = WRITTEN.iter().map(|w| w.analysis.as_str()).collect();
    assert_eq!(known, seen);
    assert!(known.len() >= 15);
}

/// Every closed record of a schema is met, so that none is there for nothing and none stands unchecked.
#[test]
fn every_record_of_the_schemas_occurs() {
    let results: Vec<Value> = WRITTEN.iter().map(|w| w.value.clone()).collect();
    for (kind, values) in [("result", results), ("point", points())] {
        let mut seen = BTreeSet::new();
        for value in &values {
            key_sets(value, &mut seen);
        }
        for (name, definition) in schema(kind)["definitions"].as_object().unwrap() {
            let Some(keys) = definition["properties"].as_object() else {
                continue;
            };
            let keys: BTreeSet<String> = keys
                .keys()
                .filter(|k| !OPTIONAL.contains(&k.as_str()))
                .cloned()
                .collect();
            assert!(
                seen.contains(&keys) || RARE.contains(&name.as_str()),
                "{kind}: {name} does not occur"
            );
        }
    }
}

fn key_sets(value: &Value, seen: &mut BTreeSet<BTreeSet<String>>) {
    if let Value::Object(map) = value {
        let always = map.keys().filter(|key| !OPTIONAL.contains(&key.as_str()));
        seen.insert(always.cloned().collect());
    }
    for (_, inner) in children(value) {
        key_sets(inner, seen);
    }
}

/// What an object or a list holds, with the keys.
fn children(value: &Value) -> Box<dyn Iterator<Item = (String, &Value)> + '_> {
    match value {
        Value::Object(map) => Box::new(map.iter().map(|(key, inner)| (key.clone(), inner))),
        Value::Array(list) => Box::new(list.iter().enumerate().map(|(i, inner)| (i.to_string(), inner))),
        _ => Box::new(std::iter::empty()),
    }
}

#[test]
fn unknown_and_missing_keys_are_refused() {
    let mut done = BTreeSet::new();
    for w in WRITTEN.iter() {
        refuses(&validator("result"), &w.value, &mut done);
    }
    let results = done.len();
    for value in points() {
        refuses(&validator("point"), &value, &mut done);
    }
    assert!(results > 200 && done.len() > results + 50, "{results} {}", done.len());
}

/// Every place of a document once: one more key, or one less, is a fault.
fn refuses(validator: &Validator, value: &Value, done: &mut BTreeSet<String>) {
    let value = &thinned(value);
    let mut paths = Vec::new();
    objects(value, String::new(), &mut paths);
    for path in paths {
        let keys: Vec<String> = value
            .pointer(&path)
            .unwrap()
            .as_object()
            .unwrap()
            .keys()
            .cloned()
            .collect();
        let place: String = path.chars().filter(|c| !c.is_ascii_digit()).collect();
        let changed = |change: &dyn Fn(&mut Map<String, Value>)| {
            let mut value = value.clone();
            change(value.pointer_mut(&path).unwrap().as_object_mut().unwrap());
            validator.is_valid(&value)
        };
        if done.insert(format!("{place} {keys:?}")) {
            let more = |map: &mut Map<String, Value>| drop(map.insert("unknown".to_owned(), json!(1)));
            assert!(!changed(&more), "{path} takes an unknown key");
        }
        for key in keys.iter().filter(|key| !OPTIONAL.contains(&key.as_str())) {
            if done.insert(format!("{place}/{key} {keys:?}")) {
                let less = |map: &mut Map<String, Value>| drop(map.shift_remove(key));
                assert!(!changed(&less), "{path} does without `{key}`");
            }
        }
    }
}

/// The same with one entry of each list of objects: the others have its keys.
fn thinned(value: &Value) -> Value {
    match value {
        Value::Array(list) if list.first().is_some_and(Value::is_object) => json!([thinned(&list[0])]),
        Value::Object(map) => map.iter().map(|(key, inner)| (key.clone(), thinned(inner))).collect(),
        other => other.clone(),
    }
}

/// Paths of all closed objects.
fn objects(value: &Value, path: String, paths: &mut Vec<String>) {
    let key = path.rsplit('/').next().unwrap_or_default();
    // A list of models is closed, a model is not.
    if OPEN.contains(&key) {
        return;
    }
    for (key, inner) in children(value) {
        objects(inner, format!("{path}/{key}"), paths);
    }
    if value.is_object() {
        paths.push(path);
    }
}

/// Keys say what they hold, and quantities their unit; records that both files have are the same.
#[test]
fn the_schemas_explain_every_key() {
    for kind in ["result", "point", "check", "models"] {
        let schema = schema(kind);
        jsonschema::draft7::meta::validate(&schema).unwrap();
        explained(&schema, kind);
    }
    let (result, point) = (schema("result"), schema("point"));
    for (name, definition) in point["definitions"].as_object().unwrap() {
        let other = &result["definitions"][name];
        assert!(other.is_null() || other == definition, "{name}");
    }
}

/// Units by the ends of keys.
const UNITS: [(&str, &str); 14] = [
    ("_w", "[W]"),
    ("_nm", "[Nm]"),
    ("_n", "[N]"),
    ("_rpm", "[rpm]"),
    ("_degc", "[degC]"),
    ("_k", "[K]"),
    ("_n_mm", "[N/mm]"),
    ("_mm", "[mm]"),
    ("_um", "[um]"),
    ("_gpa", "[GPa]"),
    ("_m_s", "[m/s]"),
    ("_percent", "[%]"),
    ("_percent_of_loss", "[%]"),
    ("efficiency", "[-]"),
];

fn explained(schema: &Value, path: &str) {
    if let Some(properties) = schema["properties"].as_object() {
        assert_eq!(schema["additionalProperties"], false, "{path}");
        for key in schema["required"].as_array().unwrap() {
            assert!(properties.contains_key(key.as_str().unwrap()), "{path}/{key}");
        }
        for (key, property) in properties {
            let said = property["description"]
                .as_str()
                .unwrap_or_else(|| panic!("{path}/{key} says nothing"));
            assert!(said.ends_with('.') || said.ends_with(']'), "{path}/{key}: {said}");
            let unit = UNITS.iter().find(|(end, _)| key.ends_with(end));
            let record = said.contains("in addition to the losses");
            assert!(
                record || unit.is_none_or(|(_, unit)| said.ends_with(unit)),
                "{path}/{key}: {said}"
            );
        }
    }
    for (key, inner) in children(schema) {
        explained(inner, &format!("{path}/{key}"));
    }
}

/// A table: its header, and cells that are absent, numbers or texts.
type Table = (Vec<String>, Vec<Vec<Value>>);

fn csv_of(file: &Path) -> Table {
    let mut reader = csv::Reader::from_path(file).unwrap();
    let header = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let cell = |text: &str| match text.parse::<f64>() {
        _ if text.is_empty() => Value::Null,
        Ok(number) => json!(number),
        Err(_) => json!(text),
    };
    let rows = reader.records().map(|row| row.unwrap().iter().map(cell).collect());
    (header, rows.collect())
}

fn parquet_of(file: &Path) -> Table {
    let reader = SerializedFileReader::new(std::fs::File::open(file).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let header = schema.columns().iter().map(|c| c.name().to_owned()).collect();
    let cell = |field: &Field| match field {
        Field::Double(number) => json!(number),
        Field::Str(text) => json!(text),
        _ => Value::Null,
    };
    let rows = reader.get_row_iter(None).unwrap().map(|row| {
        let row = row.unwrap();
        row.get_column_iter().map(|(_, field)| cell(field)).collect()
    });
    (header, rows.collect())
}

/// The rows that the CSV of a map has, from its JSON.
fn json_of(value: &Value, header: &[String]) -> Vec<Vec<Value>> {
    let mut rows = Vec::new();
    for map in value["maps"].as_array().unwrap() {
        let parts: Vec<&str> = map["parts"]
            .as_array()
            .unwrap()
            .iter()
            .map(|p| p["part"].as_str().unwrap())
            .collect();
        for point in map["points"].as_array().unwrap() {
            let cell = |key: &String| -> Value {
                let name = key.trim_end_matches("_w");
                let part = parts.iter().position(|p| *p == name);
                let limit = key.trim_start_matches("limit_").trim_end_matches("_h");
                let limited = &point["limit_values"][limit];
                [&map[key], &map["bound"][key], &point["sums_w"][name], limited]
                    .into_iter()
                    .chain(part.map(|i| &point["parts_w"][i]))
                    // The temperature of the map is that of its points where it is given.
                    .fold(
                        point[key].clone(),
                        |found, other| if found.is_null() { other.clone() } else { found },
                    )
            };
            rows.push(header.iter().map(cell).collect());
        }
    }
    rows
}

#[test]
fn csv_json_and_parquet_of_a_map_hold_the_same_numbers() {
    let folder = &common::study_run("tests/results/study.yaml").folder;
    for name in ["map_grid", "map_listed", "map_balanced"] {
        let (header, rows) = csv_of(&folder.join(format!("{name}.csv")));
        assert_eq!(
            (header.clone(), rows.clone()),
            parquet_of(&folder.join(format!("{name}.parquet"))),
            "{name}"
        );
        let file = folder.join(format!("{name}.json"));
        let value: Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
        assert_eq!(rows, json_of(&value, &header), "{name}");
        // Each has gaps: at rest, without a value, or without a balance.
        assert!(rows.len() >= 4 && header.len() > 25 && rows.iter().flatten().any(Value::is_null));
    }
}
