//! A language server over any pair of streams: JSON-RPC frames with `Content-Length`, as in the Language Server Protocol 3.17.
//!
//! One thread reads, one answers in order, one checks documents. A check is interrupted when a newer text arrives; requests that the
//! client has cancelled before their turn are not computed.

mod checker;
mod frame;
mod show;
mod uri;

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use gearloss_document::files::SharedSource;
use gearloss_framework::language::Language;
use serde_json::{Value, json};

use self::checker::Checker;
use self::frame::{Frame, read_frame, write_frame};
use crate::folder;
use crate::text::{Encoding, Lines};
use crate::workspace::Workspace;

/// Codes of errors of JSON-RPC and of the protocol.
const PARSE_ERROR: i64 = -32700;
const INVALID_REQUEST: i64 = -32600;
const METHOD_NOT_FOUND: i64 = -32601;
const INVALID_PARAMS: i64 = -32602;
const NOT_INITIALIZED: i64 = -32002;
const CANCELLED: i64 = -32800;
const REQUEST_FAILED: i64 = -32803;

/// The output, which the threads share.
pub(crate) struct Output<W>(Mutex<W>);

impl<W: Write> Output<W> {
    /// Sends a message. A closed pipe is not a failure: the input ends then, too.
    fn send(&self, message: &Value) {
        if let Ok(mut to) = self.0.lock() {
            let _ = write_frame(&mut *to, message);
        }
    }

    fn notify(&self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }
}

/// Serves until the client says `exit` or closes the input. Returns true if it said `shutdown` before.
pub fn serve(language: &Language, source: SharedSource, input: impl BufRead + Send, output: impl Write + Send) -> bool {
    let output = Output(Mutex::new(output));
    let checker = Checker::default();
    thread::scope(|scope| {
        let (to, from) = channel();
        scope.spawn(move || {
            let mut input = input;
            while let Some(frame) = read_frame(&mut input) {
                let last = matches!(&frame, Frame::Message(message) if message["method"] == "exit");
                if to.send(frame).is_err() || last {
                    break;
                }
            }
        });
        scope.spawn(|| checker.run(&output));
        let mut server = Server {
            workspace: Workspace::new(language, source),
            output: &output,
            checker: &checker,
            encoding: Encoding::Utf16,
            uris: BTreeMap::new(),
            versions: BTreeMap::new(),
            state: State::New,
        };
        server.run(&from);
        checker.stop();
        server.state == State::ShutDown
    })
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    Running,
    ShutDown,
}

struct Server<'a, 'l, W> {
    workspace: Workspace<'l>,
    output: &'a Output<W>,
    checker: &'a Checker<'l>,
    encoding: Encoding,
    /// As the client writes them.
    uris: BTreeMap<PathBuf, String>,
    versions: BTreeMap<PathBuf, i64>,
    state: State,
}

/// Why a request has no result.
struct Refused {
    code: i64,
    message: String,
}

impl Refused {
    fn new(code: i64, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
        }
    }
}

impl<W: Write> Server<'_, '_, W> {
    fn run(&mut self, from: &Receiver<Frame>) {
        let mut waiting: VecDeque<Frame> = VecDeque::new();
        let mut cancelled: BTreeSet<String> = BTreeSet::new();
        loop {
            if waiting.is_empty() {
                match from.recv() {
                    Ok(frame) => waiting.push_back(frame),
                    Err(_) => return,
                }
            }
            // Everything that has arrived: a later message may cancel an earlier one.
            waiting.extend(from.try_iter());
            for frame in &waiting {
                if let Frame::Message(message) = frame
                    && message["method"] == "$/cancelRequest"
                {
                    cancelled.insert(message["params"]["id"].to_string());
                }
            }
            let Some(frame) = waiting.pop_front() else { continue };
            match frame {
                Frame::Broken(reason) => self.respond(&Value::Null, Err(Refused::new(PARSE_ERROR, reason))),
                Frame::Message(message) => {
                    if message["method"] == "exit" {
                        return;
                    }
                    self.message(&message, &mut cancelled);
                }
            }
        }
    }

    fn respond(&self, id: &Value, result: Result<Value, Refused>) {
        let mut response = json!({ "jsonrpc": "2.0", "id": id });
        match result {
            Ok(result) => response["result"] = result,
            Err(refused) => response["error"] = json!({ "code": refused.code, "message": refused.message }),
        }
        self.output.send(&response);
    }

