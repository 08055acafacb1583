//! Requests and answers as JSON.

use gearloss_document::files::InMemory;
use gearloss_editor::{Request, Workspace};
use gearloss_studies::engine::progress::Silent;
use serde_json::{Value, json};

use super::common::language;

#[test]
fn requests_and_answers_are_json() {
    let mut workspace = Workspace::new(language(), InMemory::default().shared());
    let mut ask = |request: Value| {
        let request: Request = serde_json::from_value(request).unwrap();
        serde_json::to_value(workspace.answer(&request, &Silent)).unwrap()
    };
    let text = "gearloss: gearbox/1\nshafts: { a: {} }\ngears: { G: { shaft: a } }\n";
    assert_eq!(
        ask(json!({ "request": "open", "file": "g.yaml", "text": text }))["answer"],
        "done"
    );
    let at = text.find("a } }").unwrap();
    let completion = ask(json!({ "request": "completion", "file": "g.yaml", "offset": at }));
    assert_eq!(completion["value"][0]["label"], "a", "{completion}");
    let place = ask(json!({ "request": "definition", "file": "g.yaml", "offset": at }));
    assert_eq!(place["value"][0]["range"]["start"]["line"], 1, "{place}");
    let edits = ask(json!({ "request": "rename", "file": "g.yaml", "offset": at, "name": "b" }));
    assert_eq!(edits["value"][0]["edits"].as_array().unwrap().len(), 2, "{edits}");
    let refused = ask(json!({ "request": "rename", "file": "g.yaml", "offset": at, "name": "no" }));
    assert_eq!(refused["answer"], "no_rename");
    let found = ask(json!({ "request": "findings", "file": "g.yaml" }));
    assert!(found["value"][0]["code"].is_string(), "{found}");
    assert!(ask(json!({ "request": "hover", "file": "g.yaml", "offset": at }))["value"]["text"].is_string());
    assert!(ask(json!({ "request": "symbols", "file": "g.yaml" }))["value"].is_array());
    assert!(ask(json!({ "request": "references", "file": "g.yaml", "offset": at }))["value"].is_array());
    assert_eq!(ask(json!({ "request": "close", "file": "g.yaml" }))["answer"], "done");
}
