//! The published schemas are those of the program, and the walk gives their verdict on every document.

use crate::common;
use std::process::{Command, Output};

use gearloss_framework::document::{Content, Node, read_yaml};
use gearloss_framework::language::{Kind, Language};
use serde_json::{Value, json};

/// What the program prints on a schema of this kind.
fn schema(kind: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .args(["schema", kind])
        .output()
        .unwrap()
}

/// Every kind that the program accepts has a file and every file a kind; outputs of the program are validated in `results.rs` and
/// `json.rs`.
#[test]
fn committed_schemas_are_those_of_the_program() {
    let refused = String::from_utf8(schema("nothing").stderr).unwrap();
    let kinds = refused.split_once("[possible values: ").unwrap().1;
    let mut kinds: Vec<&str> = kinds.split_once(']').unwrap().0.split(", ").collect();
    kinds.sort_unstable();
    for kind in &kinds {
        let generated = String::from_utf8(schema(kind).stdout).unwrap();
        let path = common::file(&format!("schemas/{kind}.schema.json"));
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&path, &generated).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap();
        assert!(
            committed == generated,
            "schemas/{kind}.schema.json is stale: run `UPDATE=1 cargo test --test all schema::`"
        );
        let meta = jsonschema::meta::validate(&serde_json::from_str(&generated).unwrap()).map_err(|e| e.to_string());
        assert_eq!(meta, Ok(()), "{kind}");
    }
    let files = std::fs::read_dir(common::file("schemas")).unwrap();
    let mut names: Vec<String> = files.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let expected: Vec<String> = kinds.iter().map(|kind| format!("{kind}.schema.json")).collect();
    assert_eq!((names, expected.len()), (expected, 7));
}

/// What the walk checks and JSON Schema cannot, by the words of the finding: ranges of quantities written as text and texts
/// that are too large for a number; words that YAML readers take for booleans, where a text and not an id is due.
fn only_the_walk_can_know(message: &str) -> bool {
    ["is out of range", "is too large", "is a boolean to many YAML readers"]
        .iter()
        .any(|words| message.contains(words))
}

/// Compares both verdicts on one document.
fn compare(language: &Language, validator: &jsonschema::Validator, study: bool, node: &Node, what: &str) {
    let walked = if study {
        language.walk_study(node)
    } else {
        language.walk_gearbox(node)
    };
    let schema = validator.is_valid(&node.to_json());
    if walked.findings.is_empty() != schema {
        let listed = schema && walked.findings.iter().all(|f| only_the_walk_can_know(&f.message));
        let errors: Vec<String> = validator
            .iter_errors(&node.to_json())
            .map(|e| format!("{}: {e}", e.instance_path()))
            .collect();
        assert!(listed, "{what}: walk {:#?}\nschema {errors:#?}", walked.findings);
    }
}

/// Every document that differs from a given one in one place.
fn mutants(value: &Value) -> Vec<Value> {
    let replacements = [
        json!(null),
        json!(true),
        json!(-1.5),
        json!(1e30),
        json!("text"),
        json!("30 mm"),
        json!("30 Nm"),
        json!("47"),
        json!("1,5 mm"),
        json!(" 5 mm"),
        json!([]),
        json!([1, 2, 3]),
        json!({}),
        json!({ "type": "skf" }),
        json!({ "type": "nothing_of_the_kind" }),
        json!("none"),
    ];
    let mut found = Vec::new();
    let mut paths = Vec::new();
    collect(value, String::new(), &mut paths);
    for path in paths {
        for new in &replacements {
            let mut mutant = value.clone();
            *mutant.pointer_mut(&path).unwrap() = new.clone();
            found.push(mutant);
        }
        let (parent, key) = path.rsplit_once('/').unwrap();
        let mut without = value.clone();
        if let Some(map) = without.pointer_mut(parent).and_then(Value::as_object_mut) {
            let old = map.shift_remove(key).unwrap();
            let mut renamed = without.clone();
            found.push(without);
            renamed
                .pointer_mut(parent)
                .unwrap()
                .as_object_mut()
                .unwrap()
                .insert(format!("{key}_x"), old);
            found.push(renamed);
        }
    }
    found
}

fn collect(value: &Value, path: String, paths: &mut Vec<String>) {
    if !path.is_empty() {
        paths.push(path.clone());
    }
    match value {
        Value::Object(map) => map
            .iter()
            .for_each(|(key, inner)| collect(inner, format!("{path}/{key}"), paths)),
        Value::Array(list) => list
            .iter()
            .enumerate()
            .for_each(|(i, inner)| collect(inner, format!("{path}/{i}"), paths)),
        _ => {}
    }
}

#[test]
fn walk_and_schema_agree_on_golden_documents() {
    let language = common::language();
    let validator = jsonschema::validator_for(&language.published(Kind::Gearbox)).unwrap();
    for folder in common::cases() {
        let text = std::fs::read_to_string(folder.join("input.yaml")).unwrap();
        let read = read_yaml(0, &text);
        // What is no YAML for us has no verdict of a schema.
        if read.findings.is_empty() {
            compare(&language, &validator, false, &read.node, &folder.display().to_string());
        }
    }
}

#[test]
fn walk_and_schema_agree_on_mutated_documents() {
    let language = common::language();
    let mut count = 0;
    for (path, study) in [
        ("tests/cases/fine/input.yaml", false),
        ("tests/cases/model_misses_input/input.yaml", false),
        ("examples/two-speed-ev/gearbox.yaml", false),
        ("examples/two-speed-ev/study.yaml", true),
    ] {
        let kind = if study { Kind::Study } else { Kind::Gearbox };
        let validator = jsonschema::validator_for(&language.published(kind)).unwrap();
        let text = std::fs::read_to_string(common::file(path)).unwrap();
        let node = read_yaml(0, &text).node;
        assert!(matches!(node.content, Content::Map(_)));
        compare(&language, &validator, study, &node, path);
        let mutants = mutants(&node.to_json());
        // The large example is thinned out: its sections repeat.
        let step = if mutants.len() > 4000 { 3 } else { 1 };
        for mutant in mutants.iter().step_by(step) {
            count += 1;
            compare(
                &language,
                &validator,
                study,
                &Node::from_json(mutant),
                &format!("{path}: {mutant}"),
            );
        }
    }
    assert!(count > 3000, "only {count} documents");
}
