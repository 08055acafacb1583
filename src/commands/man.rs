//! `man`: the manual pages `gearloss.1`, `gearloss-run.1` and so on, from the texts of `--help`.

use clap::CommandFactory as _;

use crate::args::{Args, ManArgs};
use crate::output::{End, Failure};

pub fn run(args: &ManArgs) -> Result<End, Failure> {
    let written =
        std::fs::create_dir_all(&args.folder).and_then(|()| clap_mangen::generate_to(Args::command(), &args.folder));
    written.map_err(|error| {
        let message = format!("cannot write manual pages into {}: {error}", args.folder.display());
        Failure::input(message, "choose another folder")
    })?;
    Ok(End::Fine)
}
