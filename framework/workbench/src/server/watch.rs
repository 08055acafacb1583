//! Changes of files on the disk.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

use hyper::body::Bytes;
use serde_json::json;
use tokio::sync::mpsc::Sender;
use tokio::task::spawn_blocking;
use tokio::time::{sleep, timeout};

use super::work::OpenPage;
use crate::session::Session;
use crate::store::hash;

/// When a watch looks, and when it ends.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// Time between two looks.
    pub period: Duration,
    /// How long a page may leave its lines unread.
    pub patience: Duration,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            period: Duration::from_secs(1),
            patience: Duration::from_mins(1),
        }
    }
}

/// Files of a page as it knows them.
struct Watched {
    files: BTreeMap<String, String>,
    /// Files that were missing at the last look: one that is replaced is missing for a moment.
    missing: BTreeSet<String>,
}

/// Looks at the files of a page every second and writes what changed, until nobody listens, or until the page has not read for a while.
/// Texts are short and reading one is faster than a service of the system that differs from computer to computer.
pub async fn watch(
    session: Arc<Session<'static>>,
    files: BTreeMap<String, String>,
    lines: Sender<Bytes>,
    _page: OpenPage,
    pace: Pace,
) {
    let mut watched = Watched {
        files,
        missing: BTreeSet::new(),
    };
    let names: Vec<String> = watched.files.keys().cloned().collect();
    loop {
        // One file after the other, so that a text is read when there is room for it.
        for file in &names {
            let Ok(Ok(place)) = timeout(pace.patience, lines.reserve()).await else {
                return;
            };
            let (session, file) = (Arc::clone(&session), file.clone());
            let looked = spawn_blocking(move || {
                let event = watched.look(&session, &file);
                (watched, event)
            });
            let Ok((back, event)) = looked.await else {
                return;
            };
            watched = back;
            if let Some(event) = event {
                place.send(event);
            }
        }
        let alive = Bytes::from_static(b"{\"event\":\"alive\"}\n");
        if !matches!(timeout(pace.patience, lines.send(alive)).await, Ok(Ok(()))) {
            return;
        }
        sleep(pace.period).await;
    }
}

impl Watched {
    /// The event of a file that is not as the page knows it.
    fn look(&mut self, session: &Session<'_>, file: &str) -> Option<Bytes> {
        let (now, event) = match session.store().text(file) {
            Ok(Some(text)) => {
                self.missing.remove(file);
                let now = hash(&text);
                (
                    now.clone(),
                    json!({ "event": "changed", "file": file, "text": text, "hash": now }),
                )
            }
            Ok(None) if self.missing.insert(file.to_owned()) => return None,
            Ok(None) => (String::new(), json!({ "event": "removed", "file": file })),
            Err(fault) => (
                fault.message.clone(),
                json!({ "event": "unreadable", "file": file, "reason": fault.message }),
            ),
        };
        let known = self.files.get_mut(file)?;
        if now == *known {
            return None;
        }
        *known = now;
        Some(format!("{event}\n").into())
    }
}
