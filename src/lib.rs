//! Power losses, efficiency and operating temperature of transmissions: the program, as a library.
//!
//! - **Programs** use [`api`]: read from disk or memory, override values by path, solve points, run studies, get typed outcomes.
//! - **Your own models and mechanisms** use [`framework::prelude`], **your own analyses** [`studies::prelude`].
//! - **The program with your models** is three lines:
//!
//! ```no_run
//! // use my_models as _;
//! fn main() -> std::process::ExitCode {
//!     gearloss::main()
//! }
//! ```
//!
//! # A first program
//! ```
//! use gearloss::api::{Choice, Gearbox, Given, Language, solve_point};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/two-speed-ev/gearbox.yaml");
//! let language = Language::linked()?;
//! let gearbox = Gearbox::read(&language, file.as_ref())?;
//! let transmission = gearbox.transmission(&language, &Choice::of_set("joint"))?;
//! let point = solve_point(&gearbox, &transmission, "first", Given::new(10.0, 800.0))?; // Nm, rad/s
//! println!("loss {:?} W, efficiency {:?}", point.loss, point.efficiency);
//! # assert!(point.efficiency.is_some_and(|share| share < 1.0));
//! # Ok(())
//! # }
//! ```
//! Gearboxes and studies are described in YAML; `README.md` shows one of each, and the folder `examples` has more. Errors list all
//! findings with code, position and help; `docs/errors.md` explains the codes.

pub mod api;
mod args;
mod commands;
mod interrupt;
mod output;
mod own_process;
mod registers;
mod shard;
mod threads;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
// The built-in models register themselves; this line links them.
use gearloss_plugins as _;

pub use gearloss_document as document;
pub use gearloss_editor as editor;
pub use gearloss_exchange as exchange;
pub use gearloss_framework as framework;
pub use gearloss_numerics as numerics;
pub use gearloss_report as report;
pub use gearloss_studies as studies;

use args::{Args, Command, ResultArgs, ShownArgs};
use gearloss_studies::tasks::TaskResults;
use output::{End, Failure, Out};

/// Runs the program with the arguments of the process.
///
/// Exit codes: 0 success, 1 a finding, 2 an input error, 3 a bug, 130 interrupted. A panic in any thread, also of a model of another
/// crate, is a bug: the hook that this function installs reports it and ends the process.
pub fn main() -> ExitCode {
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |bug| {
        report(bug);
        let _ = Out::error().text("This is a bug in gearloss. Please report the input and the lines above.\n");
        std::process::exit(3);
    }));
    if let Ok(program) = std::env::current_exe() {
        own_process::set(vec![program.into()]);
    }
    interrupt::own_signals();
    ExitCode::from(call(std::env::args_os()))
}

/// States how a process of [`call`] is started, such as `["python", "-c", "..."]`: `run --template` does so, to fill the template apart. [`main`]
/// knows it.
pub fn started_by(words: impl IntoIterator<Item = OsString>) {
    own_process::set(words.into_iter().collect());
}

/// Stops the command that runs in [`call`] on another thread, as the first Ctrl-C does: finished analyses are kept. Where `call` is used
/// without [`main`], signals belong to the caller.
pub fn interrupt() {
    interrupt::press();
}

/// Runs one command with its arguments, the first of which is the program name; returns the exit code of [`main`]. A panic reaches the
/// caller.
pub fn call(args: impl IntoIterator<Item = OsString>) -> u8 {
    interrupt::forget();
    let args = match Args::try_parse_from(args) {
        Ok(args) => args,
        Err(error) => {
            let wrong = error.use_stderr();
            let mut out = if wrong { Out::error() } else { Out::standard() };
            // A closed pipe is not a failure.
            let _ = out.text(&error.render().to_string());
            return if wrong { 2 } else { 0 };
        }
    };
    exit_code(run(args))
}

/// Writes the results of a study into a folder as `gearloss run -o` does, from results of tasks that other processes have computed; without
/// a folder, into `results` next to the study. Returns the exit code of [`main`].
pub fn write_results(
    study: &api::Study,
    language: &api::Language,
    tasks: &dyn TaskResults,
    folder: Option<&Path>,
    force: bool,
) -> u8 {
    interrupt::forget();
    let args = ResultArgs {
        output: folder.map(Path::to_owned),
        template: None,
        force,
        deny: Vec::new(),
        shown: ShownArgs::default(),
    };
    exit_code(commands::run::all(
        language,
        study,
        Some(tasks),
        &args,
        &mut Out::standard(),
    ))
}

/// The exit code of a command, whose failure is printed.
fn exit_code(end: Result<End, Failure>) -> u8 {
    match end {
        Ok(End::Fine) => 0,
        Ok(End::Finding) => 1,
        Err(failure) => {
            let text = failure.text();
            let _ = Out::error().text(text.as_deref().unwrap_or("interrupted\n"));
            if text.is_some() { 2 } else { 130 }
        }
    }
}

fn run(args: Args) -> Result<End, Failure> {
    threads::limit()?;
    registers::check()?;
    let mut out = Out::standard();
    match args.command {
        Command::Catalogue(args) => commands::catalogue::run(&args, &mut out),
        Command::Check(args) => commands::check::run(&args, &mut out),
        Command::Solve(args) => commands::solve::run(&args, &mut out),
        Command::Explain(args) => commands::explain::run(&args, &mut out),
        Command::Run(args) => commands::run::run(&args, &mut out),
        Command::Shards(args) => commands::shards::run(&args, &mut out),
        Command::Report(args) => commands::report::run(&args, &mut out),
        Command::Merge(args) => commands::merge::run(&args, &mut out),
        Command::Models(args) => commands::models::run(&args, &mut out),
        Command::Validate(args) => commands::validate::run(&args, &mut out),
        Command::Eval(args) => commands::eval::run(&args, &mut out),
        Command::Schema(args) => commands::schema::run(&args, &mut out),
        Command::Completions(args) => commands::completions::run(&args, &mut out),
        Command::Man(args) => commands::man::run(&args),
        Command::FillTemplate => commands::fill_template::run(),
        Command::Fit(args) => commands::fit::run(&args, &mut out),
        Command::Import(args) => commands::import::run(&args, &mut out),
        Command::New(args) => commands::new::run(&args, &mut out),
        Command::Lsp(_) => {
            // Two threads of the server write to it.
            drop(out);
            commands::lsp::run()
        }
        Command::Open(args) => commands::open::run(&args, &mut out),
    }
}
