//! What a connection does, which decides whether it is closed for another one.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use tokio::time::Instant;

/// How long a connection without the token may take to show it while others wait.
const STRANGER: Duration = Duration::from_secs(2);

/// How long a connection with the token may be idle while others wait.
const IDLE: Duration = Duration::from_millis(500);

/// What a connection does.
#[derive(Debug)]
pub struct Activity {
    /// Whether a request on it has shown the token.
    known: AtomicBool,
    /// Number of its requests that are not answered completely.
    busy: AtomicUsize,
    /// When it was opened, and since it is known, when its last answer was complete.
    since: Mutex<Instant>,
}

impl Activity {
    /// Of a new connection.
    pub fn begin() -> Arc<Self> {
        Arc::new(Self {
            known: AtomicBool::new(false),
            busy: AtomicUsize::new(0),
            since: Mutex::new(Instant::now()),
        })
    }

    /// Notes that a request has shown the token.
    pub fn know(&self) {
        self.known.store(true, Ordering::Relaxed);
    }

    /// Busy until the returned value is dropped.
    pub fn work(self: &Arc<Self>) -> Busy {
        self.busy.fetch_add(1, Ordering::Relaxed);
        Busy(Arc::clone(self))
    }

    fn age(&self) -> Duration {
        self.since.lock().unwrap_or_else(PoisonError::into_inner).elapsed()
    }

    /// How gladly it is closed for another connection, as a pair to compare; `None` if it is not. Strangers come first: they must not keep
    /// out who has the token.
    pub fn dispensable(&self) -> Option<(bool, Duration)> {
        let (is_known, age) = (self.known.load(Ordering::Relaxed), self.age());
        let is_idle = self.busy.load(Ordering::Relaxed) == 0;
        let is = if is_known {
            is_idle && age > IDLE
        } else {
            age > STRANGER
        };
        is.then_some((!is_known, age))
    }
}

/// A request that is not answered completely.
#[derive(Debug)]
pub struct Busy(Arc<Activity>);

impl Drop for Busy {
    fn drop(&mut self) {
        let activity = &self.0;
        activity.busy.fetch_sub(1, Ordering::Relaxed);
        // The time of a stranger runs from its beginning, whatever it asks.
        if activity.known.load(Ordering::Relaxed) {
            *activity.since.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
        }
    }
}
