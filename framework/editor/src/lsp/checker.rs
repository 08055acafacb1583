//! The thread that checks documents: the newest texts only.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};

use gearloss_document::Severity;
use gearloss_document::files::without_dots;
use gearloss_studies::engine::progress::{Progress, Silent, Steps};
use serde_json::{Value, json};

use super::{Output, show, uri};
use crate::findings::Finding;
use crate::ids::Name;
use crate::text::{Encoding, Lines};
use crate::workspace::{Workspace, named};

/// A document to be checked.
pub struct Job {
    pub path: PathBuf,
    pub uri: String,
    pub version: Option<i64>,
}

/// The newest texts and what is to be checked of them.
struct Work<'l> {
    workspace: Workspace<'l>,
    encoding: Encoding,
    uris: BTreeMap<PathBuf, String>,
    jobs: Vec<Job>,
    generation: u64,
}

/// Starts and interrupts checks.
#[derive(Default)]
pub struct Checker<'l> {
    waiting: Mutex<Option<Work<'l>>>,
    changed: Condvar,
    /// Number of the newest work; odd where it is the last.
    generation: AtomicU64,
}

/// Continues while no newer texts have arrived.
struct Newest<'a> {
    generation: &'a AtomicU64,
    started: u64,
}

impl Progress for Newest<'_> {
    fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_> {
        Silent.begin(label, count)
    }

    fn should_continue(&self) -> bool {
        self.generation.load(Ordering::Relaxed) == self.started
    }
}

impl<'l> Checker<'l> {
    /// Checks documents; what is running is interrupted.
    pub fn start(&self, workspace: Workspace<'l>, encoding: Encoding, uris: BTreeMap<PathBuf, String>, jobs: Vec<Job>) {
        let generation = self.generation.fetch_add(2, Ordering::Relaxed) + 2;
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        *waiting = Some(Work {
            workspace,
            encoding,
            uris,
            jobs,
            generation,
        });
        self.changed.notify_one();
    }

    /// Ends [`Checker::run`] when it has finished its present work.
    pub fn stop(&self) {
        // The lock is held so that the thread is either waiting or sees the number.
        let _waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        self.generation.fetch_or(1, Ordering::Relaxed);
        self.changed.notify_one();
    }

    fn next(&self) -> Option<Work<'l>> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if self.generation.load(Ordering::Relaxed) % 2 == 1 {
                return None;
            }
            if let Some(work) = waiting.take() {
                return Some(work);
            }
            waiting = self.changed.wait(waiting).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Checks and publishes until it is stopped.
    pub(super) fn run<W: Write>(&self, output: &Output<W>) {
        while let Some(work) = self.next() {
            let newest = Newest {
                generation: &self.generation,
                started: work.generation,
            };
            for job in &work.jobs {
                // A file of another program, or a text that is still empty.
                let is_document = work.workspace.states_kind(&job.path);
                let findings = if is_document {
                    work.workspace.findings(&job.path, &newest)
                } else {
                    Some(Vec::new())
                };
                let Some(findings) = findings else {
                    break;
                };
                if !newest.should_continue() {
                    break;
                }
                let mut params = json!({ "uri": job.uri, "diagnostics": work.diagnostics(&job.path, &findings) });
                if let Some(version) = job.version {
                    params["version"] = version.into();
                }
                output.notify("textDocument/publishDiagnostics", params);
            }
        }
    }
}

impl Work<'_> {
    fn uri(&self, path: &Path) -> String {
        self.uris.get(path).cloned().unwrap_or_else(|| uri::uri(path))
    }

    fn diagnostics(&self, path: &Path, findings: &[Finding]) -> Vec<Value> {
        findings.iter().map(|finding| self.diagnostic(path, finding)).collect()
    }

    /// A finding in another file is shown where the document names that file.
    fn diagnostic(&self, path: &Path, finding: &Finding) -> Value {
        let here = finding
            .place
            .as_ref()
            .filter(|place| without_dots(Path::new(&place.file)) == *path);
        let other = finding.place.as_ref().filter(|_| here.is_none());
        let range = match here {
            Some(place) => show::range(&place.range, self.encoding),
            None => self.naming(path, other.map(|place| without_dots(Path::new(&place.file))).as_deref()),
        };
        let mut message = String::new();
        if let Some(place) = other {
            let name = Path::new(&place.file).file_name().unwrap_or_default().to_string_lossy();
            message.push_str(&format!("{name}, line {}: ", place.range.start.line + 1));
        }
        if !finding.path.is_empty() {
            message.push_str(&format!("{}: ", finding.path));
        }
        message.push_str(&finding.message);
        for note in &finding.notes {
            message.push_str(&format!("\nnote: {note}"));
        }
        if let Some(help) = &finding.help {
            message.push_str(&format!("\nhelp: {help}"));
        }
        let related = other.map(|place| (place, "here")).into_iter();
        let related = related.chain(
            finding
                .related
                .iter()
                .map(|place| (&place.place, place.message.as_str())),
        );
        let related: Vec<Value> = related
            .map(|(place, message)| {
                let uri = self.uri(&without_dots(Path::new(&place.file)));
                json!({ "location": { "uri": uri, "range": show::range(&place.range, self.encoding) }, "message": message })
            })
            .collect();
        json!({
            "range": range,
            "severity": if finding.severity == Severity::Error { 1 } else { 2 },
            "code": finding.code,
            "source": "gearloss",
            "message": message,
            "relatedInformation": related,
        })
    }

    /// Where a document names a file, or one that extends it; its first character if it does not.
    fn naming(&self, path: &Path, file: Option<&Path>) -> Value {
        let document = self.workspace.document(path);
        let span = document.as_ref().zip(file).and_then(|(document, file)| {
            let all = self.workspace.occurrences(document).into_iter();
            let mut named = all.filter_map(|occurrence| match &occurrence.name {
                Name::File(name) => Some((named(path, name), occurrence.span)),
                _ => None,
            });
            let found = named.find(|(named, _)| {
                named == file
                    || self
                        .workspace
                        .chain(named)
                        .iter()
                        .any(|document| document.path == *file)
            });
            found.map(|(_, span)| span)
        });
        let text = document.map(|document| document.text).unwrap_or_default();
        show::range(&Lines::new(&text).range(&text, &span.unwrap_or(0..0)), self.encoding)
    }
}
