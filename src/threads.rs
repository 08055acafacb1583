//! Number of threads.

use crate::output::{Failure, Out};

/// The environment variable.
const ASKED: &str = "RAYON_NUM_THREADS";

/// Maximum number of threads for each core; more only cost memory and time.
const MOST_PER_CORE: usize = 4;

/// Number of threads that is allowed on any machine.
const ALWAYS: usize = 64;

/// Limits an excessive `RAYON_NUM_THREADS` and prints a note. Results do not depend on the number of threads.
pub fn limit() -> Result<(), Failure> {
    let asked = std::env::var(ASKED)
        .ok()
        .and_then(|text| text.trim().parse::<usize>().ok());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let most = ALWAYS.max(MOST_PER_CORE * cores);
    let Some(asked) = asked.filter(|asked| *asked > most) else {
        return Ok(());
    };
    // A calling program that has started its threads has already chosen their number.
    if rayon::ThreadPoolBuilder::new().num_threads(most).build_global().is_ok() {
        Out::error().line(format!(
            "note: {ASKED}={asked}: using {most} threads, because more would be slower"
        ))?;
    }
    Ok(())
}
