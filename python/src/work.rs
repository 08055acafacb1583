//! Long work beside the interpreter: it runs without its lock and ends on Ctrl-C.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How often signals are looked for.
const LOOK: Duration = Duration::from_millis(20);

/// Runs work on another thread until it is done or Ctrl-C is pressed. The work is asked to end by the flag that it is given.
///
/// # Errors
/// `KeyboardInterrupt`, or what a handler of signals raises.
pub fn run<T: Send>(py: Python<'_>, work: impl FnOnce(&AtomicBool) -> T + Send) -> PyResult<T> {
    run_watched(py, |_| Ok(()), || {}, work)
}

/// As [`run`], for work that is asked to end by a function.
pub fn run_until<T: Send>(py: Python<'_>, end: impl Fn(), work: impl FnOnce(&AtomicBool) -> T + Send) -> PyResult<T> {
    run_watched(py, |_| Ok(()), end, work)
}

/// As [`run_until`]; meanwhile and at the end `watch` is called, and ends the work with an error.
pub fn run_watched<T: Send>(
    py: Python<'_>,
    watch: impl Fn(Python<'_>) -> PyResult<()>,
    end: impl Fn(),
    work: impl FnOnce(&AtomicBool) -> T + Send,
) -> PyResult<T> {
    same_process()?;
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let (done, finished) = channel();
        let finished = Mutex::new(finished);
        let stop = &stop;
        let worker = scope.spawn(move || {
            let result = work(stop);
            // The receiver is gone only after an interruption, when nobody needs the result.
            let _ = done.send(());
            result
        });
        let mut pressed = None;
        loop {
            let waited = py.detach(|| wait(&finished));
            match waited {
                Err(RecvTimeoutError::Timeout) => {}
                Ok(()) | Err(RecvTimeoutError::Disconnected) => break,
            }
            if let Err(error) = py
                .check_signals()
                .and_then(|()| if pressed.is_none() { watch(py) } else { Ok(()) })
            {
                stop.store(true, Ordering::Relaxed);
                pressed.get_or_insert(error);
            }
            // Again and again: work that has only just begun may have missed it.
            if pressed.is_some() {
                end();
            }
        }
        if pressed.is_none() {
            pressed = watch(py).err();
        }
        let result = py.detach(|| worker.join());
        match (pressed, result) {
            (Some(error), _) => Err(error),
            (None, Ok(result)) => Ok(result),
            // A bug: as `PanicException`.
            (None, Err(bug)) => std::panic::resume_unwind(bug),
        }
    })
}

/// Waits for the end of the work, not longer than the next look for signals.
fn wait(finished: &Mutex<Receiver<()>>) -> Result<(), RecvTimeoutError> {
    let finished = finished.lock().unwrap_or_else(PoisonError::into_inner);
    finished.recv_timeout(LOOK)
}

/// Refuses to compute in a process that was forked after its parent had computed: it has no threads, so it would wait forever.
fn same_process() -> PyResult<()> {
    static FIRST: AtomicU32 = AtomicU32::new(0);
    let this = std::process::id();
    match FIRST.compare_exchange(0, this, Ordering::Relaxed, Ordering::Relaxed) {
        Err(first) if first != this => Err(PyRuntimeError::new_err(
            "this process was forked from one that has computed; use the start method `spawn`",
        )),
        _ => Ok(()),
    }
}
