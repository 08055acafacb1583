//! `completions`: what a shell needs to complete commands and options.

use clap::{Command, CommandFactory as _};

use crate::args::{Args, CompletionsArgs};
use crate::output::{End, Failure, Out};

pub fn run(args: &CompletionsArgs, out: &mut Out) -> Result<End, Failure> {
    let whole = Args::command();
    // The generators would offer hidden commands, too.
    let shown = whole.get_subcommands().filter(|command| !command.is_hide_set());
    let mut command = Command::new("gearloss")
        .version(env!("CARGO_PKG_VERSION"))
        .subcommands(shown.cloned());
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, "gearloss", &mut script);
    out.text(&String::from_utf8_lossy(&script))?;
    Ok(End::Fine)
}