    fn message(&mut self, message: &Value, cancelled: &mut BTreeSet<String>) {
        let params = &message["params"];
        let method = message.get("method").and_then(Value::as_str);
        match (message.get("id"), method) {
            (Some(id), Some(method)) => {
                let result = if cancelled.remove(&id.to_string()) {
                    Err(Refused::new(CANCELLED, "cancelled"))
                } else {
                    self.request(method, params)
                };
                self.respond(id, result);
            }
            (None, Some("$/cancelRequest")) => {
                cancelled.remove(&params["id"].to_string());
            }
            (None, Some(method)) => self.notification(method, params),
            // A response to a request: the server makes none.
            (Some(_), None) if message.get("result").is_some() || message.get("error").is_some() => {}
            _ => self.respond(
                message.get("id").unwrap_or(&Value::Null),
                Err(Refused::new(INVALID_REQUEST, "neither a request nor a notification")),
            ),
        }
    }

    fn request(&mut self, method: &str, params: &Value) -> Result<Value, Refused> {
        match (self.state, method) {
            (State::New, "initialize") => Ok(self.initialize(params)),
            (State::New, _) => Err(Refused::new(NOT_INITIALIZED, "`initialize` must be first")),
            (State::ShutDown, _) => Err(Refused::new(INVALID_REQUEST, "the server is shut down")),
            (State::Running, "shutdown") => {
                self.state = State::ShutDown;
                Ok(Value::Null)
            }
            (State::Running, "textDocument/completion") => {
                let (path, offset) = self.place(params)?;
                let items = if self.workspace.is_document(&path) {
                    self.workspace.completion(&path, offset)
                } else {
                    Vec::new()
                };
                Ok(show::completions(&items, self.encoding))
            }
            (State::Running, "textDocument/hover") => {
                let (path, offset) = self.place(params)?;
                let hover = self.workspace.hover(&path, offset);
                let hover = hover.filter(|_| self.workspace.is_document(&path));
                Ok(hover.map_or(Value::Null, |hover| show::hover(&hover, self.encoding)))
            }
            (State::Running, "textDocument/definition") => {
                let (path, offset) = self.place(params)?;
                Ok(self.locations(&self.workspace.definition(&path, offset)))
            }
            (State::Running, "textDocument/references") => {
                let (path, offset) = self.place(params)?;
                let mut places = self.workspace.references(&path, offset);
                if params["context"]["includeDeclaration"] == false {
                    let definitions = self.workspace.definition(&path, offset);
                    places.retain(|place| !definitions.contains(place));
                }
                Ok(self.locations(&places))
            }
            (State::Running, "textDocument/prepareRename") => {
                let (path, offset) = self.place(params)?;
                let place = self.workspace.renamable(&path, offset);
                Ok(place.map_or(Value::Null, |place| show::range(&place.range, self.encoding)))
            }
            (State::Running, "textDocument/rename") => {
                let (path, offset) = self.place(params)?;
                let name = params["newName"].as_str();
                let name = name.ok_or_else(|| Refused::new(INVALID_PARAMS, "`newName` is missing"))?;
                let edits = self.workspace.rename(&path, offset, name);
                let edits = edits.map_err(|refused| Refused::new(REQUEST_FAILED, refused.to_string()))?;
                let mut changes = serde_json::Map::new();
                for file in &edits {
                    changes.insert(self.uri(Path::new(&file.file)), show::edits(&file.edits, self.encoding));
                }
                Ok(json!({ "changes": changes }))
            }
            (State::Running, "textDocument/documentSymbol") => {
                let path = document(params)?;
                Ok(show::symbols(&self.workspace.symbols(&path), self.encoding))
            }
            (State::Running, _) => Err(Refused::new(METHOD_NOT_FOUND, format!("there is no method `{method}`"))),
        }
    }

    fn initialize(&mut self, params: &Value) -> Value {
        self.state = State::Running;
        let encodings = params.pointer("/capabilities/general/positionEncodings");
        let offered = encodings.and_then(Value::as_array).into_iter().flatten();
        if offered.into_iter().any(|encoding| encoding == "utf-8") {
            self.encoding = Encoding::Utf8;
        }
        let folders = params["workspaceFolders"].as_array().into_iter().flatten();
        let folders = folders.filter_map(|folder| folder["uri"].as_str());
        let root = params["rootUri"].as_str();
        let folders: BTreeSet<PathBuf> = folders.chain(root).filter_map(uri::path).collect();
        for folder in folders {
            for file in folder::files(&folder, folder::DEEPEST) {
                self.workspace.know(file);
            }
        }
        json!({
            "capabilities": {
                "positionEncoding": self.encoding,
                "textDocumentSync": { "openClose": true, "change": 2, "save": true },
                "completionProvider": { "triggerCharacters": [" ", ":", "{", "[", ",", ".", "/"] },
                "hoverProvider": true,
                "definitionProvider": true,
                "referencesProvider": true,
                "renameProvider": { "prepareProvider": true },
                "documentSymbolProvider": true,
            },
            "serverInfo": { "name": "gearloss", "version": env!("CARGO_PKG_VERSION") },
        })
    }

