//! Changes of files on the disk.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

use hyper::body::Bytes;
use serde_json::json;
use tokio::sync::mpsc::UnboundedSender;
use tokio::time::sleep;

use super::work::OpenPage;
use crate::session::Session;
use crate::store::hash;

/// Time between two looks.
const PERIOD: Duration = Duration::from_secs(1);

/// Looks at the files of a page every second and tells what changed, until nobody listens. Texts are short and reading one is faster
/// than a service of the system that differs from computer to computer.
pub async fn watch(
    session: Arc<Session<'static>>,
    mut files: BTreeMap<String, String>,
    lines: UnboundedSender<Bytes>,
    page: OpenPage,
) {
    // Files that were missing at the last look: one that is replaced is missing for a moment.
    let mut missing: BTreeSet<String> = BTreeSet::new();
    loop {
        for (file, known) in &mut files {
            let (now, event) = match session.store().text(file) {
                Ok(Some(text)) => {
                    missing.remove(file);
                    let now = hash(&text);
                    (
                        now.clone(),
                        json!({ "event": "changed", "file": file, "text": text, "hash": now }),
                    )
                }
                Ok(None) if missing.insert(file.clone()) => continue,
                Ok(None) => (String::new(), json!({ "event": "removed", "file": file })),
                Err(fault) => (
                    fault.message.clone(),
                    json!({ "event": "unreadable", "file": file, "reason": fault.message }),
                ),
            };
            if now == *known {
                continue;
            }
            *known = now;
            if lines.send(format!("{event}\n").into()).is_err() {
                return;
            }
        }
        if lines.send(Bytes::from_static(b"{\"event\":\"alive\"}\n")).is_err() {
            break;
        }
        sleep(PERIOD).await;
    }
    drop(page);
}
