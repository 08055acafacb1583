//! `gearloss lsp`: the program over its standard streams, and its findings beside those of `check`.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use crate::common;
use gearloss::editor::Workspace;
use gearloss::studies::engine::progress::Silent;
use gearloss_framework::files::Disk;
use serde_json::{Value, json};

struct Client {
    process: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    next: i64,
    /// Findings by document, the newest.
    published: Vec<Value>,
}

impl Client {
    fn start(folder: &Path) -> Self {
        let mut process = Command::new(assert_cmd::cargo::cargo_bin("gearloss"))
            .args(["lsp", "--stdio"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (to, from) = (process.stdin.take().unwrap(), process.stdout.take().unwrap());
        let mut client = Self {
            process,
            to,
            from: BufReader::new(from),
            next: 0,
            published: Vec::new(),
        };
        let root = format!("file://{}", folder.display());
        client.request(
            "initialize",
            json!({ "rootUri": root, "capabilities": { "general": { "positionEncodings": ["utf-8", "utf-16"] } } }),
        );
        client.notify("initialized", json!({}));
        client
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        write!(self.to, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.to.flush().unwrap();
    }

    fn notify(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.from.read_line(&mut line).unwrap() > 0, "the server ended");
            match line.trim().split_once(": ") {
                Some((_, number)) => length = number.parse().unwrap(),
                None => break,
            }
        }
        let mut bytes = vec![0; length];
        self.from.read_exact(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    fn request(&mut self, method: &str, params: Value) -> Value {
        self.next += 1;
        let id = self.next;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.receive();
            if message["id"] == id {
                return message;
            }
            self.published.push(message["params"].clone());
        }
    }

    fn open(&mut self, file: &Path, text: &str) {
        let document = json!({ "uri": uri(file), "languageId": "yaml", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// The findings of a version of a document.
    fn findings(&mut self, file: &Path, version: i64) -> Value {
        let uri = uri(file);
        let is_it = |params: &Value| params["uri"] == uri.as_str() && params["version"] == version;
        loop {
            if let Some(found) = self.published.iter().find(|params| is_it(params)) {
                return found["diagnostics"].clone();
            }
            let message = self.receive();
            self.published.push(message["params"].clone());
        }
    }

    fn end(mut self) {
        self.request("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        assert!(self.process.wait().unwrap().success());
    }
}

fn uri(file: &Path) -> String {
    format!("file://{}", file.display())
}

#[test]
fn the_program_serves_an_editor() {
    let folder = common::file("examples/two-speed-ev");
    let (gearbox, study) = (folder.join("gearbox.yaml"), folder.join("study.yaml"));
    let text = std::fs::read_to_string(&gearbox).unwrap();
    let mut client = Client::start(&folder);
    client.open(&gearbox, &text);
    assert_eq!(client.findings(&gearbox, 1), json!([]));

    // Half a line is typed at the end of the text.
    let lines = text.lines().count();
    let change = json!({ "range": { "start": { "line": lines, "character": 0 }, "end": { "line": lines, "character": 0 } },
        "text": "seals:\n  S9: { shaft: " });
    let document = json!({ "uri": uri(&gearbox), "version": 2 });
    client.notify(
        "textDocument/didChange",
        json!({ "textDocument": document, "contentChanges": [change] }),
    );
    let found = client.findings(&gearbox, 2);
    assert_eq!(found[0]["severity"], 1, "{found}");
    assert!(found[0]["message"].as_str().unwrap().contains("help: "), "{found}");
    let at = json!({ "textDocument": { "uri": uri(&gearbox) }, "position": { "line": lines + 1, "character": 15 } });
    let items = client.request("textDocument/completion", at)["result"]["items"].clone();
    let labels: Vec<&str> = items
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|item| item["label"].as_str())
        .collect();
    assert!(labels.contains(&"input"), "{labels:?}");

    // A study, open or not, is renamed with the gearbox.
    let line = text.lines().position(|line| line.starts_with("gear_states:")).unwrap();
    let row = text.lines().nth(line).unwrap();
    let (line, column) = match row.find("first") {
        Some(column) => (line, column),
        None => (line + 1, text.lines().nth(line + 1).unwrap().find("first").unwrap()),
    };
    let rename = json!({ "textDocument": { "uri": uri(&gearbox) }, "position": { "line": line, "character": column + 1 }, "newName": "low" });
    let renamed = client.request("textDocument/rename", rename);
    let changes = &renamed["result"]["changes"];
    assert!(
        changes[uri(&gearbox)].is_array() && changes[uri(&study)].is_array(),
        "{renamed}"
    );
    client.end();
}

/// Without `shutdown` the program ends with the input, and says so by its exit code.
#[test]
fn the_program_ends_with_its_input() {
    let Client { mut process, to, .. } = Client::start(&common::file("examples"));
    drop(to);
    assert_eq!(process.wait().unwrap().code(), Some(1));
}

/// Documents of the repository, valid and faulty.
fn documents() -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in ["examples", "tests/cases", "tests/mistakes"] {
        let mut waiting = vec![common::file(folder)];
        while let Some(folder) = waiting.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    waiting.push(path);
                } else if path.extension().is_some_and(|extension| extension == "yaml") {
                    found.push(path);
                }
            }
        }
    }
    found.sort();
    assert!(found.len() > 100);
    found
}

/// A finding without its ranges, as `check --format json` prints it.
fn as_checked(finding: Value) -> Value {
    let mut finding = finding;
    let place = finding["place"].take();
    let point = |place: &Value| {
        let text = std::fs::read_to_string(place["file"].as_str().unwrap()).unwrap();
        let from = place["range"]["from"].as_u64().unwrap() as usize;
        let before = &text[..from];
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        assert_eq!(place["range"]["start"]["line"], before.matches('\n').count());
        (place["range"]["start"]["line"].as_u64().unwrap() + 1, column)
    };
    let object = finding.as_object_mut().unwrap();
    object.remove("place");
    let position = (!place.is_null()).then(|| point(&place));
    object.insert("file".to_owned(), place.get("file").cloned().unwrap_or_default());
    object.insert("line".to_owned(), json!(position.map(|(line, _)| line)));
    object.insert("column".to_owned(), json!(position.map(|(_, column)| column)));
    for related in object["related"].as_array_mut().unwrap() {
        let (line, column) = point(related);
        *related = json!({ "file": related["file"], "line": line, "column": column, "message": related["message"] });
    }
    finding
}

#[test]
fn findings_are_those_of_check() {
    let language = common::language();
    let workspace = Workspace::new(&language, Disk::shared());
    let files = documents();
    let output = Command::new(assert_cmd::cargo::cargo_bin("gearloss"))
        .args(["check", "--format", "json"])
        .args(&files)
        .output()
        .unwrap();
    let checked: Value = serde_json::from_slice(&output.stdout).unwrap();
    let mut faulty = 0;
    for (file, checked) in files.iter().zip(checked["files"].as_array().unwrap()) {
        let found = workspace.findings(file, &Silent).unwrap();
        faulty += usize::from(!found.is_empty());
        let found: Vec<Value> = found
            .iter()
            .map(|finding| as_checked(serde_json::to_value(finding).unwrap()))
            .collect();
        assert_eq!(json!(found), checked["findings"], "{}", file.display());
    }
    assert!(faulty > 50, "{faulty}");
}
