//! The language server over streams in memory.

use std::io::{BufReader, Cursor, Read, Write};
use std::sync::{Arc, Mutex};

use gearloss_document::files::InMemory;
use gearloss_editor::lsp::serve;
use serde_json::{Value, json};

use super::common::language;

#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn frame(message: &str) -> Vec<u8> {
    format!("Content-Length: {}\r\n\r\n{message}", message.len()).into_bytes()
}

fn messages(bytes: &[u8]) -> Vec<Value> {
    let mut rest = bytes;
    let mut all = Vec::new();
    while let Some(end) = rest.windows(4).position(|four| four == b"\r\n\r\n") {
        let head = std::str::from_utf8(&rest[..end]).unwrap();
        let length: usize = head.trim_start_matches("Content-Length: ").parse().unwrap();
        all.push(serde_json::from_slice(&rest[end + 4..end + 4 + length]).unwrap());
        rest = &rest[end + 4 + length..];
    }
    all
}

/// Sends frames and returns the answers, and whether the server ended in order.
fn exchange(frames: &[Vec<u8>]) -> (Vec<Value>, bool) {
    let output = Shared::default();
    let input = BufReader::new(Cursor::new(frames.concat()).take(u64::MAX));
    let ended = serve(language(), InMemory::default().shared(), input, output.clone());
    let bytes = output.0.lock().unwrap().clone();
    (messages(&bytes), ended)
}

fn request(id: i64, method: &str, params: Value) -> Vec<u8> {
    frame(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }).to_string())
}

fn notification(method: &str, params: Value) -> Vec<u8> {
    frame(&json!({ "jsonrpc": "2.0", "method": method, "params": params }).to_string())
}

fn answer(all: &[Value], id: i64) -> &Value {
    all.iter()
        .find(|message| message["id"] == id)
        .unwrap_or_else(|| panic!("no answer to {id}: {all:?}"))
}

#[test]
fn a_session_with_incremental_changes() {
    let document = json!({ "uri": "file:///f/a.yaml" });
    let text = "gearloss: gearbox/1\n# 𝄞\nshafts: { a: {} }\ngears: { G: { shaft: a } }\n";
    let at = |line: u32, character: u32| json!({ "textDocument": document, "position": { "line": line, "character": character } });
    let (all, ended) = exchange(&[
        request(1, "initialize", json!({ "capabilities": {} })),
        notification("initialized", json!({})),
        notification(
            "textDocument/didOpen",
            json!({ "textDocument": { "uri": "file:///f/a.yaml", "version": 1, "text": text } }),
        ),
        request(2, "textDocument/completion", at(3, 21)),
        // `𝄞` has two units: this replaces it and inserts behind.
        notification(
            "textDocument/didChange",
            json!({
                "textDocument": { "uri": "file:///f/a.yaml", "version": 2 },
                "contentChanges": [
                    { "range": { "start": { "line": 1, "character": 2 }, "end": { "line": 1, "character": 4 } }, "text": "x" },
                    { "range": { "start": { "line": 2, "character": 10 }, "end": { "line": 2, "character": 11 } }, "text": "bb" },
                ],
            }),
        ),
        request(3, "textDocument/hover", at(2, 1)),
        request(4, "textDocument/definition", at(3, 21)),
        request(
            5,
            "textDocument/rename",
            json!({
                "textDocument": document, "position": { "line": 2, "character": 10 }, "newName": "cc",
            }),
        ),
        request(6, "textDocument/documentSymbol", json!({ "textDocument": document })),
        request(7, "textDocument/nothing", json!({})),
        request(8, "shutdown", Value::Null),
        notification("exit", Value::Null),
    ]);
    assert!(ended);
    assert_eq!(answer(&all, 1)["result"]["capabilities"]["positionEncoding"], "utf-16");
    assert_eq!(answer(&all, 2)["result"]["items"][0]["label"], "a");
    assert!(
        answer(&all, 3)["result"]["contents"]["value"]
            .as_str()
            .unwrap()
            .contains("Shafts")
    );
    assert_eq!(answer(&all, 4)["result"], json!([]), "`a` is now `bb`");
    let changes = &answer(&all, 5)["result"]["changes"]["file:///f/a.yaml"];
    assert_eq!(changes.as_array().unwrap().len(), 1, "{changes}");
    assert_eq!(changes[0]["range"]["end"]["character"], 12);
    assert_eq!(answer(&all, 6)["result"][1]["name"], "shafts");
    assert_eq!(answer(&all, 7)["error"]["code"], -32601);
    assert_eq!(answer(&all, 8)["result"], Value::Null);
}

#[test]
fn broken_frames_and_wrong_orders_are_answered() {
    let (all, ended) = exchange(&[
        b"Content-Type: x\r\n\r\n".to_vec(),
        frame("{ no json"),
        frame("[1, 2]"),
        b"\r\n\r\nContent-Length: many\r\n\r\n".to_vec(),
        request(1, "textDocument/hover", json!({})),
        request(
            2,
            "initialize",
            json!({ "capabilities": { "general": { "positionEncodings": ["utf-8"] } } }),
        ),
        request(
            3,
            "textDocument/hover",
            json!({ "textDocument": { "uri": "file:///f/a.yaml" }, "position": {} }),
        ),
        request(4, "textDocument/hover", json!(null)),
        notification("textDocument/didOpen", json!("wrong")),
        notification(
            "textDocument/didChange",
            json!({ "textDocument": { "uri": "file:///f/b.yaml" }, "contentChanges": 3 }),
        ),
        frame("{}"),
        request(
            5,
            "textDocument/completion",
            json!({ "textDocument": { "uri": "untitled:1" }, "position": { "line": -1, "character": 1e99 } }),
        ),
        notification("$/cancelRequest", json!({ "id": 5 })),
    ]);
    assert!(!ended, "the input ended without `shutdown`");
    let codes: Vec<i64> = all
        .iter()
        .filter_map(|message| message["error"]["code"].as_i64())
        .collect();
    assert_eq!(codes.iter().filter(|code| **code == -32700).count(), 4, "{all:?}");
    assert_eq!(answer(&all, 1)["error"]["code"], -32002);
    assert_eq!(answer(&all, 2)["result"]["capabilities"]["positionEncoding"], "utf-8");
    assert_eq!(answer(&all, 3)["error"]["code"], -32602);
    assert_eq!(answer(&all, 4)["error"]["code"], -32602);
    assert!([-32602, -32800].contains(&answer(&all, 5)["error"]["code"].as_i64().unwrap()));
    // A frame that ends too early ends the session.
    let (all, _) = exchange(&[b"Content-Length: 99\r\n\r\n{}".to_vec()]);
    assert!(all.is_empty());
}

/// An editor sends every YAML file.
#[test]
fn files_of_other_programs_are_left_alone() {
    let uri = "file:///f/compose.yaml";
    let place = json!({ "textDocument": { "uri": uri }, "position": { "line": 1, "character": 0 } });
    let (all, _) = exchange(&[
        request(1, "initialize", json!({ "capabilities": {} })),
        notification(
            "textDocument/didOpen",
            json!({ "textDocument": { "uri": uri, "text": "services: { a: {} }\n" } }),
        ),
        request(2, "textDocument/completion", place),
    ]);
    assert_eq!(answer(&all, 2)["result"]["items"], json!([]));
    let published = all
        .iter()
        .filter(|message| message["method"] == "textDocument/publishDiagnostics");
    assert!(
        published
            .into_iter()
            .all(|message| message["params"]["diagnostics"] == json!([]))
    );
}
