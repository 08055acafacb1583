//! Ctrl-C: finished analyses are kept. The first press stops the current analysis, the second ends the program immediately.

use std::sync::atomic::{AtomicBool, Ordering};

static PRESSED: AtomicBool = AtomicBool::new(false);
/// Whether the signals of the process are ours: not in a library.
static OWNED: AtomicBool = AtomicBool::new(false);

/// Says that the process is this program, whose commands may handle its signals.
pub fn own_signals() {
    OWNED.store(true, Ordering::Relaxed);
}

/// Installs the handler in the program. If the system refuses, Ctrl-C ends the program immediately.
pub fn listen() {
    if !OWNED.load(Ordering::Relaxed) {
        return;
    }
    let _ = ctrlc::set_handler(|| {
        if PRESSED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
}

/// As if Ctrl-C was pressed once.
pub fn press() {
    PRESSED.store(true, Ordering::Relaxed);
}

/// Forgets that Ctrl-C was pressed.
pub fn forget() {
    PRESSED.store(false, Ordering::Relaxed);
}

/// True after Ctrl-C was pressed.
pub fn pressed() -> bool {
    PRESSED.load(Ordering::Relaxed)
}
