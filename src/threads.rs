//! How many threads work.

use crate::output::{Failure, Out};

/// The variable that states it.
const ASKED: &str = "RAYON_NUM_THREADS";

/// Threads for each core from which on more of them only take memory and time.
const MOST_PER_CORE: usize = 4;

/// Threads that are allowed on any machine, so that a number for a larger one may be tried on a small one.
const ALWAYS: usize = 64;

/// Starts fewer threads than `RAYON_NUM_THREADS` asks for where it asks for too many, and prints a note about it. Results do not
/// depend on their number.
pub fn limit() -> Result<(), Failure> {
    let asked = std::env::var(ASKED)
        .ok()
        .and_then(|text| text.trim().parse::<usize>().ok());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let most = ALWAYS.max(MOST_PER_CORE * cores);
    let Some(asked) = asked.filter(|asked| *asked > most) else {
        return Ok(());
    };
    // Where a program that calls this one has started its threads, it has chosen their number.
    if rayon::ThreadPoolBuilder::new().num_threads(most).build_global().is_ok() {
        Out::error().line(format!(
            "note: {ASKED}={asked}: {most} threads are used, more would only slow it down"
        ))?;
    }
    Ok(())
}