    fn notification(&mut self, method: &str, params: &Value) {
        if self.state != State::Running {
            return;
        }
        // Without a valid document there is nothing to do, and nobody to answer.
        let path = document(params).ok();
        match (method, path) {
            ("textDocument/didOpen", Some(path)) => {
                let Some(text) = params["textDocument"]["text"].as_str() else {
                    return;
                };
                if let Some(written) = params["textDocument"]["uri"].as_str() {
                    self.uris.insert(path.clone(), written.to_owned());
                }
                if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                    for file in folder::files(folder, 1) {
                        self.workspace.know(file);
                    }
                }
                self.workspace.open(&path, text);
                self.changed(params, &path);
            }
            ("textDocument/didChange", Some(path)) => {
                let Some(text) = self.workspace.text(&path) else {
                    return;
                };
                let mut text = text.to_string();
                for change in params["contentChanges"].as_array().into_iter().flatten() {
                    self.apply(change, &mut text);
                }
                self.workspace.open(&path, text);
                self.changed(params, &path);
            }
            ("textDocument/didClose", Some(path)) => {
                self.workspace.close(&path);
                self.versions.remove(&path);
                let uri = self.uri(&path);
                self.output.notify(
                    "textDocument/publishDiagnostics",
                    json!({ "uri": uri, "diagnostics": [] }),
                );
                self.uris.remove(&path);
                self.check(None);
            }
            ("textDocument/didSave", path) => self.check(path.as_deref()),
            ("workspace/didChangeWatchedFiles", _) => {
                let changes = params["changes"].as_array().into_iter().flatten();
                for file in changes.filter_map(|change| uri::path(change["uri"].as_str()?)) {
                    self.workspace.know(file);
                }
                self.check(None);
            }
            _ => {}
        }
    }

    /// Applies a change of a text: a range, or the whole.
    fn apply(&self, change: &Value, text: &mut String) {
        let Some(new) = change["text"].as_str() else { return };
        let Some(range) = change.get("range") else {
            new.clone_into(text);
            return;
        };
        let lines = Lines::new(text);
        let offset = |place: &Value| {
            let number = |key: &str| u32::try_from(place[key].as_u64().unwrap_or(0)).unwrap_or(u32::MAX);
            lines.offset(text, number("line"), number("character"), self.encoding)
        };
        let (start, end) = (offset(&range["start"]), offset(&range["end"]));
        text.replace_range(start.min(end)..end.max(start), new);
    }

    fn changed(&mut self, params: &Value, path: &Path) {
        if let Some(version) = params["textDocument"]["version"].as_i64() {
            self.versions.insert(path.to_owned(), version);
        }
        self.check(Some(path));
    }

    /// Checks all open documents, one of them first: others may name it.
    fn check(&self, first: Option<&Path>) {
        let mut paths: Vec<PathBuf> = self.workspace.opened().map(Path::to_owned).collect();
        if let Some(first) = first {
            let first = gearloss_document::files::without_dots(first);
            paths.sort_by_key(|path| *path != first);
        }
        let jobs = paths.into_iter().map(|path| {
            let uri = self.uri(&path);
            let version = self.versions.get(&path).copied();
            checker::Job { path, uri, version }
        });
        let jobs = jobs.collect();
        self.checker
            .start(self.workspace.clone(), self.encoding, self.uris.clone(), jobs);
    }

    fn uri(&self, path: &Path) -> String {
        self.uris.get(path).cloned().unwrap_or_else(|| uri::uri(path))
    }

    fn locations(&self, places: &[crate::findings::FileRange]) -> Value {
        let location = |place: &crate::findings::FileRange| json!({ "uri": self.uri(Path::new(&place.file)), "range": show::range(&place.range, self.encoding) });
        places.iter().map(location).collect()
    }

    fn place(&self, params: &Value) -> Result<(PathBuf, usize), Refused> {
        let path = document(params)?;
        let text = self.workspace.text(&path);
        let text = text.ok_or_else(|| Refused::new(INVALID_PARAMS, "the document is not open"))?;
        let number = |key: &str| params["position"][key].as_u64().and_then(|n| u32::try_from(n).ok());
        let (Some(line), Some(column)) = (number("line"), number("character")) else {
            return Err(Refused::new(INVALID_PARAMS, "`position` needs `line` and `character`"));
        };
        Ok((path, Lines::new(text).offset(text, line, column, self.encoding)))
    }
}

/// The path of the document of a request.
fn document(params: &Value) -> Result<PathBuf, Refused> {
    let written = params["textDocument"]["uri"].as_str();
    let written = written.ok_or_else(|| Refused::new(INVALID_PARAMS, "`textDocument.uri` is missing"))?;
    // A document without a file has its URI as its name.
    let path = uri::path(written).unwrap_or_else(|| PathBuf::from(written));
    Ok(gearloss_document::files::without_dots(&path))
}
