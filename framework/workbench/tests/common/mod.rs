//! Sessions about examples.

use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

use gearloss_framework::language::Language;
use gearloss_studies::engine::progress::Silent;
use gearloss_workbench::Session;
use gearloss_workbench::disk::Folder;
use gearloss_workbench::request::Request;
use gearloss_workbench::store::Store;
use serde_json::{Value, json};

static LANGUAGE: LazyLock<Language> = LazyLock::new(|| Language::linked().unwrap());

/// The linked models.
pub fn language() -> &'static Language {
    &LANGUAGE
}

/// The folder of an example.
pub fn example(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../examples")
        .join(name)
}

/// A session about a store.
pub fn session(store: impl Store + 'static) -> Session<'static> {
    Session::new(language(), Arc::new(store))
}

/// A session about an example.
pub fn about(name: &str) -> Session<'static> {
    session(Folder::open(&example(name)).unwrap())
}

/// A folder for a test, empty.
pub fn empty(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gearloss-workbench-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The answer to a request.
pub fn ask(session: &Session<'_>, request: Value) -> Value {
    let request: Request = serde_json::from_value(request).unwrap();
    session.answer(&request, &Silent)
}

/// The value of an answer.
pub fn value(session: &Session<'_>, request: Value) -> Value {
    let mut answer = ask(session, request);
    assert!(answer.get("fault").is_none(), "{answer}");
    answer["value"].take()
}

/// The fault instead of an answer.
pub fn fault(session: &Session<'_>, request: Value) -> Value {
    let mut answer = ask(session, request);
    assert!(answer.get("value").is_none(), "{answer}");
    answer["fault"].take()
}

/// The first point that the controls of a gearbox suggest, without texts.
pub fn first_point(session: &Session<'_>, texts: &Value, gearbox: &str) -> Value {
    let controls = value(
        session,
        json!({ "request": "controls", "texts": texts, "gearbox": gearbox }),
    );
    let gear = &controls["gears"][0];
    json!({
        "request": "point", "texts": texts, "gearbox": gearbox, "gear": gear["name"], "inputs": gear["inputs"],
        "oil_temperature": null, "model_set": "",
    })
}
