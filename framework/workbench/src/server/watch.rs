//! Changes of files on the disk.

use std::collections::BTreeMap;
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
    loop {
        for (file, known) in &mut files {
            let event = match session.store().read(file) {
                Ok(text) => {
                    let now = hash(&text);
                    if now == *known {
                        continue;
                    }
                    known.clone_from(&now);
                    json!({ "event": "changed", "file": file, "text": text, "hash": now })
                }
                Err(_) if known.is_empty() => continue,
                Err(_) => {
                    known.clear();
                    json!({ "event": "removed", "file": file })
                }
            };
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
