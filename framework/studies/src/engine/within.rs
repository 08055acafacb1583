//! Jobs inside a numerical method.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Engine, Stopped};

/// Jobs inside a numerical method that has errors of its own and no word for those of the engine: keeps why they ended.
pub struct JobsWithin<'e> {
    /// The engine.
    pub engine: &'e Engine<'e>,
    ended: Mutex<Option<Stopped>>,
    /// Asked often, from all threads.
    has_ended: AtomicBool,
}

impl<'e> JobsWithin<'e> {
    /// Of an engine.
    pub fn new(engine: &'e Engine<'e>) -> Self {
        Self {
            engine,
            ended: Mutex::default(),
            has_ended: AtomicBool::new(false),
        }
    }

    /// As [`Engine::jobs`]; none if they ended.
    pub fn compute<R: Serialize + DeserializeOwned + Send>(
        &self,
        label: &str,
        count: usize,
        job: impl Fn(usize) -> R + Sync,
    ) -> Option<Vec<R>> {
        let results = self.engine.jobs(label, count, |i| Ok(job(i)));
        results
            .map_err(|stopped| {
                *self.ended() = Some(stopped);
                self.has_ended.store(true, Ordering::Relaxed);
            })
            .ok()
    }

    /// Whether the method should go on.
    pub fn should_continue(&self) -> bool {
        self.engine.should_continue() && !self.has_ended.load(Ordering::Relaxed)
    }

    /// The result of the method, unless its jobs ended or the caller interrupted.
    ///
    /// # Errors
    /// Why they ended.
    pub fn result<T>(&self, result: T) -> Result<T, Stopped> {
        match self.ended().take() {
            Some(stopped) => Err(stopped),
            None if self.engine.should_continue() => Ok(result),
            None => Err(Stopped::Interrupted),
        }
    }

    fn ended(&self) -> std::sync::MutexGuard<'_, Option<Stopped>> {
        self.ended.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
