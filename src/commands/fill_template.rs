//! `fill-template`: the process in which `run` fills a template of the user.
//!
//! A template is a program: it can double a text thirty times, or nest expressions as deeply as it is long. No language can limit that
//! from within, so that a process ends instead.

use std::io::{Read as _, Write as _};
use std::time::{Duration, Instant};

use gearloss_report::html::fill_template;
use serde_json::Value;

use crate::output::{End, Failure, Out};

/// Name of the command.
pub const COMMAND: &str = "fill-template";

/// Maximum memory beyond that of the content. \[byte\]
const MOST_MEMORY: usize = 1 << 30;

/// Maximum time.
const MOST_TIME: Duration = Duration::from_secs(30);

/// Time between two looks at memory and time.
const PERIOD: Duration = Duration::from_millis(2);

/// Memory for nesting, of which a template of the maximum length needs a part. \[byte\]
const STACK: usize = 512 << 20;

pub fn run() -> Result<End, Failure> {
    let refused = |reason: &dyn std::fmt::Display| {
        let message = format!("{COMMAND} is a part of `run --template`: {reason}");
        Failure::input(message, "use `gearloss run STUDY --template FILE`")
    };
    let mut input = Vec::new();
    std::io::stdin()
        .read_to_end(&mut input)
        .map_err(|error| refused(&error))?;
    let mut input: Value = serde_json::from_slice(&input).map_err(|error| refused(&error))?;
    let [name, template] = ["name", "template"].map(|key| input[key].as_str().unwrap_or_default().to_owned());
    let content = input["content"].take();
    drop(input);
    watch(name.clone());
    let filled = std::thread::Builder::new().stack_size(STACK).spawn(move || {
        let mut page = Vec::new();
        fill_template(&name, &template, content, &mut page).map(|()| page)
    });
    let filled = filled.map_err(|error| refused(&error))?.join();
    let page = filled.map_err(|_| refused(&"it broke off"))??;
    std::io::stdout().write_all(&page)?;
    Ok(End::Fine)
}

/// Ends the process when it needs too much memory or time.
fn watch(name: String) {
    let (start, before) = (Instant::now(), memory());
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(PERIOD);
            let words = if memory().saturating_sub(before) > MOST_MEMORY {
                format!(
                    "it needs more than {} GB of memory; does it double a text?",
                    MOST_MEMORY >> 30
                )
            } else if start.elapsed() > MOST_TIME {
                format!("it takes more than {} s", MOST_TIME.as_secs())
            } else {
                continue;
            };
            let failure = Failure::input(
                format!("the template {name}: {words}"),
                "correct it, or omit --template",
            );
            let _ = Out::error().text(&failure.text().unwrap_or_default());
            std::process::exit(2);
        }
    });
}

/// Memory of this process; zero where it is not known. \[byte\]
fn memory() -> usize {
    memory_stats::memory_stats().map_or(0, |stats| stats.physical_mem)
}
