//! A client of a language server: requests and their answers as JSON-RPC over standard input and output.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// The longest that one answer may take. An answer takes a fraction of a second; a machine may be busy.
const PATIENCE: Duration = Duration::from_secs(90);

/// What a language server says of a place in a text.
#[derive(Debug)]
pub struct Complaint {
    /// Line, from zero.
    pub line: usize,
    /// The text that is underlined.
    pub marked: String,
    /// What is said.
    pub message: String,
}

/// What is offered at a place in a text.
#[derive(Debug)]
pub struct Offer {
    /// What is inserted, as shown.
    pub label: String,
    /// What it is.
    pub meaning: String,
}

/// A running language server with its settings. It ends when this is dropped.
pub struct LanguageServer {
    child: Child,
    input: ChildStdin,
    messages: Receiver<Value>,
    settings: Value,
    diagnostics: BTreeMap<String, Value>,
    requests: u64,
    opened: u64,
}

impl Drop for LanguageServer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl LanguageServer {
    /// Starts a server with the settings of its section `yaml`; what it prints as errors goes into a file.
    pub fn start(mut command: Command, settings: Value, errors: &Path) -> Self {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(File::create(errors).unwrap())
            .spawn()
            .unwrap();
        let input = child.stdin.take().unwrap();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            while let Some(message) = read(&mut output) {
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        let mut server = Self {
            child,
            input,
            messages,
            settings,
            diagnostics: BTreeMap::new(),
            requests: 0,
            opened: 0,
        };
        server.request(
            "initialize",
            &json!({
                "processId": std::process::id(),
                "rootUri": null,
                "capabilities": {
                    "workspace": { "configuration": true },
                    "textDocument": {
                        "completion": { "completionItem": { "snippetSupport": true, "documentationFormat": ["markdown"] } },
                        "hover": { "contentFormat": ["markdown"] },
                    },
                },
            }),
        );
        server.send(&json!({ "method": "initialized", "params": {} }));
        server
    }

    /// All complaints about a text that stands, or would stand, in a file.
    pub fn complaints(&mut self, file: &Path, text: &str) -> Vec<Complaint> {
        let uri = self.open(file, text);
        let end = Instant::now() + PATIENCE;
        while !self.diagnostics.contains_key(&uri) {
            self.next(end, "diagnostics");
        }
        let lines: Vec<&str> = text.lines().collect();
        let complaints = self.diagnostics[&uri].as_array().unwrap().iter().map(|d| {
            let (from, to) = (&d["range"]["start"], &d["range"]["end"]);
            let line = index(&from["line"]);
            let rest: Vec<u16> = lines[line].encode_utf16().collect();
            let start = index(&from["character"]).min(rest.len());
            let same_line = from["line"] == to["line"];
            let stop = if same_line { index(&to["character"]) } else { rest.len() };
            Complaint {
                line,
                marked: String::from_utf16_lossy(&rest[start..stop.clamp(start, rest.len())]),
                message: d["message"].as_str().unwrap().to_owned(),
            }
        });
        complaints.collect()
    }

    /// What is offered where `|` stands in a text.
    pub fn offers(&mut self, file: &Path, text: &str) -> Vec<Offer> {
        let answer = self.at_cursor("textDocument/completion", file, text);
        let items = answer.get("items").unwrap_or(&answer).as_array().cloned();
        let offer = |item: Value| Offer {
            label: item["label"].as_str().unwrap().to_owned(),
            meaning: markup(&item["documentation"]),
        };
        items.unwrap_or_default().into_iter().map(offer).collect()
    }

    /// What is shown of the word on which `|` stands in a text.
    pub fn hover(&mut self, file: &Path, text: &str) -> String {
        let answer = self.at_cursor("textDocument/hover", file, text);
        markup(&answer["contents"])
    }

    fn at_cursor(&mut self, method: &str, file: &Path, text: &str) -> Value {
        let (before, after) = text.split_once('|').expect("a text with a cursor");
        let uri = self.open(file, &format!("{before}{after}"));
        let line = before.matches('\n').count();
        let character = before.rsplit('\n').next().unwrap_or_default().encode_utf16().count();
        self.request(
            method,
            &json!({ "textDocument": { "uri": uri }, "position": { "line": line, "character": character } }),
        )
    }

    /// Opens a text. Each has a name of its own beside the file, so that no answer belongs to an earlier one.
    fn open(&mut self, file: &Path, text: &str) -> String {
        self.opened += 1;
        let name = format!("{}-{}", self.opened, file.file_name().unwrap().to_string_lossy());
        let uri = uri(&file.with_file_name(name));
        let document = json!({ "uri": uri, "languageId": "yaml", "version": 1, "text": text });
        self.send(&json!({ "method": "textDocument/didOpen", "params": { "textDocument": document } }));
        uri
    }

    fn request(&mut self, method: &str, params: &Value) -> Value {
        self.requests += 1;
        let id = self.requests;
        self.send(&json!({ "id": id, "method": method, "params": params }));
        let end = Instant::now() + PATIENCE;
        loop {
            let Some(mut answer) = self.next(end, method) else {
                continue;
            };
            if answer["id"] == id {
                assert!(answer.get("error").is_none(), "{method}: {answer}");
                return answer["result"].take();
            }
        }
    }

    /// The next answer of the server; its own requests are answered and its notices noted.
    fn next(&mut self, end: Instant, what: &str) -> Option<Value> {
        let left = end.saturating_duration_since(Instant::now());
        let message = match self.messages.recv_timeout(left) {
            Ok(message) => message,
            Err(RecvTimeoutError::Timeout) => panic!("the language server gave no {what} within {PATIENCE:?}"),
            Err(RecvTimeoutError::Disconnected) => panic!("the language server ended before it gave {what}"),
        };
        let Some(method) = message["method"].as_str() else {
            return Some(message);
        };
        if method == "textDocument/publishDiagnostics" {
            let params = &message["params"];
            let uri = params["uri"].as_str().unwrap().to_owned();
            self.diagnostics.insert(uri, params["diagnostics"].clone());
        }
        if let Some(id) = message.get("id") {
            let sections = message["params"]["items"].as_array().into_iter().flatten();
            let settings: Vec<Value> = sections
                .map(|item| match item["section"].as_str() {
                    Some("yaml") => self.settings.clone(),
                    _ => json!({}),
                })
                .collect();
            let asked = method == "workspace/configuration";
            let result = if asked { json!(settings) } else { Value::Null };
            self.send(&json!({ "id": id, "result": result }));
        }
        None
    }

    fn send(&mut self, message: &Value) {
        let mut message = message.clone();
        message["jsonrpc"] = json!("2.0");
        let body = message.to_string();
        let sent = write!(self.input, "Content-Length: {}\r\n\r\n{body}", body.len()).and_then(|()| self.input.flush());
        sent.expect("the language server reads");
    }
}

/// The address of a file.
pub fn uri(file: &Path) -> String {
    let mut text = "file://".to_owned();
    for byte in file.to_string_lossy().bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
            text.push(char::from(byte));
        } else {
            text.push_str(&format!("%{byte:02X}"));
        }
    }
    text
}

fn index(value: &Value) -> usize {
    usize::try_from(value.as_u64().unwrap()).unwrap()
}

/// Plain text of what may be a text or marked up; brackets are escaped there.
fn markup(value: &Value) -> String {
    let text = value.as_str().or_else(|| value["value"].as_str()).unwrap_or_default();
    text.replace('\\', "")
}

/// One message; none at the end.
fn read(output: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        let line = line.trim_end();
        if line.is_empty() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse().ok()?;
        }
    }
    let mut body = vec![0; length];
    output.read_exact(&mut body).ok()?;
    serde_json::from_slice(&body).ok()
}
